//! A lesson: follows the trainee through its steps. Each step is announced, waits until it is done, and says what went wrong.

use crate::feedback::HeadingOffset;
use spandrel_mavlink::contract::lesson::{LessonStatus, LessonTask, TEXT_PREFIX};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{LessonPlace, LessonStep};
use spandrel_model::time::SimTime;

/// Shortest time for which a step is shown, so that a step that is already done can be read.
const MIN_STEP_DURATION: SimTime = SimTime::from_ms(1_500);
/// Shortest time between two remarks (estimate: one can be read and acted upon).
const REMARK_INTERVAL: SimTime = SimTime::from_ms(5_000);
/// Speed below which the aircraft counts as stopped, m/s (estimate: a held position in light wind is slower).
const STOPPED_M_S: f64 = 0.4;
/// Difference from the wanted pitch that the gimbal's own error explains, rad.
const TILT_TOLERANCE_RAD: f64 = 1.0 / 180.0 * math::PI;
/// Time in a ring after which leaving it is worth a remark.
const REMARK_HOLD: SimTime = SimTime::from_ms(1_000);
/// Interval at which the way to a step's place is repeated, as for the tasks of a job.
const WAY_INTERVAL: SimTime = SimTime::from_ms(10_000);
/// Time without progress after which the instruction is repeated (estimate: longer than reading it and flying to a ring takes).
const REPETITION_INTERVAL: SimTime = SimTime::from_ms(30_000);
/// Angle by which the camera may turn away from the wanted pitch without a remark, rad (estimate: one key press tilts it by less).
const WRONG_WAY_RAD: f64 = 8.0 / 180.0 * math::PI;

/// State of the flight that a lesson depends on.
#[derive(Debug, Clone, Copy)]
pub struct LessonInput<'a> {
    /// Simulation time.
    pub time: SimTime,
    /// Position of the drone.
    pub position_m: Vec3<Enu>,
    /// Heading, rad clockwise from north.
    pub heading_rad: f64,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Position of the landing pad.
    pub pad_m: Vec3<Enu>,
    /// Horizontal distance from the pad at which the drone counts as being there, m.
    pub home_radius_m: f64,
    /// Whether the motors are armed.
    pub armed: bool,
    /// Whether the drone flies home or lands by itself, so that the trainee does none of the steps before.
    pub is_return: bool,
    /// Whether the drone is on the ground.
    pub on_ground: bool,
    /// Pitch of the camera, rad, up positive.
    pub camera_pitch_rad: f64,
    /// Whether the lamp is on.
    pub lamp: bool,
    /// For each task of the job, the share of its path that was flown, and whether that is enough.
    pub tasks: &'a [(f64, bool)],
}

/// Result of evaluating a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PictureVerdict {
    /// At least one defect that counts.
    Shown,
    /// The defect that comes closest, and why it does not count.
    Missed(String),
    /// No defect.
    Nothing,
}

/// How far the trainee has come in a lesson.
#[derive(Debug, Clone, PartialEq)]
pub struct LessonCoach {
    steps: Vec<LessonStep>,
    /// Index of the current step.
    current: usize,
    /// Heading at the last input.
    last_heading_rad: f64,
    /// Whether the drone flies home or lands by itself.
    is_return: bool,
    state: StepState,
}

/// State of the current step.
#[derive(Debug, Clone, Default, PartialEq)]
struct StepState {
    /// Time at which the step began; `None` before the first input.
    begun: Option<SimTime>,
    /// Angle turned since then, clockwise positive.
    turned_rad: f64,
    /// Time since which the aircraft has been in the step's ring.
    held_since: Option<SimTime>,
    /// Whether the aircraft moves or has moved in the step's ring, in which it has to stop, since it entered the ring.
    passed: bool,
    /// Longest time without moving since it entered the ring.
    longest_hold: SimTime,
    /// Whether a picture of the step shows a defect.
    pictured: bool,
    /// Pitch of the camera when the step began.
    start_pitch_rad: Option<f64>,
    /// Highest progress, and since when.
    best: (f64, SimTime),
    announced: bool,
    way_sent_at: Option<SimTime>,
    remarked: Option<SimTime>,
}

impl LessonCoach {
    /// Creates the state before the first step; `None` for a job that is not a lesson.
    #[must_use]
    pub fn new(steps: &[LessonStep]) -> Option<Self> {
        let state = StepState::default();
        (!steps.is_empty()).then(|| Self { steps: steps.to_vec(), current: 0, last_heading_rad: 0.0, is_return: false, state })
    }

    /// Returns the task that the trainee follows in this step, if it is one.
    #[must_use]
    pub fn path_task(&self) -> Option<u32> {
        match self.steps.get(self.current) {
            Some(LessonStep::FlyPath { task }) => Some(*task),
            _ => None,
        }
    }

    /// Returns the number of steps that are done.
    #[must_use]
    pub fn done(&self) -> usize {
        self.current
    }

    /// Updates the lesson and returns the texts to send to the pilot.
    pub fn update(&mut self, input: &LessonInput) -> Vec<String> {
        let begun = *self.state.begun.get_or_insert_with(|| {
            self.last_heading_rad = input.heading_rad;
            input.time
        });
        let turned_rad = math::wrap_pi(input.heading_rad - std::mem::replace(&mut self.last_heading_rad, input.heading_rad));
        let mut texts = Vec::new();
        let can_go_on = |step: &LessonStep| !input.is_return || matches!(step, LessonStep::FlyHome | LessonStep::Land);
        self.is_return = input.is_return;
        if input.is_return {
            self.state.held_since = None;
        }
        if let Some(step) = self.steps.get(self.current).copied().filter(can_go_on) {
            self.state.turned_rad += turned_rad;
            texts.extend(self.mistake(&step, input));
            if self.progress(&step, input) >= 1.0 && input.time - begun >= MIN_STEP_DURATION {
                self.begin_next(input);
            }
        }
        texts.extend(self.instructions(input));
        texts
    }

    /// Returns the instruction of a new step or of one without progress, and the way to the step's place.
    fn instructions(&mut self, input: &LessonInput) -> Vec<String> {
        let status = self.status(input);
        if status.progress > self.state.best.0 || !self.state.announced {
            self.state.best = (status.progress, input.time);
        }
        let is_stuck = !status.is_done() && input.time - self.state.best.1 >= REPETITION_INTERVAL;
        let mut texts = Vec::new();
        if !self.state.announced || is_stuck {
            (self.state.announced, self.state.best.1) = (true, input.time);
            texts.push(status.words());
        }
        let is_due = self.state.way_sent_at.is_none_or(|sent_at| input.time - sent_at >= WAY_INTERVAL);
        if let Some(words) = status.way_words().filter(|_| is_due) {
            self.state.way_sent_at = Some(input.time);
            texts.push(words);
        }
        texts
    }

    /// Handles a picture, and returns the text to send to the pilot.
    pub fn handle_picture(&mut self, verdict: &PictureVerdict) -> Option<String> {
        if self.is_return || !matches!(self.steps.get(self.current), Some(LessonStep::Photograph)) {
            return None;
        }
        match verdict {
            PictureVerdict::Shown => {
                self.state.pictured = true;
                None
            }
            PictureVerdict::Missed(why) => Some(format!("{TEXT_PREFIX}{why}")),
            PictureVerdict::Nothing => Some(format!("{TEXT_PREFIX}no defect in the picture")),
        }
    }

    fn begin_next(&mut self, input: &LessonInput) {
        self.current += 1;
        self.state = StepState { begun: Some(input.time), ..StepState::default() };
    }

    /// Returns a remark about a mistake in this step, and measures how long the aircraft has been in the step's ring.
    fn mistake(&mut self, step: &LessonStep, input: &LessonInput) -> Option<String> {
        match step {
            LessonStep::Land => self.landed_elsewhere(input),
            LessonStep::Arm => None,
            _ if !input.armed => self.remark(input.time, "the motors are off: arm them again"),
            LessonStep::TiltCamera { pitch_rad } => self.tilted_wrong(step, *pitch_rad, input),
            LessonStep::Hover(place) | LessonStep::StopAt(place) => self.hold(step, place, input),
            LessonStep::TakeOff { .. }
            | LessonStep::Turn { .. }
            | LessonStep::FlyPath { .. }
            | LessonStep::Lamp
            | LessonStep::Photograph
            | LessonStep::FlyHome => None,
        }
    }

    fn landed_elsewhere(&mut self, input: &LessonInput) -> Option<String> {
        let distance_m = (input.position_m - input.pad_m).horizontal_norm();
        if !input.on_ground || distance_m <= input.home_radius_m {
            return None;
        }
        self.remark(input.time, &format!("you landed {distance_m:.0} m from the pad"))
    }

    fn tilted_wrong(&mut self, step: &LessonStep, pitch_rad: f64, input: &LessonInput) -> Option<String> {
        let start_rad = *self.state.start_pitch_rad.get_or_insert(input.camera_pitch_rad);
        let turned_rad = (input.camera_pitch_rad - start_rad) * pitch_rad.signum();
        let is_reached = self.progress(step, input) >= 1.0;
        if is_reached || turned_rad > -WRONG_WAY_RAD {
            return None;
        }
        let (wanted, done) = if pitch_rad < 0.0 { ("down", "up") } else { ("up", "down") };
        self.remark(input.time, &format!("tilt the camera {wanted}, not {done}"))
    }

    /// Measures how long the aircraft has been in the ring, and returns a remark when it leaves it too early.
    fn hold(&mut self, step: &LessonStep, place: &LessonPlace, input: &LessonInput) -> Option<String> {
        let stop = matches!(step, LessonStep::StopAt(_));
        let inside = (input.position_m - place.position_m).norm() <= place.radius_m;
        if inside && !(stop && input.speed_m_s > STOPPED_M_S) {
            self.state.held_since.get_or_insert(input.time);
            return None;
        }
        let held = self.state.held_since.take().map_or(SimTime::ZERO, |since| input.time - since);
        self.state.longest_hold = self.state.longest_hold.max(held);
        if inside {
            self.state.passed = true;
            return None;
        }
        let (passed, held) = (std::mem::take(&mut self.state.passed), std::mem::take(&mut self.state.longest_hold));
        if self.progress(step, input) >= 1.0 {
            None
        } else if held >= REMARK_HOLD {
            self.remark(input.time, &format!("you left the ring: stay {:.0} s", place.duration.s()))
        } else if passed {
            self.remark(input.time, "you flew through the ring: stop in it")
        } else {
            None
        }
    }

    /// Returns a remark, unless there was one just before.
    fn remark(&mut self, now: SimTime, words: &str) -> Option<String> {
        if self.state.remarked.is_some_and(|at| now - at < REMARK_INTERVAL) {
            return None;
        }
        self.state.remarked = Some(now);
        Some(format!("{TEXT_PREFIX}{words}"))
    }

    /// Returns how much of a step is done, 0 to 1.
    fn progress(&self, step: &LessonStep, input: &LessonInput) -> f64 {
        let yes = |done: bool| if done { 1.0 } else { 0.0 };
        let is_home = (input.position_m - input.pad_m).horizontal_norm() <= input.home_radius_m;
        let share = match step {
            LessonStep::Arm => yes(input.armed),
            LessonStep::TakeOff { height_m } => (input.position_m.up() - input.pad_m.up()) / height_m,
            LessonStep::Hover(place) | LessonStep::StopAt(place) => self.held_share(place, input.time),
            LessonStep::Turn { angle_rad } => self.state.turned_rad.abs() / angle_rad,
            LessonStep::FlyPath { task } => match input.tasks.get(*task as usize - 1) {
                Some((_, true)) => 1.0,
                Some((share, false)) => share.min(0.99),
                None => 1.0,
            },
            LessonStep::TiltCamera { pitch_rad } => {
                if *pitch_rad < 0.0 {
                    yes(input.camera_pitch_rad <= *pitch_rad + TILT_TOLERANCE_RAD)
                } else {
                    yes(input.camera_pitch_rad >= *pitch_rad - TILT_TOLERANCE_RAD)
                }
            }
            LessonStep::Lamp => yes(input.lamp),
            LessonStep::Photograph => yes(self.state.pictured),
            LessonStep::FlyHome => yes(is_home),
            // Not when the motors stop: the session may end before.
            LessonStep::Land => yes(is_home && input.on_ground),
        };
        share.clamp(0.0, 1.0)
    }

    fn held_share(&self, place: &LessonPlace, now: SimTime) -> f64 {
        let held = self.state.held_since.map_or(SimTime::ZERO, |since| now - since);
        match (self.state.held_since, place.duration.s()) {
            (Some(_), duration_s) if duration_s <= 0.0 => 1.0,
            (_, duration_s) => held.s() / duration_s.max(1e-3),
        }
    }

    /// Returns the current step for displays.
    #[must_use]
    pub fn status(&self, input: &LessonInput) -> LessonStatus {
        let steps = self.steps.len() as u32;
        let Some(step) = self.steps.get(self.current) else {
            let done = LessonTask::Done;
            return LessonStatus { task: done, step: steps + 1, steps, progress: 1.0, way: None, radius_m: None, target: None };
        };
        let home = (*step == LessonStep::FlyHome).then_some((input.pad_m, input.home_radius_m));
        let ring = step.place().map(|place| (place.position_m, place.radius_m)).or(home);
        let target = match step {
            LessonStep::TakeOff { height_m } => Some(*height_m),
            LessonStep::Hover(place) | LessonStep::StopAt(place) => Some(place.duration.s()),
            LessonStep::Turn { angle_rad } => Some(*angle_rad),
            LessonStep::TiltCamera { pitch_rad } => Some(*pitch_rad),
            LessonStep::Arm
            | LessonStep::FlyPath { .. }
            | LessonStep::Lamp
            | LessonStep::Photograph
            | LessonStep::FlyHome
            | LessonStep::Land => None,
        };
        LessonStatus {
            task: task_of(step),
            step: self.current as u32 + 1,
            steps,
            progress: self.progress(step, input),
            way: ring.map(|(place_m, _)| HeadingOffset::new(place_m - input.position_m, input.heading_rad).way()),
            radius_m: ring.map(|(_, radius_m)| radius_m),
            target,
        }
    }
}

/// Returns the task of a step in a scenario file.
fn task_of(step: &LessonStep) -> LessonTask {
    match step {
        LessonStep::Arm => LessonTask::Arm,
        LessonStep::TakeOff { .. } => LessonTask::TakeOff,
        LessonStep::Hover(_) => LessonTask::Hover,
        LessonStep::Turn { .. } => LessonTask::Turn,
        LessonStep::FlyPath { .. } => LessonTask::FlyPath,
        LessonStep::StopAt(_) => LessonTask::StopAt,
        LessonStep::TiltCamera { .. } => LessonTask::TiltCamera,
        LessonStep::Lamp => LessonTask::Lamp,
        LessonStep::Photograph => LessonTask::Photograph,
        LessonStep::FlyHome => LessonTask::FlyHome,
        LessonStep::Land => LessonTask::Land,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACE: LessonPlace =
        LessonPlace { position_m: Vec3::new(0.0, 10.0, 5.0), radius_m: 2.0, duration: SimTime::from_ms(10_000) };

    fn input(ms: i64) -> LessonInput<'static> {
        LessonInput {
            time: SimTime::from_ms(ms),
            position_m: Vec3::zero(),
            heading_rad: 0.0,
            speed_m_s: 0.0,
            pad_m: Vec3::zero(),
            home_radius_m: 3.0,
            armed: true,
            is_return: false,
            on_ground: false,
            camera_pitch_rad: 0.0,
            lamp: false,
            tasks: &[(0.5, false)],
        }
    }

    fn coach(steps: &[LessonStep]) -> LessonCoach {
        LessonCoach::new(steps).unwrap()
    }

    #[test]
    fn exact_each_step_waits_until_it_is_done_and_is_announced_once() {
        let mut coach = coach(&[LessonStep::Arm, LessonStep::TakeOff { height_m: 2.0 }, LessonStep::Land]);
        let off = |ms| LessonInput { armed: false, ..input(ms) };
        assert_eq!(coach.update(&off(0)), ["Lesson: 1/3 arm the motors"]);
        assert!(coach.update(&off(29_000)).is_empty() && coach.done() == 0, "it waits");
        assert_eq!(coach.update(&off(30_000)), ["Lesson: 1/3 arm the motors"], "nothing has happened");
        assert_eq!(coach.update(&input(60_100)), ["Lesson: 2/3 take off to 2 m"]);
        let up = |ms| LessonInput { position_m: Vec3::new(0.0, 0.0, 2.1), ..input(ms) };
        assert!(coach.update(&up(60_200)).is_empty(), "the step is shown for a moment");
        assert_eq!(coach.update(&up(61_700)), ["Lesson: 3/3 land on the pad"]);
        let down = |ms| LessonInput { armed: false, on_ground: true, ..input(ms) };
        assert_eq!(coach.update(&down(70_000)), ["Lesson: all steps done"]);
        assert_eq!((coach.done(), coach.status(&down(70_000)).task), (3, LessonTask::Done));
        assert_eq!(LessonCoach::new(&[]), None, "not a lesson");
    }

    #[test]
    fn exact_the_return_does_no_step_but_those_that_lead_home() {
        let mut coach = coach(&[LessonStep::Turn { angle_rad: 1.0 }, LessonStep::FlyHome]);
        let at = |ms, heading_rad, is_return| LessonInput { heading_rad, is_return, ..input(ms) };
        coach.update(&at(0, 0.0, false));
        coach.update(&at(5_000, 1.5, true));
        assert_eq!((coach.done(), coach.status(&at(5_000, 1.5, true)).progress), (0, 0.0), "the autopilot has turned");
        coach.update(&at(6_000, 2.6, false));
        assert_eq!(coach.done(), 1);
        coach.update(&at(9_000, 2.6, true));
        assert_eq!(coach.done(), 2);
        let mut coach = self::coach(&[LessonStep::Hover(PLACE), LessonStep::Photograph]);
        let in_ring = |ms, is_return| LessonInput { position_m: PLACE.position_m, is_return, ..input(ms) };
        coach.update(&in_ring(0, false));
        coach.update(&in_ring(8_000, true));
        coach.update(&in_ring(12_000, false));
        assert_eq!((coach.done(), coach.status(&in_ring(12_000, false)).progress), (0, 0.0), "the time in the ring begins again");
        coach.update(&in_ring(22_000, false));
        coach.update(&in_ring(22_100, true));
        assert_eq!((coach.done(), coach.handle_picture(&PictureVerdict::Nothing)), (1, None));
    }

    #[test]
    fn exact_leaving_the_ring_restarts_the_time_and_is_remarked() {
        let mut coach = coach(&[LessonStep::Hover(PLACE)]);
        let at = |ms, north| LessonInput { position_m: Vec3::new(0.0, north, 5.0), ..input(ms) };
        coach.update(&at(0, 9.0));
        assert!(coach.update(&at(9_000, 11.0)).is_empty());
        assert!((coach.status(&at(9_000, 11.0)).progress - 0.9).abs() < 1e-9);
        let said = coach.update(&at(9_100, 13.0));
        assert_eq!(said, ["Lesson: you left the ring: stay 10 s", "Lesson: 1/1 3 m, behind you"]);
        assert_eq!(coach.status(&at(9_200, 13.0)).progress, 0.0);
        let way = coach.status(&at(9_200, 13.0)).way.unwrap();
        assert!((way.distance_m - 3.0).abs() < 1e-9 && (way.bearing_rad.abs() - math::PI).abs() < 1e-9, "{way:?}");
        coach.update(&at(10_000, 10.0));
        assert!(coach.update(&at(19_900, 10.0)).is_empty());
        assert_eq!(coach.update(&at(20_000, 10.0)), ["Lesson: all steps done"]);
    }

    #[test]
    fn exact_flying_through_the_ring_is_not_a_stop() {
        let mut coach = coach(&[LessonStep::StopAt(PLACE)]);
        let at = |ms, speed_m_s| LessonInput { position_m: PLACE.position_m, speed_m_s, ..input(ms) };
        coach.update(&at(0, 2.0));
        coach.update(&at(20_000, 2.0));
        assert_eq!(coach.done(), 0);
        let beyond = LessonInput { position_m: Vec3::new(0.0, 15.0, 5.0), ..at(20_100, 2.0) };
        let said = coach.update(&beyond);
        assert_eq!(said, ["Lesson: you flew through the ring: stop in it", "Lesson: 1/1 5 m, behind you"]);
        coach.update(&at(21_000, 0.1));
        coach.update(&at(23_000, 1.0));
        let left = LessonInput { time: SimTime::from_ms(26_000), ..beyond };
        assert_eq!(coach.update(&left), ["Lesson: you left the ring: stay 10 s"], "after 2 s without moving");
        coach.update(&at(31_000, 0.1));
        assert_eq!(coach.update(&at(41_000, 0.1)), ["Lesson: all steps done"]);
    }

    #[test]
    fn exact_pictures_count_only_in_their_step_and_misses_are_explained() {
        let mut coach = coach(&[LessonStep::Lamp, LessonStep::Photograph]);
        assert_eq!(coach.handle_picture(&PictureVerdict::Shown), None);
        coach.update(&input(0));
        coach.update(&LessonInput { lamp: true, ..input(2_000) });
        let why = PictureVerdict::Missed("too dark".to_owned());
        assert_eq!(coach.handle_picture(&why).as_deref(), Some("Lesson: too dark"));
        assert_eq!(coach.handle_picture(&PictureVerdict::Nothing).as_deref(), Some("Lesson: no defect in the picture"));
        coach.update(&input(4_000));
        assert_eq!(coach.done(), 1, "the picture before the step does not count");
        coach.handle_picture(&PictureVerdict::Shown);
        assert_eq!(coach.update(&input(4_100)), ["Lesson: all steps done"]);
    }

    #[test]
    fn exact_turns_tilts_paths_and_the_way_home_have_their_goals() {
        let done = |step: LessonStep, now: LessonInput| {
            let mut coach = coach(&[step]);
            coach.update(&input(0));
            coach.update(&LessonInput { time: SimTime::from_ms(2_000), ..now });
            coach.done() == 1
        };
        let turn = LessonStep::Turn { angle_rad: 1.0 };
        assert!(!done(turn, LessonInput { heading_rad: 0.9, ..input(0) }));
        assert!(done(turn, LessonInput { heading_rad: -1.1, ..input(0) }), "either way");
        let mut half = coach(&[LessonStep::Turn { angle_rad: math::PI }]);
        for (k, heading_rad) in [0.0, 1.2, 2.4, -2.6, -1.4].into_iter().enumerate() {
            half.update(&LessonInput { time: SimTime::from_ms(2_000 * k as i64), heading_rad, ..input(0) });
        }
        assert_eq!(half.done(), 1, "half a turn is done once the heading passes it");
        let tilt = LessonStep::TiltCamera { pitch_rad: 0.3 };
        assert!(!done(tilt, input(0)) && done(tilt, LessonInput { camera_pitch_rad: 0.299, ..input(0) }));
        let down = LessonStep::TiltCamera { pitch_rad: -0.3 };
        assert!(!done(down, input(0)) && done(down, LessonInput { camera_pitch_rad: -0.299, ..input(0) }));
        let path = LessonStep::FlyPath { task: 1 };
        assert!(!done(path, input(0)) && done(path, LessonInput { tasks: &[(0.85, true)], ..input(0) }));
        let home = LessonStep::FlyHome;
        assert!(!done(home, LessonInput { position_m: Vec3::new(9.0, 0.0, 5.0), ..input(0) }) && done(home, input(0)));
    }

    #[test]
    fn exact_the_way_to_a_ring_is_said_and_repeated_outside_it() {
        let mut coach = coach(&[LessonStep::Hover(PLACE)]);
        let at = |ms, north| LessonInput { position_m: Vec3::new(0.0, north, 5.0), ..input(ms) };
        assert_eq!(coach.update(&at(0, 0.0)), ["Lesson: 1/1 hover in the ring for 10 s", "Lesson: 1/1 10 m, ahead"]);
        assert!(coach.update(&at(9_900, 0.0)).is_empty());
        assert_eq!(coach.update(&at(10_000, 2.0)), ["Lesson: 1/1 8 m, ahead"]);
        assert!(coach.update(&at(20_000, 9.0)).is_empty(), "it is there");
    }

    #[test]
    fn exact_a_camera_tilted_the_wrong_way_and_a_landing_elsewhere_are_remarked() {
        let mut tilting = coach(&[LessonStep::TiltCamera { pitch_rad: 0.3 }]);
        let pitch = |ms, camera_pitch_rad| LessonInput { camera_pitch_rad, ..input(ms) };
        tilting.update(&pitch(0, -0.1));
        assert!(tilting.update(&pitch(1_000, -0.2)).is_empty());
        assert_eq!(tilting.update(&pitch(2_000, -0.4)), ["Lesson: tilt the camera up, not down"]);
        let mut landing = coach(&[LessonStep::Land]);
        let down = |ms, east| LessonInput { position_m: Vec3::new(east, 0.0, 0.0), on_ground: true, armed: false, ..input(ms) };
        assert_eq!(landing.update(&down(0, 12.0)), ["Lesson: you landed 12 m from the pad", "Lesson: 1/1 land on the pad"]);
        assert_eq!(landing.update(&down(2_000, 1.0)), ["Lesson: all steps done"]);
    }

    #[test]
    fn exact_stopped_motors_are_remarked() {
        let mut coach = coach(&[LessonStep::TakeOff { height_m: 2.0 }]);
        let off = |ms| LessonInput { armed: false, ..input(ms) };
        let first = coach.update(&off(0));
        assert!(first.contains(&"Lesson: the motors are off: arm them again".to_owned()), "{first:?}");
        assert!(coach.update(&off(1_000)).is_empty() && coach.update(&off(5_000)).len() == 1, "not too often");
    }
}
