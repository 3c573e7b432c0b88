//! Commands as the person at the terminal has to type them.

use std::borrow::Cow;

/// Environment variable with which `tools/run` passes on how it was called.
const STARTED_AS: &str = "SPANDREL_STARTED_AS";

/// Returns a command that starts with "spandrel" as it must be typed here: a program that a script started is not on the path.
pub fn typed(command: &str) -> Cow<'_, str> {
    with_program(command, std::env::var(STARTED_AS).ok().as_deref())
}

fn with_program<'a>(command: &'a str, program: Option<&str>) -> Cow<'a, str> {
    match (program, command.strip_prefix("spandrel ")) {
        (Some(program), Some(arguments)) if !program.is_empty() => Cow::Owned(format!("{program} {arguments}")),
        _ => Cow::Borrowed(command),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_only_the_program_is_replaced() {
        let command = "spandrel train --trainee spandrel";
        assert_eq!(with_program(command, Some("tools/run")), "tools/run train --trainee spandrel");
        assert_eq!(with_program(command, None), command);
        assert_eq!(with_program(command, Some("")), command);
        assert_eq!(with_program("spandrels", Some("tools/run")), "spandrels");
    }
}
