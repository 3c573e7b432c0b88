//! Open-spandrel deck arch bridge: two parabolic ribs with struts, spandrel columns, floorbeams, stringers, deck slab, railings,
//! abutments.

use super::dimensions::{Inconsistency, InconsistencyList, bridge_dimensions};
use super::path::{LocalPath, PathPlace, SPACING_M, TaskKind, equal_steps};
use super::quantity::{Amounts, ElementQuantity};
use super::railing::add_railing;
use super::shape::BridgeShape;
use super::solid::{Footing, LocalPoint, MemberBuilder};
use crate::elements::Element;
use crate::math;

/// Distance from the ends of the floorbeams to the deck's edge, m (estimate).
const BEAM_INSET_M: f64 = 0.4;
/// Depth of abutments and skewbacks below the intrados at the springings, m (estimate).
const FOUNDATION_DEPTH_M: f64 = 3.5;
/// Skewback length, m (estimate).
const SKEWBACK_LENGTH_M: f64 = 3.0;
/// Minimum length of a column, m; shorter columns are omitted (estimate).
const MIN_COLUMN_LENGTH_M: f64 = 0.25;

bridge_dimensions! {
    /// Dimensions of an open-spandrel deck arch. Bridge axes: x along the deck, y left, z up, origin on the deck at midspan.
    Arch "arch" {
        span_m 40.0 to 520.0, 98.0, "Distance between springings, m; Bixby Creek 98 m, New River Gorge 518 m.";
        rise_m 8.0 to 120.0, 26.0, "Height of the crown axis above the springing axis, m; span/rise of cataloged arches is 2.5 to 8.";
        crown_depth_m 0.8 to 8.0, 1.6, "Rib depth at the crown, m; span/65 to span/50 (estimate).";
        springing_depth_m 1.0 to 12.0, 2.7, "Rib depth at the springing, m; Bixby Creek 2.7 m (estimate).";
        rib_width_m 0.8 to 6.0, 1.5, "Rib width, m; 1.0 to 1.8 m (estimate).";
        rib_spacing_m 3.0 to 30.0, 5.8, "Distance between rib axes, m; 0.55 to 0.7 of the deck width (estimate).";
        crown_gap_m 2.0 to 12.0, 3.4, "Clear height between slab soffit and crown extrados: the interlayer, m (estimate).";
        panels 6.0 to 40.0, 14.0, "Number of panels between springings; span/16 to span/10 per panel (estimate); a whole number.";
        column_m 0.4 to 3.0, 0.8, "Side length of the spandrel columns, m; 0.6 to 1.2 m (estimate).";
        deck_width_m 5.0 to 40.0, 9.6, "Deck width, m; Bixby Creek 7.3 m.";
        slab_m 0.15 to 0.5, 0.23, "Slab thickness, m; 8 to 10 in (estimate).";
        floorbeam_depth_m 0.4 to 3.0, 0.95, "Floorbeam depth, m; 0.9 to 1.5 m (estimate).";
        floorbeam_width_m 0.2 to 1.5, 0.45, "Floorbeam width, m; 0.4 to 0.5 m (estimate).";
        stringers 2.0 to 12.0, 4.0, "Number of stringer lines; 3 to 6 (estimate); a whole number.";
        stringer_depth_m 0.3 to 2.0, 0.7, "Stringer depth, m; 0.6 to 1.0 m (estimate).";
        stringer_width_m 0.15 to 1.0, 0.3, "Stringer width, m (estimate).";
        railing_m 0.6 to 2.0, 1.0, "Railing height, m; 32 to 42 in (estimate).";
        approach_m 2.0 to 60.0, 12.0, "Deck length beyond each springing, m (estimate).";
    }
}

impl BridgeShape for Arch {
    fn type_in_words(&self) -> &'static str {
        "an arch"
    }

    fn task_kinds(&self) -> &'static [TaskKind] {
        &[TaskKind::SlabSide, TaskKind::ArchBottom, TaskKind::Interlayer]
    }

    // If there are none, every member has a positive volume and a support, and the interlayer is open.
    fn inconsistencies(&self) -> Vec<Inconsistency> {
        let panel_m = self.span_m / self.panels.round();
        let line_m = (self.deck_width_m - 2.0 * BEAM_INSET_M) / self.stringers.round();
        let over_columns_m = self.rib_spacing_m + self.column_m + 2.0 * BEAM_INSET_M;
        let mut m = InconsistencyList::default();
        m.require_integer("panels", self.panels);
        m.require_integer("stringers", self.stringers);
        m.require_at_least("rise_m", self.rise_m, self.span_m / 12.0, "not too flat for span_m");
        m.require_at_most("rise_m", self.rise_m, self.span_m / 2.0, "not too steep for span_m");
        m.require_at_least(
            "springing_depth_m",
            self.springing_depth_m,
            self.crown_depth_m,
            "no thinner than the crown (crown_depth_m)",
        );
        m.require_at_most("rib_width_m", self.rib_width_m, self.rib_spacing_m - 1.0, "rib_spacing_m minus 1 m for the struts");
        m.require_at_most("column_m", self.column_m, self.rib_width_m, "no wider than the rib (rib_width_m)");
        m.require_at_most("column_m", self.column_m, 0.5 * panel_m, "half a panel (span_m, panels)");
        m.require_at_most("floorbeam_width_m", self.floorbeam_width_m, 0.5 * panel_m, "half a panel (span_m, panels)");
        m.require_at_most("floorbeam_depth_m", self.floorbeam_depth_m, self.crown_gap_m - 0.5, "crown_gap_m minus 0.5 m");
        m.require_at_least(
            "deck_width_m",
            self.deck_width_m,
            over_columns_m,
            "wide enough for the columns (rib_spacing_m, column_m)",
        );
        m.require_at_most("stringer_width_m", self.stringer_width_m, line_m, "room for all stringers (stringers, deck_width_m)");
        m.require_at_most("stringer_depth_m", self.stringer_depth_m, self.crown_gap_m - 0.5, "crown_gap_m minus 0.5 m");
        m.0
    }

    fn build(&self, b: &mut MemberBuilder) {
        self.ribs(b);
        self.columns(b);
        self.floor(b);
        self.railings(b);
        self.abutments(b);
    }

    fn deck_length_m(&self) -> f64 {
        self.span_m + 2.0 * self.approach_m
    }

    fn deck_width_m(&self) -> f64 {
        self.deck_width_m
    }

    fn fascia_z_m(&self) -> (f64, f64) {
        (-self.slab_m - self.stringer_depth_m, 0.0)
    }

    fn opening_half_length_m(&self) -> f64 {
        0.5 * self.span_m
    }

    fn underside_depth_m(&self) -> Option<f64> {
        Some(-self.intrados_z_m(0.5 * self.span_m))
    }

    fn footings(&self) -> Vec<Footing> {
        let (inner, outer) = (0.5 * self.span_m, 0.5 * self.deck_length_m());
        let (half, narrow) = (0.5 * self.deck_width_m, self.skewback_half_length_m());
        let at = |low: f64, high: f64, y: f64| Footing { x_m: (low, high), y_m: (-y, y), up_m: self.foundation_bottom_z_m() };
        vec![
            at(-outer, -inner - 1.0, half),
            at(inner + 1.0, outer, half),
            at(-inner - SKEWBACK_LENGTH_M, -inner, narrow),
            at(inner, inner + SKEWBACK_LENGTH_M, narrow),
        ]
    }

    fn quantities(&self) -> Vec<ElementQuantity> {
        let (length_m, width_m) = (self.deck_length_m(), self.deck_width_m);
        [
            (Element::RcDeck, length_m * width_m),
            (Element::RcStringer, self.stringers.round() * length_m),
            (Element::RcArch, 2.0 * self.span_m),
            (Element::RcFloorBeam, (self.panels.round() + 1.0) * (width_m - 2.0 * BEAM_INSET_M)),
            (Element::RcColumn, 2.0 * self.column_feet().len() as f64),
            (Element::RcAbutment, 2.0 * width_m),
            (Element::RcRailing, 2.0 * length_m),
        ]
        .into_iter()
        .collect::<Amounts>()
        .list()
    }

    fn task_path(&self, kind: TaskKind, stand_off_m: f64, _: &PathPlace) -> Result<LocalPath, String> {
        match kind {
            TaskKind::SlabSide => Ok(slab_side(self, stand_off_m)),
            TaskKind::ArchBottom => Ok(arch_bottom(self, stand_off_m)),
            TaskKind::Interlayer => Ok(interlayer(self)),
            TaskKind::PierCircle
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

impl Arch {
    /// Returns the height of the rib axis at x in bridge axes, in meters: the parabola z_crown - 4 r x² / L².
    #[must_use]
    pub fn axis_z_m(&self, x: f64) -> f64 {
        let u = 2.0 * x / self.span_m;
        -(self.slab_m + self.crown_gap_m + 0.5 * self.crown_depth_m) - self.rise_m * u * u
    }

    /// Returns the vertical depth of the rib at x, in meters: d_c + (d_s - d_c)(2x/L)².
    #[must_use]
    pub fn rib_depth_m(&self, x: f64) -> f64 {
        let u = 2.0 * x / self.span_m;
        self.crown_depth_m + (self.springing_depth_m - self.crown_depth_m) * u * u
    }

    /// Returns the height of the rib's top at x, in meters.
    #[must_use]
    pub fn extrados_z_m(&self, x: f64) -> f64 {
        self.axis_z_m(x) + 0.5 * self.rib_depth_m(x)
    }

    /// Returns the height of the rib's underside at x, in meters.
    #[must_use]
    pub fn intrados_z_m(&self, x: f64) -> f64 {
        self.axis_z_m(x) - 0.5 * self.rib_depth_m(x)
    }

    /// Returns the curvature coefficient c of the intrados, in 1/m: at x, the intrados is c x² below its crown.
    #[must_use]
    pub fn intrados_curvature_per_m(&self) -> f64 {
        (4.0 * self.rise_m + 2.0 * (self.springing_depth_m - self.crown_depth_m)) / (self.span_m * self.span_m)
    }

    /// Returns the end positions of the straight rib segments (two per panel) from springing to springing.
    #[must_use]
    pub fn rib_nodes(&self) -> Vec<f64> {
        let n = 2 * self.panels.round() as i32;
        (0..=n).map(|k| self.span_m * (f64::from(k) / f64::from(n) - 0.5)).collect()
    }

    /// Returns the height of the rib's top as built, in meters: straight between nodes on [`Self::extrados_z_m`].
    #[must_use]
    pub fn rib_top_z_m(&self, x: f64) -> f64 {
        let step = self.span_m / (2.0 * self.panels.round());
        let from = ((x + 0.5 * self.span_m) / step).floor() * step - 0.5 * self.span_m;
        math::lerp(self.extrados_z_m(from), self.extrados_z_m(from + step), (x - from) / step)
    }

    /// Returns the height of the floorbeams' undersides in meters.
    #[must_use]
    pub fn floorbeam_bottom_z_m(&self) -> f64 {
        -self.slab_m - self.floorbeam_depth_m
    }

    /// Returns the positions of the panel points between the springings.
    #[must_use]
    pub fn panel_points(&self) -> Vec<f64> {
        let n = self.panels.round() as i32;
        (1..n).map(|k| self.span_m * (f64::from(k) / f64::from(n) - 0.5)).collect()
    }

    fn ribs(&self, b: &mut MemberBuilder) {
        for (side, y) in [("left", 0.5 * self.rib_spacing_m), ("right", -0.5 * self.rib_spacing_m)] {
            for (k, pair) in self.rib_nodes().windows(2).enumerate() {
                let (a, c) = (pair[0], pair[1]);
                let profile =
                    [[a, self.intrados_z_m(a)], [c, self.intrados_z_m(c)], [c, self.extrados_z_m(c)], [a, self.extrados_z_m(a)]];
                let half = 0.5 * self.rib_width_m;
                b.add_extrusion(&format!("rib-{side}/{k:02}"), Element::RcArch, &profile, y - half, y + half);
            }
        }
        let inner = 0.5 * (self.rib_spacing_m - self.rib_width_m);
        for (k, x) in self.panel_points().into_iter().enumerate().filter(|(k, _)| k % 2 == 1) {
            let z = self.axis_z_m(x);
            b.add_box(&format!("strut/{k:02}"), Element::RcArch, [x - 0.35, -inner, z - 0.35], [x + 0.35, inner, z + 0.35]);
        }
    }

    /// Returns the numbers of the panel points with columns, their positions, and the heights of the columns' feet.
    fn column_feet(&self) -> Vec<(usize, f64, f64)> {
        let (half, top) = (0.5 * self.column_m, self.floorbeam_bottom_z_m());
        // The rib slopes under the column, so the column starts where both of its edges are inside the rib.
        let foot = |x: f64| self.rib_top_z_m(x + half).min(self.rib_top_z_m(x - half));
        let points = self.panel_points().into_iter().enumerate().map(|(k, x)| (k, x, foot(x)));
        // Near the crown the floorbeam rests directly on the rib.
        points.filter(|(_, _, foot)| top - foot >= MIN_COLUMN_LENGTH_M).collect()
    }

    fn columns(&self, b: &mut MemberBuilder) {
        let half = 0.5 * self.column_m;
        let top = self.floorbeam_bottom_z_m();
        for (k, x, foot) in self.column_feet() {
            for (side, y) in [("left", 0.5 * self.rib_spacing_m), ("right", -0.5 * self.rib_spacing_m)] {
                b.add_box(
                    &format!("column-{side}/{k:02}"),
                    Element::RcColumn,
                    [x - half, y - half, foot],
                    [x + half, y + half, top],
                );
            }
            // Struts connect tall pairs at a third of their height, well below the flight space in the interlayer.
            if top - foot > 9.0 {
                let z = foot + (top - foot) / 3.0;
                let inner = 0.5 * self.rib_spacing_m - half;
                b.add_box(
                    &format!("column-strut/{k:02}"),
                    Element::RcColumn,
                    [x - 0.3, -inner, z - 0.3],
                    [x + 0.3, inner, z + 0.3],
                );
            }
        }
    }

    fn floor(&self, b: &mut MemberBuilder) {
        let half_width = 0.5 * self.deck_width_m;
        let beam_half = half_width - BEAM_INSET_M;
        let soffit = -self.slab_m;
        let mut lines = vec![-0.5 * self.span_m];
        lines.extend(self.panel_points());
        lines.push(0.5 * self.span_m);
        for (k, x) in lines.iter().enumerate() {
            let half = 0.5 * self.floorbeam_width_m;
            b.add_box(
                &format!("floorbeam/{k:02}"),
                Element::RcFloorBeam,
                [x - half, -beam_half, self.floorbeam_bottom_z_m()],
                [x + half, beam_half, soffit],
            );
        }
        let mut ends = vec![-0.5 * self.deck_length_m()];
        ends.extend(&lines);
        ends.push(0.5 * self.deck_length_m());
        let count = self.stringers.round() as i32;
        for (k, pair) in ends.windows(2).enumerate() {
            b.add_box(&format!("slab/{k:02}"), Element::RcDeck, [pair[0], -half_width, soffit], [pair[1], half_width, 0.0]);
            for line in 0..count {
                let share = (f64::from(line) + 0.5) / f64::from(count) * 2.0 - 1.0;
                let (y, half) = (share * beam_half, 0.5 * self.stringer_width_m);
                let name = format!("stringer-{line}/{k:02}");
                b.add_box(
                    &name,
                    Element::RcStringer,
                    [pair[0], y - half, soffit - self.stringer_depth_m],
                    [pair[1], y + half, soffit],
                );
            }
        }
    }

    fn railings(&self, b: &mut MemberBuilder) {
        add_railing(b, self.deck_length_m(), 0.5 * self.deck_width_m, self.railing_m, Element::RcRailing);
    }

    /// Returns the height of the abutment and skewback undersides in meters.
    #[must_use]
    pub fn foundation_bottom_z_m(&self) -> f64 {
        self.intrados_z_m(0.5 * self.span_m) - FOUNDATION_DEPTH_M
    }

    fn skewback_half_length_m(&self) -> f64 {
        0.5 * (self.rib_spacing_m + self.rib_width_m) + 0.5
    }

    fn abutments(&self, b: &mut MemberBuilder) {
        // The skewbacks support the ribs and therefore extend above them.
        let under_deck = -self.slab_m - self.stringer_depth_m;
        let over_ribs = self.extrados_z_m(0.5 * self.span_m) + 0.8;
        let names = [
            ("abutment-start", under_deck),
            ("abutment-end", under_deck),
            ("skewback-start", over_ribs),
            ("skewback-end", over_ribs),
        ];
        for ((name, top), Footing { x_m, y_m, up_m }) in names.into_iter().zip(self.footings()) {
            b.add_box(name, Element::RcAbutment, [x_m.0, y_m.0, up_m], [x_m.1, y_m.1, top]);
        }
    }
}

/// Returns the path of task 1: a straight line along the right side of the deck, slightly below the slab's surface, facing it.
fn slab_side(arch: &Arch, stand_off_m: f64) -> LocalPath {
    let half = 0.5 * arch.span_m;
    let y = -0.5 * arch.deck_width_m - stand_off_m;
    let points: Vec<LocalPoint> = equal_steps(-half, half).into_iter().map(|x| [x, y, -0.6]).collect();
    LocalPath { viewing_directions: vec![[0.0, 1.0, 0.0]; points.len()], points, closed: false }
}

/// Returns the path of task 2: under the arch between the ribs, at the stand-off distance perpendicular to the intrados. The
/// camera looks up and ahead at the arch.
fn arch_bottom(arch: &Arch, stand_off_m: f64) -> LocalPath {
    let reach = 0.5 * arch.span_m * 0.78;
    let bend = arch.intrados_curvature_per_m();
    // The ribs are straight between nodes on the curve, so the path stays farther away by their maximum deviation.
    let step = 0.5 * arch.span_m / arch.panels.round();
    let off = stand_off_m + 0.25 * bend * step * step;
    let steepest = 2.0 * bend * reach;
    let n = (2.0 * reach * (1.0 + steepest * steepest).sqrt() / SPACING_M).ceil() as i32;
    let on_curve = (0..=n).map(|k| reach * (2.0 * f64::from(k) / f64::from(n) - 1.0));
    let points: Vec<LocalPoint> = on_curve
        .map(|x| {
            let fall = 2.0 * bend * x;
            let stretch = (1.0 + fall * fall).sqrt();
            [x - off * fall / stretch, 0.0, arch.intrados_z_m(x) - off / stretch]
        })
        .collect();
    let viewing_directions = points.iter().enumerate().map(|(k, p)| under_arch_viewing_direction(arch, *p, off, k)).collect();
    LocalPath { points, viewing_directions, closed: false }
}

/// Returns the viewing direction of task 2 at point `k`: up at the soffits and slightly ahead, panning slowly between
/// the left and right ribs.
fn under_arch_viewing_direction(arch: &Arch, from: LocalPoint, off: f64, k: usize) -> LocalPoint {
    const PERIOD_POINTS: f64 = 30.0;
    let side = math::sin(math::TAU * k as f64 / PERIOD_POINTS);
    // The closest point of the arch is not vertically above the path point but farther from the crown.
    let bend = 2.0 * arch.intrados_curvature_per_m();
    let square = from[0] / (1.0 - off * bend / (1.0 + (bend * from[0]) * (bend * from[0])).sqrt());
    let ahead = (square + 0.3 * off).min(0.5 * arch.span_m);
    [ahead - from[0], 0.5 * arch.rib_spacing_m * side, arch.intrados_z_m(ahead) - from[2]]
}

/// Returns the path of task 3: a horizontal line on the centerline between the deck and the arch, halfway between the
/// floorbeams and the crown.
fn interlayer(arch: &Arch) -> LocalPath {
    let half = 0.3 * arch.span_m;
    let z = 0.5 * (arch.floorbeam_bottom_z_m() + arch.extrados_z_m(0.0));
    let points: Vec<LocalPoint> = equal_steps(-half, half).into_iter().map(|x| [x, 0.0, z]).collect();
    let viewing_directions = (0..points.len()).map(interlayer_viewing_direction).collect();
    LocalPath { points, viewing_directions, closed: false }
}

/// Returns the viewing direction of task 3 at point `k`: alternately up at the deck's underside and down at the ribs, panning to
/// both sides.
fn interlayer_viewing_direction(k: usize) -> LocalPoint {
    const PERIOD_POINTS: f64 = 20.0;
    let phase = math::TAU * k as f64 / PERIOD_POINTS;
    [0.6, 0.5 * math::sin(0.5 * phase), 0.8 * math::sin(phase)]
}
