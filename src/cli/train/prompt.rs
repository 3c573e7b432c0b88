//! Terminal prompt after a session has been scored: quit, or fly the same job again.

use std::io::{BufRead, IsTerminal};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// Input that starts another flight.
const AGAIN_INPUT: &str = "again";

/// A line typed at the terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PromptAnswer {
    /// Fly the same job again.
    Again,
    /// Quit the program.
    Quit,
}

/// The terminal prompt. Without a terminal, only a signal ends the run.
#[derive(Debug, Default)]
pub struct TerminalPrompt {
    lines: Option<Receiver<String>>,
    /// True once the user has quit at the terminal.
    pub has_quit: bool,
}

impl TerminalPrompt {
    /// Returns true when standard input is a terminal.
    pub fn is_open(&self) -> bool {
        std::io::stdin().is_terminal()
    }

    /// Returns the text that explains why the vehicle stays connected and how to quit.
    pub fn help_text(&self) -> &'static str {
        if self.is_open() {
            "The vehicle stays connected: download its logs, or keep flying. Press Enter to quit; type 'again' and press Enter for another session."
        } else {
            "The vehicle stays connected: download its logs, or keep flying. Interrupt (Ctrl-C or SIGTERM) to quit."
        }
    }

    /// Returns the next answer, if one was typed. The end of the input counts as quitting.
    pub fn answer(&mut self) -> Option<PromptAnswer> {
        if !self.is_open() {
            return None;
        }
        let answer = match self.lines.get_or_insert_with(read_lines).try_recv() {
            Ok(line) => read(&line),
            Err(TryRecvError::Disconnected) => PromptAnswer::Quit,
            Err(TryRecvError::Empty) => return None,
        };
        self.has_quit |= answer == PromptAnswer::Quit;
        Some(answer)
    }

    /// Returns true if a person at a terminal can read a question and answer it.
    pub fn can_ask(&self) -> bool {
        self.is_open() && std::io::stdout().is_terminal()
    }

    /// Returns whether the user has pressed Enter; `None` until then, and false at the end of the input.
    pub fn confirmation(&mut self) -> Option<bool> {
        match self.lines.get_or_insert_with(read_lines).try_recv() {
            Ok(line) => line.trim().is_empty().then_some(true),
            Err(TryRecvError::Disconnected) => Some(false),
            Err(TryRecvError::Empty) => None,
        }
    }
}

fn read(line: &str) -> PromptAnswer {
    if line.trim().eq_ignore_ascii_case(AGAIN_INPUT) { PromptAnswer::Again } else { PromptAnswer::Quit }
}

/// Reads standard input in a separate thread, because reading a terminal blocks.
fn read_lines() -> Receiver<String> {
    let (sender, lines) = channel();
    std::thread::spawn(move || {
        for line in std::io::stdin().lock().lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                break;
            }
        }
    });
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_enter_quits_and_typing_again_starts_another_flight() {
        for (line, answer) in [
            ("", PromptAnswer::Quit),
            ("again", PromptAnswer::Again),
            (" Again \n", PromptAnswer::Again),
            ("q", PromptAnswer::Quit),
        ] {
            assert_eq!(read(line), answer, "{line:?}");
        }
    }
}
