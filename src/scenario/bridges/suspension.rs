//! Suspension bridge: towers on piers in the water, main cables, hangers, stiffening girders, floor, railings, anchorages.

use super::arch::railing;
use super::solid::Builder;
use super::{Field, Misfit};

/// The numbers of a suspension bridge. Own axes: x along the deck, y left, z up, origin on the deck at midspan.
#[derive(Debug, Clone, PartialEq)]
pub struct Suspension {
    /// Distance between the towers, m.
    pub main_span_m: f64,
    /// From a tower to its anchorage, m.
    pub side_span_m: f64,
    /// Sag of the main cable at midspan, m.
    pub sag_m: f64,
    /// Height of the cable over the deck at midspan, m.
    pub cable_clearance_m: f64,
    /// Corner radius of the cables' prisms, m.
    pub cable_radius_m: f64,
    /// Distance between hangers, m.
    pub hanger_spacing_m: f64,
    /// Corner radius of the hangers' prisms, m.
    pub hanger_radius_m: f64,
    /// Deck width, m.
    pub deck_width_m: f64,
    /// Slab thickness, m.
    pub slab_m: f64,
    /// Depth of the stiffening girders, m.
    pub girder_depth_m: f64,
    /// Depth of the floorbeams, m.
    pub floorbeam_depth_m: f64,
    /// Tower leg along the bridge, m.
    pub leg_x_m: f64,
    /// Tower leg across, m.
    pub leg_y_m: f64,
    /// Pier along the bridge, m.
    pub pier_x_m: f64,
    /// Pier across, m.
    pub pier_y_m: f64,
    /// Pier top under the deck, m.
    pub pier_top_m: f64,
    /// Height of the pier, m.
    pub pier_height_m: f64,
    /// Length of the anchorages, m.
    pub anchorage_m: f64,
    /// Railing height, m.
    pub railing_m: f64,
}

const fn field(key: &'static str, min: f64, max: f64, default: f64, doc: &'static str) -> Field {
    Field { key, min, max, default, doc }
}

impl Suspension {
    /// Keys of the scenario file, in the order of [`Suspension::from_values`].
    pub const FIELDS: &'static [Field] = &[
        field("main_span_m", 60.0, 1400.0, 140.0, "between the towers; Deer Isle 329 m, Golden Gate 1280 m"),
        field("side_span_m", 20.0, 400.0, 45.0, "tower to anchorage (estimate)"),
        field("sag_m", 5.0, 160.0, 14.0, "cable sag; span/9 to span/11 (estimate)"),
        field("cable_clearance_m", 0.5, 10.0, 2.0, "cable over the deck at midspan (estimate)"),
        field("cable_radius_m", 0.05, 0.6, 0.15, "main cable; 0.12 to 0.25 m for spans of about 330 m (estimate)"),
        field("hanger_spacing_m", 3.0, 20.0, 7.0, "between hangers; Deer Isle 9 to 12 m (estimate)"),
        field("hanger_radius_m", 0.01, 0.1, 0.03, "hanger rope; 50 to 65 mm pairs (estimate)"),
        field("deck_width_m", 5.0, 40.0, 8.4, "deck width; Deer Isle 7.2 m"),
        field("slab_m", 0.15, 0.5, 0.2, "slab thickness; 8 to 10 in (estimate)"),
        field("girder_depth_m", 0.8, 8.0, 2.0, "stiffening girder; Deer Isle about 2 m"),
        field("floorbeam_depth_m", 0.4, 3.0, 0.9, "floorbeam depth (estimate)"),
        field("leg_x_m", 1.0, 16.0, 2.4, "tower leg along the bridge; 2 to 4 m on small bridges (estimate)"),
        field("leg_y_m", 1.0, 16.0, 1.8, "tower leg across (estimate)"),
        field("pier_x_m", 2.0, 20.0, 4.0, "pier along the bridge; 4 x 8 to 10 x 18 m (estimate)"),
        field("pier_y_m", 4.0, 60.0, 13.0, "pier across (estimate)"),
        field("pier_top_m", 4.0, 70.0, 9.0, "pier top under the deck; 4 to 8 m over the water (estimate)"),
        field("pier_height_m", 4.0, 60.0, 16.0, "pier height, reaching into the lake's ground (estimate)"),
        field("anchorage_m", 3.0, 40.0, 8.0, "length of an anchorage (estimate)"),
        field("railing_m", 0.6, 2.0, 1.0, "railing height; 32 to 42 in (estimate)"),
    ];

    /// From values in the order of [`Suspension::FIELDS`].
    #[must_use]
    pub fn from_values(v: &[f64]) -> Self {
        let get = |k: usize| v.get(k).copied().unwrap_or(Self::FIELDS[k].default);
        Self {
            main_span_m: get(0),
            side_span_m: get(1),
            sag_m: get(2),
            cable_clearance_m: get(3),
            cable_radius_m: get(4),
            hanger_spacing_m: get(5),
            hanger_radius_m: get(6),
            deck_width_m: get(7),
            slab_m: get(8),
            girder_depth_m: get(9),
            floorbeam_depth_m: get(10),
            leg_x_m: get(11),
            leg_y_m: get(12),
            pier_x_m: get(13),
            pier_y_m: get(14),
            pier_top_m: get(15),
            pier_height_m: get(16),
            anchorage_m: get(17),
            railing_m: get(18),
        }
    }

    /// Numbers that do not fit together, so that the towers stand on their piers and the girders clear them.
    #[must_use]
    pub fn misfits(&self) -> Vec<Misfit> {
        let legs_m = 2.0 * (self.cable_y_m() + self.leg_y_m - 0.35);
        let under_m = self.slab_m + self.girder_depth_m;
        super::misfits(&[
            ("leg_x_m", self.leg_x_m, self.leg_x_m <= self.pier_x_m, format!("at most pier_x_m, {}", self.pier_x_m)),
            (
                "pier_y_m",
                self.pier_y_m,
                self.pier_y_m >= legs_m,
                format!("wide enough for both tower legs: at least {legs_m:.2}"),
            ),
            ("pier_top_m", self.pier_top_m, self.pier_top_m >= under_m, format!("under slab and girders: at least {under_m:.2}")),
        ])
    }

    /// Length of the deck between the anchorages' far ends, m.
    #[must_use]
    pub fn deck_length_m(&self) -> f64 {
        self.main_span_m + 2.0 * (self.side_span_m + self.anchorage_m)
    }

    /// Height of the cable at x: a parabola in the main span, straight lines to the anchorages.
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

    /// Distance of the cables from the deck's middle, m: just outside the railings.
    #[must_use]
    pub fn cable_y_m(&self) -> f64 {
        0.5 * self.deck_width_m + 0.35
    }

    /// Hanger places: evenly spaced in the main span, none at the towers.
    #[must_use]
    pub fn hangers(&self) -> Vec<f64> {
        let n = (self.main_span_m / self.hanger_spacing_m).round() as i32;
        (1..n).map(|k| self.main_span_m * (f64::from(k) / f64::from(n) - 0.5)).collect()
    }

    /// Builds every member.
    pub fn build(&self, b: &mut Builder) {
        self.towers(b);
        self.cables(b);
        self.floor(b);
        railing(b, self.deck_length_m(), 0.5 * self.deck_width_m, self.railing_m, 330);
        self.anchorages(b);
    }

    fn towers(&self, b: &mut Builder) {
        let top = self.cable_z_m(0.5 * self.main_span_m) + 0.5;
        for (name, x) in [("start", -0.5 * self.main_span_m), ("end", 0.5 * self.main_span_m)] {
            let (px, py) = (0.5 * self.pier_x_m, 0.5 * self.pier_y_m);
            let foot = -self.pier_top_m;
            b.block(&format!("pier-{name}"), 210, [x - px, -py, foot - self.pier_height_m], [x + px, py, foot]);
            let y = self.cable_y_m();
            let (lx, ly) = (0.5 * self.leg_x_m, 0.5 * self.leg_y_m);
            for (side, y) in [("left", y + ly - 0.35), ("right", -y - ly + 0.35)] {
                b.block(&format!("tower-{name}/{side}"), 207, [x - lx, y - ly, foot], [x + lx, y + ly, top]);
            }
            for (part, z) in [("portal-top", top - 1.2), ("portal-deck", -self.slab_m - self.girder_depth_m - 1.4)] {
                b.block(&format!("tower-{name}/{part}"), 207, [x - 0.6, -y, z], [x + 0.6, y, z + 1.2]);
            }
        }
    }

    fn cables(&self, b: &mut Builder) {
        let half = 0.5 * self.main_span_m;
        let mut xs = vec![-half - self.side_span_m, -half];
        xs.extend(self.hangers());
        xs.extend([half, half + self.side_span_m]);
        for (side, y) in [("left", self.cable_y_m()), ("right", -self.cable_y_m())] {
            for (k, pair) in xs.windows(2).enumerate() {
                let ends = [pair[0], pair[1]].map(|x| [x, y, self.cable_z_m(x)]);
                b.rod(&format!("cable-{side}/{k:03}"), 147, ends[0], ends[1], self.cable_radius_m, 8);
            }
            for (k, x) in self.hangers().into_iter().enumerate() {
                let foot = [x, y, -self.slab_m];
                b.rod(&format!("hanger-{side}/{k:03}"), 148, foot, [x, y, self.cable_z_m(x)], self.hanger_radius_m, 6);
            }
        }
    }

    fn floor(&self, b: &mut Builder) {
        let half_length = 0.5 * self.deck_length_m();
        let half_width = 0.5 * self.deck_width_m;
        let soffit = -self.slab_m;
        let mut lines = vec![-half_length, -0.5 * self.main_span_m];
        lines.extend(self.hangers());
        lines.extend([0.5 * self.main_span_m, half_length]);
        for (k, pair) in lines.windows(2).enumerate() {
            b.block(&format!("slab/{k:02}"), 12, [pair[0], -half_width, soffit], [pair[1], half_width, 0.0]);
            for (side, y) in [("left", half_width - 0.2), ("right", -half_width - 0.2)] {
                let name = format!("girder-{side}/{k:02}");
                b.block(&name, 107, [pair[0], y, soffit - self.girder_depth_m], [pair[1], y + 0.4, soffit]);
            }
            for (line, y) in [(0, -0.25), (1, 0.25)] {
                let y = y * self.deck_width_m;
                let name = format!("stringer-{line}/{k:02}");
                b.block(&name, 113, [pair[0], y - 0.12, soffit - 0.5], [pair[1], y + 0.12, soffit]);
            }
        }
        for (k, x) in self.hangers().into_iter().enumerate() {
            let inner = half_width - 0.2;
            let name = format!("floorbeam/{k:02}");
            b.block(&name, 152, [x - 0.15, -inner, soffit - self.floorbeam_depth_m], [x + 0.15, inner, soffit]);
        }
    }

    fn anchorages(&self, b: &mut Builder) {
        let inner = 0.5 * self.main_span_m + self.side_span_m;
        let y = self.cable_y_m() + 0.6;
        for (name, low, high) in [("start", -inner - self.anchorage_m, -inner), ("end", inner, inner + self.anchorage_m)] {
            b.block(&format!("anchorage-{name}"), 220, [low, -y, -12.0], [high, y, -self.slab_m - self.girder_depth_m]);
        }
    }
}

impl Default for Suspension {
    fn default() -> Self {
        Self::from_values(&[])
    }
}
