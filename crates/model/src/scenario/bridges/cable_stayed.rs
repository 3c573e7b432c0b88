//! Cable-stayed bridge: two towers on piers, two planes of stays in a fan, edge girders, floorbeams, deck, railings, and anchor piers at the
//! ends, which hold the backstays down.

use super::beam_path;
use super::dimensions::{Inconsistency, InconsistencyList, bridge_dimensions};
use super::path::{LocalPath, PathPlace, TaskKind, equal_steps, rectangle_loop};
use super::quantity::{Amounts, ElementQuantity};
use super::railing::add_railing;
use super::shape::BridgeShape;
use super::solid::{BeamDirection, Footing, LocalPoint, MemberBuilder, PlateThickness};
use crate::elements::Element;
use crate::math;

/// Half the width of the edge girders, which are centered on the deck edges, m (estimate).
const GIRDER_HALF_WIDTH_M: f64 = 0.25;
/// Plate thicknesses of the edge girders and the floorbeams (estimate).
const GIRDER_PLATES: PlateThickness = PlateThickness { flange_m: 0.05, web_m: 0.02 };
const FLOORBEAM_PLATES: PlateThickness = PlateThickness { flange_m: 0.03, web_m: 0.014 };
/// Half the flange width of the floorbeams, and the length of the beams beyond the stays that they carry, m (estimate).
const FLOORBEAM_M: (f64, f64) = (0.2, 0.3);
/// Maximum distance between floorbeams, m (estimate).
const FLOORBEAM_SPACING_M: f64 = 5.0;
/// Gap between girder and tower leg, m (estimate: room for movement).
const LEG_GAP_M: f64 = 0.05;
/// Height of the bearings below the girders, and half of their side lengths along and across the bridge, m (estimate).
const BEARING_M: [f64; 3] = [0.25, 0.3, 0.2];
/// Depth of the towers' cross beams, and half their width along the bridge, m (estimate).
const CROSS_BEAM_M: (f64, f64) = (1.6, 0.8);
/// Height of the towers above the uppermost stays, m (estimate).
const TOWER_TOP_M: f64 = 2.0;
/// Length of the stays' guide pipes above the deck, m, and their radius relative to that of the stay (estimate).
const PIPE: (f64, f64) = (1.5, 1.5);
/// Minimum angle between the stays and the deck, degrees (estimate: flatter stays are soft).
const MIN_STAY_ANGLE_DEG: f64 = 16.0;
/// Minimum and maximum height of the towers above the deck, as a share of the main span (estimate around a fifth, as in Gimsing and
/// Georgakis, *Cable Supported Bridges*).
const TOWER_SHARE: (f64, f64) = (0.12, 0.4);
/// Minimum and maximum length of a side span, as a share of the main span (estimate: the backstays stay in tension).
const SIDE_SHARE: (f64, f64) = (0.25, 0.5);
/// Distance from the outermost bearings to the ends of the girders, and to the fronts of the abutments, m (estimate).
const END_M: (f64, f64) = (0.8, 1.5);
/// Width of the expansion joints, height of their seals and depth of the seals below the road, m (estimate).
const JOINT_M: [f64; 3] = [0.12, 0.1, 0.02];
/// Thickness of backwalls and wing walls, thickness of the approach slabs, and height of the abutments below the bearings, m (estimate).
const ABUTMENT_M: [f64; 3] = [0.5, 0.3, 6.0];
/// Minimum radius of the turn between two passes below the floor, m, and the radius as a share of the deck width (estimate).
const TURN: (f64, f64) = (2.5, 0.3);
/// Largest distance from the middle to which the camera looks at the floor, as a share of the deck width.
const VIEW_SHARE: f64 = 0.45;
/// Number of points after which the view below the floor has panned over both sides, and the share of the stand-off that it looks ahead.
const PAN: (f64, f64) = (30.0, 0.3);

bridge_dimensions! {
    /// Dimensions of a cable-stayed bridge. Bridge axes: x along the deck, y left, z up, origin on the deck at midspan.
    CableStayed "cable_stayed" {
        main_span_m 80.0 to 1100.0, 160.0, "Distance between the towers, m; Sunshine Skyway 366 m.";
        side_span_m 30.0 to 500.0, 66.0, "Distance from a tower to its anchor pier, m; 0.25 to 0.5 of the main span (estimate).";
        tower_height_m 15.0 to 350.0, 36.0, "Height of the uppermost stays above the deck, m; about a fifth of the main span (Gimsing and Georgakis, Cable Supported Bridges).";
        stays 3.0 to 30.0, 7.0, "Number of stays on each side of a tower in one plane; a whole number.";
        anchor_spacing_m 0.8 to 5.0, 1.6, "Distance between the stays' anchorages at the tower, m (estimate).";
        stay_radius_m 0.04 to 0.25, 0.09, "Corner radius of the stays with their pipes, m (estimate).";
        deck_width_m 7.0 to 40.0, 11.0, "Deck width between the planes of the stays, m (estimate).";
        slab_m 0.18 to 0.5, 0.25, "Slab thickness, m; 8 to 10 in (estimate).";
        girder_depth_m 0.8 to 5.0, 1.6, "Depth of the edge girders, m; main span/100 to main span/200 (estimate).";
        floorbeam_depth_m 0.5 to 4.0, 1.1, "Floorbeam depth, m (estimate).";
        leg_x_m 1.5 to 14.0, 3.0, "Length of a tower leg along the bridge, m (estimate).";
        leg_y_m 1.2 to 10.0, 2.0, "Width of a tower leg across the bridge, m (estimate).";
        pier_x_m 3.0 to 25.0, 6.0, "Length of a pier along the bridge, m (estimate).";
        pier_y_m 8.0 to 70.0, 20.0, "Width of a pier across the bridge, m (estimate).";
        pier_top_m 4.0 to 80.0, 10.0, "Depth of the pier tops below the deck, m (estimate).";
        pier_height_m 4.0 to 60.0, 12.0, "Height of the piers, which extend into the river bed, m (estimate).";
        approach_m 4.0 to 30.0, 8.0, "Length of the abutments behind the anchor piers, m (estimate).";
        railing_m 0.6 to 2.0, 1.07, "Railing height, m; 32 to 42 in (estimate).";
    }
}

/// A stay: its anchorages at the deck and at the tower in a plane along the bridge, position and height, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stay {
    /// Lower end, at the top of its floorbeam.
    pub deck_m: [f64; 2],
    /// Upper end, on the axis of the tower leg.
    pub tower_m: [f64; 2],
}

impl BridgeShape for CableStayed {
    fn type_in_words(&self) -> &'static str {
        "a cable-stayed bridge"
    }

    fn task_kinds(&self) -> &'static [TaskKind] {
        &[TaskKind::SlabSide, TaskKind::PierCircle, TaskKind::FloorSystem, TaskKind::StayCable]
    }

    // If there are none, the towers rest on their piers and clear the girders, and the stays are steep enough and have room at the tower.
    fn inconsistencies(&self) -> Vec<Inconsistency> {
        let mut m = InconsistencyList::default();
        let (span_m, tower_m) = (self.main_span_m, self.tower_height_m);
        m.require_integer("stays", self.stays);
        m.require_at_least("tower_height_m", tower_m, TOWER_SHARE.0 * span_m, "0.12 main_span_m (estimate)");
        m.require_at_most("tower_height_m", tower_m, TOWER_SHARE.1 * span_m, "0.4 main_span_m (estimate)");
        m.require_at_least("side_span_m", self.side_span_m, SIDE_SHARE.0 * span_m, "0.25 main_span_m (estimate)");
        m.require_at_most("side_span_m", self.side_span_m, SIDE_SHARE.1 * span_m, "0.5 main_span_m (estimate)");
        let slope = math::tan(MIN_STAY_ANGLE_DEG.to_radians());
        let stays = self.stays.round();
        let longest_m = self.side_span_m.max(stays * self.spacing_m().0);
        m.require_at_least(
            "tower_height_m",
            tower_m,
            slope * longest_m,
            "stays at least 16 degrees steep (main_span_m, side_span_m)",
        );
        let first_m = self.spacing_m().0.max(self.spacing_m().1);
        let rows_m = (tower_m - slope * first_m) / (stays - 1.0);
        m.require_at_most(
            "anchor_spacing_m",
            self.anchor_spacing_m,
            rows_m,
            "lowest stays that are steep enough (stays, tower_height_m)",
        );
        let apart_m = 4.0 * self.stay_radius_m;
        m.require_at_least("anchor_spacing_m", self.anchor_spacing_m, apart_m, "four radii of a stay (stay_radius_m)");
        let panel_m = self.spacing_m().0.min(self.spacing_m().1) - 0.5;
        m.require_at_most("leg_x_m", self.leg_x_m, panel_m, "shorter than the distance to the first stay (stays, side_span_m)");
        m.require_at_most("leg_x_m", self.leg_x_m, self.pier_x_m, "no wider than the pier (pier_x_m)");
        m.require_at_least("leg_y_m", self.leg_y_m, 2.0 * PIPE.1 * self.stay_radius_m, "wider than the stays (stay_radius_m)");
        let legs_m = 2.0 * self.stay_y_m() + self.leg_y_m;
        m.require_at_least("pier_y_m", self.pier_y_m, legs_m, "wide enough for both tower legs (deck_width_m, leg_y_m)");
        let beam_m = CROSS_BEAM_M.0 - self.seat_z_m();
        m.require_at_least(
            "pier_top_m",
            self.pier_top_m,
            beam_m,
            "below the girders and the cross beam (slab_m, girder_depth_m)",
        );
        m.require_at_least("girder_depth_m", self.girder_depth_m, self.floorbeam_depth_m, "no shallower than the floorbeams");
        m.0
    }

    fn build(&self, b: &mut MemberBuilder) {
        for (name, x) in [("start", -0.5 * self.main_span_m), ("end", 0.5 * self.main_span_m)] {
            self.add_tower(b, name, x);
        }
        self.add_stays(b);
        self.add_floor(b);
        self.add_abutment(b, "start", -1.0);
        self.add_abutment(b, "end", 1.0);
        add_railing(b, self.deck_length_m(), 0.5 * self.deck_width_m, self.railing_m, Element::MetalRailing);
    }

    fn deck_length_m(&self) -> f64 {
        2.0 * (self.backwall_back_x_m() + self.approach_m)
    }

    fn deck_width_m(&self) -> f64 {
        self.deck_width_m
    }

    fn fascia_z_m(&self) -> (f64, f64) {
        (self.girder_bottom_z_m(), 0.0)
    }

    fn opening_half_length_m(&self) -> f64 {
        self.backwall_back_x_m()
    }

    fn underside_depth_m(&self) -> Option<f64> {
        Some(-self.seat_z_m())
    }

    fn footings(&self) -> Vec<Footing> {
        let (px, py) = (0.5 * self.pier_x_m, 0.5 * self.pier_y_m);
        let half = 0.5 * self.main_span_m;
        let (front, end, y) = (self.end_x_m() - END_M.1, 0.5 * self.deck_length_m(), self.abutment_half_width_m());
        let at = |x_m: (f64, f64), half: f64, up_m: f64| Footing { x_m, y_m: (-half, half), up_m };
        let (pier_up_m, end_up_m) = (-self.pier_top_m - self.pier_height_m, self.seat_z_m() - ABUTMENT_M[2]);
        vec![
            at((-half - px, px - half), py, pier_up_m),
            at((half - px, half + px), py, pier_up_m),
            at((-end, -front), y, end_up_m),
            at((front, end), y, end_up_m),
        ]
    }

    fn quantities(&self) -> Vec<ElementQuantity> {
        let floor_m = 2.0 * self.girder_end_x_m();
        let floorbeams_m: f64 = self.floorbeams().into_iter().map(|beam| 2.0 * self.floorbeam_half_length_m(beam)).sum();
        // Main cables are measured along the road (AASHTO MBEI).
        let stays_m: f64 = self.stays().into_iter().map(|stay| (stay.deck_m[0] - stay.tower_m[0]).abs()).sum();
        [
            (Element::RcDeck, floor_m * self.deck_width_m),
            (Element::SteelGirder, 2.0 * floor_m),
            (Element::MainCable, 2.0 * stays_m),
            (Element::SteelFloorBeam, floorbeams_m),
            (Element::RcColumn, 4.0),
            (Element::RcPierWall, 2.0 * self.pier_y_m),
            (Element::RcAbutment, 4.0 * (self.abutment_half_width_m() + self.approach_m)),
            (Element::RcPierCap, 2.0 * self.cross_beam_m()),
            (Element::StripSealJoint, 2.0 * self.deck_width_m),
            (Element::MovableBearing, 6.0),
            (Element::FixedBearing, 2.0),
            (Element::RcApproachSlab, 2.0 * self.approach_m * self.deck_width_m),
            (Element::MetalRailing, 2.0 * self.deck_length_m()),
        ]
        .into_iter()
        .collect::<Amounts>()
        .list()
    }

    fn task_path(&self, kind: TaskKind, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String> {
        match kind {
            TaskKind::SlabSide => self.edge_girder(stand_off_m),
            TaskKind::PierCircle => self.pier_circle(stand_off_m),
            TaskKind::FloorSystem => self.floor_system(stand_off_m, place),
            TaskKind::StayCable => self.stay_cable(stand_off_m),
            TaskKind::ArchBottom
            | TaskKind::Interlayer
            | TaskKind::GirderSoffit
            | TaskKind::BearingLine
            | TaskKind::PierCap
            | TaskKind::TrussPanel
            | TaskKind::BarrelSoffit
            | TaskKind::ArchRing
            | TaskKind::Free => Err(self.supported_kinds()),
        }
    }
}

/// A floorbeam: its position along the bridge, m, and whether it carries stays.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Floorbeam {
    x_m: f64,
    carries_stays: bool,
}

// Dimensions that follow from others.
impl CableStayed {
    /// Returns the distances between the stays at the deck in the main span and in the side spans, in meters. In the main span, the uppermost
    /// stays of the two towers are one distance apart; in the side spans, they end above the abutments.
    fn spacing_m(&self) -> (f64, f64) {
        let stays = self.stays.round();
        (self.main_span_m / (2.0 * stays + 1.0), self.side_span_m / stays)
    }

    /// Returns the stays of one plane: those of the start tower toward the side span and toward the main span, then those of the end tower, each
    /// from the lowest to the uppermost.
    #[must_use]
    pub fn stays(&self) -> Vec<Stay> {
        let (main_m, side_m) = self.spacing_m();
        let count = self.stays.round() as i32;
        let mut out = Vec::new();
        for tower in [-1.0, 1.0] {
            for (spacing_m, toward) in [(side_m, tower), (main_m, -tower)] {
                let x = tower * 0.5 * self.main_span_m;
                out.extend((1..=count).map(|k| Stay {
                    deck_m: [x + toward * spacing_m * f64::from(k), -self.slab_m],
                    tower_m: [x, self.tower_height_m - self.anchor_spacing_m * f64::from(count - k)],
                }));
            }
        }
        out
    }

    /// Returns the distance of the stays and the tower legs from the deck's centerline in meters. It keeps the legs clear of the girders.
    #[must_use]
    pub fn stay_y_m(&self) -> f64 {
        0.5 * self.deck_width_m + GIRDER_HALF_WIDTH_M + LEG_GAP_M + 0.5 * self.leg_y_m
    }

    /// Returns the height of the girders' undersides in meters.
    #[must_use]
    pub fn girder_bottom_z_m(&self) -> f64 {
        -self.slab_m - self.girder_depth_m
    }

    /// Returns the height of the bearings' undersides in meters.
    fn seat_z_m(&self) -> f64 {
        self.girder_bottom_z_m() - BEARING_M[0]
    }

    /// Returns the distance from midspan to the outermost bearings in meters.
    fn end_x_m(&self) -> f64 {
        0.5 * self.main_span_m + self.side_span_m
    }

    /// Returns the distance from midspan to the ends of girders and deck in meters.
    fn girder_end_x_m(&self) -> f64 {
        self.end_x_m() + END_M.0
    }

    /// Returns the distance from midspan to the backs of the backwalls in meters.
    fn backwall_back_x_m(&self) -> f64 {
        self.girder_end_x_m() + JOINT_M[0] + ABUTMENT_M[0]
    }

    fn abutment_half_width_m(&self) -> f64 {
        0.5 * self.deck_width_m + GIRDER_HALF_WIDTH_M
    }

    /// Returns the length of the cross beams between the tower legs in meters.
    fn cross_beam_m(&self) -> f64 {
        2.0 * self.stay_y_m() - self.leg_y_m
    }

    /// Returns the floorbeams from the start to the end: at the ends, the towers and all stays, and at equal distances between them.
    fn floorbeams(&self) -> Vec<Floorbeam> {
        let half = 0.5 * self.main_span_m;
        let mut main: Vec<Floorbeam> =
            self.stays().iter().map(|stay| Floorbeam { x_m: stay.deck_m[0], carries_stays: true }).collect();
        main.extend([-half, half].map(|x_m| Floorbeam { x_m, carries_stays: false }));
        main.sort_by(|a, b| a.x_m.total_cmp(&b.x_m));
        let mut out = Vec::new();
        for pair in main.windows(2) {
            out.push(pair[0]);
            let length_m = pair[1].x_m - pair[0].x_m;
            let count = (length_m / FLOORBEAM_SPACING_M).ceil();
            let between = |k: i32| Floorbeam { x_m: pair[0].x_m + length_m * f64::from(k) / count, carries_stays: false };
            out.extend((1..count as i32).map(between));
        }
        out.extend(main.last());
        out
    }

    /// Returns half the length of a floorbeam in meters. Those that carry stays extend beyond them.
    fn floorbeam_half_length_m(&self, beam: Floorbeam) -> f64 {
        if beam.carries_stays { self.stay_y_m() + FLOORBEAM_M.1 } else { 0.5 * self.deck_width_m }
    }

    /// Returns the distance from the deck's centerline to the outermost parts above the piers in meters.
    fn outer_y_m(&self) -> f64 {
        self.stay_y_m() + FLOORBEAM_M.1.max(0.5 * self.leg_y_m)
    }
}

// Members.
impl CableStayed {
    /// Adds a tower: its pier, two legs, a cross beam below the girders with their bearings, and one at the top.
    fn add_tower(&self, b: &mut MemberBuilder, name: &str, x: f64) {
        let (px, py) = (0.5 * self.pier_x_m, 0.5 * self.pier_y_m);
        let (foot, top) = (-self.pier_top_m, self.tower_height_m + TOWER_TOP_M);
        b.add_box(&format!("pier-{name}"), Element::RcPierWall, [x - px, -py, foot - self.pier_height_m], [x + px, py, foot]);
        let (lx, ly) = (0.5 * self.leg_x_m, 0.5 * self.leg_y_m);
        for (side, y) in [("left", self.stay_y_m()), ("right", -self.stay_y_m())] {
            b.add_box(&format!("tower-{name}/{side}"), Element::RcColumn, [x - lx, y - ly, foot], [x + lx, y + ly, top]);
            let element = if x < 0.0 { Element::FixedBearing } else { Element::MovableBearing };
            self.add_bearing(b, &format!("bearing-tower-{name}/{side}"), element, x, y.signum());
        }
        let (inner, half) = (0.5 * self.cross_beam_m(), CROSS_BEAM_M.1.min(lx));
        let seat = self.seat_z_m();
        b.add_box(&format!("cap-{name}"), Element::RcPierCap, [x - half, -inner, seat - CROSS_BEAM_M.0], [x + half, inner, seat]);
        b.add_box(
            &format!("tower-{name}/beam"),
            Element::RcColumn,
            [x - half, -inner, top - CROSS_BEAM_M.0],
            [x + half, inner, top],
        );
    }

    fn add_bearing(&self, b: &mut MemberBuilder, name: &str, element: Element, x: f64, side: f64) {
        let (y, top, [height, along, across]) = (side * 0.5 * self.deck_width_m, self.girder_bottom_z_m(), BEARING_M);
        b.add_box(name, element, [x - along, y - across, top - height], [x + along, y + across, top]);
    }

    /// Adds the stays, each with a guide pipe at its lower end.
    fn add_stays(&self, b: &mut MemberBuilder) {
        let count = self.stays.round() as usize;
        for (side, y) in [("left", self.stay_y_m()), ("right", -self.stay_y_m())] {
            for (k, stay) in self.stays().into_iter().enumerate() {
                let name = format!("stay-{side}/{}-{:02}", ["1-side", "1-main", "2-side", "2-main"][k / count], k % count + 1);
                let at = |[x, z]: [f64; 2]| -> LocalPoint { [x, y, z] };
                let (foot, head) = (stay.deck_m, stay.tower_m);
                b.add_rod(&name, Element::MainCable, at(foot), at(head), self.stay_radius_m, 8);
                let share = PIPE.0 / math::hypot(head[0] - foot[0], head[1] - foot[1]);
                let end = [0, 1].map(|axis| math::lerp(foot[axis], head[axis], share));
                b.add_rod(&format!("{name}/pipe"), Element::MainCable, at(foot), at(end), PIPE.1 * self.stay_radius_m, 8);
            }
        }
    }

    /// Adds deck, edge girders, floorbeams and joints.
    fn add_floor(&self, b: &mut MemberBuilder) {
        let (half_width, soffit, end) = (0.5 * self.deck_width_m, -self.slab_m, self.girder_end_x_m());
        let beams = self.floorbeams();
        let mut ends = vec![-end];
        ends.extend(beams.iter().map(|beam| beam.x_m));
        ends.push(end);
        for (k, pair) in ends.windows(2).enumerate() {
            b.add_box(&format!("slab/{k:02}"), Element::RcDeck, [pair[0], -half_width, soffit], [pair[1], half_width, 0.0]);
            for (side, y) in [("left", half_width), ("right", -half_width)] {
                let low = [pair[0], y - GIRDER_HALF_WIDTH_M, self.girder_bottom_z_m()];
                let high = [pair[1], y + GIRDER_HALF_WIDTH_M, soffit];
                let name = format!("girder-{side}/{k:02}");
                b.add_steel_beam(&name, Element::SteelGirder, (low, high), BeamDirection::Along, GIRDER_PLATES);
            }
        }
        for (k, beam) in beams.into_iter().enumerate() {
            let (x, reach, half) = (beam.x_m, self.floorbeam_half_length_m(beam), FLOORBEAM_M.0);
            let corners = ([x - half, -reach, soffit - self.floorbeam_depth_m], [x + half, reach, soffit]);
            b.add_steel_beam(
                &format!("floorbeam/{k:02}"),
                Element::SteelFloorBeam,
                corners,
                BeamDirection::Across,
                FLOORBEAM_PLATES,
            );
        }
        let [gap, height, depth] = JOINT_M;
        for (name, from, to) in [("joint-start", -end - gap, -end), ("joint-end", end, end + gap)] {
            b.add_box(name, Element::StripSealJoint, [from, -half_width, -depth - height], [to, half_width, -depth]);
        }
    }

    /// Adds an abutment: the stem with the bearings, the backwall, the wing walls and the approach slab.
    fn add_abutment(&self, b: &mut MemberBuilder, name: &str, side: f64) {
        let (half, road, seat) = (self.abutment_half_width_m(), 0.5 * self.deck_width_m, self.seat_z_m());
        let [wall, slab, height] = ABUTMENT_M;
        let (front, back, end) = (self.end_x_m() - END_M.1, self.backwall_back_x_m(), 0.5 * self.deck_length_m());
        let mut part = |part: String, element: Element, x: (f64, f64), y: (f64, f64), z: (f64, f64)| {
            let (low, high) = math::range([side * x.0, side * x.1].into_iter());
            b.add_box(&part, element, [low, y.0, z.0], [high, y.1, z.1]);
        };
        let bottom = seat - height;
        part(format!("abutment-{name}/stem"), Element::RcAbutment, (front, back), (-half, half), (bottom, seat));
        part(format!("abutment-{name}/backwall"), Element::RcAbutment, (back - wall, back), (-half, half), (seat, 0.0));
        let under_slab = (bottom, -slab);
        part(format!("abutment-{name}/wing-left"), Element::RcAbutment, (back, end), (half - wall, half), under_slab);
        part(format!("abutment-{name}/wing-right"), Element::RcAbutment, (back, end), (-half, wall - half), under_slab);
        part(format!("approach-slab-{name}"), Element::RcApproachSlab, (back, end), (-road, road), (-slab, 0.0));
        for sign in [1.0, -1.0] {
            let place = if sign > 0.0 { "left" } else { "right" };
            self.add_bearing(b, &format!("bearing-{name}/{place}"), Element::MovableBearing, side * self.end_x_m(), sign);
        }
    }
}

// Task paths.
impl CableStayed {
    /// Returns a straight line along the right edge girder, outside the stays and the towers, facing the girder.
    fn edge_girder(&self, stand_off_m: f64) -> Result<LocalPath, String> {
        let half = self.end_x_m() - END_M.1 - stand_off_m;
        let z = 0.5 * self.girder_bottom_z_m();
        if half <= 0.0 || z + self.pier_top_m < stand_off_m {
            return Err("piers and abutments that are farther away than stand_off_m (pier_top_m, side_span_m)".into());
        }
        let y = -self.outer_y_m() - stand_off_m;
        let points: Vec<LocalPoint> = equal_steps(-half, half).into_iter().map(|x| [x, y, z]).collect();
        Ok(LocalPath { viewing_directions: vec![[0.0, 1.0, 0.0]; points.len()], points, closed: false })
    }

    /// Returns one loop around the pier of the start tower, 2 m below its top, or lower if the stand-off from the girders requires it.
    fn pier_circle(&self, stand_off_m: f64) -> Result<LocalPath, String> {
        let z = (-self.pier_top_m - 2.0).min(self.girder_bottom_z_m() - stand_off_m);
        if z < -self.pier_top_m - self.pier_height_m {
            return Err("a pier that extends to stand_off_m below the girders".into());
        }
        let half_m = (0.5 * self.pier_x_m, 0.5 * self.pier_y_m);
        let (points, normals) = rectangle_loop((-0.5 * self.main_span_m, z), half_m, stand_off_m);
        let viewing_directions = normals.into_iter().map(|[nx, ny]| [-nx, -ny, 0.0]).collect();
        Ok(LocalPath { points, viewing_directions, closed: true })
    }

    /// Returns the path under the floorbeams of a span, out below the left half of the deck and back below the right half. The camera looks up,
    /// slightly ahead, and from side to side.
    fn floor_system(&self, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String> {
        let (tower, end) = (0.5 * self.main_span_m, self.end_x_m() - END_M.1);
        let pier_m = 0.5 * self.pier_x_m;
        let (from, to) = match place.span.unwrap_or(2) {
            1 => (-end, -tower - pier_m),
            2 => (pier_m - tower, tower - pier_m),
            3 => (tower + pier_m, end),
            _ => return Err("span_number = 1 to 3".into()),
        };
        let ends = (from + stand_off_m, to - stand_off_m);
        let radius_m = TURN.1 * self.deck_width_m;
        if radius_m < TURN.0 || ends.1 - ends.0 <= 2.0 * radius_m {
            return Err("a wider deck (deck_width_m), a longer span or a smaller stand_off_m".into());
        }
        let z = self.girder_bottom_z_m() - stand_off_m;
        let (rise_m, ahead_m) = (-self.slab_m - z, PAN.1 * stand_off_m);
        let pan_m = (VIEW_SHARE * self.deck_width_m - radius_m).max(0.0);
        let mut path = LocalPath { points: Vec::new(), viewing_directions: Vec::new(), closed: false };
        for (k, (at, ahead)) in beam_path::out_and_back(ends, radius_m).into_iter().enumerate() {
            let aside_m = pan_m * math::sin(math::TAU * k as f64 / PAN.0);
            path.points.push([at[0], at[1], z]);
            let view = [ahead_m * ahead[0] - aside_m * ahead[1], ahead_m * ahead[1] + aside_m * ahead[0], rise_m];
            path.viewing_directions.push(view);
        }
        Ok(path)
    }

    /// Returns a line along the longest stay of the start tower in the main span, from the deck up to the tower, outside the right plane of
    /// stays and facing it.
    fn stay_cable(&self, stand_off_m: f64) -> Result<LocalPath, String> {
        let stay = self.stays()[2 * self.stays.round() as usize - 1];
        let away_m = FLOORBEAM_M.1 + stand_off_m;
        // Beside the leg, which is wider than the plane of the stays, the path ends earlier.
        let beside_m = (away_m - 0.5 * self.leg_y_m).min(stand_off_m);
        let before_m = 0.5 * self.leg_x_m + (stand_off_m * stand_off_m - beside_m * beside_m).max(0.0).sqrt();
        let run_m = stay.deck_m[0] - stay.tower_m[0];
        if beside_m <= 0.0 || before_m >= 0.5 * run_m {
            return Err("a longer stay (main_span_m, stays) or another stand_off_m".into());
        }
        let (rise_m, share) = (stay.tower_m[1] - stay.deck_m[1], 1.0 - before_m / run_m);
        let length_m = share * math::hypot(run_m, rise_m);
        let points: Vec<LocalPoint> = equal_steps(0.0, length_m)
            .into_iter()
            .map(|along_m| {
                let t = share * along_m / length_m;
                [stay.deck_m[0] - t * run_m, -self.stay_y_m() - away_m, stay.deck_m[1] + t * rise_m]
            })
            .collect();
        Ok(LocalPath { viewing_directions: vec![[0.0, 1.0, 0.0]; points.len()], points, closed: false })
    }
}
