//! Throttling of failed logins. After a few failures for one name from one address, or many failures from one address,
//! each further attempt must wait longer, up to one minute. A longer lockout would let others behind the same address
//! lock out a user. A one-minute wait allows about 60 guesses per hour against passwords that `login::check` accepts. A
//! browser from which the user has logged in before is counted separately ([`super::known_browsers`]), so failures by
//! others at the same address don't delay it.

use super::known_browsers::KnownBrowser;
use std::collections::BTreeMap;
use std::net::IpAddr;

/// Time for which failures are remembered, µs.
const FAILURE_WINDOW_US: u64 = 15 * 60_000_000;
/// First wait after the limit is reached, µs; doubles with each further failure (estimate: long enough to slow down
/// guessing, short enough after a typo).
const FIRST_WAIT_US: u64 = 4_000_000;
/// Maximum wait between two attempts, µs.
const MAX_WAIT_US: u64 = 60_000_000;
/// Failures allowed per window for one name from one address.
const MAX_FAILURES_PER_NAME: usize = 5;
/// Failures allowed per window from one address, across all names.
const MAX_FAILURES_PER_ADDRESS: usize = 20;
/// Maximum number of stored origins. At the limit, the origin with the oldest failure is forgotten.
const MAX_ORIGINS: usize = 10_000;

/// Origin of a login attempt. Failures are counted per origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum LoginOrigin {
    /// An address or, for IPv6, a network.
    Network(IpAddr),
    /// A browser from which the user has logged in before.
    Known(KnownBrowser),
}

impl LoginOrigin {
    /// Returns the browser if it is known, otherwise the network of the address.
    #[must_use]
    pub fn for_address(from: IpAddr, known: Option<KnownBrowser>) -> Self {
        known.map_or_else(|| Self::Network(network(from)), Self::Known)
    }
}

/// Times and names of failed logins, by origin.
#[derive(Debug, Default)]
pub struct LoginThrottle(BTreeMap<LoginOrigin, Vec<(u64, String)>>);

impl LoginThrottle {
    /// Returns the wait before the next login attempt in µs; `None` if it may be made immediately.
    #[must_use]
    pub fn wait_us(&self, from: LoginOrigin, name: &str, now_us: u64) -> Option<u64> {
        let failures = self.0.get(&from)?;
        let recent: Vec<&(u64, String)> =
            failures.iter().filter(|(at, _)| now_us.saturating_sub(*at) < FAILURE_WINDOW_US).collect();
        let left = |times: Vec<u64>, most: usize| {
            let waits_until = times.last()?.saturating_add(wait_after(times.len().checked_sub(most)?));
            waits_until.checked_sub(now_us).filter(|left| *left > 0)
        };
        let of_name = recent.iter().filter(|(_, who)| *who == truncate_name(name)).map(|(at, _)| *at).collect();
        left(of_name, MAX_FAILURES_PER_NAME).max(left(recent.iter().map(|(at, _)| *at).collect(), MAX_FAILURES_PER_ADDRESS))
    }

    /// Records a failed login.
    pub fn record_failure(&mut self, from: LoginOrigin, name: &str, now_us: u64) {
        if self.0.len() >= MAX_ORIGINS {
            self.evict_oldest(now_us);
        }
        let failures = self.0.entry(from).or_default();
        failures.retain(|(at, _)| now_us.saturating_sub(*at) < FAILURE_WINDOW_US);
        failures.push((now_us, truncate_name(name)));
    }

    /// Clears the failures of a name after a successful login.
    pub fn clear_failures(&mut self, from: LoginOrigin, name: &str) {
        if let Some(failures) = self.0.get_mut(&from) {
            let name = truncate_name(name);
            failures.retain(|(_, who)| *who != name);
        }
    }

    fn evict_oldest(&mut self, now_us: u64) {
        let newest = |failures: &Vec<(u64, String)>| failures.last().map_or(0, |(at, _)| *at);
        self.0.retain(|_, failures| now_us.saturating_sub(newest(failures)) < FAILURE_WINDOW_US);
        if self.0.len() >= MAX_ORIGINS
            && let Some(oldest) = self.0.iter().min_by_key(|(_, failures)| newest(failures)).map(|(address, _)| *address)
        {
            self.0.remove(&oldest);
        }
    }
}

/// Returns the wait in µs for the given number of failures above the limit.
fn wait_after(beyond: usize) -> u64 {
    let doublings = u32::try_from(beyond).unwrap_or(u32::MAX);
    FIRST_WAIT_US.checked_shl(doublings).filter(|wait| *wait >= FIRST_WAIT_US).map_or(MAX_WAIT_US, |wait| wait.min(MAX_WAIT_US))
}

/// Truncates a name for storage because an attacker controls its length.
fn truncate_name(name: &str) -> String {
    name.chars().take(64).collect()
}

/// Returns the network of an address; an IPv6 subscriber gets an entire /64.
fn network(from: IpAddr) -> IpAddr {
    match from.to_canonical() {
        IpAddr::V6(v6) => IpAddr::V6((v6.to_bits() >> 64 << 64).into()),
        v4 @ IpAddr::V4(_) => v4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn localhost() -> LoginOrigin {
        LoginOrigin::for_address([127, 0, 0, 1].into(), None)
    }

    #[test]
    fn regress_login_wait_doubles_up_to_a_minute() {
        let mut throttle = LoginThrottle::default();
        for k in 0..5 {
            assert_eq!(throttle.wait_us(localhost(), "anna", k), None);
            throttle.record_failure(localhost(), "anna", k);
        }
        assert_eq!(throttle.wait_us(localhost(), "anna", 4), Some(FIRST_WAIT_US));
        assert_eq!(throttle.wait_us(localhost(), "ben", 10), None, "other names are not delayed");
        assert_eq!(
            throttle.wait_us(LoginOrigin::for_address([10, 0, 0, 1].into(), None), "anna", 10),
            None,
            "other addresses are not delayed"
        );
        assert_eq!(throttle.wait_us(localhost(), "anna", 4 + FIRST_WAIT_US), None);
        let mut now_us = 4;
        let waits: Vec<u64> = (0..6)
            .map(|_| {
                let wait_us = throttle.wait_us(localhost(), "anna", now_us).unwrap_or_default();
                now_us += wait_us;
                throttle.record_failure(localhost(), "anna", now_us);
                wait_us / 1_000_000
            })
            .collect();
        assert_eq!(waits, [4, 8, 16, 32, 60, 60]);
        throttle.clear_failures(localhost(), "anna");
        assert_eq!(throttle.wait_us(localhost(), "anna", now_us), None);
    }

    #[test]
    fn exact_login_waits_double_up_to_maximum() {
        for (beyond, wait_us) in [(0, 4_000_000), (1, 8_000_000), (4, MAX_WAIT_US), (63, MAX_WAIT_US), (usize::MAX, MAX_WAIT_US)]
        {
            assert_eq!(wait_after(beyond), wait_us, "{beyond}");
        }
    }

    #[test]
    fn regress_known_browser_is_throttled_separately() {
        let mut throttle = LoginThrottle::default();
        let known = LoginOrigin::for_address([127, 0, 0, 1].into(), Some([7; 32]));
        (0..30).for_each(|_| throttle.record_failure(localhost(), "anna", 0));
        assert_eq!(throttle.wait_us(localhost(), "anna", 1), Some(MAX_WAIT_US - 1), "an unknown browser at the same address");
        assert_eq!(throttle.wait_us(known, "anna", 1), None, "a known browser");
        (0..MAX_FAILURES_PER_NAME).for_each(|_| throttle.record_failure(known, "anna", 1));
        assert_eq!(throttle.wait_us(known, "anna", 1), Some(FIRST_WAIT_US), "guessing with a stolen cookie");
    }

    #[test]
    fn exact_failures_for_many_names_throttle_address() {
        let mut throttle = LoginThrottle::default();
        for k in 0..20 {
            assert_eq!(throttle.wait_us(localhost(), &format!("n{k}"), 0), None, "{k}");
            throttle.record_failure(localhost(), &format!("n{k}"), 0);
        }
        assert_eq!(throttle.wait_us(localhost(), "one-more", 1), Some(FIRST_WAIT_US - 1));
    }

    #[test]
    fn exact_ipv6_network_counts_as_one_origin() {
        let at = |last: u16| IpAddr::from([0x2001, 0xdb8, 0, 1, 0, 0, 0, last]);
        assert_eq!(network(at(1)), network(at(2)));
        assert_eq!(network("::ffff:10.0.0.1".parse().unwrap()), IpAddr::from([10, 0, 0, 1]));
    }

    #[test]
    fn prop_login_throttle_is_bounded() {
        let mut throttle = LoginThrottle::default();
        for k in 0..30_000u32 {
            throttle.record_failure(LoginOrigin::for_address(k.to_be_bytes().into(), None), "x", u64::from(k));
        }
        assert!(throttle.0.len() <= MAX_ORIGINS);
    }
}
