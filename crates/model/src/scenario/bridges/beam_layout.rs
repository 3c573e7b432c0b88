//! Layout of a bridge whose deck lies on parallel beams over piers and seat abutments: spans, lines of beams, deck, bearings and
//! supports. Bridge types with such a deck derive a [`BeamLayout`] from their dimensions. Its members are in `beam_members.rs`, and the
//! reference paths in `beam_path.rs`.

use super::dimensions::InconsistencyList;
use super::quantity::Amounts;
use super::solid::Footing;
use crate::elements::Element;
use crate::math;

/// Width of a pedestal beyond its bearing on each side, m (estimate).
pub(super) const PEDESTAL_MARGIN_M: f64 = 0.1;
/// Distance from a pedestal to the edge of its cap or abutment, m (estimate).
const SEAT_MARGIN_M: f64 = 0.1;
/// Widths of a single-slope barrier at its foot and at its top, m (estimate).
pub(super) const BARRIER_WIDTH_M: (f64, f64) = (0.4, 0.2);
/// Distance between a walkway's axis and the barrier, m (estimate: half of a person's width and a margin).
const WALKWAY_MARGIN_M: f64 = 0.45;
/// Corner radius of the drain pipes, and their distance from the barriers, m (estimate).
pub(super) const DRAIN_M: (f64, f64) = (0.08, 0.04);
/// Length of the caps beyond the outer beams' axes, m (estimate).
const CAP_END_M: f64 = 0.6;
/// Depth of the footings, and their length beyond the columns, m (estimate).
pub(super) const FOOTING_M: (f64, f64) = (1.2, 0.8);
/// Thickness of the backwalls, m (estimate).
const BACKWALL_M: f64 = 0.5;
/// Minimum space between columns, and minimum length of the caps beyond them, m (estimate).
const COLUMN_SPACE_M: f64 = 0.5;
/// Minimum and maximum deck width, m: those of the other bridge types.
pub(super) const DECK_WIDTH_M: (f64, f64) = (5.0, 40.0);

/// Spans, and what separates their beams. Lengths along the bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpanLayout {
    /// Number of spans.
    pub count: f64,
    /// Length of the spans between supports, m, except for the first and the last of several spans.
    pub span_m: f64,
    /// Length of the first and the last of several spans, m.
    pub end_span_m: f64,
    /// Distance from the outermost bearings of a beam to its ends, m.
    pub overhang_m: f64,
    /// Gap between the beams of two spans above a pier, m; `None` if they are continuous.
    pub pier_gap_m: Option<f64>,
    /// Whether the deck has joints above the piers.
    pub has_pier_joints: bool,
    /// Width of the joints at the abutments, m.
    pub joint_gap_m: f64,
    /// Maximum distance between cross-sections with cross-frames, diaphragms or floorbeams, m.
    pub station_spacing_m: f64,
}

/// Lines of beams across the bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineLayout {
    /// Number of lines.
    pub count: f64,
    /// Distance between them, m.
    pub spacing_m: f64,
    /// Width of the deck's haunches above the beams, m.
    pub haunch_width_m: f64,
    /// Height of the beams' tops, m.
    pub top_z_m: f64,
    /// Height of the beams' undersides, m; above the piers if the depth varies.
    pub bottom_z_m: f64,
    /// Height of the beams' undersides at the abutments, m.
    pub abutment_bottom_z_m: f64,
}

/// Deck of a beam bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DeckLayout {
    /// Width, m.
    pub width_m: f64,
    /// Thickness of the slab, m.
    pub slab_m: f64,
    /// Element of the slab: a deck, or the top flange of a box girder.
    pub element: Element,
    /// Height of the barriers or railings, m.
    pub railing_m: f64,
    /// Element of the railings: barriers of reinforced concrete, or posts and rails of another material.
    pub railing: Element,
    /// Distance between drains, m.
    pub drain_spacing_m: f64,
    /// Whether floorbeams cross the bridge at the stations, so that the drains are between them.
    pub has_floorbeams: bool,
}

/// Bearings of a beam bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BearingLayout {
    /// Height, m.
    pub height_m: f64,
    /// Length along the bridge, m.
    pub length_m: f64,
    /// Width across the bridge, m.
    pub width_m: f64,
    /// Height of the pedestals below the bearings, m.
    pub pedestal_m: f64,
    /// Element of the bearings that let the beams move along the bridge.
    pub expansion: Element,
    /// Element of the other bearings: one row for each run of beams.
    pub fixed: Element,
}

/// Piers and abutments of a beam bridge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupportLayout {
    /// Depth of the pier caps, m.
    pub cap_depth_m: f64,
    /// Width of the pier caps along the bridge, m.
    pub cap_width_m: f64,
    /// Number of columns for each pier.
    pub columns: f64,
    /// Side length or diameter of the columns, m.
    pub column_m: f64,
    /// Whether the columns are round.
    pub has_round_columns: bool,
    /// Height of the columns between footing and cap, m.
    pub column_height_m: f64,
    /// Height of the abutments below the bearing seats, m.
    pub abutment_m: f64,
    /// Width of the abutments across the bridge, m.
    pub abutment_width_m: f64,
    /// Length of the approach slabs and wing walls, m.
    pub approach_m: f64,
}

/// Returns the piers and abutments of a beam bridge from its dimensions, which have the same keys in all types, and the width of its
/// abutments.
macro_rules! support_layout {
    ($bridge:expr, $abutment_width_m:expr) => {
        $crate::scenario::bridges::beam_layout::SupportLayout {
            cap_depth_m: $bridge.cap_depth_m,
            cap_width_m: $bridge.cap_width_m,
            columns: $bridge.columns,
            column_m: $bridge.column_m,
            has_round_columns: $bridge.round_columns.round() > 0.0,
            column_height_m: $bridge.column_height_m,
            abutment_m: $bridge.abutment_m,
            abutment_width_m: $abutment_width_m,
            approach_m: $bridge.approach_m,
        }
    };
}
pub(super) use support_layout;

/// Layout of a beam bridge. Bridge axes: x along the deck, y left, z up, origin on the deck in the middle between the abutments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamLayout {
    /// Spans.
    pub spans: SpanLayout,
    /// Lines of beams.
    pub lines: LineLayout,
    /// Deck.
    pub deck: DeckLayout,
    /// Bearings.
    pub bearings: BearingLayout,
    /// Piers and abutments.
    pub supports: SupportLayout,
}

/// A part of the beams or of the deck without a gap or joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Start of the run, m.
    pub start_x_m: f64,
    /// End of the run, m.
    pub end_x_m: f64,
    /// Rows of bearings on which it lies.
    pub bearings: Vec<BearingRow>,
}

/// The bearings of one run on one support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BearingRow {
    /// Number of the support.
    pub support: usize,
    /// Position along the bridge, m.
    pub x_m: f64,
}

/// A cross-section with cross-frames, diaphragms or floorbeams.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Position along the bridge, m.
    pub x_m: f64,
    /// Whether the section is above bearings.
    pub at_bearings: bool,
}

// Positions along the bridge.
impl BeamLayout {
    /// Returns the lengths of the spans in meters.
    #[must_use]
    pub fn span_lengths_m(&self) -> Vec<f64> {
        let SpanLayout { count, span_m, end_span_m, .. } = self.spans;
        let last = count.round() as usize - 1;
        (0..=last).map(|k| if last > 0 && (k == 0 || k == last) { end_span_m } else { span_m }).collect()
    }

    /// Returns the distance between the abutments' bearings in meters.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.span_lengths_m().iter().sum()
    }

    /// Returns the positions of the abutments' bearings and of the piers' axes, from the start to the end.
    #[must_use]
    pub fn support_positions(&self) -> Vec<f64> {
        let start = -0.5 * self.length_m();
        let mut out = vec![start];
        for span_m in self.span_lengths_m() {
            out.push(out[out.len() - 1] + span_m);
        }
        out
    }

    /// Returns the numbers of the supports that are piers.
    #[must_use]
    pub fn piers(&self) -> std::ops::Range<usize> {
        1..self.span_lengths_m().len()
    }

    /// Returns the distance from the middle to the ends of the beams, in meters.
    #[must_use]
    pub fn beam_end_x_m(&self) -> f64 {
        0.5 * self.length_m() + self.spans.overhang_m
    }

    /// Returns the distance from the middle to the joints' ends at the backwalls, in meters.
    #[must_use]
    pub fn backwall_x_m(&self) -> f64 {
        self.beam_end_x_m() + self.spans.joint_gap_m
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
        0.5 * self.bearings.length_m + PEDESTAL_MARGIN_M
    }

    /// Returns the deck length in meters, including the backwalls and the approach slabs.
    #[must_use]
    pub fn deck_length_m(&self) -> f64 {
        2.0 * (self.backwall_back_x_m() + self.supports.approach_m)
    }

    /// Returns the distance of the bearings from a pier's axis in meters.
    fn pier_offset_m(&self) -> f64 {
        self.spans.pier_gap_m.map_or(0.0, |gap_m| self.spans.overhang_m + 0.5 * gap_m)
    }

    /// Returns the distance from the fronts of a support's bearings to the edge of its cap or abutment in the direction of the nearer
    /// span, in meters.
    #[must_use]
    pub fn bearing_setback_m(&self, support: usize) -> f64 {
        let is_pier = self.piers().contains(&support);
        let edge_m = if is_pier { 0.5 * self.supports.cap_width_m - self.pier_offset_m() } else { self.abutment_seat_m() };
        edge_m - 0.5 * self.bearings.length_m
    }

    /// Returns the steepest slope at which the middle of a bearing's front is visible from below, past the edges of its pedestal and of
    /// the cap or abutment.
    #[must_use]
    pub fn bearing_sight_slope(&self, support: usize) -> f64 {
        let middle_m = 0.5 * self.bearings.height_m;
        (middle_m / PEDESTAL_MARGIN_M).min((self.bearings.pedestal_m + middle_m) / self.bearing_setback_m(support))
    }

    /// Returns the position of the fronts of a support's bearings: at the first abutment the sides toward the first span, at all other
    /// supports the sides toward the span before them.
    #[must_use]
    pub fn bearing_front_x_m(&self, support: usize) -> f64 {
        let offset_m = if self.piers().contains(&support) { self.pier_offset_m() } else { 0.0 };
        let half_m = 0.5 * self.bearings.length_m;
        self.support_positions()[support] - offset_m + if support == 0 { half_m } else { -half_m }
    }

    /// Returns the runs of beams from the start to the end.
    #[must_use]
    pub fn beam_runs(&self) -> Vec<Run> {
        let (supports, end) = (self.support_positions(), self.beam_end_x_m());
        let last = supports.len() - 1;
        let Some(gap_m) = self.spans.pier_gap_m else {
            let bearings = supports.iter().enumerate().map(|(support, x_m)| BearingRow { support, x_m: *x_m }).collect();
            return vec![Run { start_x_m: -end, end_x_m: end, bearings }];
        };
        let (offset_m, half_gap_m) = (self.pier_offset_m(), 0.5 * gap_m);
        let run = |k: usize| {
            let (from, to) = (supports[k], supports[k + 1]);
            let (start_x_m, first) = if k == 0 { (-end, from) } else { (from + half_gap_m, from + offset_m) };
            let (end_x_m, second) = if k + 1 == last { (end, to) } else { (to - half_gap_m, to - offset_m) };
            let bearings = vec![BearingRow { support: k, x_m: first }, BearingRow { support: k + 1, x_m: second }];
            Run { start_x_m, end_x_m, bearings }
        };
        (0..last).map(run).collect()
    }

    /// Returns the runs of the deck from the start to the end, with all rows of bearings below each.
    #[must_use]
    pub fn deck_runs(&self) -> Vec<Run> {
        let runs = self.beam_runs();
        if self.spans.has_pier_joints || runs.len() == 1 {
            return runs;
        }
        let end = self.beam_end_x_m();
        vec![Run { start_x_m: -end, end_x_m: end, bearings: runs.into_iter().flat_map(|run| run.bearings).collect() }]
    }

    /// Returns the stations of a run: at all bearings, and at equal distances between those of a span.
    #[must_use]
    pub fn stations(&self, run: &Run) -> Vec<Station> {
        let mut out = vec![Station { x_m: run.bearings[0].x_m, at_bearings: true }];
        for pair in run.bearings.windows(2) {
            let (from, to) = (pair[0].x_m, pair[1].x_m);
            // The two rows of bearings on one pier have nothing between them.
            let is_span = pair[0].support != pair[1].support;
            let count = if is_span { ((to - from) / self.spans.station_spacing_m).ceil().max(1.0) as i32 } else { 1 };
            let at = |k: i32| if k == count { to } else { from + (to - from) * f64::from(k) / f64::from(count) };
            out.extend((1..=count).map(|k| Station { x_m: at(k), at_bearings: k == count }));
        }
        out
    }

    /// Returns the ends of the panels of a run between stations, and of those beyond the outermost bearings.
    #[must_use]
    pub fn panels(&self, run: &Run) -> Vec<(f64, f64)> {
        let mut ends = vec![run.start_x_m];
        ends.extend(self.stations(run).iter().map(|station| station.x_m));
        ends.push(run.end_x_m);
        ends.windows(2).map(|pair| (pair[0], pair[1])).collect()
    }

    /// Returns the panels of the beams.
    #[must_use]
    pub fn beam_panels(&self) -> Vec<(f64, f64)> {
        self.beam_runs().iter().flat_map(|run| self.panels(run)).collect()
    }

    /// Returns the panels of the deck.
    #[must_use]
    pub fn deck_panels(&self) -> Vec<(f64, f64)> {
        self.deck_runs().iter().flat_map(|run| self.panels(run)).collect()
    }

    /// Returns the stations of all beams.
    #[must_use]
    pub fn beam_stations(&self) -> Vec<Station> {
        self.beam_runs().iter().flat_map(|run| self.stations(run)).collect()
    }

    /// Returns the positions of the drains along the bridge. There are none above the piers.
    #[must_use]
    pub fn drains(&self) -> Vec<f64> {
        let supports = self.support_positions();
        let piers: Vec<f64> = self.piers().map(|pier| supports[pier]).collect();
        let of_run = |run: &Run| {
            let length_m = run.end_x_m - run.start_x_m;
            let count = (length_m / self.deck.drain_spacing_m).floor();
            let start_x_m = run.start_x_m;
            (0..count as i32).map(move |k| start_x_m + length_m * (f64::from(k) + 0.5) / count)
        };
        let is_clear = |x: &f64| piers.iter().all(|pier| (x - pier).abs() > self.supports.cap_width_m);
        let panels = if self.deck.has_floorbeams { self.deck_panels() } else { Vec::new() };
        let between = |x: f64| {
            let panel = panels.iter().find(|(from, to)| (*from..*to).contains(&x));
            panel.map_or(x, |(from, to)| 0.5 * (from + to))
        };
        self.deck_runs().iter().flat_map(of_run).map(between).filter(is_clear).collect()
    }

    /// Returns the joints' positions: name, start and end along the bridge.
    #[must_use]
    pub fn joints(&self) -> Vec<(String, f64, f64)> {
        let (end, wall) = (self.beam_end_x_m(), self.backwall_x_m());
        let mut out = vec![("joint-start".to_owned(), -wall, -end)];
        let runs = self.deck_runs();
        let at_pier = |(k, pair): (usize, &[Run])| (format!("joint-pier-{}", k + 1), pair[0].end_x_m, pair[1].start_x_m);
        out.extend(runs.windows(2).enumerate().map(at_pier));
        out.push(("joint-end".to_owned(), end, wall));
        out
    }
}

// Positions across the bridge.
impl BeamLayout {
    /// Returns the distance between the axes of the outer beams in meters.
    #[must_use]
    pub fn beam_group_m(&self) -> f64 {
        (self.lines.count.round() - 1.0) * self.lines.spacing_m
    }

    /// Returns the positions of the beams across the bridge, from the left to the right.
    #[must_use]
    pub fn beam_lines(&self) -> Vec<f64> {
        let count = self.lines.count.round() as i32;
        (0..count).map(|k| 0.5 * self.beam_group_m() - f64::from(k) * self.lines.spacing_m).collect()
    }

    /// Returns the beams' numbers, from 1 on the left, and their positions across the bridge.
    pub fn numbered_lines(&self) -> impl Iterator<Item = (usize, f64)> + use<> {
        (1..).zip(self.beam_lines())
    }

    /// Returns whether the railings are closed barriers.
    #[must_use]
    pub fn has_barriers(&self) -> bool {
        self.deck.railing == Element::RcRailing
    }

    /// Returns the distance of the walkways from the deck's centerline in meters: along the barriers.
    #[must_use]
    pub fn walkway_y_m(&self) -> f64 {
        0.5 * self.deck.width_m - BARRIER_WIDTH_M.0 - WALKWAY_MARGIN_M
    }

    /// Returns the distance of the drain pipes from the deck's centerline in meters.
    pub(super) fn drain_y_m(&self) -> f64 {
        0.5 * self.deck.width_m - BARRIER_WIDTH_M.0 - DRAIN_M.0 - DRAIN_M.1
    }

    /// Returns the length of a cap across the bridge in meters.
    #[must_use]
    pub fn cap_length_m(&self) -> f64 {
        self.beam_group_m() + 2.0 * CAP_END_M
    }

    /// Returns the positions of a pier's columns across the bridge.
    pub(super) fn column_lines(&self) -> Vec<f64> {
        let (count, each_m) = (self.supports.columns.round(), self.cap_length_m() / self.supports.columns.round());
        (0..count as i32).map(|k| (f64::from(k) - 0.5 * (count - 1.0)) * each_m).collect()
    }

    /// Returns half the width of a footing along the bridge in meters.
    pub(super) fn footing_half_width_m(&self) -> f64 {
        0.5 * self.supports.column_m + FOOTING_M.1
    }

    /// Returns the length of a footing across the bridge in meters.
    pub(super) fn footing_length_m(&self) -> f64 {
        let between_m = self.cap_length_m() * (1.0 - 1.0 / self.supports.columns.round());
        between_m + self.supports.column_m + 2.0 * FOOTING_M.1
    }
}

// Heights.
impl BeamLayout {
    /// Returns the height of the beams' undersides at a support in meters.
    #[must_use]
    pub fn beam_bottom_z_m(&self, support: usize) -> f64 {
        if self.piers().contains(&support) { self.lines.bottom_z_m } else { self.lines.abutment_bottom_z_m }
    }

    /// Returns the height of the undersides of a support's bearings in meters.
    pub(super) fn bearing_bottom_z_m(&self, support: usize) -> f64 {
        self.beam_bottom_z_m(support) - self.bearings.height_m
    }

    /// Returns the height of the top of a support's cap or abutment, below the pedestals, in meters.
    #[must_use]
    pub fn seat_z_m(&self, support: usize) -> f64 {
        self.bearing_bottom_z_m(support) - self.bearings.pedestal_m
    }

    /// Returns the height of the tops of the piers' caps in meters.
    #[must_use]
    pub fn cap_top_z_m(&self) -> f64 {
        self.lines.bottom_z_m - self.bearings.height_m - self.bearings.pedestal_m
    }

    /// Returns the height of the caps' undersides in meters.
    #[must_use]
    pub fn cap_bottom_z_m(&self) -> f64 {
        self.cap_top_z_m() - self.supports.cap_depth_m
    }

    /// Returns the height of the footings' tops in meters.
    #[must_use]
    pub fn footing_top_z_m(&self) -> f64 {
        self.cap_bottom_z_m() - self.supports.column_height_m
    }
}

// Checks, quantities and footings.
impl BeamLayout {
    /// Requires a deck of a common width with room for barriers and drains beside the outer beams. `beam_m` is the width of a beam, which
    /// the given key determines.
    pub(super) fn require_deck_room(&self, m: &mut InconsistencyList, overhang_m: f64, (beam_m, key): (f64, &str)) {
        let bays = self.lines.count.round() - 1.0;
        let spacing_m = |deck_m: f64| (deck_m - 2.0 * overhang_m) / bays;
        let beside_m = 0.5 * beam_m + BARRIER_WIDTH_M.0 + DRAIN_M.1 + 2.0 * DRAIN_M.0;
        let (low_m, high_m) = DECK_WIDTH_M;
        let spacing = self.lines.spacing_m;
        m.require_at_least("girder_spacing_m", spacing, spacing_m(low_m), "a deck at least 5 m wide (girders, overhang_m)");
        m.require_at_most("girder_spacing_m", spacing, spacing_m(high_m), "a deck at most 40 m wide (girders, overhang_m)");
        m.require_at_least("overhang_m", overhang_m, beside_m, &format!("room for barrier and drains ({key})"));
        m.require_at_most("overhang_m", overhang_m, spacing, "no wider than girder_spacing_m");
    }

    /// Requires spans of at most this length. With one span, only `span_m` counts, and with two, only `end_span_m`.
    pub(super) fn require_spans_at_most(&self, m: &mut InconsistencyList, longest_m: f64, why: &str) {
        if self.piers().len() != 1 {
            m.require_at_most("span_m", self.spans.span_m, longest_m, why);
        }
        if !self.piers().is_empty() {
            m.require_at_most("end_span_m", self.spans.end_span_m, longest_m, why);
        }
    }

    /// Requires room for the bearings on the caps, and for the columns below them. `gap_keys` are the keys that determine the distance
    /// between the rows of bearings, and `line_keys` those that determine the length of the caps.
    pub(super) fn require_pier_room(&self, m: &mut InconsistencyList, gap_keys: &str, line_keys: &str) {
        let SupportLayout { cap_width_m, columns, column_m, .. } = self.supports;
        let seat_m = 2.0 * (self.pier_offset_m() + self.pedestal_half_length_m() + SEAT_MARGIN_M);
        let each_m = self.cap_length_m() / columns.round() - COLUMN_SPACE_M;
        m.require_at_least("cap_width_m", cap_width_m, seat_m, &format!("room for the bearings ({gap_keys})"));
        m.require_at_most("column_m", column_m, cap_width_m, "no wider than the cap (cap_width_m)");
        m.require_at_most("column_m", column_m, each_m, &format!("room for all columns (columns, {line_keys})"));
    }

    /// Returns the length of all beams of one line, in meters.
    #[must_use]
    pub fn beam_length_m(&self) -> f64 {
        self.beam_runs().iter().map(|run| run.end_x_m - run.start_x_m).sum()
    }

    /// Returns the quantities of the elements, except for the beams.
    pub(super) fn amounts(&self) -> Amounts {
        let SupportLayout { columns, approach_m, abutment_width_m, .. } = self.supports;
        let (piers, width_m) = (self.piers().len() as f64, self.deck.width_m);
        let (runs, lines) = (self.beam_runs(), self.lines.count.round());
        let deck_m: f64 = self.deck_runs().iter().map(|run| run.end_x_m - run.start_x_m).sum();
        let fixed = runs.len() as f64 * lines;
        let bearings = runs.iter().map(|run| run.bearings.len() as f64).sum::<f64>() * lines;
        let mut amounts = Amounts::default();
        amounts.add(self.deck.element, deck_m * width_m);
        amounts.add(Element::RcColumn, piers * columns.round());
        amounts.add(Element::RcAbutment, 2.0 * (abutment_width_m + 2.0 * approach_m));
        amounts.add(Element::RcFooting, piers * self.footing_length_m());
        amounts.add(Element::RcPierCap, piers * self.cap_length_m());
        amounts.add(Element::StripSealJoint, self.joints().len() as f64 * width_m);
        amounts.add(self.bearings.expansion, bearings - fixed);
        amounts.add(self.bearings.fixed, fixed);
        amounts.add(Element::RcApproachSlab, 2.0 * approach_m * width_m);
        amounts.add(self.deck.railing, 2.0 * self.deck_length_m());
        amounts
    }

    /// Returns the footings of piers and abutments.
    #[must_use]
    pub fn footings(&self) -> Vec<Footing> {
        let supports = self.support_positions();
        let half = 0.5 * self.supports.abutment_width_m;
        let (front, back) = (self.abutment_front_x_m(), 0.5 * self.deck_length_m());
        let abutment = |side: f64| Footing {
            x_m: math::range([side * front, side * back].into_iter()),
            y_m: (-half, half),
            up_m: self.seat_z_m(0) - self.supports.abutment_m,
        };
        let pier = |k: usize| {
            let (along, across) = (self.footing_half_width_m(), 0.5 * self.footing_length_m());
            let up_m = self.footing_top_z_m() - FOOTING_M.0;
            Footing { x_m: (supports[k] - along, supports[k] + along), y_m: (-across, across), up_m }
        };
        [abutment(-1.0), abutment(1.0)].into_iter().chain(self.piers().map(pier)).collect()
    }
}
