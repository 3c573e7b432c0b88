//! Causes of a session's scores, computed for each task from the session's frames.

use super::crashes::Crashes;
use super::source::RecordSource;
use super::task_record::{DefectRecord, TaskRecord};
use super::technique::{self, MAX_OFF_PATH_DISTANCE_M, SessionTechnique, TaskTechnique};
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::defect_codes::defect_name;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::PlacedDefect;
use spandrel_monitor::assessment::SnapshotCounts;
use spandrel_monitor::measures::crash::{self, Crash};
use spandrel_monitor::measures::image_quality::angle_rad;
use spandrel_monitor::measures::on_path::{OnPath, ReferencePaths, TaskWindow};
use spandrel_monitor::measures::on_speed;

/// Angle to the viewing direction beyond which a defect faces away from the path, rad: the limit for pictures (60 degrees).
const MAX_FACING_ANGLE_RAD: f64 = std::f64::consts::FRAC_PI_3;

/// The parts of a session record computed from frames.
pub struct ScoreCauses {
    /// Tasks in scenario order.
    pub tasks: Vec<TaskRecord>,
    /// Crashes outside all task windows.
    pub crashes_outside: Crashes,
    /// Technique outside the tasks.
    pub technique: SessionTechnique,
    /// Defects in placement order.
    pub defects: Vec<DefectRecord>,
}

struct FlownSession<'a> {
    frames: &'a [Frame],
    paths: ReferencePaths,
    on_path: OnPath,
    crashes: Vec<Crash>,
    speeding: Vec<bool>,
    frame_s: f64,
}

/// Computes the causes of a session's scores.
pub fn causes(source: &RecordSource<'_>) -> ScoreCauses {
    let (scenario, frames) = (source.scenario, &source.assessed_session.frames);
    let paths = ReferencePaths::new(scenario);
    let on_path = OnPath::measure(&paths, frames.iter().map(|frame| frame.position_m));
    let speeds: Vec<f64> = frames.iter().map(Frame::speed_m_s).collect();
    let flown = FlownSession {
        frames,
        crashes: crash::crashes(frames, &on_path),
        speeding: on_speed::speeding(&speeds, &on_path.windows, scenario.scoring.speed_limit_m_s),
        frame_s: 1.0 / scenario.scoring.frame_rate_hz,
        paths,
        on_path,
    };
    let defects = defects(source, &flown.paths);
    let techniques = technique::tasks(source, &flown.paths, &flown.on_path);
    let task = |(task, technique)| task_causes(source, &flown, (task, technique), &defects);
    ScoreCauses {
        tasks: techniques.into_iter().enumerate().map(task).collect(),
        crashes_outside: crashes(&flown, None),
        technique: technique::session(source),
        defects,
    }
}

fn task_causes(
    source: &RecordSource<'_>,
    flown: &FlownSession<'_>,
    (task, technique): (usize, TaskTechnique),
    defects: &[DefectRecord],
) -> TaskRecord {
    let (described, result) = (&source.scenario.tasks[task], &source.assessed_session.assessment.tasks[task]);
    let window = flown.on_path.windows[task];
    let range = window.map_or(0..0, |window| window.first..window.last + 1);
    let speeding = flown.speeding[range.clone()].iter().filter(|speeding| **speeding).count();
    let off = window.map(|window| off_path(flown, task, window)).unwrap_or_default();
    let mean = |pick: fn(&(f64, f64)) -> f64| (!off.is_empty()).then(|| off.iter().map(pick).sum::<f64>() / off.len() as f64);
    let own = || defects.iter().filter(|defect| defect.task == Some(described.id));
    TaskRecord {
        id: described.id,
        name: described.name.clone(),
        kind: described.kind.key().to_owned(),
        attempted: result.attempted,
        state: Some(result.state),
        covered: Some(result.covered),
        seconds: window.map_or(0, |window| window.frames()) as f64 * flown.frame_s,
        on_path: result.on_path,
        speeding: result.speeding,
        speeding_s: speeding as f64 * flown.frame_s,
        fastest_m_s: flown.frames[range].iter().map(Frame::speed_m_s).fold(0.0, f64::max),
        off_path_s: off.len() as f64 * flown.frame_s,
        off_sideways_m: mean(|(sideways, _)| *sideways),
        off_height_m: mean(|(_, height)| *height),
        crashes: crashes(flown, Some(task)),
        defects_placed: own().count(),
        defects_found: own().filter(|defect| defect.found).count(),
        technique: Some(technique),
    }
}

/// Returns the horizontal and vertical distances from the task's path in meters, for each frame in the window that is
/// on no path but within 8 m of this one.
fn off_path(flown: &FlownSession<'_>, task: usize, window: TaskWindow) -> Vec<(f64, f64)> {
    let frames = (window.first..=window.last).filter(|k| flown.on_path.task[*k].is_none());
    let offset = |k: usize| {
        let position_m = flown.frames[k].position_m;
        flown.paths.path(task).closest_position(position_m).map(|foot_m| position_m - foot_m)
    };
    let near = frames.filter_map(offset).filter(|offset| offset.norm() <= MAX_OFF_PATH_DISTANCE_M);
    near.map(|offset: Vec3<Enu>| (offset.horizontal_norm(), offset.up().abs())).collect()
}

fn crashes(flown: &FlownSession<'_>, task: Option<usize>) -> Crashes {
    let mut counts = Crashes::default();
    for crash in flown.crashes.iter().filter(|crash| crash.task == task) {
        counts.add(crash.with);
    }
    counts
}

fn defects(source: &RecordSource<'_>, paths: &ReferencePaths) -> Vec<DefectRecord> {
    let pictures = &source.assessed_session.assessment.snapshots;
    source.placed.iter().map(|defect| defect_causes(source, paths, defect, pictures)).collect()
}

fn defect_causes(
    source: &RecordSource<'_>,
    paths: &ReferencePaths,
    defect: &PlacedDefect,
    pictures: &SnapshotCounts,
) -> DefectRecord {
    let found = pictures.each.iter().any(|picture| picture.found.contains(&defect.id));
    let views = pictures.each.iter().flat_map(|picture| &picture.views).filter(|view| view.defect == defect.id && !view.shown);
    let best = views.min_by_key(|view| view.fails.len());
    let nearest = nearest_task(paths, defect.position_m);
    let graded = graded(source, defect.id);
    DefectRecord {
        id: defect.id,
        kind: defect.kind,
        kind_name: defect_name(defect.kind).to_owned(),
        element: defect.element,
        condition_state: defect.condition_state,
        task: nearest.map(|task| source.scenario.tasks[task].id),
        found,
        lacked: best.filter(|_| !found).map(|view| view.fails.clone()).unwrap_or_default(),
        in_view_s: None,
        line: defect.line,
        hidden: nearest.is_some_and(|task| is_hidden(source, paths, task, defect)),
        shortfalls: graded.filter(|_| found).unwrap_or_default(),
    }
}

/// Returns whether a defect faces away from the viewing direction at the nearest point of its task's path.
fn is_hidden(source: &RecordSource<'_>, paths: &ReferencePaths, task: usize, defect: &PlacedDefect) -> bool {
    let task_spec = &source.scenario.tasks[task];
    let nearest = paths.path(task).nearest_exact(defect.position_m);
    let view = nearest.and_then(|nearest| task_spec.viewing_directions.get(nearest.point)).filter(|_| task_spec.inspects_surface);
    view.is_some_and(|view| angle_rad(*view, defect.normal * -1.0) > MAX_FACING_ANGLE_RAD)
}

/// Returns why no picture of a defect has sufficient quality for the certification, without duplicates; `None` if one
/// has, or if the camera can't reach that quality.
fn graded(source: &RecordSource<'_>, id: u32) -> Option<Vec<String>> {
    let accuracy = &source.assessed_session.assessment.certification.accuracy;
    let grade = accuracy.defects.iter().find(|grade| grade.defect == id)?;
    if !grade.gradable || grade.found_in_frame.is_some() {
        return None;
    }
    let prefix = format!("defect {id}: ");
    let mut reasons: Vec<String> = Vec::new();
    for reason in accuracy.pictures.iter().flat_map(|picture| &picture.fails).filter_map(|text| text.strip_prefix(&prefix)) {
        if !reasons.iter().any(|known| known == reason) {
            reasons.push(reason.to_owned());
        }
    }
    Some(reasons)
}

fn nearest_task(paths: &ReferencePaths, position_m: Vec3<Enu>) -> Option<usize> {
    let distance = |task: &usize| paths.path(*task).nearest_exact(position_m).map_or(f64::INFINITY, |nearest| nearest.distance_m);
    (0..paths.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))
}
