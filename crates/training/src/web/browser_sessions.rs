//! Login sessions of browsers, identified by a cookie. The server stores them in memory under the hash of the cookie,
//! so neither a memory dump nor a log reveals a usable cookie. A restart logs everyone out. Callers pass the time and
//! random bytes.

use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Time after which an idle login session expires, µs: two hours, which keeps users logged in during a flight.
const IDLE_TIMEOUT_US: u64 = 2 * 3_600_000_000;
/// Time after which every login session expires, µs: one working day.
const MAX_SESSION_AGE_US: u64 = 12 * 3_600_000_000;
/// Maximum number of anonymous browser sessions. Limits the memory that clients without cookies can use.
const MAX_ANONYMOUS_SESSIONS: usize = 4_096;

/// Random bytes for a cookie or CSRF token.
pub type TokenBytes = [u8; 32];
/// Hash of password and role. A login session is valid only while it matches the user's current credential.
pub type CredentialHash = [u8; 32];

/// Login state of one browser.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BrowserSession {
    /// Name of the logged-in user, if any.
    pub name: Option<String>,
    /// Credential used for the login; `None` if not logged in.
    pub credential: Option<CredentialHash>,
    /// CSRF token included in every form.
    pub token: String,
    started_us: u64,
    last_used_us: u64,
}

impl BrowserSession {
    fn is_over(&self, now_us: u64) -> bool {
        now_us.saturating_sub(self.last_used_us) > IDLE_TIMEOUT_US || now_us.saturating_sub(self.started_us) > MAX_SESSION_AGE_US
    }
}

/// Login sessions of all browsers.
#[derive(Debug, Default)]
pub struct BrowserSessions(BTreeMap<[u8; 32], BrowserSession>);

/// Encodes a secret as text for a cookie, form or address.
#[must_use]
pub fn encode_token(secret: &TokenBytes) -> String {
    secret.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Number of hexadecimal digits at the beginning of a [`file_key`] with which its session is found.
const SESSION_DIGITS: usize = 16;

/// Returns the key with which a visitor's page loads one file without their cookie. `token` is the visitor's CSRF token.
#[must_use]
pub fn file_key(cookie: &str, token: &str, file: &str) -> String {
    file_key_of(&key(cookie), token, file)
}

fn file_key_of(session: &[u8; 32], token: &str, file: &str) -> String {
    let secret = encode_token(&Sha256::digest(format!("{token}/{file}").as_bytes()).into());
    format!("{}{secret}", &encode_token(session)[..SESSION_DIGITS])
}

fn key(cookie: &str) -> [u8; 32] {
    Sha256::digest(cookie.as_bytes()).into()
}

impl BrowserSessions {
    /// Returns the session for a cookie and extends it; `None` if there is none or it has expired.
    pub fn find(&mut self, cookie: &str, now_us: u64) -> Option<BrowserSession> {
        let key = key(cookie);
        let visit = self.0.get_mut(&key)?;
        if visit.is_over(now_us) {
            self.0.remove(&key);
            return None;
        }
        visit.last_used_us = now_us;
        Some(visit.clone())
    }

    /// Returns the session of the visitor who received this [`file_key`]; `None` if there is none or it has expired. The session is not
    /// extended, because the key can be passed on.
    #[must_use]
    pub fn find_by_file_key(&self, file: &str, given: &str, now_us: u64) -> Option<BrowserSession> {
        let first = u64::from_str_radix(given.get(..SESSION_DIGITS)?, 16).ok()?.to_be_bytes();
        let mut lowest = [0; 32];
        lowest[..first.len()].copy_from_slice(&first);
        let (key, visit) = self.0.range(lowest..).next()?;
        let is_owner = constant_time_eq(&file_key_of(key, &visit.token, file), given);
        (is_owner && !visit.is_over(now_us)).then(|| visit.clone())
    }

    /// Starts a session, either anonymous or after a login, and returns its cookie. Always creates a new cookie so that
    /// one planted before the login is useless afterward (session fixation).
    pub fn begin(
        &mut self,
        who: Option<(&str, CredentialHash)>,
        [cookie, token]: [TokenBytes; 2],
        now_us: u64,
    ) -> (String, BrowserSession) {
        if who.is_none() {
            self.evict_oldest(now_us);
        }
        let (name, credential) = who.map(|(name, credential)| (name.to_owned(), credential)).unzip();
        let visit = BrowserSession { name, credential, token: encode_token(&token), started_us: now_us, last_used_us: now_us };
        let cookie = encode_token(&cookie);
        self.0.insert(key(&cookie), visit.clone());
        (cookie, visit)
    }

    /// Ends the session for a cookie.
    pub fn end(&mut self, cookie: &str) {
        self.0.remove(&key(cookie));
    }

    /// Updates the credential of a login session so that users who change their own password stay logged in.
    pub fn update_credential(&mut self, cookie: &str, credential: CredentialHash) {
        if let Some(visit) = self.0.get_mut(&key(cookie)).filter(|visit| visit.name.is_some()) {
            visit.credential = Some(credential);
        }
    }

    /// Ends all sessions of a user after a password change or erasure, except the one with the given cookie.
    pub fn end_all_of(&mut self, name: &str, but: Option<&str>) {
        let kept = but.map(key);
        self.0.retain(|key, visit| visit.name.as_deref() != Some(name) || Some(*key) == kept);
    }

    /// Removes expired sessions and, above the limit, the anonymous sessions that have been idle longest.
    fn evict_oldest(&mut self, now_us: u64) {
        if self.0.len() < MAX_ANONYMOUS_SESSIONS {
            return;
        }
        self.0.retain(|_, visit| now_us.saturating_sub(visit.last_used_us) <= IDLE_TIMEOUT_US);
        let mut strangers: Vec<(u64, [u8; 32])> =
            self.0.iter().filter(|(_, visit)| visit.name.is_none()).map(|(key, visit)| (visit.last_used_us, *key)).collect();
        if strangers.len() >= MAX_ANONYMOUS_SESSIONS {
            strangers.sort_unstable();
            // Removes a quarter of them so that not every further anonymous request triggers a scan.
            for (_, key) in strangers.into_iter().take(MAX_ANONYMOUS_SESSIONS / 4) {
                self.0.remove(&key);
            }
        }
    }
}

/// Compares two strings in constant time, independent of how many characters match.
#[must_use]
pub fn constant_time_eq(a: &str, b: &str) -> bool {
    a.len() == b.len() && a.bytes().zip(b.bytes()).fold(0, |different, (x, y)| different | (x ^ y)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEST_CREDENTIAL: CredentialHash = [1; 32];

    fn secrets(k: u32) -> [TokenBytes; 2] {
        let mut a = [0; 32];
        a[..4].copy_from_slice(&k.to_le_bytes());
        [a, [7; 32]]
    }

    #[test]
    fn exact_browser_session_expires_when_idle_or_after_maximum_age() {
        let mut visits = BrowserSessions::default();
        let (cookie, visit) = visits.begin(Some(("anna", TEST_CREDENTIAL)), secrets(1), 0);
        assert_eq!(cookie.len(), 64);
        assert_eq!(visits.find(&cookie, IDLE_TIMEOUT_US).map(|visit| visit.name), Some(Some("anna".into())));
        assert_eq!(visits.find(&cookie, 2 * IDLE_TIMEOUT_US).map(|found| found.token), Some(visit.token));
        assert_eq!(visits.find(&cookie, 3 * IDLE_TIMEOUT_US + 1), None);
        let (cookie, _) = visits.begin(Some(("anna", TEST_CREDENTIAL)), secrets(2), 0);
        for k in 1..=6 {
            assert!(visits.find(&cookie, k * IDLE_TIMEOUT_US).is_some());
        }
        assert_eq!(visits.find(&cookie, MAX_SESSION_AGE_US + 1), None);
        assert_eq!(visits.find("", 0), None);
    }

    #[test]
    fn exact_file_key_is_for_one_file_and_ends_with_its_session() {
        let mut visits = BrowserSessions::default();
        let (cookie, visit) = visits.begin(Some(("anna", TEST_CREDENTIAL)), [[1; 32], [8; 32]], 0);
        visits.begin(Some(("ben", TEST_CREDENTIAL)), [[2; 32], [9; 32]], 0);
        let key = file_key(&cookie, &visit.token, "flight-1");
        let name = |visits: &BrowserSessions, file: &str, key: &str, now_us: u64| {
            visits.find_by_file_key(file, key, now_us).and_then(|visit| visit.name)
        };
        assert_eq!(name(&visits, "flight-1", &key, IDLE_TIMEOUT_US), Some("anna".into()));
        assert_eq!(name(&visits, "flight-1", &key, IDLE_TIMEOUT_US + 1), None, "its use does not extend the session");
        let zeros = "0".repeat(key.len());
        for wrong in ["", "é", &visit.token, &zeros, &key[..key.len() - 1], &key.replace(&key[16..18], "zz")] {
            assert_eq!(name(&visits, "flight-1", wrong, 1), None, "{wrong}");
        }
        assert_eq!(name(&visits, "flight-2", &key, 1), None);
        visits.end(&cookie);
        assert_eq!(name(&visits, "flight-1", &key, 1), None);
    }

    #[test]
    fn exact_password_change_ends_other_sessions_of_user() {
        let mut visits = BrowserSessions::default();
        let cookies =
            [("anna", 1), ("anna", 2), ("ben", 3)].map(|(name, k)| visits.begin(Some((name, TEST_CREDENTIAL)), secrets(k), 0).0);
        visits.end_all_of("anna", Some(&cookies[0]));
        assert_eq!(cookies.each_ref().map(|cookie| visits.find(cookie, 1).is_some()), [true, false, true]);
        visits.update_credential(&cookies[0], [2; 32]);
        let credential = |visits: &mut BrowserSessions, cookie: &str| visits.find(cookie, 1).and_then(|visit| visit.credential);
        assert_eq!(
            (credential(&mut visits, &cookies[0]), credential(&mut visits, &cookies[2])),
            (Some([2; 32]), Some(TEST_CREDENTIAL))
        );
        let (stranger, _) = visits.begin(None, secrets(4), 0);
        visits.update_credential(&stranger, TEST_CREDENTIAL);
        assert_eq!(credential(&mut visits, &stranger), None, "an anonymous session has no credential");
        visits.end(&cookies[0]);
        assert_eq!(visits.find(&cookies[0], 1), None);
    }

    #[test]
    fn prop_anonymous_sessions_are_bounded_and_evict_no_logins() {
        let mut visits = BrowserSessions::default();
        let (anna, _) = visits.begin(Some(("anna", TEST_CREDENTIAL)), secrets(u32::MAX), 0);
        for k in 0..20_000 {
            visits.begin(None, secrets(k), u64::from(k));
        }
        assert!(visits.0.len() <= MAX_ANONYMOUS_SESSIONS + 1, "{}", visits.0.len());
        assert!(visits.find(&anna, 20_000).is_some());
    }

    #[test]
    fn exact_constant_time_comparison_detects_differences() {
        assert!(constant_time_eq("ab", "ab") && constant_time_eq("", ""));
        assert!(!constant_time_eq("ab", "ac") && !constant_time_eq("ab", "abc") && !constant_time_eq("", "a"));
    }
}
