//! Multi-span steel I-girder bridge: plate girders with cross-frames under a concrete deck, on piers with columns and caps and on
//! seat abutments.
//!
//! The default dimensions are those of a published design, where it states them: FHWA, *Steel Bridge Design Handbook*, Design
//! Example 1 (FHWA-IF-12-052, volume 20, 2012): spans of 140, 175 and 140 ft, four girders.

use super::dimensions::{Inconsistency, InconsistencyList, bridge_dimensions};
use super::quantity::ElementQuantity;
use super::solid::{BeamDirection, Footing, MemberBuilder, PlateThickness};
use crate::elements::Element;
use crate::math;

/// Distance from the outermost bearings to the end of the girders and the deck, m (estimate).
const END_OVERHANG_M: f64 = 0.4;
/// Length of a bearing along the bridge, m (estimate). It is as wide as the flange.
const BEARING_LENGTH_M: f64 = 0.4;
/// Width of a pedestal beyond its bearing on each side, m (estimate).
const PEDESTAL_MARGIN_M: f64 = 0.1;
/// Distance from a pedestal to the edge of its cap or abutment, m (estimate).
const SEAT_MARGIN_M: f64 = 0.1;
/// Height of a joint seal, and its depth below the road surface, m (estimate).
const JOINT_SEAL_M: (f64, f64) = (0.1, 0.02);
/// Widths of a single-slope barrier at its foot and at its top, m (estimate).
const BARRIER_WIDTH_M: (f64, f64) = (0.4, 0.2);
/// Distance between a walkway's axis and the barrier, m (estimate: half of a person's width and a margin).
const WALKWAY_MARGIN_M: f64 = 0.45;
/// Thickness of the plates that connect cross-frames to the webs, m (TxDOT LRFD Bridge Design Manual, straight plate girders: at
/// least 0.5 in).
const CONNECTION_PLATE_M: f64 = 0.0127;
/// Thickness of the bearing stiffeners, m (estimate).
const BEARING_STIFFENER_M: f64 = 0.022;
/// Width of a stiffener, as a share of the flange's projection beside the web (estimate).
const STIFFENER_SHARE: f64 = 0.8;
/// Sides of a cross-frame's bars along and across the bridge, m (estimate: angles of 4 in).
const BAR_M: (f64, f64) = (0.08, 0.1);
/// Gap between the bars and the webs, m (estimate).
const BAR_GAP_M: f64 = 0.03;
/// Distances of the axes of a cross-frame's chords and of the ends of its diagonals from the flanges, m (estimate).
const BAR_HEIGHTS_M: (f64, f64) = (0.1, 0.36);
/// Maximum distance of the ends of the diagonals from the flanges, as a share of the web depth (estimate, for shallow girders).
const DIAGONAL_HEIGHT_SHARE: f64 = 0.3;
/// Corner radius of the drain pipes, and their distance from the barriers, m (estimate).
const DRAIN_M: (f64, f64) = (0.08, 0.04);
/// Length of the caps beyond the outer girders' axes, m (estimate).
const CAP_END_M: f64 = 0.6;
/// Depth of the footings, and their length beyond the columns, m (estimate).
const FOOTING_M: (f64, f64) = (1.2, 0.8);
/// Thickness of the backwalls, wing walls and approach slabs, m (estimate).
const BACKWALL_M: f64 = 0.5;
const WING_WALL_M: f64 = 0.4;
const APPROACH_SLAB_M: f64 = 0.3;
/// Number of sides of a round column (estimate: its outline is within 2% of the circle).
const ROUND_COLUMN_SIDES: u32 = 16;
/// Minimum space between columns, and minimum length of the caps beyond them, m (estimate).
const COLUMN_SPACE_M: f64 = 0.5;
/// Minimum and maximum deck width, m: those of the other bridge types.
const DECK_WIDTH_M: (f64, f64) = (5.0, 40.0);

bridge_dimensions! {
    /// Dimensions of a steel girder bridge. Bridge axes: x along the deck, y left, z up, origin on the deck in the middle between the
    /// abutments.
    Girder "girder" {
        spans 1.0 to 8.0, 3.0, "Number of spans; a whole number.";
        span_m 10.0 to 100.0, 53.34, "Length of each span between bearings, m, except for the first and the last of several spans; 53.3 m (175 ft) in FHWA's design example 1.";
        end_span_m 10.0 to 100.0, 42.67, "Length of the first and the last of several spans, m; 42.7 m (140 ft) in FHWA's design example 1.";
        simple_spans 0.0 to 1.0, 0.0, "1 if each span has its own girders, with joints above the piers; 0 if the girders are continuous; a whole number.";
        joint_gap_m 0.03 to 0.15, 0.06, "Width of the expansion joints, m (estimate).";
        girders 2.0 to 12.0, 4.0, "Number of girders; 4 in FHWA's design example 1; a whole number.";
        girder_spacing_m 1.5 to 5.0, 3.66, "Distance between girders, m; 3.66 m (12 ft) in FHWA's design example 1.";
        overhang_m 0.6 to 2.0, 1.07, "Deck width beyond the outer girders' axes, m; 1.07 m (3 ft 6 in) in FHWA's design example 1.";
        slab_m 0.178 to 0.35, 0.241, "Slab thickness, m; 0.241 m (9.5 in) in FHWA's design example 1, at least 7 in (AASHTO LRFD 9.7.1.1).";
        haunch_m 0.02 to 0.15, 0.05, "Height of the concrete haunch between the slab and a girder, m (estimate).";
        web_depth_m 0.6 to 4.0, 1.753, "Depth of the girders' webs, m; 1.753 m (69 in) in FHWA's design example 1.";
        web_m 0.011 to 0.04, 0.0127, "Web thickness, m; 0.5 in (12.7 mm) or more (TxDOT).";
        flange_width_m 0.3 to 1.0, 0.457, "Flange width, m; 15 in (381 mm) or more (TxDOT).";
        flange_m 0.019 to 0.1, 0.035, "Flange thickness, m; 0.75 in (19 mm) or more (TxDOT).";
        cross_frame_spacing_m 3.0 to 9.0, 7.0, "Maximum distance between cross-frames, m; 25 ft (7.6 m) in older AASHTO specifications.";
        barrier_m 0.685 to 1.4, 1.07, "Barrier height, m; 27 in for test level 3, 42 in for test level 5 (AASHTO LRFD 13.7.3.2).";
        drain_spacing_m 5.0 to 100.0, 18.0, "Distance between deck drains, m (estimate).";
        bearing_m 0.05 to 0.5, 0.12, "Height of the bearings, m (estimate).";
        pedestal_m 0.1 to 1.0, 0.3, "Height of the pedestals below the bearings, m (estimate).";
        cap_depth_m 0.6 to 3.0, 1.3, "Depth of the pier caps, m (estimate).";
        cap_width_m 0.8 to 4.0, 1.4, "Width of the pier caps along the bridge, m (estimate).";
        columns 1.0 to 6.0, 3.0, "Number of columns per pier; a whole number.";
        column_m 0.5 to 3.0, 1.1, "Side length or diameter of the columns, m (estimate).";
        round_columns 0.0 to 1.0, 0.0, "1 if the columns are round, 0 if they are square; a whole number.";
        column_height_m 2.0 to 60.0, 12.0, "Height of the columns between footing and cap, m (estimate).";
        abutment_m 2.0 to 15.0, 4.0, "Height of the abutments below the bearing seats, m (estimate).";
        approach_m 4.0 to 20.0, 6.0, "Length of the approach slabs and wing walls, m (estimate).";
    }
}

/// Girders and deck without a joint between them.
#[derive(Debug, Clone, PartialEq)]
struct Run {
    start_x_m: f64,
    end_x_m: f64,
    bearings: Vec<BearingLine>,
}

/// The bearings of one run on one support.
#[derive(Debug, Clone, Copy, PartialEq)]
struct BearingLine {
    support: usize,
    x_m: f64,
}

/// A cross-section of the girders with cross-frames.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Station {
    x_m: f64,
    at_bearings: bool,
}

// Dimensions that follow from others.
impl Girder {
    /// Returns the lengths of the spans in meters.
    #[must_use]
    pub fn span_lengths_m(&self) -> Vec<f64> {
        let last = self.spans.round() as usize - 1;
        (0..=last).map(|k| if last > 0 && (k == 0 || k == last) { self.end_span_m } else { self.span_m }).collect()
    }

    /// Returns the distance between the abutments' bearings in meters.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.span_lengths_m().iter().sum()
    }

    /// Returns the positions of the abutments' bearings and of the piers' axes, from the start to the end.
    #[must_use]
    pub fn supports(&self) -> Vec<f64> {
        let start = -0.5 * self.length_m();
        let mut out = vec![start];
        for span_m in self.span_lengths_m() {
            out.push(out[out.len() - 1] + span_m);
        }
        out
    }

    /// Returns the numbers of the supports that are piers.
    fn piers(&self) -> std::ops::Range<usize> {
        1..self.span_lengths_m().len()
    }

    /// Returns the distance between the axes of the outer girders in meters.
    #[must_use]
    pub fn girder_group_m(&self) -> f64 {
        (self.girders.round() - 1.0) * self.girder_spacing_m
    }

    /// Returns the positions of the girders across the bridge, from the left to the right.
    #[must_use]
    pub fn girder_lines(&self) -> Vec<f64> {
        let count = self.girders.round() as i32;
        (0..count).map(|k| 0.5 * self.girder_group_m() - f64::from(k) * self.girder_spacing_m).collect()
    }

    /// Returns the deck width in meters.
    #[must_use]
    pub fn deck_width_m(&self) -> f64 {
        self.girder_group_m() + 2.0 * self.overhang_m
    }

    /// Returns the distance of the walkways from the deck's centerline in meters: along the barriers.
    #[must_use]
    pub fn walkway_y_m(&self) -> f64 {
        0.5 * self.deck_width_m() - BARRIER_WIDTH_M.0 - WALKWAY_MARGIN_M
    }

    /// Returns the deck length in meters, including the backwalls and the approach slabs.
    #[must_use]
    pub fn deck_length_m(&self) -> f64 {
        2.0 * (self.backwall_back_x_m() + self.approach_m)
    }

    /// Returns the distance from the middle to the ends of the girders, in meters.
    fn girder_end_x_m(&self) -> f64 {
        0.5 * self.length_m() + END_OVERHANG_M
    }

    /// Returns the distance from the middle to the joints' ends at the backwalls, in meters.
    fn backwall_x_m(&self) -> f64 {
        self.girder_end_x_m() + self.joint_gap_m
    }

    /// Returns the distance from the middle to the backs of the backwalls, in meters. The ground between them is open.
    #[must_use]
    pub fn backwall_back_x_m(&self) -> f64 {
        self.backwall_x_m() + BACKWALL_M
    }

    /// Returns the distance from the middle to the fronts of the abutments, in meters.
    #[must_use]
    pub fn abutment_front_x_m(&self) -> f64 {
        0.5 * self.length_m() - self.abutment_seat_m()
    }

    /// Returns the distance from the abutments' bearings to the fronts of the abutments, in meters.
    fn abutment_seat_m(&self) -> f64 {
        self.pedestal_half_length_m() + SEAT_MARGIN_M
    }

    fn pedestal_half_length_m(&self) -> f64 {
        0.5 * BEARING_LENGTH_M + PEDESTAL_MARGIN_M
    }

    /// Returns the height of the girders' tops in meters.
    #[must_use]
    pub fn girder_top_z_m(&self) -> f64 {
        -self.slab_m - self.haunch_m
    }

    /// Returns the height of the girders' undersides in meters.
    #[must_use]
    pub fn girder_bottom_z_m(&self) -> f64 {
        self.girder_top_z_m() - self.web_depth_m - 2.0 * self.flange_m
    }

    /// Returns the height of the bearings' undersides in meters.
    fn bearing_bottom_z_m(&self) -> f64 {
        self.girder_bottom_z_m() - self.bearing_m
    }

    /// Returns the height of the tops of caps and abutments, below the pedestals, in meters.
    #[must_use]
    pub fn seat_z_m(&self) -> f64 {
        self.bearing_bottom_z_m() - self.pedestal_m
    }

    /// Returns the height of the caps' undersides in meters.
    #[must_use]
    pub fn cap_bottom_z_m(&self) -> f64 {
        self.seat_z_m() - self.cap_depth_m
    }

    /// Returns the length of a cap across the bridge in meters.
    #[must_use]
    pub fn cap_length_m(&self) -> f64 {
        self.girder_group_m() + 2.0 * CAP_END_M
    }

    /// Returns the height of the footings' tops in meters.
    #[must_use]
    pub fn footing_top_z_m(&self) -> f64 {
        self.cap_bottom_z_m() - self.column_height_m
    }

    /// Returns the distance from the fronts of a support's bearings to the edge of its cap or abutment in the direction of the nearer
    /// span, in meters.
    #[must_use]
    pub fn bearing_setback_m(&self, support: usize) -> f64 {
        let is_pier = self.piers().contains(&support);
        let edge_m = if is_pier { 0.5 * self.cap_width_m - self.pier_offset_m() } else { self.abutment_seat_m() };
        edge_m - 0.5 * BEARING_LENGTH_M
    }

    /// Returns the steepest slope at which the middle of a bearing's front is visible from below, past the edges of its pedestal and of
    /// the cap or abutment.
    #[must_use]
    pub fn bearing_sight_slope(&self, support: usize) -> f64 {
        let middle_m = 0.5 * self.bearing_m;
        (middle_m / PEDESTAL_MARGIN_M).min((self.pedestal_m + middle_m) / self.bearing_setback_m(support))
    }

    /// Returns the distance of the bearings from a pier's axis in meters.
    fn pier_offset_m(&self) -> f64 {
        if self.is_continuous() { 0.0 } else { END_OVERHANG_M + 0.5 * self.joint_gap_m }
    }

    fn is_continuous(&self) -> bool {
        self.simple_spans.round() < 1.0
    }

    /// Returns the position of the fronts of a support's bearings: at the first abutment the sides toward the first span, at all other
    /// supports the sides toward the span before them.
    #[must_use]
    pub fn bearing_front_x_m(&self, support: usize) -> f64 {
        let offset_m = if self.piers().contains(&support) { self.pier_offset_m() } else { 0.0 };
        let half_m = 0.5 * BEARING_LENGTH_M;
        self.supports()[support] - offset_m + if support == 0 { half_m } else { -half_m }
    }

    /// Returns the positions of a pier's columns across the bridge.
    fn column_lines(&self) -> Vec<f64> {
        let (count, each_m) = (self.columns.round(), self.cap_length_m() / self.columns.round());
        (0..count as i32).map(|k| (f64::from(k) - 0.5 * (count - 1.0)) * each_m).collect()
    }

    /// Returns the length of a footing across the bridge in meters.
    fn footing_length_m(&self) -> f64 {
        let between_m = self.cap_length_m() * (1.0 - 1.0 / self.columns.round());
        between_m + self.column_m + 2.0 * FOOTING_M.1
    }

    /// Returns the runs of girders and deck from the start to the end.
    fn runs(&self) -> Vec<Run> {
        let (supports, end) = (self.supports(), self.girder_end_x_m());
        let last = supports.len() - 1;
        if self.is_continuous() {
            let bearings = supports.iter().enumerate().map(|(support, x_m)| BearingLine { support, x_m: *x_m }).collect();
            return vec![Run { start_x_m: -end, end_x_m: end, bearings }];
        }
        let (offset_m, half_gap_m) = (self.pier_offset_m(), 0.5 * self.joint_gap_m);
        let run = |k: usize| {
            let (from, to) = (supports[k], supports[k + 1]);
            let (start_x_m, first) = if k == 0 { (-end, from) } else { (from + half_gap_m, from + offset_m) };
            let (end_x_m, second) = if k + 1 == last { (end, to) } else { (to - half_gap_m, to - offset_m) };
            let bearings = vec![BearingLine { support: k, x_m: first }, BearingLine { support: k + 1, x_m: second }];
            Run { start_x_m, end_x_m, bearings }
        };
        (0..last).map(run).collect()
    }

    /// Returns the cross-sections with cross-frames: at all bearings, and at equal distances between them.
    fn stations(&self, run: &Run) -> Vec<Station> {
        let mut out = vec![Station { x_m: run.bearings[0].x_m, at_bearings: true }];
        for pair in run.bearings.windows(2) {
            let (from, to) = (pair[0].x_m, pair[1].x_m);
            let count = ((to - from) / self.cross_frame_spacing_m).ceil().max(1.0) as i32;
            let at = |k: i32| if k == count { to } else { from + (to - from) * f64::from(k) / f64::from(count) };
            out.extend((1..=count).map(|k| Station { x_m: at(k), at_bearings: k == count }));
        }
        out
    }

    /// Returns the ends of the panels between cross-frames, and of those beyond the outermost bearings.
    fn panels(&self) -> Vec<(f64, f64)> {
        let of_run = |run: &Run| {
            let mut ends = vec![run.start_x_m];
            ends.extend(self.stations(run).iter().map(|station| station.x_m));
            ends.push(run.end_x_m);
            ends.windows(2).map(|pair| (pair[0], pair[1])).collect::<Vec<_>>()
        };
        self.runs().iter().flat_map(of_run).collect()
    }

    /// Returns the positions of the drains along the bridge. There are none above the piers.
    fn drains(&self) -> Vec<f64> {
        let supports = self.supports();
        let piers: Vec<f64> = self.piers().map(|pier| supports[pier]).collect();
        let of_run = |run: &Run| {
            let length_m = run.end_x_m - run.start_x_m;
            let count = (length_m / self.drain_spacing_m).floor();
            let start_x_m = run.start_x_m;
            (0..count as i32).map(move |k| start_x_m + length_m * (f64::from(k) + 0.5) / count)
        };
        let is_clear = |x: &f64| piers.iter().all(|pier| (x - pier).abs() > self.cap_width_m);
        self.runs().iter().flat_map(of_run).filter(is_clear).collect()
    }

    /// Returns the distance of the drain pipes from the deck's centerline in meters.
    fn drain_y_m(&self) -> f64 {
        0.5 * self.deck_width_m() - BARRIER_WIDTH_M.0 - DRAIN_M.0 - DRAIN_M.1
    }

    /// Returns the joints' positions: name, start and end along the bridge.
    fn joints(&self) -> Vec<(String, f64, f64)> {
        let (end, wall) = (self.girder_end_x_m(), self.backwall_x_m());
        let mut out = vec![("joint-start".to_owned(), -wall, -end)];
        let runs = self.runs();
        let at_pier = |(k, pair): (usize, &[Run])| (format!("joint-pier-{}", k + 1), pair[0].end_x_m, pair[1].start_x_m);
        out.extend(runs.windows(2).enumerate().map(at_pier));
        out.push(("joint-end".to_owned(), end, wall));
        out
    }

    /// Returns all inconsistent dimensions. If there are none, all plates meet the proportion limits of AASHTO LRFD, and all members
    /// have a support and room.
    #[must_use]
    pub fn inconsistencies(&self) -> Vec<Inconsistency> {
        let mut m = InconsistencyList::default();
        for (key, value) in [
            ("spans", self.spans),
            ("simple_spans", self.simple_spans),
            ("girders", self.girders),
            ("columns", self.columns),
            ("round_columns", self.round_columns),
        ] {
            m.require_integer(key, value);
        }
        self.require_room(&mut m);
        self.require_proportions(&mut m);
        m.0
    }

    fn require_room(&self, m: &mut InconsistencyList) {
        let bays = self.girders.round() - 1.0;
        let spacing_m = |deck_m: f64| (deck_m - 2.0 * self.overhang_m) / bays;
        let beside_m = 0.5 * self.flange_width_m + BARRIER_WIDTH_M.0 + DRAIN_M.1 + 2.0 * DRAIN_M.0;
        let seat_m = 2.0 * (self.pier_offset_m() + self.pedestal_half_length_m() + SEAT_MARGIN_M);
        let column_m = self.cap_length_m() / self.columns.round() - COLUMN_SPACE_M;
        let (low_m, high_m) = DECK_WIDTH_M;
        let spacing = self.girder_spacing_m;
        m.require_at_least("girder_spacing_m", spacing, spacing_m(low_m), "a deck of at least 5 m (girders, overhang_m)");
        m.require_at_most("girder_spacing_m", spacing, spacing_m(high_m), "a deck of at most 40 m (girders, overhang_m)");
        m.require_at_least("overhang_m", self.overhang_m, beside_m, "room for barrier and drains (flange_width_m)");
        m.require_at_most("overhang_m", self.overhang_m, spacing, "no wider than girder_spacing_m");
        m.require_at_most("flange_width_m", self.flange_width_m, 0.5 * spacing, "half of girder_spacing_m");
        m.require_at_least("cap_width_m", self.cap_width_m, seat_m, "room for the bearings (simple_spans, joint_gap_m)");
        m.require_at_most("column_m", self.column_m, self.cap_width_m, "no wider than the cap (cap_width_m)");
        m.require_at_most("column_m", self.column_m, column_m, "room for all columns (columns, girders, girder_spacing_m)");
    }

    /// Requires the proportion limits of AASHTO LRFD 6.10.2 for webs and flanges, and a web that is not too flat for the spans.
    fn require_proportions(&self, m: &mut InconsistencyList) {
        let longest_m = self.span_lengths_m().into_iter().fold(0.0, f64::max);
        m.require_at_least("web_depth_m", self.web_depth_m, longest_m / 50.0, "not too flat for the longest span (estimate)");
        m.require_at_least("web_m", self.web_m, self.web_depth_m / 150.0, "web_depth_m / 150 (AASHTO LRFD 6.10.2.1)");
        m.require_at_least(
            "flange_width_m",
            self.flange_width_m,
            self.web_depth_m / 6.0,
            "web_depth_m / 6 (AASHTO LRFD 6.10.2.2)",
        );
        m.require_at_least("flange_m", self.flange_m, self.flange_width_m / 24.0, "flange_width_m / 24 (AASHTO LRFD 6.10.2.2)");
        m.require_at_least("flange_m", self.flange_m, 1.1 * self.web_m, "1.1 times web_m (AASHTO LRFD 6.10.2.2)");
    }

    /// Returns the total quantities of the elements.
    #[must_use]
    pub fn quantities(&self) -> Vec<ElementQuantity> {
        let runs = self.runs();
        let (piers, width_m) = (self.piers().len() as f64, self.deck_width_m());
        let run_m: f64 = runs.iter().map(|run| run.end_x_m - run.start_x_m).sum();
        let fixed = runs.len() as f64 * self.girders.round();
        let bearings = runs.iter().map(|run| run.bearings.len() as f64).sum::<f64>() * self.girders.round();
        ElementQuantity::list(&[
            (Element::RcDeck, run_m * width_m),
            (Element::SteelGirder, run_m * self.girders.round()),
            (Element::RcColumn, piers * self.columns.round()),
            (Element::RcAbutment, 2.0 * (width_m + 2.0 * self.approach_m)),
            (Element::RcFooting, piers * self.footing_length_m()),
            (Element::RcPierCap, piers * self.cap_length_m()),
            (Element::StripSealJoint, self.joints().len() as f64 * width_m),
            (Element::ElastomericBearing, bearings - fixed),
            (Element::FixedBearing, fixed),
            (Element::RcApproachSlab, 2.0 * self.approach_m * width_m),
            (Element::RcRailing, 2.0 * self.deck_length_m()),
        ])
    }

    /// Returns the footings of piers and abutments.
    #[must_use]
    pub fn footings(&self) -> Vec<Footing> {
        let supports = self.supports();
        let half = 0.5 * self.deck_width_m();
        let (front, back) = (self.abutment_front_x_m(), 0.5 * self.deck_length_m());
        let abutment = |side: f64| Footing {
            x_m: math::range([side * front, side * back].into_iter()),
            y_m: (-half, half),
            up_m: self.seat_z_m() - self.abutment_m,
        };
        let pier = |k: usize| {
            let (along, across) = (0.5 * self.column_m + FOOTING_M.1, 0.5 * self.footing_length_m());
            let up_m = self.footing_top_z_m() - FOOTING_M.0;
            Footing { x_m: (supports[k] - along, supports[k] + along), y_m: (-across, across), up_m }
        };
        [abutment(-1.0), abutment(1.0)].into_iter().chain(self.piers().map(pier)).collect()
    }
}

// Members.
impl Girder {
    /// Adds all the bridge's members to a builder.
    pub fn build(&self, b: &mut MemberBuilder) {
        self.deck(b);
        self.barriers(b);
        self.girder_members(b);
        self.cross_frames(b);
        self.bearings(b);
        for pier in self.piers() {
            self.pier(b, pier);
        }
        self.abutment(b, "abutment-start", -1.0);
        self.abutment(b, "abutment-end", 1.0);
    }

    fn deck(&self, b: &mut MemberBuilder) {
        let (half, soffit) = (0.5 * self.deck_width_m(), -self.slab_m);
        for (k, (from, to)) in self.panels().into_iter().enumerate() {
            b.add_box(&format!("slab/{k:02}"), Element::RcDeck, [from, -half, soffit], [to, half, 0.0]);
        }
        let (flange, top) = (0.5 * self.flange_width_m, self.girder_top_z_m());
        for (k, run) in self.runs().iter().enumerate() {
            for (line, y) in self.numbered_lines() {
                let name = format!("haunch-{line}/{k}");
                b.add_box(&name, Element::RcDeck, [run.start_x_m, y - flange, top], [run.end_x_m, y + flange, soffit]);
            }
        }
        for (name, from, to) in self.joints() {
            let (height, depth) = JOINT_SEAL_M;
            b.add_box(&name, Element::StripSealJoint, [from, -half, -depth - height], [to, half, -depth]);
        }
        self.drain_pipes(b);
    }

    fn drain_pipes(&self, b: &mut MemberBuilder) {
        for (side, y) in [("left", self.drain_y_m()), ("right", -self.drain_y_m())] {
            for (k, x) in self.drains().into_iter().enumerate() {
                let (inlet, outlet) = ([x, y, -self.slab_m], [x, y, self.girder_bottom_z_m()]);
                b.add_rod(&format!("drain-{side}/{k:02}"), Element::DECK_DRAIN, inlet, outlet, DRAIN_M.0, 8);
            }
        }
    }

    /// Returns the girders' numbers, from 1 on the left, and their positions across the bridge.
    fn numbered_lines(&self) -> impl Iterator<Item = (usize, f64)> + use<> {
        (1..).zip(self.girder_lines())
    }

    fn barriers(&self, b: &mut MemberBuilder) {
        let (wall, end) = (self.backwall_x_m(), 0.5 * self.deck_length_m());
        let mut pieces = vec![(-end, -wall)];
        pieces.extend(self.panels());
        pieces.push((wall, end));
        let edge = 0.5 * self.deck_width_m();
        let (foot, top) = (edge - BARRIER_WIDTH_M.0, edge - BARRIER_WIDTH_M.1);
        let left = [[foot, 0.0], [edge, 0.0], [edge, self.barrier_m], [top, self.barrier_m]];
        let right = [[-edge, 0.0], [-foot, 0.0], [-top, self.barrier_m], [-edge, self.barrier_m]];
        for (side, profile) in [("left", left), ("right", right)] {
            for (k, (from, to)) in pieces.iter().enumerate() {
                b.add_cross_section(&format!("barrier-{side}/{k:02}"), Element::RcRailing, &profile, *from, *to);
            }
        }
    }

    fn girder_members(&self, b: &mut MemberBuilder) {
        let plates = PlateThickness { flange_m: self.flange_m, web_m: self.web_m };
        let (half, low, high) = (0.5 * self.flange_width_m, self.girder_bottom_z_m(), self.girder_top_z_m());
        for (line, y) in self.numbered_lines() {
            for (k, (from, to)) in self.panels().into_iter().enumerate() {
                let corners = ([from, y - half, low], [to, y + half, high]);
                let name = format!("girder-{line}/{k:02}");
                b.add_steel_beam(&name, Element::SteelGirder, corners, BeamDirection::Along, plates);
            }
        }
    }

    /// Returns the heights of the webs' lower and upper edges in meters.
    fn web_z_m(&self) -> (f64, f64) {
        (self.girder_bottom_z_m() + self.flange_m, self.girder_top_z_m() - self.flange_m)
    }

    /// Adds cross-frames between the girders, and the stiffeners that connect them to the webs. Bearing stiffeners are on both sides of
    /// every web.
    fn cross_frames(&self, b: &mut MemberBuilder) {
        let stations: Vec<Station> = self.runs().iter().flat_map(|run| self.stations(run)).collect();
        let count = self.girder_lines().len();
        for (k, station) in stations.iter().enumerate() {
            for (line, y) in self.numbered_lines() {
                if line > 1 || station.at_bearings {
                    self.stiffener(b, &format!("stiffener-{line}/{k:02}-left"), *station, (y, 1.0));
                }
                if line < count || station.at_bearings {
                    self.stiffener(b, &format!("stiffener-{line}/{k:02}-right"), *station, (y, -1.0));
                }
                if line < count {
                    self.cross_frame(b, &format!("cross-frame-{line}/{k:02}"), *station, y);
                }
            }
        }
    }

    fn stiffener(&self, b: &mut MemberBuilder, name: &str, station: Station, (y, side): (f64, f64)) {
        let half = 0.5 * stiffener_thickness_m(station);
        let (web, (low, high)) = (0.5 * self.web_m, self.web_z_m());
        let edge = web + STIFFENER_SHARE * (0.5 * self.flange_width_m - web);
        let (near, far) = math::range([y + side * web, y + side * edge].into_iter());
        b.add_box(name, Element::SteelGirder, [station.x_m - half, near, low], [station.x_m + half, far, high]);
    }

    /// Adds a cross-frame between the girder at `left` and the next one: two chords on one side of the stiffeners, and two diagonals, one
    /// on each side.
    fn cross_frame(&self, b: &mut MemberBuilder, name: &str, station: Station, left: f64) {
        let (low, high) = self.web_z_m();
        let (chord, diagonal) = (BAR_HEIGHTS_M.0, BAR_HEIGHTS_M.1.min(DIAGONAL_HEIGHT_SHARE * self.web_depth_m));
        let right = left - self.girder_spacing_m;
        let inset = 0.5 * self.web_m + BAR_GAP_M;
        let face = 0.5 * stiffener_thickness_m(station);
        let (ahead, behind) =
            ((station.x_m + face, station.x_m + face + BAR_M.0), (station.x_m - face - BAR_M.0, station.x_m - face));
        let half = 0.5 * BAR_M.1;
        let mut bar = |part: &str, from_z: f64, to_z: f64, (x_low, x_high): (f64, f64)| {
            let (from, to) = (right + inset, left - inset);
            let profile = [[from, from_z - half], [to, to_z - half], [to, to_z + half], [from, from_z + half]];
            b.add_cross_section(&format!("{name}/{part}"), Element::SteelGirder, &profile, x_low, x_high);
        };
        bar("bottom", low + chord, low + chord, ahead);
        bar("top", high - chord, high - chord, ahead);
        bar("rising", low + diagonal, high - diagonal, ahead);
        bar("falling", high - diagonal, low + diagonal, behind);
    }

    /// Adds bearings and their pedestals. Each run has one fixed row of bearings: on the first pier, or at its start.
    fn bearings(&self, b: &mut MemberBuilder) {
        for run in self.runs() {
            let fixed = usize::from(run.bearings.len() > 2);
            for (k, row) in run.bearings.iter().enumerate() {
                let element = if k == fixed { Element::FixedBearing } else { Element::ElastomericBearing };
                // On a pier with two rows, the girders of the second row begin there.
                let place = if !self.is_continuous() && k == 0 { "-ahead" } else { "" };
                for (line, y) in self.numbered_lines() {
                    self.bearing(b, (row, element), &format!("{place}/{line}"), y);
                }
            }
        }
    }

    fn bearing(&self, b: &mut MemberBuilder, (row, element): (&BearingLine, Element), place: &str, y: f64) {
        let (along, across) = (0.5 * BEARING_LENGTH_M, 0.5 * self.flange_width_m);
        let (bottom, top, seat) = (self.bearing_bottom_z_m(), self.girder_bottom_z_m(), self.seat_z_m());
        let name = format!("bearing-{}{place}", row.support);
        b.add_box(&name, element, [row.x_m - along, y - across, bottom], [row.x_m + along, y + across, top]);
        let below = if self.piers().contains(&row.support) { Element::RcPierCap } else { Element::RcAbutment };
        let (along, across) = (along + PEDESTAL_MARGIN_M, across + PEDESTAL_MARGIN_M);
        let name = format!("pedestal-{}{place}", row.support);
        b.add_box(&name, below, [row.x_m - along, y - across, seat], [row.x_m + along, y + across, bottom]);
    }

    /// Adds a pier: a cap with tapered ends, its columns and their footing.
    fn pier(&self, b: &mut MemberBuilder, pier: usize) {
        let x = self.supports()[pier];
        let (half_width, half_length) = (0.5 * self.cap_width_m, 0.5 * self.cap_length_m());
        let (top, bottom) = (self.seat_z_m(), self.cap_bottom_z_m());
        let columns = self.column_lines();
        let (column, middle) = (0.5 * self.column_m, 0.5 * (top + bottom));
        let reach = columns[columns.len() - 1] + column;
        let profile = [
            [-reach, bottom],
            [reach, bottom],
            [half_length, middle],
            [half_length, top],
            [-half_length, top],
            [-half_length, middle],
        ];
        b.add_cross_section(&format!("cap-{pier}"), Element::RcPierCap, &profile, x - half_width, x + half_width);
        let foot = self.footing_top_z_m();
        for (k, y) in (1..).zip(columns) {
            let name = format!("column-{pier}/{k}");
            if self.round_columns.round() > 0.0 {
                b.add_rod(&name, Element::RcColumn, [x, y, foot], [x, y, bottom], column, ROUND_COLUMN_SIDES);
            } else {
                b.add_box(&name, Element::RcColumn, [x - column, y - column, foot], [x + column, y + column, bottom]);
            }
        }
        let (along, across) = (column + FOOTING_M.1, 0.5 * self.footing_length_m());
        let low = [x - along, -across, foot - FOOTING_M.0];
        b.add_box(&format!("footing-{pier}"), Element::RcFooting, low, [x + along, across, foot]);
    }

    /// Adds the abutment on one side: the stem with the bearing seat, the backwall, the wing walls and the approach slab.
    fn abutment(&self, b: &mut MemberBuilder, name: &str, side: f64) {
        let (seat, half) = (self.seat_z_m(), 0.5 * self.deck_width_m());
        let bottom = seat - self.abutment_m;
        let (front, wall, back, end) =
            (self.abutment_front_x_m(), self.backwall_x_m(), self.backwall_back_x_m(), 0.5 * self.deck_length_m());
        let mut part = |part: &str, element: Element, x: (f64, f64), y: (f64, f64), z: (f64, f64)| {
            let (low, high) = math::range([side * x.0, side * x.1].into_iter());
            b.add_box(part, element, [low, y.0, z.0], [high, y.1, z.1]);
        };
        let stem = (bottom, seat);
        part(&format!("{name}/stem"), Element::RcAbutment, (front, back), (-half, half), stem);
        part(&format!("{name}/backwall"), Element::RcAbutment, (wall, back), (-half, half), (seat, 0.0));
        let under_slab = (bottom, -APPROACH_SLAB_M);
        part(&format!("{name}/wing-left"), Element::RcAbutment, (back, end), (half - WING_WALL_M, half), under_slab);
        part(&format!("{name}/wing-right"), Element::RcAbutment, (back, end), (-half, WING_WALL_M - half), under_slab);
        let slab = name.replace("abutment", "approach-slab");
        part(&slab, Element::RcApproachSlab, (back, end), (-half, half), (-APPROACH_SLAB_M, 0.0));
    }
}

fn stiffener_thickness_m(station: Station) -> f64 {
    if station.at_bearings { BEARING_STIFFENER_M } else { CONNECTION_PLATE_M }
}
