//! Entry point. The subcommands are in the `spandrel` library.
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    spandrel::main()
}
