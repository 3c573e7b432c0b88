//! A site as meshes: what stands still is built once, with its indirect light worked out at every corner; what moves is a list of instances
//! for each picture.

mod bake;
mod bridges;
pub mod defects;
mod drone;
mod fields;
mod ground;
mod plants;
mod props;
mod sparse;

pub use defects::DefectPatch;

use super::mesh::{Mesh, Vertex, single};
use super::quality::Quality;
use bake::LightBaker;
use spandrel_model::frames::{Enu, Frd, Ned, Rotation, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::movers::MoverKind;
use spandrel_model::site::{QueryTime, Site};
use spandrel_model::vehicle::Vehicle;

/// Where one copy of a mesh stands.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Instance {
    /// Rows of the affine map from the mesh's own axes into the site.
    pub rows: [[f32; 4]; 3],
    /// Colour of painted parts, linear; the last is 1 where it counts.
    pub paint: [f32; 4],
    /// Indirect light on what faces up (shares of sky and sun), and down.
    pub around: [f32; 4],
}

impl Instance {
    /// Where the mesh was built, with its own light.
    pub const HERE: Self =
        Self { rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]], paint: [0.0; 4], around: [1.0; 4] };

    /// A mesh whose axes point along three vectors (their lengths scale it) from an origin.
    #[must_use]
    pub fn placed(origin_m: Vec3<Enu>, axes: [Vec3<Enu>; 3], around: [f32; 4]) -> Self {
        let [x, y, z] = axes.map(single);
        let o = single(origin_m);
        Self { rows: [0, 1, 2].map(|k| [x[k], y[k], z[k], o[k]]), paint: [0.0; 4], around }
    }

    /// A corner of the mesh where this copy has it, lit as the shaders light copies.
    fn transformed(&self, v: &Vertex) -> Vertex {
        let turned = |of: [f32; 3]| self.rows.map(|row| row[0] * of[0] + row[1] * of[1] + row[2] * of[2]);
        let [x, y, z] = turned(v.normal);
        let length = (x * x + y * y + z * z).sqrt().max(f32::MIN_POSITIVE);
        let moved = turned(v.position);
        let up = 0.5 + 0.5 * z / length;
        let light = |k: usize| v.light[k] * (self.around[2 + k] + (self.around[k] - self.around[2 + k]) * up);
        Vertex {
            position: [0, 1, 2].map(|k| moved[k] + self.rows[k][3]),
            normal: [x, y, z].map(|c| c / length),
            light: [light(0), light(1)],
            ..*v
        }
    }

    fn with_material(self, [r, g, b]: [f32; 3]) -> Self {
        Self { paint: [r, g, b, 1.0], ..self }
    }
}

/// A mesh and where its copies stand.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneItem {
    /// What it is.
    pub name: &'static str,
    /// Triangles.
    pub mesh: Mesh,
    /// Copies.
    pub instances: Vec<Instance>,
    /// It throws shadows.
    pub casts: bool,
    /// From where it shows.
    pub visible_range: VisibleRange,
    /// It stands around everything: cut into sectors.
    pub backdrop: bool,
}

/// From where something shows: distances at which it begins and ends, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisibleRange {
    /// Straight.
    pub straight_m: [f64; 2],
    /// In the lake.
    pub in_lake_m: [f64; 2],
}

impl VisibleRange {
    /// From anywhere.
    pub const ALWAYS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
    /// From nowhere.
    pub const NEVER: [f64; 2] = [f64::INFINITY, f64::INFINITY];
    /// Straight and in the lake.
    pub const EVERYWHERE: Self = Self { straight_m: Self::ALWAYS, in_lake_m: Self::ALWAYS };
    /// Never in the lake.
    pub const STRAIGHT: Self = Self { in_lake_m: Self::NEVER, ..Self::EVERYWHERE };
    /// In the lake alone: a simpler stand-in.
    pub const IN_LAKE: Self = Self { straight_m: Self::NEVER, ..Self::EVERYWHERE };

    /// From nearer than this, m.
    #[must_use]
    pub const fn within(most_m: f64) -> [f64; 2] {
        [f64::NEG_INFINITY, most_m]
    }

    /// From this far on, m.
    #[must_use]
    pub const fn beyond(least_m: f64) -> [f64; 2] {
        [least_m, f64::INFINITY]
    }

    /// Whether it shows straight or in the lake, at a distance.
    #[must_use]
    pub fn shows(&self, in_lake: bool, from_m: f64) -> bool {
        let [begins, ends] = if in_lake { self.in_lake_m } else { self.straight_m };
        begins <= from_m && from_m < ends
    }
}

impl SceneItem {
    /// What is built where it stands.
    fn here(name: &'static str, mesh: Mesh, casts: bool) -> Self {
        Self { name, mesh, instances: vec![Instance::HERE], casts, visible_range: VisibleRange::EVERYWHERE, backdrop: false }
    }
}

/// Meshes of what moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MoverModel {
    /// A car.
    Car,
    /// A lorry.
    Truck,
    /// A person.
    Person,
    /// The aircraft without its propellers.
    Drone,
    /// One propeller.
    Propeller,
    /// The disc that a fast propeller blurs into.
    Disc,
}

impl MoverModel {
    /// All, in order.
    pub const ALL: [Self; 6] = [Self::Car, Self::Truck, Self::Person, Self::Drone, Self::Propeller, Self::Disc];
}

/// The aircraft as it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DronePose {
    /// Centre of mass, m.
    pub position_m: Vec3<Enu>,
    /// Attitude.
    pub ned_from_frd: Rotation<Frd, Ned>,
    /// Its propellers turn.
    pub spinning: bool,
}

/// Everything that is drawn of a site.
#[derive(Debug, Clone)]
pub struct Scene {
    /// What stands still.
    pub parts: Vec<SceneItem>,
    /// The lake's surface; `aux` of its corners is the depth, m.
    pub water: Mesh,
    /// Defects.
    pub patches: Vec<DefectPatch>,
    /// Meshes of [`MoverModel::ALL`].
    pub models: Vec<Mesh>,
    /// Ball around everything that is built, m.
    pub bounds_m: (Vec3<Enu>, f64),
    rotors: Vec<(Vec3<Frd>, f64)>,
    water_m: f64,
}

/// How many times farther off the ground may lie in the lake's mirror, which waves blur and which has fewer pixels.
const IN_LAKE: f64 = 4.0;
/// Speed at which propellers are shown to turn, rad/s: slow enough not to stand still on a screen (the wire does not tell the true one).
const SHOWN_SPIN_RAD_S: f64 = 43.0;

impl Scene {
    /// Builds a site's scene for the light at one instant.
    #[must_use]
    pub fn build(scenario: &Scenario, site: &Site, vehicle: &Vehicle, quality: &Quality, at: QueryTime) -> Self {
        let sun = site.light().daylight(at).sun;
        let bake = LightBaker::new(site, sun, quality.light_rays);
        let shown = if quality.sparse { fields::sparse(scenario, site, 1.0) } else { fields::all(site) };
        let rounds = if quality.sparse { props::RoundDetail::Plain } else { props::RoundDetail::Fine };
        let ground = |triangles: &[[u32; 3]], under_m: f64| {
            ground::mesh(scenario, site, &bake, &fields::shallow(scenario, site, triangles, under_m))
        };
        let bottom_m = if quality.sparse { fields::UNSEEN_M } else { f64::INFINITY };
        let mut parts = bridges::parts(scenario, &bake, quality);
        let ground_at = parts.len();
        parts.extend([
            SceneItem::here("ground", ground(&shown, bottom_m), true),
            SceneItem { backdrop: true, ..SceneItem::here("mountains", ground::mountains(scenario, site, false), false) },
            SceneItem::here("pad", ground::pad(site), false),
        ]);
        if quality.sparse {
            let coarse = SceneItem::here("mountains in the lake", ground::mountains(scenario, site, true), false);
            parts[ground_at].visible_range = VisibleRange::STRAIGHT;
            parts[ground_at + 1].visible_range = VisibleRange::STRAIGHT;
            parts.push(SceneItem { backdrop: true, visible_range: VisibleRange::IN_LAKE, ..coarse });
            let rough = ground(&fields::sparse(scenario, site, IN_LAKE), 0.0);
            parts.push(SceneItem { visible_range: VisibleRange::IN_LAKE, ..SceneItem::here("ground in the lake", rough, false) });
        }
        parts.extend(plants::parts(scenario, site, quality));
        Self {
            parts,
            water: ground::water(scenario, site, &bake, &shown),
            patches: defects::patches(site, sun),
            models: vec![
                props::car(rounds),
                props::truck(rounds),
                props::person(rounds),
                drone::body(vehicle),
                drone::propeller(vehicle),
                drone::disc(vehicle),
            ],
            bounds_m: bounds(site),
            rotors: vehicle.rotors.iter().map(|rotor| (rotor.position_m, rotor.spin)).collect(),
            water_m: scenario.terrain.water_level_m,
        }
    }

    /// Water surface, m up.
    #[must_use]
    pub fn water_m(&self) -> f64 {
        self.water_m
    }

    /// What moves, at an instant.
    #[must_use]
    pub fn moving(
        &self,
        scenario: &Scenario,
        site: &Site,
        drone: Option<&DronePose>,
        at: QueryTime,
    ) -> Vec<(MoverModel, Instance)> {
        let mut all = Vec::new();
        for (k, mover) in site.traffic().movers().iter().enumerate() {
            let Some(placed) = site.traffic().place(mover, at) else { continue };
            let model = match mover.kind {
                MoverKind::Car => MoverModel::Car,
                MoverKind::Truck => MoverModel::Truck,
                MoverKind::Pedestrian => MoverModel::Person,
            };
            all.push((
                model,
                place_on_ground(placed.position_m, placed.forward, OPEN).with_material(props::colour(mover.kind, k)),
            ));
        }
        let team = &scenario.ground_team;
        let facing = |heading_deg: f64| {
            let (s, c) = math::sin_cos(heading_deg.to_radians());
            Vec3::new(s, c, 0.0)
        };
        all.push((
            MoverModel::Truck,
            place_on_ground(team.truck_m, facing(team.truck_heading_deg), OPEN).with_material(props::CREW_TRUCK),
        ));
        all.push((
            MoverModel::Person,
            place_on_ground(team.inspector_m, facing(team.pad_heading_deg), OPEN).with_material(props::VEST),
        ));
        if let Some(drone) = drone {
            self.aircraft(site, drone, at, &mut all);
        }
        all
    }

    fn aircraft(&self, site: &Site, drone: &DronePose, at: QueryTime, out: &mut Vec<(MoverModel, Instance)>) {
        let axis = |v: Vec3<Frd>| (drone.ned_from_frd * v).enu();
        let axes = [axis(Vec3::new(1.0, 0.0, 0.0)), axis(Vec3::new(0.0, 1.0, 0.0)), axis(Vec3::new(0.0, 0.0, 1.0))];
        let around = bake::around(site, drone.position_m, at);
        out.push((MoverModel::Drone, Instance::placed(drone.position_m, axes, around)));
        for (hub_m, spin) in &self.rotors {
            let hub = drone.position_m + axis(*hub_m);
            let angle = if drone.spinning { -spin * SHOWN_SPIN_RAD_S * at.s() } else { 0.6 };
            let (s, c) = math::sin_cos(angle);
            let turned = [axes[0] * c + axes[1] * s, axes[1] * c - axes[0] * s, axes[2]];
            out.push((MoverModel::Propeller, Instance::placed(hub, turned, around)));
            if drone.spinning {
                out.push((MoverModel::Disc, Instance::placed(hub, axes, around)));
            }
        }
    }
}

/// Light in the open: all of the sky above, half of what the ground throws back below (estimate).
const OPEN: [f32; 4] = [0.95, 0.02, 0.22, 0.10];

/// A mesh with x forward, y left, z up that stands on its feet.
fn place_on_ground(feet_m: Vec3<Enu>, forward: Vec3<Enu>, around: [f32; 4]) -> Instance {
    let level: Vec3<Enu> = Vec3::new(forward.east(), forward.north(), 0.0).unit();
    let left = Vec3::new(-level.north(), level.east(), 0.0);
    Instance::placed(feet_m, [level, left, Vec3::new(0.0, 0.0, 1.0)], around)
}

/// A ball around all members and the pad.
fn bounds(site: &Site) -> (Vec3<Enu>, f64) {
    let members = site.members().iter().chain([site.geometry().pad()]);
    let points: Vec<Vec3<Enu>> = members.flat_map(|member| member.solid.vertices_m.iter().copied()).collect();
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for p in &points {
        for (k, x) in p.array().into_iter().enumerate() {
            low[k] = low[k].min(x);
            high[k] = high[k].max(x);
        }
    }
    let centre = Vec3::new(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2]));
    let radius = points.iter().map(|p| (*p - centre).norm()).fold(10.0, f64::max);
    (centre, radius)
}
