//! Command line reference page: the help text of the program and every subcommand.

use crate::{check, page_head};
use clap::{Command, CommandFactory};

/// Appends the help for a command and its subcommands.
fn help(command: &mut Command, name: &str, level: usize, out: &mut String) {
    let text = command.render_long_help().to_string();
    let text: Vec<&str> = text.lines().map(str::trim_end).collect();
    out.push_str(&format!("\n{} {name}\n\n```text\n{}\n```\n", "#".repeat(level), text.join("\n").trim_end()));
    let names: Vec<String> = command.get_subcommands().map(|sub| sub.get_name().to_owned()).filter(|sub| sub != "help").collect();
    for sub in names {
        if let Some(found) = command.find_subcommand_mut(&sub) {
            help(found, &format!("{name} {sub}"), level + 1, out);
        }
    }
}

#[test]
fn exact_commands_page_matches_the_program() {
    let mut command = spandrel::Cli::command();
    command.build();
    let about = "The help text of every subcommand, as printed by `--help`. The exit code is 0 for success, 1 for failure, and 2 for invalid arguments or files. Subcommands that can run an external autopilot list further codes.";
    let mut page = page_head("Command line", about);
    help(&mut command, "spandrel", 2, &mut page);
    check("commands.md", &page);
}
