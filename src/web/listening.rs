//! The server's listening settings.

use ipnet::IpNet;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;

/// Listening address, TLS files, and proxy settings.
#[derive(Debug, Clone)]
pub struct ListenConfig {
    /// Address and port to listen on; 0 for any free port
    pub listen: SocketAddr,
    /// TLS certificate chain, PEM
    pub tls_cert: Option<PathBuf>,
    /// Private key of the certificate, PEM
    pub tls_key: Option<PathBuf>,
    /// A reverse proxy terminates TLS, sets X-Forwarded-For and forwards the Host header; the server must be reachable
    /// only through the proxy
    pub behind_proxy: bool,
    /// The proxy's addresses or networks, such as 10.0.0.2 or 10.0.0.0/24; this machine by default
    pub trusted_proxy: Vec<IpNet>,
    /// Host names that browsers may use for the server; localhost and IP addresses are always accepted
    pub host: Vec<String>,
}

impl ListenConfig {
    /// Returns the settings for connections from this machine only.
    pub fn local(port: u16) -> Self {
        let listen = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
        let (trusted_proxy, host) = (Vec::new(), Vec::new());
        Self { listen, tls_cert: None, tls_key: None, behind_proxy: false, trusted_proxy, host }
    }
}
