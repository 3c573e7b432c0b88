//! A collision with a drone that flies along a path of the scenario, as clients receive it.

use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_model::shipped::DRILL_HOVER;
use spandrel_model::time::SimTime;
use spandrel_sitl::sim::SimEvent;
use spandrel_sitl::testing::Vehicle;

/// The hover drill with a drone that passes through the place 6 m above the pad, 40 s after the start.
const CROSSING: &str = "[[drones]]\nname = \"survey\"\nat_s = 35.0\npoints_m = [[-20, 0, 6], [40, 0, 6]]\nspeed_m_s = 5.0\n";

fn hovering(seed: u64) -> Vehicle {
    let mut vehicle = Vehicle::builder().scenario(format!("{DRILL_HOVER}\n{CROSSING}")).seed(seed).build().unwrap();
    vehicle.arm(SimTime::from_s(20.0)).unwrap();
    vehicle.take_off(6.0).unwrap();
    vehicle.run_until(|v| v.height_m() > 5.5, SimTime::from_s(15.0)).unwrap();
    vehicle
}

/// Returns all values that `pick` selects, in the order of their arrival.
fn named<T>(vehicle: &Vehicle, pick: impl Fn(NamedValue) -> Option<T>) -> Vec<T> {
    vehicle.received.iter().filter_map(|frame| NamedValue::of(frame.message.as_ref()?).and_then(&pick)).collect()
}

#[test]
fn wire_other_drone_comes_near_and_hits() {
    let mut vehicle = hovering(3);
    vehicle.run(SimTime::from_s(45.0) - vehicle.now());
    let clearances_m =
        named(&vehicle, |value| if let NamedValue::ClearanceM(clearance_m) = value { Some(clearance_m) } else { None });
    let least_m = clearances_m.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(clearances_m.iter().any(|m| *m > 5.0) && least_m < 0.4, "{least_m}");
    let contacts = named(&vehicle, |value| if let NamedValue::Contact(contact) = value { Some(contact) } else { None });
    assert!(contacts.contains(&ContactKind::Vehicle), "the contact is on the wire");
    let hits = named(&vehicle, |value| if let NamedValue::Hits(hits) = value { Some(hits) } else { None });
    assert!(hits.first() == Some(&0) && hits.last().is_some_and(|hits| *hits >= 1), "{hits:?}");
    let events: Vec<SimEvent> = std::iter::from_fn(|| vehicle.sim.poll_event()).collect();
    let crash = events.iter().find_map(|event| match event {
        SimEvent::Crash { what, impact_m_s } => Some((what.as_str(), *impact_m_s)),
        _ => None,
    });
    assert!(crash.is_some_and(|(what, impact_m_s)| what == "drone survey" && (3.0..9.0).contains(&impact_m_s)), "{crash:?}");
    assert_eq!(vehicle.sim.ended(), Some("hit drone survey"));
}

#[test]
fn prop_flights_with_another_drone_are_bit_identical() {
    let digest = |seed| {
        let mut vehicle = hovering(seed);
        vehicle.run(SimTime::from_s(42.0) - vehicle.now());
        vehicle.sim.digest()
    };
    assert_eq!(digest(3), digest(3));
    assert_ne!(digest(3), digest(4));
}
