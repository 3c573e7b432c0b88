//! Aircraft on and against members of the shipped bridges, and next to steep ground.

use spandrel_model::frames::{Enu, Rotation, Vec3};
use spandrel_model::math::{self, GRAVITY_M_S2};
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::{BatteryModel, Scenario};
use spandrel_model::site::{Contact, HullProbe, RayHit, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, Obstacles, PhysicsState, PowerLoad};

const DT: SimTime = SimTime::from_ms(1);
/// Radius of the balls at the feet, m (crates/model/src/site/aircraft_hull.rs).
const FOOT_RADIUS_M: f64 = 0.015;

fn scenario() -> Scenario {
    let text = spandrel_model::shipped::TWO_BRIDGES;
    let mut scenario =
        spandrel_model::scenario::read("two-bridges.toml", text, &|_| Err("none".into())).unwrap_or_else(|p| panic!("{p}"));
    // Without traffic, nothing hits an aircraft that stands on the deck.
    (scenario.traffic.cars, scenario.traffic.trucks, scenario.traffic.pedestrians) = (0, 0, 0);
    scenario
}

fn vehicles() -> Vec<Vehicle> {
    [
        spandrel_model::shipped::PHANTOM2,
        spandrel_model::shipped::F450,
        spandrel_model::shipped::M30,
        spandrel_model::shipped::ELIOS3,
    ]
    .map(|text| spandrel_model::vehicle::read("shipped.toml", text).unwrap_or_else(|p| panic!("{p}")))
    .to_vec()
}

fn state(position: Vec3<Enu>) -> PhysicsState {
    PhysicsState::at_rest(position.ned(), 0.0)
}

fn run(model: &AirframeModel, obstacles: &impl Obstacles, state: &mut PhysicsState, steps: i64, each: impl FnMut(&PhysicsState)) {
    run_from(0, model, obstacles, state, steps, each);
}

fn run_from(
    from_ms: i64,
    model: &AirframeModel,
    obstacles: &impl Obstacles,
    state: &mut PhysicsState,
    steps: i64,
    mut each: impl FnMut(&PhysicsState),
) {
    for k in from_ms..from_ms + steps {
        let now = SimTime::from_ms(k);
        model.advance(state, &Actuators::default(), &AirState::STILL, obstacles, PowerLoad::default(), now, DT);
        each(state);
    }
}

/// Returns a point on a member's upper side, specified in the bridge's axes.
fn on_top(scenario: &Scenario, site: &Site, member: &str, [x, y]: [f64; 2]) -> Vec3<Enu> {
    let (name, _) = member.split_once('/').unwrap();
    let bridge = scenario.bridges.iter().find(|b| b.name == name).unwrap();
    let k = site.members().iter().position(|m| m.name == member).unwrap_or_else(|| panic!("no {member}"));
    let high = site.geometry().shape(k).unwrap().bounds().1.up() + 1.0;
    let from = bridge.placement().point([x, y, high - bridge.center_m.up()]);
    let down = Vec3::new(0.0, 0.0, -1.0);
    let (distance, _) = site
        .geometry()
        .shape(k)
        .unwrap()
        .ray(from, down, 100.0)
        .unwrap_or_else(|| panic!("{member} does not exist at this point"));
    from + down * distance
}

/// Returns how far the lowest part of a level aircraft is below its center, in meters.
fn lowest_part_below_center_m(vehicle: &Vehicle) -> f64 {
    let feet = vehicle.hull.feet_m.iter().map(|f| f.down()).fold(0.0, f64::max) + FOOT_RADIUS_M;
    if vehicle.hull.has_propeller_guard { feet.max(0.5 * vehicle.hull.tip_to_tip_m) } else { feet }
}

#[test]
fn exact_aircraft_on_a_bridge_stays_within_a_millimeter() {
    // Maximum drift in 5 s, m, after one second of settling from a height of about a centimeter.
    const MAX_DRIFT_M: f64 = 1e-3;
    // Relative tolerance for the mean force over 5 s.
    const FORCE_TOLERANCE: f64 = 1e-3;
    let scenario = scenario();
    let site = Site::build(&scenario, 3);
    for vehicle in vehicles() {
        let model = AirframeModel::new(&vehicle, BatteryModel::Paper);
        let low = lowest_part_below_center_m(&vehicle);
        for (member, place) in [
            ("arch/slab/08", [3.0, 1.2]),
            ("arch/rib-left/14", [1.75, 2.9]),
            ("arch/strut/05", [-7.0, 0.0]),
            ("arch/skewback-end", [49.5, 2.0]),
            ("suspension/slab/10", [-45.0, -2.0]),
            ("suspension/pier-start", [-70.0, 0.5]),
            ("suspension/tower-end/portal-deck", [70.0, 0.3]),
            ("suspension/tower-start/portal-top", [-70.0, 0.0]),
            ("suspension/anchorage-end/left", [116.0, 5.3]),
        ] {
            let mut s = state(on_top(&scenario, &site, member, place) + Vec3::new(0.0, 0.0, low + 0.01));
            run(&model, &site, &mut s, 1000, |_| ());
            let (start, mut force) = (s.rigid.position_m, 0.0);
            let mut worst: f64 = 0.0;
            run_from(1000, &model, &site, &mut s, 5000, |s| {
                force += s.contact.normal_force_n;
                worst = worst.max((s.rigid.position_m - start).norm());
            });
            assert!(worst < MAX_DRIFT_M, "{} on {member}: drifted {worst} m", vehicle.id);
            let share = force / 5000.0 / (vehicle.mass_kg * GRAVITY_M_S2);
            // On the sloping rib, friction carries part of the weight.
            let least = if member.contains("rib") { 0.9 } else { 1.0 - FORCE_TOLERANCE };
            assert!((least..1.0 + FORCE_TOLERANCE).contains(&share), "{} on {member}: {share} of its weight", vehicle.id);
        }
    }
}

#[test]
fn exact_aircraft_on_the_pad_does_not_drift() {
    // Maximum drift in 60 s, m, and relative tolerance for the mean normal force.
    const MAX_DRIFT_M: f64 = 1e-6;
    const FORCE_TOLERANCE: f64 = 1e-6;
    let scenario = scenario();
    let site = Site::build(&scenario, 3);
    for vehicle in vehicles() {
        let model = AirframeModel::new(&vehicle, BatteryModel::Paper);
        let low = lowest_part_below_center_m(&vehicle);
        let mut s = PhysicsState::at_rest((scenario.ground_team.pad_m + Vec3::new(0.0, 0.0, low + 0.01)).ned(), 0.6);
        run(&model, &site, &mut s, 2000, |_| ());
        let (start, mut worst, mut force): (_, f64, f64) = (s.rigid.position_m, 0.0, 0.0);
        run_from(2000, &model, &site, &mut s, 60_000, |s| {
            worst = worst.max((s.rigid.position_m - start).norm());
            force += s.contact.normal_force_n;
        });
        let share = force / 60_000.0 / (vehicle.mass_kg * GRAVITY_M_S2);
        assert!(worst < MAX_DRIFT_M, "{}: {worst} m", vehicle.id);
        assert!((share - 1.0).abs() < FORCE_TOLERANCE, "{}: {share} of its weight", vehicle.id);
    }
}

#[test]
fn exact_tilted_aircraft_on_a_beam_edge_falls_outward() {
    let scenario = scenario();
    let site = Site::build(&scenario, 3);
    let model = AirframeModel::new(&vehicles()[0], BatteryModel::Paper);
    // Struts between the ribs are 0.7 m wide. Bridge and aircraft both face east, so negative pitch leans over the far
    // edge.
    for (lean, side) in [(-0.35, 1.0), (0.35, -1.0)] {
        let top = on_top(&scenario, &site, "arch/strut/05", [-7.0, 0.0]);
        let mut s = state(top + Vec3::new(side * 0.40, 0.0, 0.22));
        s.rigid.attitude = Rotation::from_euler(0.0, lean, std::f64::consts::FRAC_PI_2);
        let (mut most, mut fell, mut touched): (f64, bool, bool) = (0.0, false, false);
        run(&model, &site, &mut s, 1500, |s| {
            let height = s.rigid.position_m.enu().up() - top.up();
            touched |= s.contact.touching();
            if height > -0.5 {
                let nose_up = math::asin(-(s.rigid.attitude * Vec3::new(1.0, 0.0, 0.0)).down());
                most = most.max(nose_up * lean.signum());
            }
            fell |= height < -2.0;
        });
        assert!(touched && fell, "lean {lean}: the aircraft did not fall, {:?}", s.rigid.position_m);
        assert!(most > 0.35 + 0.2, "lean {lean}: the aircraft tilted only {most} rad");
        assert!((s.rigid.position_m.enu() - top).east() * side > 0.4, "lean {lean}: the aircraft fell back over the beam");
    }
}

#[test]
fn exact_tilted_aircraft_on_the_deck_comes_to_rest_upright() {
    let scenario = scenario();
    let site = Site::build(&scenario, 3);
    let vehicle = &vehicles()[0];
    let model = AirframeModel::new(vehicle, BatteryModel::Paper);
    let mut s = state(on_top(&scenario, &site, "arch/slab/08", [3.0, 1.2]) + Vec3::new(0.0, 0.0, 0.35));
    s.rigid.attitude = Rotation::from_euler(0.25, -0.2, 0.7);
    run(&model, &site, &mut s, 5000, |_| ());
    let up = -(s.rigid.attitude * Vec3::new(0.0, 0.0, 1.0)).down();
    assert!(up < -0.999_9, "the aircraft does not stand upright: {up}");
}

/// Checks that the arms do not penetrate anything: no obstacle may be between the center and the hubs.
fn is_free_of_obstacles(vehicle: &Vehicle, site: &Site, s: &PhysicsState) -> bool {
    let center = s.rigid.position_m.enu();
    let mut all = vehicle.rotors.iter().map(|r| (s.rigid.attitude * r.position_m).enu());
    all.all(|arm| site.geometry().ray(center, arm.unit(), arm.norm()).is_none())
}

#[test]
fn exact_members_stop_aircraft_at_30_m_s() {
    const IMPACT_SPEED_M_S: f64 = 30.0;
    let site = Site::build(&scenario(), 3);
    let mut random = RandomStream::new(5, "shots");
    let members = [
        "arch/slab/08",
        "arch/rib-left/14",
        "arch/column-right/03",
        "arch/floorbeam/04",
        "arch/stringer-1/05",
        "arch/rail-left/2",
        "suspension/slab/10",
        "suspension/girder-left/10/web",
        "suspension/girder-right/20/bottom",
        "suspension/floorbeam/12/web",
        "suspension/stringer-0/15/web",
        "suspension/tower-start/left",
        "suspension/cable-left/007",
        "suspension/hanger-right/010",
        "suspension/post-left/030",
    ];
    for vehicle in &vehicles() {
        let model = AirframeModel::new(vehicle, BatteryModel::Paper);
        let (mut shots, mut stopped) = (0, 0);
        for member in members {
            let solid = &site.members().iter().find(|m| m.name == member).unwrap_or_else(|| panic!("no {member}")).solid;
            for _ in 0..20 {
                let corners = &solid.vertices_m;
                let mean = corners.iter().fold(Vec3::zero(), |sum, c| sum + *c) / corners.len() as f64;
                let corner = corners[(random.uniform() * corners.len() as f64) as usize % corners.len()];
                let aim = mean.lerp(corner, random.range(0.0, 0.6));
                let towards = Vec3::<Enu>::new(random.normal(), random.normal(), random.normal()).unit();
                let start = aim - towards * (1.5 + random.uniform());
                if site.geometry().free_radius(start, vehicle.hull.tip_to_tip_m).is_some() {
                    continue;
                }
                let mut s = state(start);
                s.rigid.attitude =
                    Rotation::from_euler(random.range(-3.1, 3.1), random.range(-1.5, 1.5), random.range(-3.1, 3.1));
                s.rigid.velocity_m_s = (towards * IMPACT_SPEED_M_S).ned();
                shots += 1;
                let mut before = start;
                let mut touched = false;
                run(&model, &site, &mut s, 200, |s| {
                    let now = s.rigid.position_m.enu();
                    let step = now - before;
                    let way = site.geometry().ray(before, step.unit(), step.norm());
                    assert!(step.norm() == 0.0 || way.is_none(), "{} passed through {:?} at {member}", vehicle.id, way);
                    assert!(is_free_of_obstacles(vehicle, &site, s), "{}: an arm penetrates an obstacle at {member}", vehicle.id);
                    before = now;
                    touched |= s.contact.touching();
                });
                stopped += usize::from(touched);
            }
        }
        assert!(shots > 60 && 2 * stopped > shots, "{}: {stopped} of {shots}", vehicle.id);
    }
}

/// A site that performs contact queries in every step.
struct AlwaysQueriedSite<'a>(&'a Site);

impl Obstacles for AlwaysQueriedSite<'_> {
    fn contacts(&self, probe: &HullProbe, margin_m: f64, at: SimTime, out: &mut Vec<Contact>) {
        Obstacles::contacts(self.0, probe, margin_m, at, out);
    }
    fn clearance(&self, _: Vec3<Enu>, _: f64, _: SimTime) -> Option<f64> {
        Some(0.0)
    }
    fn ray(&self, origin_m: Vec3<Enu>, direction: Vec3<Enu>, max_m: f64, at: SimTime) -> Option<RayHit> {
        Obstacles::ray(self.0, origin_m, direction, max_m, at)
    }
}

#[test]
fn exact_skipping_contact_queries_far_from_obstacles_changes_nothing() {
    let scenario = scenario();
    let site = Site::build(&scenario, 3);
    let model = AirframeModel::new(&vehicles()[0], BatteryModel::Paper);
    let mut random = RandomStream::new(6, "steep");
    let mut touched = 0;
    for k in 0..60 {
        // Flights along and into the embankments next to the arch ends, the valley slopes, and the bridge.
        let x = if k % 2 == 0 { -1.0 } else { 1.0 } * random.range(40.0, 90.0);
        let (y, up) = (random.range(-35.0, 35.0), random.range(0.3, 4.0));
        let from = Vec3::<Enu>::new(x, y, site.ground_up_m(x, y).max(0.0) + up);
        if site.geometry().free_radius(from, 0.4).is_some() {
            continue;
        }
        let velocity =
            Vec3::<Enu>::new(random.normal(), random.normal(), -0.3 * random.uniform()).unit() * random.range(2.0, 25.0);
        let start = || {
            let mut s = state(from);
            s.rigid.velocity_m_s = velocity.ned();
            s
        };
        let (mut a, mut b) = (start(), start());
        let mut flown = Vec::new();
        run(&model, &site, &mut a, 1500, |s| flown.push(s.rigid));
        let mut step = 0;
        run(&model, &AlwaysQueriedSite(&site), &mut b, 1500, |s| {
            assert_eq!(s.rigid, flown[step], "shot {k}, step {step}");
            step += 1;
            touched += usize::from(s.contact.touching());
        });
    }
    assert!(touched > 1000, "{touched}");
}
