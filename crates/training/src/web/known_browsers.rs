//! Browsers from which a user has logged in before, similar to OWASP's device cookies. Their failed logins are counted
//! separately from those of their IP address, so others at the same address cannot lock the user out. The server stores
//! them in memory as a hash of cookie and name. After a restart, a browser is unknown until the next login. Callers
//! pass the time and random bytes.

use super::browser_sessions::{TokenBytes, encode_token};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Time without a login after which a browser is forgotten, µs: 90 days, longer than a break between courses.
const BROWSER_EXPIRY_US: u64 = 90 * 24 * 3_600_000_000;
/// Maximum number of known browsers. Beyond it, the browser with the oldest login is forgotten.
const MAX_KNOWN_BROWSERS: usize = 10_000;

/// Hash that identifies a known browser of one user.
pub type KnownBrowser = [u8; 32];

/// Known browsers with the time of their last login, µs.
#[derive(Debug, Default)]
pub struct KnownBrowsers(BTreeMap<KnownBrowser, u64>);

impl KnownBrowsers {
    /// Returns the browser with this cookie if `name` has logged in from it before.
    #[must_use]
    pub fn find(&self, cookie: &str, name: &str, now_us: u64) -> Option<KnownBrowser> {
        let device = browser_key(cookie, name);
        self.0.get(&device).filter(|login_us| now_us.saturating_sub(**login_us) < BROWSER_EXPIRY_US).map(|_| device)
    }

    /// Records a login by `name` and returns the cookie to set: the existing one for a known browser, otherwise a new
    /// one.
    pub fn remember(&mut self, cookie: Option<&str>, name: &str, secret: &TokenBytes, now_us: u64) -> String {
        let known = cookie.filter(|cookie| self.find(cookie, name, now_us).is_some());
        let cookie = known.map_or_else(|| encode_token(secret), str::to_owned);
        self.0.insert(browser_key(&cookie, name), now_us);
        if self.0.len() > MAX_KNOWN_BROWSERS
            && let Some(oldest) = self.0.iter().min_by_key(|(_, login_us)| **login_us).map(|(device, _)| *device)
        {
            self.0.remove(&oldest);
        }
        cookie
    }
}

fn browser_key(cookie: &str, name: &str) -> KnownBrowser {
    // Cookies contain no zero bytes, so different pairs of cookie and name never produce the same input.
    Sha256::new().chain_update(cookie).chain_update([0]).chain_update(name).finalize().into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_browser_is_remembered_per_user() {
        let mut devices = KnownBrowsers::default();
        let cookie = devices.remember(None, "anna", &[1; 32], 0);
        assert!(devices.find(&cookie, "anna", BROWSER_EXPIRY_US - 1).is_some());
        assert_eq!(devices.find(&cookie, "anna", BROWSER_EXPIRY_US), None);
        assert_eq!(devices.find(&cookie, "ben", 1), None);
        assert_eq!(devices.find("guessed", "anna", 1), None);
        assert_eq!(devices.remember(Some(&cookie), "anna", &[2; 32], 1), cookie, "a known browser keeps its cookie");
        assert_ne!(devices.remember(Some("planted"), "anna", &[3; 32], 1), "planted");
        assert!(devices.find(&cookie, "anna", BROWSER_EXPIRY_US).is_some(), "a login restarts the expiry");
    }

    #[test]
    fn prop_known_browsers_are_bounded() {
        let mut devices = KnownBrowsers::default();
        for k in 0..MAX_KNOWN_BROWSERS as u32 + 100 {
            let mut secret = [0; 32];
            secret[..4].copy_from_slice(&k.to_le_bytes());
            devices.remember(None, "anna", &secret, u64::from(k));
        }
        assert_eq!(devices.0.len(), MAX_KNOWN_BROWSERS);
    }
}
