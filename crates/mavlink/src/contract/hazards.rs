//! How strongly the bridges and the water disturb the compass, the radio, the air and the sensors of the aircraft, for instructors, displays
//! and reports.
//!
//! DEBUG_FLOAT_ARRAY with the name `hazards`. NaN stands for a value that the job does not simulate. The layout only grows at its end.

use super::float_array::{self, FloatArray, optional};
use crate::dialect::MavMessage;
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::radio::RadioWay;
use spandrel_model::time::SimTime;

/// Name in the message.
pub const NAME: &str = "hazards";
/// Age at which a report that was not repeated is out of date; the vehicle repeats it at 2 Hz.
pub const TIMEOUT: SimTime = SimTime::from_ms(2_500);
/// Lowest margin that is sent, dB. It stands for all lower ones.
pub const MIN_MARGIN_DB: f64 = -100.0;

/// All ways of a signal, in the order of their codes.
const WAYS: [RadioWay; 4] = [RadioWay::LineOfSight, RadioWay::AroundEdge, RadioWay::ThroughConcrete, RadioWay::Blocked];

/// State of the links between the pilot and the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RadioMargins {
    /// How much stronger the control signal is than the receiver's sensitivity, dB.
    pub control_db: f64,
    /// The same for the video signal, dB.
    pub video_db: f64,
    /// How the control signal arrives.
    pub way: RadioWay,
    /// Number of times that control was lost since the start of the simulation.
    pub losses: u32,
}

/// Counters restart at this number, so that a 32-bit float holds them exactly.
const COUNTER_RANGE: u32 = 1_000_000;

/// Value that marks the presence of the wake and the water, which older vehicles don't report: their message ends before, with zeros.
const HAS_AIR_AND_WATER: f32 = 1.0;

/// Optical flow and the range finder that looks down, over water.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WaterSensors {
    /// Whether the flow sensor finds nothing to track because there is only water in its reach.
    pub flow_lost: bool,
    /// Number of readings of the range finder over water since the start of the simulation.
    pub ranges: u32,
    /// Number of those that had no result.
    pub lost_ranges: u32,
}

/// The hazards that a job simulates and that no standard message reports.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HazardReport {
    /// Angle by which steel turns the compass, rad, clockwise positive.
    pub compass_rad: Option<f64>,
    /// State of the radio links.
    pub radio: Option<RadioMargins>,
    /// Largest velocity that the bridges added to the wind at the aircraft in the last half second, m/s.
    pub wake_m_s: Option<Vec3<Ned>>,
    /// Sensors over water.
    pub water: Option<WaterSensors>,
}

impl HazardReport {
    /// Encodes the message. `time_us` is the simulation time, µs.
    #[must_use]
    pub fn message(&self, time_us: u64) -> MavMessage {
        let margin = |db: f64| db.max(MIN_MARGIN_DB);
        let code = |way| WAYS.iter().position(|known| *known == way).map(|code| code as f64);
        let values = [
            optional(self.compass_rad),
            optional(self.radio.map(|radio| margin(radio.control_db))),
            optional(self.radio.map(|radio| margin(radio.video_db))),
            optional(self.radio.and_then(|radio| code(radio.way))),
            optional(self.radio.map(|radio| f64::from(radio.losses))),
            HAS_AIR_AND_WATER,
            optional(self.wake_m_s.map(|added| added.north())),
            optional(self.wake_m_s.map(|added| added.east())),
            optional(self.wake_m_s.map(|added| added.down())),
            optional(self.water.map(|water| f64::from(u8::from(water.flow_lost)))),
            optional(self.water.map(|water| f64::from(water.ranges % COUNTER_RANGE))),
            optional(self.water.map(|water| f64::from(water.lost_ranges % COUNTER_RANGE))),
        ];
        float_array::message(NAME, time_us, values)
    }

    /// Decodes a message; `None` for other messages.
    #[must_use]
    pub fn of(message: &MavMessage) -> Option<Self> {
        let array = FloatArray::named(NAME, message)?;
        let way = array.count(3).and_then(|number| WAYS.get(number as usize).copied());
        let radio = array.finite(1).zip(array.finite(2)).zip(way).zip(array.count(4));
        let radio = radio.map(|(((control_db, video_db), way), losses)| RadioMargins { control_db, video_db, way, losses });
        let has_more = array.raw(5) == HAS_AIR_AND_WATER;
        let wake_m_s = array.triple(6).filter(|_| has_more).map(|[north, east, down]| Vec3::new(north, east, down));
        let water = array.count(9).zip(array.count(10)).zip(array.count(11)).filter(|_| has_more);
        let water = water.map(|((flow, ranges), lost_ranges)| WaterSensors { flow_lost: flow > 0, ranges, lost_ranges });
        Some(Self { compass_rad: array.finite(0), radio, wake_m_s, water })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::{Decoder, Encoder};

    fn received(report: HazardReport) -> Option<HazardReport> {
        let bytes = Encoder::new(1, 1).encode(&report.message(5_000_000));
        HazardReport::of(&Decoder::new().datagram(&bytes).remove(0).message.unwrap())
    }

    #[test]
    fn wire_reports_survive_the_link_with_and_without_each_hazard() {
        for way in WAYS {
            let radio = RadioMargins { control_db: 12.5, video_db: -3.25, way, losses: 2 };
            let wake_m_s = Some(Vec3::new(-4.5, 0.25, 1.5));
            let water = Some(WaterSensors { flow_lost: true, ranges: 40, lost_ranges: 19 });
            for report in [
                HazardReport { compass_rad: Some(-0.25), radio: Some(radio), wake_m_s, water },
                HazardReport { radio: Some(radio), ..HazardReport::default() },
                HazardReport { compass_rad: Some(0.5), wake_m_s, ..HazardReport::default() },
                HazardReport { water, ..HazardReport::default() },
                HazardReport::default(),
            ] {
                assert_eq!(received(report), Some(report));
            }
        }
    }

    #[test]
    fn wire_reports_of_older_vehicles_have_neither_wakes_nor_water() {
        let radio = RadioMargins { control_db: 12.5, video_db: -3.25, way: RadioWay::AroundEdge, losses: 2 };
        let older = HazardReport { compass_rad: Some(-0.25), radio: Some(radio), wake_m_s: None, water: None };
        let message = float_array::message(NAME, 5_000_000, [-0.25, 12.5, -3.25, 1.0, 2.0]);
        assert_eq!(HazardReport::of(&message), Some(older));
    }

    #[test]
    fn exact_blocked_signals_have_the_lowest_margin() {
        let radio =
            RadioMargins { control_db: f64::NEG_INFINITY, video_db: f64::NEG_INFINITY, way: RadioWay::Blocked, losses: 0 };
        let read = received(HazardReport { radio: Some(radio), ..HazardReport::default() }).unwrap().radio.unwrap();
        assert_eq!((read.control_db, read.video_db), (MIN_MARGIN_DB, MIN_MARGIN_DB));
    }
}
