//! TLS certificates, and the requirements for access from other machines.

use super::listening::ListenConfig;
use crate::errors::AppError;
use axum_server::tls_rustls::RustlsConfig;
use rustls::ServerConfig;
use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use std::path::Path;
use std::sync::Arc;

/// If other machines can reach the server, checks that it has a password and TLS.
///
/// # Errors
/// Returns an error if either is missing.
pub fn check(args: &ListenConfig, somebody_has_a_password: bool) -> Result<(), AppError> {
    let beyond = !args.listen.ip().is_loopback();
    if (beyond || args.behind_proxy) && !somebody_has_a_password {
        return Err(AppError::invalid(format!(
            "--listen {}: other machines could reach the server, but no password is set; first set one with \
             --set-password USER --role administrator",
            args.listen
        )));
    }
    if beyond && args.tls_cert.is_none() && !args.behind_proxy {
        return Err(AppError::invalid(format!(
            "--listen {}: passwords would be sent unencrypted; use --tls-cert and --tls-key, or --behind-proxy if a proxy \
             terminates TLS",
            args.listen
        )));
    }
    Ok(())
}

/// Returns the TLS configuration, or `None` without certificate files.
///
/// # Errors
/// Returns an error if a file cannot be read or does not contain a certificate or key.
pub fn config(args: &ListenConfig) -> Result<Option<RustlsConfig>, AppError> {
    let (Some(chain), Some(key)) = (&args.tls_cert, &args.tls_key) else { return Ok(None) };
    let wrong =
        |flag: &str, path: &Path, error: &dyn std::fmt::Display| AppError::invalid(format!("{flag} {}: {error}", path.display()));
    let certificates = CertificateDer::pem_file_iter(chain)
        .and_then(Iterator::collect::<Result<Vec<_>, _>>)
        .map_err(|error| wrong("--tls-cert", chain, &error))?;
    if certificates.is_empty() {
        return Err(wrong("--tls-cert", chain, &"the file contains no certificate (PEM)"));
    }
    let private = PrivateKeyDer::from_pem_file(key).map_err(|error| wrong("--tls-key", key, &error))?;
    let provider = Arc::new(rustls::crypto::ring::default_provider());
    let mut config = ServerConfig::builder_with_provider(provider)
        .with_safe_default_protocol_versions()
        .map_err(|error| AppError::failed(error.to_string()))?
        .with_no_client_auth()
        .with_single_cert(certificates, private)
        .map_err(|error| wrong("--tls-key", key, &error))?;
    config.alpn_protocols = vec![b"http/1.1".to_vec()];
    Ok(Some(RustlsConfig::from_config(Arc::new(config))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args(listen: &str, behind_proxy: bool) -> ListenConfig {
        ListenConfig { listen: listen.parse().unwrap(), behind_proxy, ..ListenConfig::local(0) }
    }

    #[test]
    fn exact_remote_access_requires_a_password_and_tls() {
        assert_eq!(check(&args("127.0.0.1:0", false), false), Ok(()));
        assert_eq!(check(&args("[::1]:0", false), false), Ok(()));
        assert_eq!(check(&args("0.0.0.0:0", true), true), Ok(()));
        for (bad, password, said) in [
            (args("0.0.0.0:0", true), false, "--set-password"),
            (args("127.0.0.1:0", true), false, "--set-password"),
            (args("192.168.1.2:0", false), true, "--tls-cert"),
        ] {
            assert!(check(&bad, password).unwrap_err().to_string().contains(said));
        }
        let tls =
            ListenConfig { tls_cert: Some("no-such.pem".into()), tls_key: Some("no-key.pem".into()), ..args("0.0.0.0:0", false) };
        assert_eq!(check(&tls, true), Ok(()));
        assert!(config(&tls).unwrap_err().to_string().contains("--tls-cert no-such.pem"));
        assert!(matches!(config(&args("127.0.0.1:0", false)), Ok(None)));
    }
}
