//! Outlines of the bridges and the shore for the map and the profile; computed once per flight.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::site::outline::{ParallelView, WaterStrip, ground_profile, outlines, water_strips};

/// Smallest silhouette that is drawn, m.
const LEAST_M: f64 = 0.8;
/// Margin around the content, relative to its size.
const MARGIN: f64 = 0.06;
/// Smallest size of a drawing, m.
const MIN_SIZE_M: f64 = 40.0;
/// Height above the highest part of a profile and below its lowest, m.
const HEADROOM_M: f64 = 4.0;

/// A point of a drawing, m right and up.
pub(super) type Point = (f64, f64);

/// Lower left and upper right corner of a drawing, m right and up.
pub(super) type Bounds = (Point, Point);

/// A side view.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SideView {
    pub view: ParallelView,
    /// Silhouettes of the members, farthest first.
    pub members: Vec<Vec<Point>>,
    /// The ground below the middle, from left to right.
    pub ground: Vec<Point>,
    pub bounds: Bounds,
}

/// The site as line drawings.
#[derive(Debug, Clone, PartialEq)]
pub struct SiteOutline {
    pub(super) water: Vec<WaterStrip>,
    /// Silhouettes of the members from above, lowest first.
    pub(super) members: Vec<Vec<Point>>,
    /// Area of the map.
    pub(super) bounds: Bounds,
    /// Side view of each bridge, then the view from the south, which shows all tasks.
    sides: Vec<SideView>,
    /// Bridge of each task by the task's number.
    bridges: Vec<(u32, Option<usize>)>,
    pub(super) water_level_m: f64,
}

impl SiteOutline {
    /// Returns an outline without water, bridges and tasks.
    #[must_use]
    pub fn empty() -> Self {
        let bounds = ((0.0, 0.0), (0.0, 0.0));
        Self { water: Vec::new(), members: Vec::new(), bounds, sides: Vec::new(), bridges: Vec::new(), water_level_m: 0.0 }
    }

    /// Returns an outline that has only the area of the map, around points.
    #[cfg(test)]
    pub(in super::super) fn around(points_m: impl Iterator<Item = Vec3<Enu>>) -> Self {
        let plan = ParallelView::plan();
        Self { bounds: bounds(points_m.map(|point_m| plan.at(point_m))), ..Self::empty() }
    }

    /// Computes the outlines of a job's site.
    #[must_use]
    pub fn new(scenario: &Scenario, site: &Site) -> Self {
        let plan = ParallelView::plan();
        let team = &scenario.ground_team;
        let paths = scenario.tasks.iter().flat_map(|task| task.path_m.iter().copied());
        let shown = paths.chain([team.pad_m]).chain(team.inspector_places_m().filter(|_| team.can_walk()));
        let bounds = bounds(shown.map(|point_m| plan.at(point_m)));
        let sides = (0..scenario.bridges.len()).map(|bridge| side_view(scenario, site, Some(bridge)));
        Self {
            water: water_strips(scenario, site),
            members: silhouettes(site, &plan, None),
            bounds,
            sides: sides.chain([side_view(scenario, site, None)]).collect(),
            bridges: scenario.tasks.iter().map(|task| (task.id, task.bridge)).collect(),
            water_level_m: scenario.terrain.water_level_m,
        }
    }

    /// Returns the index of a task's bridge in the scenario; `None` for a free path.
    pub(super) fn bridge_of(&self, task: u32) -> Option<usize> {
        self.bridges.iter().find(|(id, _)| *id == task).and_then(|(_, bridge)| *bridge)
    }

    /// Returns the side view of a task's bridge; without a task or a bridge, the view from the south.
    pub(super) fn side(&self, task: Option<u32>) -> Option<&SideView> {
        let bridge = task.and_then(|task| self.bridge_of(task));
        bridge.and_then(|bridge| self.sides.get(bridge)).or(self.sides.last())
    }
}

/// Returns the silhouettes of a bridge's members, or of all members. Members are named after their bridge.
fn silhouettes(site: &Site, view: &ParallelView, bridge: Option<&str>) -> Vec<Vec<Point>> {
    let is_part = |name: &str, bridge: &str| name.strip_prefix(bridge).is_some_and(|rest| rest.starts_with('/'));
    let shown = site.members().iter().filter(|member| bridge.is_none_or(|bridge| is_part(&member.name, bridge)));
    outlines(shown, view, LEAST_M).into_iter().map(|outline| outline.corners).collect()
}

fn side_view(scenario: &Scenario, site: &Site, bridge: Option<usize>) -> SideView {
    let view = bridge.map_or_else(ParallelView::from_south, |bridge| ParallelView::side(&scenario.bridges[bridge]));
    let members = silhouettes(site, &view, bridge.map(|bridge| scenario.bridges[bridge].name.as_str()));
    let tasks = scenario.tasks.iter().filter(|task| bridge.is_none_or(|_| task.bridge == bridge));
    let paths = tasks.flat_map(|task| task.path_m.iter()).map(|point_m| view.at(*point_m));
    let water = scenario.terrain.water_level_m;
    let pad = bridge.is_none().then(|| view.at(scenario.ground_team.pad_m));
    let shown = paths.chain(members.iter().flatten().copied()).chain(pad);
    let ((left, low), (right, high)) = bounds(shown);
    let through_m: Vec3<Enu> = bridge.map_or(scenario.ground_team.pad_m, |bridge| scenario.bridges[bridge].center_m);
    let ground = ground_profile(scenario, site, &view, through_m, (left, right));
    let is_wet = ground.iter().any(|(_, up_m)| *up_m < water);
    let low = if is_wet { low.min(water) } else { low };
    SideView { members, ground, bounds: ((left, low - HEADROOM_M), (right, high + HEADROOM_M)), view }
}

/// Returns the bounds of points with a margin.
fn bounds(points: impl Iterator<Item = Point>) -> Bounds {
    let (low, high) = points.fold(((f64::MAX, f64::MAX), (f64::MIN, f64::MIN)), |(low, high), p| {
        ((low.0.min(p.0), low.1.min(p.1)), (high.0.max(p.0), high.1.max(p.1)))
    });
    if low.0 > high.0 {
        return ((-MIN_SIZE_M, 0.0), (MIN_SIZE_M, MIN_SIZE_M));
    }
    let missing = |low: f64, high: f64| (0.5 * (MIN_SIZE_M - (high - low))).max(MARGIN * (high - low));
    let (x, y) = (missing(low.0, high.0), MARGIN * (high.1 - low.1));
    ((low.0 - x, low.1 - y), (high.0 + x, high.1 + y))
}
