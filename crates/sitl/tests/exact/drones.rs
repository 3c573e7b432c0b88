//! Collisions with a drone that flies along a path of the scenario.

use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::BatteryModel;
use spandrel_model::shipped::{DRILL_HOVER, ELIOS3, PHANTOM2};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_sitl::physics::{Actuators, AirState, AirframeModel, ContactReport, PhysicsState, PowerLoad};

const DT: SimTime = SimTime::from_ms(1);
/// Time at which the other drone is at full speed: 15 m/s after 7.5 s and 56.25 m.
const MEETING_S: f64 = 10.0;
/// Distance that it has flown then, m.
const FLOWN_M: f64 = 56.25 + 15.0 * (MEETING_S - 7.5);

/// A site with a drone that flies north at 15 m/s from the time of the meeting on.
fn site(vehicle: &str) -> Site {
    let drone = format!(
        "{DRILL_HOVER}\n[[drones]]\nname = \"other\"\nvehicle = \"{vehicle}\"\nspeed_m_s = 15.0\npoints_m = [[0, 0, 50], [0, 400, 50]]\n"
    );
    let scenario = spandrel_model::scenario::read("drone.toml", &drone, &|_| Err("none".into()))
        .unwrap_or_else(|problems| panic!("{problems}"));
    Site::without_defects(&scenario)
}

fn vehicle(text: &str) -> Vehicle {
    spandrel_model::vehicle::read("shipped.toml", text).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Returns an aircraft in weightlessness, so that only the collision changes its motion.
fn weightless(vehicle: &Vehicle) -> AirframeModel {
    let mut model = AirframeModel::new(vehicle, BatteryModel::Paper);
    model.gravity_scale = 0.0;
    model
}

/// Flies through the meeting with the other drone, or up to the first contact if `stop`. Returns all contacts.
fn fly(model: &AirframeModel, site: &Site, state: &mut PhysicsState, steps: i64, stop: bool) -> Vec<ContactReport> {
    let start_ms = (1000.0 * MEETING_S) as i64;
    let mut contacts = Vec::new();
    for k in 0..steps {
        let now = SimTime::from_ms(start_ms + k);
        model.advance(state, &Actuators::default(), &AirState::STILL, site, PowerLoad::default(), now, DT);
        if state.contact.touching() {
            contacts.push(state.contact);
            if stop {
                break;
            }
        }
    }
    contacts
}

/// Returns the state of an aircraft at an offset from the other drone at the time of the meeting.
fn meeting(offset_m: Vec3<Enu>, velocity_m_s: Vec3<Enu>) -> PhysicsState {
    let mut state = PhysicsState::at_rest((Vec3::<Enu>::new(0.0, FLOWN_M, 50.0) + offset_m).ned(), 0.0);
    state.rigid.velocity_m_s = velocity_m_s.ned();
    state
}

#[test]
fn exact_frontal_hit_reverses_the_relative_velocity_by_the_restitution() {
    // Relative tolerance: the air slows the aircraft for a few milliseconds before the contact.
    const TOLERANCE: f64 = 2e-3;
    let (site, caged) = (site("elios3"), vehicle(ELIOS3));
    let model = weightless(&caged);
    for own_m_s in [0.0, -10.0] {
        let distance_m = caged.hull.tip_to_tip_m + 0.05;
        let mut state = meeting(Vec3::new(0.0, distance_m, 0.0), Vec3::new(0.0, own_m_s, 0.0));
        let contacts = fly(&model, &site, &mut state, 12, true);
        assert_eq!(
            contacts.first().map(|contact| contact.surface.map(|found| site.object_name(found.1))),
            Some(Some("drone other".into()))
        );
        // The other drone's motion does not change: it is as heavy as a car in traffic.
        let expected_m_s = 15.0 + caged.hull.restitution * (15.0 - own_m_s);
        let north_m_s = state.rigid.velocity_m_s.north();
        assert!((north_m_s / expected_m_s - 1.0).abs() < TOLERANCE, "{north_m_s} m/s, expected {expected_m_s} m/s");
    }
}

#[test]
fn prop_open_aircraft_do_not_pass_through_each_other_at_top_speed() {
    let (site, open) = (site("phantom2"), vehicle(PHANTOM2));
    let model = weightless(&open);
    let half_m = open.hull.body_half_extent_m;
    for k in 0..400_u32 {
        // A phase of the approach within a step, and a place where the bodies, not just the propellers, meet.
        let (side, level) = (f64::from(k % 20) / 10.0 - 1.0, f64::from(k / 20) / 10.0 - 1.0);
        let offset_m = Vec3::new(0.9 * half_m[1] * side, 1.0 + 0.002 * f64::from(k), 0.9 * half_m[2] * level);
        let mut state = meeting(offset_m, Vec3::new(0.0, -20.0, 0.0));
        let contacts = fly(&model, &site, &mut state, 90, false);
        assert!(!contacts.is_empty(), "no contact at {offset_m:?}");
    }
}

#[test]
fn exact_clearance_and_rays_end_at_the_other_drone() {
    let (site, caged) = (site("elios3"), vehicle(ELIOS3));
    let (at, radius_m) = (SimTime::from_s(MEETING_S), 0.5 * caged.hull.tip_to_tip_m);
    let here = Vec3::new(0.0, FLOWN_M + 5.0, 50.0);
    let near = site.nearest(here, 30.0, at).unwrap();
    assert!((near.distance_m - (5.0 - radius_m)).abs() < 1e-9, "{near:?}");
    let hit = site.ray(here, Vec3::new(0.0, -1.0, 0.0), 30.0, at).unwrap();
    assert!((hit.distance_m - (5.0 - radius_m)).abs() < 1e-9, "{hit:?}");
    assert!((site.free_radius(here, 10.0, at).unwrap() - (5.0 - radius_m)).abs() < 1e-9);
}
