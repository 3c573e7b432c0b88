//! Surfaces that reflect the signals of navigation satellites like mirrors: the water, and the walls of bridges.
//!
//! The signal comes from so far away that its rays are parallel. Behind a plane mirror, the receiver has an image; the signal's
//! path to it is longer than the direct path by 2 d cos(θ), where d is the distance from the mirror and θ the angle between the
//! satellite and the mirror's normal. For water this is 2 h sin(elevation), and for a vertical wall 2 d cos(elevation) times the
//! cosine of the difference in azimuth.

use crate::elements::ElementMaterial;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::scenario::bridges::Member;
use crate::scenario::bridges::solid::Solid;

/// Wavelength of the signals L1 and E1, m: 299,792,458 m/s divided by 1575.42 MHz (IS-GPS-200).
pub const WAVELENGTH_M: f64 = 0.190_293_672_8;
/// Vertical component of the normal up to which a face counts as a wall: 30 degrees from the vertical (estimate).
const MAX_WALL_NORMAL_UP: f64 = 0.5;
/// Smallest width of a wall, m (estimate: about two wavelengths and a half).
const MIN_WALL_WIDTH_M: f64 = 0.5;
/// Distance up to which walls reflect, m (estimate: members of bridges are narrower than the first Fresnel zone there).
const WALL_RANGE_M: f64 = 30.0;
/// Smallest cosine of the angle of incidence at which a surface reflects like a mirror (estimate: 3 degrees of grazing angle).
const MIN_COS_INCIDENCE: f64 = 0.05;

const UP: Vec3<Enu> = Vec3::new(0.0, 0.0, 1.0);

/// Material of a mirror.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MirrorMaterial {
    /// Lake water.
    Water,
    /// Concrete, masonry and everything else that is not metal.
    Concrete,
    /// Steel.
    Steel,
}

/// A reflection of a satellite's signal, by geometry alone: other objects may block its path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reflection {
    /// Point of the mirror at which the signal is reflected, m.
    pub point_m: Vec3<Enu>,
    /// Normal of the mirror, toward the receiver.
    pub normal: Vec3<Enu>,
    /// Cosine of the angle between the satellite and the normal.
    pub cos_incidence: f64,
    /// Length by which the path is longer than the direct one, m.
    pub extra_path_m: f64,
    /// Share of the first Fresnel zone that the mirror covers, 0 to 1.
    pub zone_share: f64,
    /// Material of the mirror.
    pub material: MirrorMaterial,
}

/// A plane face of a bridge.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    corners_m: Vec<Vec3<Enu>>,
    normal: Vec3<Enu>,
    center_m: Vec3<Enu>,
    radius_m: f64,
    sides_m: [f64; 2],
    material: MirrorMaterial,
}

/// All mirrors of a site.
#[derive(Debug, Clone, PartialEq)]
pub struct Reflectors {
    walls: Vec<Wall>,
    water_level_m: f64,
}

impl Reflectors {
    /// Collects the walls of the members. `water_level_m` is the height of the water above the site's origin.
    #[must_use]
    pub fn new(members: &[Member], water_level_m: f64) -> Self {
        let walls = members.iter().flat_map(|member| {
            let material = match member.element.material() {
                ElementMaterial::Steel => MirrorMaterial::Steel,
                ElementMaterial::ReinforcedConcrete
                | ElementMaterial::PrestressedConcrete
                | ElementMaterial::Timber
                | ElementMaterial::Masonry
                | ElementMaterial::Other => MirrorMaterial::Concrete,
            };
            member.solid.faces.iter().filter_map(move |face| Wall::of(&member.solid, face, material))
        });
        Self { walls: walls.collect(), water_level_m }
    }

    /// Returns the walls that may reflect a signal to a receiver at this position.
    #[must_use]
    pub fn walls_near(&self, position_m: Vec3<Enu>) -> Vec<&Wall> {
        self.walls.iter().filter(|wall| wall.is_near(position_m)).collect()
    }

    /// Returns the reflection off the water, if there is one. `satellite` is the unit vector to the satellite.
    #[must_use]
    pub fn water(&self, position_m: Vec3<Enu>, satellite: Vec3<Enu>) -> Option<Reflection> {
        let surface_m = Vec3::new(position_m.east(), position_m.north(), self.water_level_m);
        mirror(position_m, satellite, (surface_m, UP)).map(|(point_m, extra_path_m)| Reflection {
            point_m,
            normal: UP,
            cos_incidence: satellite.up(),
            extra_path_m,
            zone_share: 1.0,
            material: MirrorMaterial::Water,
        })
    }
}

impl Wall {
    fn of(solid: &Solid, face: &[u32], material: MirrorMaterial) -> Option<Self> {
        let corners_m: Vec<Vec3<Enu>> = face.iter().map(|index| solid.vertices_m[*index as usize]).collect();
        let [a, b, c] = [*corners_m.first()?, *corners_m.get(1)?, *corners_m.get(2)?];
        let normal = (b - a).cross(c - b).unit();
        let edges = corners_m.iter().zip(corners_m.iter().cycle().skip(1)).map(|(from, to)| *to - *from);
        let along = edges.max_by(|a, b| a.norm().total_cmp(&b.norm()))?.unit();
        let size = |axis: Vec3<Enu>| math::range(corners_m.iter().map(|corner| corner.dot(axis)));
        let sides_m = [along, normal.cross(along)].map(size).map(|(low, high)| high - low);
        let center_m = corners_m.iter().fold(Vec3::zero(), |sum, corner| sum + *corner) / corners_m.len() as f64;
        let radius_m = corners_m.iter().map(|corner| (*corner - center_m).norm()).fold(0.0, f64::max);
        let is_wall = normal.norm() > 0.5 && normal.up().abs() <= MAX_WALL_NORMAL_UP && sides_m[1] >= MIN_WALL_WIDTH_M;
        is_wall.then_some(Self { corners_m, normal, center_m, radius_m, sides_m, material })
    }

    fn is_near(&self, position_m: Vec3<Enu>) -> bool {
        let from_center = position_m - self.center_m;
        let distance_m = from_center.dot(self.normal);
        distance_m > 0.0 && distance_m < WALL_RANGE_M && from_center.norm() < WALL_RANGE_M + self.radius_m
    }

    /// Returns the reflection off this wall, if there is one. `satellite` is the unit vector to the satellite.
    #[must_use]
    pub fn reflection(&self, position_m: Vec3<Enu>, satellite: Vec3<Enu>) -> Option<Reflection> {
        let (point_m, extra_path_m) = mirror(position_m, satellite, (self.center_m, self.normal))?;
        let distance_m = (point_m - position_m).norm();
        (distance_m < WALL_RANGE_M && self.contains(point_m)).then(|| Reflection {
            point_m,
            normal: self.normal,
            cos_incidence: satellite.dot(self.normal),
            extra_path_m,
            zone_share: self.zone_share(distance_m),
            material: self.material,
        })
    }

    /// Returns whether a point of the wall's plane lies inside its corners, which are counterclockwise seen from outside.
    fn contains(&self, point_m: Vec3<Enu>) -> bool {
        let next = self.corners_m.iter().cycle().skip(1);
        self.corners_m.iter().zip(next).all(|(from, to)| (*to - *from).cross(point_m - *from).dot(self.normal) >= 0.0)
    }

    /// Returns the share of the first Fresnel zone that the wall covers. Estimate: the zone is a square with sides of
    /// 2 √(λ d), centered on the wall.
    fn zone_share(&self, distance_m: f64) -> f64 {
        let zone_m = 2.0 * (WAVELENGTH_M * distance_m).sqrt();
        self.sides_m.iter().map(|side_m| (side_m / zone_m).min(1.0)).product()
    }
}

/// Returns the point at which a mirror, given by a point and its normal, reflects the signal, and the extra length of its path, m.
fn mirror(position_m: Vec3<Enu>, satellite: Vec3<Enu>, (at_m, normal): (Vec3<Enu>, Vec3<Enu>)) -> Option<(Vec3<Enu>, f64)> {
    let distance_m = (position_m - at_m).dot(normal);
    let cos_incidence = satellite.dot(normal);
    if distance_m <= 0.0 || cos_incidence < MIN_COS_INCIDENCE {
        return None;
    }
    let arrival = satellite - normal * (2.0 * cos_incidence);
    Some((position_m + arrival * (distance_m / cos_incidence), 2.0 * distance_m * cos_incidence))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elements::Element;
    use crate::scenario::bridges::solid::{MemberBuilder, Placement};

    /// Rounding of lengths of some 100 m, m.
    const ROUNDING_M: f64 = 1e-9;

    fn satellite(azimuth_deg: f64, elevation_deg: f64) -> Vec3<Enu> {
        let (s, c) = math::sin_cos(azimuth_deg.to_radians());
        let (up, flat) = math::sin_cos(elevation_deg.to_radians());
        Vec3::new(flat * s, flat * c, up)
    }

    /// A wall of 20 by 10 m that faces north, at north = 0.
    fn site() -> Reflectors {
        let mut builder = MemberBuilder::new("test", Placement::new(Vec3::zero(), 90.0));
        builder.add_box("wall", Element::from_number(210), [-10.0, 0.0, 0.0], [10.0, 1.0, 10.0]);
        Reflectors::new(&builder.finish(), -5.0)
    }

    #[test]
    fn exact_water_adds_twice_the_height_times_the_sine_of_the_elevation() {
        let position_m = Vec3::new(3.0, 40.0, 7.0);
        for elevation_deg in [10.0, 30.0, 75.0] {
            let direction = satellite(130.0, elevation_deg);
            let found = site().water(position_m, direction).expect("above the water");
            let expected_m = 2.0 * 12.0 * math::sin(elevation_deg.to_radians());
            assert!((found.extra_path_m - expected_m).abs() < ROUNDING_M, "{found:?}");
            // The same from the two legs: along the reflected ray, minus what the direct ray is shorter there.
            let leg = found.point_m - position_m;
            assert!((leg.norm() - leg.dot(direction) - expected_m).abs() < ROUNDING_M, "{found:?}");
            assert!((found.point_m.up() + 5.0).abs() < ROUNDING_M, "{found:?}");
        }
        assert_eq!(site().water(Vec3::new(0.0, 40.0, -6.0), satellite(0.0, 45.0)), None);
    }

    #[test]
    fn exact_wall_adds_twice_the_distance_times_the_cosines_of_elevation_and_azimuth() {
        let (site, distance_m) = (site(), 4.0);
        let position_m = site_front(&site, distance_m);
        let walls = site.walls_near(position_m);
        let found = |azimuth_deg: f64, elevation_deg: f64| {
            let mut all = walls.iter().filter_map(|wall| wall.reflection(position_m, satellite(azimuth_deg, elevation_deg)));
            all.next()
        };
        for (azimuth_deg, elevation_deg) in [(0.0, 20.0), (30.0, 40.0), (-50.0, 15.0)] {
            let facing_deg = facing_deg(&site) + azimuth_deg;
            let reflection = found(facing_deg, elevation_deg).expect("faces the satellite");
            let expected_m = 2.0 * distance_m * math::cos(elevation_deg.to_radians()) * math::cos(azimuth_deg.to_radians());
            assert!((reflection.extra_path_m - expected_m).abs() < ROUNDING_M, "{reflection:?}");
            assert_eq!(reflection.material, MirrorMaterial::Concrete);
        }
        assert_eq!(found(facing_deg(&site) + 180.0, 20.0), None, "behind the wall");
        // 4 m from the wall, this ray would have to come from 15 m above, but the wall ends 5 m above.
        assert_eq!(found(facing_deg(&site), 75.0), None, "the image is outside the wall");
    }

    /// The large face that the tests use, by its normal.
    fn big_wall(site: &Reflectors) -> &Wall {
        site.walls.iter().max_by(|a, b| (a.sides_m[0] * a.sides_m[1]).total_cmp(&(b.sides_m[0] * b.sides_m[1]))).expect("walls")
    }

    fn site_front(site: &Reflectors, distance_m: f64) -> Vec3<Enu> {
        big_wall(site).center_m + big_wall(site).normal * distance_m
    }

    fn facing_deg(site: &Reflectors) -> f64 {
        let normal = big_wall(site).normal;
        math::atan2(normal.east(), normal.north()).to_degrees()
    }

    #[test]
    fn exact_small_faces_reflect_less_and_slender_ones_not_at_all() {
        let wall = Wall { sides_m: [20.0, 1.0], ..big_wall(&site()).clone() };
        let zone_m = 2.0 * (WAVELENGTH_M * 16.0).sqrt();
        assert!((wall.zone_share(16.0) - 1.0 / zone_m).abs() < ROUNDING_M, "{}", wall.zone_share(16.0));
        let mut builder = MemberBuilder::new("test", Placement::new(Vec3::zero(), 90.0));
        builder.add_box("post", Element::from_number(205), [-0.2, -0.2, 0.0], [0.2, 0.2, 10.0]);
        assert_eq!(Reflectors::new(&builder.finish(), 0.0).walls, []);
    }
}
