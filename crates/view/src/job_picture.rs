//! Small picture of a job's site for the start page: an oblique parallel view with the bridges, the tasks' paths and the landing
//! pad. It needs neither a graphics device nor the light of a rendered scene, so it is ready in a fraction of a second.

use crate::ground_photo::GroundColors;
use crate::picture::Picture;
use crate::site_map::{Canvas, surface_color};
use spandrel_model::frames::Vec3;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::outline::{ParallelView, outlines};
use spandrel_model::site::{Site, Surface};
use spandrel_model::time::SimTime;

/// Size of the picture, px.
const SIZE_PX: (u32, u32) = (480, 270);
/// Width over height of the picture.
pub const ASPECT: f64 = SIZE_PX.0 as f64 / SIZE_PX.1 as f64;
/// Direction of the view: angle between its horizontal part and the line across the first bridge, and tilt, deg.
const TURN_DEG: f64 = 35.0;
const TILT_DEG: f64 = 28.0;
/// Distance of the viewer, m: farther than the edge of every site.
const VIEWER_M: f64 = 3_000.0;
/// Smallest silhouette that determines the part of the site that is shown, m.
const LEAST_M: f64 = 0.5;
/// Margin around the content, relative to its size, and smallest width of the view, m.
const MARGIN: f64 = 0.08;
const MIN_WIDTH_M: f64 = 40.0;
const SKY_COLOR: [u8; 3] = [176, 200, 222];

/// Draws the picture of a job.
#[must_use]
pub fn draw(scenario: &Scenario, site: &Site) -> Picture {
    let across_deg = scenario.bridges.first().map_or(0.0, |bridge| bridge.heading_deg + 90.0);
    let view = ParallelView::oblique(across_deg - TURN_DEG, TILT_DEG);
    let window = ViewWindow::of(scenario, site, &view);
    let mut canvas = Canvas::new(SIZE_PX);
    let ground = GroundColors::new(scenario, site);
    for y in 0..SIZE_PX.1 {
        for x in 0..SIZE_PX.0 {
            let (right_m, up_m) = window.point(f64::from(x) + 0.5, f64::from(y) + 0.5);
            canvas.set(x, y, color((scenario, site, ground.as_ref()), &view, (right_m, up_m)));
        }
    }
    for task in &scenario.tasks {
        let mut points: Vec<(f64, f64)> = task.path_m.iter().map(|point_m| window.pixel(view.at(*point_m))).collect();
        points.extend(points.first().copied().filter(|_| task.closed));
        canvas.line(&points);
    }
    canvas.pad(window.pixel(view.at(scenario.ground_team.pad_m)));
    canvas.into_picture()
}

fn color(
    (scenario, site, ground): (&Scenario, &Site, Option<&GroundColors>),
    view: &ParallelView,
    (right_m, up_m): (f64, f64),
) -> [u8; 3] {
    let from_m = view.right * right_m + view.up * up_m + view.toward_viewer() * VIEWER_M;
    let away = view.toward_viewer() * -1.0;
    let half_m = 0.5 * scenario.terrain.size_m;
    let hit = site.ray(from_m, away, 2.0 * VIEWER_M, SimTime::ZERO);
    let Some(hit) = hit else { return SKY_COLOR };
    let place_m: Vec3<_> = from_m + away * hit.distance_m;
    if place_m.east().abs() > half_m || place_m.north().abs() > half_m {
        return SKY_COLOR;
    }
    let photographed = ground.filter(|_| hit.surface == Surface::Terrain).and_then(|ground| ground.at(place_m));
    photographed.unwrap_or_else(|| surface_color(hit.surface, hit.normal, place_m.up() - scenario.terrain.water_level_m))
}

/// The part of the view that the picture shows.
struct ViewWindow {
    middle_m: (f64, f64),
    m_per_px: f64,
}

impl ViewWindow {
    /// Returns the window that shows the bridges, the paths and the pad.
    fn of(scenario: &Scenario, site: &Site, view: &ParallelView) -> Self {
        let members = outlines(site.members().iter(), view, LEAST_M).into_iter().flat_map(|outline| outline.corners);
        let paths = scenario.tasks.iter().flat_map(|task| task.path_m.iter()).map(|point_m| view.at(*point_m));
        let shown = members.chain(paths).chain([view.at(scenario.ground_team.pad_m)]);
        let infinite = (f64::INFINITY, f64::NEG_INFINITY);
        let (x, y) = shown.fold((infinite, infinite), |(x, y), point| {
            ((x.0.min(point.0), x.1.max(point.0)), (y.0.min(point.1), y.1.max(point.1)))
        });
        let wide_m = (x.1 - x.0).max(ASPECT * (y.1 - y.0)).max(MIN_WIDTH_M);
        let middle_m = (0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1));
        Self { middle_m, m_per_px: (1.0 + 2.0 * MARGIN) * wide_m / f64::from(SIZE_PX.0) }
    }

    /// Returns the point of the view at a pixel, m right and up.
    fn point(&self, x: f64, y: f64) -> (f64, f64) {
        let right = (x - 0.5 * f64::from(SIZE_PX.0)) * self.m_per_px;
        let up = (0.5 * f64::from(SIZE_PX.1) - y) * self.m_per_px;
        (self.middle_m.0 + right, self.middle_m.1 + up)
    }

    /// Returns the pixel of a point of the view, m right and up.
    fn pixel(&self, (right_m, up_m): (f64, f64)) -> (f64, f64) {
        let x = (right_m - self.middle_m.0) / self.m_per_px + 0.5 * f64::from(SIZE_PX.0);
        let y = 0.5 * f64::from(SIZE_PX.1) - (up_m - self.middle_m.1) / self.m_per_px;
        (x, y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::{scenario, shipped};

    #[test]
    fn prop_every_shipped_job_has_a_picture_of_its_own_that_shows_its_bridges() {
        let mut seen = Vec::new();
        for (name, text) in shipped::SCENARIOS {
            let scenario = scenario::read(name, text, &|file| Err(file.to_owned())).unwrap();
            let picture = draw(&scenario, &Site::without_defects(&scenario));
            assert_eq!((picture.width, picture.height), SIZE_PX);
            let pixels = || picture.rgba.chunks_exact(4);
            let sky = pixels().filter(|pixel| pixel[..3] == SKY_COLOR).count();
            assert!(sky < pixels().count() / 2, "{name}: {sky} px of sky");
            // Concrete and steel are gray; meadow, water and rock are not.
            let gray = pixels().filter(|pixel| pixel[0].abs_diff(pixel[2]) <= 8 && pixel[0] > 60).count();
            assert!(scenario.bridges.is_empty() || gray > 500, "{name}: {gray} px of bridge");
            // A job with other defects at the same place looks the same.
            let place = (scenario.bridges, scenario.tasks);
            assert!(!seen.iter().any(|(other, at)| *other == picture && *at != place), "{name} looks like another job");
            seen.push((picture, place));
        }
    }
}
