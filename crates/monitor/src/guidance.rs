//! Guidance: determines the next step of the job and the way to it from the drone's position and the parts of the paths that
//! were flown.

use crate::feedback::{HeadingOffset, TaskProximity};
use crate::measures::coverage::FlownPath;
use crate::measures::on_path::ReferencePaths;
use spandrel_mavlink::contract::guidance::{DetourKind, Guidance, GuidanceStep, PathDeviation, StandOffReading, WayTo};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;

/// Distance along the path to the place that the pilot is guided to while following it, m (estimate: far enough that the
/// direction is steady, near enough that it follows a curve).
const LOOK_AHEAD_M: f64 = 6.0;
/// Height above the pad of the place that the way home leads to if it is blocked, m (estimate).
const APPROACH_HEIGHT_M: Vec3<Enu> = Vec3::new(0.0, 0.0, 5.0);
/// Time for which a step must last before it is announced, so that a drone at the threshold of a path causes no flood of
/// texts (estimate).
const ANNOUNCEMENT_DELAY: SimTime = SimTime::from_ms(1_500);

/// The state of the flight that the guidance depends on.
#[derive(Debug, Clone, Copy)]
pub struct GuidanceInput<'a> {
    /// The job.
    pub scenario: &'a Scenario,
    /// The tasks' paths.
    pub paths: &'a ReferencePaths,
    /// For each task, the part of its path that was flown.
    pub flown: &'a [FlownPath],
    /// For each task, its state relative to the drone.
    pub tasks: &'a [TaskProximity],
    /// Index of the task that is being flown, if any.
    pub active_task: Option<usize>,
    /// Position of the drone.
    pub position_m: Vec3<Enu>,
    /// Heading, rad clockwise from north.
    pub heading_rad: f64,
    /// Whether the drone has taken off.
    pub taken_off: bool,
    /// Whether the session is over.
    pub over: bool,
    /// Flight time, s.
    pub flown_s: f64,
    /// Time that the job needs, s.
    pub needed_s: f64,
}

impl GuidanceInput<'_> {
    /// Determines the next step.
    #[must_use]
    pub fn next_step(&self) -> Guidance {
        let step = self.step();
        let task = self.task_of(step);
        let target_m = self.target_m(step);
        let near = task.map(|task| &self.tasks[task]).filter(|task| task.distance_m <= self.scenario.feedback.off_path_max_m);
        Guidance {
            step,
            task: task.map(|task| self.scenario.tasks[task].id),
            way: target_m.map(|target_m| self.way_to(target_m)),
            progress: task.map(|task| self.tasks[task].flown_share),
            tasks_done: self.tasks.iter().filter(|task| task.done).count() as u32,
            tasks: self.tasks.len() as u32,
            deviation: near.map(|task| PathDeviation { distance_m: task.distance_m, above_m: -task.way_back.up_m }),
            stand_off: near.and_then(|task| task.surface).map(|surface| StandOffReading {
                actual_m: surface.actual_m,
                recommended_m: surface.recommended_m,
                tolerance_m: surface.tolerance_m,
            }),
            flown_s: self.flown_s,
            needed_s: self.needed_s,
            detour: None,
        }
    }

    /// Returns the place far away that the step leads to, to which the straight way may be blocked; `None` in other steps.
    #[must_use]
    pub fn far_place_m(&self) -> Option<Vec3<Enu>> {
        match self.step() {
            GuidanceStep::FlyToTask => self.target_m(GuidanceStep::FlyToTask),
            GuidanceStep::FlyHome => Some(self.scenario.ground_team.pad_m + APPROACH_HEIGHT_M),
            GuidanceStep::TakeOff
            | GuidanceStep::FollowPath
            | GuidanceStep::HoldPosition
            | GuidanceStep::Land
            | GuidanceStep::Over => None,
        }
    }

    /// Returns the task that a step belongs to.
    fn task_of(&self, step: GuidanceStep) -> Option<usize> {
        match step {
            GuidanceStep::FlyToTask | GuidanceStep::FollowPath | GuidanceStep::HoldPosition => self.task(),
            GuidanceStep::TakeOff | GuidanceStep::FlyHome | GuidanceStep::Land | GuidanceStep::Over => None,
        }
    }

    /// Returns the place that a step leads to.
    fn target_m(&self, step: GuidanceStep) -> Option<Vec3<Enu>> {
        let task = self.task_of(step);
        match step {
            GuidanceStep::FlyToTask | GuidanceStep::FollowPath => task.and_then(|task| self.target_on_path_m(task)),
            GuidanceStep::HoldPosition => task.and_then(|task| self.paths.path(task).closest_position(self.position_m)),
            GuidanceStep::FlyHome => Some(self.scenario.ground_team.pad_m),
            GuidanceStep::TakeOff | GuidanceStep::Land | GuidanceStep::Over => None,
        }
    }

    fn step(&self) -> GuidanceStep {
        if self.over {
            return GuidanceStep::Over;
        }
        if !self.taken_off {
            return GuidanceStep::TakeOff;
        }
        match self.task() {
            Some(task) if self.active_task == Some(task) && self.is_hold_position(task) => GuidanceStep::HoldPosition,
            Some(task) if self.active_task == Some(task) => GuidanceStep::FollowPath,
            Some(_) => GuidanceStep::FlyToTask,
            None if self.is_home() => GuidanceStep::Land,
            None => GuidanceStep::FlyHome,
        }
    }

    /// Returns the task to fly: the active one until nothing of it remains, then the first one that is not done.
    fn task(&self) -> Option<usize> {
        let is_open = |task: &usize| match self.is_hold_position(*task) {
            true => !self.flown[*task].is_held(),
            false => !self.tasks[*task].done,
        };
        let is_unfinished = |task: &usize| if self.is_hold_position(*task) { is_open(task) } else { !self.tasks[*task].finished };
        self.active_task.filter(is_unfinished).or_else(|| (0..self.tasks.len()).find(|task| is_open(task)))
    }

    fn is_hold_position(&self, task: usize) -> bool {
        self.scenario.tasks[task].is_hold_position()
    }

    fn is_home(&self) -> bool {
        let team = &self.scenario.ground_team;
        (self.position_m - team.pad_m).horizontal_norm() <= team.home_radius_m
    }

    /// Returns the place to fly to: the nearest position on the path if the drone has left it, the next part of the path that
    /// was not flown if the drone is on it, and otherwise its start or the nearest part that was not flown.
    fn target_on_path_m(&self, task: usize) -> Option<Vec3<Enu>> {
        let (path, flown) = (self.paths.path(task), self.flown[task].points());
        let points_m = path.points_m();
        if self.active_task == Some(task) {
            let off_path = self.tasks[task].distance_m > self.tasks[task].threshold_m;
            return if off_path { path.closest_position(self.position_m) } else { self.place_ahead_m(task) };
        }
        if !flown.contains(&true) {
            // A loop can be entered anywhere.
            return if self.scenario.tasks[task].closed {
                path.closest_position(self.position_m)
            } else {
                points_m.first().copied()
            };
        }
        let squared = |k: &usize| (points_m[*k] - self.position_m).norm_squared();
        let left = (0..points_m.len()).filter(|k| !flown[*k]);
        left.min_by(|a, b| squared(a).total_cmp(&squared(b))).map(|k| points_m[k])
    }

    /// Returns the place on the path that comes next: in the direction of increasing distance along the path, unless only the
    /// other direction leads to a part that was not flown.
    fn place_ahead_m(&self, task: usize) -> Option<Vec3<Enu>> {
        let (path, flown) = (self.paths.path(task), self.flown[task].points());
        let points_m = path.points_m();
        let here = path.nearest_by_tasbid_rule(self.position_m)?.point;
        let count = points_m.len();
        let closed = self.scenario.tasks[task].closed;
        let forward: Vec<usize> =
            if closed { (1..count).map(|k| (here + k) % count).collect() } else { (here + 1..count).collect() };
        let back: Vec<usize> = if closed { forward.iter().rev().copied().collect() } else { (0..here).rev().collect() };
        let first_left = |way: &[usize]| way.iter().position(|k| !flown[*k]);
        let way = match (first_left(&forward), first_left(&back)) {
            (Some(ahead), Some(behind)) if closed && behind < ahead => back,
            (Some(_), _) => forward,
            (None, Some(_)) => back,
            (None, None) => return path.closest_position(self.position_m),
        };
        let mut along_m = 0.0;
        let mut at_m = points_m[here];
        for k in way {
            along_m += (points_m[k] - at_m).norm();
            at_m = points_m[k];
            if along_m >= LOOK_AHEAD_M && !flown[k] {
                break;
            }
        }
        Some(at_m)
    }

    fn way_to(&self, target_m: Vec3<Enu>) -> WayTo {
        HeadingOffset::new(target_m - self.position_m, self.heading_rad).way()
    }
}

/// Interval at which the way to a task or home is repeated, for ground stations that show only texts (estimate).
const REPETITION_INTERVAL: SimTime = SimTime::from_ms(10_000);

/// Identity of an announcement: step, task and detour.
type Announcement = (GuidanceStep, Option<u32>, Option<DetourKind>);

/// Announces each new step once it has lasted, and repeats the way to a place while the drone is on its way.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StepAnnouncer {
    /// Step that was announced last, and when.
    announced: Option<(Announcement, SimTime)>,
    /// Step, and the time since when it has lasted.
    current: Option<(Announcement, SimTime)>,
}

impl StepAnnouncer {
    /// Returns the texts to send, if a new step has lasted long enough.
    pub fn update(&mut self, now: SimTime, guidance: &Guidance) -> Vec<String> {
        let key = (guidance.step, guidance.task, guidance.detour.map(|detour| detour.kind));
        let since = self.current.filter(|(current, _)| *current == key).map_or(now, |(_, since)| since);
        self.current = Some((key, since));
        let repeated = match guidance.step {
            GuidanceStep::FlyToTask | GuidanceStep::FlyHome => true,
            GuidanceStep::TakeOff
            | GuidanceStep::FollowPath
            | GuidanceStep::HoldPosition
            | GuidanceStep::Land
            | GuidanceStep::Over => false,
        };
        let said = self.announced.filter(|(announced, _)| *announced == key);
        let is_news = said.is_none_or(|(_, at)| repeated && now - at >= REPETITION_INTERVAL);
        if !is_news || now - since < ANNOUNCEMENT_DELAY {
            return Vec::new();
        }
        self.announced = Some((key, now));
        // The end of the session has a text of its own.
        let words = (guidance.step != GuidanceStep::Over).then(|| guidance.words());
        words.into_iter().chain(guidance.detour_words()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::contract::guidance::Detour;
    use spandrel_model::math;
    use spandrel_model::scenario::HOLD_DURATION;
    use spandrel_model::{scenario, shipped};

    /// Largest difference that rounding explains, m and rad.
    const TOLERANCE: f64 = 1e-9;

    struct Flight {
        scenario: Scenario,
        paths: ReferencePaths,
        flown: Vec<FlownPath>,
        finished: Vec<bool>,
    }

    impl Flight {
        fn new() -> Self {
            Self::of(shipped::TWO_BRIDGES)
        }

        fn of(text: &str) -> Self {
            let scenario = scenario::read("job.toml", text, &|file| Err(file.to_owned())).unwrap();
            let paths = ReferencePaths::new(&scenario);
            let flown = (0..paths.len()).map(|task| FlownPath::of_task(&paths, task)).collect();
            Self { finished: vec![false; paths.len()], scenario, paths, flown }
        }

        /// Marks the points of a task's path as flown.
        fn fly(&mut self, task: usize, points: std::ops::Range<usize>) {
            points.for_each(|point| self.flown[task].add_frame(Some(point), SimTime::ZERO));
            self.finished[task] = !self.flown[task].points().contains(&false);
        }

        fn fly_all(&mut self, task: usize) {
            self.fly(task, 0..self.paths.path(task).points_m().len());
        }

        fn point_m(&self, task: usize, point: usize) -> Vec3<Enu> {
            self.paths.path(task).points_m()[point]
        }

        fn guidance(&self, position_m: Vec3<Enu>, active_task: Option<usize>) -> Guidance {
            let done_share = self.scenario.scoring.task_completion_fraction;
            let proximity = |task: usize| TaskProximity {
                distance_m: self.paths.nearest(task, position_m).map_or(f64::INFINITY, |nearest| nearest.distance_m),
                threshold_m: self.paths.threshold_m(task),
                way_back: HeadingOffset::default(),
                surface: None,
                too_close_m: None,
                id: self.scenario.tasks[task].id,
                at_path_end: false,
                flown_share: self.flown[task].coverage().share,
                done: self.flown[task].coverage().share >= done_share,
                finished: self.finished[task],
            };
            let tasks: Vec<TaskProximity> = (0..self.paths.len()).map(proximity).collect();
            GuidanceInput {
                scenario: &self.scenario,
                paths: &self.paths,
                flown: &self.flown,
                tasks: &tasks,
                active_task,
                position_m,
                heading_rad: 0.0,
                taken_off: true,
                over: false,
                flown_s: 60.0,
                needed_s: 300.0,
            }
            .next_step()
        }
    }

    #[test]
    fn exact_the_first_unfinished_task_is_next_and_then_the_way_home() {
        let mut flight = Flight::new();
        let pad_m = flight.scenario.ground_team.pad_m;
        for task in 0..flight.paths.len() {
            let guidance = flight.guidance(pad_m, None);
            assert_eq!((guidance.step, guidance.task), (GuidanceStep::FlyToTask, Some(flight.scenario.tasks[task].id)));
            assert_eq!((guidance.tasks_done as usize, guidance.progress), (task, Some(0.0)));
            flight.fly_all(task);
        }
        assert_eq!(flight.guidance(pad_m, None).step, GuidanceStep::Land);
        let away = pad_m + Vec3::new(0.0, -50.0, 20.0);
        let way = flight.guidance(away, None).way.unwrap();
        assert_eq!(flight.guidance(away, None).step, GuidanceStep::FlyHome);
        assert!((way.distance_m - 50.0).abs() < TOLERANCE && way.bearing_rad.abs() < TOLERANCE, "{way:?}");
        assert!((way.up_m + 20.0).abs() < TOLERANCE, "{way:?}");
    }

    #[test]
    fn exact_an_open_path_begins_at_its_start_and_continues_where_it_was_left() {
        let mut flight = Flight::new();
        let last = flight.paths.path(0).points_m().len() - 1;
        let beside_m = flight.point_m(0, last) + Vec3::new(0.0, 0.0, 30.0);
        let way = flight.guidance(beside_m, None).way.unwrap();
        let to_start_m = (flight.point_m(0, 0) - beside_m).horizontal_norm();
        assert!((way.distance_m - to_start_m).abs() < TOLERANCE, "the start, although the other end is nearer");
        flight.fly(0, 0..last / 2);
        let way = flight.guidance(flight.point_m(0, 0), None).way.unwrap();
        let to_rest_m = (flight.point_m(0, last / 2) - flight.point_m(0, 0)).horizontal_norm();
        assert!((way.distance_m - to_rest_m).abs() < TOLERANCE, "the first part that was not flown");
    }

    #[test]
    fn exact_on_the_path_the_way_leads_ahead_and_off_the_path_back_to_it() {
        let mut flight = Flight::new();
        let last = flight.paths.path(0).points_m().len() - 1;
        let (middle, spacing_m) = (last / 2, (flight.point_m(0, 1) - flight.point_m(0, 0)).norm());
        flight.fly(0, 0..middle + 1);
        let on = flight.guidance(flight.point_m(0, middle), Some(0));
        assert_eq!(on.step, GuidanceStep::FollowPath);
        let ahead_m = on.way.unwrap().distance_m;
        assert!((LOOK_AHEAD_M - TOLERANCE..=LOOK_AHEAD_M + spacing_m).contains(&ahead_m), "{ahead_m} m");
        let off = flight.guidance(flight.point_m(0, middle) + Vec3::new(0.0, 0.0, 5.0), Some(0));
        assert!((off.way.unwrap().up_m + 5.0).abs() < TOLERANCE, "{off:?}");
        // Flown in the other direction, the way leads on in that direction.
        let mut back = Flight::new();
        back.fly(0, middle..last + 1);
        let ahead = back.guidance(back.point_m(0, middle), Some(0)).way.unwrap();
        let before = back.point_m(0, middle - 1) - back.point_m(0, middle);
        assert!(before.array()[1] * math::cos(ahead.bearing_rad) + before.array()[0] * math::sin(ahead.bearing_rad) > 0.0);
    }

    #[test]
    fn exact_a_hold_position_is_held_before_the_way_leads_home() {
        let mut flight = Flight::of(shipped::DRILL_HOVER);
        let place_m = flight.point_m(0, 0);
        flight.fly_all(0);
        let guidance = flight.guidance(place_m, Some(0));
        assert_eq!((guidance.step, guidance.words()), (GuidanceStep::HoldPosition, "Task 1: hold position".to_owned()));
        flight.flown[0].add_frame(Some(0), HOLD_DURATION - SimTime::from_ms(1));
        assert_eq!(flight.guidance(place_m, Some(0)).step, GuidanceStep::HoldPosition);
        flight.flown[0].add_frame(Some(0), SimTime::from_ms(1));
        assert_eq!(flight.guidance(place_m, Some(0)).step, GuidanceStep::FlyHome);
    }

    #[test]
    fn exact_steps_are_announced_once_they_last_and_the_way_is_repeated() {
        let flight = Flight::new();
        let far = flight.guidance(flight.scenario.ground_team.pad_m, None);
        let on = flight.guidance(flight.point_m(0, 0), Some(0));
        let mut announcer = StepAnnouncer::default();
        let mut said = |ms: i64, guidance: &Guidance| announcer.update(SimTime::from_ms(ms), guidance).join("; ");
        assert_eq!(said(0, &far), "");
        assert_eq!(said(1_500, &far), far.words());
        let visit = [said(1_700, &on), said(2_000, &far), said(3_500, &far)];
        assert_eq!(visit, ["", "", ""], "a short visit");
        assert_eq!(said(11_400, &far), "");
        assert_eq!(said(11_500, &far), far.words());
        assert_eq!([said(12_000, &on), said(13_500, &on)], ["", "Task 1: follow the path"]);
        assert_eq!(said(60_000, &on), "", "nothing new");
        let way = WayTo { distance_m: 8.0, bearing_rad: 0.0, up_m: 0.0 };
        let blocked = Guidance { detour: Some(Detour { kind: DetourKind::OutFromUnder, way }), ..far };
        assert_eq!([said(70_000, &blocked), said(71_000, &blocked)], ["", ""]);
        assert_eq!(said(71_500, &blocked), "Task 1: fly out from under the bridge first; First: 8 m, ahead");
    }
}
