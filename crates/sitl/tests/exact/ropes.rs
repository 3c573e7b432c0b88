//! Collisions with a rope of the scenario.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::BatteryModel;
use spandrel_model::shipped::{DRILL_HOVER, PHANTOM2};
use spandrel_model::site::{Site, Surface};
use spandrel_model::time::SimTime;
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, PhysicsState, PowerLoad};

const DT: SimTime = SimTime::from_ms(1);

/// A thin rope across the way of an aircraft stops it, also at high speed: a step is longer than the rope is thick.
#[test]
fn exact_no_aircraft_passes_through_a_thin_rope() {
    let text = format!(
        "{DRILL_HOVER}\n[[ropes]]\nname = \"line\"\npoints_m = [[-20, 30, 50], [20, 30, 50]]\nlength_m = 40.05\ndiameter_mm = 4\nmass_kg_m = 50\n"
    );
    let scenario = spandrel_model::scenario::read("rope.toml", &text, &|_| Err("none".into())).unwrap();
    let site = Site::without_defects(&scenario);
    let vehicle = spandrel_model::vehicle::read("phantom2.toml", PHANTOM2).unwrap();
    let mut model = AirframeModel::new(&vehicle, BatteryModel::Paper);
    model.gravity_scale = 0.0;
    let sag_up_m = site.ropes().points_m(SimTime::ZERO).next().map(|(_, points)| points[points.len() / 2].up()).unwrap();
    for speed_m_s in [2.0, 15.0, 30.0] {
        let mut state = PhysicsState::at_rest(Vec3::<Enu>::new(0.0, 28.0, sag_up_m).ned(), 0.0);
        state.rigid.velocity_m_s = Vec3::<Enu>::new(0.0, speed_m_s, 0.0).ned();
        let mut hit = None;
        for k in 0..(1000.0 * 4.0 / speed_m_s) as i64 {
            let now = SimTime::from_ms(k);
            model.advance(&mut state, &Actuators::default(), &AirState::STILL, &site, PowerLoad::default(), now, DT);
            hit = hit.or(state.contact.surface);
        }
        let (surface, object) = hit.unwrap_or_else(|| panic!("at {speed_m_s} m/s it passes through"));
        assert_eq!((surface, site.object_name(object).as_str()), (Surface::Other, "rope line"));
    }
}
