//! Sentences on how the drone was flown.

use super::flight_scan::{FlightScan, Stretches};
use super::wording::{Place, Sentence, surface, when};
use crate::record::{MAX_OFF_PATH_DISTANCE_M, TaskTechnique, clearance_limit_m};
use crate::time_text::clock;
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::numbers::format_limit;
use spandrel_monitor::measures::on_speed;
use spandrel_text::text;

/// Period in which the busiest stick movements are sought, s (estimate: long enough to notice when replayed).
const BUSY_PERIOD_S: f64 = 10.0;

/// Returns the stretches of frames with a value, and the values' mean and maximum.
fn measured(scan: &FlightScan<'_>, value: impl Fn(usize) -> Option<f64>) -> Option<(Stretches, f64, f64)> {
    let stretches = scan.stretches(|frame| value(frame).is_some())?;
    let values = (0..scan.frames().len()).filter_map(value);
    let (sum, most) = values.fold((0.0, f64::NEG_INFINITY), |(sum, most), value| (sum + value, f64::max(most, value)));
    Some((stretches, sum / stretches.frames as f64, most))
}

pub(super) fn off_path(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let (stretches, _, most_m) = measured(scan, |frame| scan.off_path_m(frame, &tasks).map(|offset| offset.norm()))?;
    let when = when(scan, Place::of(scan, ids), &stretches);
    Some((text!(scan.language, "advice-off-path", when = when, most = format!("{most_m:.1}")), stretches.longest))
}

pub(super) fn off_height(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let height_m = |frame: usize| {
        let offset_m = scan.off_path_m(frame, &tasks)?;
        let is_near = offset_m.norm() <= MAX_OFF_PATH_DISTANCE_M;
        (is_near && offset_m.up().abs() > offset_m.horizontal_norm()).then(|| offset_m.up())
    };
    let (stretches, mean_m, _) = measured(scan, height_m)?;
    let (mean, when) = (format!("{:.1}", mean_m.abs()), when(scan, Place::of(scan, ids), &stretches));
    let words = if mean_m > 0.0 {
        text!(scan.language, "advice-drifted-up", mean = mean, when = when)
    } else {
        text!(scan.language, "advice-drifted-down", mean = mean, when = when)
    };
    Some((words, stretches.longest))
}

pub(super) fn beside_path(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let away_m = |frame: usize| {
        let near = scan.near(frame, &tasks).filter(|_| scan.on_path.task[frame].is_none())?;
        Some(near.offset_m.norm())
    };
    let (stretches, mean_m, _) = measured(scan, away_m)?;
    let when = when(scan, Place::of(scan, ids), &stretches);
    Some((text!(scan.language, "advice-beside-path", mean = format!("{mean_m:.1}"), when = when), stretches.longest))
}

/// Too far from the surface (`sign` is 1) or too close to it (-1).
pub(super) fn stand_off(scan: &FlightScan<'_>, ids: &[u32], limit_m: f64, sign: f64) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let error_m = |frame: usize| {
        let error_m = scan.near(frame, &tasks)?.stand_off_error_m(&scan.evidence.scenario.tasks)?;
        (sign * error_m > limit_m).then_some(sign * error_m)
    };
    let (stretches, mean_m, _) = measured(scan, error_m)?;
    let (mean, when) = (format!("{mean_m:.1}"), when(scan, Place::of(scan, ids), &stretches));
    let surface = surface(scan, &tasks);
    let words = if sign > 0.0 {
        text!(scan.language, "advice-too-far", mean = mean, surface = surface, when = when)
    } else {
        text!(scan.language, "advice-too-close", mean = mean, surface = surface, when = when)
    };
    Some((words, stretches.longest))
}

/// Changing distance from the surface. The moment is that of the largest error.
pub(super) fn uneven_stand_off(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let error_m = |frame: usize| scan.near(frame, &tasks)?.stand_off_error_m(&scan.evidence.scenario.tasks).map(f64::abs);
    let (frame, most_m) = largest(scan, error_m)?;
    let (surface, most, at) = (surface(scan, &tasks), format!("{most_m:.1}"), clock(scan.t_s(frame)));
    Some((text!(scan.language, "advice-uneven-distance", surface = surface, most = most, at = at), frame))
}

/// Changing height. The moment is that of the largest error.
pub(super) fn uneven_height(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let error_m = |frame: usize| scan.near(frame, &tasks)?.height_error_m(&scan.evidence.scenario.tasks).map(f64::abs);
    let (frame, most_m) = largest(scan, error_m)?;
    let (most, at) = (format!("{most_m:.1}"), clock(scan.t_s(frame)));
    let Place { kind, tasks } = Place::of(scan, ids);
    Some((text!(scan.language, "advice-uneven-height", most = most, place = kind, tasks = tasks, at = at), frame))
}

/// Returns the first frame with the largest value, and the value.
fn largest(scan: &FlightScan<'_>, value: impl Fn(usize) -> Option<f64>) -> Option<(usize, f64)> {
    let values = (0..scan.frames().len()).filter_map(|frame| Some((frame, value(frame)?)));
    values.max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
}

/// Too high (`sign` is 1) or too low (-1).
pub(super) fn height(scan: &FlightScan<'_>, ids: &[u32], limit_m: f64, sign: f64) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let error_m = |frame: usize| {
        let error_m = scan.near(frame, &tasks)?.height_error_m(&scan.evidence.scenario.tasks)?;
        (sign * error_m > limit_m).then_some(sign * error_m)
    };
    let (stretches, mean_m, _) = measured(scan, error_m)?;
    let (mean, when) = (format!("{mean_m:.1}"), when(scan, Place::of(scan, ids), &stretches));
    let words = if sign > 0.0 {
        text!(scan.language, "advice-too-high", mean = mean, when = when)
    } else {
        text!(scan.language, "advice-too-low", mean = mean, when = when)
    };
    Some((words, stretches.longest))
}

pub(super) fn speeding(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let limit_m_s = scan.evidence.scenario.scoring.speed_limit_m_s;
    let windows: Vec<_> = scan.task_indices(ids).iter().map(|task| scan.on_path.windows[*task]).collect();
    let speeds: Vec<f64> = scan.frames().iter().map(Frame::speed_m_s).collect();
    let is_speeding = on_speed::speeding(&speeds, &windows, limit_m_s);
    let (stretches, _, most_m_s) = measured(scan, |frame| is_speeding[frame].then(|| speeds[frame]))?;
    let Place { kind, tasks } = Place::of(scan, ids);
    let (most, limit, when) = (format!("{most_m_s:.1}"), format!("{limit_m_s:.1}"), when(scan, Place::none(), &stretches));
    let words = text!(scan.language, "advice-speeding", most = most, place = kind, tasks = tasks, limit = limit, when = when);
    Some((words, stretches.longest))
}

pub(super) fn low_clearance(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let limit_m = tasks.iter().map(|task| clearance_limit_m(scan.evidence.scenario, *task)).fold(0.0, f64::max);
    let clearance_m = |frame: usize| {
        let near = scan.near(frame, &tasks)?;
        let limit_m = clearance_limit_m(scan.evidence.scenario, near.task);
        scan.frames()[frame].clearance_m.filter(|clearance| *clearance < limit_m)
    };
    too_close(scan, Place::of(scan, ids), limit_m, clearance_m)
}

/// Time below the minimum clearance in the whole session. The limit is that of the last task entered.
pub(super) fn exposure(scan: &FlightScan<'_>) -> Option<Sentence> {
    let (scenario, team) = (scan.evidence.scenario, &scan.evidence.scenario.ground_team);
    let mut task = None;
    let entered = |on: &Option<(usize, usize)>| {
        task = on.map(|(task, _)| task).or(task);
        task.map_or(scenario.scoring.clearance_m, |task| clearance_limit_m(scenario, task))
    };
    let limits_m: Vec<f64> = scan.on_path.task.iter().map(entered).collect();
    let clearance_m = |frame: usize| {
        let now = &scan.frames()[frame];
        let is_home = (now.position_m - team.pad_m).horizontal_norm() <= team.home_radius_m;
        now.clearance_m.filter(|clearance| *clearance < limits_m[frame] && !is_home && !now.missing)
    };
    too_close(scan, Place::none(), scenario.scoring.clearance_m, clearance_m)
}

fn too_close(scan: &FlightScan<'_>, place: Place, limit_m: f64, clearance_m: impl Fn(usize) -> Option<f64>) -> Option<Sentence> {
    let (stretches, _, most_m) = measured(scan, |frame| clearance_m(frame).map(|clearance| -clearance))?;
    let (limit, least, when) = (format_limit(limit_m), format!("{:.1}", -most_m), when(scan, place, &stretches));
    let words = text!(scan.language, "advice-low-clearance", limit = limit, when = when, least = least);
    Some((words, stretches.longest))
}

/// Returns the largest rate per minute of these tasks, as text.
fn highest_rate(scan: &FlightScan<'_>, ids: &[u32], rate: impl Fn(TaskTechnique) -> f64) -> String {
    let tasks = scan.evidence.record.tasks.iter().filter(|task| ids.contains(&task.id));
    format!("{:.0}", tasks.filter_map(|task| task.technique).map(rate).fold(0.0, f64::max))
}

/// Jumps of the sticks.
pub(super) fn jumps(scan: &FlightScan<'_>, ids: &[u32]) -> Option<Sentence> {
    let most = highest_rate(scan, ids, |technique| technique.stick_jumps_per_min.unwrap_or(0.0));
    let frame = busiest(scan, &scan.task_indices(ids), &[0, 1, 2])?;
    let (Place { kind, tasks }, at) = (Place::of(scan, ids), clock(scan.t_s(frame)));
    Some((text!(scan.language, "advice-stick-jumps", most = most, place = kind, tasks = tasks, at = at), frame))
}

/// Reversals of the sticks with the given indices.
pub(super) fn reversals(scan: &FlightScan<'_>, ids: &[u32], axes: &[usize]) -> Option<Sentence> {
    let tasks = scan.task_indices(ids);
    let of = |technique: TaskTechnique| {
        if axes == [3] { technique.yaw_reversals_per_min } else { technique.stick_reversals_per_min }
    };
    let most = highest_rate(scan, ids, of);
    let frame = busiest(scan, &tasks, axes)?;
    let (Place { kind, tasks }, at) = (Place::of(scan, ids), clock(scan.t_s(frame)));
    let words = if axes == [3] {
        text!(scan.language, "advice-yaw-reversals", most = most, place = kind, tasks = tasks, at = at)
    } else {
        text!(scan.language, "advice-stick-reversals", most = most, place = kind, tasks = tasks, at = at)
    };
    Some((words, frame))
}

/// Returns the first frame of the period with the most stick travel near the tasks' paths.
fn busiest(scan: &FlightScan<'_>, tasks: &[usize], axes: &[usize]) -> Option<usize> {
    let frames = scan.frames();
    let near: Vec<usize> = (1..frames.len()).filter(|frame| scan.near(*frame, tasks).is_some()).collect();
    let moved = |frame: usize, axis: usize| (frames[frame].sticks[axis] - frames[frame - 1].sticks[axis]).abs();
    let travels: Vec<f64> = near.iter().map(|frame| axes.iter().map(|axis| moved(*frame, *axis)).sum()).collect();
    let period = ((BUSY_PERIOD_S * scan.rate_hz()) as usize).clamp(1, travels.len().max(1));
    let sums = travels.windows(period).map(|window| window.iter().sum::<f64>());
    let best = sums.enumerate().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))?;
    near.get(best.0).copied()
}
