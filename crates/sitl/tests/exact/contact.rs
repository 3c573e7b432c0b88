//! Contact response compared with statics and impact theory.

use spandrel_model::frames::{Enu, Rotation, Vec3};
use spandrel_model::math::GRAVITY_M_S2;
use spandrel_model::scenario::BatteryModel;
use spandrel_model::site::{Contact, HullProbe, ObjectId, RayHit, Surface};
use spandrel_model::time::SimTime;
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, Obstacles, PhysicsState, PowerLoad};
use spandrel_testkit::aircraft::quad;

const DT: SimTime = SimTime::from_ms(1);

/// A half space below `top_m` with thickness `thick_m`.
struct Plate {
    top_m: f64,
    thick_m: f64,
}

impl Plate {
    fn touch(&self, center: Vec3<Enu>, radius: f64, margin: f64, out: &mut Vec<Contact>) {
        let middle = self.top_m - 0.5 * self.thick_m;
        let up = if center.up() >= middle { 1.0 } else { -1.0 };
        let gap = (center.up() - middle).abs() - 0.5 * self.thick_m - radius;
        if gap <= margin {
            let face = middle + up * 0.5 * self.thick_m;
            out.push(Contact {
                point_m: Vec3::new(center.east(), center.north(), face),
                normal: Vec3::new(0.0, 0.0, up),
                gap_m: gap,
                velocity_m_s: Vec3::zero(),
                surface: Surface::Bridge,
                object: ObjectId(0),
            });
        }
    }
}

impl Obstacles for Plate {
    fn contacts(&self, probe: &HullProbe, margin_m: f64, _: SimTime, out: &mut Vec<Contact>) {
        match *probe {
            HullProbe::Ball { center_m, radius_m } => self.touch(center_m, radius_m, margin_m, out),
            HullProbe::Capsule { a_m, b_m, radius_m } => {
                self.touch(a_m, radius_m, margin_m, out);
                self.touch(b_m, radius_m, margin_m, out);
            }
        }
    }
    fn clearance(&self, p: Vec3<Enu>, max_m: f64, _: SimTime) -> Option<f64> {
        let d = (p.up() - self.top_m).max(self.top_m - self.thick_m - p.up());
        (d <= max_m).then_some(d)
    }
    fn ray(&self, _: Vec3<Enu>, _: Vec3<Enu>, _: f64, _: SimTime) -> Option<RayHit> {
        None
    }
}

const GROUND: Plate = Plate { top_m: 0.0, thick_m: 100.0 };
/// Height of the center of mass when the feet (0.12 m below, balls with a radius of 15 mm) are on the ground.
const STANDING_HEIGHT_M: f64 = 0.135;

fn at(up: f64) -> PhysicsState {
    PhysicsState::at_rest(Vec3::new(0.0, 0.0, -up), 0.0)
}

fn run(plate: &Plate, state: &mut PhysicsState, steps: i64, mut each: impl FnMut(&PhysicsState)) {
    let model = AirframeModel::new(&quad(), BatteryModel::Paper);
    for k in 0..steps {
        model.advance(state, &Actuators::default(), &AirState::STILL, plate, PowerLoad::default(), SimTime::from_ms(k), DT);
        each(state);
    }
}

#[test]
fn exact_aircraft_at_rest_does_not_drift() {
    // Maximum drift in 60 s, m, and relative force tolerance.
    const MAX_DRIFT_M: f64 = 1e-6;
    const FORCE_TOLERANCE: f64 = 1e-6;
    let mut state = at(STANDING_HEIGHT_M);
    let (mut steps, mut start, mut force) = (0, Vec3::zero(), 0.0);
    run(&GROUND, &mut state, 61_000, |s| {
        steps += 1;
        if steps == 1000 {
            start = s.rigid.position_m;
        } else if steps > 1000 {
            force += s.contact.normal_force_n;
        }
    });
    assert!((state.rigid.position_m - start).norm() < MAX_DRIFT_M, "{:?}", state.rigid.position_m - start);
    assert!((force / 60_000.0 / (1.3 * GRAVITY_M_S2) - 1.0).abs() < FORCE_TOLERANCE, "{}", force / 60_000.0);
    assert!((state.specific_force_m_s2.down() + GRAVITY_M_S2).abs() < FORCE_TOLERANCE);
}

#[test]
fn exact_dropped_aircraft_comes_to_rest_on_its_feet() {
    // Height tolerance, m.
    const TOLERANCE: f64 = 1e-3;
    let mut state = at(0.8);
    run(&GROUND, &mut state, 5000, |_| ());
    assert!((-state.rigid.position_m.down() - STANDING_HEIGHT_M).abs() < TOLERANCE, "{:?}", state.rigid.position_m);
    assert!(state.rigid.velocity_m_s.norm() < TOLERANCE);
}

#[test]
fn exact_bounce_does_not_gain_energy() {
    let mut state = at(1.5);
    state.rigid.attitude = Rotation::from_euler(0.4, 0.2, 0.0);
    state.rigid.velocity_m_s = Vec3::new(2.0, 0.0, 0.0);
    let energy = |s: &PhysicsState| {
        let w = s.rigid.rates_rad_s.array();
        let spin: f64 = [0.0097, 0.0097, 0.017].iter().zip(w).map(|(i, w)| 0.5 * i * w * w).sum();
        0.5 * 1.3 * s.rigid.velocity_m_s.norm_squared() + spin - 1.3 * GRAVITY_M_S2 * s.rigid.position_m.down()
    };
    let mut highest = energy(&state);
    run(&GROUND, &mut state, 4000, |s| {
        let now = energy(s);
        // Energy tolerance, J: correcting 0.01 mm of penetration lifts the body by that distance.
        assert!(now <= highest + 2e-3, "{now} after {highest}");
        highest = highest.min(now);
    });
}

#[test]
fn exact_friction_force_stays_within_the_friction_cone() {
    let mut state = at(STANDING_HEIGHT_M);
    state.rigid.velocity_m_s = Vec3::new(3.0, 0.0, 0.0);
    let mut before = 3.0;
    run(&GROUND, &mut state, 200, |s| {
        let now = s.rigid.velocity_m_s.north();
        // Coulomb friction decelerates by at most mu times the normal force over the mass.
        let bound = 0.6 * s.contact.normal_force_n / 1.3 * DT.s() + 0.001;
        assert!(before - now <= bound, "{before} -> {now}, bound {bound}");
        before = now;
    });
}

#[test]
fn exact_thin_plate_stops_aircraft_at_30_m_s() {
    let plate = Plate { top_m: 0.0, thick_m: 0.05 };
    for (roll, start) in [(0.0, 2.013), (0.7, 1.987), (1.5, 2.001), (3.1, 2.029)] {
        let mut state = at(start);
        state.rigid.attitude = Rotation::from_euler(roll, 0.3, 0.0);
        state.rigid.velocity_m_s = Vec3::new(0.0, 0.0, 30.0);
        run(&plate, &mut state, 1000, |_| ());
        assert!(state.rigid.position_m.down() < 0.0, "roll {roll}: passed to {:?}", state.rigid.position_m);
    }
}
