//! Prestressed concrete box girder bridge: one continuous box with one or more cells, of constant depth or with haunches at the piers, on
//! two bearings at each support. The outer webs can be inclined.

use super::beam_bridge::BeamBridge;
use super::beam_layout::{
    BARRIER_WIDTH_M, BeamLayout, BearingLayout, DECK_WIDTH_M, DeckLayout, LineLayout, SpanLayout, support_layout,
};
use super::beam_path;
use super::dimensions::{InconsistencyList, bridge_dimensions};
use super::path::{LocalPath, PathPlace, SPACING_M, TaskKind};
use super::plan_polygon;
use super::quantity::Amounts;
use super::solid::MemberBuilder;
use crate::elements::Element;

/// Distance from the abutments' bearings to the ends of the box, and half the thickness of the diaphragms, m (estimate: the diaphragms at
/// the abutments close the box).
const BOX_OVERHANG_M: f64 = 0.6;
/// Distance between the bearings' axes and the edges of the box at the piers, m (estimate).
const BEARING_INSET_M: f64 = 0.7;
/// Minimum distance between the bearings' axes, m (estimate: against overturning).
const MIN_BEARING_SPACING_M: f64 = 2.0;
/// Side length of the bearings, m (estimate: pot bearings).
const BEARING_M: f64 = 0.8;
/// Length of the parts of the box between straight edges of its soffit, m (estimate: segments of a box that is built by free
/// cantilevering).
const SEGMENT_M: f64 = 3.5;
/// Minimum depth of a prestressed box with one span and with several, as a share of the span (AASHTO LRFD table 2.5.2.6.3-1).
const MIN_DEPTH_SHARE: (f64, f64) = (0.045, 0.04);
/// Minimum thickness of the top and bottom slab, as a share of the clear distance between webs (AASHTO LRFD 5.12.3.5.1).
const MIN_SLAB_SHARE: (f64, f64) = (1.0 / 20.0, 1.0 / 30.0);
/// Minimum height and width of a cell, m (estimate: an inspector can walk through it).
const MIN_CELL_M: (f64, f64) = (0.9, 1.2);
/// Largest slope of the soffit at a pier (estimate).
const MAX_SOFFIT_SLOPE: f64 = 0.3;
/// Minimum length of the part of an end span without a haunch, m (estimate: access to the bearings).
const LEVEL_END_M: f64 = 12.0;
/// Room for a barrier and a drain beside the box, m.
const DECK_EDGE_M: f64 = BARRIER_WIDTH_M.0 + 0.25;

bridge_dimensions! {
    /// Dimensions of a concrete box girder bridge. Bridge axes: x along the deck, y left, z up, origin on the deck in the middle between
    /// the abutments.
    BoxGirder "box_girder" {
        spans 1.0 to 8.0, 3.0, "Number of spans; a whole number.";
        span_m 20.0 to 120.0, 54.86, "Length of each span between bearings, m, except for the first and the last of several spans; 180 ft (estimate).";
        end_span_m 20.0 to 120.0, 42.67, "Length of the first and the last of several spans, m; 140 ft (estimate).";
        joint_gap_m 0.03 to 0.15, 0.08, "Width of the expansion joints, m (estimate).";
        midspan_depth_m 1.2 to 6.0, 1.83, "Depth of the box at midspan and at the abutments, including the top slab, m; with pier_depth_m on average 0.04 span_m (AASHTO LRFD table 2.5.2.6.3-1).";
        pier_depth_m 1.2 to 12.0, 3.2, "Depth of the box above the piers, m; midspan_depth_m for a box of constant depth (estimate).";
        haunch_length_m 6.0 to 60.0, 22.0, "Length of the haunch on each side of a pier, m; its soffit is a parabola (estimate).";
        cells 1.0 to 6.0, 3.0, "Number of cells; a whole number.";
        cell_width_m 2.0 to 8.0, 2.82, "Distance between the axes of the webs at the top, m; 9.25 ft in ADOT's LRFD example of a post-tensioned box girder.";
        web_m 0.2 to 0.8, 0.305, "Thickness of the webs, m; 12 in in ADOT's LRFD example of a post-tensioned box girder.";
        web_slope 0.0 to 0.5, 0.25, "Inclination of the outer webs: inward per meter of depth, m (estimate).";
        overhang_m 0.9 to 4.0, 1.9, "Deck width beyond the outer webs' axes at the top, m (estimate).";
        slab_m 0.178 to 0.5, 0.216, "Thickness of the top slab, m; 8.5 in in ADOT's LRFD example of a post-tensioned box girder.";
        bottom_slab_m 0.14 to 0.6, 0.18, "Thickness of the bottom slab, m; at least 5.5 in (AASHTO LRFD 5.12.3.5.1b).";
        barrier_m 0.685 to 1.4, 0.86, "Barrier height, m; 27 in for test level 3, 42 in for test level 5 (AASHTO LRFD 13.7.3.2).";
        drain_spacing_m 5.0 to 100.0, 18.0, "Distance between deck drains, m (estimate).";
        bearing_m 0.08 to 0.4, 0.2, "Height of the bearings, m (estimate).";
        pedestal_m 0.1 to 1.0, 0.4, "Height of the pedestals below the bearings, m (estimate).";
        cap_depth_m 0.6 to 3.0, 1.5, "Depth of the pier caps, m (estimate).";
        cap_width_m 0.8 to 4.0, 2.0, "Width of the pier caps along the bridge, m (estimate).";
        columns 1.0 to 6.0, 2.0, "Number of columns per pier; a whole number.";
        column_m 0.5 to 3.0, 1.5, "Side length or diameter of the columns, m (estimate).";
        round_columns 0.0 to 1.0, 1.0, "1 if the columns are round, 0 if they are square; a whole number.";
        column_height_m 2.0 to 60.0, 10.0, "Height of the columns between footing and cap, m (estimate).";
        abutment_m 2.0 to 15.0, 4.0, "Height of the abutments below the bearing seats, m (estimate).";
        approach_m 4.0 to 20.0, 6.0, "Length of the approach slabs and wing walls, m (estimate).";
    }
}

/// A cross-section of the box: position along the bridge and depth below the road surface, m.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Section {
    x_m: f64,
    depth_m: f64,
}

impl BeamBridge for BoxGirder {
    const IN_WORDS: &'static str = "a box girder bridge";

    fn layout(&self) -> BeamLayout {
        let width_m = self.web_group_m() + 2.0 * self.overhang_m;
        let spacing_m = 2.0 * (self.outer_y_m(self.pier_depth()) - BEARING_INSET_M);
        BeamLayout {
            spans: SpanLayout {
                count: self.spans,
                span_m: self.span_m,
                end_span_m: self.end_span_m,
                overhang_m: BOX_OVERHANG_M,
                pier_gap_m: None,
                has_pier_joints: false,
                joint_gap_m: self.joint_gap_m,
                station_spacing_m: SEGMENT_M,
            },
            lines: LineLayout {
                count: 2.0,
                spacing_m,
                haunch_width_m: 0.0,
                top_z_m: -self.slab_m,
                bottom_z_m: -self.pier_depth(),
                abutment_bottom_z_m: -self.midspan_depth_m,
            },
            deck: DeckLayout {
                width_m,
                slab_m: self.slab_m,
                element: Element::PscTopFlange,
                railing_m: self.barrier_m,
                railing: Element::RcRailing,
                drain_spacing_m: self.drain_spacing_m,
                has_floorbeams: false,
            },
            bearings: BearingLayout {
                height_m: self.bearing_m,
                length_m: BEARING_M,
                width_m: BEARING_M,
                pedestal_m: self.pedestal_m,
                expansion: Element::PotBearing,
                fixed: Element::PotBearing,
            },
            supports: support_layout!(self, width_m),
        }
    }

    fn require(&self, layout: &BeamLayout, m: &mut InconsistencyList) {
        for (key, value) in
            [("spans", self.spans), ("cells", self.cells), ("columns", self.columns), ("round_columns", self.round_columns)]
        {
            m.require_integer(key, value);
        }
        self.require_depths(layout, m);
        self.require_section(m);
        layout.require_pier_room(m, "bearing_m", "cells, cell_width_m, web_slope");
    }

    fn add_beams(&self, layout: &BeamLayout, b: &mut MemberBuilder) {
        for (k, (from, to)) in layout.beam_panels().into_iter().enumerate() {
            let ends = [from, to].map(|x_m| Section { x_m, depth_m: self.depth_at_m(layout, x_m) });
            self.add_segment(b, &format!("box/{k:02}"), ends);
        }
        for (support, x) in layout.support_positions().into_iter().enumerate() {
            self.add_diaphragm(b, layout, support, x);
        }
    }

    fn add_beam_amounts(&self, layout: &BeamLayout, amounts: &mut Amounts) {
        amounts.add(Element::PscBoxGirder, layout.beam_length_m());
    }

    fn beam_path(
        &self,
        layout: &BeamLayout,
        kind: TaskKind,
        stand_off_m: f64,
        place: &PathPlace,
    ) -> Option<Result<LocalPath, String>> {
        if kind == TaskKind::GirderSoffit {
            let turn_m = 0.25 * layout.beam_group_m();
            let height_m = |x_m: f64| self.height_below_soffit_m(layout, x_m, stand_off_m);
            Some(beam_path::below_soffit(layout, stand_off_m, place, (turn_m, turn_m), &height_m))
        } else {
            beam_path::of_kind(layout, kind, stand_off_m, place)
        }
    }
}

// Dimensions that follow from others.
impl BoxGirder {
    fn has_piers(&self) -> bool {
        self.spans.round() > 1.0
    }

    /// Returns the depth above the piers in meters; that at midspan if there are none.
    fn pier_depth(&self) -> f64 {
        if self.has_piers() { self.pier_depth_m } else { self.midspan_depth_m }
    }

    /// Returns the distance between the axes of the outer webs at the top, in meters.
    fn web_group_m(&self) -> f64 {
        self.cells.round() * self.cell_width_m
    }

    /// Returns the distance from the centerline to the outer face of an outer web, at a depth below the road surface, in meters.
    fn outer_y_m(&self, depth_m: f64) -> f64 {
        0.5 * (self.web_group_m() + self.web_m) - self.web_slope * (depth_m - self.slab_m)
    }

    /// Returns the depth of the box at the end of a segment, in meters: on a parabola in the haunches. Between, the soffit is straight.
    fn depth_at_m(&self, layout: &BeamLayout, x_m: f64) -> f64 {
        let supports = layout.support_positions();
        let from_pier_m = layout.piers().map(|pier| (x_m - supports[pier]).abs()).fold(f64::INFINITY, f64::min);
        let share = (1.0 - from_pier_m / self.haunch_length_m).max(0.0);
        self.midspan_depth_m + (self.pier_depth() - self.midspan_depth_m) * share * share
    }

    /// Returns the height of a path at the stand-off distance from the soffit in meters: below the circles around all points of the soffit.
    fn height_below_soffit_m(&self, layout: &BeamLayout, x_m: f64, stand_off_m: f64) -> f64 {
        let node = |x: f64| [x, -self.depth_at_m(layout, x)];
        let below = |(from, to): (f64, f64)| plan_polygon::height_below_edge_m((node(from), node(to)), x_m, stand_off_m);
        layout.beam_panels().into_iter().map(below).fold(f64::INFINITY, f64::min)
    }
}

// Rules.
impl BoxGirder {
    fn require_depths(&self, layout: &BeamLayout, m: &mut InconsistencyList) {
        let mean_m = 0.5 * (self.midspan_depth_m + self.pier_depth());
        let share = if self.has_piers() { MIN_DEPTH_SHARE.1 } else { MIN_DEPTH_SHARE.0 };
        let longest_m = mean_m / share;
        let why = format!("1/{share} of the mean depth (midspan_depth_m, pier_depth_m; AASHTO LRFD table 2.5.2.6.3-1)");
        layout.require_spans_at_most(m, longest_m, &why);
        if !self.has_piers() {
            return;
        }
        m.require_at_least("pier_depth_m", self.pier_depth_m, self.midspan_depth_m, "no shallower than midspan_depth_m");
        let steep_m = 2.0 * (self.pier_depth_m - self.midspan_depth_m) / MAX_SOFFIT_SLOPE;
        m.require_at_least(
            "haunch_length_m",
            self.haunch_length_m,
            steep_m,
            "a soffit slope of at most 0.3 (pier_depth_m, midspan_depth_m; estimate)",
        );
        let room_m = self.end_span_m - LEVEL_END_M;
        m.require_at_most(
            "haunch_length_m",
            self.haunch_length_m,
            room_m,
            "12 m of constant depth in the end spans (end_span_m)",
        );
        if layout.piers().len() > 1 {
            m.require_at_most("haunch_length_m", self.haunch_length_m, 0.5 * self.span_m, "half of span_m");
        }
    }

    fn require_section(&self, m: &mut InconsistencyList) {
        let clear_m = self.cell_width_m - self.web_m;
        let (top_m, bottom_m) = (MIN_SLAB_SHARE.0 * clear_m, MIN_SLAB_SHARE.1 * clear_m);
        m.require_at_least("slab_m", self.slab_m, top_m, "1/20 of the distance between webs (AASHTO LRFD 5.12.3.5.1a)");
        m.require_at_least(
            "bottom_slab_m",
            self.bottom_slab_m,
            bottom_m,
            "1/30 of the distance between webs (AASHTO LRFD 5.12.3.5.1b)",
        );
        let cell_m = self.slab_m + self.bottom_slab_m + MIN_CELL_M.0;
        m.require_at_least("midspan_depth_m", self.midspan_depth_m, cell_m, "cells at least 0.9 m high (slab_m, bottom_slab_m)");
        // The outer cells are narrowest at the bottom above the piers; a single cell narrows on both sides.
        let drop_m = self.pier_depth() - self.slab_m;
        let sides = if self.cells.round() > 1.0 { 1.0 } else { 2.0 };
        let steepest = (clear_m - MIN_CELL_M.1) / (sides * drop_m);
        m.require_at_most(
            "web_slope",
            self.web_slope,
            steepest,
            "outer cells at least 1.2 m wide (cell_width_m, web_m, pier_depth_m)",
        );
        let missing_m = MIN_BEARING_SPACING_M - 2.0 * (self.outer_y_m(self.pier_depth()) - BEARING_INSET_M);
        let apart_m = self.cell_width_m + missing_m / self.cells.round();
        let why = "bearings at least 2 m apart (cells, web_slope, pier_depth_m)";
        m.require_at_least("cell_width_m", self.cell_width_m, apart_m, why);
        let beside_m = 0.5 * self.web_m + DECK_EDGE_M;
        m.require_at_least("overhang_m", self.overhang_m, beside_m, "room for barrier and drains (web_m)");
        m.require_at_most("overhang_m", self.overhang_m, self.cell_width_m, "no wider than cell_width_m");
        let (low_m, high_m) = DECK_WIDTH_M;
        let cell_for = |deck_m: f64| (deck_m - 2.0 * self.overhang_m) / self.cells.round();
        m.require_at_least("cell_width_m", self.cell_width_m, cell_for(low_m), "a deck at least 5 m wide (cells, overhang_m)");
        m.require_at_most("cell_width_m", self.cell_width_m, cell_for(high_m), "a deck at most 40 m wide (cells, overhang_m)");
    }
}

// Members.
impl BoxGirder {
    /// Adds the webs and the bottom slab between two cross-sections. The outer webs extend to the soffit.
    fn add_segment(&self, b: &mut MemberBuilder, name: &str, ends: [Section; 2]) {
        let element = Element::PscBoxGirder;
        let mut loft = |part: &str, profile: &dyn Fn(Section) -> [[f64; 2]; 4]| {
            let [start, end] = ends;
            b.add_loft(&format!("{name}/{part}"), element, (&profile(start), start.x_m), (&profile(end), end.x_m));
        };
        loft("web-left", &|section| self.outer_web(section));
        loft("web-right", &|section| {
            let [a, b, c, d] = self.outer_web(section).map(|[y, z]| [-y, z]);
            [b, a, d, c]
        });
        for web in 1..self.cells.round() as i32 {
            let y = 0.5 * self.web_group_m() - f64::from(web) * self.cell_width_m;
            loft(&format!("web-{web}"), &|section| self.inner_web(section, y));
        }
        loft("bottom", &|section| self.bottom_slab(section));
    }

    /// Returns the profile of the left outer web.
    fn outer_web(&self, Section { depth_m, .. }: Section) -> [[f64; 2]; 4] {
        let (below, above) = (self.outer_y_m(depth_m), self.outer_y_m(self.slab_m));
        [[below - self.web_m, -depth_m], [below, -depth_m], [above, -self.slab_m], [above - self.web_m, -self.slab_m]]
    }

    fn inner_web(&self, Section { depth_m, .. }: Section, y: f64) -> [[f64; 2]; 4] {
        let (half, low) = (0.5 * self.web_m, self.bottom_slab_m - depth_m);
        [[y - half, low], [y + half, low], [y + half, -self.slab_m], [y - half, -self.slab_m]]
    }

    /// Returns the profile of the bottom slab between the outer webs.
    fn bottom_slab(&self, Section { depth_m, .. }: Section) -> [[f64; 2]; 4] {
        let below = self.outer_y_m(depth_m) - self.web_m;
        let above = self.outer_y_m(depth_m - self.bottom_slab_m) - self.web_m;
        let (low, high) = (-depth_m, self.bottom_slab_m - depth_m);
        [[-below, low], [below, low], [above, high], [-above, high]]
    }

    /// Adds the solid diaphragms between the webs above a support.
    fn add_diaphragm(&self, b: &mut MemberBuilder, layout: &BeamLayout, support: usize, x: f64) {
        let low = self.bottom_slab_m - self.depth_at_m(layout, x);
        let inside = |z: f64| self.outer_y_m(-z) - self.web_m;
        let cells = self.cells.round() as i32;
        for cell in 0..cells {
            let left = 0.5 * self.web_group_m() - f64::from(cell) * self.cell_width_m;
            let (left_y, right_y) = (left - 0.5 * self.web_m, left - self.cell_width_m + 0.5 * self.web_m);
            let high = -self.slab_m;
            let left_at = |z: f64| if cell == 0 { inside(z) } else { left_y };
            let right_at = |z: f64| if cell + 1 == cells { -inside(z) } else { right_y };
            let profile = [[right_at(low), low], [left_at(low), low], [left_at(high), high], [right_at(high), high]];
            let name = format!("box/diaphragm-{support}/{}", cell + 1);
            b.add_cross_section(&name, Element::PscBoxGirder, &profile, x - BOX_OVERHANG_M, x + BOX_OVERHANG_M);
        }
    }
}

/// The points of a path on a sloping soffit are at most this far apart along the bridge, so that they are at most 1 m apart along the path.
const _: () = assert!(SPACING_M * SPACING_M * (1.0 + MAX_SOFFIT_SLOPE * MAX_SOFFIT_SLOPE) < 1.0);
