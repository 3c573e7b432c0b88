//! The program: everything is in the library, see `spandrel::app`.

fn main() -> std::process::ExitCode {
    spandrel::app::main()
}
