//! Suspension bridge: towers on piers in the water, main cables, hangers, stiffening girders, deck, railings, anchorages.

use super::dimensions::{Inconsistency, InconsistencyList, bridge_dimensions};
use super::path::{LocalPath, PathPlace, TaskKind, rectangle_loop};
use super::quantity::{Amounts, ElementQuantity};
use super::railing::add_railing;
use super::shape::BridgeShape;
use super::solid::{BeamDirection, Footing, MemberBuilder, PlateThickness};
use crate::elements::Element;

/// Half the width of the girders, which are centered on the deck edges, m (estimate).
const GIRDER_HALF_WIDTH_M: f64 = 0.2;
/// Plate thicknesses of the welded stiffening girders (estimate).
const GIRDER_PLATES: PlateThickness = PlateThickness { flange_m: 0.04, web_m: 0.016 };
/// Plate thicknesses of the floorbeams (estimate).
const FLOORBEAM_PLATES: PlateThickness = PlateThickness { flange_m: 0.025, web_m: 0.012 };
/// Plate thicknesses of the stringers, which are rolled W21 shapes (estimate).
const STRINGER_PLATES: PlateThickness = PlateThickness { flange_m: 0.02, web_m: 0.012 };
/// Gap between girder and tower leg, m (estimate).
const TOWER_LEG_GAP_M: f64 = 0.02;
/// Height of the bearings below the girders, m (estimate).
const BEARING_HEIGHT_M: f64 = 0.2;
/// Depth of the towers' portal struts, m (estimate).
const PORTAL_DEPTH_M: f64 = 1.2;
/// Depth of the anchorages below the deck, m (estimate).
const ANCHORAGE_DEPTH_M: f64 = 12.0;
/// Length of the cables inside the anchorage blocks, m (estimate). The blocks are twice as long.
const CABLE_EMBEDMENT_LENGTH_M: f64 = 1.0;
/// Height of the saddle between cable and tower leg, m (estimate).
const SADDLE_HEIGHT_M: f64 = 0.1;

bridge_dimensions! {
    /// Dimensions of a suspension bridge. Bridge axes: x along the deck, y left, z up, origin on the deck at midspan.
    Suspension "suspension" {
        main_span_m 60.0 to 1400.0, 140.0, "Distance between the towers, m; Deer Isle 329 m, Golden Gate 1280 m.";
        side_span_m 20.0 to 400.0, 45.0, "Distance from a tower to its anchorage, m (estimate).";
        sag_m 5.0 to 160.0, 14.0, "Cable sag, m; span/9 to span/11 (estimate).";
        cable_clearance_m 0.5 to 10.0, 2.0, "Height of the cable above the deck at midspan, m (estimate).";
        cable_radius_m 0.05 to 0.6, 0.15, "Corner radius of the main cables, m; 0.12 to 0.25 m for spans of about 330 m (estimate).";
        hanger_spacing_m 3.0 to 20.0, 7.0, "Distance between hangers, m; Deer Isle 9 to 12 m (estimate).";
        hanger_radius_m 0.01 to 0.1, 0.03, "Corner radius of the hangers, m; pairs of 50 to 65 mm (estimate).";
        deck_width_m 5.0 to 40.0, 8.4, "Deck width, m; Deer Isle 7.2 m.";
        slab_m 0.15 to 0.5, 0.2, "Slab thickness, m; 8 to 10 in (estimate).";
        girder_depth_m 0.8 to 8.0, 2.0, "Depth of the stiffening girders, m; Deer Isle about 2 m.";
        floorbeam_depth_m 0.4 to 3.0, 0.9, "Floorbeam depth, m (estimate).";
        leg_x_m 1.0 to 16.0, 2.4, "Length of a tower leg along the bridge, m; 2 to 4 m on small bridges (estimate).";
        leg_y_m 1.0 to 16.0, 1.8, "Width of a tower leg across the bridge, m (estimate).";
        pier_x_m 2.0 to 20.0, 4.0, "Length of a pier along the bridge, m; 4 x 8 to 10 x 18 m (estimate).";
        pier_y_m 4.0 to 60.0, 13.0, "Width of a pier across the bridge, m (estimate).";
        pier_top_m 4.0 to 70.0, 9.0, "Depth of the pier tops below the deck, m; 4 to 8 m above the water (estimate).";
        pier_height_m 4.0 to 60.0, 16.0, "Height of the piers, which extend into the lake bed, m (estimate).";
        anchorage_m 3.0 to 40.0, 8.0, "Length of an anchorage, m (estimate).";
        railing_m 0.6 to 2.0, 1.0, "Railing height, m; 32 to 42 in (estimate).";
    }
}

impl BridgeShape for Suspension {
    fn type_in_words(&self) -> &'static str {
        "a suspension bridge"
    }

    fn task_kinds(&self) -> &'static [TaskKind] {
        &[TaskKind::PierCircle]
    }

    // If there are none, the towers rest on their piers and clear the girders, and all members are connected.
    fn inconsistencies(&self) -> Vec<Inconsistency> {
        let legs_m = 2.0 * self.cable_y_m() + self.leg_y_m;
        let portal_m = BEARING_HEIGHT_M + PORTAL_DEPTH_M - self.girder_bottom_z_m();
        let mut m = InconsistencyList::default();
        m.require_at_least("sag_m", self.sag_m, self.main_span_m / 20.0, "not too flat for main_span_m");
        m.require_at_most("sag_m", self.sag_m, self.main_span_m / 4.0, "not too steep for main_span_m");
        m.require_at_least(
            "cable_clearance_m",
            self.cable_clearance_m,
            self.cable_radius_m,
            "clear of the deck (cable_radius_m)",
        );
        m.require_at_least("leg_y_m", self.leg_y_m, 2.0 * self.cable_radius_m, "no narrower than the cable (cable_radius_m)");
        m.require_at_most("leg_x_m", self.leg_x_m, self.pier_x_m, "no wider than the pier (pier_x_m)");
        m.require_at_least("pier_y_m", self.pier_y_m, legs_m, "wide enough for both tower legs (deck_width_m, leg_y_m)");
        m.require_at_least("pier_top_m", self.pier_top_m, portal_m, "below the girders and the portal (slab_m, girder_depth_m)");
        m.require_at_least("girder_depth_m", self.girder_depth_m, self.floorbeam_depth_m, "no shallower than the floorbeams");
        m.0
    }

    fn build(&self, b: &mut MemberBuilder) {
        self.towers(b);
        self.cables(b);
        self.floor(b);
        add_railing(b, self.deck_length_m(), 0.5 * self.deck_width_m, self.railing_m, Element::MetalRailing);
        self.anchorages(b);
    }

    fn deck_length_m(&self) -> f64 {
        self.main_span_m + 2.0 * (self.side_span_m + self.anchorage_m)
    }

    fn deck_width_m(&self) -> f64 {
        self.deck_width_m
    }

    fn fascia_z_m(&self) -> (f64, f64) {
        (self.girder_bottom_z_m(), 0.0)
    }

    fn opening_half_length_m(&self) -> f64 {
        0.5 * self.deck_length_m() - self.anchorage_m
    }

    fn underside_depth_m(&self) -> Option<f64> {
        Some(self.slab_m + self.girder_depth_m)
    }

    fn footings(&self) -> Vec<Footing> {
        let (px, py) = (0.5 * self.pier_x_m, 0.5 * self.pier_y_m);
        let (inner, outer) = (self.anchor_x_m(), self.anchor_x_m() + self.anchorage_m);
        let half = 0.5 * self.main_span_m;
        let anchor_up_m = -ANCHORAGE_DEPTH_M.max(3.0 - self.girder_bottom_z_m());
        let at = |low: f64, high: f64, y: f64, up_m: f64| Footing { x_m: (low, high), y_m: (-y, y), up_m };
        let pier_up_m = -self.pier_top_m - self.pier_height_m;
        vec![
            at(-half - px, px - half, py, pier_up_m),
            at(half - px, half + px, py, pier_up_m),
            at(-outer, -inner, self.anchorage_half_width_m(), anchor_up_m),
            at(inner, outer, self.anchorage_half_width_m(), anchor_up_m),
        ]
    }

    fn quantities(&self) -> Vec<ElementQuantity> {
        let length_m = self.deck_length_m();
        let floorbeams_m: f64 = self.floorbeams().into_iter().map(|x| 2.0 * self.floorbeam_half_length_m(x)).sum();
        [
            (Element::RcDeck, length_m * self.deck_width_m),
            (Element::SteelGirder, 2.0 * length_m),
            (Element::SteelStringer, 2.0 * length_m),
            (Element::MainCable, 4.0 * self.anchor_x_m()),
            (Element::Hanger, 2.0 * self.hangers().len() as f64),
            (Element::SteelFloorBeam, floorbeams_m),
            (Element::SteelTower, 2.0 * (self.leg_top_z_m() + self.pier_top_m)),
            (Element::RcPierWall, 2.0 * self.pier_y_m),
            (Element::RcFooting, 4.0 * self.anchorage_half_width_m()),
            (Element::MovableBearing, 10.0),
            (Element::FixedBearing, 2.0),
            (Element::MetalRailing, 2.0 * length_m),
        ]
        .into_iter()
        .collect::<Amounts>()
        .list()
    }

    fn task_path(&self, kind: TaskKind, stand_off_m: f64, _: &PathPlace) -> Result<LocalPath, String> {
        match kind {
            TaskKind::PierCircle => pier_circle(self, stand_off_m),
            TaskKind::SlabSide
            | TaskKind::ArchBottom
            | TaskKind::Interlayer
            | TaskKind::GirderSoffit
            | TaskKind::BearingLine
            | TaskKind::PierCap
            | TaskKind::TrussPanel
            | TaskKind::FloorSystem
            | TaskKind::BarrelSoffit
            | TaskKind::ArchRing
            | TaskKind::StayCable
            | TaskKind::Free => Err(self.supported_kinds()),
        }
    }
}

impl Suspension {
    /// Returns the height of the cable at x, in meters. The cable is a parabola in the main span and straight in the
    /// side spans.
    #[must_use]
    pub fn cable_z_m(&self, x: f64) -> f64 {
        let half = 0.5 * self.main_span_m;
        let top = self.cable_clearance_m + self.sag_m;
        if x.abs() <= half {
            let u = x / half;
            self.cable_clearance_m + self.sag_m * u * u
        } else {
            top * (1.0 - (x.abs() - half) / self.side_span_m)
        }
    }

    /// Returns the lateral distance of cables, hangers and tower legs from the deck's centerline, in meters. It keeps
    /// the legs clear of the girders.
    #[must_use]
    pub fn cable_y_m(&self) -> f64 {
        0.5 * self.deck_width_m + GIRDER_HALF_WIDTH_M + TOWER_LEG_GAP_M + 0.5 * self.leg_y_m
    }

    /// Returns the height of the girders' underside in meters.
    #[must_use]
    pub fn girder_bottom_z_m(&self) -> f64 {
        -self.slab_m - self.girder_depth_m
    }

    /// Returns the distance, in meters, from midspan to the point where the cables enter the anchorages.
    #[must_use]
    pub fn anchor_x_m(&self) -> f64 {
        0.5 * self.main_span_m + self.side_span_m
    }

    /// Returns the positions of the floorbeams: one at every hanger, and at about the same spacing in the side spans, which have
    /// no hangers.
    #[must_use]
    pub fn floorbeams(&self) -> Vec<f64> {
        let n = (self.side_span_m / self.hanger_spacing_m).round().max(1.0) as i32;
        let step = |k: i32| self.side_span_m * f64::from(k) / f64::from(n);
        let half = 0.5 * self.main_span_m;
        let mut out: Vec<f64> = (1..n).rev().map(|k| -half - step(k)).collect();
        out.extend(self.hangers());
        out.extend((1..n).map(|k| half + step(k)));
        out
    }

    /// Returns the positions where deck panels end: the ends of the deck, the anchorages, the towers and the
    /// floorbeams.
    #[must_use]
    pub fn panel_ends(&self) -> Vec<f64> {
        let half = 0.5 * self.main_span_m;
        let ends = [0.5 * self.deck_length_m(), self.anchor_x_m(), half];
        let mut out = self.floorbeams();
        out.extend(ends.iter().flat_map(|x| [-x, *x]));
        out.sort_by(f64::total_cmp);
        out
    }

    /// Returns the positions of the hangers, which are evenly spaced in the main span. There are none at the towers.
    #[must_use]
    pub fn hangers(&self) -> Vec<f64> {
        let n = (self.main_span_m / self.hanger_spacing_m).round() as i32;
        (1..n).map(|k| self.main_span_m * (f64::from(k) / f64::from(n) - 0.5)).collect()
    }

    /// Returns the height of the tower leg tops, which are below the cables on both sides of the saddle, in meters.
    fn leg_top_z_m(&self) -> f64 {
        self.saddle_edge_z_m() - self.cable_radius_m - SADDLE_HEIGHT_M
    }

    /// Returns the height where the cable leaves the saddle, at the faces of the tower legs, in meters.
    fn saddle_edge_z_m(&self) -> f64 {
        let (half, reach) = (0.5 * self.main_span_m, 0.5 * self.leg_x_m);
        self.cable_z_m(half - reach).min(self.cable_z_m(half + reach))
    }

    fn towers(&self, b: &mut MemberBuilder) {
        let top = self.leg_top_z_m();
        for (name, x) in [("start", -0.5 * self.main_span_m), ("end", 0.5 * self.main_span_m)] {
            let (px, py) = (0.5 * self.pier_x_m, 0.5 * self.pier_y_m);
            let foot = -self.pier_top_m;
            b.add_box(&format!("pier-{name}"), Element::RcPierWall, [x - px, -py, foot - self.pier_height_m], [x + px, py, foot]);
            let (lx, ly) = (0.5 * self.leg_x_m, 0.5 * self.leg_y_m);
            for (side, y) in [("left", self.cable_y_m()), ("right", -self.cable_y_m())] {
                b.add_box(&format!("tower-{name}/{side}"), Element::SteelTower, [x - lx, y - ly, foot], [x + lx, y + ly, top]);
                self.saddle(b, &format!("tower-{name}/saddle-{side}"), x, y);
                // Fixed bearings at one tower, movable bearings at the other.
                let element = if x < 0.0 { Element::FixedBearing } else { Element::MovableBearing };
                self.bearing(b, &format!("bearing-{name}/{side}"), element, x, y.signum());
            }
            let inner = self.cable_y_m() - ly;
            for (part, z) in [("portal-top", top), ("portal-deck", self.girder_bottom_z_m() - BEARING_HEIGHT_M)] {
                b.add_box(
                    &format!("tower-{name}/{part}"),
                    Element::SteelTower,
                    [x - 0.6, -inner, z - PORTAL_DEPTH_M],
                    [x + 0.6, inner, z],
                );
            }
        }
    }

    /// Adds a saddle, which fills the space between a tower leg and the axis of the cable.
    fn saddle(&self, b: &mut MemberBuilder, name: &str, x: f64, y: f64) {
        let (reach, half) = (0.5 * self.leg_x_m, self.cable_radius_m + SADDLE_HEIGHT_M);
        let (low, edge, crown) = (self.leg_top_z_m(), self.saddle_edge_z_m(), self.cable_z_m(0.5 * self.main_span_m));
        let profile = [[x - reach, low], [x + reach, low], [x + reach, edge], [x, crown], [x - reach, edge]];
        b.add_extrusion(name, Element::SteelTower, &profile, y - half, y + half);
    }

    /// Adds a bearing between a girder and its support.
    fn bearing(&self, b: &mut MemberBuilder, name: &str, element: Element, x: f64, side: f64) {
        let y = side * 0.5 * self.deck_width_m;
        let z = self.girder_bottom_z_m();
        b.add_box(name, element, [x - 0.3, y - 0.15, z - BEARING_HEIGHT_M], [x + 0.3, y + 0.15, z]);
    }

    fn cables(&self, b: &mut MemberBuilder) {
        let half = 0.5 * self.main_span_m;
        let grip = self.anchor_x_m() + CABLE_EMBEDMENT_LENGTH_M;
        let mut xs = vec![-grip, -half];
        xs.extend(self.hangers());
        xs.extend([half, grip]);
        for (side, y) in [("left", self.cable_y_m()), ("right", -self.cable_y_m())] {
            let points: Vec<[f64; 3]> = xs.iter().map(|x| [*x, y, self.cable_z_m(*x)]).collect();
            b.add_cable(&format!("cable-{side}"), Element::MainCable, &points, self.cable_radius_m, 8);
            for (k, x) in self.hangers().into_iter().enumerate() {
                let foot = [x, y, -self.slab_m];
                b.add_rod(
                    &format!("hanger-{side}/{k:03}"),
                    Element::Hanger,
                    foot,
                    [x, y, self.cable_z_m(x)],
                    self.hanger_radius_m,
                    6,
                );
            }
        }
    }

    fn floor(&self, b: &mut MemberBuilder) {
        let half_width = 0.5 * self.deck_width_m;
        let soffit = -self.slab_m;
        for (k, pair) in self.panel_ends().windows(2).enumerate() {
            b.add_box(&format!("slab/{k:02}"), Element::RcDeck, [pair[0], -half_width, soffit], [pair[1], half_width, 0.0]);
            for (side, y) in [("left", half_width - GIRDER_HALF_WIDTH_M), ("right", -half_width - GIRDER_HALF_WIDTH_M)] {
                let name = format!("girder-{side}/{k:02}");
                let corners = ([pair[0], y, self.girder_bottom_z_m()], [pair[1], y + 2.0 * GIRDER_HALF_WIDTH_M, soffit]);
                b.add_steel_beam(&name, Element::SteelGirder, corners, BeamDirection::Along, GIRDER_PLATES);
            }
            for (line, y) in [(0, -0.25), (1, 0.25)] {
                let y = y * self.deck_width_m;
                let name = format!("stringer-{line}/{k:02}");
                let corners = ([pair[0], y - 0.12, soffit - 0.5], [pair[1], y + 0.12, soffit]);
                b.add_steel_beam(&name, Element::SteelStringer, corners, BeamDirection::Along, STRINGER_PLATES);
            }
        }
        for (k, x) in self.floorbeams().into_iter().enumerate() {
            let reach = self.floorbeam_half_length_m(x);
            let name = format!("floorbeam/{k:02}");
            let corners = ([x - 0.15, -reach, soffit - self.floorbeam_depth_m], [x + 0.15, reach, soffit]);
            b.add_steel_beam(&name, Element::SteelFloorBeam, corners, BeamDirection::Across, FLOORBEAM_PLATES);
        }
    }

    /// Returns half the length of the floorbeam at x in meters. In the main span, the floorbeams extend to the hangers, which support
    /// them.
    fn floorbeam_half_length_m(&self, x: f64) -> f64 {
        if x.abs() < 0.5 * self.main_span_m { self.cable_y_m() + 0.15 } else { 0.5 * self.deck_width_m }
    }

    /// Returns half the width of an anchorage in meters.
    fn anchorage_half_width_m(&self) -> f64 {
        self.cable_y_m() + self.cable_radius_m + 0.45
    }

    fn anchorages(&self, b: &mut MemberBuilder) {
        let near = (self.cable_y_m() - self.cable_radius_m - 0.45).max(0.5 * self.deck_width_m + GIRDER_HALF_WIDTH_M);
        let top = self.girder_bottom_z_m() - BEARING_HEIGHT_M;
        for (name, foot) in ["start", "end"].into_iter().zip(&self.footings()[2..]) {
            let (low, high, far) = (foot.x_m.0, foot.x_m.1, foot.y_m.1);
            b.add_box(&format!("anchorage-{name}"), Element::RcFooting, [low, -far, foot.up_m], [high, far, top]);
            // On each side of the deck, the cable enters a block. The girders end on movable bearings.
            for (side, low_y, high_y) in [("left", near, far), ("right", -far, -near)] {
                let grip = if low < 0.0 { high - 2.0 * CABLE_EMBEDMENT_LENGTH_M } else { low };
                let block = format!("anchorage-{name}/{side}");
                b.add_box(
                    &block,
                    Element::RcFooting,
                    [grip, low_y, top],
                    [grip + 2.0 * CABLE_EMBEDMENT_LENGTH_M, high_y, self.cable_radius_m + 0.45],
                );
                for (end, x) in [("low", low + 0.5), ("high", high - 0.5)] {
                    self.bearing(b, &format!("bearing-{name}/{side}-{end}"), Element::MovableBearing, x, low_y.signum());
                }
            }
        }
    }
}

/// Returns the path of task 4: one loop around the start pier at the stand-off distance from its faces, rounded at the corners
/// and facing the pier. It is 2 m below the top of the pier, or lower if the stand-off from the girders requires it.
fn pier_circle(suspension: &Suspension, stand_off_m: f64) -> Result<LocalPath, String> {
    let center_x = -0.5 * suspension.main_span_m;
    let (hx, hy) = (0.5 * suspension.pier_x_m, 0.5 * suspension.pier_y_m);
    let z = (-suspension.pier_top_m - 2.0).min(suspension.girder_bottom_z_m() - stand_off_m);
    if z < -suspension.pier_top_m - suspension.pier_height_m {
        return Err("a pier that extends to stand_off_m below the girders".into());
    }
    let (points, normals) = rectangle_loop((center_x, z), (hx, hy), stand_off_m);
    let viewing_directions = normals.into_iter().map(|[nx, ny]| [-nx, -ny, 0.0]).collect();
    Ok(LocalPath { points, viewing_directions, closed: true })
}
