//! Multi-span steel I-girder bridge: plate girders with cross-frames under a concrete deck, on piers with columns and caps and on
//! seat abutments.
//!
//! The default dimensions are those of a published design, where it states them: FHWA, *Steel Bridge Design Handbook*, Design
//! Example 1 (FHWA-IF-12-052, volume 20, 2012): spans of 140, 175 and 140 ft, four girders.

use super::beam_bridge::BeamBridge;
use super::beam_layout::{BeamLayout, BearingLayout, DeckLayout, LineLayout, SpanLayout, Station, support_layout};
use super::dimensions::{InconsistencyList, bridge_dimensions};
use super::quantity::Amounts;
use super::solid::{BeamDirection, MemberBuilder, PlateThickness};
use crate::elements::Element;
use crate::math;

/// Distance from the outermost bearings to the end of the girders and the deck, m (estimate).
const END_OVERHANG_M: f64 = 0.4;
/// Length of a bearing along the bridge, m (estimate). It is as wide as the flange.
const BEARING_LENGTH_M: f64 = 0.4;
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

impl BeamBridge for Girder {
    const IN_WORDS: &'static str = "a girder bridge";

    fn layout(&self) -> BeamLayout {
        let is_continuous = self.simple_spans.round() < 1.0;
        let group_m = (self.girders.round() - 1.0) * self.girder_spacing_m;
        let width_m = group_m + 2.0 * self.overhang_m;
        let top_z_m = -self.slab_m - self.haunch_m;
        BeamLayout {
            spans: SpanLayout {
                count: self.spans,
                span_m: self.span_m,
                end_span_m: self.end_span_m,
                overhang_m: END_OVERHANG_M,
                pier_gap_m: (!is_continuous).then_some(self.joint_gap_m),
                has_pier_joints: !is_continuous,
                joint_gap_m: self.joint_gap_m,
                station_spacing_m: self.cross_frame_spacing_m,
            },
            lines: LineLayout {
                count: self.girders,
                spacing_m: self.girder_spacing_m,
                haunch_width_m: self.flange_width_m,
                top_z_m,
                bottom_z_m: top_z_m - self.web_depth_m - 2.0 * self.flange_m,
                abutment_bottom_z_m: top_z_m - self.web_depth_m - 2.0 * self.flange_m,
            },
            deck: DeckLayout {
                width_m,
                slab_m: self.slab_m,
                element: Element::RcDeck,
                railing_m: self.barrier_m,
                railing: Element::RcRailing,
                drain_spacing_m: self.drain_spacing_m,
                has_floorbeams: false,
            },
            bearings: BearingLayout {
                height_m: self.bearing_m,
                length_m: BEARING_LENGTH_M,
                width_m: self.flange_width_m,
                pedestal_m: self.pedestal_m,
                expansion: Element::ElastomericBearing,
                fixed: Element::FixedBearing,
            },
            supports: support_layout!(self, width_m),
        }
    }

    /// Requires all plates to meet the proportion limits of AASHTO LRFD, and all members to have a support and room.
    fn require(&self, layout: &BeamLayout, m: &mut InconsistencyList) {
        for (key, value) in [
            ("spans", self.spans),
            ("simple_spans", self.simple_spans),
            ("girders", self.girders),
            ("columns", self.columns),
            ("round_columns", self.round_columns),
        ] {
            m.require_integer(key, value);
        }
        layout.require_deck_room(m, self.overhang_m, (self.flange_width_m, "flange_width_m"));
        let half_spacing_m = 0.5 * self.girder_spacing_m;
        m.require_at_most("flange_width_m", self.flange_width_m, half_spacing_m, "half of girder_spacing_m");
        layout.require_pier_room(m, "simple_spans, joint_gap_m", "girders, girder_spacing_m");
        self.require_proportions(layout, m);
    }

    fn add_beams(&self, layout: &BeamLayout, b: &mut MemberBuilder) {
        self.add_girders(layout, b);
        self.add_cross_frames(layout, b);
    }

    fn add_beam_amounts(&self, layout: &BeamLayout, amounts: &mut Amounts) {
        amounts.add(Element::SteelGirder, layout.beam_length_m() * self.girders.round());
    }
}

impl Girder {
    /// Requires the proportion limits of AASHTO LRFD 6.10.2 for webs and flanges, and a web that is not too flat for the spans.
    fn require_proportions(&self, layout: &BeamLayout, m: &mut InconsistencyList) {
        let longest_m = layout.span_lengths_m().into_iter().fold(0.0, f64::max);
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

    fn add_girders(&self, layout: &BeamLayout, b: &mut MemberBuilder) {
        let plates = PlateThickness { flange_m: self.flange_m, web_m: self.web_m };
        let (half, low, high) = (0.5 * self.flange_width_m, layout.lines.bottom_z_m, layout.lines.top_z_m);
        for (line, y) in layout.numbered_lines() {
            for (k, (from, to)) in layout.beam_panels().into_iter().enumerate() {
                let corners = ([from, y - half, low], [to, y + half, high]);
                let name = format!("girder-{line}/{k:02}");
                b.add_steel_beam(&name, Element::SteelGirder, corners, BeamDirection::Along, plates);
            }
        }
    }

    /// Returns the heights of the webs' lower and upper edges in meters.
    fn web_z_m(&self, layout: &BeamLayout) -> (f64, f64) {
        (layout.lines.bottom_z_m + self.flange_m, layout.lines.top_z_m - self.flange_m)
    }

    /// Adds cross-frames between the girders, and the stiffeners that connect them to the webs. Bearing stiffeners are on both sides of
    /// every web.
    fn add_cross_frames(&self, layout: &BeamLayout, b: &mut MemberBuilder) {
        let count = layout.beam_lines().len();
        let web_z_m = self.web_z_m(layout);
        for (k, station) in layout.beam_stations().iter().enumerate() {
            for (line, y) in layout.numbered_lines() {
                if line > 1 || station.at_bearings {
                    self.add_stiffener(b, &format!("stiffener-{line}/{k:02}-left"), *station, (y, 1.0), web_z_m);
                }
                if line < count || station.at_bearings {
                    self.add_stiffener(b, &format!("stiffener-{line}/{k:02}-right"), *station, (y, -1.0), web_z_m);
                }
                if line < count {
                    self.add_cross_frame(b, &format!("cross-frame-{line}/{k:02}"), *station, y, web_z_m);
                }
            }
        }
    }

    fn add_stiffener(&self, b: &mut MemberBuilder, name: &str, station: Station, (y, side): (f64, f64), (low, high): (f64, f64)) {
        let half = 0.5 * stiffener_thickness_m(station);
        let web = 0.5 * self.web_m;
        let edge = web + STIFFENER_SHARE * (0.5 * self.flange_width_m - web);
        let (near, far) = math::range([y + side * web, y + side * edge].into_iter());
        b.add_box(name, Element::SteelGirder, [station.x_m - half, near, low], [station.x_m + half, far, high]);
    }

    /// Adds a cross-frame between the girder at `left` and the next one: two chords on one side of the stiffeners, and two diagonals, one
    /// on each side.
    fn add_cross_frame(&self, b: &mut MemberBuilder, name: &str, station: Station, left: f64, (low, high): (f64, f64)) {
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
}

fn stiffener_thickness_m(station: Station) -> f64 {
    if station.at_bearings { BEARING_STIFFENER_M } else { CONNECTION_PLATE_M }
}
