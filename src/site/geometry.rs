//! What stands still: bridge members, ground, water, pad. Members are found through a bounding-volume tree (parry's, in f64); the
//! exact questions are answered by [`Convex`].

use super::convex::{Convex, SurfacePoint};
use super::terrain::Terrain;
use super::{Contact, Nearest, ObjectId, Probe, RayHit, Surface};
use crate::base::frames::{Enu, Vec3};
use crate::scenario::bridges::Member;
use crate::scenario::{GroundTeam, Scenario};
use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::math::Vector;
use rapier3d::parry::partitioning::{Bvh, BvhBuildStrategy};
use rapier3d::parry::query::{PointProjection, Ray};

/// The ground.
pub const GROUND: ObjectId = ObjectId(900_000);
/// The water.
pub const WATER: ObjectId = ObjectId(900_001);
/// The pad.
pub const PAD: ObjectId = ObjectId(900_002);

/// Static geometry of a site.
#[derive(Debug)]
pub struct Geometry {
    members: Vec<Member>,
    shapes: Vec<Convex>,
    tree: Bvh,
    /// Ground and water level.
    pub terrain: Terrain,
    pad_m: Vec3<Enu>,
    pad_half_m: f64,
}

fn vector(v: Vec3<Enu>) -> Vector {
    Vector::new(v.east(), v.north(), v.up())
}

impl Geometry {
    /// Builds bridges, ground and pad.
    #[must_use]
    pub fn new(scenario: &Scenario) -> Self {
        let members: Vec<Member> = scenario.bridges.iter().flat_map(crate::scenario::Bridge::members).collect();
        let shapes: Vec<Convex> = members.iter().map(|m| Convex::new(&m.solid)).collect();
        let boxes: Vec<Aabb> = shapes
            .iter()
            .map(|s| {
                let (low, high) = s.bounds();
                Aabb::new(vector(low), vector(high))
            })
            .collect();
        let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
        let GroundTeam { pad_m, pad_half_m, .. } = scenario.ground_team;
        Self { members, shapes, tree, terrain: Terrain::new(scenario), pad_m, pad_half_m }
    }

    /// Bridge members.
    #[must_use]
    pub fn members(&self) -> &[Member] {
        &self.members
    }

    /// Centre of the pad's upper surface and half its side, m.
    #[must_use]
    pub fn pad(&self) -> (Vec3<Enu>, f64) {
        (self.pad_m, self.pad_half_m)
    }

    /// The shape of a member.
    #[must_use]
    pub fn shape(&self, member: usize) -> Option<&Convex> {
        self.shapes.get(member)
    }

    fn over_pad(&self, p: Vec3<Enu>) -> bool {
        (p.east() - self.pad_m.east()).abs() <= self.pad_half_m && (p.north() - self.pad_m.north()).abs() <= self.pad_half_m
    }

    /// Height of ground or pad under a point, m up.
    #[must_use]
    pub fn ground_up_m(&self, east_m: f64, north_m: f64) -> f64 {
        let height = self.terrain.ground(east_m, north_m).0;
        if self.over_pad(Vec3::new(east_m, north_m, 0.0)) { height.max(self.pad_m.up()) } else { height }
    }

    /// The nearest member within `max_m`.
    #[must_use]
    pub fn nearest_member(&self, p: Vec3<Enu>, max_m: f64) -> Option<Nearest> {
        if self.shapes.is_empty() {
            return None;
        }
        let found = std::cell::Cell::new((f64::INFINITY, None::<(u32, SurfacePoint)>));
        let _ = self.tree.project_point(vector(p), max_m, |leaf, _| {
            let near = self.shapes[leaf as usize].nearest(p);
            if near.distance_m < found.get().0 && near.distance_m <= max_m {
                found.set((near.distance_m, Some((leaf, near))));
            }
            let inside = near.distance_m <= 0.0;
            // The tree compares plain distances; inside a solid the surface point itself is handed back as no distance at all.
            Some(PointProjection::new(inside, if inside { vector(p) } else { vector(near.point_m) }))
        });
        found.get().1.map(|(leaf, near)| Nearest {
            distance_m: near.distance_m,
            point_m: near.point_m,
            normal: near.normal,
            surface: Surface::Bridge,
            object: ObjectId(leaf),
        })
    }

    /// The nearest of members, ground and water within `max_m`; around the pad the ground does not count.
    #[must_use]
    pub fn nearest(&self, p: Vec3<Enu>, max_m: f64) -> Option<Nearest> {
        let mut best = self.nearest_member(p, max_m);
        let (ground, ground_normal) = self.terrain.distance(p);
        let water = p.up() - self.terrain.water_m;
        let mut offer = |distance_m: f64, normal: Vec3<Enu>, surface: Surface, object: ObjectId| {
            if distance_m <= max_m && best.is_none_or(|b| distance_m < b.distance_m) {
                best = Some(Nearest { distance_m, point_m: p - normal * distance_m, normal, surface, object });
            }
        };
        if !self.over_pad(p) {
            offer(ground, ground_normal, Surface::Terrain, GROUND);
        }
        offer(water, Vec3::new(0.0, 0.0, 1.0), Surface::Water, WATER);
        best
    }

    /// The first member, ground, pad or water along a ray.
    #[must_use]
    pub fn ray(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<RayHit> {
        let mut best = self.ray_member(origin, direction, max_m);
        let mut offer = |distance_m: f64, normal: Vec3<Enu>, surface: Surface, object: ObjectId| {
            if distance_m <= max_m && best.is_none_or(|b| distance_m < b.distance_m) {
                best = Some(RayHit { distance_m, normal, surface, object });
            }
        };
        let up = Vec3::new(0.0, 0.0, 1.0);
        let level = |height: f64| (direction.up() < 0.0).then(|| (height - origin.up()) / direction.up()).filter(|t| *t >= 0.0);
        if let Some(t) = level(self.pad_m.up()).filter(|t| self.over_pad(origin + direction * *t)) {
            offer(t, up, Surface::Pad, PAD);
        }
        if let Some(t) = level(self.terrain.water_m) {
            offer(t, up, Surface::Water, WATER);
        }
        let ground_reach = best.map_or(max_m, |b| b.distance_m);
        if let Some(t) = self.terrain.ray(origin, direction, ground_reach) {
            let hit = origin + direction * t;
            let normal = self.terrain.ground(hit.east(), hit.north()).1;
            if t <= max_m && best.is_none_or(|b| t < b.distance_m) {
                best = Some(RayHit { distance_m: t, normal, surface: Surface::Terrain, object: GROUND });
            }
        }
        best
    }

    fn ray_member(&self, origin: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64) -> Option<RayHit> {
        let ray = Ray::new(vector(origin), vector(direction));
        let (leaf, distance_m) = self
            .tree
            .cast_ray(&ray, max_m, |leaf, best| self.shapes[leaf as usize].ray(origin, direction, best).map(|(t, _)| t))?;
        let normal = self.shapes[leaf as usize].ray(origin, direction, max_m).map_or(-direction, |(_, n)| n);
        Some(RayHit { distance_m, normal, surface: Surface::Bridge, object: ObjectId(leaf) })
    }

    /// Appends contacts of a probe with members, ground, pad and water.
    pub fn contacts(&self, probe: &Probe, margin_m: f64, out: &mut Vec<Contact>) {
        let (low, high, radius) = probe_box(probe);
        let reach = Vec3::new(radius + margin_m, radius + margin_m, radius + margin_m);
        let around = Aabb::new(vector(low - reach), vector(high + reach));
        // The tree's order depends on its shape; members are reported in their own order.
        let mut near: Vec<u32> = self.tree.intersect_aabb(&around).collect();
        near.sort_unstable();
        for leaf in near {
            let shape = &self.shapes[leaf as usize];
            touch(
                probe,
                margin_m,
                |p| shape.nearest(p),
                |a, b| shape.nearest_on_segment(a, b),
                |near, radius| {
                    out.push(contact(near, radius, Surface::Bridge, ObjectId(leaf)));
                },
            );
        }
        self.floor_contacts(probe, margin_m, out);
    }

    fn floor_contacts(&self, probe: &Probe, margin_m: f64, out: &mut Vec<Contact>) {
        for (p, radius) in probe_ends(probe) {
            let up = Vec3::new(0.0, 0.0, 1.0);
            let (ground, normal) = self.terrain.distance(p);
            let pad = p.up() - self.pad_m.up();
            let water = p.up() - self.terrain.water_m;
            let floor = if self.over_pad(p) && pad < ground + 0.2 {
                (pad, up, Surface::Pad, PAD)
            } else if water < ground {
                (water, up, Surface::Water, WATER)
            } else {
                (ground, normal, Surface::Terrain, GROUND)
            };
            if floor.0 - radius <= margin_m {
                let near = SurfacePoint { distance_m: floor.0, point_m: p - floor.1 * floor.0, normal: floor.1 };
                out.push(contact(near, radius, floor.2, floor.3));
            }
        }
    }
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

fn probe_ends(probe: &Probe) -> impl Iterator<Item = (Vec3<Enu>, f64)> {
    let (ends, count, radius) = match *probe {
        Probe::Ball { centre_m, radius_m } => ([centre_m, centre_m], 1, radius_m),
        Probe::Capsule { a_m, b_m, radius_m } => ([a_m, b_m], 2, radius_m),
    };
    ends.into_iter().take(count).map(move |p| (p, radius))
}

fn probe_box(probe: &Probe) -> (Vec3<Enu>, Vec3<Enu>, f64) {
    match *probe {
        Probe::Ball { centre_m, radius_m } => (centre_m, centre_m, radius_m),
        Probe::Capsule { a_m, b_m, radius_m } => {
            let (a, b) = (a_m.array(), b_m.array());
            let pick = |f: fn(f64, f64) -> f64| Vec3::new(f(a[0], b[0]), f(a[1], b[1]), f(a[2], b[2]));
            (pick(f64::min), pick(f64::max), radius_m)
        }
    }
}

/// Contacts of a probe with one convex thing: at a ball's centre; at a capsule's ends, and between them where it lies across an edge.
fn touch(
    probe: &Probe,
    margin_m: f64,
    nearest: impl Fn(Vec3<Enu>) -> SurfacePoint,
    search: impl Fn(Vec3<Enu>, Vec3<Enu>) -> f64,
    mut found: impl FnMut(SurfacePoint, f64),
) {
    for (p, radius) in probe_ends(probe) {
        let near = nearest(p);
        if near.distance_m - radius <= margin_m {
            found(near, radius);
        }
    }
    if let Probe::Capsule { a_m, b_m, radius_m } = *probe {
        let t = search(a_m, b_m);
        // At the ends the contact is known already.
        if t > 0.02 && t < 0.98 {
            let near = nearest(a_m.lerp(b_m, t));
            if near.distance_m - radius_m <= margin_m {
                found(near, radius_m);
            }
        }
    }
}
