//! Which sensors still say something, and what is told when one falls silent.

use super::core::{Autopilot, Severity};
use crate::base::time::SimTime;
use crate::sitl::sensors::Readings;

/// A sensor that is silent this long is missing, s (estimate: 25 readings of compass and barometer, fewer than a wink loses).
const SILENT_S: f64 = 0.5;

/// What the autopilot finds working.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Health {
    /// The compass gives readings.
    pub compass: bool,
    /// The barometer gives readings.
    pub barometer: bool,
    /// The vehicle turns as it is told.
    pub obeys: bool,
}

impl Health {
    /// All is well.
    pub const GOOD: Self = Self { compass: true, barometer: true, obeys: true };
}

/// When each sensor spoke last; the clock begins with the first look.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Senses {
    compass: Option<SimTime>,
    barometer: Option<SimTime>,
}

impl Senses {
    fn silent(heard: &mut Option<SimTime>, speaks: bool, now: SimTime) -> bool {
        let since = heard.get_or_insert(now);
        if speaks {
            *since = now;
        }
        (now - *since).s() > SILENT_S
    }
}

impl Autopilot {
    /// Notes who speaks; a sensor that falls silent or comes back is told once.
    pub(super) fn listen(&mut self, readings: &Readings, now: SimTime) {
        let senses = &mut self.senses;
        let compass = !Senses::silent(&mut senses.compass, readings.mag_gauss.is_some(), now);
        let barometer = !Senses::silent(&mut senses.barometer, readings.baro_up_m.is_some(), now);
        let before = self.status.health;
        self.status.health = Health { compass, barometer, ..before };
        self.tell_change(before.compass, compass, "Compass");
        self.tell_change(before.barometer, barometer, "Barometer");
    }

    fn tell_change(&mut self, before: bool, now: bool, name: &str) {
        match (before, now) {
            (true, false) => self.say(Severity::Critical, format!("{name} lost: no readings")),
            (false, true) => self.say(Severity::Info, format!("{name} is back")),
            _ => {}
        }
    }

    /// Sensors whose silence forbids arming.
    pub(super) fn missing_sensors(&self) -> Vec<String> {
        let health = self.status.health;
        let all = [(health.compass, "Compass missing"), (health.barometer, "Barometer missing")];
        all.into_iter().filter(|(works, _)| !works).map(|(_, why)| why.into()).collect()
    }
}
