//! Where a request comes from: a page of ours, and which address.

use super::Guard;
use crate::app::web::answer::Refusal;
use axum::http::HeaderMap;
use std::net::IpAddr;

impl Guard {
    /// A request that changes something comes from a page of ours, as far as the browser tells; and one to a server without passwords is
    /// addressed to this machine by a name that no other site can take over (DNS rebinding).
    ///
    /// # Errors
    /// When it does not.
    pub fn check_origin(&self, headers: &HeaderMap, changes: bool, open: bool) -> Result<(), Refusal> {
        let text = |name: &str| headers.get(name).and_then(|value| value.to_str().ok());
        let host = text("host").unwrap_or_default();
        if open && !is_this_machine(host) {
            return Err(Refusal::Forbidden("Without a password the server answers to localhost and 127.0.0.1 alone.".into()));
        }
        if !changes {
            return Ok(());
        }
        let site = text("sec-fetch-site").is_none_or(|site| site == "same-origin" || site == "none");
        let origin = text("origin").is_none_or(|origin| origin.split_once("://").is_some_and(|(_, from)| from == host));
        if site && origin {
            return Ok(());
        }
        Err(Refusal::Forbidden("This request comes from another site.".into()))
    }

    /// Who sends: the socket's address, or what the proxy says.
    pub fn address(&self, socket: IpAddr, headers: &HeaderMap) -> IpAddr {
        let forwarded = || {
            // The last address is the one that our own proxy saw; those before it are the sender's to choose.
            let all = headers.get_all("x-forwarded-for").iter().next_back()?.to_str().ok()?;
            all.rsplit(',').next()?.trim().parse().ok()
        };
        if self.behind_proxy { forwarded().unwrap_or(socket) } else { socket }
    }
}

/// A Host header that names this machine: no DNS can answer for it.
fn is_this_machine(host: &str) -> bool {
    let name = match host.strip_prefix('[') {
        Some(rest) => rest.split(']').next().unwrap_or_default(),
        None => host.split(':').next().unwrap_or_default(),
    };
    name.eq_ignore_ascii_case("localhost") || name.parse::<IpAddr>().is_ok_and(|address| address.is_loopback())
}

#[cfg(test)]
mod tests {
    use super::*;
    use axum::http::header;

    fn headers(pairs: &[(&'static str, &str)]) -> HeaderMap {
        pairs.iter().map(|(name, value)| (header::HeaderName::from_static(name), value.parse().unwrap())).collect()
    }

    #[test]
    fn exact_other_sites_and_other_names_are_turned_away() {
        let guard = Guard::new(false, false, false);
        let ok = |pairs: &[(&'static str, &str)], changes, open| guard.check_origin(&headers(pairs), changes, open).is_ok();
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
            "a link from elsewhere may be followed"
        );
    }

    #[test]
    fn exact_only_behind_a_proxy_its_word_is_taken() {
        let socket: IpAddr = [127, 0, 0, 1].into();
        let forwarded = headers(&[("x-forwarded-for", "1.1.1.1, 10.0.0.7")]);
        assert_eq!(Guard::new(true, false, false).address(socket, &forwarded), socket);
        assert_eq!(Guard::new(true, true, true).address(socket, &forwarded), IpAddr::from([10, 0, 0, 7]));
        assert_eq!(Guard::new(true, true, true).address(socket, &headers(&[])), socket);
    }
}
