//! Files in the folder of a scenario.

/// Function that loads a file by name from the scenario's folder and returns its bytes or an error message.
pub type SiblingLoader<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, String>;

/// Loads a text file from the scenario's folder.
pub(super) fn sibling_text(siblings: SiblingLoader, file: &str) -> Result<String, String> {
    String::from_utf8(siblings(file)?).map_err(|error| format!("not UTF-8 text (byte {})", error.utf8_error().valid_up_to()))
}
