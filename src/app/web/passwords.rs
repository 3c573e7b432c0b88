//! Passwords: argon2id with the parameters that OWASP names (19 MiB, 2 passes, 1 lane), which are the library's defaults.

use crate::app::errors::AppError;
use crate::app::records::Place;
use crate::training::trainee::Role;
use crate::web::login;
use argon2::Argon2;
use argon2::password_hash::{PasswordHash, PasswordHasher, PasswordVerifier, SaltString};
use std::io::{BufRead, IsTerminal};

/// What a name without a password is checked against, so that it takes as long as one with.
const NOBODY: &str = "$argon2id$v=19$m=19456,t=2,p=1$c3BhbmRyZWxzcGFuZHJlbA$lpYT1oVDUN5U6kPGGjEw5xOVQbQTkgO2xbCVrTQEzDM";

/// A password's hash.
///
/// # Errors
/// When the system has no randomness.
pub fn hash(password: &str) -> Result<String, AppError> {
    let failed = |error: &dyn std::fmt::Display| AppError::failed(format!("the password cannot be hashed: {error}"));
    let mut salt = [0; 16];
    getrandom::fill(&mut salt).map_err(|error| failed(&error))?;
    let salt = SaltString::encode_b64(&salt).map_err(|error| failed(&error))?;
    let hash = Argon2::default().hash_password(password.as_bytes(), &salt).map_err(|error| failed(&error))?;
    Ok(hash.to_string())
}

/// The password is the one that was hashed.
pub fn fits(password: &str, hash: Option<&str>) -> bool {
    let Ok(parsed) = PasswordHash::new(hash.unwrap_or(NOBODY)) else { return false };
    let fits = Argon2::default().verify_password(password.as_bytes(), &parsed).is_ok();
    fits && hash.is_some()
}

/// Asks for a password and keeps its hash.
///
/// # Errors
/// When it is no good, or the database refuses.
pub fn set(place: &Place, name: &str, role: Role) -> Result<(), AppError> {
    let password = ask(name)?;
    login::check(&password, name).map_err(|wrong| AppError::wrong(format!("--set-password {name}: {wrong}")))?;
    let database = place.open()?;
    database.set_login(name, role, &hash(&password)?)?;
    println!("{}: '{name}' may log in as {}", database.name(), role.word());
    Ok(())
}

fn ask(name: &str) -> Result<String, AppError> {
    let failed = |error: std::io::Error| AppError::failed(format!("no password was read: {error}"));
    if std::io::stdin().is_terminal() {
        let first = rpassword::prompt_password(format!("Password for {name}: ")).map_err(failed)?;
        let again = rpassword::prompt_password("Again: ").map_err(failed)?;
        return if first == again { Ok(first) } else { Err(AppError::wrong("the two passwords differ")) };
    }
    let mut line = String::new();
    std::io::stdin().lock().read_line(&mut line).map_err(failed)?;
    Ok(line.trim_end_matches(['\r', '\n']).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_a_hash_fits_its_password_alone_and_never_twice_the_same() {
        let first = hash("correct horse battery").unwrap();
        assert!(first.starts_with("$argon2id$v=19$m=19456,t=2,p=1$"), "{first}");
        assert_ne!(first, hash("correct horse battery").unwrap());
        assert!(fits("correct horse battery", Some(&first)));
        assert!(!fits("correct horse batterz", Some(&first)));
        assert!(!fits("correct horse battery", None));
        assert!(!fits("x", Some("no hash")));
        // The stand-in is a hash like any other, so that nobody's name is told by the time that it takes.
        assert!(PasswordHash::new(NOBODY).is_ok());
    }
}
