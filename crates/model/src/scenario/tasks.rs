//! Reads a job's tasks. Their reference paths are derived from a bridge or listed point by point.

use super::bridges::path::{PathPlace, SPACING_M, TaskKind, TaskPath};
use super::bridges::solid::{LocalPoint, Placement};
use super::bridges::task_kind::{PlaceKey, SurfaceSide};
use super::bridges::{Bridge, BridgeKind};
use super::job::{StandOff, Task};
use super::point::MAX_COORDINATE_M;
use crate::frames::{Enu, Vec3};
use crate::toml::{Reader, Section};

/// Default stand-off distance of task paths derived from a bridge, m. It leaves a margin before the too-close warning
/// at 2.5 m.
const DEFAULT_STAND_OFF_M: f64 = 4.0;
/// Minimum stand-off distance of task paths derived from a bridge, m. Below the default, the task's own too-close warning
/// must leave [`WARNING_MARGIN_M`].
const MIN_STAND_OFF_M: f64 = 2.0;
/// Minimum distance between the stand-off and the too-close warning of a task with a small stand-off, m (estimate: the
/// position error of a trained pilot).
const WARNING_MARGIN_M: f64 = 0.5;
/// Maximum on-path threshold, m. The threshold must be below 8 m, the outer limit of the off-path band.
const MAX_THRESHOLD_M: f64 = 7.999;

/// Maximum number of tasks per job (estimate; the TASBID paper has four).
pub const MAX_TASKS: usize = 64;
/// Maximum length of a path in a file, m (estimate: twice the distance flown on one battery). A longer path is likely a
/// typo.
const MAX_PATH_LENGTH_M: f64 = 20_000.0;

/// Maximum number of spans of a bridge.
const MAX_SPANS: i64 = 8;

/// Key of a free path that names the bridge in whose axes its points are.
const RELATIVE_TO: &str = "points_relative_to";

pub(super) fn read(r: &mut Reader, root: &mut Section, bridges: &[Bridge]) -> Vec<Task> {
    let mut out = Vec::new();
    let tables = r.sections(root, "tasks");
    let count = tables.len();
    // The paths of thousands of tasks would fill the memory.
    for mut s in tables.into_iter().take(MAX_TASKS) {
        let id = out.len() as u32 + 1;
        out.push(read_task(r, &mut s, id, bridges));
        r.finish(&s);
    }
    if out.is_empty() {
        r.add_problem_at(1, "tasks", "", "at least one [[tasks]]", "no tasks");
    }
    if count > MAX_TASKS {
        r.add_problem(root, "tasks", &count.to_string(), "at most 64 [[tasks]]", "too many");
    }
    out
}

fn read_task(r: &mut Reader, s: &mut Section, id: u32, bridges: &[Bridge]) -> Task {
    let name = r.text(s, "name", None);
    let kinds: Vec<(&str, TaskKind)> = TaskKind::ALL.iter().map(|kind| (kind.key(), *kind)).collect();
    let kind = r.keyword(s, "kind", &kinds, None);
    let rules = kind.rules();
    let (bridge, axes) = read_bridge_index(r, s, kind, bridges);
    let stand_off_m = r.number(s, "stand_off_m", (MIN_STAND_OFF_M, 50.0), Some(DEFAULT_STAND_OFF_M));
    let threshold_m = r.number(s, "threshold_m", (0.2, MAX_THRESHOLD_M), Some(rules.threshold_m));
    r.describe_default(s, "threshold_m", &format!("by kind: {}", TaskKind::thresholds_in_words()));
    let place = read_place(r, s, rules.place);
    let closed = r.boolean(s, "closed", false);
    let points = r.points(s, "points_m", (-MAX_COORDINATE_M, MAX_COORDINATE_M));
    let look_at = r.points(s, "look_at_m", (-MAX_COORDINATE_M, MAX_COORDINATE_M));
    let path = match bridge.filter(|index| kind != TaskKind::Free && !is_unread(&bridges[*index])) {
        Some(index) => bridges[index].task_path_at(kind, stand_off_m, &place).unwrap_or_else(|problem| {
            r.add_problem(s, "kind", "", &problem, "not available for this bridge");
            TaskPath { path_m: Vec::new(), viewing_directions: Vec::new(), closed }
        }),
        None => free_path(r, s, kind, (&points, &look_at), axes, closed),
    };
    let tolerance_m = r.number(s, "stand_off_tolerance_m", (0.2, 20.0), Some(threshold_m));
    r.describe_default(s, "stand_off_tolerance_m", "threshold_m");
    let stand_off = toward_surface(rules.surface, &path).map(|toward_surface| StandOff {
        recommended_m: stand_off_m,
        tolerance_m,
        toward_surface,
    });
    let dark = r.boolean(s, "dark", rules.is_dark);
    r.describe_default(s, "dark", &format!("true for {}", TaskKind::keys_in_words(|rules| rules.is_dark)));
    let too_close_m = r.optional_number(s, "too_close_m", (0.2, 20.0));
    if stand_off_m < DEFAULT_STAND_OFF_M && too_close_m.is_none_or(|limit| limit > stand_off_m - WARNING_MARGIN_M) {
        let allowed = format!("at least 4, or too_close_m at most {}", stand_off_m - WARNING_MARGIN_M);
        r.add_problem(s, "stand_off_m", &stand_off_m.to_string(), &allowed, "too small for the too-close warning");
    }
    Task {
        id,
        name,
        bridge,
        kind,
        threshold_m,
        closed: path.closed,
        path_m: path.path_m,
        viewing_directions: path.viewing_directions,
        inspects_surface: kind != TaskKind::Free || !look_at.is_empty(),
        stand_off,
        too_close_m,
        dark,
    }
}

/// Returns whether a bridge has an invalid type or file, so that its paths are unknown.
pub(super) fn is_unread(bridge: &Bridge) -> bool {
    matches!(&bridge.kind, BridgeKind::Model(model) if model.parts().is_empty())
}

/// Reads the span or the support of a task. Kinds of tasks without a place have no such keys.
fn read_place(r: &mut Reader, s: &mut Section, place: PlaceKey) -> PathPlace {
    let mut number = |key: &'static str, min: i64, default: &str| {
        let value = r.optional_integer(s, key, (min, MAX_SPANS));
        r.describe_default(s, key, default);
        value.and_then(|value| usize::try_from(value).ok())
    };
    match place {
        PlaceKey::Span => PathPlace { span: number("span_number", 1, "the middle span"), support: None },
        PlaceKey::Support => PathPlace { span: None, support: number("support_number", 0, "the first pier") },
        PlaceKey::None => PathPlace::default(),
    }
}

/// Reads the bridge of a task. Returns its index and its axes; `None` for a free path in the axes of the site.
fn read_bridge_index(r: &mut Reader, s: &mut Section, kind: TaskKind, bridges: &[Bridge]) -> (Option<usize>, Option<Placement>) {
    let (key, wanted) = if kind == TaskKind::Free {
        let wanted = r.text(s, RELATIVE_TO, Some(""));
        r.describe_default(s, RELATIVE_TO, "none");
        if wanted.is_empty() {
            return (None, None);
        }
        (RELATIVE_TO, wanted)
    } else {
        ("bridge", r.text(s, "bridge", None))
    };
    let found = bridges.iter().position(|b| b.name == wanted);
    if found.is_none() {
        let names = bridges.iter().map(|b| b.name.as_str()).collect::<Vec<_>>().join(", ");
        r.add_problem(s, key, &wanted, &format!("a bridge in this file: {names}"), "unknown bridge");
    }
    (found, found.map(|index| bridges[index].placement()))
}

/// Returns unit vectors from the path points toward the inspected surface and perpendicular to it; `None` if the path has
/// no single surface at the stand-off distance.
fn toward_surface(side: SurfaceSide, path: &TaskPath) -> Option<Vec<Vec3<Enu>>> {
    match side {
        SurfaceSide::InView => Some(path.viewing_directions.clone()),
        // The path is parallel to the underside of the arch or girders, which is above it. The camera also looks ahead and to the sides.
        SurfaceSide::Above => Some((0..path.path_m.len()).map(|k| above(&path.path_m, k)).collect()),
        // The camera looks up at the surface, which is vertical.
        SurfaceSide::Beside => {
            Some(path.viewing_directions.iter().map(|view| Vec3::new(view.east(), view.north(), 0.0).unit()).collect())
        }
        SurfaceSide::None => None,
    }
}

/// Returns the upward unit vector that is perpendicular to a path at point `k` and lies in the path's vertical plane.
fn above(path_m: &[Vec3<Enu>], k: usize) -> Vec3<Enu> {
    let up = Vec3::new(0.0, 0.0, 1.0);
    let along = path_m[(k + 1).min(path_m.len() - 1)] - path_m[k.saturating_sub(1)];
    let length_squared = along.norm_squared();
    let normal = if length_squared > 0.0 { up - along * (along.up() / length_squared) } else { up };
    if normal.norm() > 1e-9 { normal.unit() } else { up }
}

/// Creates a path by resampling the points in the file, which are in the given axes. The camera points along the path unless the file
/// specifies a target, or a target for each point.
fn free_path(
    r: &mut Reader,
    s: &mut Section,
    kind: TaskKind,
    (points, look_at): (&[LocalPoint], &[LocalPoint]),
    axes: Option<Placement>,
    closed: bool,
) -> TaskPath {
    let to_site = |p: &LocalPoint| axes.map_or(Vec3::new(p[0], p[1], p[2]), |axes| axes.point(*p));
    let [points, look_at] = [points, look_at].map(|list| list.iter().map(to_site).collect::<Vec<Vec3<Enu>>>());
    if points.is_empty() && kind == TaskKind::Free {
        r.add_problem(s, "points_m", "", "one or more [east, north, up]", "a free path without points");
    }
    let length_m: f64 = points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    if length_m > MAX_PATH_LENGTH_M {
        r.add_problem(s, "points_m", &format!("{length_m:.0} m long"), "at most 20000 m of path", "too long");
        return TaskPath { path_m: Vec::new(), viewing_directions: Vec::new(), closed };
    }
    let path_m = resample(&points, closed);
    let targets = targets(&points, &look_at, closed);
    let viewing_directions =
        (0..path_m.len()).map(|k| look_direction(&path_m, k, targets.get(k).or(look_at.first()).copied())).collect();
    TaskPath { path_m, viewing_directions, closed }
}

fn look_direction(path: &[Vec3<Enu>], k: usize, target: Option<Vec3<Enu>>) -> Vec3<Enu> {
    let ahead = match target {
        Some(target) => target - path[k],
        None if path.len() > 1 => path[(k + 1).min(path.len() - 1)] - path[k.min(path.len() - 2)],
        None => Vec3::zero(),
    };
    if ahead.norm() > 1e-9 { ahead.unit() } else { Vec3::new(0.0, 1.0, 0.0) }
}

/// Returns the target of each point of a resampled path; empty if the file does not list a target for each of its points.
fn targets(points: &[Vec3<Enu>], look_at: &[Vec3<Enu>], closed: bool) -> Vec<Vec3<Enu>> {
    if look_at.len() != points.len() || points.len() < 2 {
        return Vec::new();
    }
    resample_shares(points, closed)
        .into_iter()
        .map(|(k, share)| look_at[k].lerp(look_at[(k + 1) % look_at.len()], share))
        .collect()
}

/// Resamples a polyline so that its points are at most [`SPACING_M`] apart. A closed polyline does not repeat its first point.
#[must_use]
pub fn resample(points: &[Vec3<Enu>], closed: bool) -> Vec<Vec3<Enu>> {
    let n = points.len();
    resample_shares(points, closed).into_iter().map(|(k, share)| points[k].lerp(points[(k + 1) % n], share)).collect()
}

/// Returns the points of a resampled polyline, each as the number of the corner before it and the share of the way to the next corner.
fn resample_shares(points: &[Vec3<Enu>], closed: bool) -> Vec<(usize, f64)> {
    let n = points.len();
    let mut out = Vec::new();
    let pairs = if closed && n > 1 { n } else { n.saturating_sub(1) };
    for k in 0..pairs {
        let length_m = (points[(k + 1) % n] - points[k]).norm();
        let steps = (length_m / SPACING_M).ceil().max(1.0) as usize;
        out.extend((0..steps).map(|step| (k, step as f64 / steps as f64)));
    }
    if n > 0 && (!closed || n == 1) {
        out.push((n - 1, 0.0));
    }
    out
}
