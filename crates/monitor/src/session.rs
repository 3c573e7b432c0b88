//! Determines a session's start, end and end reason.

use super::measures::crash;
use serde::Serialize;
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::continuity::is_jump;
use spandrel_mavlink::telemetry::{Flight, Frame};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{AfterCrash, Scenario};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;

/// Minimum height of the drone's center above the pad that counts as lift-off, m (docs/src/reference/assessment.md, "Frames").
const MIN_LIFT_OFF_HEIGHT_M: f64 = 0.3;
/// Margin above the resting height for aircraft whose center rests higher than `MIN_LIFT_OFF_HEIGHT_M`, m (estimate).
const RESTING_HEIGHT_MARGIN_M: f64 = 0.05;
/// Speed below which the drone is at rest, m/s (estimate: above the resolution of 0.01 m/s in the truth messages, below any
/// controlled drift).
const MAX_REST_SPEED_M_S: f64 = 0.2;
/// Time at rest that counts as a landing (docs/src/reference/assessment.md, "Frames").
const LANDING_REST_TIME: SimTime = SimTime::from_ms(3_000);

/// Maximum age of the armed and on-ground states. The autopilot sends them every second.
const MAX_STATE_AGE: SimTime = SimTime::from_ms(1_500);

/// Reason why a session ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(into = "&'static str")]
pub enum EndReason {
    /// Landed near the ground team.
    Landed,
    /// The battery was empty.
    Battery,
    /// The maximum flight time was exceeded.
    TimeLimit,
    /// The drone hit a person.
    Person,
    /// The drone hit a vehicle.
    Vehicle,
    /// The drone crashed in a scenario in which any crash ends the session.
    Crash,
    /// The user ended the session, or the telemetry stopped.
    Abort,
    /// The simulator was restarted during the flight.
    Restart,
}

impl From<EndReason> for &'static str {
    fn from(reason: EndReason) -> Self {
        reason.label()
    }
}

impl EndReason {
    /// Returns the value for `assessment.json`.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Landed => "landed",
            Self::Battery => "battery",
            Self::TimeLimit => "time_limit",
            Self::Person => "person",
            Self::Vehicle => "vehicle",
            Self::Crash => "crash",
            Self::Abort => "abort",
            Self::Restart => "restart",
        }
    }
}

/// Flight state at one time step, used to detect the end of the session.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndRuleInput {
    /// Current simulation time.
    pub time: SimTime,
    /// Flight time so far, s.
    pub flight_time_s: f64,
    /// Position of the drone's center in the site frame, m.
    pub position_m: Vec3<Enu>,
    /// Speed (magnitude of the velocity), m/s.
    pub speed_m_s: f64,
    /// Kind of object in contact, excluding touchdowns on the pad.
    pub contact: ContactKind,
    /// Remaining battery charge, %.
    pub battery_pct: f64,
    /// Whether the drone is armed; `None` if not yet received.
    pub armed: Option<bool>,
    /// Whether the autopilot reports that the drone is on the ground.
    pub on_ground: bool,
}

/// Detects the end of a session. A landing counts from the time the drone came to rest but is confirmed only after
/// the rest time. Events in between, such as an empty battery, do not override it.
#[derive(Debug, Clone, PartialEq)]
pub struct EndRule {
    pad_m: Vec3<Enu>,
    home_radius_m: f64,
    lift_off_m: f64,
    time_max_s: f64,
    any_crash_ends_session: bool,
    armed_received: bool,
    rest_since: Option<SimTime>,
    pending: Option<(SimTime, EndReason)>,
    last_input: Option<EndRuleInput>,
    respawned_at: Option<SimTime>,
}

impl EndRule {
    /// Creates the end rule for a session.
    #[must_use]
    pub fn new(scenario: &Scenario, vehicle: &Vehicle) -> Self {
        Self {
            pad_m: scenario.ground_team.pad_m,
            home_radius_m: scenario.ground_team.home_radius_m,
            lift_off_m: lift_off_height_m(vehicle),
            time_max_s: scenario.scoring.time_max_s,
            any_crash_ends_session: scenario.rules.after_crash == AfterCrash::End,
            armed_received: false,
            rest_since: None,
            pending: None,
            last_input: None,
            respawned_at: None,
        }
    }

    /// Discards armed and on-ground states received before a respawn.
    fn discard_stale_states(&mut self, input: &EndRuleInput) -> EndRuleInput {
        let jumped = self.last_input.is_some_and(|last| {
            let step_m = (input.position_m - last.position_m).norm();
            is_jump(step_m, input.speed_m_s.max(last.speed_m_s), input.time - last.time)
        });
        self.last_input = Some(*input);
        if jumped {
            self.respawned_at = Some(input.time);
        }
        if self.respawned_at.is_none_or(|since| input.time - since >= MAX_STATE_AGE) {
            return *input;
        }
        let down = matches!(input.contact, ContactKind::Terrain);
        EndRuleInput { armed: input.armed.filter(|armed| *armed), on_ground: input.on_ground && down, ..*input }
    }

    /// Returns the time of the last frame and the end reason if the session ends now.
    pub fn update(&mut self, input: &EndRuleInput) -> Option<(SimTime, EndReason)> {
        let input = &self.discard_stale_states(input);
        match input.contact {
            ContactKind::Person => return Some((input.time, EndReason::Person)),
            ContactKind::Vehicle => return Some((input.time, EndReason::Vehicle)),
            ContactKind::Bridge | ContactKind::Terrain | ContactKind::Water | ContactKind::Other
                if self.any_crash_ends_session =>
            {
                return Some((input.time, EndReason::Crash));
            }
            ContactKind::None | ContactKind::Bridge | ContactKind::Terrain | ContactKind::Water | ContactKind::Other => {}
        }
        // The armed state can be up to a second old, so "disarmed" indicates a landing only after "armed" was received.
        self.armed_received |= input.armed == Some(true);
        self.rest_since = self.has_landed_at_home(input).then(|| self.rest_since.unwrap_or(input.time));
        if let Some(since) = self.rest_since
            && (self.armed_received && input.armed == Some(false) || input.time - since >= LANDING_REST_TIME)
        {
            return Some((since, EndReason::Landed));
        }
        let over = if input.battery_pct <= 0.0 {
            Some(EndReason::Battery)
        } else {
            (input.flight_time_s > self.time_max_s).then_some(EndReason::TimeLimit)
        };
        self.pending = self.pending.or(over.map(|reason| (input.time, reason)));
        if self.rest_since.is_none() { self.pending } else { None }
    }

    /// Returns the pending end while a possible landing is being confirmed. If the telemetry stops first, this end
    /// takes effect.
    #[must_use]
    pub fn pending(&self) -> Option<(SimTime, EndReason)> {
        self.pending
    }

    fn has_landed_at_home(&self, input: &EndRuleInput) -> bool {
        let from_pad = input.position_m - self.pad_m;
        let down = input.on_ground || from_pad.up() < self.lift_off_m || input.contact == ContactKind::Terrain;
        down && input.speed_m_s < MAX_REST_SPEED_M_S && from_pad.horizontal_norm() <= self.home_radius_m
    }
}

/// Returns the height in meters of the aircraft's center above the pad that counts as lift-off.
#[must_use]
pub fn lift_off_height_m(vehicle: &Vehicle) -> f64 {
    let stand = vehicle.hull.feet_m.iter().map(|foot| foot.down()).fold(vehicle.hull.body_half_extent_m[2], f64::max);
    MIN_LIFT_OFF_HEIGHT_M.max(stand + RESTING_HEIGHT_MARGIN_M)
}

/// Time past the time limit during which frames are still evaluated; longer than it takes to confirm a landing.
const EVALUATION_MARGIN: SimTime = SimTime::from_ms(10_000);

/// A session's frames and end.
#[derive(Debug, Clone, PartialEq)]
pub struct Session {
    /// Session frames, with pad touchdowns removed; frame 1 has index 0.
    pub frames: Vec<Frame>,
    /// Reason why the session ended after the last frame.
    pub reason: EndReason,
}

impl Session {
    /// Extracts the session from a flight; `None` if there was no lift-off.
    #[must_use]
    pub fn from_flight(flight: &Flight, scenario: &Scenario, vehicle: &Vehicle) -> Option<Self> {
        let start = flight.lift_off(scenario.ground_team.pad_m.up(), lift_off_height_m(vehicle))?;
        // Limits the number of frames even if the clock is corrupt.
        let end = flight.end()?.min(start + SimTime::from_s(scenario.scoring.time_max_s) + EVALUATION_MARGIN);
        let rate = scenario.scoring.frame_rate_hz;
        let mut frames = all_frames(flight, start, end, rate);
        crash::clean_up_contacts(&mut frames, flight, &scenario.ground_team);
        let mut rule = EndRule::new(scenario, vehicle);
        let decided = frames.iter().find_map(|frame| rule.update(&input(frame, rate)));
        let none = if flight.ended_by_restart { EndReason::Restart } else { EndReason::Abort };
        let (last, reason) = decided.or(rule.pending()).unwrap_or((end, none));
        frames.truncate(frames.partition_point(|frame| frame.time <= last).max(1));
        Some(Self { frames, reason })
    }

    /// Returns the session duration (N/f) in seconds.
    #[must_use]
    pub fn seconds(&self, frame_rate_hz: f64) -> f64 {
        self.frames.len() as f64 / frame_rate_hz
    }
}

fn all_frames(flight: &Flight, start: SimTime, end: SimTime, rate: f64) -> Vec<Frame> {
    let at = |k: u32| start + SimTime::from_s(f64::from(k) / rate);
    // Frame 1 has no predecessor, so its interval is a single instant.
    let before = SimTime::from_ns(start.ns() - 1);
    (0u32..)
        .take_while(|k| at(*k) <= end)
        .filter_map(|k| flight.frame(k + 1, if k == 0 { before } else { at(k - 1) }, at(k)))
        .collect()
}

fn input(frame: &Frame, rate: f64) -> EndRuleInput {
    EndRuleInput {
        time: frame.time,
        flight_time_s: f64::from(frame.index) / rate,
        position_m: frame.position_m,
        speed_m_s: frame.speed_m_s(),
        contact: frame.contact,
        battery_pct: frame.battery_pct,
        armed: frame.armed,
        on_ground: frame.on_ground,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule() -> EndRule {
        let read = |text| spandrel_model::scenario::read("two-bridges.toml", text, &|_| Err("none".into())).unwrap();
        let vehicle =
            spandrel_model::vehicle::read("phantom2.toml", include_str!("../../../vehicle-params/phantom2.toml")).unwrap();
        EndRule::new(&read(include_str!("../../../scenarios/two-bridges.toml")), &vehicle)
    }

    /// Returns the first end detected within eight seconds at rest, sampled 30 times per second from `from_ms`. `words`
    /// returns the armed and on-ground states of a sample.
    fn end(rule: &mut EndRule, from_ms: i64, position_m: Vec3<Enu>, words: impl Fn(i64) -> (bool, bool)) -> Option<EndReason> {
        (0..240).find_map(|k| {
            let (armed, on_ground) = words(k);
            let time = SimTime::from_ms(from_ms + k * 33);
            let contact = ContactKind::None;
            let still = EndRuleInput {
                time,
                flight_time_s: time.s(),
                position_m,
                speed_m_s: 0.0,
                contact,
                battery_pct: 90.0,
                armed: Some(armed),
                on_ground,
            };
            rule.update(&still).map(|(_, reason)| reason)
        })
    }

    #[test]
    fn exact_respawn_over_home_with_stale_states_is_not_a_landing() {
        let mut rule = rule();
        let pad_m = rule.pad_m;
        let over_home = pad_m + Vec3::new(1.0, 0.0, 5.0);
        assert_eq!(end(&mut rule, 0, over_home, |_| (true, false)), None);
        // The drone disarms in the lake. After the respawn, it is armed, but for one second, the telemetry still
        // reports it as disarmed and on the ground.
        assert_eq!(end(&mut rule, 8_000, pad_m + Vec3::new(80.0, 0.0, -5.0), |_| (false, true)), None);
        assert_eq!(end(&mut rule, 16_000, over_home, |k| (k >= 30, k < 30)), None);
        // Later states are valid again: the drone comes to rest near home and disarms.
        assert_eq!(end(&mut rule, 24_000, over_home, |_| (false, true)), Some(EndReason::Landed));
    }
}
