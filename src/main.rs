//! The program: everything is in the library, see `spandrel`.
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    spandrel::main()
}
