//! Two vehicles that share a site and a clock.

use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::contract::other_drones;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::{self, Scenario};
use spandrel_model::shipped::{DRILL_HOVER, ELIOS3, M30, PHANTOM2, SCENARIOS};
use spandrel_model::site::Site;
use spandrel_model::site::aircraft_hull::{hull_radius_m, probes};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle;
use spandrel_sitl::sim::SimEvent;
use spandrel_sitl::sim::shared_site::{START_GAP_M, exchange, start_places};
use spandrel_sitl::testing::Vehicle;

fn read(name: &str, text: &str) -> Scenario {
    scenario::read(name, text, &|_| Err("none".into())).unwrap_or_else(|problems| panic!("{problems}"))
}

fn places(count: usize) -> Vec<Vec3<Enu>> {
    let job = read("drill-hover.toml", DRILL_HOVER);
    let aircraft = vehicle::read("phantom2.toml", PHANTOM2).unwrap();
    start_places(&job, &Site::without_defects(&job), &aircraft, count).unwrap()
}

fn pair() -> [Vehicle; 2] {
    let starts = places(2);
    [0, 1].map(|instance: u8| {
        let mut vehicle = Vehicle::builder().instance(instance).seed(5).build().unwrap();
        vehicle.sim.share_site(starts[usize::from(instance)]);
        vehicle
    })
}

/// Runs both vehicles to a time, tick by tick.
fn run_together(pair: &mut [Vehicle; 2], until: SimTime) {
    let [a, b] = pair;
    while a.now() < until {
        a.run(SimTime::from_ms(1));
        b.run(SimTime::from_ms(1));
        exchange(&mut [&mut a.sim, &mut b.sim]);
    }
}

/// Returns both vehicles in a hover above their places, at the same time.
fn hovering() -> [Vehicle; 2] {
    let mut pair = pair();
    for vehicle in &mut pair {
        vehicle.arm(SimTime::from_s(20.0)).unwrap();
        vehicle.take_off(6.0).unwrap();
        vehicle.run(SimTime::from_s(35.0) - vehicle.now());
        assert!(vehicle.height_m() > 5.0, "{}", vehicle.height_m());
    }
    pair
}

fn named<T>(vehicle: &Vehicle, pick: impl Fn(NamedValue) -> Option<T>) -> Vec<T> {
    vehicle.received.iter().filter_map(|frame| NamedValue::of(frame.message.as_ref()?).and_then(&pick)).collect()
}

fn events(vehicle: &mut Vehicle) -> Vec<SimEvent> {
    std::iter::from_fn(|| vehicle.sim.poll_event()).collect()
}

/// Flies the first vehicle into the second one. Its position estimate is off by up to a meter, so the target is corrected by the true
/// distance until they meet.
fn collision() -> [Vehicle; 2] {
    let mut pair = hovering();
    let mut target_m = pair[1].position_m();
    for _ in 0..15 {
        pair[0].go_to(target_m).unwrap();
        let behind = pair[0].now() - pair[1].now();
        pair[1].run(behind);
        let until = pair[0].now() + SimTime::from_s(2.0);
        run_together(&mut pair, until);
        if pair[0].sim.ended().is_some() {
            break;
        }
        target_m += pair[1].position_m() - pair[0].position_m();
    }
    pair
}

#[test]
fn wire_vehicles_at_one_site_see_and_hit_each_other() {
    let mut pair = collision();
    for (vehicle, other) in pair.iter_mut().zip(["drone 2", "drone 1"]) {
        let crashes: Vec<String> = events(vehicle)
            .into_iter()
            .filter_map(|event| if let SimEvent::Crash { what, .. } = event { Some(what) } else { None })
            .collect();
        assert_eq!(crashes.first().map(String::as_str), Some(other), "{crashes:?}");
        assert_eq!(vehicle.sim.ended(), Some(format!("hit {other}").as_str()));
        let contacts = named(vehicle, |value| if let NamedValue::Contact(contact) = value { Some(contact) } else { None });
        assert!(contacts.contains(&ContactKind::Vehicle));
        let clearances_m =
            named(vehicle, |value| if let NamedValue::ClearanceM(clearance_m) = value { Some(clearance_m) } else { None });
        assert!(clearances_m.iter().any(|m| *m < 0.5), "the clearance sees the other vehicle");
        let (id, system) = if other == "drone 2" { (2, "2 beside 1") } else { (1, "1 beside 2") };
        let seen = vehicle.last_message(other_drones::of).unwrap();
        assert!(seen.len() == 1 && seen[0].system_id == id && seen[0].offset_m.norm() < 12.0, "{system}: {seen:?}");
    }
}

#[test]
fn prop_flights_of_two_vehicles_are_bit_identical() {
    let digests = || collision().map(|vehicle| vehicle.sim.digest());
    let first = digests();
    assert_eq!(first, digests());
    assert_ne!(first[0], first[1]);
}

#[test]
fn exact_one_vehicle_flies_as_it_does_alone() {
    let fly = |shared: bool| {
        let mut vehicle = Vehicle::builder().seed(5).build().unwrap();
        if shared {
            vehicle.sim.share_site(places(1)[0]);
        }
        vehicle.arm(SimTime::from_s(20.0)).unwrap();
        vehicle.take_off(4.0).unwrap();
        while vehicle.now() < SimTime::from_s(25.0) {
            vehicle.run(SimTime::from_ms(1));
            if shared {
                exchange(&mut [&mut vehicle.sim]);
            }
        }
        vehicle.sim.digest()
    };
    assert_eq!(fly(true), fly(false));
}

#[test]
fn prop_each_vehicle_has_its_own_sensor_errors() {
    let mut pair = pair();
    run_together(&mut pair, SimTime::from_s(8.0));
    let readings = pair.each_ref().map(|vehicle| {
        vehicle.last_message(
            |message| if let MavMessage::ATTITUDE(angle) = message { Some((angle.roll, angle.rollspeed)) } else { None },
        )
    });
    assert!(readings[0].is_some() && readings[0] != readings[1], "{readings:?}");
}

#[test]
fn exact_aircraft_start_a_gap_apart_on_level_ground() {
    for (name, text) in SCENARIOS {
        let job = read(name, text);
        let site = Site::without_defects(&job);
        for aircraft in [PHANTOM2, M30, ELIOS3] {
            let aircraft = vehicle::read("shipped.toml", aircraft).unwrap();
            let Some(places) = start_places(&job, &site, &aircraft, 8) else {
                panic!("{name}: no room for eight {}", aircraft.id)
            };
            assert_eq!(places[0], job.ground_team.pad_m);
            let width_m = 2.0 * hull_radius_m(&probes(&aircraft));
            for (k, place) in places.iter().enumerate() {
                assert!((place.up() - job.ground_team.pad_m.up()).abs() <= 0.3, "{name}: {place:?}");
                let away_m = (*place - job.ground_team.pad_m).horizontal_norm();
                assert!(away_m <= job.ground_team.home_radius_m, "{name}: {away_m} m from the pad");
                for other in &places[..k] {
                    assert!((*place - *other).horizontal_norm() >= width_m + START_GAP_M - 1e-9, "{name}: {place:?} {other:?}");
                }
            }
        }
    }
    let job = read("drill-hover.toml", DRILL_HOVER);
    let aircraft = vehicle::read("phantom2.toml", PHANTOM2).unwrap();
    assert_eq!(start_places(&job, &Site::without_defects(&job), &aircraft, 1_000), None);
}
