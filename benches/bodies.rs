//! Compares the shapes and contacts of rapier and parry with Spandrel's own (docs/src/measured/bodies.md): the nearest point and the first hit of a
//! ray on convex members, an aircraft at rest, an impact at 30 m/s, and the time that each takes.

#[path = "support/best.rs"]
mod best;
#[path = "support/deck.rs"]
mod deck;

use best::best;
use deck::deck;
use rapier3d::parry::query::{PointQuery, Ray, RayCast};
use rapier3d::parry::shape::ConvexPolyhedron;
use rapier3d::prelude::{
    ColliderBuilder, ColliderHandle, MassProperties, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, RigidBodyType, Vector,
};
use spandrel_model::frames::{Enu, Frd, Vec3};
use spandrel_model::math::GRAVITY_M_S2;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::{BatteryModel, Scenario};
use spandrel_model::site::Site;
use spandrel_model::site::convex::Convex;
use spandrel_model::site::geometry::Geometry;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, PhysicsState, PowerLoad};
use std::hint::black_box;

const STEP: SimTime = SimTime::from_ms(1);
const STEP_S: f64 = 1e-3;
const ROUNDS: usize = 9;
/// Points and rays per member.
const QUERY_COUNT: usize = 400;
/// Distance of the points from a member's bounding box, at most, m.
const AROUND_M: f64 = 2.0;
/// Steps until an aircraft that was put down has come to rest, and those in which it is measured.
const SETTLING_STEPS: usize = 5_000;
const MEASURED_STEPS: usize = 1_000;
/// Radius of a foot, m (aircraft_hull.rs).
const FOOT_RADIUS_M: f64 = 0.015;
const IMPACT_M_S: f64 = 30.0;
/// Thickness of the plate that the aircraft hits in rapier, m.
const PLATE_M: f64 = 0.05;
/// Number of vehicles beside the aircraft.
const VEHICLE_COUNT: usize = 40;

fn vector(v: Vec3<Enu>) -> Vector {
    Vector::new(v.east(), v.north(), v.up())
}

/// A member as a shape of each library, with the points and directions that are asked about.
struct Pair {
    own: Convex,
    parry: ConvexPolyhedron,
    points: Vec<Vec3<Enu>>,
    directions: Vec<Vec3<Enu>>,
}

/// Returns the convex members of a scenario that parry accepts.
fn pairs(scenario: &Scenario) -> Vec<Pair> {
    let mut random = RandomStream::new(1, "bodies");
    let geometry = Geometry::new(scenario);
    let convex = geometry.members().iter().filter(|member| member.solid.surface.is_none());
    let pair = |member: &spandrel_model::scenario::bridges::Member| {
        let corners: Vec<Vector> = member.solid.vertices_m.iter().copied().map(vector).collect();
        let parry = ConvexPolyhedron::from_convex_hull(&corners)?;
        let own = Convex::new(&member.solid);
        let (low, high) = own.bounds();
        let mut place = || {
            let [e, n, u] = [0, 1, 2].map(|k| random.range(low.array()[k] - AROUND_M, high.array()[k] + AROUND_M));
            Vec3::new(e, n, u)
        };
        let points: Vec<Vec3<Enu>> = (0..QUERY_COUNT).map(|_| place()).collect();
        let directions = points.iter().map(|p| (place() - *p).unit()).collect();
        Some(Pair { own, parry, points, directions })
    };
    convex.filter_map(pair).collect()
}

/// A query about a member from a point in a direction.
type Query<'a> = &'a dyn Fn(&Pair, Vec3<Enu>, Vec3<Enu>) -> f64;

/// Prints the largest difference of the signed distances and of the first hits, and the time of a query.
fn compare_queries(pairs: &[Pair]) {
    let count = (pairs.len() * QUERY_COUNT) as f64;
    let signed = |shape: &ConvexPolyhedron, p: Vec3<Enu>| {
        let found = shape.project_local_point(vector(p), false);
        let distance_m = (found.point - vector(p)).length();
        if found.is_inside { -distance_m } else { distance_m }
    };
    let hit =
        |shape: &ConvexPolyhedron, p: Vec3<Enu>, d: Vec3<Enu>| shape.cast_local_ray(&Ray::new(vector(p), vector(d)), 100.0, true);
    let (mut distance_m, mut hit_m, mut missed, mut hits) = (0.0_f64, 0.0_f64, 0, 0);
    for pair in pairs {
        for (p, d) in pair.points.iter().zip(&pair.directions) {
            distance_m = distance_m.max((pair.own.nearest(*p).distance_m - signed(&pair.parry, *p)).abs());
            match (pair.own.ray(*p, *d, 100.0), hit(&pair.parry, *p, *d)) {
                (Some((own, _)), Some(parry)) => {
                    hits += 1;
                    hit_m = hit_m.max((own - parry).abs());
                }
                (None, None) => {}
                (Some(_), None) | (None, Some(_)) => missed += 1,
            }
        }
    }
    println!("{} convex members, {QUERY_COUNT} points and rays each", pairs.len());
    println!("  largest difference of the distances {distance_m:.1e} m; of {hits} hits {hit_m:.1e} m; hit by one only: {missed}");
    let time = |ask: Query| {
        let all =
            || pairs.iter().map(|pair| pair.points.iter().zip(&pair.directions).map(|(p, d)| ask(pair, *p, *d)).sum::<f64>());
        best(ROUNDS, || black_box(all().sum::<f64>())).as_secs_f64() * 1e9 / count
    };
    let own = [
        time(&|pair, p, _| pair.own.nearest(p).distance_m),
        time(&|pair, p, d| pair.own.ray(p, d, 100.0).map_or(0.0, |hit| hit.0)),
    ];
    let parry = [time(&|pair, p, _| signed(&pair.parry, p)), time(&|pair, p, d| hit(&pair.parry, p, d).unwrap_or(0.0))];
    for (what, (own, parry)) in ["nearest point", "ray"].into_iter().zip(own.into_iter().zip(parry)) {
        println!("  {what}: own {own:.0} ns, parry {parry:.0} ns ({:.1} times)", parry / own);
    }
}

/// Returns the height of the center of mass of an aircraft that stands on its feet, m.
fn standing_m(vehicle: &Vehicle) -> f64 {
    vehicle.hull.feet_m.iter().map(|foot| foot.down()).fold(0.0, f64::max) + FOOT_RADIUS_M
}

/// An aircraft with its feet above a plate in rapier's world. The plate's upper side is at 0.
struct RapierAircraft {
    world: PhysicsWorld,
    body: RigidBodyHandle,
    feet: Vec<ColliderHandle>,
    /// Height of the center of mass when the feet touch the plate, m.
    standing_m: f64,
}

impl RapierAircraft {
    fn new(vehicle: &Vehicle, plate_m: f64, above_m: f64, speed_m_s: f64) -> Self {
        let mut world = PhysicsWorld { gravity: Vector::new(0.0, 0.0, -GRAVITY_M_S2), ..PhysicsWorld::default() };
        world.integration_parameters.dt = STEP_S;
        let surface = |collider: ColliderBuilder| collider.friction(vehicle.hull.friction).restitution(vehicle.hull.restitution);
        let plate = RigidBodyBuilder::fixed().translation(Vector::new(0.0, 0.0, -0.5 * plate_m));
        world.insert(plate, surface(ColliderBuilder::cuboid(20.0, 20.0, 0.5 * plate_m)));
        let standing_m = standing_m(vehicle);
        let inertia = Vector::from_array(vehicle.inertia_kg_m2);
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(0.0, 0.0, standing_m + above_m))
            .linvel(Vector::new(0.0, 0.0, -speed_m_s))
            .additional_mass_properties(MassProperties::new(Vector::ZERO, vehicle.mass_kg, inertia))
            .can_sleep(false);
        let body = world.insert_body(body);
        let feet = vehicle.hull.feet_m.iter().map(|foot: &Vec3<Frd>| {
            let place = Vector::new(foot.forward(), -foot.right(), -foot.down());
            let ball = surface(ColliderBuilder::ball(FOOT_RADIUS_M)).translation(place).density(0.0);
            world.colliders.insert_with_parent(ball, body, &mut world.bodies)
        });
        let feet = feet.collect();
        Self { world, body, feet, standing_m }
    }

    /// Adds vehicles that pass by without touching the aircraft.
    fn with_vehicles(mut self) -> Self {
        for k in 0..VEHICLE_COUNT {
            let place = Vector::new(4.0 * k as f64 - 80.0, 6.0, 0.8);
            let body = RigidBodyBuilder::new(RigidBodyType::KinematicVelocityBased).translation(place);
            self.world.insert(body.linvel(Vector::new(15.0, 0.0, 0.0)), ColliderBuilder::cuboid(2.2, 0.9, 0.8));
        }
        self
    }

    /// Height of the feet above the plate, m.
    fn height_m(&self) -> f64 {
        self.world.bodies[self.body].translation().z - self.standing_m
    }

    fn normal_force_n(&self) -> f64 {
        let impulse = |foot: &ColliderHandle| -> f64 {
            self.world.contact_pairs_with(*foot).map(|pair| pair.total_impulse_magnitude()).sum()
        };
        self.feet.iter().map(impulse).sum::<f64>() / STEP_S
    }

    fn settle(&mut self) {
        (0..SETTLING_STEPS).for_each(|_| self.world.step());
    }
}

/// Motion and normal force of an aircraft that stands on its feet.
struct Rest {
    sunk_m: f64,
    drift_m: f64,
    force_error: f64,
}

impl Rest {
    /// Measures an aircraft of a weight. `step` advances it and returns the height of its feet, m, and its normal force, N.
    fn measure(weight_n: f64, mut step: impl FnMut() -> (f64, f64)) -> Self {
        let samples: Vec<(f64, f64)> = (0..MEASURED_STEPS).map(|_| step()).collect();
        let heights = samples.iter().map(|sample| sample.0);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (h.min(low), h.max(high)));
        let force_error = samples.iter().map(|sample| (sample.1 / weight_n - 1.0).abs()).fold(0.0, f64::max);
        Self { sunk_m: -low, drift_m: high - low, force_error }
    }

    fn print(&self, whose: &str, ns: f64) {
        println!(
            "  {whose}: sunk in {:.1e} m, moves {:.1e} m in 1 s, normal force differs from the weight by {:.1e}; {ns:.0} ns per step",
            self.sunk_m, self.drift_m, self.force_error
        );
    }
}

fn ns_per_step(steps: usize, mut step: impl FnMut()) -> f64 {
    best(ROUNDS, || (0..steps).for_each(|_| step())).as_secs_f64() * 1e9 / steps as f64
}

/// The bridge deck under Spandrel's own contacts.
struct OwnDeck<'a> {
    model: &'a AirframeModel,
    site: &'a Site,
    place: Vec3<Enu>,
}

impl OwnDeck<'_> {
    fn step(&self, state: &mut PhysicsState, now: &mut SimTime) {
        self.model.advance(state, &Actuators::default(), &AirState::STILL, self.site, PowerLoad::default(), *now, STEP);
        *now += STEP;
    }

    /// Returns the state with the feet at a height above the deck.
    fn above(&self, vehicle: &Vehicle, above_m: f64) -> PhysicsState {
        PhysicsState::at_rest((self.place + Vec3::new(0.0, 0.0, standing_m(vehicle) + above_m)).ned(), 0.0)
    }

    fn height_m(&self, vehicle: &Vehicle, state: &PhysicsState) -> f64 {
        self.above(vehicle, 0.0).rigid.position_m.down() - state.rigid.position_m.down()
    }
}

fn compare_rest(vehicle: &Vehicle, deck: &OwnDeck) {
    println!("an aircraft at rest");
    let weight_n = vehicle.mass_kg * GRAVITY_M_S2;
    let (mut state, mut now) = (deck.above(vehicle, 0.01), SimTime::ZERO);
    (0..SETTLING_STEPS).for_each(|_| deck.step(&mut state, &mut now));
    let own = Rest::measure(weight_n, || {
        deck.step(&mut state, &mut now);
        (deck.height_m(vehicle, &state), state.contact.normal_force_n)
    });
    own.print("own", ns_per_step(MEASURED_STEPS, || deck.step(&mut state, &mut now)));
    let mut rapier = RapierAircraft::new(vehicle, 0.5, 0.01, 0.0);
    rapier.settle();
    let theirs = Rest::measure(weight_n, || {
        rapier.world.step();
        (rapier.height_m(), rapier.normal_force_n())
    });
    theirs.print("rapier", ns_per_step(MEASURED_STEPS, || rapier.world.step()));
    let mut crowded = RapierAircraft::new(vehicle, 0.5, 0.01, 0.0).with_vehicles();
    crowded.settle();
    println!("  rapier, with {VEHICLE_COUNT} vehicles: {:.0} ns per step", ns_per_step(MEASURED_STEPS, || crowded.world.step()));
    let mut alone = RapierAircraft::new(vehicle, 0.5, 500.0, 0.0);
    println!("  rapier, in the air: {:.0} ns per step", ns_per_step(MEASURED_STEPS, || alone.world.step()));
}

/// Prints how far an aircraft gets into a surface that it hits.
fn compare_impact(vehicle: &Vehicle, deck: &OwnDeck) {
    println!("an impact at {IMPACT_M_S} m/s, feet first");
    let (mut state, mut now) = (deck.above(vehicle, 0.5), SimTime::ZERO);
    state.rigid.velocity_m_s = Vec3::<Enu>::new(0.0, 0.0, -IMPACT_M_S).ned();
    let depth = |step: &mut dyn FnMut() -> f64| (0..200).map(|_| -step()).fold(f64::NEG_INFINITY, f64::max);
    let own = depth(&mut || {
        deck.step(&mut state, &mut now);
        deck.height_m(vehicle, &state)
    });
    println!("  own, a deck: at most {own:.1e} m deep");
    let mut rapier = RapierAircraft::new(vehicle, PLATE_M, 0.5, IMPACT_M_S);
    let deepest = depth(&mut || {
        rapier.world.step();
        rapier.height_m()
    });
    println!("  rapier, a plate of {PLATE_M} m: at most {deepest:.1e} m deep");
}

fn main() {
    let text = include_str!("../scenarios/two-bridges.toml");
    let mut scenario: Scenario = spandrel_model::scenario::read("two-bridges.toml", text, &|_| Err("no file".into()))
        .expect("the shipped scenario must be valid");
    compare_queries(&pairs(&scenario));
    (scenario.traffic.cars, scenario.traffic.trucks) = (0, 0);
    let vehicle = spandrel_model::vehicle::read("phantom2.toml", spandrel_model::shipped::PHANTOM2)
        .expect("the shipped aircraft must be valid");
    let (site, model) = (Site::build(&scenario, 1), AirframeModel::new(&vehicle, BatteryModel::Physical));
    let deck = OwnDeck { model: &model, site: &site, place: deck(&site) };
    compare_rest(&vehicle, &deck);
    compare_impact(&vehicle, &deck);
}
