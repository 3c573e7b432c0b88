//! Other vehicles at the site, from the vehicle's reports, at the moment to draw.

use spandrel_mavlink::contract::other_drones::{MAX_OTHERS, OtherDrone};
use spandrel_model::time::SimTime;
use std::collections::VecDeque;

/// Time for which reports are kept.
const KEPT: SimTime = SimTime::from_ms(1_000);
/// Age at which a report that was not followed by another one is out of date.
const TIMEOUT: SimTime = SimTime::from_ms(500);

/// Recent reports on other vehicles, oldest first.
#[derive(Debug, Clone, Default)]
pub struct OtherTraces(VecDeque<(SimTime, Vec<OtherDrone>)>);

impl OtherTraces {
    /// Adds a report. One that is not newer than the last is ignored.
    pub fn push(&mut self, time: SimTime, mut others: Vec<OtherDrone>) {
        if self.0.back().is_some_and(|(last, _)| *last >= time) {
            return;
        }
        others.truncate(MAX_OTHERS);
        self.0.retain(|(old, _)| *old + KEPT >= time);
        self.0.push_back((time, others));
    }

    /// Returns the other vehicles at a time, interpolated between two reports.
    #[must_use]
    pub fn at(&self, at: SimTime) -> Vec<OtherDrone> {
        let next = self.0.partition_point(|(time, _)| *time <= at);
        let Some((from, before)) = next.checked_sub(1).and_then(|k| self.0.get(k)) else {
            return Vec::new();
        };
        let Some((to, after)) = self.0.get(next) else {
            return if at <= *from + TIMEOUT { before.clone() } else { Vec::new() };
        };
        let share = (at - *from).s() / (*to - *from).s();
        let between = |one: &OtherDrone| {
            let other = after.iter().find(|other| other.system_id == one.system_id)?;
            let (offset_m, attitude) = (one.offset_m.lerp(other.offset_m, share), one.attitude.lerp(other.attitude, share));
            Some(OtherDrone { offset_m, attitude, ..*one })
        };
        before.iter().filter_map(between).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::frames::{Rotation, Vec3};

    fn drone(system_id: u8, north_m: f64) -> OtherDrone {
        OtherDrone { system_id, armed: true, offset_m: Vec3::new(north_m, 0.0, 0.0), attitude: Rotation::identity() }
    }

    #[test]
    fn exact_positions_are_interpolated_and_expire() {
        let ms = SimTime::from_ms;
        let mut traces = OtherTraces::default();
        assert_eq!(traces.at(ms(10)), []);
        traces.push(ms(100), vec![drone(2, 1.0), drone(3, 0.0)]);
        traces.push(ms(200), vec![drone(2, 3.0)]);
        traces.push(ms(150), vec![drone(2, 90.0)]);
        assert_eq!(traces.at(ms(50)), []);
        assert_eq!(traces.at(ms(125)), [drone(2, 1.5)], "system 3 is gone");
        assert_eq!(traces.at(ms(400)), [drone(2, 3.0)]);
        assert_eq!(traces.at(ms(701)), []);
    }
}
