//! Members that beam bridges share: deck, barriers, drains, bearings, piers and abutments.

use super::beam_layout::{BARRIER_WIDTH_M, BeamLayout, BearingRow, DRAIN_M, FOOTING_M, PEDESTAL_MARGIN_M};
use super::railing::add_railing;
use super::solid::MemberBuilder;
use crate::elements::Element;
use crate::math;

/// Height of a joint seal, and its depth below the road surface, m (estimate).
const JOINT_SEAL_M: (f64, f64) = (0.1, 0.02);
/// Thickness of the wing walls and approach slabs, m (estimate).
const WING_WALL_M: f64 = 0.4;
const APPROACH_SLAB_M: f64 = 0.3;
/// Number of sides of a round column (estimate: its outline is within 2% of the circle).
const ROUND_COLUMN_SIDES: u32 = 16;

impl BeamLayout {
    /// Adds slab, haunches, joints and drains.
    pub(super) fn add_deck(&self, b: &mut MemberBuilder) {
        let (half, soffit) = (0.5 * self.deck.width_m, -self.deck.slab_m);
        for (k, (from, to)) in self.deck_panels().into_iter().enumerate() {
            b.add_box(&format!("slab/{k:02}"), self.deck.element, [from, -half, soffit], [to, half, 0.0]);
        }
        if self.lines.top_z_m < soffit {
            self.add_haunches(b, soffit);
        }
        for (name, from, to) in self.joints() {
            let (height, depth) = JOINT_SEAL_M;
            b.add_box(&name, Element::StripSealJoint, [from, -half, -depth - height], [to, half, -depth]);
        }
        self.add_drain_pipes(b);
    }

    fn add_haunches(&self, b: &mut MemberBuilder, soffit: f64) {
        let (half, top) = (0.5 * self.lines.haunch_width_m, self.lines.top_z_m);
        for (k, run) in self.deck_runs().iter().enumerate() {
            for (line, y) in self.numbered_lines() {
                let name = format!("haunch-{line}/{k}");
                b.add_box(&name, self.deck.element, [run.start_x_m, y - half, top], [run.end_x_m, y + half, soffit]);
            }
        }
    }

    fn add_drain_pipes(&self, b: &mut MemberBuilder) {
        for (side, y) in [("left", self.drain_y_m()), ("right", -self.drain_y_m())] {
            for (k, x) in self.drains().into_iter().enumerate() {
                let (inlet, outlet) = ([x, y, -self.deck.slab_m], [x, y, self.lines.abutment_bottom_z_m]);
                b.add_rod(&format!("drain-{side}/{k:02}"), Element::DECK_DRAIN, inlet, outlet, DRAIN_M.0, 8);
            }
        }
    }

    /// Adds barriers or railings along the deck and the approach slabs.
    pub(super) fn add_railings(&self, b: &mut MemberBuilder) {
        if self.has_barriers() {
            self.add_barriers(b);
        } else {
            add_railing(b, self.deck_length_m(), 0.5 * self.deck.width_m, self.deck.railing_m, self.deck.railing);
        }
    }

    fn add_barriers(&self, b: &mut MemberBuilder) {
        let (wall, end) = (self.backwall_x_m(), 0.5 * self.deck_length_m());
        let mut pieces = vec![(-end, -wall)];
        pieces.extend(self.deck_panels());
        pieces.push((wall, end));
        let (edge, height) = (0.5 * self.deck.width_m, self.deck.railing_m);
        let (foot, top) = (edge - BARRIER_WIDTH_M.0, edge - BARRIER_WIDTH_M.1);
        let left = [[foot, 0.0], [edge, 0.0], [edge, height], [top, height]];
        let right = [[-edge, 0.0], [-foot, 0.0], [-top, height], [-edge, height]];
        for (side, profile) in [("left", left), ("right", right)] {
            for (k, (from, to)) in pieces.iter().enumerate() {
                b.add_cross_section(&format!("barrier-{side}/{k:02}"), Element::RcRailing, &profile, *from, *to);
            }
        }
    }

    /// Adds bearings and their pedestals, piers and abutments.
    pub(super) fn add_supports(&self, b: &mut MemberBuilder) {
        self.add_bearings(b);
        for pier in self.piers() {
            self.add_pier(b, pier);
        }
        self.add_abutment(b, "abutment-start", -1.0);
        self.add_abutment(b, "abutment-end", 1.0);
    }

    /// Adds bearings and their pedestals. Each run of beams has one fixed row of bearings: on the first pier, or at its start.
    fn add_bearings(&self, b: &mut MemberBuilder) {
        for run in self.beam_runs() {
            let fixed = usize::from(run.bearings.len() > 2);
            for (k, row) in run.bearings.iter().enumerate() {
                let element = if k == fixed { self.bearings.fixed } else { self.bearings.expansion };
                // On a pier with two rows, the beams of the second row begin there.
                let place = if self.spans.pier_gap_m.is_some() && k == 0 { "-ahead" } else { "" };
                for (line, y) in self.numbered_lines() {
                    self.add_bearing(b, (row, element), &format!("{place}/{line}"), y);
                }
            }
        }
    }

    fn add_bearing(&self, b: &mut MemberBuilder, (row, element): (&BearingRow, Element), place: &str, y: f64) {
        let (along, across) = (0.5 * self.bearings.length_m, 0.5 * self.bearings.width_m);
        let (bottom, top, seat) =
            (self.bearing_bottom_z_m(row.support), self.beam_bottom_z_m(row.support), self.seat_z_m(row.support));
        let name = format!("bearing-{}{place}", row.support);
        b.add_box(&name, element, [row.x_m - along, y - across, bottom], [row.x_m + along, y + across, top]);
        let below = if self.piers().contains(&row.support) { Element::RcPierCap } else { Element::RcAbutment };
        let (along, across) = (along + PEDESTAL_MARGIN_M, across + PEDESTAL_MARGIN_M);
        let name = format!("pedestal-{}{place}", row.support);
        b.add_box(&name, below, [row.x_m - along, y - across, seat], [row.x_m + along, y + across, bottom]);
    }

    /// Adds a pier: a cap with tapered ends, its columns and their footing. With one column, the cap is a hammerhead.
    fn add_pier(&self, b: &mut MemberBuilder, pier: usize) {
        let x = self.support_positions()[pier];
        let (half_width, half_length) = (0.5 * self.supports.cap_width_m, 0.5 * self.cap_length_m());
        let (top, bottom) = (self.cap_top_z_m(), self.cap_bottom_z_m());
        let columns = self.column_lines();
        let (column, middle) = (0.5 * self.supports.column_m, 0.5 * (top + bottom));
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
            if self.supports.has_round_columns {
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
    fn add_abutment(&self, b: &mut MemberBuilder, name: &str, side: f64) {
        let (seat, half, road) = (self.seat_z_m(0), 0.5 * self.supports.abutment_width_m, 0.5 * self.deck.width_m);
        let bottom = seat - self.supports.abutment_m;
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
        part(&slab, Element::RcApproachSlab, (back, end), (-road, road), (-APPROACH_SLAB_M, 0.0));
    }
}
