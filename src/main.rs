//! The command line: one line per subcommand.

fn main() -> std::process::ExitCode {
    std::process::ExitCode::SUCCESS
}
