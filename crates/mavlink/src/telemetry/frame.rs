//! Resamples a flight at the scoring rate f. Frame i covers the 1/f s up to its time; frame 1 is at lift-off.

use super::timeline::Flight;
use crate::contract::contact::ContactKind;
use crate::contract::truth::Truth;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::pose::Motion;
use spandrel_model::time::SimTime;

/// Minimum interval between truth messages that counts as a gap (docs/src/reference/assessment.md, "Frames").
pub const MIN_GAP: SimTime = SimTime::from_ms(200);
/// Maximum length of an interpolated gap. Frames in longer gaps are missing.
pub const MAX_INTERPOLATED_GAP: SimTime = SimTime::from_ms(1_000);
/// Maximum delay of a `contact` message after the `hits` message that counts it (`contact` is repeated at 10 Hz).
const MAX_CONTACT_DELAY: SimTime = SimTime::from_ms(200);

/// A scoring frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Frame number, from 1.
    pub index: u32,
    /// Simulation time at this instant.
    pub time: SimTime,
    /// Stick positions: forward, right, up, clockwise, each in [-1, 1].
    pub sticks: [f64; 4],
    /// Whether the lamp is on.
    pub light: bool,
    /// Whether a photo was taken since the previous frame.
    pub snapshot: bool,
    /// Position in the scenario frame, m.
    pub position_m: Vec3<Enu>,
    /// Velocity in the scenario frame, m/s.
    pub velocity_m_s: Vec3<Enu>,
    /// Remaining battery charge, 0 to 100%.
    pub battery_pct: f64,
    /// Most severe contact since the previous frame.
    pub contact: ContactKind,
    /// Whether the frame is in a gap that is too long to interpolate.
    pub missing: bool,
    /// Whether the frame is in an interpolated gap.
    pub interpolated: bool,
    /// Distance to the nearest surface, m; `None` if not received yet.
    pub clearance_m: Option<f64>,
    /// Whether the motors are armed; `None` if not received yet.
    pub armed: Option<bool>,
    /// Whether the autopilot reports that the aircraft is on the ground.
    pub on_ground: bool,
}

impl Frame {
    /// Returns the magnitude of the velocity in m/s.
    #[must_use]
    pub fn speed_m_s(&self) -> f64 {
        self.velocity_m_s.norm()
    }
}

/// Aircraft state at a time between two truth messages.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InterpolatedState {
    /// Motion, with the attitude from the preceding sample.
    pub motion: Motion<Enu>,
    /// Whether the time is in a gap that is too long to interpolate.
    pub missing: bool,
    /// Whether the time is in an interpolated gap.
    pub interpolated: bool,
}

impl Flight {
    /// Returns the first time at which the aircraft was more than `height_m` above the pad. `pad_height_m` is the pad's
    /// height in the scenario frame, m.
    #[must_use]
    pub fn lift_off(&self, pad_height_m: f64, height_m: f64) -> Option<SimTime> {
        self.truths.iter().find(|truth| truth.motion.position_m.up() - pad_height_m > height_m).map(|truth| truth.time)
    }

    /// Returns the time of the last truth message.
    #[must_use]
    pub fn end(&self) -> Option<SimTime> {
        self.truths.last().map(|truth| truth.time)
    }

    /// Returns the aircraft state at `time`. Before the first truth message or after the last one, returns that
    /// message's state. `None` if there are no truth messages.
    #[must_use]
    pub fn between(&self, time: SimTime) -> Option<InterpolatedState> {
        let after = self.truths.partition_point(|truth| truth.time <= time);
        let before = self.truths[after.saturating_sub(1)..].first()?;
        let next = self.truths.get(after).filter(|_| after > 0);
        let held = |missing| InterpolatedState { motion: before.motion, missing, interpolated: false };
        let Some(next) = next else { return Some(held(false)) };
        let span = next.time - before.time;
        if before.time == time {
            return Some(held(false));
        }
        if span > MAX_INTERPOLATED_GAP {
            return Some(held(true));
        }
        if self.was_moved_between(before, next) {
            return Some(held(false));
        }
        let t = (time - before.time).ns() as f64 / span.ns() as f64;
        Some(InterpolatedState {
            motion: before.motion.lerp_with_held_attitude(&next.motion, t),
            interpolated: span > MIN_GAP,
            ..held(false)
        })
    }

    /// Returns whether the simulator moved the aircraft between two messages: by a respawn or a rewind.
    fn was_moved_between(&self, before: &Truth, next: &Truth) -> bool {
        // The respawn message may have been lost.
        if before.jumps_to(next) {
            return true;
        }
        let has_respawned = self.respawns.at(before.time) != self.respawns.at(next.time);
        has_respawned && self.respawns.at(before.time).is_some() || self.was_rewound_between(before.time, next.time)
    }

    /// Returns whether the flight was rewound between two times.
    #[must_use]
    pub fn was_rewound_between(&self, from: SimTime, to: SimTime) -> bool {
        // The vehicle does not send the number before the first rewind.
        self.rewinds.at(from).unwrap_or(0) < self.rewinds.at(to).unwrap_or(0)
    }

    /// Returns the frame at `time` with the events since `since`; `None` if there are no truth messages.
    #[must_use]
    pub fn frame(&self, index: u32, since: SimTime, time: SimTime) -> Option<Frame> {
        let between = self.between(time)?;
        Some(Frame {
            index,
            time,
            sticks: self.sticks.at(time).unwrap_or_default(),
            light: self.light.at(time).unwrap_or(false),
            snapshot: !self.snapshots.between(since, time).is_empty(),
            position_m: between.motion.position_m,
            velocity_m_s: between.motion.velocity_m_s,
            // The battery counts as full until its level is received.
            battery_pct: self.battery.at(time).unwrap_or(100.0),
            contact: if between.missing { ContactKind::None } else { self.contact_in(since, time) },
            missing: between.missing,
            interpolated: between.interpolated,
            clearance_m: self.clearance.at(time),
            armed: self.armed.at(time),
            on_ground: self.on_ground.at(time).unwrap_or(false),
        })
    }

    /// Returns the contact at `time`, or the most severe contact that started since `since`.
    fn contact_in(&self, since: SimTime, time: SimTime) -> ContactKind {
        let changes = self.contact.between(since, time);
        let now = self.contact.at(time).unwrap_or_default();
        changes.iter().map(|change| change.2).fold(now, ContactKind::more_severe)
    }

    /// Returns the times at which `hits` increased without a corresponding `contact` message, which indicates a lost
    /// message.
    #[must_use]
    pub fn missed_contacts(&self) -> Vec<SimTime> {
        let mut lost = Vec::new();
        let mut accounted = None;
        let mut onsets = ContactOnsets::default();
        for (time, _, count) in self.hits.all() {
            let surplus = i64::from(*count) - onsets.until(self, *time + MAX_CONTACT_DELAY);
            match accounted {
                // Contacts counted before the first message do not belong to this flight.
                None => accounted = Some(surplus.max(0)),
                Some(known) if surplus > known => {
                    lost.push(*time);
                    accounted = Some(surplus);
                }
                Some(_) => {}
            }
        }
        lost
    }
}

/// Running count of the contacts in the `contact` signal.
#[derive(Default)]
struct ContactOnsets {
    read: usize,
    touching: bool,
    count: i64,
}

impl ContactOnsets {
    fn until(&mut self, flight: &Flight, time: SimTime) -> i64 {
        while let Some((_, _, now)) = flight.contact.all().get(self.read).filter(|point| point.0 <= time) {
            let touching = *now != ContactKind::None;
            self.count += i64::from(touching && !self.touching);
            self.touching = touching;
            self.read += 1;
        }
        self.count
    }
}
