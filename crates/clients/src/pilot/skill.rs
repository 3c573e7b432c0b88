//! The synthetic trainee's numbers: pace, visual search, photography, control, orientation and judgment. Errors result from
//! these numbers; none are scripted.

use spandrel_model::math;
use std::str::FromStr;

/// Exponent of the power law of practice for a trainee who repeats the job (Newell and Rosenbloom 1981 report 0.2 to 0.6 for
/// most skills; the value is an estimate).
pub const LEARNING_EXPONENT: f64 = 0.4;

/// The numbers that describe how a pilot flies. Sources: docs/src/reference/pilot.md.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Skill {
    /// Delay from an event to the control response, s.
    pub delay_s: f64,
    /// Gain of the position and heading loops, relative to the trained pilot.
    pub gain: f64,
    /// Noise of perception and motor control, relative to the trained pilot.
    pub noise: f64,
    /// Visual preview time, s.
    pub preview_s: f64,
    /// Attention lapses per minute; during a lapse, the sticks do not move.
    pub lapses_per_min: f64,
    /// Time until the pilot notices a displayed cue that the aircraft is off the path, s.
    pub notice_cue_s: f64,
    /// Preferred speed along a surface under inspection, m/s.
    pub speed_m_s: f64,
    /// Largest speed along a path, relative to a prudent one for the kind of task.
    pub path_speed_ratio: f64,
    /// Preferred speed between tasks, m/s.
    pub transit_speed_m_s: f64,
    /// Time to the nearest surface that the pilot keeps, s: limits the speed near structure.
    pub time_gap_s: f64,
    /// Distance between stops to look at the surface, m.
    pub look_spacing_m: f64,
    /// Mean time to look in one direction during a stop, s.
    pub look_duration_s: f64,
    /// Angle by which the pilot turns the camera up, down, left and right during a stop, degrees.
    pub look_sweep_deg: f64,
    /// Battery charge at which the pilot returns, %.
    pub return_battery_pct: f64,
    /// Time between fixations, s.
    pub fixation_s: f64,
    /// Fraction of the picture that one fixation examines, 0 to 1.
    pub fixation_area: f64,
    /// Defect length that is detected with a probability of 50%, mm.
    pub median_length_mm: f64,
    /// Marks that the pilot mistakes for defects, per minute of search.
    pub false_alarms_per_min: f64,
    /// Distance from which the pilot photographs, as a multiple of the largest distance that meets the job's ground
    /// sampling distance.
    pub photo_distance_ratio: f64,
    /// Speed below which the pilot takes a picture, m/s.
    pub photo_speed_m_s: f64,
    /// Turn rate below which the pilot takes a picture, degrees/s.
    pub photo_turn_deg_s: f64,
    /// Time for which the image must be steady before the pilot presses the shutter, s.
    pub steady_s: f64,
    /// Angle from the center of the picture below which the pilot accepts the framing, degrees.
    pub framing_deg: f64,
    /// Angle between the line of sight and the surface normal up to which the pilot photographs, degrees.
    pub photo_incidence_deg: f64,
    /// Probability of photographing a defect again after a good picture, 0 to 1.
    pub doubt: f64,
    /// Time after which the pilot gives up on photographing a defect, s.
    pub patience_s: f64,
    /// Episodes of lost orientation per minute, in which the pilot moves sticks the wrong way.
    pub disorientations_per_min: f64,
    /// Mean time until the pilot notices the error, s.
    pub recovery_s: f64,
    /// Growth of the distance on the task panel at which the pilot notices the error, m; 0 for a pilot who does not look at it.
    pub panel_growth_m: f64,
    /// Perceived distance to a surface divided by the true distance.
    pub distance_ratio: f64,
    /// Perceived distance to a surface above, divided by that to one beside at the same true distance.
    pub upward_distance_ratio: f64,
    /// Drifting relative error of perceived distances (1 sigma).
    pub distance_error: f64,
    /// Drifting error of the perceived position, m (1 sigma per axis).
    pub position_error_m: f64,
}

/// A group of numbers; used to swap one group between pilots.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SkillFactor {
    /// Selects [`Skill::delay_s`].
    Delay,
    /// Selects [`Skill::gain`].
    Gain,
    /// Selects [`Skill::noise`].
    Noise,
    /// Selects [`Skill::preview_s`].
    Preview,
    /// Selects the numbers of attention: lapses and noticed cues.
    Lapses,
    /// Selects the chosen speeds, stops and battery reserve.
    Pace,
    /// Selects the numbers of the visual search.
    Search,
    /// Selects the numbers of photography.
    Photo,
    /// Selects the numbers of lost orientation.
    Orientation,
    /// Selects the judgment of distances and positions.
    Judgment,
}

impl SkillFactor {
    /// All factors.
    pub const ALL: [Self; 10] = [
        Self::Delay,
        Self::Gain,
        Self::Noise,
        Self::Preview,
        Self::Lapses,
        Self::Pace,
        Self::Search,
        Self::Photo,
        Self::Orientation,
        Self::Judgment,
    ];

    /// Returns the name used on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Delay => "delay",
            Self::Gain => "gain",
            Self::Noise => "noise",
            Self::Preview => "preview",
            Self::Lapses => "lapses",
            Self::Pace => "pace",
            Self::Search => "search",
            Self::Photo => "photo",
            Self::Orientation => "orientation",
            Self::Judgment => "judgment",
        }
    }
}

impl FromStr for SkillFactor {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL.into_iter().find(|factor| factor.name() == text).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("unknown factor '{text}' (allowed: {names})")
        })
    }
}

/// One number of [`Skill`]: its key in a pilot file, unit, allowed range and source.
pub struct SkillField {
    /// Key in a pilot file.
    pub key: &'static str,
    /// Unit symbol; empty for ratios.
    pub unit: &'static str,
    /// Smallest and largest allowed value.
    pub range: (f64, f64),
    /// The group to which the number belongs.
    pub factor: SkillFactor,
    /// Meaning, for the reference page.
    pub meaning: &'static str,
    /// Source of the three skill levels' values, for the reference page.
    pub source: &'static str,
    /// Returns the value.
    pub get: fn(&Skill) -> f64,
    /// Changes the value.
    pub set: fn(&mut Skill, f64),
}

macro_rules! field {
    ($name:ident, $unit:literal, $low:literal to $high:literal, $factor:ident, $meaning:literal, $source:literal) => {
        SkillField {
            key: stringify!($name),
            unit: $unit,
            range: ($low, $high),
            factor: SkillFactor::$factor,
            meaning: $meaning,
            source: $source,
            get: |skill| skill.$name,
            set: |skill, value| skill.$name = value,
        }
    };
}

/// All numbers, in the order of the reference page.
#[rustfmt::skip]
pub const FIELDS: [SkillField; 33] = [
    field!(delay_s, "s", 0.0 to 0.9, Delay, "delay from an event to the control response", "Pfeiffer and Scaramuzza: 220 ms; others estimate"),
    field!(gain, "", 0.1 to 2.0, Gain, "gain of the position and heading loops, relative to the trained pilot", "estimate"),
    field!(noise, "", 0.0 to 6.0, Noise, "noise of perceived speed and heading, and of the hands, relative to the trained pilot", "estimate; McRuer and Jex for the trained pilot's hands"),
    field!(preview_s, "s", 0.2 to 4.0, Preview, "look-ahead of the gaze", "Pfeiffer and Scaramuzza: 1.5 s; novice estimate"),
    field!(lapses_per_min, "1/min", 0.0 to 30.0, Lapses, "attention lapses of 1 to 3 s, during which the sticks don't move", "estimate"),
    field!(notice_cue_s, "s", 0.0 to 120.0, Lapses, "time until the pilot notices a displayed off-path cue", "estimate"),
    field!(speed_m_s, "m/s", 0.2 to 10.0, Pace, "preferred speed along a surface", "estimate: about 1 m/s, the certification's inspection speed"),
    field!(path_speed_ratio, "", 0.1 to 4.0, Pace, "largest speed along a path, relative to a prudent one (1.4 to 3.3 m/s, by the kind of task)", "estimate: prudent for all levels"),
    field!(transit_speed_m_s, "m/s", 0.5 to 13.0, Pace, "preferred speed between tasks", "estimate"),
    field!(time_gap_s, "s", 0.2 to 10.0, Pace, "time to the nearest surface that the pilot keeps; limits the speed near structure", "estimate: drivers keep 1 to 2 s"),
    field!(look_spacing_m, "m", 2.0 to 1000.0, Pace, "distance between stops to look at the surface", "estimate: one picture width at a stand-off of 4.5 m is 8 m"),
    field!(look_duration_s, "s", 0.0 to 60.0, Pace, "mean time to look in one direction during a stop", "estimate: 3 to 4 fixations"),
    field!(look_sweep_deg, "°", 0.0 to 120.0, Search, "angle by which the pilot turns the camera up, down, left and right during a stop", "estimate"),
    field!(return_battery_pct, "%", 1.0 to 90.0, Pace, "battery charge at which the pilot returns", "estimate: the battery display turns red at 30%"),
    field!(fixation_s, "s", 0.1 to 2.0, Search, "time between fixations", "estimate: fixations in visual search take 0.2 to 0.3 s"),
    field!(fixation_area, "", 0.01 to 1.0, Search, "fraction of the picture that one fixation examines", "estimate"),
    field!(median_length_mm, "mm", 1.0 to 1000.0, Search, "defect length that is detected with a probability of 50%", "Campbell et al.: 26 mm (50%) and 113 mm (90%), also for inspectors who are new to drones; expert estimate"),
    field!(false_alarms_per_min, "1/min", 0.0 to 60.0, Search, "marks that the pilot mistakes for defects, per minute of search", "estimate"),
    field!(photo_distance_ratio, "", 0.2 to 4.0, Photo, "distance from which the pilot photographs, relative to the largest one that meets the job's ground sampling distance", "estimate"),
    field!(photo_speed_m_s, "m/s", 0.02 to 3.0, Photo, "speed below which the pilot takes a picture", "estimate: 0.3 m/s or less looks stopped"),
    field!(photo_turn_deg_s, "°/s", 0.2 to 90.0, Photo, "turn rate below which the pilot takes a picture", "estimate"),
    field!(steady_s, "s", 0.0 to 5.0, Photo, "time for which the image must be steady before the pilot presses the shutter", "estimate: 1 to 3 fixations"),
    field!(framing_deg, "°", 1.0 to 30.0, Photo, "angle from the center of the picture below which the pilot accepts the framing", "estimate"),
    field!(photo_incidence_deg, "°", 5.0 to 85.0, Photo, "angle from the surface normal up to which the pilot photographs", "estimate: inspection practice is at most 60"),
    field!(doubt, "", 0.0 to 1.0, Photo, "probability of photographing a defect again after a good picture", "estimate"),
    field!(patience_s, "s", 2.0 to 120.0, Photo, "time after which the pilot gives up on photographing a defect", "estimate"),
    field!(disorientations_per_min, "1/min", 0.0 to 30.0, Orientation, "episodes in which the pilot moves sticks the wrong way; three times as many while the drone faces the pilot", "estimate"),
    field!(recovery_s, "s", 0.1 to 20.0, Orientation, "mean time until the pilot notices the wrong direction", "estimate"),
    field!(panel_growth_m, "m", 0.0 to 20.0, Orientation, "growth of the distance to the next place on the task panel at which the pilot notices the wrong direction; 0: does not look at the panel", "estimate: the panel shows whole meters"),
    field!(distance_ratio, "", 0.3 to 1.5, Judgment, "perceived distance to a surface divided by the true distance", "Renner et al. 2013: 0.74 on average in virtual environments; with feedback near 1 (estimate)"),
    field!(upward_distance_ratio, "", 0.5 to 3.0, Judgment, "perceived distance to a surface above, divided by that to one beside at the same true distance", "Klein, Li and Durgin 2016: large vertical extents look 15 to 25% longer; Stefanucci and Proffitt 2009; the levels' value is an estimate: pilots use the range finder"),
    field!(distance_error, "", 0.0 to 1.0, Judgment, "drifting relative error of perceived distances (1 sigma)", "estimate"),
    field!(position_error_m, "m", 0.0 to 5.0, Judgment, "drifting error of the perceived position (1 sigma per axis)", "estimate"),
];

impl Skill {
    /// A beginner: unsteady, underestimates distances, easily distracted and disoriented.
    pub const NOVICE: Self = Self {
        delay_s: 0.35,
        gain: 0.6,
        noise: 2.0,
        preview_s: 0.7,
        lapses_per_min: 0.5,
        notice_cue_s: 0.0,
        speed_m_s: 2.2,
        path_speed_ratio: 1.0,
        transit_speed_m_s: 5.0,
        time_gap_s: 1.2,
        look_spacing_m: 25.0,
        look_duration_s: 0.9,
        look_sweep_deg: 50.0,
        return_battery_pct: 8.0,
        fixation_s: 0.3,
        fixation_area: 0.15,
        median_length_mm: 26.0,
        false_alarms_per_min: 0.2,
        photo_distance_ratio: 1.3,
        photo_speed_m_s: 0.6,
        photo_turn_deg_s: 12.0,
        steady_s: 0.2,
        framing_deg: 10.0,
        photo_incidence_deg: 60.0,
        doubt: 0.1,
        patience_s: 14.0,
        disorientations_per_min: 1.5,
        recovery_s: 3.0,
        panel_growth_m: 0.0,
        distance_ratio: 0.8,
        upward_distance_ratio: 1.0,
        distance_error: 0.25,
        position_error_m: 1.0,
    };
    /// A pilot after training.
    pub const TRAINED: Self = Self {
        delay_s: 0.22,
        gain: 1.0,
        noise: 1.0,
        preview_s: 1.5,
        lapses_per_min: 0.1,
        notice_cue_s: 0.0,
        speed_m_s: 1.4,
        path_speed_ratio: 1.0,
        transit_speed_m_s: 5.0,
        time_gap_s: 1.7,
        look_spacing_m: 14.0,
        look_duration_s: 0.8,
        look_sweep_deg: 55.0,
        return_battery_pct: 25.0,
        fixation_s: 0.28,
        fixation_area: 0.15,
        median_length_mm: 26.0,
        false_alarms_per_min: 0.15,
        photo_distance_ratio: 0.85,
        photo_speed_m_s: 0.2,
        photo_turn_deg_s: 3.0,
        steady_s: 0.5,
        framing_deg: 8.0,
        photo_incidence_deg: 55.0,
        doubt: 0.08,
        patience_s: 18.0,
        disorientations_per_min: 0.08,
        recovery_s: 0.9,
        panel_growth_m: 0.0,
        distance_ratio: 0.92,
        upward_distance_ratio: 1.0,
        distance_error: 0.12,
        position_error_m: 0.4,
    };
    /// A professional pilot.
    pub const EXPERT: Self = Self {
        delay_s: 0.18,
        gain: 1.0,
        noise: 0.7,
        preview_s: 1.5,
        lapses_per_min: 0.02,
        notice_cue_s: 0.0,
        speed_m_s: 2.1,
        path_speed_ratio: 1.0,
        transit_speed_m_s: 7.0,
        time_gap_s: 1.5,
        look_spacing_m: 12.0,
        look_duration_s: 0.5,
        look_sweep_deg: 60.0,
        return_battery_pct: 25.0,
        fixation_s: 0.25,
        fixation_area: 0.45,
        median_length_mm: 15.0,
        false_alarms_per_min: 0.03,
        photo_distance_ratio: 0.7,
        photo_speed_m_s: 0.1,
        photo_turn_deg_s: 1.5,
        steady_s: 0.7,
        framing_deg: 6.0,
        photo_incidence_deg: 50.0,
        doubt: 0.01,
        patience_s: 25.0,
        disorientations_per_min: 0.01,
        recovery_s: 0.6,
        panel_growth_m: 0.0,
        distance_ratio: 1.0,
        upward_distance_ratio: 1.0,
        distance_error: 0.06,
        position_error_m: 0.25,
    };

    /// Returns this skill with one group of numbers replaced by those of `from`.
    #[must_use]
    pub fn with(mut self, factor: SkillFactor, from: Self) -> Self {
        for field in FIELDS.iter().filter(|field| field.factor == factor) {
            (field.set)(&mut self, (field.get)(&from));
        }
        self
    }

    /// Returns the numbers of this pilot in their `session`-th session (from 1): by the power law of practice, each number's
    /// difference to the expert's shrinks by session^-`exponent`.
    #[must_use]
    pub fn in_session(mut self, session: u32, exponent: f64) -> Self {
        let share = math::pow(f64::from(session.max(1)), -exponent);
        for field in FIELDS {
            let (mine, expert) = ((field.get)(&self), (field.get)(&Self::EXPERT));
            (field.set)(&mut self, mine * share + expert * (1.0 - share));
        }
        self
    }
}

impl FromStr for Skill {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "novice" => Ok(Self::NOVICE),
            "trained" => Ok(Self::TRAINED),
            "expert" => Ok(Self::EXPERT),
            other => Err(format!("unknown skill '{other}' (allowed: novice, trained, expert)")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_replacing_all_factors_turns_a_novice_into_an_expert() {
        let gifted = SkillFactor::ALL.into_iter().fold(Skill::NOVICE, |pilot, factor| pilot.with(factor, Skill::EXPERT));
        assert_eq!(gifted, Skill::EXPERT);
    }

    #[test]
    fn exact_levels_are_within_the_allowed_ranges() {
        for field in FIELDS {
            for skill in [Skill::NOVICE, Skill::TRAINED, Skill::EXPERT] {
                let value = (field.get)(&skill);
                assert!((field.range.0..=field.range.1).contains(&value), "{}: {value}", field.key);
            }
        }
    }

    #[test]
    fn exact_practice_follows_a_power_law() {
        assert_eq!(Skill::NOVICE.in_session(1, LEARNING_EXPONENT), Skill::NOVICE);
        assert_eq!(Skill::EXPERT.in_session(5, LEARNING_EXPONENT), Skill::EXPERT);
        // With an exponent of 1, the difference to the expert is halved in the second session.
        let second = Skill::NOVICE.in_session(2, 1.0);
        assert_eq!(second.noise, 0.5 * Skill::NOVICE.noise + 0.5 * Skill::EXPERT.noise);
        assert_eq!(second.distance_ratio, 0.5 * Skill::NOVICE.distance_ratio + 0.5 * Skill::EXPERT.distance_ratio);
    }
}
