//! Failed logins: after a few for one name from one address, or many from one address, the next try has to wait.

use std::collections::BTreeMap;
use std::net::IpAddr;

/// Failures that are remembered for so long, µs.
const WINDOW_US: u64 = 15 * 60_000_000;
/// Failures in that time for one name from one address.
const OF_NAME: usize = 5;
/// Failures in that time from one address, whatever the names.
const OF_ADDRESS: usize = 20;
/// Addresses that are remembered; beyond it those that failed longest ago are forgotten.
const ADDRESSES: usize = 10_000;

/// Failed logins by address: when, and for which name.
#[derive(Debug, Default)]
pub struct Throttle(BTreeMap<IpAddr, Vec<(u64, String)>>);

impl Throttle {
    /// How long a login has to wait, µs; `None` when it may be tried.
    #[must_use]
    pub fn wait_us(&self, from: IpAddr, name: &str, now_us: u64) -> Option<u64> {
        let failures = self.0.get(&network(from))?;
        let recent = |wanted: &dyn Fn(&str) -> bool| -> Vec<u64> {
            failures.iter().filter(|(at, who)| now_us.saturating_sub(*at) < WINDOW_US && wanted(who)).map(|(at, _)| *at).collect()
        };
        let frees = |times: Vec<u64>, most: usize| {
            // It may be tried again once fewer than `most` are left in the window.
            times.len().checked_sub(most).map(|k| times[k] + WINDOW_US - now_us)
        };
        frees(recent(&|who| who == name), OF_NAME).max(frees(recent(&|_| true), OF_ADDRESS))
    }

    /// Notes a failure.
    pub fn failed(&mut self, from: IpAddr, name: &str, now_us: u64) {
        if self.0.len() >= ADDRESSES {
            self.forget(now_us);
        }
        let failures = self.0.entry(network(from)).or_default();
        failures.retain(|(at, _)| now_us.saturating_sub(*at) < WINDOW_US);
        // Names are the attacker's to choose; only their beginning is kept.
        failures.push((now_us, name.chars().take(64).collect()));
    }

    /// A login that went well clears its name.
    pub fn went_well(&mut self, from: IpAddr, name: &str) {
        if let Some(failures) = self.0.get_mut(&network(from)) {
            failures.retain(|(_, who)| who != name);
        }
    }

    fn forget(&mut self, now_us: u64) {
        let newest = |failures: &Vec<(u64, String)>| failures.last().map_or(0, |(at, _)| *at);
        self.0.retain(|_, failures| now_us.saturating_sub(newest(failures)) < WINDOW_US);
        if self.0.len() >= ADDRESSES
            && let Some(oldest) = self.0.iter().min_by_key(|(_, failures)| newest(failures)).map(|(address, _)| *address)
        {
            self.0.remove(&oldest);
        }
    }
}

/// One subscriber of IPv6 has a whole /64 of addresses.
fn network(from: IpAddr) -> IpAddr {
    match from.to_canonical() {
        IpAddr::V6(v6) => IpAddr::V6((v6.to_bits() >> 64 << 64).into()),
        v4 @ IpAddr::V4(_) => v4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn here() -> IpAddr {
        [127, 0, 0, 1].into()
    }

    #[test]
    fn exact_the_sixth_try_waits_until_the_first_failure_is_old() {
        let mut throttle = Throttle::default();
        for k in 0..5 {
            assert_eq!(throttle.wait_us(here(), "anna", k), None);
            throttle.failed(here(), "anna", k);
        }
        assert_eq!(throttle.wait_us(here(), "anna", 10), Some(WINDOW_US - 10));
        assert_eq!(throttle.wait_us(here(), "ben", 10), None, "another name");
        assert_eq!(throttle.wait_us([10, 0, 0, 1].into(), "anna", 10), None, "anna herself, elsewhere");
        assert_eq!(throttle.wait_us(here(), "anna", WINDOW_US), None);
        throttle.went_well(here(), "anna");
        assert_eq!(throttle.wait_us(here(), "anna", 10), None);
    }

    #[test]
    fn exact_many_names_from_one_address_wait_together() {
        let mut throttle = Throttle::default();
        for k in 0..20 {
            assert_eq!(throttle.wait_us(here(), &format!("n{k}"), 0), None, "{k}");
            throttle.failed(here(), &format!("n{k}"), 0);
        }
        assert_eq!(throttle.wait_us(here(), "one-more", 1), Some(WINDOW_US - 1));
    }

    #[test]
    fn exact_a_subscribers_addresses_count_as_one() {
        let at = |last: u16| IpAddr::from([0x2001, 0xdb8, 0, 1, 0, 0, 0, last]);
        assert_eq!(network(at(1)), network(at(2)));
        assert_eq!(network("::ffff:10.0.0.1".parse().unwrap()), IpAddr::from([10, 0, 0, 1]));
    }

    #[test]
    fn prop_many_addresses_fill_no_memory() {
        let mut throttle = Throttle::default();
        for k in 0..30_000u32 {
            throttle.failed(IpAddr::from(k.to_be_bytes()), "x", u64::from(k));
        }
        assert!(throttle.0.len() <= ADDRESSES);
    }
}
