//! The program: everything is in the library, see `spandrel::app`.
#![forbid(unsafe_code)]

fn main() -> std::process::ExitCode {
    spandrel::app::main()
}
