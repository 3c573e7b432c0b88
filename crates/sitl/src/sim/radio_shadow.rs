//! The radio shadow of the structure, in jobs with `hazards.radio`: how strong control and video arrive, and in which intervals control
//! and telemetry are silent.

use crate::endpoint::RadioTruth;
use spandrel_mavlink::codec::Decoder;
use spandrel_mavlink::contract::hazards::RadioMargins;
use spandrel_mavlink::contract::practice::PracticeRequest;
use spandrel_mavlink::contract::walk::WalkRequest;
use spandrel_mavlink::dialect::{MavCmd, MavMessage};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::radio::{self, LinkBudget, RadioWay};
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::site::radio_path::{PILOT_ANTENNA_HEIGHT_M, RadioPath};
use spandrel_model::time::{Schedule, SimTime};

/// Rate at which the path is computed, Hz. In each interval, control either arrives or not.
const UPDATE_RATE_HZ: f64 = 10.0;
/// Number of silent intervals after which control counts as lost: 0.5 s, PX4's default of COM_RC_LOSS_T.
const LOST_INTERVALS: u32 = 5;

/// State of both links. Plain data.
#[derive(Debug, Clone)]
pub(super) struct RadioShadow {
    due: Schedule,
    stream: RandomStream,
    /// Loss in addition to that of the models, dB.
    extra_loss_db: f64,
    is_silent: bool,
    silent_intervals: u32,
    truth: RadioTruth,
}

impl RadioShadow {
    /// Returns `None` if the job does not simulate the radio.
    pub(super) fn of(scenario: &Scenario, seed: u64) -> Option<Self> {
        let hazards = &scenario.hazards;
        let margins = RadioMargins { control_db: 0.0, video_db: 0.0, way: RadioWay::LineOfSight, losses: 0 };
        hazards.radio.then(|| Self {
            due: Schedule::new(SimTime::ZERO, UPDATE_RATE_HZ),
            stream: RandomStream::new(seed, "radio-shadow"),
            extra_loss_db: 20.0 * math::log10(hazards.severity),
            is_silent: false,
            silent_intervals: 0,
            truth: RadioTruth { margins, signal_dbm: radio::CONTROL.received_dbm(0.0), silent_intervals: 0 },
        })
    }

    /// Computes the links to an aircraft if they are due. Returns whether it did.
    pub(super) fn update(&mut self, site: &Site, aircraft_m: Vec3<Enu>, now: SimTime) -> bool {
        if !self.due.fire(now) {
            return false;
        }
        let pilot_m = site.inspector().at(now).feet_m + Vec3::new(0.0, 0.0, PILOT_ANTENNA_HEIGHT_M);
        let path = RadioPath::between(site.geometry(), pilot_m, aircraft_m);
        let loss = |link: &LinkBudget| {
            let (loss_db, way) = path.loss_db(link.frequency_ghz);
            (loss_db + self.extra_loss_db, way)
        };
        let ((control_db, way), (video_db, _)) = (loss(&radio::CONTROL), loss(&radio::VIDEO));
        let margins = &mut self.truth.margins;
        margins.control_db = radio::CONTROL.margin_db(control_db);
        margins.video_db = radio::VIDEO.margin_db(video_db);
        margins.way = way;
        self.truth.signal_dbm = radio::CONTROL.received_dbm(control_db);
        self.draw_interval();
        true
    }

    /// Decides whether control arrives until the next update.
    fn draw_interval(&mut self) {
        self.is_silent = self.stream.uniform() >= radio::delivered_share(self.truth.margins.control_db);
        self.silent_intervals = if self.is_silent { self.silent_intervals + 1 } else { 0 };
        self.truth.silent_intervals += u32::from(self.is_silent);
        self.truth.margins.losses += u32::from(self.silent_intervals == LOST_INTERVALS);
    }

    /// Returns whether control and telemetry don't arrive.
    pub(super) fn is_silent(&self) -> bool {
        self.is_silent
    }

    /// Returns the state of the links.
    pub(super) fn truth(&self) -> RadioTruth {
        self.truth
    }
}

/// Checks whether a datagram contains a request to the simulator or the inspector, or the answer to one. Such requests are no radio
/// signals: a trainee can still send the inspector to a place from which the drone is in sight, or rewind the flight.
pub(super) fn is_for_simulator(bytes: &[u8]) -> bool {
    let is_request =
        |command: MavCmd| PracticeRequest::of(command as u16, 0.0).is_some() || WalkRequest::of(command as u16, 0.0).is_some();
    Decoder::new().datagram(bytes).iter().any(|frame| match &frame.message {
        Some(MavMessage::COMMAND_LONG(wire)) => is_request(wire.command),
        Some(MavMessage::COMMAND_INT(wire)) => is_request(wire.command),
        Some(MavMessage::COMMAND_ACK(wire)) => is_request(wire.command),
        _ => false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::codec::Encoder;
    use spandrel_mavlink::dialect::COMMAND_ACK_DATA;
    use spandrel_mavlink::station;
    use spandrel_model::{scenario, shipped};

    fn job(hazards: &str) -> Scenario {
        let text = format!("{}\n[hazards]\n{hazards}\n", shipped::without_hazards(shipped::TWO_BRIDGES));
        scenario::read("job.toml", &text, &|file| Err(format!("no {file}"))).unwrap()
    }

    /// Returns the state after `intervals` at a margin.
    fn after(control_db: f64, intervals: u32) -> RadioShadow {
        let mut shadow = RadioShadow::of(&job("radio = true"), 1).unwrap();
        shadow.truth.margins.control_db = control_db;
        (0..intervals).for_each(|_| shadow.draw_interval());
        shadow
    }

    #[test]
    fn exact_control_is_lost_once_per_half_second_of_silence() {
        assert_eq!(after(20.0, 100).truth.silent_intervals, 0);
        assert_eq!((after(-20.0, 4).truth.margins.losses, after(-20.0, 5).truth.margins.losses), (0, 1));
        let mut dead = after(-20.0, 100);
        assert_eq!((dead.truth.margins.losses, dead.truth.silent_intervals, dead.is_silent()), (1, 100, true));
        dead.truth.margins.control_db = 20.0;
        dead.draw_interval();
        assert!(!dead.is_silent());
        dead.truth.margins.control_db = -20.0;
        (0..5).for_each(|_| dead.draw_interval());
        assert_eq!(dead.truth.margins.losses, 2);
    }

    #[test]
    fn prop_share_of_silent_intervals_follows_the_margin() {
        // Standard deviation of the share of 4000 draws: 0.008.
        for (control_db, share) in [(0.0, 0.5), (1.5, 0.25), (-1.5, 0.75)] {
            let lost = f64::from(after(control_db, 4_000).truth.silent_intervals) / 4_000.0;
            assert!((lost - share).abs() < 0.03, "{control_db} dB: {lost}");
        }
    }

    #[test]
    fn exact_severity_weakens_the_signal_by_its_square() {
        let margins = |hazards: &str| {
            let job = job(hazards);
            let site = Site::without_defects(&job);
            let mut shadow = RadioShadow::of(&job, 1).unwrap();
            assert!(shadow.update(&site, job.ground_team.pad_m + Vec3::new(0.0, 0.0, 30.0), SimTime::ZERO));
            assert!(!shadow.update(&site, job.ground_team.pad_m, SimTime::from_ms(50)));
            shadow.truth().margins
        };
        let (plain, severe) = (margins("radio = true"), margins("radio = true\nseverity = 2.0"));
        let weaker_db = 20.0 * math::log10(2.0);
        assert!((plain.control_db - severe.control_db - weaker_db).abs() < 1e-9);
        assert!((plain.video_db - severe.video_db - weaker_db).abs() < 1e-9);
        assert_eq!(plain.way, RadioWay::LineOfSight);
    }

    #[test]
    fn regress_walks_and_rewinds_are_possible_in_the_shadow() {
        let datagram = |message: &MavMessage| Encoder::new(255, 190).encode(message);
        let command = |command: MavCmd| datagram(&MavMessage::COMMAND_LONG(station::command(1, 1, command, [1.0; 7])));
        let ack =
            |command: MavCmd| datagram(&MavMessage::COMMAND_ACK(COMMAND_ACK_DATA { command, ..COMMAND_ACK_DATA::default() }));
        for request in [MavCmd::MAV_CMD_USER_1, MavCmd::MAV_CMD_USER_2, MavCmd::MAV_CMD_USER_3, MavCmd::MAV_CMD_USER_4] {
            assert!(is_for_simulator(&command(request)) && is_for_simulator(&ack(request)), "{request:?}");
        }
        for other in [MavCmd::MAV_CMD_NAV_RETURN_TO_LAUNCH, MavCmd::MAV_CMD_COMPONENT_ARM_DISARM] {
            assert!(!is_for_simulator(&command(other)) && !is_for_simulator(&ack(other)), "{other:?}");
        }
        assert!(!is_for_simulator(&[]) && !is_for_simulator(&datagram(&station::companion_heartbeat())));
    }

    #[test]
    fn regress_jobs_without_the_hazard_have_no_shadow() {
        assert!(RadioShadow::of(&job(""), 1).is_none() && RadioShadow::of(&job("radio = false"), 1).is_none());
    }
}
