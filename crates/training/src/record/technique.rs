//! How a task was flown: measures that explain the scores. They also cover a drone that flew beside a path without ever
//! being on it.

use super::crashes::Crashes;
use super::source::RecordSource;
use serde::{Deserialize, Serialize};
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{Scenario, Task};
use spandrel_monitor::measures::coverage::FlownPath;
use spandrel_monitor::measures::on_path::{OnPath, ReferencePaths};

/// Maximum distance from a path at which the drone counts as off that path, m. Farther away, it counts as elsewhere
/// (docs/src/reference/assessment.md, "Feedback during the flight").
pub const MAX_OFF_PATH_DISTANCE_M: f64 = 8.0;
/// Fraction of the time near a path that the drone must be on it for the path to count as flown (estimate).
const MIN_ON_PATH_FRACTION: f64 = 0.5;
/// Stick movement that counts as a reversal, as a fraction of the travel from the center to the stop (the method of
/// steering wheel reversals in SAE J2944; the value for sticks is an estimate).
const REVERSAL_GAP: f64 = 0.2;
/// Vertical component of the viewing direction above which the stand-off is mostly vertical, so that a height error is a
/// stand-off error (45 degrees).
const MAX_LEVEL_VIEW_UP: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Speed above which a picture counts as taken in motion, m/s (estimate: position hold in a breeze stays below it).
const MOVING_M_S: f64 = 0.5;
/// Speed above which the drone drifts while a picture is taken, m/s (estimate: careful pilots take theirs below 0.15 m/s).
const DRIFTING_M_S: f64 = 0.2;
/// Speed of a stick between two frames from which it jumps, in travels from the center to the stop per second (estimate: a tenth of the travel
/// between two frames at 30 Hz).
const JUMP_PER_S: f64 = 3.0;
/// Deflection from which a stick isn't centered, as a fraction of that travel (estimate). To let go of a stick or to start a movement
/// with a key is no jump.
const DEFLECTED: f64 = 0.02;
/// Yaw stick deflection above which a picture is taken while turning, as a fraction of that travel (estimate: the deadband of the sticks).
const TURNING: f64 = 0.1;
/// Horizontal distance from the landing pad within which the pilot lands, m (estimate).
const LANDING_RADIUS_M: f64 = 10.0;
/// Lower and upper quantile between which a spread is measured: a short excursion doesn't count.
const SPREAD_QUANTILES: (f64, f64) = (0.1, 0.9);
/// Distance within which the nearest position on a path counts as its end, m.
const END_TOLERANCE_M: f64 = 1e-6;

/// How one task was flown. Frames count for the path that the drone is on or else for the nearest one within 8 m,
/// except while the drone is past that path's ends. If it was on the path for at least half of that time, only frames between
/// the first and the last one on the path count, not the way to and from the path.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct TaskTechnique {
    /// Time that counts for this path, s.
    pub near_s: f64,
    /// Fraction of the path's length that the drone passed within 8 m, 0 to 1; the way to the path and back counts, too.
    pub passed: f64,
    /// Median height above the path, m, positive upward; `None` if the stand-off is vertical or the drone never came near.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_error_m: Option<f64>,
    /// Median distance from the surface beyond the path's, m, positive if too far; `None` if the task inspects no surface
    /// or the drone never came near.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stand_off_error_m: Option<f64>,
    /// Half the range of the distance from the surface beyond the path's between its 10th and 90th percentile, m: how much the
    /// distance changes, wherever its median is. `None` like the median, and in records before format 8.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stand_off_spread_m: Option<f64>,
    /// Half the range of the height above the path between its 10th and 90th percentile, m. `None` like the median, and in records
    /// before format 9.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_spread_m: Option<f64>,
    /// RMS framing error of the certification profile, degrees; `None` if the task inspects no surface or its path was
    /// not entered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rms_framing_deg: Option<f64>,
    /// Fraction of the time near the path below the minimum clearance, 0 to 1.
    pub low_clearance: f64,
    /// Fraction of the time near the path with the lamp off, 0 to 1; `None` if the task needs no lamp.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lamp_off: Option<f64>,
    /// Number of reversals per minute near the path of the forward, right and up sticks together.
    pub stick_reversals_per_min: f64,
    /// Number of reversals per minute near the path of the yaw stick.
    pub yaw_reversals_per_min: f64,
    /// Number of jumps per minute near the path of the forward, right and up sticks together: movements faster than 3 travels per
    /// second between two deflected positions. `None` in records before format 9.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stick_jumps_per_min: Option<f64>,
    /// Number of pictures taken near the path; `None` in records before format 10.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pictures: Option<usize>,
    /// Fraction of these pictures that were taken with the lamp off, 0 to 1; `None` if the task needs no lamp, without pictures
    /// there, and in records before format 9.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unlit_pictures: Option<f64>,
    /// Contacts within the task's window, merged if they are less than a second apart.
    pub contacts: Crashes,
    /// Speed of the fastest of these contacts, m/s; 0 without contacts.
    pub fastest_contact_m_s: f64,
}

/// Technique outside the tasks and over the whole session.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct SessionTechnique {
    /// Contacts outside all task windows, merged if they are less than a second apart.
    pub contacts_outside: Crashes,
    /// Time below the minimum clearance, s.
    pub exposure_s: f64,
    /// Fraction of the pictures that were taken in motion (above 0.5 m/s), 0 to 1; `None` without pictures, and in records before
    /// format 8.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moving_pictures: Option<f64>,
    /// Fraction of the pictures that were taken while the drone drifted (0.2 to 0.5 m/s), 0 to 1; `None` without pictures, and in
    /// records before format 9.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drifting_pictures: Option<f64>,
    /// Fraction of the pictures that were taken while the yaw stick was deflected, 0 to 1; `None` without pictures, and in records
    /// before format 9.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turning_pictures: Option<f64>,
    /// Time from the last approach to within 10 m of the landing pad, measured horizontally, to the end of the flight, s; `None` if the
    /// drone never left that circle, and in records before format 9.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub landing_s: Option<f64>,
}

/// Samples of one task, in frame order.
#[derive(Default)]
struct NearSamples {
    frames: usize,
    heights_m: Vec<f64>,
    stand_offs_m: Vec<f64>,
    low_clearance: usize,
    lamp_off: usize,
    sticks: [ReversalCounter; 4],
    /// Index and sticks of the latest of these frames.
    latest: Option<(usize, [f64; 4])>,
    jumps: usize,
    pictures: usize,
    unlit_pictures: usize,
}

/// Counts the reversals of one stick axis.
#[derive(Debug, Clone, Copy, Default)]
struct ReversalCounter {
    /// Lowest and highest position since the last reversal.
    range: Option<(f64, f64)>,
    /// Direction of the current movement; `None` until the stick has moved by the gap.
    rising: Option<bool>,
    count: usize,
}

impl ReversalCounter {
    fn add(&mut self, position: f64) {
        let (low, high) = self.range.map_or((position, position), |(low, high)| (low.min(position), high.max(position)));
        self.range = Some((low, high));
        let turned = match self.rising {
            Some(true) | None if high - position > REVERSAL_GAP => Some(false),
            Some(false) | None if position - low > REVERSAL_GAP => Some(true),
            Some(_) | None => None,
        };
        if let Some(rising) = turned {
            self.count += usize::from(self.rising.is_some());
            self.rising = Some(rising);
            self.range = Some((position, position));
        }
    }
}

/// Computes the technique of every task, in scenario order.
pub(super) fn tasks(source: &RecordSource<'_>, paths: &ReferencePaths, on_path: &OnPath) -> Vec<TaskTechnique> {
    let (scenario, frames) = (source.scenario, &source.assessed_session.frames);
    let count = scenario.tasks.len();
    let frame_s = 1.0 / scenario.scoring.frame_rate_hz;
    let mut samples: Vec<NearSamples> = (0..count).map(|_| NearSamples::default()).collect();
    let mut passed: Vec<FlownPath> = (0..count).map(|task| FlownPath::new(paths.path(task), MAX_OFF_PATH_DISTANCE_M)).collect();
    let mut near = nearest_paths(scenario, frames, paths, on_path);
    for (k, near) in near.iter().enumerate() {
        for (task, path) in passed.iter_mut().enumerate() {
            path.add_frame(near.and_then(|near| (near.task == task).then_some(near.point)), paths.frame_duration(k));
        }
    }
    drop_ways(&mut near, on_path);
    for (k, (frame, near)) in frames.iter().zip(&near).enumerate() {
        if let Some(near) = near {
            samples[near.task].add(frame, near, &scenario.tasks, clearance_limit_m(scenario, near.task));
            samples[near.task].add_sticks((k, frame.sticks), frame_s);
        }
    }
    let one = |(task, samples): (usize, NearSamples)| {
        let passed = if samples.frames > 0 { passed[task].coverage().share } else { 0.0 };
        with_certification(source, task, samples.technique(&scenario.tasks[task], passed, frame_s))
    };
    samples.into_iter().enumerate().map(one).collect()
}

/// Returns the technique outside the tasks.
pub(super) fn session(source: &RecordSource<'_>) -> SessionTechnique {
    let certification = &source.assessed_session.assessment.certification;
    SessionTechnique {
        contacts_outside: contacts(source, None).0,
        exposure_s: certification.exposure_s,
        moving_pictures: share_of_pictures(&source.assessed_session.frames, is_in_motion),
        drifting_pictures: share_of_pictures(&source.assessed_session.frames, is_drifting),
        turning_pictures: share_of_pictures(&source.assessed_session.frames, is_turning),
        landing_s: landing_s(source),
    }
}

/// Returns whether a picture in this frame is taken in motion.
pub fn is_in_motion(frame: &Frame) -> bool {
    !frame.missing && frame.speed_m_s() > MOVING_M_S
}

/// Returns whether a picture in this frame is taken while the drone drifts.
pub fn is_drifting(frame: &Frame) -> bool {
    !frame.missing && frame.speed_m_s() > DRIFTING_M_S && !is_in_motion(frame)
}

/// Returns whether the drone turns in this frame because of the pilot.
pub fn is_turning(frame: &Frame) -> bool {
    frame.sticks[3].abs() > TURNING
}

/// Returns the index of the last frame before the drone came near the landing pad for good; `None` if it never left its surroundings.
pub fn last_approach(scenario: &Scenario, frames: &[Frame]) -> Option<usize> {
    let pad_m = scenario.ground_team.pad_m;
    frames.iter().rposition(|frame| (frame.position_m - pad_m).horizontal_norm() > LANDING_RADIUS_M)
}

/// Returns the time since the last approach to the landing pad; `None` if the drone never left its surroundings.
fn landing_s(source: &RecordSource<'_>) -> Option<f64> {
    let frames = &source.assessed_session.frames;
    let away = last_approach(source.scenario, frames)?;
    Some((frames.len() - 1 - away) as f64 / source.scenario.scoring.frame_rate_hz)
}

/// Returns the fraction of the pictures that were taken in such frames; `None` without pictures.
fn share_of_pictures(frames: &[Frame], is_meant: fn(&Frame) -> bool) -> Option<f64> {
    let taken = frames.iter().filter(|frame| frame.snapshot);
    let meant = taken.clone().filter(|frame| is_meant(frame)).count();
    let taken = taken.count();
    (taken > 0).then(|| meant as f64 / taken as f64)
}

/// Returns whether a stick jumps between two positions in consecutive frames.
fn is_jump((before, after): (f64, f64), frame_s: f64) -> bool {
    (after - before).abs() > JUMP_PER_S * frame_s && before.abs() > DEFLECTED && after.abs() > DEFLECTED
}

/// Returns the merged contacts of a task, or outside all tasks, and the speed of the fastest.
fn contacts(source: &RecordSource<'_>, task: Option<u32>) -> (Crashes, f64) {
    let merged = &source.assessed_session.assessment.certification.crashes;
    let mut counts = Crashes::default();
    let mut fastest_m_s = 0.0_f64;
    for crash in merged.iter().filter(|crash| crash.task == task) {
        counts.add(crash.with);
        fastest_m_s = fastest_m_s.max(crash.speed_m_s);
    }
    (counts, fastest_m_s)
}

/// Adds the measures that the certification profile has already computed.
fn with_certification(source: &RecordSource<'_>, task: usize, technique: TaskTechnique) -> TaskTechnique {
    let id = source.scenario.tasks[task].id;
    let graded = source.assessed_session.assessment.certification.tasks.iter().find(|graded| graded.id == id);
    let (contacts, fastest_contact_m_s) = contacts(source, Some(id));
    let rms_framing_deg = graded.and_then(|graded| graded.precision).and_then(|precision| precision.rms_framing_deg);
    TaskTechnique { rms_framing_deg, contacts, fastest_contact_m_s, ..technique }
}

/// Position relative to the path that a frame counts for.
#[derive(Debug, Clone, Copy)]
pub struct NearPath {
    /// Index of the task.
    pub task: usize,
    /// Index of the nearest path point.
    pub point: usize,
    /// Vector from the nearest position on the path to the drone, m.
    pub offset_m: Vec3<Enu>,
}

impl NearPath {
    /// Returns the distance from the surface beyond the path's in meters, positive if too far; `None` if the task inspects no
    /// surface.
    pub fn stand_off_error_m(&self, tasks: &[Task]) -> Option<f64> {
        self.view(tasks).map(|view| -self.offset_m.dot(view))
    }

    /// Returns the height above the path in meters, positive upward; `None` if the stand-off is vertical.
    pub fn height_error_m(&self, tasks: &[Task]) -> Option<f64> {
        let is_level = self.view(tasks).is_none_or(|view| view.up().abs() < MAX_LEVEL_VIEW_UP);
        is_level.then(|| self.offset_m.up())
    }

    /// Returns the viewing direction at the nearest path point; `None` if the task inspects no surface.
    pub fn view(&self, tasks: &[Task]) -> Option<Vec3<Enu>> {
        let task = &tasks[self.task];
        task.viewing_directions.get(self.point).copied().filter(|_| task.inspects_surface)
    }
}

/// Returns the path that each frame counts for; `None` for a missing frame, for one that is elsewhere, and for the way to and from a
/// path that was flown.
pub fn near_frames(scenario: &Scenario, frames: &[Frame], paths: &ReferencePaths, on_path: &OnPath) -> Vec<Option<NearPath>> {
    let mut near = nearest_paths(scenario, frames, paths, on_path);
    drop_ways(&mut near, on_path);
    near
}

/// Returns the nearest path of each frame; `None` for a missing frame and for one that is elsewhere.
fn nearest_paths(scenario: &Scenario, frames: &[Frame], paths: &ReferencePaths, on_path: &OnPath) -> Vec<Option<NearPath>> {
    let near = |(frame, on): (&Frame, &Option<(usize, usize)>)| {
        if frame.missing { None } else { near_task(paths, &scenario.tasks, frame, on.map(|(task, _)| task)) }
    };
    frames.iter().zip(&on_path.task).map(near).collect()
}

/// Drops the ways to and from the paths that were flown.
fn drop_ways(near: &mut [Option<NearPath>], on_path: &OnPath) {
    (0..on_path.windows.len()).for_each(|task| drop_ways_of(task, near, on_path));
}

fn drop_ways_of(task: usize, near: &mut [Option<NearPath>], on_path: &OnPath) {
    let is_near = |near: &Option<NearPath>| near.is_some_and(|near| near.task == task);
    let all = near.iter().filter(|near| is_near(near)).count();
    let is_on = |(near, on): &(&Option<NearPath>, &Option<(usize, usize)>)| is_near(near) && on.is_some_and(|(on, _)| on == task);
    let on = near.iter().zip(&on_path.task).filter(is_on).count();
    let Some(window) = on_path.windows[task].filter(|_| on as f64 >= MIN_ON_PATH_FRACTION * all as f64) else { return };
    let outside = near.iter_mut().enumerate().filter(|(frame, near)| is_near(near) && !window.contains(*frame));
    outside.for_each(|(_, near)| *near = None);
}

/// Returns the minimum clearance near a task's path, m.
pub fn clearance_limit_m(scenario: &Scenario, task: usize) -> f64 {
    scenario.tasks[task].too_close_m.unwrap_or(f64::INFINITY).min(scenario.scoring.clearance_m)
}

fn near_task(paths: &ReferencePaths, tasks: &[Task], frame: &Frame, on: Option<usize>) -> Option<NearPath> {
    let at = |task: usize| {
        let path = paths.path(task);
        if path.is_beyond(frame.position_m, MAX_OFF_PATH_DISTANCE_M) {
            return None;
        }
        let point = path.nearest_exact(frame.position_m)?.point;
        let foot_m = path.closest_position(frame.position_m)?;
        let offset_m = frame.position_m - foot_m;
        let ends = [path.points_m().first(), path.points_m().last()];
        let at_end = ends.into_iter().flatten().any(|end| (*end - foot_m).norm() < END_TOLERANCE_M);
        let past_end = at_end && !tasks[task].closed && offset_m.norm() > paths.threshold_m(task);
        (offset_m.norm() <= MAX_OFF_PATH_DISTANCE_M && !past_end).then_some(NearPath { task, point, offset_m })
    };
    match on {
        Some(task) => at(task),
        None => (0..paths.len()).filter_map(at).min_by(|a, b| a.offset_m.norm().total_cmp(&b.offset_m.norm())),
    }
}

impl NearSamples {
    fn add(&mut self, frame: &Frame, near: &NearPath, tasks: &[Task], clearance_m: f64) {
        self.frames += 1;
        self.stand_offs_m.extend(near.stand_off_error_m(tasks));
        self.heights_m.extend(near.height_error_m(tasks));
        self.low_clearance += usize::from(frame.clearance_m.is_some_and(|clearance| clearance < clearance_m));
        self.lamp_off += usize::from(!frame.light);
        self.pictures += usize::from(frame.snapshot);
        self.unlit_pictures += usize::from(frame.snapshot && !frame.light);
    }

    /// Adds the sticks of the frame with this index. Only consecutive frames can show a jump.
    fn add_sticks(&mut self, (index, sticks): (usize, [f64; 4]), frame_s: f64) {
        for (counter, position) in self.sticks.iter_mut().zip(sticks) {
            counter.add(position);
        }
        let before = self.latest.replace((index, sticks)).filter(|(latest, _)| latest + 1 == index);
        if let Some((_, [forward, right, up, _])) = before {
            self.jumps += [forward, right, up].into_iter().zip(sticks).filter(|&pair| is_jump(pair, frame_s)).count();
        }
    }

    fn technique(mut self, task: &Task, passed: f64, frame_s: f64) -> TaskTechnique {
        let share = |frames: usize| if self.frames > 0 { frames as f64 / self.frames as f64 } else { 0.0 };
        let near_s = self.frames as f64 * frame_s;
        let per_min = |reversals: usize| if near_s > 0.0 { 60.0 * reversals as f64 / near_s } else { 0.0 };
        let [forward, right, up, yaw] = self.sticks.map(|axis| axis.count);
        TaskTechnique {
            near_s,
            passed,
            stand_off_spread_m: spread(&mut self.stand_offs_m),
            height_spread_m: spread(&mut self.heights_m),
            height_error_m: median(self.heights_m),
            stand_off_error_m: median(self.stand_offs_m),
            rms_framing_deg: None,
            low_clearance: share(self.low_clearance),
            lamp_off: (task.dark && self.frames > 0).then(|| share(self.lamp_off)),
            stick_reversals_per_min: per_min(forward + right + up),
            yaw_reversals_per_min: per_min(yaw),
            stick_jumps_per_min: Some(per_min(self.jumps)),
            pictures: Some(self.pictures),
            unlit_pictures: (task.dark && self.pictures > 0).then(|| self.unlit_pictures as f64 / self.pictures as f64),
            contacts: Crashes::default(),
            fastest_contact_m_s: 0.0,
        }
    }
}

/// Returns half the range between the quantiles. Sorts the values.
fn spread(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    let at = |quantile: f64| values[(quantile * last as f64).round() as usize];
    Some(0.5 * (at(SPREAD_QUANTILES.1) - at(SPREAD_QUANTILES.0)))
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    let upper = *values.get(middle)?;
    Some(if values.len() % 2 == 1 { upper } else { 0.5 * (values[middle - 1] + upper) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hovering_frame;
    use spandrel_model::shipped::SCENARIOS;

    fn reversals(positions: &[f64]) -> usize {
        let mut counter = ReversalCounter::default();
        positions.iter().for_each(|position| counter.add(*position));
        counter.count
    }

    #[test]
    fn exact_reversals_need_a_movement_beyond_the_gap() {
        assert_eq!(reversals(&[0.0, 1.0, -1.0, 1.0]), 2);
        assert_eq!(reversals(&[0.0, 0.3, 0.6, 0.9]), 0, "one movement");
        assert_eq!(reversals(&[0.0, 0.1, -0.05, 0.1, 0.0]), 0, "within the gap");
        assert_eq!(reversals(&[0.0, 1.0, 0.9, 1.0, 0.85, 0.5]), 1, "a dip within the gap is no reversal");
        assert_eq!(reversals(&[]), 0);
    }

    #[test]
    fn exact_jumps_are_between_two_deflected_positions() {
        let is = |before, after| is_jump((before, after), 1.0 / 30.0);
        assert!(is(0.2, 0.31) && is(-0.3, 0.3) && is(0.9, 0.5));
        assert!(!is(0.2, 0.29), "a movement");
        assert!(!is(0.0, 0.5) && !is(0.5, 0.01), "a key pressed, and a stick let go");
        assert!(!is_jump((0.2, 0.4), 0.1), "the same speed as 0.07 in a thirtieth of a second");
    }

    #[test]
    fn exact_jumps_are_counted_between_consecutive_frames_only() {
        let jumps = |indices: [usize; 3]| {
            let mut samples = NearSamples::default();
            for (index, forward) in indices.into_iter().zip([0.2, 0.6, 0.3]) {
                samples.add_sticks((index, [forward, 0.5, 0.0, 0.9]), 1.0 / 30.0);
            }
            samples.jumps
        };
        assert_eq!(jumps([7, 8, 9]), 2);
        assert_eq!(jumps([7, 8, 300]), 1, "the drone was elsewhere in between");
    }

    /// Returns for how many frames a flight counts for the path of the straight drill: `aside` frames within 8 m of its start, then
    /// `on` frames along the path, then as many aside of its end.
    fn counted(aside: usize, on: usize) -> (usize, bool) {
        let (_, text) = SCENARIOS.iter().find(|(name, _)| *name == "drill-straight-line").unwrap();
        let scenario = spandrel_model::scenario::read("drill", text, &|file| Err(file.to_owned())).unwrap();
        let paths = ReferencePaths::new(&scenario);
        let points = paths.path(0).points_m();
        let (start, end) = (points[0], points[points.len() - 1]);
        let along = |share: f64| start + (end - start) * share;
        let inward = (end - start) * (1.0 / (end - start).norm());
        let at = |point: Vec3<Enu>, sign: f64| point + inward * sign + Vec3::new(0.0, 0.0, 7.0);
        let beside = |point, sign| std::iter::repeat_n(at(point, sign), aside);
        let flown = (0..on).map(|k| along(k as f64 / on as f64));
        let positions: Vec<Vec3<Enu>> = beside(start, 1.0).chain(flown).chain(beside(end, -1.0)).collect();
        let on_path = OnPath::measure(&paths, positions.iter().copied());
        let frames: Vec<Frame> = positions.into_iter().map(hovering_frame).collect();
        let near = near_frames(&scenario, &frames, &paths, &on_path);
        (near.iter().flatten().count(), near[0].is_some())
    }

    #[test]
    fn exact_ways_to_and_from_a_flown_path_do_not_count() {
        assert_eq!(counted(5, 20), (20, false));
        assert_eq!(counted(20, 10), (50, true), "mostly flown beside the path");
        assert_eq!(counted(20, 0), (40, true));
    }

    #[test]
    fn exact_pictures_count_by_what_the_drone_did() {
        let frame = |snapshot: bool, speed_m_s: f64, yaw: f64| Frame {
            sticks: [0.0, 0.0, 0.0, yaw],
            snapshot,
            velocity_m_s: Vec3::new(0.6 * speed_m_s, 0.0, 0.8 * speed_m_s),
            ..hovering_frame(Vec3::zero())
        };
        let pictures = [(0.1, 0.0), (0.3, 0.5), (0.45, -0.2), (0.6, 0.05)].map(|(speed_m_s, yaw)| frame(true, speed_m_s, yaw));
        let frames = [pictures.as_slice(), &[frame(false, 0.3, 1.0)]].concat();
        let shares = [is_in_motion, is_drifting, is_turning].map(|is_meant| share_of_pictures(&frames, is_meant));
        assert_eq!(shares, [Some(0.25), Some(0.5), Some(0.5)]);
        assert_eq!(share_of_pictures(&frames[4..], is_drifting), None, "no picture");
    }

    #[test]
    fn exact_spread_is_that_of_all_but_the_outermost_tenths() {
        let mut values: Vec<f64> = (0..=10).rev().map(f64::from).collect();
        assert_eq!(spread(&mut values), Some(4.0), "from 1 to 9");
        values[10] = 1000.0;
        assert_eq!(spread(&mut values), Some(4.0), "one excursion");
        assert_eq!(spread(&mut []), None);
    }

    #[test]
    fn exact_median_of_odd_and_even_counts() {
        assert_eq!(median(vec![3.0, -1.0, 2.0]), Some(2.0));
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), Some(2.5));
        assert_eq!(median(Vec::new()), None);
    }
}
