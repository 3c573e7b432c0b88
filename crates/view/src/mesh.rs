//! Triangle meshes with the vertex attributes of the shaders, and simple solids for building props.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;

/// Surface material; the shaders switch on its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Material {
    /// Cast concrete, weathered.
    Concrete = 0,
    /// Deck surface: asphalt, markings, walkways. `aux` is half the deck width, m.
    Deck = 1,
    /// Painted, riveted steel.
    Steel = 2,
    /// Galvanized wire.
    Cable = 3,
    /// Grass, rock, and shore. `aux` is the height above the water, m.
    Ground = 4,
    /// Conifer foliage. `aux` is the height between the tree's foot (0) and top (1).
    Foliage = 5,
    /// Tree bark. `aux` as for foliage.
    Bark = 6,
    /// Boulders.
    Rock = 7,
    /// Car paint.
    Paint = 8,
    /// Window glass.
    Glass = 9,
    /// Tires and black plastics.
    Rubber = 10,
    /// Cloth and skin.
    Cloth = 11,
    /// Emissive surface of a light.
    Light = 12,
    /// The landing pad.
    Pad = 13,
    /// The translucent disk of a fast-spinning propeller.
    Blur = 14,
    /// Paint with a color that instances do not override.
    Enamel = 15,
    /// Cut stone in courses. `aux` is 1 on a voussoir, which is one stone, and 0 elsewhere.
    Masonry = 16,
}

/// A vertex in the scenario's frame (east, north, up), m.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Vertex {
    /// Vertex position, m.
    pub position: [f32; 3],
    /// Outward unit normal.
    pub normal: [f32; 3],
    /// Surface coordinates, m: along the member or horizontally, and across it or up.
    pub uv: [f32; 2],
    /// Indirect light: fractions of the sky and sun illuminance (see `LightModel::indirect_fractions`).
    pub light: [f32; 2],
    /// [`Material`] in the lowest eight bits; AASHTO element number in the bits above, or 0 for anything not part of a
    /// bridge.
    pub material: u32,
    /// Color, linear RGBA in 1/255.
    pub tint: [u8; 4],
    /// Additional material parameter.
    pub aux: f32,
}

/// Triangle mesh with counterclockwise winding as seen from outside.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// Vertices.
    pub vertices: Vec<Vertex>,
    /// Vertex indices, three per triangle.
    pub indices: Vec<u32>,
}

/// Material and color of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceFinish {
    /// Surface material.
    pub material: Material,
    /// Color, linear, 0..255.
    pub tint: [u8; 3],
}

impl SurfaceFinish {
    /// Creates a finish from a material and a linear color.
    #[must_use]
    pub const fn new(material: Material, tint: [u8; 3]) -> Self {
        Self { material, tint }
    }
}

/// Converts a vector to single precision.
#[must_use]
pub fn single(v: Vec3<Enu>) -> [f32; 3] {
    v.array().map(|x| x as f32)
}

impl Mesh {
    /// Returns the number of triangles.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.indices.len() / 3
    }

    /// Appends another mesh.
    pub fn append(&mut self, other: &Self) {
        let first = self.vertices.len() as u32;
        self.vertices.extend_from_slice(&other.vertices);
        self.indices.extend(other.indices.iter().map(|k| k + first));
    }

    /// Adds a flat convex polygon with corners counterclockwise as seen from outside. Surface coordinates start at the
    /// first corner and run along the first side.
    pub fn polygon(&mut self, corners: &[Vec3<Enu>], finish: SurfaceFinish) {
        if corners.len() < 3 {
            return;
        }
        let normal =
            (2..corners.len()).fold(Vec3::zero(), |sum, k| sum + (corners[k - 1] - corners[0]).cross(corners[k] - corners[0]));
        if normal.norm() <= 0.0 {
            return;
        }
        let normal = normal.unit();
        let along = (corners[1] - corners[0]).unit();
        let first = self.vertices.len() as u32;
        for corner in corners {
            let at = *corner - corners[0];
            let uv = [at.dot(along) as f32, at.dot(normal.cross(along)) as f32];
            self.vertices.push(vertex(*corner, normal, uv, finish));
        }
        for k in 2..corners.len() as u32 {
            self.indices.extend([first, first + k - 1, first + k]);
        }
    }

    /// Adds a block with a top face that may be smaller than the bottom: `inset` reduces it at the front, at the rear
    /// and on both sides.
    pub fn block(&mut self, low: [f64; 3], high: [f64; 3], inset: [f64; 3], finish: SurfaceFinish) {
        let [front, rear, side] = inset;
        let p = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
        let bottom =
            [p(low[0], low[1], low[2]), p(high[0], low[1], low[2]), p(high[0], high[1], low[2]), p(low[0], high[1], low[2])];
        let top = [
            p(low[0] + rear, low[1] + side, high[2]),
            p(high[0] - front, low[1] + side, high[2]),
            p(high[0] - front, high[1] - side, high[2]),
            p(low[0] + rear, high[1] - side, high[2]),
        ];
        self.polygon(&[bottom[3], bottom[2], bottom[1], bottom[0]], finish);
        self.polygon(&top, finish);
        for k in 0..4 {
            let n = (k + 1) % 4;
            self.polygon(&[bottom[k], bottom[n], top[n], top[k]], finish);
        }
    }

    /// Adds a cylinder or cone frustum from `a` to `b` with a radius at each end, smooth-shaded, with flat caps.
    pub fn round(&mut self, (a, radius_a): (Vec3<Enu>, f64), (b, radius_b): (Vec3<Enu>, f64), sides: u32, finish: SurfaceFinish) {
        let axis = (b - a).unit();
        let helper = if axis.up().abs() < 0.9 { Vec3::new(0.0, 0.0, 1.0) } else { Vec3::new(1.0, 0.0, 0.0) };
        let u = helper.cross(axis).unit();
        let v = axis.cross(u);
        let slope = (radius_a - radius_b) / (b - a).norm().max(1e-9);
        let out = |k: u32| {
            let (s, c) = math::sin_cos(math::TAU * f64::from(k) / f64::from(sides));
            u * c + v * s
        };
        let first = self.vertices.len() as u32;
        let length = (b - a).norm() as f32;
        for k in 0..=sides {
            let normal = (out(k) + axis * slope).unit();
            let around = (math::TAU * radius_a.max(radius_b) * f64::from(k) / f64::from(sides)) as f32;
            self.vertices.push(vertex(a + out(k) * radius_a, normal, [around, 0.0], finish));
            self.vertices.push(vertex(b + out(k) * radius_b, normal, [around, length], finish));
        }
        for k in 0..sides {
            let i = first + 2 * k;
            self.indices.extend([i, i + 2, i + 1, i + 1, i + 2, i + 3]);
        }
        let ring = |center: Vec3<Enu>, radius: f64| (0..sides).map(move |k| center + out(k) * radius).collect::<Vec<_>>();
        if radius_b > 0.0 {
            self.polygon(&ring(b, radius_b), finish);
        }
        if radius_a > 0.0 {
            let mut end = ring(a, radius_a);
            end.reverse();
            self.polygon(&end, finish);
        }
    }

    /// Adds an ellipsoid with three semi-axes; a `dent` in 0..1 makes it an irregular boulder.
    pub fn ball(&mut self, center: Vec3<Enu>, half: [f64; 3], dent: f64, finish: SurfaceFinish) {
        self.sphere_with_detail((8, 12), center, half, dent, finish);
    }

    /// Adds an ellipsoid with the given number of rings and sides.
    pub fn sphere_with_detail(
        &mut self,
        (rings, sides): (u32, u32),
        center: Vec3<Enu>,
        half: [f64; 3],
        dent: f64,
        finish: SurfaceFinish,
    ) {
        let first = self.vertices.len() as u32;
        for ring in 0..=rings {
            let (sr, cr) = math::sin_cos(math::PI * f64::from(ring) / f64::from(rings));
            for side in 0..=sides {
                let (ss, cs) = math::sin_cos(math::TAU * f64::from(side) / f64::from(sides));
                let d = [sr * cs, sr * ss, cr];
                let bump = 1.0 - dent * (0.5 + 0.5 * math::sin(5.0 * d[0] + 3.0 * d[2]) * math::cos(4.0 * d[1] - 2.0 * d[0]));
                let at = Vec3::new(d[0] * half[0] * bump, d[1] * half[1] * bump, d[2] * half[2] * bump);
                let normal = Vec3::new(d[0] / half[0], d[1] / half[1], d[2] / half[2]).unit();
                let uv = [(half[0] * f64::from(side)) as f32, (half[2] * f64::from(ring)) as f32];
                self.vertices.push(vertex(center + at, normal, uv, finish));
            }
        }
        let row = sides + 1;
        for ring in 0..rings {
            for side in 0..sides {
                let i = first + ring * row + side;
                self.indices.extend([i, i + row, i + 1, i + 1, i + row, i + row + 1]);
            }
        }
    }
}

/// Creates a vertex that receives all indirect light; instances have their own light values.
fn vertex(position: Vec3<Enu>, normal: Vec3<Enu>, uv: [f32; 2], finish: SurfaceFinish) -> Vertex {
    let [r, g, b] = finish.tint;
    Vertex {
        position: single(position),
        normal: single(normal),
        uv,
        light: [1.0, 1.0],
        material: finish.material as u32,
        tint: [r, g, b, 255],
        aux: 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FINISH: SurfaceFinish = SurfaceFinish::new(Material::Paint, [128, 128, 128]);

    /// Returns the volume, calculated with the divergence theorem. It is positive if the triangles face outward.
    fn volume(mesh: &Mesh) -> f64 {
        let at = |k: u32| {
            let [x, y, z] = mesh.vertices[k as usize].position.map(f64::from);
            Vec3::<Enu>::new(x, y, z)
        };
        mesh.indices.chunks(3).map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0).sum()
    }

    #[test]
    fn exact_solids_are_closed_and_face_outward() {
        let mut block = Mesh::default();
        block.block([-1.0, -1.0, 0.0], [1.0, 1.0, 3.0], [0.0; 3], FINISH);
        assert!((volume(&block) - 12.0).abs() < 1e-6, "{}", volume(&block));
        let mut cone = Mesh::default();
        cone.round((Vec3::zero(), 1.0), (Vec3::new(0.0, 0.0, 3.0), 0.0), 64, FINISH);
        // The volume of a cone with 64 sides is 0.2% smaller than π.
        assert!((volume(&cone) / math::PI - 1.0).abs() < 0.003, "{}", volume(&cone));
        let mut ball = Mesh::default();
        ball.ball(Vec3::new(5.0, 0.0, 0.0), [1.0; 3], 0.0, FINISH);
        assert!((volume(&ball) / (4.0 / 3.0 * math::PI) - 1.0).abs() < 0.12, "{}", volume(&ball));
    }
}
