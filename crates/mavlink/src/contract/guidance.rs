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
const LENGTH: usize = 19;

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
    /// All steps, in the order of their codes.
    pub const ALL: [Self; 7] =
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

/// The first maneuver if an obstacle blocks the straight way to the next place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DetourKind {
    /// Fly out from under the bridge.
    OutFromUnder,
    /// Climb.
    Climb,
    /// Descend.
    Descend,
    /// Fly around the obstacle.
    Around,
}

impl DetourKind {
    /// All kinds.
    pub const ALL: [Self; 4] = [Self::OutFromUnder, Self::Climb, Self::Descend, Self::Around];

    /// Returns the number in the message; 0 stands for no detour.
    fn code(self) -> u32 {
        match self {
            Self::OutFromUnder => 1,
            Self::Climb => 2,
            Self::Descend => 3,
            Self::Around => 4,
        }
    }

    /// Returns what to do first, in words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::OutFromUnder => "fly out from under the bridge first",
            Self::Climb => "climb first",
            Self::Descend => "descend first",
            Self::Around => "fly around the obstacle first",
        }
    }
}

/// The way around an obstacle on the straight way to the next place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Detour {
    /// First maneuver.
    pub kind: DetourKind,
    /// The way to a place from which the rest of the way is clear.
    pub way: WayTo,
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
    /// What to do first if the bridge or the ground blocks the straight way to the next place.
    pub detour: Option<Detour>,
}

impl Guidance {
    /// Returns the way to the place to fly to now: around an obstacle first, then to the next place.
    #[must_use]
    pub fn first_way(&self) -> Option<WayTo> {
        self.detour.map(|detour| detour.way).or(self.way)
    }

    /// Returns whether the drone has left the path of a task that was begun.
    #[must_use]
    pub fn is_return(&self) -> bool {
        self.step == GuidanceStep::FlyToTask && self.progress.is_some_and(|progress| progress > 0.0)
    }

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
            count(self.detour.map_or(0, |detour| detour.kind.code())),
            optional(self.detour.map(|detour| detour.way.distance_m)),
            optional(self.detour.map(|detour| detour.way.bearing_rad)),
            optional(self.detour.map(|detour| detour.way.up_m)),
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
            // Older monitors send 0.
            detour: array
                .count(15)
                .and_then(|code| DetourKind::ALL.into_iter().find(|kind| kind.code() == code))
                .zip(array.triple(16))
                .map(|(kind, values)| Detour { kind, way: WayTo::from_values(values) }),
        })
    }

    /// Returns the step in words for a STATUSTEXT message (at most 50 characters), such as
    /// "Task 2: 140 m, 30 deg left, 12 m up".
    #[must_use]
    pub fn words(&self) -> String {
        let task = self.task.map_or_else(String::new, |task| format!("Task {task}: "));
        let first = self.detour.map(|detour| detour.kind.words());
        match self.step {
            GuidanceStep::TakeOff => "Take off".to_owned(),
            GuidanceStep::FlyToTask => match (first, self.way, self.task) {
                (Some(first), ..) => format!("{task}{first}"),
                (None, Some(way), Some(task)) if self.is_return() => format!("Return to task {task}: {}", way.words()),
                (None, Some(way), _) => format!("{task}{}", way.words()),
                (None, None, _) => format!("{task}fly to the path"),
            },
            GuidanceStep::FollowPath => format!("{task}follow the path"),
            GuidanceStep::FlyHome => match (first, self.way) {
                (Some(first), _) => format!("Fly home: {first}"),
                (None, Some(way)) => format!("Fly home: {}", way.words()),
                (None, None) => "Fly home".to_owned(),
            },
            GuidanceStep::Land => "Land on the pad".to_owned(),
            GuidanceStep::Over => "The session is over".to_owned(),
            GuidanceStep::HoldPosition => format!("{task}hold position"),
        }
    }

    /// Returns the way around an obstacle in words for a second STATUSTEXT message, such as "First: 12 m, 90 deg right".
    #[must_use]
    pub fn detour_words(&self) -> Option<String> {
        self.detour.map(|detour| format!("{DETOUR_PREFIX}{}", detour.way.words()))
    }
}

/// Beginning of the text about the way around an obstacle.
pub const DETOUR_PREFIX: &str = "First: ";

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
            detour: None,
        }
    }

    fn with_detour(kind: DetourKind) -> Guidance {
        let way = WayTo { distance_m: 12.0, bearing_rad: 2.0, up_m: -1.5 };
        Guidance { detour: Some(Detour { kind, way }), ..guidance() }
    }

    #[test]
    fn wire_guidance_survives_the_link() {
        for step in GuidanceStep::ALL {
            assert_survives(Guidance { step, ..guidance() });
        }
        DetourKind::ALL.into_iter().for_each(|kind| assert_survives(with_detour(kind)));
    }

    fn assert_survives(sent: Guidance) {
        let bytes = Encoder::new(1, 191).encode(&sent.message(5_000_000));
        let received = Decoder::new().datagram(&bytes).remove(0).message.unwrap();
        assert_eq!(Guidance::of(&received), Some(sent));
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
        // An older monitor sends zeros, a newer one perhaps another kind.
        let zeros = |array: &mut DEBUG_FLOAT_ARRAY_DATA| array.data[15..].fill(0.0);
        assert_eq!(of(&zeros), Some(guidance()));
        assert_eq!(of(&|array| array.data[15..19].copy_from_slice(&[5.0, 1.0, 1.0, 1.0])), Some(guidance()));
    }

    #[test]
    fn exact_words_fit_into_a_status_text() {
        let begins = Guidance { progress: Some(0.0), ..guidance() };
        assert_eq!(begins.words(), "Task 2: 140 m, 29 deg left, 12 m up");
        let way = WayTo { distance_m: 12_345.0, bearing_rad: 3.1, up_m: -123.0 };
        for step in GuidanceStep::ALL {
            let words = Guidance { step, way: Some(way), task: Some(4), ..guidance() }.words();
            assert!(words.len() <= 50 && words.is_ascii(), "{words}");
        }
        let near = WayTo { distance_m: 8.0, bearing_rad: 0.05, up_m: 0.4 };
        assert_eq!(Guidance { step: GuidanceStep::FlyHome, way: Some(near), ..guidance() }.words(), "Fly home: 8 m, ahead");
        let passed = WayTo { distance_m: 60.0, bearing_rad: -3.1, up_m: 0.0 };
        assert_eq!(Guidance { way: Some(passed), ..begins }.words(), "Task 2: 60 m, behind you");
    }

    #[test]
    fn regress_the_way_back_to_a_task_that_was_begun_is_called_a_return() {
        assert_eq!(guidance().words(), "Return to task 2: 140 m, 29 deg left, 12 m up");
        assert!(!Guidance { step: GuidanceStep::FollowPath, ..guidance() }.is_return());
    }

    #[test]
    fn regress_words_say_what_to_do_before_the_way_is_clear() {
        let under = with_detour(DetourKind::OutFromUnder);
        assert_eq!(under.words(), "Task 2: fly out from under the bridge first");
        assert_eq!(under.detour_words().as_deref(), Some("First: 12 m, 115 deg right, 2 m down"));
        assert_eq!(under.first_way().map(|way| way.distance_m), Some(12.0));
        assert_eq!(Guidance { step: GuidanceStep::FlyHome, ..with_detour(DetourKind::Climb) }.words(), "Fly home: climb first");
        assert_eq!((guidance().detour_words(), guidance().first_way()), (None, guidance().way));
        for (kind, step) in
            DetourKind::ALL.into_iter().flat_map(|kind| [GuidanceStep::FlyToTask, GuidanceStep::FlyHome].map(|step| (kind, step)))
        {
            let words = Guidance { step, task: Some(64), ..with_detour(kind) }.words();
            assert!(words.len() <= 50, "{words}");
        }
    }
}
