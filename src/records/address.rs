//! Database addresses: a file, or a PostgreSQL URL. TLS options in the URL are checked here, because the driver's error
//! messages are unclear and some options do less than their names suggest.

use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use std::path::Path;

/// Allowed values of `sslmode`. `allow` is excluded because the driver (sqlx 0.8.6 with rustls) would treat it as
/// `disable`. `verify-ca` is excluded because the driver verifies the host name anyway, with a misleading error
/// message.
const SSL_MODES: [&str; 4] = ["disable", "prefer", "require", "verify-full"];
/// The only mode that verifies PostgreSQL's certificate.
const VERIFYING_MODE: &str = "verify-full";

/// Returns true for a PostgreSQL URL, false for a file.
pub fn is_url(target: &str) -> bool {
    target.starts_with("postgres://") || target.starts_with("postgresql://")
}

/// Checks a URL's TLS options.
///
/// # Errors
/// Returns an error if an option is invalid. The error contains the option's name, its value and the allowed values.
pub fn check_tls_options(target: &str) -> Result<(), String> {
    let Some((_, query)) = target.split_once('?').filter(|_| is_url(target)) else { return Ok(()) };
    let said: Vec<(String, String)> = form_urlencoded::parse(query.as_bytes()).into_owned().collect();
    let value = |key: &str| said.iter().rev().find(|(name, _)| name == key).map(|(_, value)| value.as_str());
    let known = ["sslmode", "sslrootcert", "sslcert", "sslkey"];
    // The driver ignores unknown options, but misspelled security options must not go unnoticed.
    if let Some((name, _)) = said.iter().find(|(name, _)| is_tls_option(name) && !known.contains(&name.as_str())) {
        return Err(format!("{name}: unknown (allowed: {})", known.join(", ")));
    }
    let mode = value("sslmode");
    if let Some(mode) = mode.filter(|mode| !SSL_MODES.contains(mode)) {
        return Err(format!("sslmode = '{mode}' (allowed: {})", SSL_MODES.join(", ")));
    }
    if let Some(file) = value("sslrootcert") {
        if mode != Some(VERIFYING_MODE) {
            return Err(format!("sslrootcert = '{file}' requires sslmode={VERIFYING_MODE}"));
        }
        check_certificate_file("sslrootcert", file)?;
    }
    match (value("sslcert"), value("sslkey")) {
        (None, None) => Ok(()),
        (Some(chain), Some(key)) => {
            check_certificate_file("sslcert", chain)?;
            let read = PrivateKeyDer::from_pem_file(Path::new(key));
            read.map(|_| ()).map_err(|error| format!("sslkey = '{key}': {error}"))
        }
        _ => Err("sslcert and sslkey must be used together".into()),
    }
}

/// Returns true if an option is a TLS option. Case is ignored here, because the driver would silently ignore `SSLMODE`.
fn is_tls_option(key: &str) -> bool {
    key.to_ascii_lowercase().starts_with("ssl")
}

/// Checks that a file contains at least one certificate.
fn check_certificate_file(key: &str, file: &str) -> Result<(), String> {
    let read = CertificateDer::pem_file_iter(Path::new(file)).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    match read {
        Ok(found) if found.is_empty() => Err(format!("{key} = '{file}' contains no certificate (PEM)")),
        Ok(_) => Ok(()),
        Err(error) => Err(format!("{key} = '{file}': {error}")),
    }
}

/// Describes a connection error, and adds advice if the driver's message is unclear.
pub fn connection_error(error: &sqlx::Error) -> String {
    let said = error.to_string();
    let advice = [
        (
            "UnknownIssuer",
            "the server's certificate was issued by an unknown certificate authority: specify the CA certificate with sslrootcert=FILE",
        ),
        ("not valid for name", "the server's certificate is for another host name: use that name in the URL"),
        ("CaUsedAsEndEntity", "the server uses a CA certificate as its own: issue a server certificate for its host name"),
        ("certificate expired", "the server's certificate has expired, or one of the clocks is wrong"),
        ("server does not support TLS", "enable TLS on the server (ssl = on), or use sslmode=disable on a trusted network"),
    ];
    match advice.iter().find(|(sign, _)| said.contains(sign)) {
        Some((_, advice)) => format!("{said} ({advice})"),
        None => said,
    }
}

/// Returns the URL of an SQLite file. SQLite creates the file if it is missing.
pub fn sqlite_url(file: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/._-~".contains(&byte);
    let encoded: String =
        file.bytes().map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect();
    format!("sqlite://{encoded}?mode=rwc")
}

/// Removes the password from a URL: `postgres://user:secret@host/db` becomes `postgres://user@host/db`.
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
    fn exact_invalid_tls_options_are_reported() {
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
            ("sslrootcert=/none.pem", "requires sslmode=verify-full"),
            ("sslmode=require&sslrootcert=/none.pem", "requires sslmode=verify-full"),
            ("sslmode=verify-full&sslrootcert=/none.pem", "sslrootcert = '/none.pem': "),
            (empty.as_str(), "contains no certificate (PEM)"),
            ("sslcert=/none.pem", "sslcert and sslkey must be used together"),
        ] {
            let wrong = check_tls_options(&format!("postgres://spandrel@db/training?{query}")).unwrap_err();
            assert!(wrong.contains(said), "{query}: {wrong}");
        }
        for good in
            ["postgres://db/t", "postgres://db/t?sslmode=require", "postgres://db/t?host=/run", "records.sqlite?sslmode=on"]
        {
            assert_eq!(check_tls_options(good), Ok(()), "{good}");
        }
    }
}
