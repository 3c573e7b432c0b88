//! Static geometry: bridge members, ground, water, landing pad. A bounding-volume tree (from parry, in f64) finds candidate
//! members; [`MemberShape`] and [`HeightGrid`](super::heights::HeightGrid) compute the exact results.

use super::convex::SurfacePoint;
use super::member_shape::MemberShape;
use super::query_types::{Contact, HullProbe, NearestPoint, ObjectId, RayHit, Surface};
use super::terrain::Terrain;
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::scenario::bridges::Member;
use crate::scenario::bridges::solid::{MemberBuilder, Placement};
use crate::scenario::{GroundTeam, Scenario};
use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::math::Vector;
use rapier3d::parry::partitioning::{Bvh, BvhBuildStrategy, BvhLeafCost, BvhNode};

/// Ground object ID.
pub const GROUND: ObjectId = ObjectId(900_000);
/// Water object ID.
pub const WATER: ObjectId = ObjectId(900_001);
/// Landing pad object ID.
pub const PAD: ObjectId = ObjectId(900_002);

const UP: Vec3<Enu> = Vec3::new(0.0, 0.0, 1.0);
/// Thickness of the landing pad, m. Its upper surface is 0.05 m above the ground.
const PAD_THICKNESS_M: f64 = 0.3;

/// Static geometry of a site, with its spatial queries.
#[derive(Debug)]
pub struct Geometry {
    members: Vec<Member>,
    shapes: Vec<MemberShape>,
    tree: Bvh,
    /// Ground surface and water level.
    pub terrain: Terrain,
    pad: Member,
    pad_shape: MemberShape,
    pad_m: Vec3<Enu>,
    pad_half_m: f64,
}

fn vector(v: Vec3<Enu>) -> Vector {
    Vector::new(v.east(), v.north(), v.up())
}

/// Part of a ray that is inside a member.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passage {
    /// Index of the member.
    pub member: usize,
    /// Distance along the ray at which it enters the member, m.
    pub enter_m: f64,
    /// Distance along the ray at which it leaves the member, m.
    pub leave_m: f64,
}

fn inverse_of(direction: Vec3<Enu>) -> Vector {
    Vector::new(1.0 / direction.east(), 1.0 / direction.north(), 1.0 / direction.up())
}

/// Returns where a ray enters and leaves a node's box. The ray misses the box if the first distance is larger.
fn box_interval(node: &BvhNode, from: Vector, inverse: Vector) -> (f64, f64) {
    let (low, high) = ((node.mins() - from) * inverse, (node.maxs() - from) * inverse);
    // A zero direction component yields 0/0 if the origin is on a side of the box; min and max ignore NaN.
    let enter = low.x.min(high.x).max(low.y.min(high.y)).max(low.z.min(high.z)).max(0.0);
    let leave = low.x.max(high.x).min(low.y.max(high.y)).min(low.z.max(high.z));
    (enter, leave)
}

/// A leaf found in the bounding-volume tree, ordered by distance.
struct LeafHit<T> {
    distance_m: f64,
    result: T,
}

impl<T> BvhLeafCost for LeafHit<T> {
    fn cost(&self) -> f64 {
        self.distance_m
    }
}

impl Geometry {
    /// Builds a scenario's bridges, ground and landing pad.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let members: Vec<Member> = scenario.bridges.iter().flat_map(crate::scenario::Bridge::members).collect();
        let shapes: Vec<MemberShape> = members.iter().map(|m| MemberShape::new(&m.solid)).collect();
        let boxes: Vec<Aabb> = shapes
            .iter()
            .map(|s| {
                let (low, high) = s.bounds();
                Aabb::new(vector(low), vector(high))
            })
            .collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        let GroundTeam { pad_m, pad_half_m, .. } = scenario.ground_team;
        let pad = pad_slab(pad_m, pad_half_m);
        let pad_shape = MemberShape::new(&pad.solid);
        Self { members, shapes, tree, terrain: Terrain::new(scenario), pad, pad_shape, pad_m, pad_half_m }
    }

    /// Returns the bridge members.
    #[must_use]
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// Returns the landing pad: a level square slab embedded in the ground.
    #[must_use]
    pub fn pad(&self) -> &Member {
        &self.pad
    }

    /// Returns the collision shape of a member by its index; `None` if there is no such member.
    #[must_use]
    pub fn shape(&self, member: usize) -> Option<&MemberShape> {
        self.shapes.get(member)
    }

    /// Returns the center of the landing pad and half its side length, m.
    #[must_use]
    pub fn pad_square_m(&self) -> (Vec3<Enu>, f64) {
        (self.pad_m, self.pad_half_m)
    }

    fn is_over_pad(&self, p: Vec3<Enu>) -> bool {
        (p.east() - self.pad_m.east()).abs() <= self.pad_half_m && (p.north() - self.pad_m.north()).abs() <= self.pad_half_m
    }

    /// Returns the height of the ground or pad below a point, in meters above the origin.
    #[must_use]
    pub fn ground_up_m(&self, east_m: f64, north_m: f64) -> f64 {
        let height = self.terrain.ground.ground(east_m, north_m).0;
        if self.is_over_pad(Vec3::new(east_m, north_m, 0.0)) { height.max(self.pad_m.up()) } else { height }
    }

    /// Returns the nearest member within `max_m`.
    #[must_use]
    pub fn nearest_member(&self, p: Vec3<Enu>, max_m: f64) -> Option<NearestPoint> {
        let at = vector(p);
        // The tree search excludes the limit itself, but must find a member at exactly that distance.
        let limit = max_m.next_up();
        let to_box = |node: &BvhNode, _: f64| {
            let over = (node.mins() - at).max(at - node.maxs());
            // Inside a bounding box, the depth cannot exceed the distance to the nearest face.
            if over.max_element() < 0.0 { over.max_element() } else { over.max(Vector::ZERO).length() }
        };
        let to_member = |leaf: u32, best_m: f64| {
            let near = self.shapes[leaf as usize].nearest_within(p, best_m)?;
            (near.distance_m < best_m).then_some(LeafHit { distance_m: near.distance_m, result: near })
        };
        let (leaf, found) = self.tree.find_best(limit, to_box, to_member)?;
        let SurfacePoint { distance_m, point_m, normal } = found.result;
        Some(NearestPoint { distance_m, point_m, normal, surface: Surface::Bridge, object: ObjectId(leaf) })
    }

    /// Returns the nearest point of members, ground and water within `max_m`. Ignores the ground over the landing pad.
    #[must_use]
    pub fn nearest(&self, p: Vec3<Enu>, max_m: f64) -> Option<NearestPoint> {
        let mut best: Option<NearestPoint> = None;
        let mut offer = |found: Option<SurfacePoint>, surface: Surface, object: ObjectId| {
            if let Some(SurfacePoint { distance_m, point_m, normal }) = found
                && distance_m <= max_m
                && best.is_none_or(|b| distance_m < b.distance_m)
            {
                best = Some(NearestPoint { distance_m, point_m, normal, surface, object });
            }
            best.map_or(max_m, |b| b.distance_m)
        };
        let reach = offer(Some(self.water_point(p)), Surface::Water, WATER);
        let reach =
            if self.is_over_pad(p) { reach } else { offer(self.terrain.ground.nearest(p, reach), Surface::Terrain, GROUND) };
        self.nearest_member(p, reach).or(best)
    }

    /// Returns the distance to the nearest surface, including landing pad and water, if it is less than `max_m`. Nothing inside a
    /// sphere of this radius about `p` can touch static geometry.
    #[must_use]
    pub fn free_radius(&self, p: Vec3<Enu>, max_m: f64) -> Option<f64> {
        let slab = self.pad_shape.nearest(p).distance_m.min(max_m);
        let reach = self.terrain.ground.nearest(p, slab).map_or(slab, |near| near.distance_m).min(self.water_point(p).distance_m);
        let free = self.nearest_member(p, reach).map_or(reach, |near| near.distance_m);
        (free < max_m).then_some(free)
    }

    /// Returns the distance of a point from the landing pad, in meters; negative inside.
    #[must_use]
    pub fn pad_distance_m(&self, p: Vec3<Enu>) -> f64 {
        self.pad_shape.nearest(p).distance_m
    }

    /// Returns the point of a segment with the smallest distance to any surface, and the nearest surface point, if the distance
    /// is below `less_than_m`. The result is accurate to one millimeter.
    #[must_use]
    pub fn min_clearance(&self, from: Vec3<Enu>, to: Vec3<Enu>, less_than_m: f64) -> Option<(Vec3<Enu>, NearestPoint)> {
        const ACCURACY_M: f64 = 1e-3;
        let middle = (from + to) * 0.5;
        let half_m = 0.5 * (to - from).norm();
        // Over one meter, the distance to a surface changes by at most one meter.
        let near = self.nearest(middle, less_than_m + half_m)?;
        if near.distance_m - half_m >= less_than_m {
            return None;
        }
        let here = (near.distance_m < less_than_m).then_some((middle, near));
        if half_m <= ACCURACY_M {
            return here;
        }
        let limit = |best: &Option<(Vec3<Enu>, NearestPoint)>| best.map_or(less_than_m, |b| b.1.distance_m);
        let first = self.min_clearance(from, middle, limit(&here)).or(here);
        self.min_clearance(middle, to, limit(&first)).or(first)
    }

    fn water_point(&self, p: Vec3<Enu>) -> SurfacePoint {
        let distance_m = p.up() - self.terrain.water_m;
        SurfacePoint { distance_m, point_m: p - UP * distance_m, normal: UP }
    }

    /// Returns the first hit of a ray with members, ground, pad or water.
    #[must_use]
    pub fn ray(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<RayHit> {
        let mut best: Option<RayHit> = None;
        let mut offer = |found: Option<(f64, Vec3<Enu>)>, surface: Surface, object: ObjectId| {
            if let Some((distance_m, normal)) = found
                && distance_m <= max_m
                && best.is_none_or(|b| distance_m < b.distance_m)
            {
                best = Some(RayHit { distance_m, normal, surface, object });
            }
            best.map_or(max_m, |b| b.distance_m)
        };
        let depth = |t: &f64| *t >= 0.0 && direction.up() < 0.0;
        let water = Some((self.terrain.water_m - origin.up()) / direction.up()).filter(depth);
        let reach = offer(water.map(|t| (t, UP)), Surface::Water, WATER);
        let reach = if self.may_hit_pad(origin, direction, reach) {
            offer(self.pad_shape.ray(origin, direction, reach), Surface::Pad, PAD)
        } else {
            reach
        };
        let reach = offer(self.terrain.ground.ray(origin, direction, reach), Surface::Terrain, GROUND);
        self.ray_member(origin, direction, reach).or(best)
    }

    /// Returns false only if a ray misses the sphere around the landing pad.
    fn may_hit_pad(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> bool {
        let to_pad = self.pad_m - origin;
        let along_m = to_pad.dot(direction).max(0.0).min(max_m);
        let reach_m = 2.0 * self.pad_half_m + PAD_THICKNESS_M;
        (to_pad - direction * along_m).norm_squared() <= reach_m * reach_m
    }

    fn ray_member(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<RayHit> {
        let from = vector(origin);
        let inverse = inverse_of(direction);
        let to_box = |node: &BvhNode, best_m: f64| {
            let (enter, leave) = box_interval(node, from, inverse);
            if enter <= leave && enter <= best_m { enter } else { f64::MAX }
        };
        let to_member = |leaf: u32, best_m: f64| {
            let (distance_m, normal) = self.shapes[leaf as usize].ray(origin, direction, best_m)?;
            Some(LeafHit { distance_m, result: normal })
        };
        let (leaf, found) = self.tree.find_best(max_m.next_up(), to_box, to_member)?;
        Some(RayHit { distance_m: found.distance_m, normal: found.result, surface: Surface::Bridge, object: ObjectId(leaf) })
    }

    /// Returns the parts of a ray that are inside members, sorted by the entry.
    #[must_use]
    pub fn passages(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, length_m: f64) -> Vec<Passage> {
        let (from, inverse) = (vector(origin), inverse_of(direction));
        let is_crossed = |node: &BvhNode| {
            let (enter, leave) = box_interval(node, from, inverse);
            enter <= leave && enter <= length_m
        };
        let inside = |leaf: u32| {
            let through = self.shapes[leaf as usize].passages(origin, direction, length_m);
            through.into_iter().map(move |(enter_m, leave_m)| Passage { member: leaf as usize, enter_m, leave_m })
        };
        let mut passages: Vec<Passage> = self.tree.leaves(is_crossed).flat_map(inside).collect();
        passages.sort_by(|a, b| a.enter_m.total_cmp(&b.enter_m).then(a.member.cmp(&b.member)));
        passages
    }

    /// Returns the distance at which a ray hits the ground or the water within `max_m`, m.
    #[must_use]
    pub fn ground_hit_m(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<f64> {
        let ground = self.terrain.ground.ray(origin, direction, max_m).map(|(distance_m, _)| distance_m);
        let water = Some((self.terrain.water_m - origin.up()) / direction.up());
        let water = water.filter(|at_m| direction.up() < 0.0 && (0.0..=max_m).contains(at_m));
        ground.into_iter().chain(water).min_by(f64::total_cmp)
    }

    /// Returns whether something hides a point from another one. Objects within `margin_m` of the point do not count.
    #[must_use]
    pub fn hides(&self, from: Vec3<Enu>, point_m: Vec3<Enu>, margin_m: f64) -> bool {
        let line = point_m - from;
        let reach_m = line.norm() - margin_m;
        reach_m > 0.0 && self.ray(from, line.unit(), reach_m).is_some()
    }

    /// Appends the contacts of a probe with members, ground, landing pad and water.
    pub fn contacts(&self, probe: &HullProbe, margin_m: f64, out: &mut Vec<Contact>) {
        let (low, high) = probe_bounds(probe, margin_m);
        let around = Aabb::new(vector(low), vector(high));
        let first = out.len();
        for leaf in self.tree.intersect_aabb(&around) {
            add_shape_contacts(probe, margin_m, &self.shapes[leaf as usize], (Surface::Bridge, ObjectId(leaf)), out);
        }
        // The search order depends on the shape of the tree, so the contacts are sorted by member.
        out[first..].sort_by_key(|c| c.object.0);
        if overlaps_pad(&self.pad_shape, low, high) {
            add_shape_contacts(probe, margin_m, &self.pad_shape, (Surface::Pad, PAD), out);
        }
        self.ground_and_water_contacts(probe, margin_m, (low, high), out);
    }

    fn ground_and_water_contacts(
        &self,
        probe: &HullProbe,
        margin_m: f64,
        (low, high): (Vec3<Enu>, Vec3<Enu>),
        out: &mut Vec<Contact>,
    ) {
        if !self.terrain.ground.is_below(low, high, low.up()) {
            self.ground_contacts(probe, margin_m, out);
        }
        if low.up() > self.terrain.water_m {
            return;
        }
        for (p, radius) in probe_ends(probe) {
            let water = self.water_point(p);
            // There is water only where the ground is below the water level.
            if water.distance_m <= radius + margin_m && self.terrain.ground.ground(p.east(), p.north()).0 < self.terrain.water_m {
                out.push(contact(water, radius, Surface::Water, WATER));
            }
        }
    }

    /// Appends the ground contacts at the ends of a probe, and between the ends if the probe lies across a ridge.
    fn ground_contacts(&self, probe: &HullProbe, margin_m: f64, out: &mut Vec<Contact>) {
        let mut ends_m = f64::INFINITY;
        for (p, radius) in probe_ends(probe) {
            if let Some(near) = self.terrain.ground.nearest(p, radius + margin_m) {
                ends_m = ends_m.min(near.distance_m);
                out.push(contact(near, radius, Surface::Terrain, GROUND));
            }
        }
        if let HullProbe::Capsule { a_m, b_m, radius_m } = *probe
            && let Some(near) = self.terrain.ground.interior_minimum(a_m, b_m, ends_m, radius_m + margin_m)
        {
            out.push(contact(near, radius_m, Surface::Terrain, GROUND));
        }
    }
}

fn pad_slab(center_m: Vec3<Enu>, half_m: f64) -> Member {
    let mut builder = MemberBuilder::new("site", Placement::new(center_m, 90.0));
    // The pad is not part of a bridge and has no element number.
    builder.add_box("pad", Element::Unlisted(0), [-half_m, -half_m, -PAD_THICKNESS_M], [half_m, half_m, 0.0]);
    builder.finish().swap_remove(0)
}

fn overlaps_pad(pad: &MemberShape, low: Vec3<Enu>, high: Vec3<Enu>) -> bool {
    let (pad_low, pad_high) = pad.bounds();
    let apart = |k: usize| low.array()[k] > pad_high.array()[k] || high.array()[k] < pad_low.array()[k];
    !(0..3).any(apart)
}

fn contact(near: SurfacePoint, radius_m: f64, surface: Surface, object: ObjectId) -> Contact {
    Contact {
        point_m: near.point_m,
        normal: near.normal,
        gap_m: near.distance_m - radius_m,
        velocity_m_s: Vec3::zero(),
        surface,
        object,
    }
}

fn probe_ends(probe: &HullProbe) -> impl Iterator<Item = (Vec3<Enu>, f64)> {
    let (ends, count, radius) = match *probe {
        HullProbe::Ball { center_m, radius_m } => ([center_m, center_m], 1, radius_m),
        HullProbe::Capsule { a_m, b_m, radius_m } => ([a_m, b_m], 2, radius_m),
    };
    ends.into_iter().take(count).map(move |p| (p, radius))
}

/// Returns the corners of a probe's axis-aligned bounding box, including its margin.
fn probe_bounds(probe: &HullProbe, margin_m: f64) -> (Vec3<Enu>, Vec3<Enu>) {
    let (a, b, radius) = match *probe {
        HullProbe::Ball { center_m, radius_m } => (center_m.array(), center_m.array(), radius_m),
        HullProbe::Capsule { a_m, b_m, radius_m } => (a_m.array(), b_m.array(), radius_m),
    };
    let reach = radius + margin_m;
    let pick = |f: fn(f64, f64) -> f64, by: f64| Vec3::new(f(a[0], b[0]) + by, f(a[1], b[1]) + by, f(a[2], b[2]) + by);
    (pick(f64::min, -reach), pick(f64::max, reach))
}

/// Appends a probe's contacts with one shape.
fn add_shape_contacts(
    probe: &HullProbe,
    margin_m: f64,
    shape: &MemberShape,
    (surface, object): (Surface, ObjectId),
    out: &mut Vec<Contact>,
) {
    shape.contacts(probe, margin_m, |near, radius_m| {
        if near.distance_m - radius_m <= margin_m {
            out.push(contact(near, radius_m, surface, object));
        }
    });
}
