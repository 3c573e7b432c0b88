//! Perspective picture of a job's site with the tasks' paths, drawn from the collision geometry without a graphics device.

use super::map::extent;
use super::{coord, line, simplify_polyline};
use crate::report::assets::base64;
use crate::report::sketch::{SketchExposure, SketchLens, Sketcher, WIDTH_PX};
use maud::{Markup, html};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{Scenario, Task};
use spandrel_model::site::outline::ParallelView;
use spandrel_model::site::{CameraPose, Site};
use spandrel_model::time::SimTime;
use spandrel_text::{Language, text};

/// Height of the picture, px.
const HEIGHT_PX: usize = 225;
/// Focal length, px: a horizontal field of view of 50 degrees.
const FOCAL_PX: f64 = 429.0;
/// Direction of the view: angle between its horizontal part and the line across the first bridge, and tilt, deg.
const TURN_DEG: f64 = 35.0;
const TILT_DEG: f64 = 28.0;
/// Margin around the content, relative to its distance, and smallest distance of the viewer, m.
const MARGIN: f64 = 1.06;
const MIN_DISTANCE_M: f64 = 60.0;
/// Haze at the far end of the site, as a multiple of the viewer's distance (for appearance only).
const HAZE_FACTOR: f64 = 4.0;
/// Tolerance for simplifying a path, px.
const PATH_TOLERANCE_PX: f64 = 0.2;

/// Draws the picture. If it cannot be encoded, only the paths are drawn.
#[must_use]
pub fn site_picture(scenario: &Scenario, site: &Site, language: Language) -> Markup {
    let viewer = Viewer::of(scenario, site);
    let lens = SketchLens {
        height_px: HEIGHT_PX,
        focal_px: FOCAL_PX,
        max_distance_m: f64::INFINITY,
        haze_distance_m: HAZE_FACTOR * viewer.distance_m,
        // The edges of all ground triangles would hide the site.
        facet_edges: false,
    };
    let light = SketchExposure { light: 1.0, by_lamp: false };
    let picture = Sketcher::new(site, scenario, SimTime::ZERO).png_with_lens(&viewer.pose, &lens, light);
    let (x, y) = viewer.pixel(scenario.ground_team.pad_m);
    let title = text!(language, "plot-site-picture");
    html! {
        svg.map.site-picture viewBox={ "0 0 " (WIDTH_PX) " " (HEIGHT_PX) } role="img" aria-label=(title) {
            title { (title) }
            @if let Ok(png) = picture { image width=(WIDTH_PX) height=(HEIGHT_PX) href={ "data:image/png;base64," (base64(&png)) } {} }
            g.reference { @for task in &scenario.tasks { path d=(path(task, &viewer)) { title { (text!(language, "plot-reference", task = task.id)) } } } }
            g.pad transform={ "translate(" (coord(x)) " " (coord(y)) ")" } { path d="M-3 -3H3V3H-3Z" {} title { (text!(language, "plot-pad")) } }
        }
    }
}

fn path(task: &Task, viewer: &Viewer) -> String {
    let points: Vec<(f64, f64)> = task.path_m.iter().map(|point_m| viewer.pixel(*point_m)).collect();
    line(&simplify_polyline(&points, PATH_TOLERANCE_PX), task.closed)
}

/// The viewer of the picture, far enough away to see the bridges, the paths and the pad.
struct Viewer {
    pose: CameraPose,
    up: Vec3<Enu>,
    distance_m: f64,
}

impl Viewer {
    fn of(scenario: &Scenario, site: &Site) -> Self {
        let across_deg = scenario.bridges.first().map_or(0.0, |bridge| bridge.heading_deg + 90.0);
        let view = ParallelView::oblique(across_deg - TURN_DEG, TILT_DEG);
        let toward = view.toward_viewer();
        let shown = extent(scenario, site);
        let middle = |axis: Vec3<Enu>| {
            let (low, high) = math::range(shown.iter().map(|point| point.dot(axis)));
            axis * (0.5 * (low + high))
        };
        let center_m = middle(view.right) + middle(view.up) + middle(toward);
        let slopes = [WIDTH_PX, HEIGHT_PX].map(|px| 0.5 * px as f64 / FOCAL_PX);
        let needed_m = |point: &Vec3<Enu>| {
            let from = *point - center_m;
            let aside = (from.dot(view.right).abs() / slopes[0]).max(from.dot(view.up).abs() / slopes[1]);
            MARGIN * aside + from.dot(toward)
        };
        let distance_m = shown.iter().map(needed_m).fold(MIN_DISTANCE_M, f64::max);
        let position_m = center_m + toward * distance_m;
        Self {
            pose: CameraPose { position_m, forward: toward * -1.0, right: view.right, lamp_on: false },
            up: view.up,
            distance_m,
        }
    }

    /// Returns the position of a site point in the picture, px.
    fn pixel(&self, point_m: Vec3<Enu>) -> (f64, f64) {
        let to = point_m - self.pose.position_m;
        let scale = FOCAL_PX / to.dot(self.pose.forward).max(1.0);
        (0.5 * WIDTH_PX as f64 + scale * to.dot(self.pose.right), 0.5 * HEIGHT_PX as f64 - scale * to.dot(self.up))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{scenario, shipped};

    #[test]
    fn prop_every_shipped_job_fits_its_picture() {
        for (name, text) in shipped::SCENARIOS {
            let scenario = scenario::read(name, text, &|file| Err(file.to_owned())).unwrap();
            let site = Site::without_defects(&scenario);
            let viewer = Viewer::of(&scenario, &site);
            for point in extent(&scenario, &site) {
                let (x, y) = viewer.pixel(point);
                assert!((0.0..=WIDTH_PX as f64).contains(&x) && (0.0..=HEIGHT_PX as f64).contains(&y), "{name}: {x} {y}");
            }
            let text = site_picture(&scenario, &site, Language::English).into_string();
            assert!(text.contains("data:image/png;base64,"), "{name}");
            assert_eq!(text.matches("reference path").count(), scenario.tasks.len(), "{name}");
        }
    }
}
