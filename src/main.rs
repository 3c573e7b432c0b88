//! Entry point; the subcommands are in the library `spandrel`.
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    spandrel::main()
}
