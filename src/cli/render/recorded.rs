//! A recorded session for rendering: poses at any time, and head-up display values.

use crate::errors::AppError;
use crate::io::files;
use crate::io::session_folder::StoredSession;
use spandrel_mavlink::telemetry::sample::{FrameHeader, truth_time};
use spandrel_mavlink::telemetry::timeline::FrameDisposition;
use spandrel_mavlink::telemetry::{Flight, Timeline, tlog};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::pose::Pose;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::CameraPose;
use spandrel_model::site::changes::SiteChanges;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};
use spandrel_monitor::assessment::flight_and_prior_runs;
use spandrel_monitor::folder::{EVENTS, SIMULATOR_RESTARTED};
use spandrel_monitor::measures::attention;
use spandrel_monitor::session::Session;
use spandrel_view::feed::Feed;
use spandrel_view::live::MotionHistory;
use spandrel_view::scene::DronePose;
use spandrel_view::stage::SceneMoment;
use std::path::{Path, PathBuf};

/// A recorded flight and its session folder.
pub struct RecordedFlight {
    /// Session folder.
    pub folder: PathBuf,
    /// Contents of the session folder.
    pub stored: StoredSession,
    /// Wall time at simulation time zero, µs since the Unix epoch.
    zero_unix_us: u64,
    /// Complete telemetry log, kept in memory because images may need its records in any order.
    log: Vec<u8>,
    /// The session's scored flight, which is the one to render.
    pub flight: Flight,
    /// Number of earlier flights in the log, from before the simulator was restarted.
    earlier_flights: usize,
    /// Total duration of the earlier flights.
    earlier_duration: SimTime,
    /// Number of records in the earlier flights.
    earlier_records: usize,
}

impl RecordedFlight {
    /// Reads the flight from a session folder.
    ///
    /// # Errors
    /// Returns an error if it is not a session folder, a file is invalid, or it contains no flight.
    pub fn read(folder: &Path) -> Result<Self, AppError> {
        let stored = StoredSession::read(folder)?;
        let mut timeline = Timeline::new(LocalPlane::new(stored.scenario.scenario.origin));
        let log = stored.log.bytes()?;
        let begun: Vec<usize> = tlog::TlogReader::new(&log)
            .enumerate()
            .filter_map(|(k, record)| matches!(timeline.push(record.frame), FrameDisposition::Restarted(_)).then_some(k))
            .collect();
        let (earlier_flights, flight) = flight_and_prior_runs(&timeline, &stored.scenario.scenario, &stored.vehicle.vehicle);
        if flight.truths.is_empty() {
            return Err(AppError::failed("the session contains no flight to render"));
        }
        let zero_unix_us = tlog::simulation_zero_us(&log).unwrap_or(stored.started_unix_us);
        let (passed, earlier_records) =
            (timeline.elapsed_before_epoch(earlier_flights), earlier_flights.checked_sub(1).map_or(0, |k| begun[k]));
        Ok(Self {
            folder: folder.to_owned(),
            stored,
            log,
            zero_unix_us,
            flight,
            earlier_flights,
            earlier_duration: passed,
            earlier_records,
        })
    }

    /// Converts a simulation time of the flight to wall time in µs since the Unix epoch.
    pub fn unix_us(&self, at: SimTime) -> u64 {
        self.zero_unix_us + u64::try_from((self.earlier_duration + at).us()).unwrap_or(0)
    }

    /// Returns the session's scenario.
    pub fn scenario(&self) -> &Scenario {
        &self.stored.scenario.scenario
    }

    /// Returns the session's aircraft.
    pub fn vehicle(&self) -> &Vehicle {
        &self.stored.vehicle.vehicle
    }

    /// Returns the flight's start and end times.
    pub fn span(&self) -> (SimTime, SimTime) {
        let time = |truth: Option<&spandrel_mavlink::contract::truth::Truth>| truth.map_or(SimTime::ZERO, |truth| truth.time);
        (time(self.flight.truths.first()), time(self.flight.truths.last()))
    }

    /// Returns the start and end times of the scored part of the flight, which begins at lift-off.
    /// The whole flight if there is none.
    pub fn scored_span(&self) -> (SimTime, SimTime) {
        let session = Session::from_flight(&self.flight, self.scenario(), self.vehicle());
        let ends = session.as_ref().and_then(|session| session.frames.first().zip(session.frames.last()));
        ends.map_or_else(|| self.span(), |(first, last)| (first.time, last.time))
    }

    /// Returns the seed for defects and traffic.
    pub fn seed(&self) -> u64 {
        self.scenario().seed.or(self.flight.seeds.all().first().map(|said| said.2)).unwrap_or_default()
    }

    /// Returns the bridge closures and the inspector's walks.
    pub fn site_changes(&self) -> SiteChanges {
        attention::site_changes(&self.flight)
    }

    /// Returns the poses at this time in the flight.
    ///
    /// # Errors
    /// Returns an error if there is no telemetry for this time.
    pub fn moment(&self, at: SimTime) -> Result<SceneMoment, AppError> {
        let (first, last) = self.span();
        moment(&self.flight, at, self.vehicle()).ok_or_else(|| {
            let (at, first, last) = (at.s(), first.s(), last.s());
            AppError::failed(format!("the session has no data at {at:.1} s (available: {first:.1} to {last:.1} s)"))
        })
    }

    /// Returns a feed of the other display values from the start of the flight.
    pub fn replay_feed(&self) -> RecordedFeed<'_> {
        // A session without an event log is rendered without cues.
        let events = files::read(&self.folder.join(EVENTS)).unwrap_or_default();
        let mut events = events.lines().filter_map(|line| serde_json::from_str::<serde_json::Value>(line).ok());
        for _ in 0..self.earlier_flights {
            events.find(|event| event["event"] == SIMULATOR_RESTARTED);
        }
        let mut events: Vec<(SimTime, serde_json::Value)> =
            events.filter_map(|event| Some((event["t_s"].as_f64().map(SimTime::from_s)?, event))).collect();
        // Reversed so that events can be popped from the end; the sort preserves the order of simultaneous events.
        events.sort_by_key(|event| event.0);
        events.reverse();
        let records = tlog::TlogReader::new(&self.log).skip(self.earlier_records);
        RecordedFeed { feed: Feed::default(), now: SimTime::ZERO, records, next: None, events }
    }
}

/// Flight mode, satellite count, cues and messages, replayed forward in time.
pub struct RecordedFeed<'a> {
    feed: Feed,
    now: SimTime,
    records: std::iter::Skip<tlog::TlogReader<'a>>,
    next: Option<&'a [u8]>,
    events: Vec<(SimTime, serde_json::Value)>,
}

impl RecordedFeed<'_> {
    /// Advances to a time, using the telemetry and the monitor's recorded cues and messages.
    pub fn advance_to(&mut self, at: SimTime) -> &Feed {
        while let Some(frame) = self.next.take().or_else(|| self.records.next().map(|record| record.frame)) {
            let now = truth_time(frame).unwrap_or(self.now);
            if now > at {
                self.next = Some(frame);
                break;
            }
            self.now = now;
            if FrameHeader::peek(frame).is_some_and(|header| Feed::is_relevant(header.message_id)) {
                self.feed.handle_datagram(frame, now);
            }
        }
        while let Some((time, event)) = self.events.pop_if(|(time, _)| *time <= at) {
            if let Some(mask) = event["cues"].as_i64() {
                self.feed.set_cues(i32::try_from(mask).unwrap_or(0), time);
            }
            if let Some(words) = event["text"].as_str() {
                self.feed.handle_text(words);
            }
        }
        &self.feed
    }
}

/// Returns the poses at a time; `None` without telemetry. Attitude, gimbal and zoom are interpolated, as in the live
/// view; other values are the last ones received.
fn moment(flight: &Flight, at: SimTime, vehicle: &Vehicle) -> Option<SceneMoment> {
    let state = flight.between(at)?;
    let trace = trace(flight, at);
    let ned_from_frd = trace.at(at).filter(|_| !state.missing).map_or(state.motion.ned_from_frd, |motion| motion.ned_from_frd);
    let lamp_on = flight.light.at(at).unwrap_or(false);
    let pose = Pose { position_m: state.motion.position_m, ned_from_frd };
    Some(SceneMoment {
        at,
        drone: DronePose { pose, spinning: flight.armed.at(at).unwrap_or(false) },
        velocity_m_s: state.motion.velocity_m_s,
        camera: CameraPose::on_aircraft(&vehicle.camera, pose, trace.gimbal_at(at), lamp_on),
        lens: trace.reported_lens_at(at).map_or(vehicle.camera, |hfov_rad| Camera { hfov_rad, ..vehicle.camera }),
        turn: trace.turn_at(at),
    })
}

/// Returns the samples just before and after a time.
fn trace(flight: &Flight, at: SimTime) -> MotionHistory {
    let near = |after: usize, count: usize| after.saturating_sub(1)..count.min(after + 1);
    let (truths, pitches) = (&flight.truths, flight.gimbal.all());
    let mut trace = MotionHistory::default();
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
    use crate::io::session_folder::SessionFolder;
    use serde_json::json;
    use spandrel_mavlink::codec::Encoder;
    use spandrel_mavlink::contract::cue;
    use spandrel_mavlink::contract::truth::Truth;
    use spandrel_mavlink::dialect::{HEARTBEAT_DATA, HIL_STATE_QUATERNION_DATA, MavMessage, MavModeFlag};
    use spandrel_model::frames::{Rotation, Vec3};
    use spandrel_model::pose::Motion;
    use spandrel_monitor::SessionOutput;
    use spandrel_view::stage::CameraTurnRate;

    const STARTED_US: u64 = 1_700_000_000_000_000;
    /// Interval between position samples, ms (50 Hz).
    const STEP_MS: i64 = 20;

    /// Writes a session's records as a vehicle and a monitor would write them.
    struct ReplayTelemetry {
        folder: SessionFolder,
        vehicle: Encoder,
        other: Encoder,
        scenario: Scenario,
        newest: Option<SimTime>,
    }

    impl ReplayTelemetry {
        fn receive_message(&mut self, frame: &[u8]) {
            self.folder.record(SessionOutput::Telemetry(tlog::record(STARTED_US, frame)));
        }

        fn event(&mut self, value: &serde_json::Value) {
            self.folder.record(SessionOutput::Event(format!("{value}\n")));
        }

        /// Records one position sample at a height above the pad.
        fn truth(&mut self, ms: i64, height_m: f64, other: bool) {
            let pad = self.scenario.ground_team.pad_m;
            let place = LocalPlane::new(self.scenario.origin).geo_from_enu(pad + Vec3::new(0.0, 0.0, height_m));
            let truth = MavMessage::HIL_STATE_QUATERNION(HIL_STATE_QUATERNION_DATA {
                time_usec: u64::try_from(1_000 * ms).unwrap(),
                attitude_quaternion: [1.0, 0.0, 0.0, 0.0],
                lat: (place.latitude_deg * 1e7).round() as i32,
                lon: (place.longitude_deg * 1e7).round() as i32,
                alt: (place.altitude_m * 1e3).round() as i32,
                ..Default::default()
            });
            let frame = if other { self.other.encode(&truth) } else { self.vehicle.encode(&truth) };
            self.receive_message(&frame);
        }

        /// Records a flight in this PX4 flight mode with a status text; its clock starts at zero.
        fn flight(&mut self, until_ms: i64, height_m: f64, mode: u32, words: &str) {
            for ms in (0..=until_ms).step_by(STEP_MS as usize) {
                self.truth(ms, height_m, false);
                let again = self.newest.is_some() && ms == 2 * STEP_MS;
                if again {
                    self.event(&json!({ "t_s": 0.04, "event": SIMULATOR_RESTARTED }));
                }
                if ms == 100 {
                    let beat = HEARTBEAT_DATA {
                        custom_mode: mode << 16,
                        base_mode: MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
                        ..Default::default()
                    };
                    let frame = self.vehicle.encode(&MavMessage::HEARTBEAT(beat));
                    self.receive_message(&frame);
                    self.event(&json!({ "t_s": 0.1, "event": "cue", "cues": mode, "text": words }));
                }
            }
            self.newest = Some(SimTime::from_ms(until_ms));
        }
    }

    #[test]
    fn exact_last_flight_is_shown_after_simulator_restart() {
        let sessions = tempfile::tempdir().unwrap();
        let shipped = |path: &str| format!("{}/{path}", env!("CARGO_MANIFEST_DIR"));
        let scenario = files::scenario(&shipped("scenarios/two-bridges.toml")).unwrap();
        let vehicle = files::vehicle(&shipped("vehicle-params/phantom2.toml")).unwrap();
        let folder = SessionFolder::create(sessions.path(), "anna", STARTED_US, &scenario, &vehicle).unwrap();
        let (vehicle, other) = (Encoder::new(1, 1), Encoder::new(2, 1));
        let mut tape = ReplayTelemetry { folder, vehicle, other, scenario: scenario.scenario, newest: None };
        // On the ground. Three late samples from another system do not start a new flight.
        tape.flight(30_000, 0.0, 2, "Crash: simulator_restarted");
        (0..3).for_each(|k| tape.truth(STEP_MS * k, 0.0, true));
        tape.flight(20_000, 10.0, 3, "Crash: the second");
        tape.folder.flush().unwrap();

        let recorded = RecordedFlight::read(tape.folder.path()).unwrap();
        assert_eq!(recorded.span(), (SimTime::ZERO, SimTime::from_ms(20_000)));
        let second = SimTime::from_ms(1_000);
        assert_eq!(recorded.unix_us(second), STARTED_US + 31_000_000);
        assert!(recorded.moment(second).unwrap().drone.pose.position_m.up() > 5.0 + tape.scenario.ground_team.pad_m.up());
        let mut replay_feed = recorded.replay_feed();
        let early = replay_feed.advance_to(SimTime::from_ms(40)).clone();
        assert_eq!(
            (early.mode(), early.cues(SimTime::from_ms(40), true), early.cue_texts().text(cue::CRASH)),
            ("no mode", 0, Some("Crash")),
            "nothing of the first flight"
        );
        let later = replay_feed.advance_to(second);
        assert_eq!(
            (later.mode(), later.cues(second, true), later.cue_texts().text(cue::CRASH)),
            ("Position", 3, Some("Crash: the second"))
        );
    }

    #[test]
    fn exact_recorded_camera_rates_follow_the_samples() {
        let truth = |ms: i64, yaw_deg: f64| Truth {
            time: SimTime::from_ms(ms),
            motion: Motion {
                position_m: Vec3::new(0.0, 0.0, 10.0),
                velocity_m_s: Vec3::zero(),
                ned_from_frd: Rotation::from_euler(0.0, 0.0, yaw_deg.to_radians()),
            },
        };
        let mut flight = Flight::default();
        assert_eq!(trace(&flight, SimTime::ZERO).turn_at(SimTime::ZERO), CameraTurnRate::default());
        flight.truths = [(0, 0.0), (20, 2.0), (40, 2.0), (60, 1.0)].map(|(ms, yaw_deg)| truth(ms, yaw_deg)).to_vec();
        for (ms, pitch_rad) in [(0, 0.0), (50, 0.05), (100, 0.0)] {
            flight.gimbal.push(SimTime::from_ms(ms), ms, pitch_rad);
        }
        for (ms, heading_deg_s, pitch_rad_s) in
            [(10, 100.0, 1.0), (20, 0.0, 1.0), (55, -50.0, -1.0), (60, 0.0, -1.0), (100, 0.0, 0.0)]
        {
            let found = trace(&flight, SimTime::from_ms(ms)).turn_at(SimTime::from_ms(ms));
            let near = (found.heading_rate_rad_s.to_degrees() - heading_deg_s).abs() < 1e-6
                && (found.pitch_rate_rad_s - pitch_rad_s).abs() < 1e-9;
            assert!(near, "{ms} ms: {found:?}");
        }
        let vehicle =
            spandrel_model::vehicle::read("phantom2.toml", include_str!("../../../vehicle-params/phantom2.toml")).unwrap();
        let between = moment(&flight, SimTime::from_ms(10), &vehicle).unwrap();
        assert!((between.drone.pose.ned_from_frd.yaw_rad().to_degrees() - 1.0).abs() < 1e-6, "halfway");
        assert!((between.camera.forward.up() - spandrel_model::math::sin(0.01)).abs() < 1e-9, "{:?}", between.camera.forward);
    }
}
