//! From lift-off to the end: which frames a session has, and why it ended.

use super::measures::crash;
use crate::base::frames::{Enu, Vec3};
use crate::base::time::SimTime;
use crate::scenario::{AfterCrash, Scenario};
use crate::telemetry::{Contact, Flight, Frame};
use crate::vehicle::Vehicle;
use serde::Serialize;

/// Lift-off and landing height of the drone's centre over the pad, m (assessment.md, frames).
const LIFT_OFF_M: f64 = 0.3;
/// An aircraft whose centre stands higher than the rule's height lifts off this much over its stand, m (estimate).
const OVER_STAND_M: f64 = 0.05;
/// Slower than this is at rest, m/s (estimate: above the truth stream's resolution of 0.01 m/s, below any controlled drift).
const REST_M_S: f64 = 0.2;
/// At rest for this long is a landing (assessment.md, frames).
const REST_FOR: SimTime = SimTime::from_ms(3_000);

/// Why a session ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum EndReason {
    /// Landed near the ground team.
    Landed,
    /// Battery empty.
    Battery,
    /// Longest flight time passed.
    TimeLimit,
    /// Hit a person.
    Person,
    /// Hit a vehicle.
    Vehicle,
    /// A crash, where the scenario ends the session on any.
    Crash,
    /// Stopped by somebody, or the telemetry ends.
    Abort,
    /// The simulator was started anew in mid-flight.
    Restart,
}

/// What the end rule looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Simulation time.
    pub time: SimTime,
    /// Flight time that this moment completes, s.
    pub flown_s: f64,
    /// Position, m.
    pub position_m: Vec3<Enu>,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Contact after the pad rule.
    pub contact: Contact,
    /// Battery, %.
    pub battery_pct: f64,
    /// Armed, if known.
    pub armed: Option<bool>,
    /// The autopilot says that it stands.
    pub on_ground: bool,
}

/// Watches for the end, moment after moment. A landing counts from the moment at which the drone came to rest, so it is known only
/// when the rest has lasted, and what happens meanwhile (an empty battery) does not undo it.
#[derive(Debug, Clone, PartialEq)]
pub struct EndRule {
    pad_m: Vec3<Enu>,
    home_radius_m: f64,
    lift_off_m: f64,
    time_max_s: f64,
    crash_ends: bool,
    seen_armed: bool,
    rest_since: Option<SimTime>,
    pending: Option<(SimTime, EndReason)>,
}

impl EndRule {
    /// For one session.
    #[must_use]
    pub fn new(scenario: &Scenario, vehicle: &Vehicle) -> Self {
        Self {
            pad_m: scenario.ground_team.pad_m,
            home_radius_m: scenario.ground_team.home_radius_m,
            lift_off_m: lift_off_height_m(vehicle),
            time_max_s: scenario.scoring.time_max_s,
            crash_ends: scenario.rules.after_crash == AfterCrash::End,
            seen_armed: false,
            rest_since: None,
            pending: None,
        }
    }

    /// The end, when this moment decides it; the time is that of the last frame.
    pub fn see(&mut self, moment: &Moment) -> Option<(SimTime, EndReason)> {
        match moment.contact {
            Contact::Person => return Some((moment.time, EndReason::Person)),
            Contact::Vehicle => return Some((moment.time, EndReason::Vehicle)),
            Contact::Bridge | Contact::Terrain | Contact::Water | Contact::Other if self.crash_ends => {
                return Some((moment.time, EndReason::Crash));
            }
            Contact::None | Contact::Bridge | Contact::Terrain | Contact::Water | Contact::Other => {}
        }
        // The word `disarmed` is a second old at most, and means a landing only after the word `armed`.
        self.seen_armed |= moment.armed == Some(true);
        self.rest_since = self.rests_at_home(moment).then(|| self.rest_since.unwrap_or(moment.time));
        if let Some(since) = self.rest_since
            && (self.seen_armed && moment.armed == Some(false) || moment.time - since >= REST_FOR)
        {
            return Some((since, EndReason::Landed));
        }
        let over = if moment.battery_pct <= 0.0 {
            Some(EndReason::Battery)
        } else {
            (moment.flown_s > self.time_max_s).then_some(EndReason::TimeLimit)
        };
        self.pending = self.pending.or(over.map(|reason| (moment.time, reason)));
        if self.rest_since.is_none() { self.pending } else { None }
    }

    /// The end that was waiting for a landing to be confirmed, when no more moments come.
    #[must_use]
    pub fn pending(&self) -> Option<(SimTime, EndReason)> {
        self.pending
    }

    fn rests_at_home(&self, moment: &Moment) -> bool {
        let from_pad = moment.position_m - self.pad_m;
        let down = moment.on_ground || from_pad.up() < self.lift_off_m || moment.contact == Contact::Terrain;
        down && moment.speed_m_s < REST_M_S && from_pad.horizontal_norm() <= self.home_radius_m
    }
}

/// Height over the pad at which this aircraft has lifted off, m.
#[must_use]
pub fn lift_off_height_m(vehicle: &Vehicle) -> f64 {
    let stand = vehicle.hull.feet_m.iter().map(|foot| foot.down()).fold(vehicle.hull.body_half_extent_m[2], f64::max);
    LIFT_OFF_M.max(stand + OVER_STAND_M)
}

/// Frames are looked at this long past the time limit: longer than a landing takes to be confirmed.
const OVERTIME: SimTime = SimTime::from_ms(10_000);

/// The frames of a session and its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Session {
    /// Frame 1 to N; contacts after the pad rule.
    pub frames: Vec<Frame>,
    /// Why frame N is the last.
    pub reason: EndReason,
}

impl Session {
    /// Cuts a flight into its session; `None` when it never lifted off.
    #[must_use]
    pub fn cut(flight: &Flight, scenario: &Scenario, vehicle: &Vehicle) -> Option<Self> {
        let start = flight.lift_off(scenario.ground_team.pad_m.up(), lift_off_height_m(vehicle))?;
        // The time limit ends every session; a broken clock must not make frames without end.
        let end = flight.end()?.min(start + SimTime::from_s(scenario.scoring.time_max_s) + OVERTIME);
        let rate = scenario.scoring.frame_rate_hz;
        let mut frames = all_frames(flight, start, end, rate);
        crash::settle_contacts(&mut frames, flight, &scenario.ground_team);
        let mut rule = EndRule::new(scenario, vehicle);
        let decided = frames.iter().find_map(|frame| rule.see(&moment(frame, rate)));
        let none = if flight.ended_by_restart { EndReason::Restart } else { EndReason::Abort };
        let (last, reason) = decided.or(rule.pending()).unwrap_or((end, none));
        frames.truncate(frames.partition_point(|frame| frame.time <= last).max(1));
        Some(Self { frames, reason })
    }

    /// N/f, s.
    #[must_use]
    pub fn seconds(&self, frame_rate_hz: f64) -> f64 {
        self.frames.len() as f64 / frame_rate_hz
    }
}

fn all_frames(flight: &Flight, start: SimTime, end: SimTime, rate: f64) -> Vec<Frame> {
    let at = |k: u32| start + SimTime::from_s(f64::from(k) / rate);
    // Frame 1 has no frame before it: it sees its own instant only.
    let before = SimTime::from_ns(start.ns() - 1);
    (0u32..)
        .take_while(|k| at(*k) <= end)
        .filter_map(|k| flight.frame(k + 1, if k == 0 { before } else { at(k - 1) }, at(k)))
        .collect()
}

fn moment(frame: &Frame, rate: f64) -> Moment {
    Moment {
        time: frame.time,
        flown_s: f64::from(frame.index) / rate,
        position_m: frame.position_m,
        speed_m_s: frame.speed_m_s(),
        contact: frame.contact,
        battery_pct: frame.battery_pct,
        armed: frame.armed,
        on_ground: frame.on_ground,
    }
}
