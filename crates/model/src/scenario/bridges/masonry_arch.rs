//! Masonry arch bridge: barrels of voussoirs with circular intrados over one or more spans, spandrel walls with fill between them, parapets,
//! piers with cutwaters, and abutments with wing walls.

use super::dimensions::{Inconsistency, InconsistencyList, bridge_dimensions};
use super::path::{LocalPath, PathPlace, SPACING_M, TaskKind, equal_steps};
use super::plan_polygon::{self, PlanPoint};
use super::quantity::{Amounts, ElementQuantity};
use super::shape::BridgeShape;
use super::solid::{Footing, LocalPoint, MemberBuilder};
use crate::elements::Element;
use crate::math;

/// Length of the voussoirs along the intrados, m (estimate: one member each, so that the barrel is round).
const VOUSSOIR_M: f64 = 0.9;
/// Width of the parapets, m (estimate).
const PARAPET_M: f64 = 0.4;
/// Length of the parapets' pieces, m (estimate).
const PARAPET_PIECE_M: f64 = 4.0;
/// Thickness of the road surface on the fill, m (estimate).
const ROAD_M: f64 = 0.15;
/// Height of the caps on the cutwaters, as a share of their length (estimate).
const CAP_SHARE: f64 = 0.6;
/// Distance between a walkway's axis and the parapet, m (estimate: half of a person's width and a margin).
const WALKWAY_MARGIN_M: f64 = 0.45;
/// Largest rise, as a share of the span: just below a semicircle, so that the skewbacks have a height.
const MAX_RISE_SHARE: f64 = 0.48;
/// Minimum rise, as a share of the span (estimate: flatter arches are rare).
const MIN_RISE_SHARE: f64 = 0.15;
/// Minimum thickness of a pier, as a share of the span (estimate; historical piers have a quarter to a sixth, later ones down to a tenth).
const MIN_PIER_SHARE: f64 = 0.1;
/// Minimum length of a pier's top between the barrels, m (estimate).
const PIER_TOP_M: f64 = 0.2;
/// Minimum radius of a path below a barrel, m (estimate: a turn that a slow aircraft can follow).
const MIN_PATH_RADIUS_M: f64 = 3.3;
/// Distance that the views pan to both sides below a barrel, as a share of its width, and the number of points of one period.
const PAN: (f64, f64) = (0.25, 30.0);
/// Length of a foot, m.
const FOOT_M: f64 = 0.3048;

bridge_dimensions! {
    /// Dimensions of a masonry arch bridge. Bridge axes: x along the deck, y left, z up, origin on the road in the middle between the
    /// abutments.
    MasonryArch "masonry_arch" {
        spans 1.0 to 8.0, 3.0, "Number of spans; a whole number.";
        clear_span_m 4.0 to 40.0, 15.24, "Clear width of each span between piers or abutments, m; Starrucca Viaduct 15.2 m (50 ft).";
        rise_m 0.8 to 18.0, 5.0, "Height of the intrados at the crown above the springings, m (estimate).";
        ring_m 0.3 to 2.0, 0.65, "Thickness of the arch barrel, m; at least Trautwine's rule for the keystone.";
        cover_m 0.3 to 3.0, 0.6, "Height of the road above the crown of the barrel, m (estimate).";
        width_m 5.0 to 20.0, 8.0, "Width between the outer faces of the spandrel walls, m (estimate; Starrucca Viaduct 9.1 m, 30 ft).";
        wall_m 0.4 to 1.5, 0.6, "Thickness of the spandrel walls, m (estimate).";
        parapet_m 0.8 to 1.5, 1.0, "Height of the parapets above the road, m (estimate).";
        pier_m 1.0 to 10.0, 2.8, "Thickness of the piers along the bridge, m; a quarter to a sixth of the span (estimate).";
        cutwater_m 0.3 to 5.0, 1.6, "Length of the cutwaters upstream and downstream of the piers, m (estimate).";
        pier_height_m 1.0 to 30.0, 6.0, "Height of the piers and abutments between the ground and the springings, m (estimate).";
        abutment_m 2.0 to 12.0, 4.0, "Length of the abutments behind the springings, m (estimate).";
        approach_m 4.0 to 20.0, 6.0, "Length of the wing walls, m (estimate).";
    }
}

/// A point in a vertical plane along the bridge: position and height, m.
type Node = [f64; 2];

impl BridgeShape for MasonryArch {
    fn type_in_words(&self) -> &'static str {
        "a masonry arch bridge"
    }

    fn task_kinds(&self) -> &'static [TaskKind] {
        &[TaskKind::SlabSide, TaskKind::PierCircle, TaskKind::BarrelSoffit, TaskKind::ArchRing]
    }

    // If there are none, the barrels rest on the piers without intersecting each other, and the walls contain the fill.
    fn inconsistencies(&self) -> Vec<Inconsistency> {
        let mut m = InconsistencyList::default();
        m.require_integer("spans", self.spans);
        m.require_at_least("rise_m", self.rise_m, MIN_RISE_SHARE * self.clear_span_m, "0.15 clear_span_m (estimate)");
        m.require_at_most(
            "rise_m",
            self.rise_m,
            MAX_RISE_SHARE * self.clear_span_m,
            "0.48 clear_span_m, just below a semicircle",
        );
        if !m.0.is_empty() {
            return m.0;
        }
        m.require_at_least(
            "ring_m",
            self.ring_m,
            self.keystone_m(),
            "Trautwine's rule for first-class masonry (clear_span_m, rise_m)",
        );
        m.require_at_most(
            "ring_m",
            self.ring_m,
            0.5 * self.radius_m(),
            "half of the radius of the intrados (clear_span_m, rise_m)",
        );
        let fill_m = 0.5 * self.width_m - 0.5;
        m.require_at_most("wall_m", self.wall_m, fill_m, "1 m of fill between the walls (width_m)");
        let road_m = ROAD_M + 0.05;
        m.require_at_least("cover_m", self.cover_m, road_m, "fill below the road surface");
        if self.spans.round() > 1.0 {
            let (sine, _) = self.springing();
            let rings_m = 2.0 * self.ring_m * sine + PIER_TOP_M;
            m.require_at_least("pier_m", self.pier_m, rings_m, "room for both barrels (ring_m, rise_m, clear_span_m)");
            m.require_at_least("pier_m", self.pier_m, MIN_PIER_SHARE * self.clear_span_m, "clear_span_m / 10 (estimate)");
            m.require_at_most("pier_m", self.pier_m, 0.5 * self.clear_span_m, "half of clear_span_m, so that water can pass");
            m.require_at_most("cutwater_m", self.cutwater_m, self.pier_m, "no longer than the pier is thick (pier_m)");
            m.require_at_most("cutwater_m", self.cutwater_m, self.rise_m / CAP_SHARE, "caps below the crown (rise_m)");
        }
        let thrust_m = self.ring_m + 0.5;
        m.require_at_least("abutment_m", self.abutment_m, thrust_m, "ring_m plus 0.5 m");
        m.0
    }

    fn build(&self, b: &mut MemberBuilder) {
        for (number, center) in (1..).zip(self.span_centers()) {
            self.add_barrel(b, number, center);
        }
        for (number, x) in (1..).zip(self.piers()) {
            self.add_pier(b, number, x);
        }
        self.add_abutment(b, "start", -1.0);
        self.add_abutment(b, "end", 1.0);
        self.add_parapets(b);
    }

    fn deck_length_m(&self) -> f64 {
        2.0 * (self.opening_half_length_m() + self.abutment_m + self.approach_m)
    }

    fn deck_width_m(&self) -> f64 {
        self.width_m
    }

    fn walkway_y_m(&self) -> Option<f64> {
        Some(0.5 * self.width_m - PARAPET_M - WALKWAY_MARGIN_M)
    }

    fn fascia_z_m(&self) -> (f64, f64) {
        (-self.cover_m - self.ring_m, self.parapet_m)
    }

    fn opening_half_length_m(&self) -> f64 {
        let spans = self.spans.round();
        0.5 * (spans * self.clear_span_m + (spans - 1.0) * self.pier_m)
    }

    fn underside_depth_m(&self) -> Option<f64> {
        Some(-self.springing_z_m())
    }

    fn footings(&self) -> Vec<Footing> {
        let (inner, outer) = (self.opening_half_length_m(), 0.5 * self.deck_length_m());
        let (half, up_m) = (0.5 * self.width_m, self.base_z_m());
        let at = |x_m: (f64, f64), half: f64| Footing { x_m, y_m: (-half, half), up_m };
        let piers = self.piers().into_iter().map(|x| {
            let half_pier = 0.5 * self.pier_m;
            at((x - half_pier, x + half_pier), half + self.cutwater_m)
        });
        [at((-outer, -inner), half), at((inner, outer), half)].into_iter().chain(piers).collect()
    }

    fn quantities(&self) -> Vec<ElementQuantity> {
        let (spans, length_m) = (self.spans.round(), self.deck_length_m());
        [
            (Element::MasonryArch, spans * self.clear_span_m),
            (Element::MasonryPierWall, (spans - 1.0) * (self.width_m + 2.0 * self.cutwater_m)),
            (Element::MasonryAbutment, 2.0 * (self.width_m + 2.0 * self.approach_m)),
            (Element::MasonryRailing, 2.0 * length_m),
            (Element::WearingSurface, length_m * self.road_width_m()),
        ]
        .into_iter()
        .collect::<Amounts>()
        .list()
    }

    fn task_path(&self, kind: TaskKind, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String> {
        match kind {
            TaskKind::SlabSide => self.spandrel_side(stand_off_m),
            TaskKind::PierCircle => self.pier_circle(stand_off_m),
            TaskKind::BarrelSoffit => self.barrel_soffit(stand_off_m, place),
            TaskKind::ArchRing => self.arch_ring(stand_off_m, place),
            TaskKind::ArchBottom
            | TaskKind::Interlayer
            | TaskKind::GirderSoffit
            | TaskKind::BearingLine
            | TaskKind::PierCap
            | TaskKind::TrussPanel
            | TaskKind::FloorSystem
            | TaskKind::StayCable
            | TaskKind::Free => Err(self.supported_kinds()),
        }
    }
}

// Dimensions that follow from others.
impl MasonryArch {
    /// Returns the radius of the intrados in meters.
    #[must_use]
    pub fn radius_m(&self) -> f64 {
        let half_m = 0.5 * self.clear_span_m;
        (half_m * half_m + self.rise_m * self.rise_m) / (2.0 * self.rise_m)
    }

    /// Returns the depth of the keystone by Trautwine's rule in meters: a quarter of the root of the radius and half of the span, plus
    /// 0.2 ft, all in feet (Trautwine, *Civil Engineer's Pocket-Book*, first-class cut stone).
    #[must_use]
    pub fn keystone_m(&self) -> f64 {
        let sum_ft = (self.radius_m() + 0.5 * self.clear_span_m) / FOOT_M;
        (0.25 * sum_ft.sqrt() + 0.2) * FOOT_M
    }

    /// Returns sine and cosine of the angle between the crown and a springing.
    fn springing(&self) -> (f64, f64) {
        let radius_m = self.radius_m();
        (0.5 * self.clear_span_m / radius_m, (radius_m - self.rise_m) / radius_m)
    }

    /// Returns the angle between the crown and a springing.
    fn half_angle_rad(&self) -> f64 {
        let (sine, cosine) = self.springing();
        math::atan2(sine, cosine)
    }

    /// Returns the height of the springings in meters.
    #[must_use]
    pub fn springing_z_m(&self) -> f64 {
        -self.cover_m - self.ring_m - self.rise_m
    }

    /// Returns the height of the centers of the intrados in meters.
    fn center_z_m(&self) -> f64 {
        -self.cover_m - self.ring_m - self.radius_m()
    }

    /// Returns the height of the undersides of piers and abutments in meters.
    fn base_z_m(&self) -> f64 {
        self.springing_z_m() - self.pier_height_m
    }

    /// Returns the width of the road between the parapets in meters.
    fn road_width_m(&self) -> f64 {
        self.width_m - 2.0 * PARAPET_M
    }

    /// Returns the positions of the crowns.
    #[must_use]
    pub fn span_centers(&self) -> Vec<f64> {
        let pitch_m = self.clear_span_m + self.pier_m;
        let spans = self.spans.round();
        (0..spans as i32).map(|k| (f64::from(k) - 0.5 * (spans - 1.0)) * pitch_m).collect()
    }

    /// Returns the positions of the piers' axes.
    #[must_use]
    pub fn piers(&self) -> Vec<f64> {
        self.span_centers().windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect()
    }

    /// Returns the number of voussoirs of a barrel: odd, so that there is a keystone.
    #[must_use]
    pub fn voussoirs(&self) -> i32 {
        let half = (self.half_angle_rad() * self.radius_m() / VOUSSOIR_M).ceil() as i32;
        2 * half + 1
    }

    /// Returns half the angle of a voussoir.
    fn voussoir_half_angle_rad(&self) -> f64 {
        self.half_angle_rad() / f64::from(self.voussoirs())
    }

    /// Returns the point at an angle from the crown and a distance from the center of the intrados.
    fn at(&self, center: f64, angle_rad: f64, radius_m: f64) -> Node {
        let (s, c) = math::sin_cos(angle_rad);
        [center + radius_m * s, self.center_z_m() + radius_m * c]
    }

    /// Returns the angles of the joints between the voussoirs.
    fn joints(&self) -> Vec<f64> {
        let (count, half) = (self.voussoirs(), self.half_angle_rad());
        (0..=count).map(|k| half * (2.0 * f64::from(k) / f64::from(count) - 1.0)).collect()
    }

    /// Returns the distance from a springing to the end of the extrados, along the bridge and up, in meters.
    fn skewback_m(&self) -> (f64, f64) {
        let (sine, cosine) = self.springing();
        (self.ring_m * sine, self.ring_m * cosine)
    }
}

// Members.
impl MasonryArch {
    /// Adds a barrel of voussoirs, and the walls and the fill above it.
    fn add_barrel(&self, b: &mut MemberBuilder, number: usize, center: f64) {
        let (radius_m, half) = (self.radius_m(), 0.5 * self.width_m);
        for (k, pair) in self.joints().windows(2).enumerate() {
            let [inner, outer] =
                [radius_m, radius_m + self.ring_m].map(|r| [self.at(center, pair[0], r), self.at(center, pair[1], r)]);
            let profile = [inner[0], inner[1], outer[1], outer[0]];
            b.add_extrusion(&format!("arch-{number}/{k:02}"), Element::MasonryArch, &profile, -half, half);
            self.add_spandrel(b, &format!("{number}/{k:02}"), outer[0], outer[1]);
        }
    }

    /// Adds spandrel walls, fill and road between two points of their underside.
    fn add_spandrel(&self, b: &mut MemberBuilder, name: &str, from: Node, to: Node) {
        let outer = 0.5 * self.width_m;
        let inner = outer - self.wall_m;
        let up_to = |z: f64| [from, to, [to[0], z], [from[0], z]];
        b.add_extrusion(&format!("spandrel-left/{name}"), Element::MasonryArch, &up_to(0.0), inner, outer);
        b.add_extrusion(&format!("spandrel-right/{name}"), Element::MasonryArch, &up_to(0.0), -outer, -inner);
        b.add_extrusion(&format!("fill/{name}"), Element::FILL, &up_to(-ROAD_M), -inner, inner);
        b.add_box(&format!("road/{name}"), Element::WearingSurface, [from[0], -inner, -ROAD_M], [to[0], inner, 0.0]);
    }

    /// Adds a pier with its skewbacks and its cutwaters, and the walls and the fill above it.
    fn add_pier(&self, b: &mut MemberBuilder, number: usize, x: f64) {
        let (half, half_width) = (0.5 * self.pier_m, 0.5 * self.width_m);
        let (base, top) = (self.base_z_m(), self.springing_z_m());
        let (back_m, up_m) = self.skewback_m();
        let name = format!("pier-{number}");
        let element = Element::MasonryPierWall;
        b.add_box(&format!("{name}/shaft"), element, [x - half, -half_width, base], [x + half, half_width, top]);
        let upper = half - back_m;
        let skewbacks = [[x - half, top], [x + half, top], [x + upper, top + up_m], [x - upper, top + up_m]];
        b.add_extrusion(&format!("{name}/skewback"), element, &skewbacks, -half_width, half_width);
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            self.add_cutwater(b, &format!("{name}/{side}"), x, sign);
        }
        self.add_spandrel(b, &format!("pier-{number}"), [x - upper, top + up_m], [x + upper, top + up_m]);
    }

    /// Adds a triangular cutwater and its sloping cap.
    fn add_cutwater(&self, b: &mut MemberBuilder, name: &str, x: f64, sign: f64) {
        let (base, top) = (self.base_z_m(), self.springing_z_m());
        let [a, tip, c] = self.cutwater_plan(x, sign);
        // Counterclockwise from above.
        let plan = if sign > 0.0 { [c, tip, a] } else { [a, tip, c] };
        let corners: Vec<LocalPoint> = [base, top].into_iter().flat_map(|z| plan.map(|[x, y]| [x, y, z])).collect();
        let faces = vec![vec![2, 1, 0], vec![3, 4, 5], vec![0, 1, 4, 3], vec![1, 2, 5, 4], vec![2, 0, 3, 5]];
        b.add_solid(&format!("{name}/cutwater"), Element::MasonryPierWall, &corners, faces);
        let mut cap: Vec<LocalPoint> = plan.iter().map(|[x, y]| [*x, *y, top]).collect();
        cap.push([x, sign * 0.5 * self.width_m, self.cap_top_z_m()]);
        let faces = vec![vec![2, 1, 0], vec![0, 1, 3], vec![1, 2, 3], vec![2, 0, 3]];
        b.add_solid(&format!("{name}/cap"), Element::MasonryPierWall, &cap, faces);
    }

    /// Returns the corners of a cutwater: two at the pier, with the tip between them.
    fn cutwater_plan(&self, x: f64, sign: f64) -> [PlanPoint; 3] {
        let (half, y) = (0.5 * self.pier_m, sign * 0.5 * self.width_m);
        [[x - half, y], [x, y + sign * self.cutwater_m], [x + half, y]]
    }

    /// Returns the height of the tops of the cutwaters' caps in meters.
    fn cap_top_z_m(&self) -> f64 {
        self.springing_z_m() + CAP_SHARE * self.cutwater_m
    }

    /// Adds an abutment with its skewback, the walls and the fill above it, and its wing walls with the road between them.
    fn add_abutment(&self, b: &mut MemberBuilder, name: &str, side: f64) {
        let (half, base, top) = (0.5 * self.width_m, self.base_z_m(), self.springing_z_m());
        let (front, back, end) =
            (self.opening_half_length_m(), self.opening_half_length_m() + self.abutment_m, 0.5 * self.deck_length_m());
        let (back_m, up_m) = self.skewback_m();
        let element = Element::MasonryAbutment;
        let between = |a: f64, b: f64| math::range([side * a, side * b].into_iter());
        let (low, high) = between(front, back);
        b.add_box(&format!("abutment-{name}/stem"), element, [low, -half, base], [high, half, top]);
        let skewback = [[front, top], [back, top], [back, top + up_m], [front + back_m, top + up_m]].map(|[x, z]| [side * x, z]);
        let [p, q, r, s] = skewback;
        let profile = if side > 0.0 { [p, q, r, s] } else { [q, p, s, r] };
        b.add_extrusion(&format!("abutment-{name}/skewback"), element, &profile, -half, half);
        let (low, high) = between(front + back_m, back);
        self.add_spandrel(b, &format!("abutment-{name}"), [low, top + up_m], [high, top + up_m]);
        let inner = half - self.wall_m;
        let (low, high) = between(back, end);
        b.add_box(&format!("abutment-{name}/wing-left"), element, [low, inner, base], [high, half, 0.0]);
        b.add_box(&format!("abutment-{name}/wing-right"), element, [low, -half, base], [high, -inner, 0.0]);
        b.add_box(&format!("road/approach-{name}"), Element::WearingSurface, [low, -inner, -ROAD_M], [high, inner, 0.0]);
    }

    fn add_parapets(&self, b: &mut MemberBuilder) {
        let (length_m, outer) = (self.deck_length_m(), 0.5 * self.width_m);
        let count = (length_m / PARAPET_PIECE_M).ceil();
        let end = |k: i32| length_m * (f64::from(k) / count - 0.5);
        for (side, low, high) in [("left", outer - PARAPET_M, outer), ("right", -outer, PARAPET_M - outer)] {
            for k in 0..count as i32 {
                let name = format!("parapet-{side}/{k:02}");
                b.add_box(&name, Element::MasonryRailing, [end(k), low, 0.0], [end(k + 1), high, self.parapet_m]);
            }
        }
    }
}

// Task paths.
impl MasonryArch {
    /// Returns the crown of the span of a task.
    fn span_center(&self, place: &PathPlace) -> Result<f64, String> {
        let centers = self.span_centers();
        let number = place.span.unwrap_or(centers.len() / 2 + 1);
        let center = number.checked_sub(1).and_then(|k| centers.get(k));
        center.copied().ok_or_else(|| format!("span_number = 1 to {}", centers.len()))
    }

    /// Returns a straight line along the right spandrel wall and its parapet, facing the wall halfway between the road and the crown. It
    /// keeps the stand-off from the cutwaters.
    fn spandrel_side(&self, stand_off_m: f64) -> Result<LocalPath, String> {
        let half = self.opening_half_length_m() - stand_off_m;
        if half <= 0.0 {
            return Err("a bridge that is longer than 2 stand_off_m".into());
        }
        let z = -0.5 * self.cover_m;
        let y = -0.5 * self.width_m - self.away_from_cutwaters_m(z, stand_off_m);
        let points: Vec<LocalPoint> = equal_steps(-half, half).into_iter().map(|x| [x, y, z]).collect();
        Ok(LocalPath { viewing_directions: vec![[0.0, 1.0, 0.0]; points.len()], points, closed: false })
    }

    /// Returns the distance from the spandrel walls that keeps the stand-off from them, from the tips of the cutwaters and from the ridges of
    /// their caps.
    fn away_from_cutwaters_m(&self, z: f64, stand_off_m: f64) -> f64 {
        if self.piers().is_empty() {
            return stand_off_m;
        }
        let over_m = z - self.springing_z_m();
        let beside_tip_m = (stand_off_m * stand_off_m - over_m * over_m).max(0.0).sqrt();
        // High above the tip, the ridge is nearer, which rises by the cap's share.
        let from_tip_m = if beside_tip_m >= CAP_SHARE * over_m {
            beside_tip_m
        } else {
            ((1.0 + CAP_SHARE * CAP_SHARE).sqrt() * stand_off_m - over_m) / CAP_SHARE
        };
        stand_off_m.max(self.cutwater_m + from_tip_m)
    }

    /// Returns a curve below the barrel of a span, at the stand-off distance from the voussoirs, piers and abutments. The views pan over
    /// the width of the barrel.
    fn barrel_soffit(&self, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String> {
        let center = self.span_center(place)?;
        // Voussoirs are flat, so that their middles are nearer to the center than the intrados.
        let radius_m = self.radius_m() * math::cos(self.voussoir_half_angle_rad()) - stand_off_m;
        let reach_m = 0.5 * self.clear_span_m - stand_off_m;
        if radius_m < MIN_PATH_RADIUS_M || reach_m < SPACING_M {
            return Err("a wider or higher arch (clear_span_m, rise_m) or a smaller stand_off_m".into());
        }
        let sine = (reach_m / radius_m).min(1.0);
        let angle_rad = math::atan2(sine, (1.0 - sine * sine).max(0.0).sqrt());
        let mut path = LocalPath { points: Vec::new(), viewing_directions: Vec::new(), closed: false };
        for (k, arc_m) in equal_steps(-angle_rad * radius_m, angle_rad * radius_m).into_iter().enumerate() {
            let (s, c) = math::sin_cos(arc_m / radius_m);
            let [x, z] = self.at(center, arc_m / radius_m, radius_m);
            let aside_m = PAN.0 * self.width_m * math::sin(math::TAU * k as f64 / PAN.1);
            path.points.push([x, 0.0, z]);
            path.viewing_directions.push([stand_off_m * s, aside_m, stand_off_m * c]);
        }
        Ok(path)
    }

    /// Returns a curve along the right face of the arch ring of a span, facing the middle of the ring, as far down as the stand-off from the
    /// cutwaters permits.
    fn arch_ring(&self, stand_off_m: f64, place: &PathPlace) -> Result<LocalPath, String> {
        let center = self.span_center(place)?;
        let radius_m = self.radius_m() + 0.5 * self.ring_m;
        if radius_m < MIN_PATH_RADIUS_M {
            return Err("a wider or higher arch (clear_span_m, rise_m)".into());
        }
        let y = -0.5 * self.width_m - stand_off_m;
        let is_clear = |angle_rad: f64| {
            let [x, z] = self.at(center, angle_rad, radius_m);
            let over_m = (z - self.cap_top_z_m()).max(0.0);
            self.piers().into_iter().all(|pier| {
                let aside_m = plan_polygon::distance_m(&self.cutwater_plan(pier, -1.0), [x, y]);
                math::hypot(aside_m, over_m) >= stand_off_m
            })
        };
        // The path is symmetric, so that it looks the same from both springings.
        let half = self.half_angle_rad();
        let steps = (half * radius_m / SPACING_M).ceil();
        let clear = (0..=steps as i32).map(|k| half * f64::from(k) / steps).take_while(|a| is_clear(*a) && is_clear(-*a));
        let Some(reach_rad) = clear.last().filter(|reach| *reach > 0.0) else {
            return Err("shorter cutwaters (cutwater_m), a higher arch (rise_m) or another stand_off_m".into());
        };
        let arcs = equal_steps(-reach_rad * radius_m, reach_rad * radius_m);
        let points: Vec<LocalPoint> = arcs
            .into_iter()
            .map(|arc_m| {
                let [x, z] = self.at(center, arc_m / radius_m, radius_m);
                [x, y, z]
            })
            .collect();
        Ok(LocalPath { viewing_directions: vec![[0.0, 1.0, 0.0]; points.len()], points, closed: false })
    }

    /// Returns one loop around the first pier and its cutwaters at the stand-off distance, facing them, as high as the stand-off from the
    /// barrels permits.
    fn pier_circle(&self, stand_off_m: f64) -> Result<LocalPath, String> {
        let Some(pier) = self.piers().first().copied() else { return Err("a bridge with piers".into()) };
        if self.clear_span_m < 2.0 * stand_off_m {
            return Err("a clear_span_m of at least 2 stand_off_m".into());
        }
        let z = self.height_below_barrels_m(stand_off_m);
        if z < self.base_z_m() + 0.5 {
            return Err("higher piers (pier_height_m) or a smaller stand_off_m".into());
        }
        let [a, right, c] = self.cutwater_plan(pier, -1.0);
        let [d, left, e] = self.cutwater_plan(pier, 1.0);
        let (points, normals) = plan_polygon::loop_around(&[a, right, c, e, left, d], stand_off_m);
        let points = points.into_iter().map(|[x, y]| [x, y, z]).collect();
        let viewing_directions = normals.into_iter().map(|[nx, ny]| [-nx, -ny, 0.0]).collect();
        Ok(LocalPath { points, viewing_directions, closed: true })
    }

    /// Returns the greatest height, at most at the springings, at which a path between the stand-offs from the pier and from the opposite
    /// side of a span keeps the stand-off from the voussoirs.
    fn height_below_barrels_m(&self, stand_off_m: f64) -> f64 {
        let at_joint = self.joints().into_iter().map(|angle| self.at(0.0, angle, self.radius_m()));
        let nodes: Vec<Node> = at_joint.collect();
        let x = stand_off_m - 0.5 * self.clear_span_m;
        let below = |pair: &[Node]| plan_polygon::height_below_edge_m((pair[0], pair[1]), x, stand_off_m);
        nodes.windows(2).map(below).fold(self.springing_z_m(), f64::min)
    }
}
