//! Builds bridge members from solids in bridge axes: x along the deck, y left, z up, origin on the deck's upper surface at
//! midspan. [`Placement`] converts them to site coordinates.

use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::mesh::surface_mesh::SurfaceMesh;
use crate::mesh::vectors::{cross, dot, norm, sub};
use crate::mesh::vertex_colors::ColorsByPlace;
use crate::mesh::weld::weld_within;
use crate::mesh::{Mesh, fans};
use std::borrow::Cow;

/// A structural member of a bridge. Collision, rendering, defects and export all use the same solid.
#[derive(Debug, Clone, PartialEq)]
pub struct Member {
    /// Member name, unique within the site, such as `arch/rib-left/07`.
    pub name: String,
    /// Bridge element that the member belongs to.
    pub element: Element,
    /// The member's solid, in site coordinates.
    pub solid: Solid,
}

/// Factor of the distance between merged vertices from one attempt to the next, until few enough are left.
const COARSENING: f64 = 1.4;

/// A closed convex polyhedron, or the surface of a part of another shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Vertices in site coordinates, m.
    pub vertices_m: Vec<Vec3<Enu>>,
    /// Planar, convex faces: three or more vertex indices each, counterclockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
    /// Triangles, if the solid is not a convex polyhedron.
    pub surface: Option<SolidSurface>,
}

/// The triangles of a solid of any shape.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidSurface {
    /// Three vertex indices each, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Whether they enclose a volume. An open surface has no inside.
    pub is_closed: bool,
    /// Color of each vertex, linear; empty if they have none.
    pub colors: Vec<[u8; 3]>,
}

impl SolidSurface {
    /// Returns the triangles of a surface mesh, with its vertex indices.
    #[must_use]
    pub fn of(surface: &SurfaceMesh) -> Self {
        let (triangles, colors) = (surface.mesh().triangles.clone(), surface.colors().to_vec());
        Self { triangles, is_closed: surface.is_closed(), colors }
    }
}

impl Solid {
    /// Returns the triangles: its own, or the faces of a convex polyhedron as triangle fans from each face's first vertex.
    #[must_use]
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        match &self.surface {
            Some(surface) => surface.triangles.clone(),
            None => fans(self.faces.iter().map(Vec::as_slice)),
        }
    }

    /// Returns the solid itself, or, if it has more than `max_vertices`, a coarser surface without those near each other.
    #[must_use]
    pub fn coarse(&self, max_vertices: usize) -> Cow<'_, Self> {
        if self.vertices_m.len() <= max_vertices {
            return Cow::Borrowed(self);
        }
        let mut mesh = Mesh { vertices_m: self.vertices_m.iter().map(|v| v.array()).collect(), triangles: self.triangles() };
        let colors = self.surface.as_ref().filter(|surface| !surface.colors.is_empty());
        let colors = colors.map(|surface| ColorsByPlace::new(&mesh.vertices_m, &surface.colors));
        let area_m2: f64 = mesh.triangles.iter().map(|triangle| 0.5 * norm(mesh.area_vector(*triangle))).sum();
        let mut spacing_m = (area_m2 / max_vertices.max(1) as f64).sqrt();
        while mesh.vertices_m.len() > max_vertices && spacing_m > 0.0 {
            mesh = weld_within(&mesh, spacing_m).mesh;
            spacing_m *= COARSENING;
        }
        let surface = SolidSurface {
            is_closed: self.surface.as_ref().is_none_or(|surface| surface.is_closed),
            // Merged vertices keep the place of one of them.
            colors: colors.map(|table| table.colors(&mesh.vertices_m)).unwrap_or_default(),
            triangles: mesh.triangles,
        };
        Cow::Owned(Self {
            vertices_m: mesh.vertices_m.iter().map(|v| Vec3::new(v[0], v[1], v[2])).collect(),
            faces: surface.triangles.iter().map(|triangle| triangle.to_vec()).collect(),
            surface: Some(surface),
        })
    }

    /// Returns whether the solid is a convex polyhedron.
    #[must_use]
    pub const fn is_convex(&self) -> bool {
        self.surface.is_none()
    }
}

/// A point in bridge axes, m.
pub type LocalPoint = [f64; 3];

/// A part of a bridge that rests on the ground, in bridge axes, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footing {
    /// Start and end along the bridge.
    pub x_m: (f64, f64),
    /// Right and left ends across the bridge.
    pub y_m: (f64, f64),
    /// Height of the footing's underside.
    pub up_m: f64,
}

/// Position and heading of the bridge axes in the site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    origin_m: Vec3<Enu>,
    along: Vec3<Enu>,
    left: Vec3<Enu>,
}

impl Placement {
    /// Creates axes with their origin at `origin_m` and x pointing `heading_deg` clockwise from north.
    #[must_use]
    pub fn new(origin_m: Vec3<Enu>, heading_deg: f64) -> Self {
        let (s, c) = math::sin_cos(heading_deg.to_radians());
        Self { origin_m, along: Vec3::new(s, c, 0.0), left: Vec3::new(-c, s, 0.0) }
    }

    /// Converts a point from bridge axes to site coordinates.
    #[must_use]
    pub fn point(&self, p: LocalPoint) -> Vec3<Enu> {
        self.origin_m + self.direction(p)
    }

    /// Converts a direction from bridge axes to site coordinates.
    #[must_use]
    pub fn direction(&self, d: LocalPoint) -> Vec3<Enu> {
        self.along * d[0] + self.left * d[1] + Vec3::new(0.0, 0.0, d[2])
    }

    /// Converts a point from site coordinates to bridge axes.
    #[must_use]
    pub fn local(&self, p: Vec3<Enu>) -> LocalPoint {
        let d = p - self.origin_m;
        [d.dot(self.along), d.dot(self.left), d.up()]
    }
}

/// Direction of a steel beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BeamDirection {
    /// Along the bridge, x.
    Along,
    /// Across the bridge, y.
    Across,
}

/// Steel beam plate thicknesses, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlateThickness {
    /// Thickness of both flanges.
    pub flange_m: f64,
    /// Web plate thickness.
    pub web_m: f64,
}

/// Collects the members of one bridge.
#[derive(Debug)]
pub struct MemberBuilder {
    bridge: String,
    placement: Placement,
    members: Vec<Member>,
}

impl MemberBuilder {
    /// Creates a builder for a bridge without members.
    #[must_use]
    pub fn new(bridge: &str, placement: Placement) -> Self {
        Self { bridge: bridge.to_string(), placement, members: Vec::new() }
    }

    /// Returns the members that were added.
    #[must_use]
    pub fn finish(self) -> Vec<Member> {
        self.members
    }

    /// Adds a convex polyhedron. Faces list corners counterclockwise seen from outside.
    pub fn add_solid(&mut self, part: &str, element: Element, corners: &[LocalPoint], faces: Vec<Vec<u32>>) {
        self.add(part, element, corners, faces, None);
    }

    /// Adds a part of any shape with its own triangles.
    pub fn add_surface(&mut self, part: &str, element: Element, surface: &SurfaceMesh) {
        let triangles = SolidSurface::of(surface);
        self.add(part, element, &surface.mesh().vertices_m, surface.faces().to_vec(), Some(triangles));
    }

    fn add(&mut self, part: &str, element: Element, corners: &[LocalPoint], faces: Vec<Vec<u32>>, surface: Option<SolidSurface>) {
        let vertices_m = corners.iter().map(|c| self.placement.point(*c)).collect();
        let name = format!("{}/{part}", self.bridge);
        self.members.push(Member { name, element, solid: Solid { vertices_m, faces, surface } });
    }

    /// Adds a box between two opposite corners.
    pub fn add_box(&mut self, part: &str, element: Element, low: LocalPoint, high: LocalPoint) {
        let profile = [[low[0], low[2]], [high[0], low[2]], [high[0], high[2]], [low[0], high[2]]];
        self.add_extrusion(part, element, &profile, low[1], high[1]);
    }

    /// Adds a rolled or welded steel beam between two opposite corners. Its two flanges and its web are separate members.
    pub fn add_steel_beam(
        &mut self,
        part: &str,
        element: Element,
        (low, high): (LocalPoint, LocalPoint),
        runs: BeamDirection,
        plates: PlateThickness,
    ) {
        let side = match runs {
            BeamDirection::Along => 1,
            BeamDirection::Across => 0,
        };
        let middle = 0.5 * (low[side] + high[side]);
        let (mut web_low, mut web_high) = (low, high);
        (web_low[side], web_high[side]) = (middle - 0.5 * plates.web_m, middle + 0.5 * plates.web_m);
        (web_low[2], web_high[2]) = (low[2] + plates.flange_m, high[2] - plates.flange_m);
        self.add_box(&format!("{part}/top"), element, [low[0], low[1], web_high[2]], high);
        self.add_box(&format!("{part}/web"), element, web_low, web_high);
        self.add_box(&format!("{part}/bottom"), element, low, [high[0], high[1], web_low[2]]);
    }

    /// Adds a convex profile in the x-z plane (counterclockwise with x right and z up), extruded from `y_low` to `y_high`.
    pub fn add_extrusion(&mut self, part: &str, element: Element, profile: &[[f64; 2]], y_low: f64, y_high: f64) {
        let near = profile.iter().map(|p| [p[0], y_low, p[1]]);
        let far = profile.iter().map(|p| [p[0], y_high, p[1]]);
        let corners: Vec<LocalPoint> = near.chain(far).collect();
        self.add_solid(part, element, &corners, prism_faces(profile.len()));
    }

    /// Adds a bar in a vertical plane along the bridge, between two points `[x, z]` on its axis, from `y_low` to `y_high`.
    pub fn add_bar(
        &mut self,
        part: &str,
        element: Element,
        ([from_x, from_z], [to_x, to_z]): ([f64; 2], [f64; 2]),
        depth_m: f64,
        (y_low, y_high): (f64, f64),
    ) {
        let [along, _, up] = unit([to_x - from_x, 0.0, to_z - from_z]);
        let (dx, dz) = (-0.5 * depth_m * up, 0.5 * depth_m * along);
        let profile = [[from_x - dx, from_z - dz], [to_x - dx, to_z - dz], [to_x + dx, to_z + dz], [from_x + dx, from_z + dz]];
        self.add_extrusion(part, element, &profile, y_low, y_high);
    }

    /// Adds a convex profile in the y-z plane (counterclockwise with y right and z up, seen from the end of the bridge), extruded from
    /// `x_low` to `x_high`.
    pub fn add_cross_section(&mut self, part: &str, element: Element, profile: &[[f64; 2]], x_low: f64, x_high: f64) {
        self.add_loft(part, element, (profile, x_low), (profile, x_high));
    }

    /// Adds a solid between two convex profiles in y-z planes, each with its position along the bridge. The profiles have the same number
    /// of corners, and the sides between their edges must be planar.
    pub fn add_loft(
        &mut self,
        part: &str,
        element: Element,
        (start, x_low): (&[[f64; 2]], f64),
        (end, x_high): (&[[f64; 2]], f64),
    ) {
        let near = end.iter().map(|p| [x_high, p[0], p[1]]);
        let far = start.iter().map(|p| [x_low, p[0], p[1]]);
        let corners: Vec<LocalPoint> = near.chain(far).collect();
        self.add_solid(part, element, &corners, prism_faces(end.len()));
    }

    /// Adds a regular prism with `sides` faces around the line from `a` to `b`, with its corners at `radius_m`.
    pub fn add_rod(&mut self, part: &str, element: Element, a: LocalPoint, b: LocalPoint, radius_m: f64, sides: u32) {
        let axis = unit(sub(b, a));
        self.add_mitered_rod(part, element, [(a, axis), (b, axis)], radius_m, sides);
    }

    /// Adds rods between consecutive points in a vertical plane along the bridge, mitered so that each one ends where the next
    /// begins. The rods are numbered.
    pub fn add_cable(&mut self, part: &str, element: Element, points: &[LocalPoint], radius_m: f64, sides: u32) {
        let last = points.len() - 1;
        let cut = |k: usize| {
            let (before, after) = (points[k.saturating_sub(1)], points[(k + 1).min(last)]);
            let (back, forth) = (sub(points[k], before), sub(after, points[k]));
            let ahead = if k == 0 { unit(forth) } else { unit(back) };
            let next = if k == last { ahead } else { unit(forth) };
            (points[k], unit([ahead[0] + next[0], ahead[1] + next[1], ahead[2] + next[2]]))
        };
        for k in 0..last {
            self.add_mitered_rod(&format!("{part}/{k:03}"), element, [cut(k), cut(k + 1)], radius_m, sides);
        }
    }

    /// Adds a prism along the line between two points, cut at each end by the plane with the given normal.
    fn add_mitered_rod(&mut self, part: &str, element: Element, ends: [(LocalPoint, LocalPoint); 2], radius_m: f64, sides: u32) {
        let axis = unit(sub(ends[1].0, ends[0].0));
        // Any direction that is not parallel to the axis works; the bridge's y axis orients cables and hangers alike.
        let helper = if axis[1].abs() > 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
        let u = unit(cross(helper, axis));
        let v = cross(axis, u);
        let ring = |(center, normal): (LocalPoint, LocalPoint)| {
            (0..sides).map(move |k| {
                let (s, c) = math::sin_cos(math::TAU * f64::from(k) / f64::from(sides));
                let out = [0, 1, 2].map(|i| radius_m * (c * u[i] + s * v[i]));
                let slide = -dot(normal, out) / dot(normal, axis);
                [0, 1, 2].map(|i| center[i] + out[i] + slide * axis[i])
            })
        };
        // Seen from the first end, the ring runs clockwise, which is counterclockwise seen from outside its first face.
        let corners: Vec<LocalPoint> = ring(ends[1]).chain(ring(ends[0])).collect();
        self.add_solid(part, element, &corners, prism_faces(sides as usize));
    }
}

/// Returns the faces of a prism. The first `n` vertices form one end, counterclockwise seen from outside; the next `n`
/// form the other end.
fn prism_faces(n: usize) -> Vec<Vec<u32>> {
    let n = n as u32;
    let mut faces = vec![(0..n).collect::<Vec<u32>>(), (n..2 * n).rev().collect()];
    for k in 0..n {
        let next = (k + 1) % n;
        faces.push(vec![next, k, n + k, n + next]);
    }
    faces
}

fn unit(a: LocalPoint) -> LocalPoint {
    let length = norm(a);
    a.map(|value| value / length)
}
