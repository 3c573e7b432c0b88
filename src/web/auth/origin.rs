//! Checks where requests come from: site, host name and client address.

use crate::web::response::WebError;
use axum::http::{HeaderMap, header};
use ipnet::IpNet;
use spandrel_text::{Language, text};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr};

/// Trusted proxies and the server's host names.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct AllowedOrigins {
    /// Proxies that terminate TLS; empty without a proxy. If there are proxies, all requests must come from them, and
    /// only their X-Forwarded-For header is trusted.
    pub proxies: Vec<IpNet>,
    /// This server's host names, in addition to localhost and IP addresses.
    pub hosts: Vec<String>,
}

impl AllowedOrigins {
    /// Returns the settings for a server behind these proxies, or behind a proxy on this machine if none are specified.
    pub fn behind_proxies(named: &[IpNet], hosts: &[String]) -> Self {
        let local = || vec![IpNet::from(IpAddr::from(Ipv4Addr::LOCALHOST)), IpNet::from(IpAddr::from(Ipv6Addr::LOCALHOST))];
        Self { proxies: if named.is_empty() { local() } else { named.to_vec() }, hosts: hosts.to_vec() }
    }

    fn is_trusted_proxy(&self, address: IpAddr) -> bool {
        self.proxies.iter().any(|proxy| proxy.contains(&address.to_canonical()))
    }

    /// Returns true for IP addresses, localhost and the configured names. Any other name may belong to another site
    /// (DNS rebinding).
    fn is_allowed_host(&self, host: &Host<'_>) -> bool {
        match host {
            Host::Address(_) => true,
            Host::Name(name) => {
                name.eq_ignore_ascii_case("localhost") || self.hosts.iter().any(|known| known.eq_ignore_ascii_case(name))
            }
        }
    }

    /// Checks that a request is addressed to this server. If it changes anything, also checks that it comes from one of
    /// the server's pages, as reported by the browser. A server without passwords accepts only requests to this
    /// machine's own names, which other sites cannot use (DNS rebinding).
    ///
    /// # Errors
    /// Returns an error if one of these checks fails.
    pub fn check_origin(&self, headers: &HeaderMap, changes: bool, open: bool, language: Language) -> Result<(), WebError> {
        let value = |name: &str| headers.get(name).and_then(|value| value.to_str().ok());
        let authority = authority(headers);
        let host = authority.and_then(Host::parse);
        let host = host.ok_or_else(|| WebError::Forbidden(text!(language, "web-error-host-header")))?;
        if open && !host.is_this_machine() {
            return Err(WebError::Forbidden(text!(language, "web-error-local-only")));
        }
        if !self.is_allowed_host(&host) {
            return Err(WebError::Forbidden(text!(language, "web-error-host-name")));
        }
        if !changes {
            return Ok(());
        }
        let site = value("sec-fetch-site").is_none_or(|site| site == "same-origin" || site == "none");
        let origin = value("origin").is_none_or(|origin| origin.split_once("://").map(|(_, from)| from) == authority);
        if site && origin {
            return Ok(());
        }
        Err(WebError::Forbidden(text!(language, "web-error-other-site")))
    }

    /// Returns the client's address: the socket's peer address or, behind a proxy, the last address in X-Forwarded-For
    /// that is not a trusted proxy.
    ///
    /// # Errors
    /// Returns an error if a proxy is required and the request does not come from one.
    pub fn address(&self, socket: IpAddr, headers: &HeaderMap, language: Language) -> Result<IpAddr, WebError> {
        if self.proxies.is_empty() {
            return Ok(socket);
        }
        if !self.is_trusted_proxy(socket) {
            return Err(WebError::Forbidden(text!(language, "web-error-proxy-only")));
        }
        let lines = headers.get_all("x-forwarded-for").iter().rev().map(|line| line.to_str().unwrap_or_default());
        // Each proxy appends the address that sent it the request; the client can forge everything before the last
        // untrusted address.
        for entry in lines.flat_map(|line| line.rsplit(',')) {
            match entry.trim().parse::<IpAddr>() {
                Ok(address) if self.is_trusted_proxy(address) => {}
                Ok(address) => return Ok(address),
                Err(_) => break,
            }
        }
        Ok(socket)
    }
}

/// Returns the value of the Host header if there is exactly one.
fn authority(headers: &HeaderMap) -> Option<&str> {
    let mut all = headers.get_all(header::HOST).iter();
    let only = all.next()?.to_str().ok()?;
    all.next().is_none().then_some(only)
}

/// Host name or address from a Host header (RFC 9110, 7.2), without the port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Host<'a> {
    Address(IpAddr),
    Name(&'a str),
}

impl<'a> Host<'a> {
    /// Parses a name or an address with an optional port; `None` for anything else.
    fn parse(authority: &'a str) -> Option<Self> {
        let (host, port) = match authority.strip_prefix('[') {
            Some(rest) => {
                let (address, port) = rest.split_once(']')?;
                (Self::Address(address.parse::<Ipv6Addr>().ok()?.into()), port)
            }
            None => {
                let (name, port) = authority.split_at(authority.find(':').unwrap_or(authority.len()));
                (Self::named(name)?, port)
            }
        };
        let plain = |digits: &str| digits.bytes().all(|b| b.is_ascii_digit()) && digits.parse::<u16>().is_ok();
        (port.is_empty() || port.strip_prefix(':').is_some_and(plain)).then_some(host)
    }

    fn named(name: &'a str) -> Option<Self> {
        if let Ok(address) = name.parse::<Ipv4Addr>() {
            return Some(Self::Address(address.into()));
        }
        is_host_name(name).then_some(Self::Name(name))
    }

    fn is_this_machine(&self) -> bool {
        match self {
            Self::Address(address) => address.to_canonical().is_loopback(),
            Self::Name(name) => name.eq_ignore_ascii_case("localhost"),
        }
    }
}

/// Returns true for a DNS name (RFC 1123): labels of letters, digits and inner hyphens.
pub fn is_host_name(name: &str) -> bool {
    let label = |label: &str| {
        let plain = label.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'-');
        plain && !label.is_empty() && label.len() <= 63 && !label.starts_with('-') && !label.ends_with('-')
    };
    name.len() <= 253 && name.split('.').all(label)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::web::auth::Authenticator;

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        let mut all = HeaderMap::new();
        for (name, value) in pairs {
            all.append(header::HeaderName::from_static(name), value.parse().unwrap());
        }
        all
    }

    fn named(hosts: &[&str]) -> Authenticator {
        let hosts = hosts.iter().map(|&host| host.to_owned()).collect();
        Authenticator::new(true, false, AllowedOrigins { hosts, ..AllowedOrigins::default() })
    }

    #[test]
    fn exact_other_sites_and_host_names_are_rejected() {
        let guard = named(&["trainer.example"]);
        let ok = |pairs: &[(&'static str, &str)], changes, open| {
            guard.check_origin(&headers(pairs), changes, open, Language::English).is_ok()
        };
        assert!(ok(&[("host", "127.0.0.1:8080")], true, true));
        assert!(ok(
            &[("host", "localhost:8080"), ("origin", "http://localhost:8080"), ("sec-fetch-site", "same-origin")],
            true,
            true
        ));
        assert!(ok(&[("host", "[::1]:8080")], false, true));
        for bad in [
            &[("host", "evil.example:8080")][..],
            &[("host", "localhost.evil.example")],
            &[],
            &[("host", "localhost:8080"), ("origin", "http://evil.example")],
            &[("host", "localhost:8080"), ("origin", "null")],
            &[("host", "localhost:8080"), ("sec-fetch-site", "cross-site")],
            &[("host", "localhost:8080"), ("sec-fetch-site", "same-site")],
        ] {
            assert!(!ok(bad, true, true), "{bad:?}");
        }
        assert!(ok(&[("host", "trainer.example"), ("origin", "https://trainer.example")], true, false));
        assert!(
            ok(&[("host", "trainer.example"), ("sec-fetch-site", "cross-site")], false, false),
            "links from other sites work"
        );
    }

    #[test]
    fn regress_invalid_host_headers_are_rejected() {
        let guard = named(&["trainer.example"]);
        let ok = |pairs: &[(&'static str, &str)]| guard.check_origin(&headers(pairs), false, false, Language::English).is_ok();
        for good in ["trainer.example", "TRAINER.example:8443", "10.0.0.7:8443", "[2001:db8::7]", "localhost:1"] {
            assert!(ok(&[("host", good)]), "{good}");
        }
        for bad in [
            "",
            "evil.example",
            "[::1]evil.example",
            "[::1",
            "[trainer.example]",
            "127.0.0.1@evil.example",
            "localhost:8080@evil",
            "localhost:",
            "localhost:x",
            "localhost:99999",
            "localhost:+80",
            "trainer.example.",
            "-trainer.example",
            "a b",
            "trainer.example/",
        ] {
            assert!(!ok(&[("host", bad)]), "{bad}");
        }
        assert!(!ok(&[("host", "localhost"), ("host", "localhost")]), "twice");
    }

    #[test]
    fn regress_forwarded_addresses_are_accepted_only_from_trusted_proxies() {
        let local: IpAddr = [127, 0, 0, 1].into();
        let (proxy, client): (IpAddr, IpAddr) = ([10, 0, 0, 2].into(), [203, 0, 113, 9].into());
        let forwarded = headers(&[("x-forwarded-for", "1.1.1.1, 203.0.113.9")]);
        let address = |reach: AllowedOrigins, socket, headers: &HeaderMap| {
            Authenticator::new(true, true, reach).address(socket, headers, Language::English).ok()
        };
        assert_eq!(address(AllowedOrigins::default(), local, &forwarded), Some(local), "without a proxy, the header is ignored");
        let here = AllowedOrigins::behind_proxies(&[], &[]);
        assert_eq!(address(here.clone(), local, &forwarded), Some(client));
        assert_eq!(address(here.clone(), IpAddr::from(Ipv4Addr::LOCALHOST.to_ipv6_mapped()), &forwarded), Some(client));
        assert_eq!(address(here.clone(), local, &headers(&[])), Some(local));
        assert_eq!(address(here.clone(), local, &headers(&[("x-forwarded-for", "1.1.1.1, nonsense")])), Some(local));
        assert_eq!(address(here, proxy, &forwarded), None, "a client that bypasses the proxy");
        let chain = AllowedOrigins::behind_proxies(&["10.0.0.0/24".parse().unwrap()], &[]);
        let through_two = headers(&[("x-forwarded-for", "1.1.1.1, 203.0.113.9"), ("x-forwarded-for", "10.0.0.3")]);
        assert_eq!(address(chain.clone(), proxy, &through_two), Some(client));
        assert_eq!(address(chain, local, &through_two), None);
    }
}
