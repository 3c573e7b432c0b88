//! Measures that the plan's rules evaluate.

/// Measure that a rule compares with its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RuleMeasure {
    /// Measured for each task.
    Task(TaskMeasure),
    /// Measured for the whole session.
    Session(SessionMeasure),
}

/// Measure of one task.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TaskMeasure {
    /// Fraction of the task's time off its path.
    OffPath,
    /// Mean vertical distance from the path while off it, m; only if that is more than a tenth of the task's time.
    OffHeight,
    /// Fraction of the task's time above the speed limit.
    Speeding,
    /// Number of contacts in the task's window, merged if they are less than a second apart.
    Crashes,
    /// 1 if the drone neither flew nor passed at least 40% of the path.
    NotAttempted,
    /// Fraction of the path that the drone neither flew nor passed within 8 m, if it entered or passed it.
    NotCovered,
    /// Fraction of the path that the drone passed within 8 m without being on it.
    BesidePath,
    /// Median distance from the surface beyond the path's stand-off, m.
    TooFar,
    /// Median distance from the surface below the path's stand-off, m.
    TooClose,
    /// Change of the distance from the surface: half its range, without the outermost tenths, m; from 20 s near the path.
    UnevenStandOff,
    /// Median height below the path, m.
    TooLow,
    /// Median height above the path, m.
    TooHigh,
    /// Change of the height above the path: half its range, without the outermost tenths, m; from 20 s near the path.
    UnevenHeight,
    /// Fraction of the time near the path below the minimum clearance.
    LowClearance,
    /// RMS framing error of the certification profile, degrees; from 20 s near the path.
    Framing,
    /// Fraction of the time near the path of a dark task with the lamp off; from 20 s there.
    LampOff,
    /// Reversals of the forward, right and up sticks per minute near the path; from 20 s there.
    StickReversals,
    /// Reversals of the yaw stick per minute near the path; from 20 s there.
    YawReversals,
    /// Jumps of the forward, right and up sticks per minute near the path; from 20 s there.
    StickJumps,
    /// Fraction of the pictures near the path of a dark task that were taken with the lamp off, if there are at least two.
    UnlitPictures,
    /// Fraction of a done task's defects not shown in any picture, if it has at least two.
    MissedAtTask,
}

/// Measure of a whole session.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SessionMeasure {
    /// Number of merged contacts outside all task windows.
    CrashesOutside,
    /// Number of merged contacts.
    CrashesAll,
    /// Fraction of defects not shown in any picture.
    Missed,
    /// Number of missed defects in condition state 3 (poor) or worse.
    MissedSevere,
    /// Longest time that a missed defect was clearly visible, s; available only if the session has a report.
    MissedInView,
    /// Fraction of the defects that face away from the path's viewing direction and are not shown in any picture.
    MissedHidden,
    /// Fraction of the cracks and other lines that are not shown in any picture.
    MissedLines,
    /// Fraction of the found defects of which no picture has sufficient quality for the certification.
    PoorPictures,
    /// 1 if there were defects to photograph but no picture was taken.
    NoPictures,
    /// Fraction of pictures that show no new defect, if there are at least four and the job has defects.
    FalseSnapshots,
    /// Fraction of pictures taken above 0.5 m/s, if there are at least four.
    MovingPictures,
    /// Fraction of pictures taken at 0.2 to 0.5 m/s, if there are at least four.
    DriftingPictures,
    /// Fraction of pictures taken while turning, if there are at least four.
    TurningPictures,
    /// Time near the landing pad before the end of the flight, s.
    Landing,
    /// Flight time beyond the time for full efficiency, min.
    Overtime,
    /// Flight time beyond what the job needs, as a fraction of that; a plan evaluates it in jobs only, not in drills and in the lesson.
    Slow,
    /// 1 if the flight did not end with a landing at home.
    NotLanded,
    /// 1 if the battery charge was below 20% at the end.
    BatteryLow,
    /// 1 if the battery was empty or the time limit reached before the landing.
    BatteryFailed,
    /// Time below the minimum clearance, s.
    Exposure,
}

/// Unit of a measure, which determines how values are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeasureUnit {
    /// Fraction, shown in percent.
    Fraction,
    /// Whole number.
    Count,
    /// Meters.
    Meters,
    /// Seconds.
    Seconds,
    /// Minutes.
    Minutes,
    /// Degrees.
    Degrees,
    /// Events per minute.
    PerMinute,
}

/// Keywords of all measures in rules files.
pub const MEASURES: &[(&str, RuleMeasure)] = &[
    ("off_path", RuleMeasure::Task(TaskMeasure::OffPath)),
    ("off_height", RuleMeasure::Task(TaskMeasure::OffHeight)),
    ("speeding", RuleMeasure::Task(TaskMeasure::Speeding)),
    ("crashes", RuleMeasure::Task(TaskMeasure::Crashes)),
    ("not_attempted", RuleMeasure::Task(TaskMeasure::NotAttempted)),
    ("not_covered", RuleMeasure::Task(TaskMeasure::NotCovered)),
    ("beside_path", RuleMeasure::Task(TaskMeasure::BesidePath)),
    ("too_far", RuleMeasure::Task(TaskMeasure::TooFar)),
    ("too_close", RuleMeasure::Task(TaskMeasure::TooClose)),
    ("uneven_stand_off", RuleMeasure::Task(TaskMeasure::UnevenStandOff)),
    ("too_low", RuleMeasure::Task(TaskMeasure::TooLow)),
    ("too_high", RuleMeasure::Task(TaskMeasure::TooHigh)),
    ("uneven_height", RuleMeasure::Task(TaskMeasure::UnevenHeight)),
    ("low_clearance", RuleMeasure::Task(TaskMeasure::LowClearance)),
    ("framing", RuleMeasure::Task(TaskMeasure::Framing)),
    ("lamp_off", RuleMeasure::Task(TaskMeasure::LampOff)),
    ("stick_reversals", RuleMeasure::Task(TaskMeasure::StickReversals)),
    ("yaw_reversals", RuleMeasure::Task(TaskMeasure::YawReversals)),
    ("stick_jumps", RuleMeasure::Task(TaskMeasure::StickJumps)),
    ("unlit_pictures", RuleMeasure::Task(TaskMeasure::UnlitPictures)),
    ("missed_at_task", RuleMeasure::Task(TaskMeasure::MissedAtTask)),
    ("crashes_outside", RuleMeasure::Session(SessionMeasure::CrashesOutside)),
    ("crashes_all", RuleMeasure::Session(SessionMeasure::CrashesAll)),
    ("missed", RuleMeasure::Session(SessionMeasure::Missed)),
    ("missed_severe", RuleMeasure::Session(SessionMeasure::MissedSevere)),
    ("missed_in_view", RuleMeasure::Session(SessionMeasure::MissedInView)),
    ("missed_hidden", RuleMeasure::Session(SessionMeasure::MissedHidden)),
    ("missed_lines", RuleMeasure::Session(SessionMeasure::MissedLines)),
    ("poor_pictures", RuleMeasure::Session(SessionMeasure::PoorPictures)),
    ("no_pictures", RuleMeasure::Session(SessionMeasure::NoPictures)),
    ("false_snapshots", RuleMeasure::Session(SessionMeasure::FalseSnapshots)),
    ("moving_pictures", RuleMeasure::Session(SessionMeasure::MovingPictures)),
    ("drifting_pictures", RuleMeasure::Session(SessionMeasure::DriftingPictures)),
    ("turning_pictures", RuleMeasure::Session(SessionMeasure::TurningPictures)),
    ("landing", RuleMeasure::Session(SessionMeasure::Landing)),
    ("overtime", RuleMeasure::Session(SessionMeasure::Overtime)),
    ("slow", RuleMeasure::Session(SessionMeasure::Slow)),
    ("not_landed", RuleMeasure::Session(SessionMeasure::NotLanded)),
    ("battery_low", RuleMeasure::Session(SessionMeasure::BatteryLow)),
    ("battery_failed", RuleMeasure::Session(SessionMeasure::BatteryFailed)),
    ("exposure", RuleMeasure::Session(SessionMeasure::Exposure)),
];

impl RuleMeasure {
    /// Returns whether the measure means nothing in drills and in the lesson.
    pub(super) fn is_about_jobs(self) -> bool {
        self == Self::Session(SessionMeasure::Slow)
    }

    /// Returns the measure's unit.
    #[must_use]
    pub fn unit(self) -> MeasureUnit {
        match self {
            Self::Task(measure) => measure.unit(),
            Self::Session(measure) => measure.unit(),
        }
    }
}

impl TaskMeasure {
    fn unit(self) -> MeasureUnit {
        match self {
            Self::OffPath
            | Self::Speeding
            | Self::NotCovered
            | Self::BesidePath
            | Self::LowClearance
            | Self::LampOff
            | Self::UnlitPictures
            | Self::MissedAtTask => MeasureUnit::Fraction,
            Self::OffHeight
            | Self::TooFar
            | Self::TooClose
            | Self::TooLow
            | Self::TooHigh
            | Self::UnevenStandOff
            | Self::UnevenHeight => MeasureUnit::Meters,
            Self::Crashes | Self::NotAttempted => MeasureUnit::Count,
            Self::Framing => MeasureUnit::Degrees,
            Self::StickReversals | Self::YawReversals | Self::StickJumps => MeasureUnit::PerMinute,
        }
    }
}

impl SessionMeasure {
    fn unit(self) -> MeasureUnit {
        match self {
            Self::Missed
            | Self::MissedHidden
            | Self::MissedLines
            | Self::PoorPictures
            | Self::FalseSnapshots
            | Self::MovingPictures
            | Self::DriftingPictures
            | Self::TurningPictures
            | Self::Slow => MeasureUnit::Fraction,
            Self::MissedInView | Self::Exposure | Self::Landing => MeasureUnit::Seconds,
            Self::Overtime => MeasureUnit::Minutes,
            Self::CrashesOutside
            | Self::CrashesAll
            | Self::MissedSevere
            | Self::NoPictures
            | Self::NotLanded
            | Self::BatteryLow
            | Self::BatteryFailed => MeasureUnit::Count,
        }
    }
}
