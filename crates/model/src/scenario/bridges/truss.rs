//! Through truss bridge: simple spans of two steel trusses with a polygonal or straight top chord, gusset plates at the panel points and
//! pins at the bearings; portal, sway and lateral bracing; floorbeams, stringers and a concrete deck between the trusses.

use super::beam_bridge::BeamBridge;
use super::beam_layout::{BeamLayout, BearingLayout, DeckLayout, LineLayout, Run, SpanLayout, support_layout};
use super::beam_path;
use super::dimensions::{InconsistencyList, bridge_dimensions};
use super::path::{LocalPath, PathPlace, TaskKind};
use super::quantity::Amounts;
use super::solid::{BeamDirection, MemberBuilder, PlateThickness};
use crate::elements::Element;
use crate::math;

/// Distance from the bearings to the ends of the deck, m (estimate). The gusset plates at the bearings end before it.
const DECK_OVERHANG_M: f64 = 0.8;
/// Side length of the bearings, m (estimate).
const BEARING_M: f64 = 0.6;
/// Minimum height of the bracing above the roadway, m (AASHTO LRFD 2.3.3.2: 17.5 ft).
const CLEARANCE_M: f64 = 5.33;
/// Minimum depth of a truss, as a share of the span (AASHTO LRFD table 2.5.2.6.3-1).
const MIN_DEPTH_SHARE: f64 = 0.1;
/// Width of the posts and diagonals, as a share of the chords' width (estimate: they fit between the gusset plates).
const WEB_WIDTH_SHARE: (f64, f64) = (0.9, 0.8);
/// Depths of posts and diagonals in the plane of the truss, as shares of the chords' depth (estimate).
const WEB_DEPTH_SHARE: (f64, f64) = (0.8, 0.65);
/// Lengths of a gusset plate along and above or below its chord, as multiples of the chord's depth (estimate).
const GUSSET_SHARE: (f64, f64) = (2.6, 2.2);
/// Radius of the pins, and their length beyond the gusset plates, m (estimate).
const PIN_M: (f64, f64) = (0.1, 0.08);
/// Side length of the struts between the trusses, m (estimate).
const STRUT_M: f64 = 0.25;
/// Corner radius of the bracing's diagonals, m (estimate: angles of 4 in).
const BRACE_RADIUS_M: f64 = 0.06;
/// Plate thicknesses of the floorbeams and the stringers, m (estimate: rolled W36 and W18 shapes).
const FLOORBEAM_PLATES: PlateThickness = PlateThickness { flange_m: 0.025, web_m: 0.016 };
const STRINGER_PLATES: PlateThickness = PlateThickness { flange_m: 0.018, web_m: 0.011 };
/// Flange widths of the floorbeams and the stringers, m (estimate).
const FLANGE_M: (f64, f64) = (0.3, 0.19);
/// Minimum space between the deck and the trusses, m (estimate).
const DECK_SPACE_M: f64 = 0.2;
/// Distance between the outer stringers' axes and the deck's edges, m (estimate: room for the drains).
const STRINGER_INSET_M: f64 = 0.9;
/// Minimum space between the stringers' axes, m (estimate).
const MIN_STRINGER_SPACING_M: f64 = 0.6;
/// Factor for the panel length, so that rounding does not add a panel.
const ROUNDING: f64 = 1.0 + 1e-9;
/// Largest distance from the middle to which the camera looks at the floor, as a share of the deck width: views stay inside the gaps between
/// the deck and the trusses.
const VIEW_SHARE: f64 = 0.45;
/// Radius of the turn below the floor, as a share of the distance between the trusses.
const TURN_SHARE: f64 = 0.3;

bridge_dimensions! {
    /// Dimensions of a through truss bridge. Bridge axes: x along the deck, y left, z up, origin on the deck in the middle between the
    /// abutments.
    Truss "truss" {
        spans 1.0 to 6.0, 2.0, "Number of spans; a whole number.";
        span_m 24.0 to 150.0, 54.86, "Length of each span between supports, m; 180 ft (estimate).";
        joint_gap_m 0.03 to 0.15, 0.08, "Width of the expansion joints, m (estimate).";
        panels 4.0 to 20.0, 8.0, "Number of panels of each truss, even; a whole number.";
        depth_m 6.0 to 25.0, 10.0, "Distance between the axes of the chords at midspan, m; at least span/10 (AASHTO LRFD table 2.5.2.6.3-1).";
        hip_depth_m 6.0 to 20.0, 8.2, "Distance between the axes of the chords at the ends of the top chord, m; if it is less than depth_m, the top chord is a polygon (estimate).";
        truss_spacing_m 6.0 to 20.0, 8.8, "Distance between the axes of the trusses, m (estimate).";
        chord_m 0.25 to 0.6, 0.4, "Depth and width of the chords, m (estimate).";
        gusset_m 0.0095 to 0.05, 0.0127, "Thickness of the gusset plates, m; at least 3/8 in (9.5 mm; AASHTO LRFD 6.14.2.8).";
        bracing_depth_m 0.8 to 4.0, 1.5, "Depth of the portal and sway bracing, m (estimate).";
        deck_width_m 5.0 to 18.0, 7.92, "Deck width, m; 26 ft (estimate).";
        slab_m 0.15 to 0.35, 0.2, "Slab thickness, m; 8 to 10 in (estimate).";
        stringers 2.0 to 10.0, 5.0, "Number of stringer lines; 3 to 6 (estimate); a whole number.";
        stringer_depth_m 0.3 to 1.2, 0.46, "Stringer depth, m; 18 in (estimate).";
        floorbeam_depth_m 0.5 to 2.5, 0.92, "Floorbeam depth, m (estimate).";
        railing_m 0.6 to 2.0, 1.07, "Railing height, m; 32 to 42 in (estimate).";
        drain_spacing_m 5.0 to 100.0, 18.0, "Distance between deck drains, m (estimate).";
        bearing_m 0.1 to 0.8, 0.35, "Height of the bearings, m (estimate).";
        pedestal_m 0.1 to 1.0, 0.4, "Height of the pedestals below the bearings, m (estimate).";
        cap_depth_m 0.6 to 3.0, 1.5, "Depth of the pier caps, m (estimate).";
        cap_width_m 0.8 to 5.0, 3.0, "Width of the pier caps along the bridge, m (estimate).";
        columns 1.0 to 6.0, 2.0, "Number of columns per pier; a whole number.";
        column_m 0.5 to 4.0, 1.8, "Side length or diameter of the columns, m (estimate).";
        round_columns 0.0 to 1.0, 1.0, "1 if the columns are round, 0 if they are square; a whole number.";
        column_height_m 2.0 to 60.0, 10.0, "Height of the columns between footing and cap, m (estimate).";
        abutment_m 2.0 to 15.0, 4.0, "Height of the abutments below the bearing seats, m (estimate).";
        approach_m 4.0 to 20.0, 6.0, "Length of the approach slabs and wing walls, m (estimate).";
    }
}

/// A panel point: position along the bridge and height, m.
type Node = [f64; 2];

/// The panel points of a span.
#[derive(Debug, Clone, PartialEq)]
struct PanelPoints {
    /// Points of the lower chord, from bearing to bearing.
    lower: Vec<Node>,
    /// Points of the upper chord above the lower ones, without the first and the last.
    upper: Vec<Node>,
}

impl BeamBridge for Truss {
    const IN_WORDS: &'static str = "a truss bridge";
    const TASK_KINDS: &'static [TaskKind] =
        &[TaskKind::TrussPanel, TaskKind::FloorSystem, TaskKind::BearingLine, TaskKind::PierCap];

    fn layout(&self) -> BeamLayout {
        BeamLayout {
            spans: SpanLayout {
                count: self.spans,
                span_m: self.span_m,
                end_span_m: self.span_m,
                overhang_m: DECK_OVERHANG_M,
                pier_gap_m: Some(self.joint_gap_m),
                has_pier_joints: true,
                joint_gap_m: self.joint_gap_m,
                station_spacing_m: self.span_m / self.panels.round() * ROUNDING,
            },
            lines: LineLayout {
                count: 2.0,
                spacing_m: self.truss_spacing_m,
                haunch_width_m: 0.0,
                top_z_m: -self.slab_m,
                bottom_z_m: self.lower_axis_z_m() - 0.5 * self.chord_m,
                abutment_bottom_z_m: self.lower_axis_z_m() - 0.5 * self.chord_m,
            },
            deck: DeckLayout {
                width_m: self.deck_width_m,
                slab_m: self.slab_m,
                element: Element::RcDeck,
                railing_m: self.railing_m,
                railing: Element::MetalRailing,
                drain_spacing_m: self.drain_spacing_m,
                has_floorbeams: true,
            },
            bearings: BearingLayout {
                height_m: self.bearing_m,
                length_m: BEARING_M,
                width_m: BEARING_M,
                pedestal_m: self.pedestal_m,
                expansion: Element::MovableBearing,
                fixed: Element::FixedBearing,
            },
            supports: support_layout!(self, self.truss_spacing_m + 2.0 * BEARING_M),
        }
    }

    fn require(&self, layout: &BeamLayout, m: &mut InconsistencyList) {
        for (key, value) in [
            ("spans", self.spans),
            ("stringers", self.stringers),
            ("columns", self.columns),
            ("round_columns", self.round_columns),
        ] {
            m.require_integer(key, value);
        }
        m.require_even("panels", self.panels);
        m.require_at_least("depth_m", self.depth_m, MIN_DEPTH_SHARE * self.span_m, "span_m / 10 (AASHTO LRFD table 2.5.2.6.3-1)");
        m.require_at_most("hip_depth_m", self.hip_depth_m, self.depth_m, "no deeper than depth_m");
        let clear_m = CLEARANCE_M + 0.5 * STRUT_M + self.bracing_depth_m - self.lower_axis_z_m();
        m.require_at_least(
            "hip_depth_m",
            self.hip_depth_m,
            clear_m,
            "5.33 m below the bracing (bracing_depth_m, floorbeam_depth_m)",
        );
        let gussets_m = 1.5 * GUSSET_SHARE.0 * self.chord_m * self.panels.round();
        m.require_at_least("span_m", self.span_m, gussets_m, "room for the gusset plates (panels, chord_m)");
        // The spans between bearings are shorter than between supports, but have the same number of panels.
        let panels_m = 2.0 * (DECK_OVERHANG_M + 0.5 * self.joint_gap_m) * self.panels.round() * ROUNDING;
        m.require_at_least(
            "span_m",
            self.span_m,
            panels_m,
            "longer panels than the distance between the bearings on a pier (panels)",
        );
        let between_m = self.truss_spacing_m - self.chord_m - 2.0 * self.gusset_m - 2.0 * DECK_SPACE_M;
        m.require_at_most("deck_width_m", self.deck_width_m, between_m, "room between the trusses (truss_spacing_m, chord_m)");
        m.require_at_least("truss_spacing_m", self.truss_spacing_m, self.span_m / 20.0, "span_m / 20 (estimate)");
        let stringers_m = 2.0 * STRINGER_INSET_M + MIN_STRINGER_SPACING_M * (self.stringers.round() - 1.0);
        m.require_at_least("deck_width_m", self.deck_width_m, stringers_m, "stringers at least 0.6 m apart (stringers)");
        m.require_at_most("stringer_depth_m", self.stringer_depth_m, self.floorbeam_depth_m, "no deeper than the floorbeams");
        m.require_at_least("cap_depth_m", self.cap_depth_m, 0.5 * self.cap_width_m, "half of cap_width_m (estimate)");
        layout.require_pier_room(m, "joint_gap_m", "truss_spacing_m");
    }

    fn add_beams(&self, layout: &BeamLayout, b: &mut MemberBuilder) {
        for (k, run) in (1..).zip(layout.beam_runs()) {
            let points = self.panel_points(layout, &run);
            for (side, y) in [("left", 0.5 * self.truss_spacing_m), ("right", -0.5 * self.truss_spacing_m)] {
                self.add_truss(b, &points, &format!("{k}-{side}"), y);
            }
            self.add_bracing(b, &points, &format!("{k}"));
            self.add_floor(b, layout, &run, k);
        }
    }

    fn add_beam_amounts(&self, layout: &BeamLayout, amounts: &mut Amounts) {
        let spans = self.spans.round();
        let trusses = 2.0 * spans;
        let panels = self.panels.round();
        amounts.add(Element::SteelStringer, self.stringers.round() * layout.beam_length_m());
        amounts.add(
            Element::SteelTruss,
            2.0 * (layout.length_m() - 2.0 * (spans - 1.0) * (DECK_OVERHANG_M + 0.5 * self.joint_gap_m)),
        );
        amounts.add(Element::SteelFloorBeam, spans * (panels + 1.0) * self.floorbeam_length_m());
        amounts.add(Element::Pin, 2.0 * trusses);
        // All plates at one panel point of a truss are one gusset plate (AASHTO MBEI).
        amounts.add(Element::GussetPlate, 2.0 * panels * trusses);
    }

    fn beam_path(
        &self,
        layout: &BeamLayout,
        kind: TaskKind,
        stand_off_m: f64,
        place: &PathPlace,
    ) -> Option<Result<LocalPath, String>> {
        if kind == TaskKind::TrussPanel {
            Some(self.truss_panel(layout, stand_off_m, place))
        } else if kind == TaskKind::FloorSystem {
            let turn_m = TURN_SHARE * self.truss_spacing_m;
            Some(beam_path::below_beams(layout, stand_off_m, place, (turn_m, (VIEW_SHARE * self.deck_width_m - turn_m).max(0.0))))
        } else {
            beam_path::of_kind(layout, kind, stand_off_m, place)
        }
    }
}

// Dimensions that follow from others.
impl Truss {
    /// Returns the height of the lower chords' axes: the floorbeams end at it.
    fn lower_axis_z_m(&self) -> f64 {
        -self.slab_m - self.floorbeam_depth_m
    }

    fn floorbeam_length_m(&self) -> f64 {
        self.truss_spacing_m - self.chord_m - 2.0 * self.gusset_m
    }

    /// Returns the distance from the bridge's axis to the outermost parts of the trusses: the ends of the pins.
    fn outer_y_m(&self) -> f64 {
        0.5 * (self.truss_spacing_m + self.chord_m) + self.gusset_m + PIN_M.1
    }

    /// Returns the panel points of a span. Those of the top chord are on a parabola.
    fn panel_points(&self, layout: &BeamLayout, run: &Run) -> PanelPoints {
        let low = self.lower_axis_z_m();
        let lower: Vec<Node> = layout.stations(run).iter().map(|station| [station.x_m, low]).collect();
        let last = lower.len() - 1;
        let middle = 0.5 * last as f64;
        let depth_m = |k: usize| {
            // From -1 at the first point of the top chord to 1 at its last one.
            let u = if middle > 1.0 { (k as f64 - middle) / (middle - 1.0) } else { 0.0 };
            self.depth_m + (self.hip_depth_m - self.depth_m) * u * u
        };
        let upper = (1..last).map(|k| [lower[k][0], low + depth_m(k)]).collect();
        PanelPoints { lower, upper }
    }
}

// Members.
impl Truss {
    /// Adds a truss at y: chords, end posts, posts, diagonals that fall toward midspan, gusset plates and pins.
    fn add_truss(&self, b: &mut MemberBuilder, points: &PanelPoints, name: &str, y: f64) {
        let PanelPoints { lower, upper } = points;
        let (chord, last) = (self.chord_m, lower.len() - 1);
        let (post, diagonal) = (WEB_WIDTH_SHARE.0 * chord, WEB_WIDTH_SHARE.1 * chord);
        let mut bar = |part: String, ends: (Node, Node), depth_m: f64, width_m: f64| {
            let part = format!("truss-{name}/{part}");
            b.add_bar(&part, Element::SteelTruss, ends, depth_m, (y - 0.5 * width_m, y + 0.5 * width_m));
        };
        for (k, pair) in lower.windows(2).enumerate() {
            bar(format!("bottom-chord/{k:02}"), (pair[0], pair[1]), chord, chord);
        }
        for (k, pair) in upper.windows(2).enumerate() {
            bar(format!("top-chord/{:02}", k + 1), (pair[0], pair[1]), chord, chord);
        }
        bar("end-post/start".into(), (lower[0], upper[0]), chord, chord);
        bar("end-post/end".into(), (upper[last - 2], lower[last]), chord, chord);
        for (k, top) in (1..).zip(upper) {
            bar(format!("post/{k:02}"), (lower[k], *top), WEB_DEPTH_SHARE.0 * chord, post);
        }
        for k in 1..last - 1 {
            let ends = if 2 * k < last { (upper[k - 1], lower[k + 1]) } else { (lower[k], upper[k]) };
            bar(format!("diagonal/{k:02}"), ends, WEB_DEPTH_SHARE.1 * chord, diagonal);
        }
        self.add_gussets(b, points, name, y);
        for (end, [x, z]) in [("start", lower[0]), ("end", lower[last])] {
            let reach = self.outer_y_m() - 0.5 * self.truss_spacing_m;
            let (from, to) = ([x, y - reach, z], [x, y + reach, z]);
            b.add_rod(&format!("pin-{name}/{end}"), Element::Pin, from, to, PIN_M.0, 12);
        }
    }

    /// Adds a pair of gusset plates at every panel point, on both sides of the chords.
    fn add_gussets(&self, b: &mut MemberBuilder, points: &PanelPoints, name: &str, y: f64) {
        let (along, beyond, half) = (0.5 * GUSSET_SHARE.0 * self.chord_m, GUSSET_SHARE.1 * self.chord_m, 0.5 * self.chord_m);
        let lower = points.lower.iter().map(|node| ("lower", node, (-half, beyond - half)));
        let upper = points.upper.iter().map(|node| ("upper", node, (half - beyond, half)));
        let offset = 0.5 * self.chord_m;
        for (k, (chord, [x, z], (below, above))) in lower.chain(upper).enumerate() {
            let profile = [[x - along, z + below], [x + along, z + below], [x + along, z + above], [x - along, z + above]];
            for (side, low) in [("left", y + offset), ("right", y - offset - self.gusset_m)] {
                let part = format!("gusset-{name}/{chord}-{k:02}-{side}");
                b.add_extrusion(&part, Element::GussetPlate, &profile, low, low + self.gusset_m);
            }
        }
    }

    /// Adds the bracing between the trusses: struts and crossed diagonals between the top chords and between the bottom chords, portals
    /// between the end posts, and sway frames between the other posts.
    fn add_bracing(&self, b: &mut MemberBuilder, points: &PanelPoints, name: &str) {
        let PanelPoints { lower, upper } = points;
        let name = format!("bracing-{name}");
        let last = upper.len() - 1;
        for (k, node) in (1..).zip(upper) {
            self.add_strut(b, &format!("{name}/top-strut/{k:02}"), *node);
        }
        for (k, pair) in (1..).zip(upper.windows(2)) {
            self.add_cross(b, &format!("{name}/top/{k:02}"), pair[0], pair[1]);
        }
        for (k, pair) in lower.windows(2).enumerate() {
            self.add_cross(b, &format!("{name}/bottom/{k:02}"), pair[0], pair[1]);
        }
        for (end, foot, hip) in [("start", lower[0], upper[0]), ("end", lower[lower.len() - 1], upper[last])] {
            let share = self.bracing_depth_m / (hip[1] - foot[1]);
            let knee = [hip[0] + share * (foot[0] - hip[0]), hip[1] - self.bracing_depth_m];
            self.add_strut(b, &format!("{name}/portal-{end}/strut"), knee);
            self.add_cross(b, &format!("{name}/portal-{end}/cross"), hip, knee);
        }
        for (k, [x, z]) in (1..).zip(upper).skip(1).take(last.saturating_sub(1)) {
            let knee = [*x, z - self.bracing_depth_m];
            self.add_strut(b, &format!("{name}/sway-{k:02}/strut"), knee);
            self.add_cross(b, &format!("{name}/sway-{k:02}/cross"), [*x, *z], knee);
        }
    }

    /// Adds a strut across the bridge between two trusses.
    fn add_strut(&self, b: &mut MemberBuilder, name: &str, [x, z]: Node) {
        let (half, reach) = (0.5 * STRUT_M, 0.5 * self.truss_spacing_m);
        b.add_box(name, Element::SteelTruss, [x - half, -reach, z - half], [x + half, reach, z + half]);
    }

    /// Adds two crossed diagonals between the trusses, from one point of each truss to another point of the other one.
    fn add_cross(&self, b: &mut MemberBuilder, name: &str, from: Node, to: Node) {
        let reach = 0.5 * self.truss_spacing_m;
        for (part, y) in [("rising", -reach), ("falling", reach)] {
            let ends = ([from[0], y, from[1]], [to[0], -y, to[1]]);
            b.add_rod(&format!("{name}-{part}"), Element::SteelTruss, ends.0, ends.1, BRACE_RADIUS_M, 6);
        }
    }

    /// Adds floorbeams at the panel points, and stringers between and beyond them.
    fn add_floor(&self, b: &mut MemberBuilder, layout: &BeamLayout, run: &Run, span: usize) {
        let soffit = -self.slab_m;
        let (reach, half) = (0.5 * self.floorbeam_length_m(), 0.5 * FLANGE_M.0);
        for (k, station) in layout.stations(run).iter().enumerate() {
            let name = format!("floorbeam-{span}/{k:02}");
            let corners = ([station.x_m - half, -reach, soffit - self.floorbeam_depth_m], [station.x_m + half, reach, soffit]);
            b.add_steel_beam(&name, Element::SteelFloorBeam, corners, BeamDirection::Across, FLOORBEAM_PLATES);
        }
        let half = 0.5 * FLANGE_M.1;
        for (k, (from, to)) in layout.panels(run).into_iter().enumerate() {
            for (line, y) in (1..).zip(self.stringer_lines()) {
                let corners = ([from, y - half, soffit - self.stringer_depth_m], [to, y + half, soffit]);
                let name = format!("stringer-{span}-{line}/{k:02}");
                b.add_steel_beam(&name, Element::SteelStringer, corners, BeamDirection::Along, STRINGER_PLATES);
            }
        }
    }

    /// Returns the positions of the stringers across the bridge.
    fn stringer_lines(&self) -> Vec<f64> {
        let count = self.stringers.round();
        let group_m = self.deck_width_m - 2.0 * STRINGER_INSET_M;
        (0..count as i32).map(|k| 0.5 * group_m - group_m * f64::from(k) / (count - 1.0)).collect()
    }
}

impl PanelPoints {
    /// Returns the height of the end posts and the top chord at a position along the bridge, m.
    fn top_z_m(&self, x_m: f64) -> f64 {
        let (first, last) = (self.lower[0], self.lower[self.lower.len() - 1]);
        let line: Vec<Node> = [first].into_iter().chain(self.upper.iter().copied()).chain([last]).collect();
        let pair = line.windows(2).find(|pair| (pair[0][0]..=pair[1][0]).contains(&x_m));
        pair.map_or(first[1], |pair| math::lerp(pair[0][1], pair[1][1], (x_m - pair[0][0]) / (pair[1][0] - pair[0][0])))
    }
}

impl Truss {
    /// Returns the path along the outside of the right truss of a span: out at a quarter of the height of its first panel point, with a
    /// view of the lower chord, and back at three quarters, with a view of the top chord and the end posts.
    fn truss_panel(&self, layout: &BeamLayout, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String> {
        let (from, to) = beam_path::span_between_stand_offs(layout, stand_off_m, place)?;
        let radius_m = 0.25 * self.hip_depth_m;
        if to - from <= 2.0 * radius_m {
            return Err("a span that is longer than 2 stand_off_m and half of hip_depth_m".into());
        }
        let points = self.panel_points(layout, &layout.beam_runs()[beam_path::span_number(layout, place)? - 1]);
        let (low, away_m) = (self.lower_axis_z_m(), self.outer_y_m() - 0.5 * self.truss_spacing_m + stand_off_m);
        let mut path = LocalPath { points: Vec::new(), viewing_directions: Vec::new(), closed: false };
        for ([x, side], _) in beam_path::out_and_back((from, to), radius_m) {
            let z = low + 2.0 * radius_m - side;
            let share = 0.5 * (1.0 - side / radius_m);
            path.points.push([x, -0.5 * self.truss_spacing_m - away_m, z]);
            path.viewing_directions.push([0.0, away_m, math::lerp(low, points.top_z_m(x), share) - z]);
        }
        Ok(path)
    }
}
