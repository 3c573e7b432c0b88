//! The monitor's guidance: the next step of the job and the way to it, for displays and ground stations.
//!
//! DEBUG_FLOAT_ARRAY with the name `guidance`. NaN stands for a value that does not exist in this step. The layout only
//! grows at its end.

use super::float_array::{self, FloatArray, optional};
use crate::dialect::MavMessage;
use spandrel_model::time::SimTime;

/// Name in the message.
pub const NAME: &str = "guidance";
/// Age at which a step that was not repeated is out of date; the monitor repeats it at 5 Hz.
pub const TIMEOUT: SimTime = SimTime::from_ms(1_500);
/// Number of values.
const LENGTH: usize = 15;

/// The pilot's next step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum GuidanceStep {
    /// Take off.
    TakeOff,
    /// Fly to the path of the task.
    FlyToTask,
    /// Fly along the path of the task.
    FollowPath,
    /// All tasks are done: fly to the pad.
    FlyHome,
    /// Land on the pad.
    Land,
    /// The session is over.
    Over,
    /// Hold position at the path of the task, which is too short to be flown along.
    HoldPosition,
}

impl GuidanceStep {
    const ALL: [Self; 7] =
        [Self::TakeOff, Self::FlyToTask, Self::FollowPath, Self::FlyHome, Self::Land, Self::Over, Self::HoldPosition];

    fn code(self) -> f32 {
        match self {
            Self::TakeOff => 0.0,
            Self::FlyToTask => 1.0,
            Self::FollowPath => 2.0,
            Self::FlyHome => 3.0,
            Self::Land => 4.0,
            Self::Over => 5.0,
            Self::HoldPosition => 6.0,
        }
    }

    fn from_code(code: f32) -> Option<Self> {
        Self::ALL.into_iter().find(|step| step.code().to_bits() == code.to_bits())
    }
}

/// The way to a place, as seen from the aircraft.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayTo {
    /// Horizontal distance, m.
    pub distance_m: f64,
    /// Direction relative to the aircraft's heading, rad, from −π to π; clockwise positive.
    pub bearing_rad: f64,
    /// Height above the aircraft, m.
    pub up_m: f64,
}

/// Direction of a place relative to the aircraft's heading, as shown to the pilot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TurnTo {
    /// Straight ahead.
    Ahead,
    /// Behind the aircraft.
    Behind,
    /// To the left by this angle, deg.
    Left(f64),
    /// To the right by this angle, deg.
    Right(f64),
}

/// The aircraft's position relative to the task's path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathDeviation {
    /// Distance from the path, m.
    pub distance_m: f64,
    /// Height above the path, m; negative below.
    pub above_m: f64,
}

/// The distance from the inspected surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandOffReading {
    /// Distance, m.
    pub actual_m: f64,
    /// Recommended distance, m.
    pub recommended_m: f64,
    /// Largest deviation without a cue, m.
    pub tolerance_m: f64,
}

/// The next step of the job.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guidance {
    /// The step.
    pub step: GuidanceStep,
    /// Number of the task in the scenario, if the step belongs to a task.
    pub task: Option<u32>,
    /// The way to the next place: the start or the next part of the path, or the pad.
    pub way: Option<WayTo>,
    /// Fraction of the task's path that was flown, 0 to 1.
    pub progress: Option<f64>,
    /// Number of tasks that are done.
    pub tasks_done: u32,
    /// Number of tasks.
    pub tasks: u32,
    /// Position relative to the task's path, while the drone is near it.
    pub deviation: Option<PathDeviation>,
    /// Distance from the inspected surface, while the drone is near the path of a task with a recommended stand-off.
    pub stand_off: Option<StandOffReading>,
    /// Flight time, s.
    pub flown_s: f64,
    /// Time that the job needs, s.
    pub needed_s: f64,
}

impl Guidance {
    /// Encodes the message. `time_us` is the simulation time, µs.
    #[must_use]
    pub fn message(&self, time_us: u64) -> MavMessage {
        float_array::message(NAME, time_us, self.values())
    }

    fn values(&self) -> [f32; LENGTH] {
        let count = |value: u32| value as f32;
        [
            self.step.code(),
            count(self.task.unwrap_or(0)),
            optional(self.way.map(|way| way.distance_m)),
            optional(self.way.map(|way| way.bearing_rad)),
            optional(self.way.map(|way| way.up_m)),
            optional(self.progress),
            count(self.tasks_done),
            count(self.tasks),
            optional(self.deviation.map(|deviation| deviation.distance_m)),
            optional(self.deviation.map(|deviation| deviation.above_m)),
            optional(self.stand_off.map(|reading| reading.actual_m)),
            optional(self.stand_off.map(|reading| reading.recommended_m)),
            optional(self.stand_off.map(|reading| reading.tolerance_m)),
            optional(Some(self.flown_s)),
            optional(Some(self.needed_s)),
        ]
    }

    /// Decodes a message; `None` for other messages and for values that are out of range.
    #[must_use]
    pub fn of(message: &MavMessage) -> Option<Self> {
        let array = FloatArray::named(NAME, message)?;
        Some(Self {
            step: GuidanceStep::from_code(array.raw(0))?,
            task: array.count(1).filter(|task| *task > 0),
            way: array.triple(2).map(WayTo::from_values),
            progress: array.finite(5),
            tasks_done: array.count(6)?,
            tasks: array.count(7)?,
            deviation: array.finite(8).zip(array.finite(9)).map(|(distance_m, above_m)| PathDeviation { distance_m, above_m }),
            stand_off: array.triple(10).map(|[actual_m, recommended_m, tolerance_m]| StandOffReading {
                actual_m,
                recommended_m,
                tolerance_m,
            }),
            flown_s: array.finite(13)?,
            needed_s: array.finite(14)?,
        })
    }

    /// Returns the step in words for a STATUSTEXT message (at most 50 characters), such as
    /// "Task 2: 140 m, 30 deg left, 12 m up".
    #[must_use]
    pub fn words(&self) -> String {
        let task = self.task.map_or_else(String::new, |task| format!("Task {task}: "));
        match self.step {
            GuidanceStep::TakeOff => "Take off".to_owned(),
            GuidanceStep::FlyToTask => match self.way {
                Some(way) => format!("{task}{}", way.words()),
                None => format!("{task}fly to the path"),
            },
            GuidanceStep::FollowPath => format!("{task}follow the path"),
            GuidanceStep::FlyHome => match self.way {
                Some(way) => format!("Fly home: {}", way.words()),
                None => "Fly home".to_owned(),
            },
            GuidanceStep::Land => "Land on the pad".to_owned(),
            GuidanceStep::Over => "The session is over".to_owned(),
            GuidanceStep::HoldPosition => format!("{task}hold position"),
        }
    }
}

/// Smallest turn that is worth mentioning, deg (estimate: a person cannot judge a smaller one).
const MIN_TURN_DEG: f64 = 5.0;
/// Smallest height difference that is worth mentioning, m (estimate).
const MIN_HEIGHT_M: f64 = 1.0;

impl WayTo {
    /// Returns the way from its distance, bearing and height.
    pub(super) fn from_values([distance_m, bearing_rad, up_m]: [f64; 3]) -> Self {
        Self { distance_m, bearing_rad, up_m }
    }

    /// Returns the direction as shown to the pilot.
    #[must_use]
    pub fn turn(&self) -> TurnTo {
        let turn_deg = self.bearing_rad.to_degrees();
        match turn_deg.abs() {
            small if small < MIN_TURN_DEG => TurnTo::Ahead,
            large if large > 180.0 - MIN_TURN_DEG => TurnTo::Behind,
            large if turn_deg < 0.0 => TurnTo::Left(large),
            large => TurnTo::Right(large),
        }
    }

    /// Returns the height above the aircraft as shown to the pilot, m; `None` if it is too small to mention.
    #[must_use]
    pub fn height_m(&self) -> Option<f64> {
        (self.up_m.abs() >= MIN_HEIGHT_M).then_some(self.up_m)
    }

    /// Returns the way in words, such as "140 m, 30 deg left, 12 m up" or "60 m, behind you".
    #[must_use]
    pub fn words(&self) -> String {
        let turn = match self.turn() {
            TurnTo::Ahead => "ahead".to_owned(),
            TurnTo::Behind => "behind you".to_owned(),
            TurnTo::Left(turn_deg) => format!("{turn_deg:.0} deg left"),
            TurnTo::Right(turn_deg) => format!("{turn_deg:.0} deg right"),
        };
        let height = match self.height_m() {
            None => String::new(),
            Some(up_m) => format!(", {:.0} m {}", up_m.abs(), if up_m < 0.0 { "down" } else { "up" }),
        };
        format!("{:.0} m, {turn}{height}", self.distance_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::{Decoder, Encoder};
    use crate::dialect::DEBUG_FLOAT_ARRAY_DATA;

    fn guidance() -> Guidance {
        Guidance {
            step: GuidanceStep::FlyToTask,
            task: Some(2),
            way: Some(WayTo { distance_m: 140.0, bearing_rad: -0.5, up_m: 12.0 }),
            progress: Some(0.25),
            tasks_done: 1,
            tasks: 4,
            deviation: None,
            stand_off: Some(StandOffReading { actual_m: 6.5, recommended_m: 5.0, tolerance_m: 1.5 }),
            flown_s: 75.0,
            needed_s: 480.0,
        }
    }

    #[test]
    fn wire_guidance_survives_the_link() {
        for step in GuidanceStep::ALL {
            let sent = Guidance { step, ..guidance() };
            let bytes = Encoder::new(1, 191).encode(&sent.message(5_000_000));
            let received = Decoder::new().datagram(&bytes).remove(0).message.unwrap();
            assert_eq!(Guidance::of(&received), Some(sent));
        }
    }

    #[test]
    fn exact_foreign_arrays_and_values_out_of_range_are_no_guidance() {
        let MavMessage::DEBUG_FLOAT_ARRAY(array) = guidance().message(0) else { panic!("another message") };
        let of = |change: &dyn Fn(&mut DEBUG_FLOAT_ARRAY_DATA)| {
            let mut other = array.clone();
            change(&mut other);
            Guidance::of(&MavMessage::DEBUG_FLOAT_ARRAY(other))
        };
        assert_eq!(of(&|_| {}), Some(guidance()));
        assert_eq!(of(&|array| array.name = "other".into()), None);
        for step in [-1.0, 0.5, 7.0, f32::NAN, f32::INFINITY] {
            assert_eq!(of(&|array| array.data[0] = step), None, "{step}");
        }
        assert_eq!(of(&|array| array.data[6] = f32::NAN), None);
        assert_eq!(of(&|array| array.data[3] = f32::NAN).unwrap().way, None);
    }

    #[test]
    fn exact_words_fit_into_a_status_text() {
        assert_eq!(guidance().words(), "Task 2: 140 m, 29 deg left, 12 m up");
        let way = WayTo { distance_m: 12_345.0, bearing_rad: 3.1, up_m: -123.0 };
        for step in GuidanceStep::ALL {
            let words = Guidance { step, way: Some(way), task: Some(4), ..guidance() }.words();
            assert!(words.len() <= 50 && words.is_ascii(), "{words}");
        }
        let near = WayTo { distance_m: 8.0, bearing_rad: 0.05, up_m: 0.4 };
        assert_eq!(Guidance { step: GuidanceStep::FlyHome, way: Some(near), ..guidance() }.words(), "Fly home: 8 m, ahead");
        let passed = WayTo { distance_m: 60.0, bearing_rad: -3.1, up_m: 0.0 };
        assert_eq!(Guidance { way: Some(passed), ..guidance() }.words(), "Task 2: 60 m, behind you");
    }
}
