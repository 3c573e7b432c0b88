//! Draws a camera's view from the collision geometry with flat shading, edges, haze and lamp light. Areas with too
//! little light are dark. The report labels the result as a drawing, not a photograph.

use spandrel_model::elements::ElementMaterial;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::{CameraPose, Site, sun};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Camera;
use std::collections::BTreeMap;

/// Width of a drawing, px; the height follows the camera's aspect ratio.
pub const WIDTH_PX: usize = 400;
/// Distance of the near clipping plane, m.
const NEAR_PLANE_DISTANCE_M: f64 = 0.05;
/// Maximum distance at which members are drawn, m.
const MAX_DISTANCE_M: f64 = 400.0;
/// Side length of the ground and water squares, m.
const GROUND_SQUARE_SIZE_M: f64 = 12.0;
/// Distance at which haze hides about two thirds of an object's color, m (for appearance only).
const HAZE_DISTANCE_M: f64 = 700.0;
const SKY_COLOR: [f64; 3] = [0.80, 0.87, 0.93];

struct Facet {
    corners: [Vec3<Enu>; 3],
    shade: ShadeIndex,
}

/// Palette index of a color. Faces of the same color share an index.
type ShadeIndex = u32;
/// Index of the sky color.
const SKY_INDEX: ShadeIndex = 0;

/// A site's colors. A drawing stores an index per pixel, which takes a sixth of the space of a full color.
struct Palette {
    colors: Vec<[f64; 3]>,
    numbers: BTreeMap<[u64; 3], ShadeIndex>,
}

impl Palette {
    fn new() -> Self {
        Self { colors: vec![SKY_COLOR], numbers: [(SKY_COLOR.map(f64::to_bits), SKY_INDEX)].into() }
    }

    fn number(&mut self, color: [f64; 3]) -> ShadeIndex {
        let next = self.colors.len();
        *self.numbers.entry(color.map(f64::to_bits)).or_insert_with(|| {
            self.colors.push(color);
            ShadeIndex::try_from(next).unwrap_or(SKY_INDEX)
        })
    }
}

struct ShadedBody {
    center_m: Vec3<Enu>,
    radius_m: f64,
    facets: Vec<Facet>,
}

/// The shaded site, ready to draw from any camera.
pub struct Sketcher {
    bodies: Vec<ShadedBody>,
    colors: Vec<[f64; 3]>,
}

/// Lens and air of a drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SketchLens {
    /// Height of the drawing, px; the width is [`WIDTH_PX`].
    pub height_px: usize,
    /// Focal length, px of the drawing.
    pub focal_px: f64,
    /// Maximum distance at which members are drawn, m.
    pub max_distance_m: f64,
    /// Distance at which haze hides about two thirds of an object's color, m.
    pub haze_distance_m: f64,
    /// Whether edges are drawn between faces of different colors, and not only where the distance jumps.
    pub facet_edges: bool,
}

impl SketchLens {
    /// Returns the lens of an aircraft's camera.
    #[must_use]
    pub fn of(camera: &Camera) -> Self {
        Self {
            height_px: (WIDTH_PX * camera.height_px as usize / (camera.width_px as usize).max(1)).clamp(1, 4 * WIDTH_PX),
            focal_px: camera.focal_px() * WIDTH_PX as f64 / f64::from(camera.width_px),
            max_distance_m: MAX_DISTANCE_M,
            haze_distance_m: HAZE_DISTANCE_M,
            facet_edges: true,
        }
    }
}

/// Lighting of a drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SketchExposure {
    /// Light at the center, as a fraction of the light that the camera needs there.
    pub light: f64,
    /// Whether most of the light comes from the lamp.
    pub by_lamp: bool,
}

impl Sketcher {
    /// Creates a sketcher for a site, shaded by the sun at simulation time `at`.
    #[must_use]
    pub fn new(site: &Site, scenario: &Scenario, at: SimTime) -> Self {
        let sun = sun::direction(scenario.light.start_unix_s as f64 + at.s(), scenario.origin);
        let mut palette = Palette::new();
        let mut bodies: Vec<ShadedBody> = site.members().iter().map(|member| structure(member, sun, &mut palette)).collect();
        bodies.extend(ground(site, scenario, sun, &mut palette));
        Self { bodies, colors: palette.colors }
    }

    /// Draws the camera's view and returns it as a PNG file.
    ///
    /// # Errors
    /// Fails if the image cannot be encoded.
    pub fn png(&self, pose: &CameraPose, camera: &Camera, exposure: SketchExposure) -> Result<Vec<u8>, png::EncodingError> {
        self.png_with_lens(pose, &SketchLens::of(camera), exposure)
    }

    /// Draws the view through a lens and returns it as a PNG file.
    ///
    /// # Errors
    /// Fails if the image cannot be encoded.
    pub fn png_with_lens(
        &self,
        pose: &CameraPose,
        lens: &SketchLens,
        exposure: SketchExposure,
    ) -> Result<Vec<u8>, png::EncodingError> {
        let mut sheet = SketchCanvas::new(lens.height_px, lens.focal_px);
        let slope = |px: usize| 0.5 * px as f64 / lens.focal_px;
        let camera = SketchCamera {
            pose,
            down: pose.forward.cross(pose.right),
            slopes: [slope(WIDTH_PX), slope(lens.height_px)],
            max_distance_m: lens.max_distance_m,
        };
        for body in &self.bodies {
            if !camera.may_be_visible(body) {
                continue;
            }
            for facet in &body.facets {
                sheet.draw(&camera, facet);
            }
        }
        encode(&sheet.shaded(&self.colors, exposure, lens), WIDTH_PX, lens.height_px)
    }
}

/// Maximum number of vertices of a member (estimate: the picture is small).
const MAX_MEMBER_VERTICES: usize = 10_000;

fn structure(member: &spandrel_model::scenario::bridges::Member, sun: Vec3<Enu>, palette: &mut Palette) -> ShadedBody {
    let solid = member.solid.coarse(MAX_MEMBER_VERTICES);
    let v = &solid.vertices_m;
    let center_m = v.iter().fold(Vec3::zero(), |sum, x| sum + *x) / v.len().max(1) as f64;
    let steel = member.element.material() == ElementMaterial::Steel;
    let base = if steel { [0.50, 0.57, 0.60] } else { [0.74, 0.72, 0.68] };
    let facet = |t: [u32; 3]| facet(t.map(|k| v[k as usize]), base, sun, palette);
    ShadedBody {
        center_m,
        radius_m: v.iter().map(|x| (*x - center_m).norm()).fold(0.0, f64::max),
        facets: solid.triangles().into_iter().map(facet).collect(),
    }
}

fn facet(corners: [Vec3<Enu>; 3], base: [f64; 3], sun: Vec3<Enu>, palette: &mut Palette) -> Facet {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).unit();
    // Skylight from above, a slight directional term that makes faces distinguishable, and direct sunlight.
    let light = 0.50 + 0.16 * normal.up() + 0.06 * normal.east() + 0.10 * normal.north().abs() + 0.25 * normal.dot(sun).max(0.0);
    Facet { corners, shade: palette.number(base.map(|c| c * light)) }
}

/// Creates the shaded squares of ground and water.
fn ground(site: &Site, scenario: &Scenario, sun: Vec3<Enu>, palette: &mut Palette) -> Vec<ShadedBody> {
    let half = 0.5 * scenario.terrain.size_m;
    let water_m = scenario.terrain.water_level_m;
    let count = (scenario.terrain.size_m / GROUND_SQUARE_SIZE_M).floor().clamp(1.0, 200.0) as usize;
    let step = 2.0 * half / count as f64;
    let mut bodies = Vec::new();
    for row in 0..count {
        for column in 0..count {
            let at = |dc: usize, dr: usize| {
                let (e, n) = (-half + (column + dc) as f64 * step, -half + (row + dr) as f64 * step);
                Vec3::new(e, n, site.ground_up_m(e, n))
            };
            let square = [at(0, 0), at(1, 0), at(1, 1), at(0, 1)];
            bodies.push(shaded_square(square, [0.42, 0.47, 0.34], sun, palette));
            if square.iter().any(|corner| corner.up() < water_m) {
                let flat = square.map(|c| Vec3::new(c.east(), c.north(), water_m));
                bodies.push(shaded_square(flat, [0.36, 0.50, 0.58], sun, palette));
            }
        }
    }
    bodies
}

fn shaded_square(square: [Vec3<Enu>; 4], base: [f64; 3], sun: Vec3<Enu>, palette: &mut Palette) -> ShadedBody {
    let center_m = square.iter().fold(Vec3::zero(), |sum, x| sum + *x) / 4.0;
    ShadedBody {
        center_m,
        radius_m: square.iter().map(|x| (*x - center_m).norm()).fold(0.0, f64::max),
        facets: [[0, 1, 2], [0, 2, 3]].map(|corners| facet(corners.map(|k: usize| square[k]), base, sun, palette)).into(),
    }
}

struct SketchCamera<'a> {
    pose: &'a CameraPose,
    down: Vec3<Enu>,
    /// Half the width and half the height of the image at a depth of 1 m.
    slopes: [f64; 2],
    max_distance_m: f64,
}

impl SketchCamera<'_> {
    /// Transforms a point to camera coordinates: right, down, forward.
    fn project(&self, point_m: Vec3<Enu>) -> [f64; 3] {
        let to = point_m - self.pose.position_m;
        [to.dot(self.pose.right), to.dot(self.down), to.dot(self.pose.forward)]
    }

    /// Returns false if the body is definitely behind the camera, too far away or outside the image.
    fn may_be_visible(&self, body: &ShadedBody) -> bool {
        let [x, y, depth] = self.project(body.center_m);
        let r = body.radius_m;
        let beside = |aside: f64, slope: f64| aside.abs() - slope * depth > r * (1.0 + slope * slope).sqrt();
        depth + r >= NEAR_PLANE_DISTANCE_M
            && depth - r <= self.max_distance_m
            && !beside(x, self.slopes[0])
            && !beside(y, self.slopes[1])
    }
}

struct SketchCanvas {
    height: usize,
    focal_px: f64,
    /// Inverse depth of each pixel, 1/m; 0 for the sky.
    near: Vec<f64>,
    shade: Vec<ShadeIndex>,
}

impl SketchCanvas {
    fn new(height: usize, focal_px: f64) -> Self {
        Self { height, focal_px, near: vec![0.0; WIDTH_PX * height], shade: vec![SKY_INDEX; WIDTH_PX * height] }
    }

    fn draw(&mut self, lens: &SketchCamera<'_>, facet: &Facet) {
        let seen = facet.corners.map(|corner| lens.project(corner));
        let clipped = clip(&seen);
        for k in 2..clipped.len() {
            self.fill([clipped[0], clipped[k - 1], clipped[k]], facet.shade);
        }
    }

    /// Fills a triangle in front of the camera if its vertices appear counterclockwise. Otherwise, it is a back face
    /// and is not drawn.
    fn fill(&mut self, corners: [[f64; 3]; 3], shade: ShadeIndex) {
        let (w, h) = (WIDTH_PX as f64, self.height as f64);
        let p = corners.map(|[x, y, z]| (0.5 * w + self.focal_px * x / z, 0.5 * h + self.focal_px * y / z, 1.0 / z));
        let area = (p[1].0 - p[0].0) * (p[2].1 - p[0].1) - (p[1].1 - p[0].1) * (p[2].0 - p[0].0);
        // Image rows run downward, so counterclockwise triangles have a negative area.
        if area > -1e-9 || !area.is_finite() {
            return;
        }
        let (low, high) = math::range(p.iter().map(|q| q.1));
        for y in low.floor().clamp(0.0, h) as usize..high.ceil().clamp(0.0, h) as usize {
            let cy = y as f64 + 0.5;
            // Barycentric coordinates at the first pixel's center, and their change per pixel.
            let share = |k: usize| {
                let (b, c) = (p[(k + 1) % 3], p[(k + 2) % 3]);
                let at = ((b.0 - 0.5) * (c.1 - cy) - (b.1 - cy) * (c.0 - 0.5)) / area;
                (at, (b.1 - c.1) / area)
            };
            let shares = [share(0), share(1), share(2)];
            let Some((from, to)) = span(&shares) else { continue };
            let sum = |f: fn(&(f64, f64)) -> f64| shares.iter().zip(&p).map(|(share, corner)| f(share) * corner.2).sum::<f64>();
            let (near, step) = (sum(|s| s.0), sum(|s| s.1));
            let row = y * WIDTH_PX + from..y * WIDTH_PX + to;
            let pixels = self.near[row.clone()].iter_mut().zip(&mut self.shade[row]);
            for (x, (nearest, shown)) in (from..to).zip(pixels) {
                let near = near + step * x as f64;
                if near > *nearest {
                    (*nearest, *shown) = (near, shade);
                }
            }
        }
    }

    /// Applies edges, haze and light, and converts the colors to 8 bits per channel.
    fn shaded(&self, colors: &[[f64; 3]], exposure: SketchExposure, lens: &SketchLens) -> Vec<u8> {
        let dim = exposure.light.clamp(0.0, 1.0).sqrt().max(0.06);
        let mut rgb = Vec::with_capacity(3 * self.near.len());
        for y in 0..self.height {
            for x in 0..WIDTH_PX {
                let at = y * WIDTH_PX + x;
                let mut color = colors[self.shade[at] as usize];
                if self.near[at] > 0.0 {
                    if self.is_edge(x, y, lens.facet_edges) {
                        color = color.map(|c| 0.72 * c);
                    }
                    let haze = 1.0 - math::exp(-1.0 / (self.near[at] * lens.haze_distance_m));
                    color = [0, 1, 2].map(|k| math::lerp(color[k], SKY_COLOR[k], haze));
                }
                let lit = dim * if exposure.by_lamp { self.lamp_falloff(x, y) } else { 1.0 };
                rgb.extend(color.map(|c| (255.0 * (c * lit).clamp(0.0, 1.0) + 0.5) as u8));
            }
        }
        rgb
    }

    /// Returns whether another depth or, with `facet_edges`, another color starts at the pixel to the right or below.
    fn is_edge(&self, x: usize, y: usize, facet_edges: bool) -> bool {
        let at = y * WIDTH_PX + x;
        let differs = |other: usize| {
            let jump = (self.near[at] - self.near[other]).abs() > 0.06 * self.near[at].max(self.near[other]);
            jump || (facet_edges && self.shade[at] != self.shade[other])
        };
        (x + 1 < WIDTH_PX && differs(at + 1)) || (y + 1 < self.height && differs(at + WIDTH_PX))
    }

    /// Returns the lamp's brightness at a pixel, which decreases from the center toward the edges.
    fn lamp_falloff(&self, x: usize, y: usize) -> f64 {
        let (dx, dy) = (x as f64 - 0.5 * WIDTH_PX as f64, y as f64 - 0.5 * self.height as f64);
        let away = math::hypot(dx, dy) / (0.5 * WIDTH_PX as f64);
        (1.15 - 0.75 * away * away).clamp(0.15, 1.0)
    }
}

/// Returns the range of pixels in a row that have no negative barycentric coordinate.
fn span(shares: &[(f64, f64); 3]) -> Option<(usize, usize)> {
    let (mut from, mut to) = (0.0, WIDTH_PX as f64);
    for (at, step) in shares {
        if *step > 0.0 {
            from = f64::max(from, (-at / step).ceil());
        } else if *step < 0.0 {
            to = f64::min(to, (-at / step).floor() + 1.0);
        } else if *at < 0.0 {
            return None;
        }
    }
    (from < to).then_some((from as usize, to as usize))
}

/// Clips a triangle at the near plane.
fn clip(corners: &[[f64; 3]; 3]) -> Vec<[f64; 3]> {
    let mut kept = Vec::with_capacity(4);
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        if a[2] >= NEAR_PLANE_DISTANCE_M {
            kept.push(a);
        }
        if (a[2] >= NEAR_PLANE_DISTANCE_M) != (b[2] >= NEAR_PLANE_DISTANCE_M) {
            let t = (NEAR_PLANE_DISTANCE_M - a[2]) / (b[2] - a[2]);
            kept.push([0, 1, 2].map(|i| math::lerp(a[i], b[i], t)));
        }
    }
    kept
}

fn encode(rgb: &[u8], width: usize, height: usize) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let side = |px: usize| u32::try_from(px).unwrap_or(u32::MAX);
    let mut encoder = png::Encoder::new(&mut file, side(width), side(height));
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    // Flat colors compress best and fastest without a filter.
    encoder.set_filter(png::Filter::NoFilter);
    encoder.write_header()?.write_image_data(rgb)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(ahead_m: f64, shade: ShadeIndex) -> Facet {
        let corner = |e: f64, u: f64| Vec3::new(e, ahead_m, u);
        Facet { corners: [corner(-1.0, -1.0), corner(1.0, -1.0), corner(0.0, 1.0)], shade }
    }

    #[test]
    fn exact_nearer_face_hides_farther_face_in_any_order() {
        let pose = CameraPose {
            position_m: Vec3::zero(),
            forward: Vec3::new(0.0, 1.0, 0.0),
            right: Vec3::new(1.0, 0.0, 0.0),
            lamp_on: false,
        };
        let lens = SketchCamera { pose: &pose, down: pose.forward.cross(pose.right), slopes: [1.0, 0.75], max_distance_m: 100.0 };
        assert_eq!(lens.project(Vec3::new(1.0, 2.0, 3.0)), [1.0, -3.0, 2.0], "right, down, forward");
        let (near, far) = (triangle(2.0, 1), triangle(4.0, 2));
        for order in [[&near, &far], [&far, &near]] {
            let mut sheet = SketchCanvas::new(300, 200.0);
            order.iter().for_each(|facet| sheet.draw(&lens, facet));
            let middle = 150 * WIDTH_PX + 200;
            assert_eq!(sheet.shade[middle], 1);
            assert!((1.0 / sheet.near[middle] - 2.0).abs() < 1e-12);
            assert_eq!(sheet.shade[0], SKY_INDEX);
        }
    }

    #[test]
    fn exact_front_face_fills_pixels_and_back_face_does_not() {
        // Vertices at pixels (10, 10), (10, 30), (30, 10), counterclockwise in the image; focal length 100 px, 1 m
        // away.
        let corner = |x: f64, y: f64| [(x - 200.0) / 100.0, (y - 150.0) / 100.0, 1.0];
        let face = [corner(10.0, 10.0), corner(10.0, 30.0), corner(30.0, 10.0)];
        let filled = |corners: [[f64; 3]; 3]| {
            let mut sheet = SketchCanvas::new(300, 100.0);
            sheet.fill(corners, 1);
            sheet.shade.iter().filter(|shade| **shade == 1).count()
        };
        // Pixel centers with x + y < 40: 19 + 18 + ... + 1, plus the 20 on the edge.
        assert!((190..=210).contains(&filled(face)), "{}", filled(face));
        assert_eq!(filled([face[0], face[2], face[1]]), 0);
    }

    #[test]
    fn exact_geometry_behind_camera_is_clipped() {
        assert!(clip(&[[0.0, 0.0, -1.0]; 3]).is_empty());
        let cut = clip(&[[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 0.0, -1.0]]);
        assert_eq!(cut.len(), 4);
        assert!(cut.iter().all(|corner| corner[2] >= NEAR_PLANE_DISTANCE_M - 1e-12));
    }

    #[test]
    fn exact_palette_indices_are_unique_and_sky_is_first() {
        let mut palette = Palette::new();
        let numbers = [[0.1, 0.2, 0.3], SKY_COLOR, [0.1, 0.2, 0.3], [0.3, 0.2, 0.1]].map(|color| palette.number(color));
        assert_eq!(numbers, [1, SKY_INDEX, 1, 2]);
        assert_eq!(palette.colors, [SKY_COLOR, [0.1, 0.2, 0.3], [0.3, 0.2, 0.1]]);
    }
}
