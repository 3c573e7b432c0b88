//! A site as meshes. Static objects are built once with baked indirect light per vertex; moving objects are a list of
//! instances per picture.

mod bake;
mod bridges;
pub mod defects;
mod drone;
mod fields;
mod ground;
mod item;
mod mountains;
mod plants;
mod props;
mod sparse;

pub use defects::DefectPatch;
pub use item::{Instance, SceneItem, VisibleRange};

use super::ground_photo::GroundColors;
use super::hud::SiteOutline;
use super::mesh::Mesh;
use super::path_guide::PathGuide;
use super::quality::Quality;
use bake::LightBaker;
use spandrel_model::frames::{Enu, Frd, Vec3};
use spandrel_model::math;
use spandrel_model::pose::Pose;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::drones::SiteDrone;
use spandrel_model::site::movers::MoverKind;
use spandrel_model::site::{QueryTime, Site};
use spandrel_model::vehicle::Vehicle;
use spandrel_text::{Language, text};
use std::sync::Arc;

/// Models of moving objects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MoverModel {
    /// A car.
    Car,
    /// A truck.
    Truck,
    /// A person.
    Person,
    /// A segment of a rope: a cylinder of length and radius 1 along x.
    Rope,
    /// An aircraft without its propellers. The number is its place in the scene's list of aircraft; 0 is the trainee's.
    Drone(u8),
    /// One propeller of this aircraft.
    Propeller(u8),
    /// The motion-blur disk of this aircraft's fast-spinning propeller.
    PropellerDisk(u8),
}

impl MoverModel {
    /// Models that every scene has, in the order of their meshes. Those of the aircraft follow.
    const COMMON: [Self; 4] = [Self::Car, Self::Truck, Self::Person, Self::Rope];

    /// Returns all models of a scene with this number of meshes, in the order of [`Scene::models`].
    pub fn all(mesh_count: usize) -> impl Iterator<Item = Self> {
        let of_aircraft = (0..u8::MAX).flat_map(|k| [Self::Drone(k), Self::Propeller(k), Self::PropellerDisk(k)]);
        Self::COMMON.into_iter().chain(of_aircraft).take(mesh_count)
    }

    /// Returns the place of the model's mesh in [`Scene::models`].
    #[must_use]
    pub fn index(self) -> usize {
        let of_aircraft = |k: u8, part: usize| Self::COMMON.len() + 3 * usize::from(k) + part;
        match self {
            Self::Car => 0,
            Self::Truck => 1,
            Self::Person => 2,
            Self::Rope => 3,
            Self::Drone(k) => of_aircraft(k, 0),
            Self::Propeller(k) => of_aircraft(k, 1),
            Self::PropellerDisk(k) => of_aircraft(k, 2),
        }
    }

    /// Returns whether the model is translucent.
    #[must_use]
    pub fn is_translucent(self) -> bool {
        matches!(self, Self::PropellerDisk(_))
    }
}

/// Pose of the aircraft for rendering.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DronePose {
    /// Position and attitude.
    pub pose: Pose<Enu>,
    /// Whether the propellers are turning.
    pub spinning: bool,
}

/// A step of loading a flight's site and scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadingStep {
    /// Building the site and placing its defects.
    Site,
    /// Building and lighting the bridges.
    Bridges,
    /// Building and lighting the ground.
    Ground,
    /// Placing trees and rocks.
    Plants,
    /// Building the water, and the meshes of moving objects.
    Water,
    /// Uploading the scene to the graphics device.
    Upload,
}

impl LoadingStep {
    /// Returns how much of the work is done before this step, %. Lighting the bridges takes nine tenths of the time on the
    /// processor (the paper's job at quality `low`); the graphics device's share is an estimate.
    fn progress_pct(self) -> u32 {
        match self {
            Self::Site => 0,
            Self::Bridges => 3,
            Self::Ground => 60,
            Self::Plants => 64,
            Self::Water => 65,
            Self::Upload => 66,
        }
    }

    /// Returns what is loading, and the share of the work that is done.
    #[must_use]
    pub fn words(self, language: Language) -> String {
        text!(language, "window-flight-loading", what = self.title(language), pct = self.progress_pct())
    }

    fn title(self, language: Language) -> String {
        match self {
            Self::Site => text!(language, "window-flight-loading-site"),
            Self::Bridges => text!(language, "window-flight-loading-bridges"),
            Self::Ground => text!(language, "window-flight-loading-ground"),
            Self::Plants => text!(language, "window-flight-loading-plants"),
            Self::Water => text!(language, "window-flight-loading-water"),
            Self::Upload => text!(language, "window-flight-loading-graphics"),
        }
    }
}

/// A site for rendering.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Static objects.
    pub parts: Vec<SceneItem>,
    /// Surface of the lake; `aux` of its vertices is the depth, m.
    pub water: Mesh,
    /// Colors of the ground from an aerial photograph.
    pub ground_colors: Option<GroundColors>,
    /// Defects.
    pub patches: Vec<DefectPatch>,
    /// Meshes in the order of [`MoverModel::all`].
    pub models: Vec<Mesh>,
    /// Whether rain or snow changes the surfaces.
    pub is_weathered: bool,
    /// Paths of the tasks.
    pub paths: PathGuide,
    /// Outlines of the site for the instruments.
    pub outline: Arc<SiteOutline>,
    /// Bounding sphere of all structures, m.
    pub bounds_m: (Vec3<Enu>, f64),
    /// Propellers of each aircraft: that of the trainee, and those of the other drones.
    airframes: Vec<Propellers>,
    /// Aircraft of each drone of the site.
    drone_airframes: Vec<u8>,
    water_m: f64,
}

/// Hubs and directions of the propellers of an aircraft.
type Propellers = Vec<(Vec3<Frd>, f64)>;

/// Factor for the ground's error tolerance in the lake's reflection, which has fewer pixels and is blurred by waves.
const LAKE_TOLERANCE_FACTOR: f64 = 4.0;
/// Displayed propeller speed, rad/s: slow enough that propellers do not seem to stand still on a screen (telemetry does
/// not include the actual speed).
const DISPLAYED_ROTOR_SPEED_RAD_S: f64 = 43.0;

impl Scene {
    /// Builds the scene of a site with the light at the given time.
    #[must_use]
    pub fn build(scenario: &Scenario, site: &Site, vehicle: &Vehicle, quality: &Quality, at: QueryTime) -> Self {
        Self::build_in_steps(scenario, site, vehicle, (quality, at), &|_| {})
    }

    /// Builds the scene like [`Self::build`], and reports each step before it begins.
    #[must_use]
    pub fn build_in_steps(
        scenario: &Scenario,
        site: &Site,
        vehicle: &Vehicle,
        (quality, at): (&Quality, QueryTime),
        report: &dyn Fn(LoadingStep),
    ) -> Self {
        let sun = site.light().daylight(at).sun;
        let bake = LightBaker::new(site, sun, quality.light_rays);
        let shown = if quality.sparse { fields::sparse(scenario, site, 1.0) } else { fields::all(site) };
        let rounds = if quality.sparse { props::RoundDetail::Plain } else { props::RoundDetail::Fine };
        let ground = |triangles: &[[u32; 3]], under_m: f64| {
            ground::mesh(scenario, site, &bake, &fields::shallow_triangles(scenario, site, triangles, under_m))
        };
        let bottom_m = if quality.sparse { fields::MAX_VISIBLE_DEPTH_M } else { f64::INFINITY };
        report(LoadingStep::Bridges);
        let mut parts = bridges::parts(scenario, &bake, quality);
        report(LoadingStep::Ground);
        let ground_at = parts.len();
        let mountain_step = if quality.sparse { mountains::SPARSE_STEP } else { 1 };
        parts.extend([
            SceneItem::here("ground", ground(&shown, bottom_m), true),
            SceneItem { backdrop: true, ..SceneItem::here("mountains", mountains::mesh(scenario, site, mountain_step), false) },
            SceneItem::here("pad", ground::pad(site), false),
        ]);
        if quality.sparse {
            let coarse =
                SceneItem::here("reflected mountains", mountains::mesh(scenario, site, mountains::REFLECTED_STEP), false);
            parts[ground_at].visible_range = VisibleRange::DIRECT_ONLY;
            parts[ground_at + 1].visible_range = VisibleRange::DIRECT_ONLY;
            parts.push(SceneItem { backdrop: true, visible_range: VisibleRange::LAKE_ONLY, ..coarse });
            let rough = ground(&fields::sparse(scenario, site, LAKE_TOLERANCE_FACTOR), 0.0);
            parts.push(SceneItem { visible_range: VisibleRange::LAKE_ONLY, ..SceneItem::here("reflected ground", rough, false) });
        }
        report(LoadingStep::Plants);
        parts.extend(plants::parts(scenario, site, quality));
        report(LoadingStep::Water);
        let (vehicles, drone_airframes) = distinct_aircraft(site, vehicle);
        let common = [props::car(rounds), props::truck(rounds), props::person(rounds), props::rope(rounds)];
        let of_aircraft = |vehicle: &&Vehicle| [drone::body(vehicle), drone::propeller(vehicle), drone::propeller_disk(vehicle)];
        Self {
            parts,
            water: ground::water(scenario, site, &bake, &shown),
            ground_colors: GroundColors::new(scenario, site),
            patches: defects::patches(site, sun),
            models: common.into_iter().chain(vehicles.iter().flat_map(of_aircraft)).collect(),
            is_weathered: scenario.weather.rain_mm_h > 0.0 || scenario.weather.snow_mm_h > 0.0,
            paths: PathGuide::new(scenario),
            outline: Arc::new(SiteOutline::new(scenario, site)),
            bounds_m: bounds(site),
            airframes: vehicles.iter().map(|vehicle| propellers(vehicle)).collect(),
            drone_airframes,
            water_m: scenario.terrain.water_level_m,
        }
    }

    /// Returns the water level in meters.
    #[must_use]
    pub fn water_m(&self) -> f64 {
        self.water_m
    }

    /// Returns the instances of the moving objects at the given time.
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
            let Some(placed) = site.traffic().placement(mover, at) else { continue };
            let model = match mover.kind {
                MoverKind::Car => MoverModel::Car,
                MoverKind::Truck => MoverModel::Truck,
                MoverKind::Pedestrian => MoverModel::Person,
            };
            all.push((
                model,
                place_on_ground(placed.position_m, placed.forward, OPEN_AIR_LIGHT).with_material(props::color(mover.kind, k)),
            ));
        }
        let team = &scenario.ground_team;
        let facing = |heading_deg: f64| {
            let (s, c) = math::sin_cos(heading_deg.to_radians());
            Vec3::new(s, c, 0.0)
        };
        all.push((
            MoverModel::Truck,
            place_on_ground(team.truck_m, facing(team.truck_heading_deg), OPEN_AIR_LIGHT).with_material(props::CREW_TRUCK_COLOR),
        ));
        let inspector = site.inspector().at(at);
        all.push((
            MoverModel::Person,
            place_on_ground(inspector.feet_m, inspector.forward, OPEN_AIR_LIGHT).with_material(props::VEST_COLOR),
        ));
        ropes(site, at, &mut all);
        for (other, airframe) in site.drones().iter().zip(&self.drone_airframes) {
            let pose = Pose { position_m: other.at(at).position_m, ned_from_frd: other.attitude() };
            self.aircraft(site, (*airframe, &DronePose { pose, spinning: true }), at, &mut all);
        }
        for other in site.live_drones() {
            let pose = Pose { position_m: other.position_m, ned_from_frd: other.attitude };
            self.aircraft(site, (0, &DronePose { pose, spinning: other.armed }), at, &mut all);
        }
        if let Some(drone) = drone {
            self.aircraft(site, (0, drone), at, &mut all);
        }
        all
    }

    fn aircraft(&self, site: &Site, (airframe, drone): (u8, &DronePose), at: QueryTime, out: &mut Vec<(MoverModel, Instance)>) {
        let axis = |v: Vec3<Frd>| (drone.pose.ned_from_frd * v).enu();
        let axes = [axis(Vec3::new(1.0, 0.0, 0.0)), axis(Vec3::new(0.0, 1.0, 0.0)), axis(Vec3::new(0.0, 0.0, 1.0))];
        let around = bake::around(site, drone.pose.position_m, at);
        out.push((MoverModel::Drone(airframe), Instance::placed(drone.pose.position_m, axes, around)));
        for (hub_m, spin) in self.airframes.get(usize::from(airframe)).into_iter().flatten() {
            let hub = drone.pose.position_m + axis(*hub_m);
            let angle = if drone.spinning { -spin * DISPLAYED_ROTOR_SPEED_RAD_S * at.s() } else { 0.6 };
            let (s, c) = math::sin_cos(angle);
            let turned = [axes[0] * c + axes[1] * s, axes[1] * c - axes[0] * s, axes[2]];
            out.push((MoverModel::Propeller(airframe), Instance::placed(hub, turned, around)));
            if drone.spinning {
                out.push((MoverModel::PropellerDisk(airframe), Instance::placed(hub, axes, around)));
            }
        }
    }
}

/// Adds the segments of the ropes.
fn ropes(site: &Site, at: QueryTime, out: &mut Vec<(MoverModel, Instance)>) {
    for (rope, points_m) in site.ropes().points_m(at) {
        let around = points_m.get(points_m.len() / 2).map_or(OPEN_AIR_LIGHT, |middle_m| bake::around(site, *middle_m, at));
        for pair in points_m.windows(2) {
            let along = pair[1] - pair[0];
            let upright = Vec3::new(0.0, 0.0, 1.0);
            let helper = if along.horizontal_norm() > along.up().abs() { upright } else { Vec3::new(1.0, 0.0, 0.0) };
            let side = helper.cross(along).unit();
            let axes = [along, side * rope.radius_m(), along.cross(side).unit() * rope.radius_m()];
            out.push((MoverModel::Rope, Instance::placed(pair[0], axes, around)));
        }
    }
}

/// Returns the trainee's aircraft and the other types of aircraft at the site, and which of them each drone of the site is.
fn distinct_aircraft<'a>(site: &'a Site, own: &'a Vehicle) -> (Vec<&'a Vehicle>, Vec<u8>) {
    let mut vehicles = vec![own];
    let place = |drone: &'a SiteDrone| {
        let known = vehicles.iter().position(|vehicle| *vehicle == drone.vehicle());
        let place = known.unwrap_or_else(|| {
            vehicles.push(drone.vehicle());
            vehicles.len() - 1
        });
        u8::try_from(place).unwrap_or(0)
    };
    let places = site.drones().iter().map(place).collect();
    (vehicles, places)
}

fn propellers(vehicle: &Vehicle) -> Propellers {
    vehicle.rotors.iter().map(|rotor| (rotor.position_m, rotor.spin)).collect()
}

/// Indirect light in open air: the whole sky from above, half of the ground's reflected light from below (estimate).
const OPEN_AIR_LIGHT: [f32; 4] = [0.95, 0.02, 0.22, 0.10];

/// Returns an instance of a mesh (x forward, y left, z up) on the ground.
fn place_on_ground(feet_m: Vec3<Enu>, forward: Vec3<Enu>, around: [f32; 4]) -> Instance {
    let level: Vec3<Enu> = Vec3::new(forward.east(), forward.north(), 0.0).unit();
    let left = Vec3::new(-level.north(), level.east(), 0.0);
    Instance::placed(feet_m, [level, left, Vec3::new(0.0, 0.0, 1.0)], around)
}

/// Returns the bounding sphere of all members and the pad.
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
    let center = Vec3::new(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2]));
    let radius = points.iter().map(|p| (*p - center).norm()).fold(10.0, f64::max);
    (center, radius)
}
