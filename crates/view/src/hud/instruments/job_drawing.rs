//! Drawings of a job for its briefing: a map, and a side view of each bridge that is inspected, with the tasks' paths, their
//! order and direction.

use super::super::pane::Pane;
use super::super::style::DisplayStyle;
use super::super::{DrawItem, InspectorMarks, MapPath};
use super::area::Area;
use super::map::{self, Paths};
use super::profile;
use super::scale::DrawingScale;
use super::site_outline::{Bounds, Point, SideView, SiteOutline};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_text::{Language, text};

/// Font size of the numbers and the scale, relative to the shorter side of a drawing, and its smallest value in page units.
const FONT_RATIO: f64 = 0.06;
const MIN_FONT: f64 = 0.016;

/// A side view and what it shows.
#[derive(Debug, Clone)]
struct Side {
    /// Name of the bridge; `None` for the view of a site without bridges.
    bridge: Option<String>,
    view: SideView,
    tracks: Vec<MapPath>,
}

/// Drawings of a job: first the map, then the side views.
#[derive(Debug, Clone)]
pub struct JobDrawing {
    outline: SiteOutline,
    tracks: Vec<MapPath>,
    pad_m: Vec3<Enu>,
    inspector: Option<InspectorMarks>,
    sides: Vec<Side>,
}

impl JobDrawing {
    /// Computes the drawings of a job.
    #[must_use]
    pub fn new(scenario: &Scenario, site: &Site) -> Self {
        let outline = SiteOutline::new(scenario, site);
        let tracks = MapPath::all(scenario);
        let sides = sides(scenario, &outline, &tracks);
        let team = &scenario.ground_team;
        Self { outline, tracks, pad_m: team.pad_m, inspector: InspectorMarks::new(team, team.inspector_m), sides }
    }

    /// Returns the number of drawings.
    #[must_use]
    pub fn count(&self) -> usize {
        1 + self.sides.len()
    }

    /// Returns the caption of a drawing; `None` if there is no drawing with this index.
    #[must_use]
    pub fn caption(&self, index: usize, language: Language) -> Option<String> {
        if index == 0 {
            return Some(text!(language, "window-briefing-map"));
        }
        Some(match &self.side(index)?.bridge {
            Some(bridge) => text!(language, "window-briefing-side", bridge = bridge.as_str()),
            None => text!(language, "window-briefing-from-south"),
        })
    }

    /// Returns the natural height of a drawing relative to its width.
    pub(crate) fn height_ratio(&self, index: usize) -> f64 {
        let (low, high) = self.bounds(index);
        (high.1 - low.1).max(1.0) / (high.0 - low.0).max(1.0)
    }

    fn bounds(&self, index: usize) -> Bounds {
        self.side(index).map_or(self.outline.bounds, |side| side.view.bounds)
    }

    /// Returns the side view that a drawing shows; `None` for the map.
    fn side(&self, index: usize) -> Option<&Side> {
        self.sides.get(index.checked_sub(1)?)
    }

    /// Draws the map (index 0) or a side view into an area.
    pub(crate) fn draw(&self, index: usize, style: DisplayStyle, pane: Pane, area: Area) -> Vec<DrawItem> {
        let font = (FONT_RATIO * area.width.min(area.height)).max(MIN_FONT);
        let scale = DrawingScale::fit(self.bounds(index), area.inside(font));
        let mut items = vec![pane.panel((area.x, area.y), area.corner())];
        items.extend(match self.side(index) {
            None => self.map(style, pane, area, (&scale, font)),
            Some(side) => self.side_view(side, pane, area, (&scale, font)),
        });
        items
    }

    fn map(&self, style: DisplayStyle, pane: Pane, area: Area, (scale, font): (&DrawingScale, f64)) -> Vec<DrawItem> {
        let place = |point_m: Vec3<Enu>| map::place(scale, point_m);
        let mut items = map::ground(&self.outline, pane, area, scale);
        let mut labels = map::legend_texts(style, area, (scale, font));
        items.extend(tasks(&Paths { tracks: &self.tracks, current: None, place: &place }, pane, area, font, &mut labels));
        if let Some(marks) = &self.inspector {
            items.extend(map::inspector(marks, pane, area, (scale, font), &mut labels));
        }
        items.push(map::pad(pane, place(self.pad_m), area, font));
        items.extend(map::legend(style, pane, area, (scale, font)));
        items
    }

    fn side_view(&self, side: &Side, pane: Pane, area: Area, (scale, font): (&DrawingScale, f64)) -> Vec<DrawItem> {
        let place = |point_m: Vec3<Enu>| scale.place(side.view.view.at(point_m));
        let mut items = profile::background(&side.view, self.outline.water_level_m, pane, area, scale);
        let paths = Paths { tracks: &side.tracks, current: None, place: &place };
        items.extend(tasks(&paths, pane, area, font, &mut Vec::new()));
        items
    }
}

/// Draws the tasks' paths with their directions and numbers. Adds the places of the numbers to those that labels take.
fn tasks(paths: &Paths<'_>, pane: Pane, area: Area, font: f64, labels: &mut Vec<Point>) -> Vec<DrawItem> {
    let mut items = paths.lines(pane, font);
    items.extend(paths.directions(pane, area, font));
    items.extend(paths.numbers(pane, area, font, labels));
    items
}

/// Returns the side view of each bridge with a task, or the view from the south if there is none.
fn sides(scenario: &Scenario, outline: &SiteOutline, tracks: &[MapPath]) -> Vec<Side> {
    let of_bridge = |bridge: usize| {
        let is_here = |track: &&MapPath| outline.bridge_of(track.id) == Some(bridge);
        let tracks: Vec<MapPath> = tracks.iter().filter(is_here).cloned().collect();
        let first = tracks.first()?;
        let view = outline.side(Some(first.id))?.clone();
        Some(Side { bridge: Some(scenario.bridges[bridge].name.clone()), view, tracks })
    };
    let found: Vec<Side> = (0..scenario.bridges.len()).filter_map(of_bridge).collect();
    if !found.is_empty() {
        return found;
    }
    let from_south = outline.side(None).cloned();
    from_south.map(|view| Side { bridge: None, view, tracks: tracks.to_vec() }).into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::super::super::{HudColor, TextAlign, contrast};
    use super::*;
    use spandrel_model::{scenario, shipped};

    const PANE: Pane = Pane { width: 2.0, height: 1.0 };
    /// Rounding of positions, fraction of the picture.
    const ROUNDING: f64 = 1e-9;
    const AREA: Area = Area { x: 0.5, y: 0.25, width: 1.0, height: 0.5 };

    fn drawing(text: &str) -> JobDrawing {
        let scenario = scenario::read("job.toml", text, &|file| Err(file.to_owned())).unwrap();
        JobDrawing::new(&scenario, &Site::without_defects(&scenario))
    }

    /// Returns the numbers with this color: white for tasks, black for places of the inspector.
    fn numbers(items: &[DrawItem], shown: HudColor) -> Vec<String> {
        let number = |item: &DrawItem| match item {
            DrawItem::Text { words, side: TextAlign::Center, color, .. } if *color == shown && words.parse::<u32>().is_ok() => {
                Some(words.clone())
            }
            DrawItem::Text { .. } | DrawItem::Panel { .. } | DrawItem::Fill { .. } | DrawItem::Line { .. } => None,
        };
        items.iter().filter_map(number).collect()
    }

    #[test]
    fn exact_map_shows_all_tasks_and_each_side_view_those_of_its_bridge() {
        let drawing = drawing(shipped::TWO_BRIDGES);
        let style = DisplayStyle::default();
        let drawn: Vec<Vec<DrawItem>> = (0..drawing.count()).map(|index| drawing.draw(index, style, PANE, AREA)).collect();
        let shown: Vec<Vec<String>> = drawn.iter().map(|items| numbers(items, HudColor::White)).collect();
        assert_eq!(numbers(&drawn[0], HudColor::Black), ["1", "2", "3", "4"], "places of the inspector");
        let mut of_sides = shown[1..].concat();
        of_sides.sort();
        assert_eq!((shown[0].clone(), of_sides), (vec!["1".into(), "2".into(), "3".into(), "4".into()], shown[0].clone()));
        let captions: Vec<_> = (0..=drawing.count()).map(|index| drawing.caption(index, Language::English)).collect();
        assert!(captions[..drawing.count()].iter().all(Option::is_some) && captions[drawing.count()].is_none(), "{captions:?}");
    }

    #[test]
    fn prop_drawings_of_every_shipped_job_stay_inside_and_paths_on_the_map_have_directions() {
        for (name, text) in shipped::SCENARIOS {
            let drawing = drawing(text);
            for index in 0..drawing.count() {
                let items = drawing.draw(index, DisplayStyle::default(), PANE, AREA);
                // A place to hover, or a path that is seen end-on, has no direction. The map has a north arrow.
                let is_level = |track: &&MapPath| track.path_m.iter().any(|end| (*end - track.path_m[0]).horizontal_norm() > 0.0);
                let directed = if index == 0 { 1 + drawing.tracks.iter().filter(is_level).count() } else { 0 };
                let arrows = items
                    .iter()
                    .filter(|item| matches!(item, DrawItem::Fill { points, color: HudColor::White } if points.len() == 3));
                assert!(arrows.count() >= directed, "{name}, drawing {index}");
                for item in &items {
                    let (DrawItem::Fill { points, .. } | DrawItem::Line { points, .. }) = item else { continue };
                    let inside = |point: &super::super::super::ScreenPoint| {
                        let fits = |place: f64| (0.25 - ROUNDING..=0.75 + ROUNDING).contains(&place);
                        fits(point.x) && fits(point.y)
                    };
                    assert!(points.iter().all(inside), "{name}, drawing {index}: {item:?}");
                }
            }
        }
    }

    #[test]
    fn prop_texts_on_drawings_of_every_shipped_job_have_enough_contrast() {
        for (name, text) in shipped::SCENARIOS {
            let drawing = drawing(text);
            for index in 0..drawing.count() {
                let items = drawing.draw(index, DisplayStyle::default(), PANE, AREA);
                contrast::check(&items, PANE.width / PANE.height, &format!("{name}, drawing {index}"));
            }
        }
    }
}
