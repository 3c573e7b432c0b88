//! Lost orientation: episodes in which the pilot moves sticks the wrong way, until they notice it, let go of the sticks and
//! look. Episodes are more frequent while the drone faces the pilot, because left and right are then reversed.

use super::hand_motion::StickAxes;
use super::skill::Skill;
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::time::SimTime;

/// Factor of the rate while the drone faces the pilot (estimate: reversed controls are the most common error of beginners).
const FACING_PILOT_FACTOR: f64 = 3.0;
/// Shortest and longest time until the pilot notices, s (estimate).
const RECOVERY_RANGE_S: (f64, f64) = (0.3, 6.0);
/// Time without stick input after the pilot has noticed, s (estimate: the drone stops, and the pilot looks where it is).
const REORIENTATION_S: f64 = 1.5;

/// Axes that the pilot confuses during an episode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ReversedAxes {
    /// Left and right.
    Sideways,
    /// Forward and backward.
    Forward,
    /// Up and down.
    Vertical,
    /// Left and right, forward and backward: the pilot believes that the drone points the other way.
    Mirrored,
}

/// State of the pilot's orientation.
#[derive(Debug, Clone, PartialEq)]
pub struct Orientation {
    random: RandomStream,
    reversed: ReversedAxes,
    wrong_until: SimTime,
    looking_until: SimTime,
    /// Smallest distance on the task panel since the episode began, m.
    nearest_m: f64,
    /// Time spent in episodes.
    lost: SimTime,
}

impl Orientation {
    /// Creates the state of an oriented pilot.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let random = RandomStream::new(seed, "pilot orientation");
        Self {
            random,
            reversed: ReversedAxes::Mirrored,
            wrong_until: SimTime::ZERO,
            looking_until: SimTime::ZERO,
            nearest_m: f64::INFINITY,
            lost: SimTime::ZERO,
        }
    }

    /// Checks whether an episode is in progress.
    #[must_use]
    pub fn is_lost(&self, now: SimTime) -> bool {
        now < self.wrong_until
    }

    /// Returns the time spent in episodes.
    #[must_use]
    pub fn lost(&self) -> SimTime {
        self.lost
    }

    /// Ends an episode when the distance on the task panel grows. `distance_m` is that distance, if there is a panel.
    pub fn look_at_panel(&mut self, distance_m: Option<f64>, skill: &Skill, now: SimTime) {
        let Some(distance_m) = distance_m.filter(|_| self.is_lost(now) && skill.panel_growth_m > 0.0) else { return };
        self.nearest_m = self.nearest_m.min(distance_m);
        if distance_m >= self.nearest_m + skill.panel_growth_m {
            self.wrong_until = now;
            self.looking_until = now + SimTime::from_s(REORIENTATION_S);
        }
    }

    /// Returns the axes that the pilot's hands aim for, given those that a pilot with full orientation would choose.
    pub fn step(&mut self, axes: StickAxes, skill: &Skill, faces_pilot: bool, now: SimTime, dt_s: f64) -> StickAxes {
        let factor = if faces_pilot { FACING_PILOT_FACTOR } else { 1.0 };
        let begins = self.random.uniform() < skill.disorientations_per_min * factor / 60.0 * dt_s;
        if begins && now >= self.looking_until {
            let wait_s = -skill.recovery_s * math::ln((1.0 - self.random.uniform()).max(1e-12));
            let choices = [ReversedAxes::Sideways, ReversedAxes::Forward, ReversedAxes::Vertical, ReversedAxes::Mirrored];
            self.reversed = choices[self.random.below(choices.len())];
            self.wrong_until = now + SimTime::from_s(wait_s.clamp(RECOVERY_RANGE_S.0, RECOVERY_RANGE_S.1));
            self.looking_until = self.wrong_until + SimTime::from_s(REORIENTATION_S);
            self.nearest_m = f64::INFINITY;
        }
        let [forward, right, up, yaw] = axes;
        if self.is_lost(now) {
            self.lost += SimTime::from_s(dt_s);
            return match self.reversed {
                ReversedAxes::Sideways => [forward, -right, up, -yaw],
                ReversedAxes::Forward => [-forward, right, up, yaw],
                ReversedAxes::Vertical => [forward, right, -up, yaw],
                ReversedAxes::Mirrored => [-forward, -right, up, yaw],
            };
        }
        if now < self.looking_until { [0.0; 4] } else { axes }
    }

    /// Ends an episode, because the aircraft has been repositioned.
    pub fn reset(&mut self) {
        self.wrong_until = SimTime::ZERO;
        self.looking_until = SimTime::ZERO;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_S: f64 = 0.02;
    const WISH: StickAxes = [0.4, 0.3, 0.2, 0.1];

    #[test]
    fn exact_oriented_pilot_moves_the_sticks_as_intended() {
        let mut mind = Orientation::new(1);
        let skill = Skill { disorientations_per_min: 0.0, ..Skill::NOVICE };
        for k in 0..10_000 {
            assert_eq!(mind.step(WISH, &skill, true, SimTime::from_ms(20 * k), STEP_S), WISH);
        }
    }

    #[test]
    fn exact_episode_reverses_sticks_then_lets_go_then_continues() {
        let mut mind = Orientation::new(2);
        let skill = Skill { disorientations_per_min: 30.0, recovery_s: 1.0, ..Skill::NOVICE };
        let axes: Vec<StickAxes> = (0..3_000).map(|k| mind.step(WISH, &skill, false, SimTime::from_ms(20 * k), STEP_S)).collect();
        let is_wrong = |a: &StickAxes| a.iter().any(|axis| *axis < 0.0);
        let first = axes.iter().position(is_wrong).expect("an episode within a minute");
        let noticed = first + axes[first..].iter().position(|a| !is_wrong(a)).expect("the episode ends");
        assert_eq!(axes[noticed], [0.0; 4], "releases the sticks");
        let resumed = axes[noticed..].iter().position(|a| *a != [0.0; 4]).expect("continues");
        assert_eq!(resumed, (REORIENTATION_S / STEP_S) as usize, "steps of {STEP_S} s without input");
    }

    #[test]
    fn exact_a_growing_distance_on_the_panel_ends_an_episode() {
        let skill = Skill { disorientations_per_min: 30.0, recovery_s: 6.0, panel_growth_m: 2.0, ..Skill::NOVICE };
        let lost_s = |distance: &dyn Fn(f64) -> Option<f64>| {
            let mut mind = Orientation::new(4);
            let mut since_s = 0.0;
            for k in 0..30_000 {
                let now = SimTime::from_ms(20 * k);
                mind.step(WISH, &skill, false, now, STEP_S);
                // The distance grows at 2 m/s while the pilot flies the wrong way.
                since_s = if mind.is_lost(now) { since_s + STEP_S } else { 0.0 };
                mind.look_at_panel(distance(since_s), &skill, now);
            }
            mind.lost().s()
        };
        let [without, with, shrinking] =
            [lost_s(&|_| None), lost_s(&|since_s| Some(40.0 + 2.0 * since_s)), lost_s(&|since_s| Some(40.0 - 2.0 * since_s))];
        assert!(with < 0.5 * without, "{with} s with the panel, {without} s without");
        assert!((shrinking - without).abs() < 1e-9, "a distance that shrinks is no sign: {shrinking} s, {without} s");
    }

    #[test]
    fn exact_rate_is_three_times_as_high_when_the_drone_faces_the_pilot() {
        // 100 h of flight with short episodes: about 6,000 and 18,000 episodes, so the ratio has a standard error of 1.5%.
        const TOLERANCE: f64 = 0.1;
        let skill = Skill { disorientations_per_min: 1.0, recovery_s: 0.1, ..Skill::NOVICE };
        let count = |faces| {
            let mut mind = Orientation::new(3);
            let mut episodes = 0;
            let mut before = false;
            for k in 0..3_600_000_i64 {
                let now = SimTime::from_ms(100 * k);
                let _axes = mind.step(WISH, &skill, faces, now, 0.1);
                episodes += i32::from(mind.is_lost(now) && !before);
                before = mind.is_lost(now);
            }
            f64::from(episodes)
        };
        let ratio = count(true) / count(false);
        // While an episode lasts (about 1.9 s), no new one begins: 3 / (1 + 3 r) against 1 / (1 + r) per minute.
        let dead_min = 1.9 / 60.0;
        let expected = FACING_PILOT_FACTOR * (1.0 + dead_min) / (1.0 + FACING_PILOT_FACTOR * dead_min);
        assert!((ratio - expected).abs() < TOLERANCE, "{ratio}, expected {expected}");
    }
}
