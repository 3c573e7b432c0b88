//! Reads the MAVLink signing key from a file.

use crate::errors::AppError;
use spandrel_mavlink::signing::SigningKey;
use std::path::Path;

/// Minimum length of a passphrase, characters.
const MIN_PASSPHRASE_CHARS: usize = 8;

/// Reads a signing key from a file with one line: either the key as 64 hexadecimal digits, or a passphrase.
///
/// # Errors
/// Returns an error if the file cannot be read, is readable by other users, or contains no key. The message never shows
/// the file's contents.
pub fn read(path: &Path) -> Result<SigningKey, AppError> {
    let wrong = |what: &str| AppError::invalid(format!("--signing-key {}: {what}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|error| wrong(&error.to_string()))?;
    if let Some(mode) = file_mode_if_readable_by_others(path) {
        return Err(wrong(&format!("other users can read it (mode {mode:o}); allowed: 600 or stricter (chmod 600)")));
    }
    let text = text.trim_end_matches(['\r', '\n']);
    if text.contains('\n') {
        return Err(wrong("the file has more than one line (allowed: exactly one)"));
    }
    match parse_hex_key(text) {
        Some(key) => Ok(SigningKey(key)),
        None if text.chars().count() >= MIN_PASSPHRASE_CHARS => Ok(SigningKey::from_passphrase(text)),
        None => Err(wrong(&format!(
            "too short; allowed: 64 hexadecimal digits, or a passphrase of {MIN_PASSPHRASE_CHARS} characters or more"
        ))),
    }
}

#[cfg(unix)]
fn file_mode_if_readable_by_others(path: &Path) -> Option<u32> {
    use std::os::unix::fs::PermissionsExt;
    let mode = std::fs::metadata(path).ok()?.permissions().mode() & 0o777;
    (mode & 0o077 != 0).then_some(mode)
}

#[cfg(not(unix))]
fn file_mode_if_readable_by_others(_: &Path) -> Option<u32> {
    None
}

fn parse_hex_key(text: &str) -> Option<[u8; 32]> {
    let digits: Vec<u8> = text.chars().map(|c| c.to_digit(16).map(|digit| digit as u8)).collect::<Option<_>>()?;
    let bytes: Vec<u8> = digits.chunks_exact(2).map(|pair| pair[0] << 4 | pair[1]).collect();
    if digits.len() == 64 { bytes.try_into().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    fn key_file(text: &str, mode: u32) -> tempfile::TempPath {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        std::fs::set_permissions(file.path(), std::fs::Permissions::from_mode(mode)).unwrap();
        file.into_temp_path()
    }

    #[test]
    fn exact_hex_digits_are_the_key_and_passphrases_are_hashed() {
        assert_eq!(
            read(&key_file(&format!("{}\n", "0aFf".repeat(16)), 0o600)).unwrap(),
            SigningKey([0x0a, 0xff].repeat(16).try_into().unwrap())
        );
        assert_eq!(read(&key_file("bridge over water", 0o400)).unwrap(), SigningKey::from_passphrase("bridge over water"));
    }

    #[test]
    fn exact_readable_or_invalid_key_files_are_rejected_without_showing_the_key() {
        for (text, mode, said) in [
            ("bridge over water", 0o640, "other users can read"),
            ("hunter2", 0o600, "too short"),
            ("one line\ntwo lines", 0o600, "more than one line"),
        ] {
            let Err(error) = read(&key_file(text, mode)) else { panic!("{said}") };
            assert!(error.to_string().contains(said) && !error.to_string().contains(text), "{error}");
        }
    }
}
