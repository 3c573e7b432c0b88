//! A recorded session as it is drawn: where everything was at any time, and what the display told.

use super::super::errors::AppError;
use super::super::files;
use super::super::session_folder::Stored;
use crate::base::geodesy::LocalPlane;
use crate::base::time::SimTime;
use crate::monitor::assessment::scored_epoch;
use crate::monitor::folder::EVENTS;
use crate::monitor::measures::attention;
use crate::scenario::Scenario;
use crate::site::CameraPose;
use crate::site::gates::Gates;
use crate::telemetry::sample::{Header, truth_time};
use crate::telemetry::{Flight, RESTART_AFTER, RESTART_CONFIRM, Timeline, tlog};
use crate::vehicle::{Camera, Vehicle};
use crate::view::feed::Feed;
use crate::view::live::Trace;
use crate::view::scene::DronePose;
use crate::view::stage::Moment;
use std::path::{Path, PathBuf};

/// The record's word for a simulator that has begun anew.
const RESTARTED: &str = "\"simulator_restarted\"";

/// A session folder that holds a flight.
pub struct Recorded {
    /// Where it is.
    pub folder: PathBuf,
    /// What it holds.
    pub stored: Stored,
    /// The flight.
    pub flight: Flight,
    /// So many flights before it are in the log: the simulator has begun anew.
    before: usize,
    /// How long these took.
    passed: SimTime,
}

impl Recorded {
    /// Reads a session folder.
    ///
    /// # Errors
    /// When it is none, a file is wrong, or it holds no flight.
    pub fn read(folder: &Path) -> Result<Self, AppError> {
        let stored = Stored::read(folder)?;
        let mut timeline = Timeline::new(LocalPlane::new(stored.scenario.scenario.origin));
        timeline.push_log(&stored.log);
        let (before, flight) = scored_epoch(&timeline, &stored.scenario.scenario, &stored.vehicle.vehicle);
        if flight.truths.is_empty() {
            return Err(AppError::failed("the session holds no flight to draw"));
        }
        let last = |epoch| timeline.flight(epoch).truths.last().map_or(SimTime::ZERO, |truth| truth.time);
        let passed = (0..before).map(last).fold(SimTime::ZERO, |sum, time| sum + time);
        Ok(Self { folder: folder.to_owned(), stored, flight, before, passed })
    }

    /// A simulation time of the flight as the clock of the world had it, microseconds since 1970.
    pub fn unix_us(&self, at: SimTime) -> u64 {
        self.stored.started_unix_us + u64::try_from((self.passed + at).us()).unwrap_or(0)
    }

    /// The job.
    pub fn scenario(&self) -> &Scenario {
        &self.stored.scenario.scenario
    }

    /// The aircraft.
    pub fn vehicle(&self) -> &Vehicle {
        &self.stored.vehicle.vehicle
    }

    /// First and last instant.
    pub fn span(&self) -> (SimTime, SimTime) {
        let time = |truth: Option<&crate::telemetry::Truth>| truth.map_or(SimTime::ZERO, |truth| truth.time);
        (time(self.flight.truths.first()), time(self.flight.truths.last()))
    }

    /// The seed that placed defects and traffic.
    pub fn seed(&self) -> u64 {
        self.scenario().seed.or(self.flight.seeds.all().first().map(|said| said.2)).unwrap_or_default()
    }

    /// When traffic was stopped and let go.
    pub fn gates(&self) -> Gates {
        attention::gates(&self.flight)
    }

    /// Where everything was.
    ///
    /// # Errors
    /// Where the telemetry says nothing.
    pub fn moment(&self, at: SimTime) -> Result<Moment, AppError> {
        let (first, last) = self.span();
        moment(&self.flight, at, self.vehicle()).ok_or_else(|| {
            let (at, first, last) = (at.s(), first.s(), last.s());
            AppError::failed(format!("the session holds nothing at {at:.1} s: it goes from {first:.1} to {last:.1} s"))
        })
    }

    /// What the display tells besides the flight, from the beginning on.
    pub fn heard(&self) -> Heard<'_> {
        // A session without its record of events is drawn without cues.
        let events = files::read(&self.folder.join(EVENTS)).unwrap_or_default();
        let mut lines = events.lines();
        for _ in 0..self.before {
            lines.find(|line| line.contains(RESTARTED));
        }
        let mut events: Vec<(SimTime, serde_json::Value)> = lines
            .filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok())
            .filter_map(|event| Some((event["t_s"].as_f64().map(SimTime::from_s)?, event)))
            .collect();
        // Taken from the end; those of one time stay in their order.
        events.sort_by_key(|event| event.0);
        events.reverse();
        let frames = tlog::Reader::new(&self.stored.log);
        Heard { feed: Feed::default(), now: SimTime::ZERO, before: self.before, old: 0, frames, next: None, events }
    }
}

/// Mode, satellites, cues and words as they were told, up to a time that only goes on.
pub struct Heard<'a> {
    feed: Feed,
    now: SimTime,
    before: usize,
    old: usize,
    frames: tlog::Reader<'a>,
    next: Option<&'a [u8]>,
    events: Vec<(SimTime, serde_json::Value)>,
}

impl Heard<'_> {
    /// A truth of a flight before: enough old ones in a row begin the next flight, as in [`Timeline`].
    fn pass(&mut self, now: SimTime) {
        if now + RESTART_AFTER >= self.now {
            (self.now, self.old) = (self.now.max(now), 0);
            return;
        }
        self.old += 1;
        if self.old == RESTART_CONFIRM {
            (self.before, self.old, self.now) = (self.before - 1, 0, now);
        }
    }

    /// What had been told by then: the telemetry's part, and the monitor's own cues and words from its record.
    pub fn until(&mut self, at: SimTime) -> &Feed {
        while let Some(frame) = self.next.take().or_else(|| self.frames.next().map(|record| record.frame)) {
            if self.before > 0 {
                truth_time(frame).into_iter().for_each(|now| self.pass(now));
                continue;
            }
            let now = truth_time(frame).unwrap_or(self.now);
            if now > at {
                self.next = Some(frame);
                break;
            }
            self.now = now;
            if Header::peek(frame).is_some_and(|header| Feed::listens(header.message_id)) {
                self.feed.hear(frame, now);
            }
        }
        while let Some((time, event)) = self.events.pop_if(|(time, _)| *time <= at) {
            if let Some(mask) = event["cues"].as_i64() {
                self.feed.cue(i32::try_from(mask).unwrap_or(0), time);
            }
            if let Some(words) = event["text"].as_str() {
                self.feed.words(words);
            }
        }
        &self.feed
    }
}

/// Where everything was, `None` where the telemetry says nothing. Attitude, gimbal and zoom go evenly between what was told, as in the live view; the
/// measures take what was told last.
fn moment(flight: &Flight, at: SimTime, vehicle: &Vehicle) -> Option<Moment> {
    let state = flight.between(at)?;
    let trace = trace(flight, at);
    let ned_from_frd = trace.at(at).filter(|_| !state.missing).map_or(state.ned_from_frd, |pose| pose.ned_from_frd);
    let lamp_on = flight.light.at(at).unwrap_or(false);
    Some(Moment {
        at,
        drone: DronePose { position_m: state.position_m, ned_from_frd, spinning: flight.armed.at(at).unwrap_or(false) },
        velocity_m_s: state.velocity_m_s,
        camera: CameraPose::on(&vehicle.camera, (state.position_m, ned_from_frd), trace.gimbal_at(at), lamp_on),
        lens: trace.lens_told_at(at).map_or(vehicle.camera, |hfov_rad| Camera { hfov_rad, ..vehicle.camera }),
        turn: trace.turn_at(at),
    })
}

/// What was told last by a time, and next.
fn trace(flight: &Flight, at: SimTime) -> Trace {
    let near = |after: usize, count: usize| after.saturating_sub(1)..count.min(after + 1);
    let (truths, pitches) = (&flight.truths, flight.gimbal.all());
    let mut trace = Trace::default();
    let around = near(truths.partition_point(|truth| truth.time <= at), truths.len());
    truths[around].iter().for_each(|truth| trace.push(*truth));
    let around = near(pitches.partition_point(|told| told.0 <= at), pitches.len());
    pitches[around].iter().for_each(|told| trace.push_gimbal(told.0, told.2));
    let fields = flight.field_of_view.all();
    let around = near(fields.partition_point(|told| told.0 <= at), fields.len());
    fields[around].iter().for_each(|told| trace.push_lens(told.0, told.2));
    trace
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::frames::{Rotation, Vec3};
    use crate::telemetry::Truth;
    use crate::view::stage::Turn;

    #[test]
    fn exact_a_recorded_camera_turned_as_its_samples_say() {
        let truth = |ms: i64, yaw_deg: f64| Truth {
            time: SimTime::from_ms(ms),
            position_m: Vec3::new(0.0, 0.0, 10.0),
            velocity_m_s: Vec3::new(0.0, 0.0, 0.0),
            ned_from_frd: Rotation::from_euler(0.0, 0.0, yaw_deg.to_radians()),
        };
        let mut flight = Flight::default();
        assert_eq!(trace(&flight, SimTime::ZERO).turn_at(SimTime::ZERO), Turn::default());
        flight.truths = [(0, 0.0), (20, 2.0), (40, 2.0), (60, 1.0)].map(|(ms, yaw_deg)| truth(ms, yaw_deg)).to_vec();
        for (ms, pitch_rad) in [(0, 0.0), (50, 0.05), (100, 0.0)] {
            flight.gimbal.push(SimTime::from_ms(ms), ms, pitch_rad);
        }
        for (ms, heading_deg_s, pitch_rad_s) in
            [(10, 100.0, 1.0), (20, 0.0, 1.0), (55, -50.0, -1.0), (60, 0.0, -1.0), (100, 0.0, 0.0)]
        {
            let found = trace(&flight, SimTime::from_ms(ms)).turn_at(SimTime::from_ms(ms));
            let near =
                (found.heading_rad_s.to_degrees() - heading_deg_s).abs() < 1e-6 && (found.pitch_rad_s - pitch_rad_s).abs() < 1e-9;
            assert!(near, "{ms} ms: {found:?}");
        }
        let vehicle = crate::vehicle::read("phantom2.toml", include_str!("../../../vehicle-params/phantom2.toml")).unwrap();
        let between = moment(&flight, SimTime::from_ms(10), &vehicle).unwrap();
        assert!((between.drone.ned_from_frd.yaw_rad().to_degrees() - 1.0).abs() < 1e-6, "halfway");
        assert!((between.camera.forward.up() - crate::base::math::sin(0.01)).abs() < 1e-9, "{:?}", between.camera.forward);
    }
}
