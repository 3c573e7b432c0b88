//! Where a database is: a file, or a URL of PostgreSQL, whose words on TLS are looked at here: a wrong one would be told in the driver's
//! words, or mean less than it seems to.

use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use std::path::Path;

/// What `sslmode` may be. `allow` is left out: here it would mean `disable`; and `verify-ca`: the driver (sqlx 0.8.6) asks for the right
/// name all the same, with rustls of today, and its message would speak of a name that nobody asked about.
const MODES: [&str; 4] = ["disable", "prefer", "require", "verify-full"];
/// Without it the certificate of PostgreSQL is not looked at.
const VERIFYING: &str = "verify-full";

/// A URL of PostgreSQL, no file.
pub fn is_url(target: &str) -> bool {
    target.starts_with("postgres://") || target.starts_with("postgresql://")
}

/// Checks what a URL says of TLS.
///
/// # Errors
/// The key that is wrong, its value, and what is allowed.
pub fn check(target: &str) -> Result<(), String> {
    let Some((_, query)) = target.split_once('?').filter(|_| is_url(target)) else { return Ok(()) };
    let said: Vec<(String, String)> = form_urlencoded::parse(query.as_bytes()).into_owned().collect();
    let value = |key: &str| said.iter().rev().find(|(name, _)| name == key).map(|(_, value)| value.as_str());
    let known = ["sslmode", "sslrootcert", "sslcert", "sslkey"];
    // A misspelt word of safety must not be passed over in silence.
    if let Some((name, _)) = said.iter().find(|(name, _)| is_of_tls(name) && !known.contains(&name.as_str())) {
        return Err(format!("{name}: unknown (allowed: {})", known.join(", ")));
    }
    let mode = value("sslmode");
    if let Some(mode) = mode.filter(|mode| !MODES.contains(mode)) {
        return Err(format!("sslmode = '{mode}' (allowed: {})", MODES.join(", ")));
    }
    if let Some(file) = value("sslrootcert") {
        if mode != Some(VERIFYING) {
            return Err(format!("sslrootcert = '{file}' counts with sslmode={VERIFYING} alone"));
        }
        certificates("sslrootcert", file)?;
    }
    match (value("sslcert"), value("sslkey")) {
        (None, None) => Ok(()),
        (Some(chain), Some(key)) => {
            certificates("sslcert", chain)?;
            let read = PrivateKeyDer::from_pem_file(Path::new(key));
            read.map(|_| ()).map_err(|error| format!("sslkey = '{key}': {error}"))
        }
        _ => Err("sslcert and sslkey go together: one of them is missing".into()),
    }
}

/// A key that means TLS, however it is written: the driver passes over `SSLMODE`.
fn is_of_tls(key: &str) -> bool {
    key.to_ascii_lowercase().starts_with("ssl")
}

/// A file holds at least one certificate.
fn certificates(key: &str, file: &str) -> Result<(), String> {
    let read = CertificateDer::pem_file_iter(Path::new(file)).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    match read {
        Ok(found) if found.is_empty() => Err(format!("{key} = '{file}' holds no certificate (PEM)")),
        Ok(_) => Ok(()),
        Err(error) => Err(format!("{key} = '{file}': {error}")),
    }
}

/// An error of the connection, and what can be done where the driver's words leave it open.
pub fn connection_error(error: &sqlx::Error) -> String {
    let said = error.to_string();
    let advice = [
        (
            "UnknownIssuer",
            "whoever signed the server's certificate is not known here: name the authority's file with sslrootcert=FILE",
        ),
        ("not valid for name", "the server's certificate is for another name: call the host by that name"),
        (
            "CaUsedAsEndEntity",
            "the server's certificate is an authority's own: it has to be signed by the authority for the host's name",
        ),
        ("certificate expired", "the server's certificate is too old, or a clock is wrong"),
        (
            "server does not support TLS",
            "switch TLS on there (ssl = on), or take sslmode=disable on a line that nobody else hears",
        ),
    ];
    match advice.iter().find(|(sign, _)| said.contains(sign)) {
        Some((_, advice)) => format!("{said} ({advice})"),
        None => said,
    }
}

/// A file name as a URL; a missing file is made.
pub fn sqlite_url(file: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/._-~".contains(&byte);
    let encoded: String =
        file.bytes().map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect();
    format!("sqlite://{encoded}?mode=rwc")
}

/// `postgres://user:secret@host/db` without the secret.
pub fn without_password(target: &str) -> String {
    let Some((scheme, rest)) = target.split_once("://").filter(|_| is_url(target)) else { return target.to_owned() };
    let (address, _) = rest.split_once('?').unwrap_or((rest, ""));
    match address.rsplit_once('@') {
        Some((user, host)) => format!("{scheme}://{}@{host}", user.split(':').next().unwrap_or_default()),
        None => format!("{scheme}://{address}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_what_is_wrong_about_tls_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("empty.pem").display().to_string();
        std::fs::write(&file, "no certificate\n").unwrap();
        let empty = format!("sslmode=verify-full&sslrootcert={file}");
        for (query, said) in [
            ("sslmode=on", "sslmode = 'on' (allowed: disable, prefer, require, verify-full)"),
            ("sslmode=allow", "sslmode = 'allow'"),
            ("sslmode=verify-ca", "sslmode = 'verify-ca'"),
            ("sslmod=verify-full", "sslmod: unknown (allowed: sslmode, sslrootcert, sslcert, sslkey)"),
            ("SSLMODE=verify-full", "SSLMODE: unknown (allowed: sslmode, sslrootcert, sslcert, sslkey)"),
            ("sslrootcert=/none.pem", "counts with sslmode=verify-full alone"),
            ("sslmode=require&sslrootcert=/none.pem", "counts with sslmode=verify-full alone"),
            ("sslmode=verify-full&sslrootcert=/none.pem", "sslrootcert = '/none.pem': "),
            (empty.as_str(), "holds no certificate (PEM)"),
            ("sslcert=/none.pem", "sslcert and sslkey go together"),
        ] {
            let wrong = check(&format!("postgres://spandrel@db/training?{query}")).unwrap_err();
            assert!(wrong.contains(said), "{query}: {wrong}");
        }
        for good in
            ["postgres://db/t", "postgres://db/t?sslmode=require", "postgres://db/t?host=/run", "records.sqlite?sslmode=on"]
        {
            assert_eq!(check(good), Ok(()), "{good}");
        }
    }
}
