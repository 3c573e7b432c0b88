//! Visual path following: aims at a point ahead, brakes for bends within the preview, and corrects cross-track error.

use super::perception::MotionState;
use super::skill::Skill;
use spandrel_model::frames::{Enu, Vec3};

/// Cross-track gain of the trained pilot, 1/s (a third of the crossover frequency of a rate-command loop,
/// docs/src/reference/domain.md, "Human operators").
const CROSS_TRACK_GAIN_PER_S: f64 = 0.9;
/// Planned braking deceleration, m/s² (estimate).
const BRAKING_DECELERATION_M_S2: f64 = 1.2;
/// Minimum distance to the aim point, m (estimate).
const MIN_AIM_DISTANCE_M: f64 = 1.0;

/// Speed factor for bends below which a leg turns back: for a bend of more than a right angle.
const TURNING_BACK_FACTOR: f64 = 0.65;

/// A polyline to fly, with a target speed and line of sight at each point.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackLeg {
    /// Points, ENU, m; at least two.
    pub points_m: Vec<Vec3<Enu>>,
    /// Target speed toward each point, m/s.
    pub speed_m_s: Vec<f64>,
    /// Line of sight at each point, unit vectors; `None` means along the path.
    pub line_of_sight: Vec<Option<Vec3<Enu>>>,
    /// Task index of each point.
    pub task: Vec<Option<usize>>,
}

/// Position on a leg: the segment that ends at `next`, and the distance along the leg.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LegProgress {
    /// Index of the segment's endpoint.
    pub next: usize,
    /// Distance from the leg's start, m.
    pub along_m: f64,
}

/// The pilot's command at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackCommand {
    /// Ground velocity, ENU, m/s.
    pub velocity_m_s: Vec3<Enu>,
    /// Line of sight; `None` keeps the current one.
    pub line_of_sight: Option<Vec3<Enu>>,
    /// Index of the active task.
    pub task: Option<usize>,
    /// Whether the end of the leg has been reached.
    pub done: bool,
    /// Whether the pilot releases the sticks that move the aircraft, so that the autopilot holds position.
    pub hands_off: bool,
    /// Whether the pilot turns toward the line of sight; if not, only the gimbal follows it.
    pub turns: bool,
}

impl TrackCommand {
    /// Returns a command with a velocity and no line of sight.
    #[must_use]
    pub fn velocity(velocity_m_s: Vec3<Enu>) -> Self {
        Self { velocity_m_s, line_of_sight: None, task: None, done: false, hands_off: false, turns: true }
    }
}

impl TrackLeg {
    /// Creates an empty leg.
    #[must_use]
    pub fn new() -> Self {
        Self { points_m: Vec::new(), speed_m_s: Vec::new(), line_of_sight: Vec::new(), task: Vec::new() }
    }

    /// Splits the leg into the points before `k` and the points from `k` on.
    #[must_use]
    pub fn split_at(&self, k: usize) -> (Self, Self) {
        let part = |from: usize, to: usize| Self {
            points_m: self.points_m[from..to].to_vec(),
            speed_m_s: self.speed_m_s[from..to].to_vec(),
            line_of_sight: self.line_of_sight[from..to].to_vec(),
            task: self.task[from..to].to_vec(),
        };
        let k = k.min(self.points_m.len());
        (part(0, k), part(k, self.points_m.len()))
    }

    /// Appends a point; merges a point that coincides with the last one.
    pub fn push(&mut self, point_m: Vec3<Enu>, speed_m_s: f64, look: Option<Vec3<Enu>>, task: Option<usize>) {
        if self.points_m.last().is_some_and(|last| (*last - point_m).norm() < 1e-3) {
            return;
        }
        self.points_m.push(point_m);
        self.speed_m_s.push(speed_m_s);
        self.line_of_sight.push(look);
        self.task.push(task);
    }

    fn segment_m(&self, next: usize) -> f64 {
        (self.points_m[next] - self.points_m[next - 1]).norm()
    }

    /// Returns the point `distance_m` ahead of `progress`.
    fn point_ahead(&self, progress: LegProgress, distance_m: f64) -> Vec3<Enu> {
        let start: f64 = (1..progress.next).map(|k| self.segment_m(k)).sum();
        let mut left = progress.along_m - start + distance_m;
        for next in progress.next..self.points_m.len() {
            let length = self.segment_m(next);
            if left <= length {
                return self.points_m[next - 1].lerp(self.points_m[next], left / length.max(1e-9));
            }
            left -= length;
        }
        self.points_m[self.points_m.len() - 1]
    }

    /// Moves the progress to the nearest point in a short window around it.
    pub fn advance(&self, progress: &mut LegProgress, position_m: Vec3<Enu>) {
        const PROGRESS_WINDOW_M: f64 = 6.0;
        let mut start: f64 = (1..progress.next.max(1)).map(|k| self.segment_m(k)).sum();
        let mut best = (f64::INFINITY, *progress);
        for next in progress.next.max(1)..self.points_m.len() {
            if start > progress.along_m + PROGRESS_WINDOW_M {
                break;
            }
            let (a, b) = (self.points_m[next - 1], self.points_m[next]);
            let length = self.segment_m(next).max(1e-9);
            let t = ((position_m - a).dot(b - a) / (length * length)).clamp(0.0, 1.0);
            let along_m = (start + t * length).max(progress.along_m);
            // A small cost per meter ahead keeps the progress from jumping across a bend.
            let cost = (position_m - a.lerp(b, t)).norm() + 0.15 * (along_m - progress.along_m);
            if cost < best.0 {
                best = (cost, LegProgress { next, along_m });
            }
            start += length;
        }
        *progress = best.1;
    }

    /// Returns the speed, in m/s, that the bends within the preview allow.
    fn speed(&self, progress: LegProgress, skill: &Skill, now_m_s: f64, pace_m_s: f64) -> f64 {
        let start: f64 = (1..progress.next).map(|k| self.segment_m(k)).sum();
        let mut ahead_m = start - progress.along_m;
        let ratio = skill.path_speed_ratio;
        let mut speed = (self.speed_m_s[progress.next] * ratio).min(pace_m_s);
        let horizon_m = skill.preview_s * now_m_s.max(1.0) + 1.0;
        for next in progress.next..self.points_m.len() {
            ahead_m += self.segment_m(next);
            if ahead_m > horizon_m {
                break;
            }
            let there = match self.speed_m_s.get(next + 1) {
                Some(following) => (following * ratio).min(pace_m_s) * self.bend_speed_factor(next),
                None => 0.0,
            };
            speed = speed.min((there * there + 2.0 * BRAKING_DECELERATION_M_S2 * ahead_m.max(0.0)).sqrt());
        }
        speed.max(0.3)
    }

    /// Returns the speed factor for the bend at a point: 1 for straight ahead, 0.3 for a reversal.
    fn bend_speed_factor(&self, at: usize) -> f64 {
        let Some(after) = self.points_m.get(at + 1) else { return 0.0 };
        let into = (self.points_m[at] - self.points_m[at - 1]).unit();
        let out = (*after - self.points_m[at]).unit();
        0.65 + 0.35 * into.dot(out)
    }

    /// Moves the progress to the next point at which the leg turns back. Before such a point, the aim point can be where the aircraft is,
    /// so that the pilot would stay there.
    pub fn pass_turn(&self, progress: &mut LegProgress) {
        let turns_back = |at: &usize| self.bend_speed_factor(*at) < TURNING_BACK_FACTOR;
        let Some(turn) = (progress.next.max(1)..self.points_m.len() - 1).find(turns_back) else { return };
        *progress = LegProgress { next: turn + 1, along_m: (1..=turn).map(|k| self.segment_m(k)).sum() };
    }

    /// Returns the pilot's command for the perceived motion, no faster than `pace_m_s` along the leg.
    pub fn command(&self, progress: &mut LegProgress, motion: &MotionState, skill: &Skill, pace_m_s: f64) -> TrackCommand {
        self.advance(progress, motion.position_m);
        let speed = self.speed(*progress, skill, motion.velocity_m_s.norm(), pace_m_s);
        let here = self.point_ahead(*progress, 0.0);
        // Trained pilots look 1.5 s ahead. A shorter preview moves the aim point closer.
        let aim = self.point_ahead(*progress, (speed * skill.preview_s).max(MIN_AIM_DISTANCE_M));
        let pull = (here - motion.position_m) * (CROSS_TRACK_GAIN_PER_S * skill.gain);
        let run = (aim - here).unit() * speed;
        let end = self.points_m[self.points_m.len() - 1];
        let total: f64 = (1..self.points_m.len()).map(|k| self.segment_m(k)).sum();
        let left_m = total - progress.along_m;
        let run = if left_m < 0.5 { Vec3::zero() } else { run };
        TrackCommand {
            velocity_m_s: run + pull.limited(2.0),
            line_of_sight: self.line_of_sight[progress.next].or_else(|| self.heading_ahead(*progress)),
            task: self.task[progress.next],
            done: left_m < 1.0 && (motion.position_m - end).norm() < 2.5,
            hands_off: false,
            turns: true,
        }
    }

    fn heading_ahead(&self, progress: LegProgress) -> Option<Vec3<Enu>> {
        let ahead = self.point_ahead(progress, 4.0) - self.point_ahead(progress, 0.0);
        let level = Vec3::new(ahead.east(), ahead.north(), 0.0);
        (level.norm() > 0.5).then(|| level.unit())
    }
}

impl Default for TrackLeg {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::time::SimTime;

    /// A pace that does not limit the speed of 3 m/s.
    const PACE_M_S: f64 = 10.0;

    #[test]
    fn exact_pace_limits_the_speed_along_the_leg() {
        let leg = straight();
        let mut progress = LegProgress { next: 3, along_m: 2.0 };
        let wish = leg.command(&mut progress, &at(2.0, 0.0), &Skill::EXPERT, 1.2);
        assert!((wish.velocity_m_s.norm() - 1.2).abs() < 1e-9, "{wish:?}");
    }

    fn straight() -> TrackLeg {
        let mut leg = TrackLeg::new();
        for k in 0..=20 {
            leg.push(Vec3::new(f64::from(k), 0.0, 5.0), 3.0, None, None);
        }
        leg
    }

    fn at(east: f64, north: f64) -> MotionState {
        let position_m = Vec3::new(east, north, 5.0);
        MotionState { time: SimTime::ZERO, position_m, velocity_m_s: Vec3::new(3.0, 0.0, 0.0), yaw_rad: 0.0 }
    }

    #[test]
    fn exact_command_returns_to_the_leg() {
        let leg = straight();
        let mut progress = LegProgress { next: 1, along_m: 0.0 };
        let wish = leg.command(&mut progress, &at(2.0, 1.0), &Skill::TRAINED, PACE_M_S);
        assert!(wish.velocity_m_s.north() < -0.5 && wish.velocity_m_s.east() > 2.0, "{wish:?}");
    }

    #[test]
    fn exact_short_preview_brakes_later() {
        let leg = straight();
        let mut a = LegProgress { next: 17, along_m: 16.5 };
        let mut b = a;
        let novice = leg.command(&mut a, &at(16.5, 0.0), &Skill::NOVICE, PACE_M_S).velocity_m_s.east();
        let expert = leg.command(&mut b, &at(16.5, 0.0), &Skill::EXPERT, PACE_M_S).velocity_m_s.east();
        assert!(novice > expert, "{novice} {expert}");
    }

    #[test]
    fn regress_a_leg_that_turns_back_is_flown_to_its_end() {
        // A transit that ends in almost the opposite direction of the task's path, as below the girders of a bridge.
        let mut leg = TrackLeg::new();
        (0..=7).rev().for_each(|k| leg.push(Vec3::new(3.0 * f64::from(k), -0.5 * f64::from(k), 5.0), 2.5, None, None));
        (1..=25).for_each(|k| leg.push(Vec3::new(0.8 * f64::from(k), 0.0, 5.0), 2.5, None, Some(0)));
        let mut motion = MotionState { velocity_m_s: Vec3::zero(), ..at(21.0, -3.5) };
        let (mut progress, mut best, mut passed) = (LegProgress { next: 1, along_m: 0.0 }, (0.0, 0), 0);
        for step in 0..4_000 {
            if step - best.1 > 750 {
                leg.pass_turn(&mut progress);
                (best.1, passed) = (step, passed + 1);
            }
            let wish = leg.command(&mut progress, &motion, &Skill::EXPERT, PACE_M_S);
            if wish.done {
                break;
            }
            motion.velocity_m_s = wish.velocity_m_s;
            motion.position_m += motion.velocity_m_s * 0.02;
            if progress.along_m > best.0 + 0.3 {
                best = (progress.along_m, step);
            }
        }
        assert_eq!(passed, 1, "the pilot waits before the turn once");
        assert!((motion.position_m - Vec3::new(20.0, 0.0, 5.0)).norm() < 2.5, "{:?}", motion.position_m);
    }
}
