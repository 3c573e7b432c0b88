//! Collisions of two simulated aircraft compared with impact theory.

use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::BatteryModel;
use spandrel_model::shipped::{ELIOS3, M30, PHANTOM2};
use spandrel_model::site::{ObjectId, Surface};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::physics::pair_contact::{PairMember, may_touch, resolve_pair};
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, ContactReport, OpenSky, PhysicsState, PowerLoad};

const DT: SimTime = SimTime::from_ms(1);
/// Relative rounding tolerance of sums over many impulses.
const ROUNDING: f64 = 1e-12;

/// An aircraft in weightlessness, so that only the collision changes its motion.
struct Body {
    vehicle: Vehicle,
    model: AirframeModel,
    state: PhysicsState,
}

impl Body {
    fn new(text: &str, position_m: Vec3<Ned>, velocity_m_s: Vec3<Ned>) -> Self {
        let vehicle = spandrel_model::vehicle::read("shipped.toml", text).unwrap_or_else(|problems| panic!("{problems}"));
        let mut model = AirframeModel::new(&vehicle, BatteryModel::Paper);
        model.gravity_scale = 0.0;
        let mut state = PhysicsState::at_rest(position_m, 0.0);
        state.rigid.velocity_m_s = velocity_m_s;
        Self { vehicle, model, state }
    }

    fn fly(&mut self, ms: i64) {
        let load = PowerLoad::default();
        self.model.advance(&mut self.state, &Actuators::default(), &AirState::STILL, &OpenSky, load, SimTime::from_ms(ms), DT);
    }

    fn momentum(&self) -> Vec3<Ned> {
        self.state.rigid.velocity_m_s * self.model.mass_kg
    }

    /// Returns the angular momentum about the origin of the site.
    fn angular_momentum(&self) -> Vec3<Ned> {
        let rigid = &self.state.rigid;
        let [x, y, z] = rigid.rates_rad_s.array();
        let [i, j, k] = self.vehicle.inertia_kg_m2;
        rigid.position_m.cross(self.momentum()) + rigid.attitude * Vec3::<Frd>::new(i * x, j * y, k * z)
    }

    fn energy_j(&self) -> f64 {
        let rates = self.state.rigid.rates_rad_s.array();
        let turning: f64 = self.vehicle.inertia_kg_m2.iter().zip(rates).map(|(inertia, rate)| inertia * rate * rate).sum();
        0.5 * (self.model.mass_kg * self.state.rigid.velocity_m_s.norm_squared() + turning)
    }
}

fn touch(a: &mut Body, b: &mut Body) -> [ContactReport; 2] {
    let mut one = PairMember { model: &a.model, state: &mut a.state, object: ObjectId(1) };
    let mut other = PairMember { model: &b.model, state: &mut b.state, object: ObjectId(2) };
    resolve_pair(&mut one, &mut other, DT.s())
}

#[test]
fn exact_frontal_collision_has_the_velocities_of_impact_theory() {
    for (text, own_m_s, other_m_s) in [(ELIOS3, 6.0, -3.0), (M30, 6.0, 0.0), (PHANTOM2, 2.0, -9.0)] {
        // The first one is a ball, which touches the other one's ball or body in the line of flight.
        let mut a = Body::new(ELIOS3, Vec3::zero(), Vec3::new(own_m_s, 0.0, 0.0));
        let mut b = Body::new(text, Vec3::new(3.0, 0.0, 0.0), Vec3::new(other_m_s, 0.0, 0.0));
        // Moves the second one until they almost touch, without air.
        while touch(&mut a, &mut b)[0] == ContactReport::default() && b.state.rigid.position_m.north() > 0.0 {
            b.state.rigid.position_m += Vec3::new(-1e-3, 0.0, 0.0);
        }
        let (m, n) = (a.model.mass_kg, b.model.mass_kg);
        let restitution = 0.5 * (a.vehicle.hull.restitution + b.vehicle.hull.restitution);
        let center_m_s = (m * own_m_s + n * other_m_s) / (m + n);
        let relative_m_s = a.state.rigid.velocity_m_s.north() - b.state.rigid.velocity_m_s.north();
        let mean_m_s = (m * a.state.rigid.velocity_m_s.north() + n * b.state.rigid.velocity_m_s.north()) / (m + n);
        assert!((mean_m_s - center_m_s).abs() < 1e-9, "{mean_m_s} {center_m_s}");
        if text == ELIOS3 {
            // Central impact: the relative velocity is reversed.
            let expected_m_s = restitution * (other_m_s - own_m_s);
            assert!((relative_m_s - expected_m_s).abs() < 1e-6, "{relative_m_s} {expected_m_s}");
            let own = center_m_s + n / (m + n) * expected_m_s;
            assert!((a.state.rigid.velocity_m_s.north() - own).abs() < 1e-6);
        } else {
            assert!(relative_m_s < own_m_s - other_m_s - 1.0, "{relative_m_s}");
        }
    }
}

#[test]
fn prop_any_collision_conserves_momentum_and_gains_no_energy() {
    let mut random = RandomStream::new(9, "collisions");
    let mut hits = 0;
    for k in 0..1_200 {
        let mut around =
            |size: f64| Vec3::<Ned>::new(random.range(-size, size), random.range(-size, size), random.range(-size, size));
        let texts = [PHANTOM2, M30, ELIOS3];
        let mut a = Body::new(texts[k % 3], around(0.3), around(12.0));
        let mut b = Body::new(texts[k / 3 % 3], around(0.5), around(12.0));
        for body in [&mut a, &mut b] {
            let [roll, pitch, yaw] = around(1.5).array();
            body.state.rigid.attitude = Rotation::from_euler(roll, pitch, yaw);
            let [p, q, r] = around(8.0).array();
            body.state.rigid.rates_rad_s = Vec3::new(p, q, r);
        }
        let before = (a.momentum() + b.momentum(), a.angular_momentum() + b.angular_momentum(), a.energy_j() + b.energy_j());
        let positions = [a.state.rigid.position_m, b.state.rigid.position_m];
        let [of_a, of_b] = touch(&mut a, &mut b);
        // The bodies are moved apart, which is no motion: momentum is compared at the places of the impulses.
        (a.state.rigid.position_m, b.state.rigid.position_m) = (positions[0], positions[1]);
        let after = (a.momentum() + b.momentum(), a.angular_momentum() + b.angular_momentum(), a.energy_j() + b.energy_j());
        let size = before.0.norm() + a.momentum().norm() + b.momentum().norm() + 1.0;
        assert!((after.0 - before.0).norm() < 100.0 * ROUNDING * size, "{:?}", after.0 - before.0);
        assert!((after.1 - before.1).norm() < 100.0 * ROUNDING * size, "{:?}", after.1 - before.1);
        assert!(after.2 <= before.2 * (1.0 + 1e-9), "energy {} J from {} J", after.2, before.2);
        if of_a.touching() {
            hits += 1;
            assert_eq!(
                (of_a.surface, of_b.surface),
                (Some((Surface::Vehicle, ObjectId(2))), Some((Surface::Vehicle, ObjectId(1))))
            );
            assert_eq!((of_a.impact_m_s, of_a.normal_force_n), (of_b.impact_m_s, of_b.normal_force_n));
        }
    }
    assert!(hits > 200, "{hits}");
}

#[test]
fn prop_aircraft_do_not_pass_through_each_other_at_40_m_s() {
    for k in 0..200_u32 {
        let mut a = Body::new(PHANTOM2, Vec3::zero(), Vec3::new(20.0, 0.0, 0.0));
        let half_m = a.vehicle.hull.body_half_extent_m;
        let (side, level) = (f64::from(k % 20) / 10.0 - 1.0, f64::from(k / 20) / 5.0 - 1.0);
        let offset_m = Vec3::new(1.0 + 0.003 * f64::from(k), 0.9 * half_m[1] * side, 0.9 * half_m[2] * level);
        let mut b = Body::new(PHANTOM2, offset_m, Vec3::new(-20.0, 0.0, 0.0));
        let mut touched = false;
        for ms in 0..60 {
            a.fly(ms);
            b.fly(ms);
            let near = may_touch((&a.model, &a.state.rigid), (&b.model, &b.state.rigid), DT.s());
            let report = touch(&mut a, &mut b)[0];
            assert!(near || !report.touching(), "the sphere test excludes a contact");
            touched |= report.touching();
        }
        assert!(touched, "no contact at {offset_m:?}");
    }
}

#[test]
fn exact_accelerometer_measures_the_impact() {
    let mut a = Body::new(ELIOS3, Vec3::zero(), Vec3::new(4.0, 0.0, 0.0));
    let mut b = Body::new(ELIOS3, Vec3::new(a.vehicle.hull.tip_to_tip_m, 0.0, 0.0), Vec3::new(-4.0, 0.0, 0.0));
    let before_m_s = a.state.rigid.velocity_m_s;
    assert!(touch(&mut a, &mut b)[0].touching());
    let change_m_s = (a.state.rigid.velocity_m_s - before_m_s).north();
    assert!(change_m_s < -4.0, "{change_m_s}");
    a.fly(0);
    let felt_m_s = a.state.specific_force_m_s2.forward() * DT.s();
    // The air's drag of one step is the difference.
    assert!((felt_m_s / change_m_s - 1.0).abs() < 1e-2, "{felt_m_s} {change_m_s}");
    a.fly(1);
    assert!(a.state.specific_force_m_s2.forward().abs() * DT.s() < 0.01 * change_m_s.abs(), "it is felt once");
}
