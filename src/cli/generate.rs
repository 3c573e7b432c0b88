//! `spandrel generate`: writes manual pages and shell completions for packaging. The help, the manual and the
//! completions do not list it.

use crate::errors::AppError;
use crate::io::files;
use clap::{Command, Subcommand};
use clap_complete::Shell;
use clap_mangen::{Man, roff::Roff};
use std::path::PathBuf;

/// Name of the hidden subcommand.
pub const NAME: &str = "generate";

/// What to generate: manual pages or shell completions.
#[derive(Debug, Subcommand)]
pub enum GeneratorCommand {
    /// Write the manual pages for the program and its subcommands
    Man {
        /// Existing folder for the pages
        #[arg(value_name = "DIR")]
        folder: PathBuf,
    },
    /// Print completions for a shell
    Completions {
        /// Shell to generate completions for
        shell: Shell,
    },
}

/// Returns the hidden subcommand.
pub fn subcommand() -> Command {
    GeneratorCommand::augment_subcommands(Command::new(NAME).hide(true).subcommand_required(true))
}

/// Runs the subcommand. `documented` is the program's command line without this subcommand.
///
/// # Errors
/// Returns an error if a file or standard output cannot be written.
pub fn run(what: &GeneratorCommand, mut documented: Command) -> Result<(), AppError> {
    match what {
        GeneratorCommand::Man { folder } => {
            for (name, page) in pages(documented)? {
                files::write(&folder.join(name).display().to_string(), &page)?;
            }
            Ok(())
        }
        GeneratorCommand::Completions { shell } => {
            let name = documented.get_name().to_owned();
            let mut script = Vec::new();
            clap_complete::generate(*shell, &mut documented, name, &mut script);
            files::write("-", &script)
        }
    }
}

/// Returns each manual page's file name and text.
fn pages(documented: Command) -> Result<Vec<(String, Vec<u8>)>, AppError> {
    let mut command = documented.disable_help_subcommand(true);
    command.build();
    let mut out = Vec::new();
    let mut waiting = vec![command];
    while let Some(command) = waiting.pop() {
        waiting.extend(command.get_subcommands().filter(|one| !one.is_hide_set()).cloned());
        out.push(page(command).map_err(|error| AppError::failed(format!("cannot write the manual: {error}")))?);
    }
    Ok(out)
}

fn page(command: Command) -> std::io::Result<(String, Vec<u8>)> {
    let after = command.get_after_long_help().or(command.get_after_help()).map(ToString::to_string).unwrap_or_default();
    let plain = command.after_help(None::<&str>).after_long_help(None::<&str>);
    let man = Man::new(plain).manual("Spandrel manual").source(concat!("Spandrel ", env!("CARGO_PKG_VERSION")));
    let mut text = Vec::new();
    man.render(&mut text)?;
    // Each section consists of a heading and lines that are not reflowed.
    let mut sections = Roff::new();
    for part in after.split("\n\n").filter(|part| !part.is_empty()) {
        let (heading, body) = part.split_once(':').unwrap_or(("Notes", part));
        sections.control("SH", [heading.to_uppercase().as_str()]).control("nf", []);
        for line in body.trim_matches('\n').lines() {
            sections.text([clap_mangen::roff::roman(line.trim())]);
        }
        sections.control("fi", []);
    }
    sections.to_writer(&mut text)?;
    Ok((man.get_filename(), text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;
    use std::collections::BTreeMap;

    #[test]
    fn exact_every_subcommand_has_manual_page_with_examples() {
        let command = super::super::Cli::command();
        let pages: BTreeMap<String, Vec<u8>> = pages(command.clone()).unwrap().into_iter().collect();
        for name in command.get_subcommands().map(Command::get_name) {
            let page = String::from_utf8(pages[&format!("spandrel-{name}.1")].clone()).unwrap();
            assert!(
                !page.contains(".SH NOTES\n.nf\n.fi")
                    && page.contains(".SH EXAMPLES")
                    && page.contains(&format!("spandrel {name}")),
                "{page}"
            );
        }
        let first = String::from_utf8(pages["spandrel.1"].clone()).unwrap();
        assert!(first.contains(".SH \"EXIT CODES\"") && !first.contains(NAME), "{first}");
    }

    #[test]
    fn exact_completions_list_every_visible_subcommand() {
        for shell in [Shell::Bash, Shell::Zsh, Shell::Fish] {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut super::super::Cli::command(), "spandrel", &mut script);
            let script = String::from_utf8(script).unwrap();
            for name in super::super::Cli::command().get_subcommands().map(Command::get_name) {
                assert!(script.contains(name), "{shell}: {name}");
            }
            assert!(!script.contains("completions"), "{shell}");
        }
    }
}
