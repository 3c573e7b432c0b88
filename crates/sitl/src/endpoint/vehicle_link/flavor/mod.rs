//! Autopilot flavors: one table per autopilot interface, with everything that differs on the wire. All other behavior
//! is shared.

pub mod ardupilot;
mod definition;
pub mod generic;
pub mod px4;

pub use definition::{Flavor, ModeRow, RefusalResults, TakeOffRule};

/// Returns the flavor with this name.
#[must_use]
pub fn named(name: &str) -> Option<&'static Flavor> {
    [&px4::FLAVOR, &ardupilot::FLAVOR, &generic::FLAVOR].into_iter().find(|flavor| flavor.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::FlightMode;

    const ALL: [FlightMode; 13] = [
        FlightMode::Stabilized,
        FlightMode::Altitude,
        FlightMode::Position,
        FlightMode::Hold,
        FlightMode::Takeoff,
        FlightMode::Land,
        FlightMode::Return,
        FlightMode::Mission,
        FlightMode::Offboard,
        FlightMode::Orbit,
        FlightMode::Acro,
        FlightMode::SmartReturn,
        FlightMode::Follow,
    ];

    #[test]
    fn exact_every_flavor_shows_every_mode_and_mode_numbers_are_unique() {
        for flavor in ["px4", "ardupilot", "generic"].map(|name| named(name).unwrap()) {
            for mode in ALL {
                assert!(flavor.default_mode(mode).shows(mode), "{}: {mode:?}", flavor.name);
            }
            for row in flavor.modes {
                assert_eq!(flavor.row(row.number).unwrap().name, row.name);
                assert_eq!(flavor.row_of(row.mode, row.number).name, row.name, "name of the requested mode");
            }
            assert!(flavor.standard(0).is_none() && flavor.standard(99).is_none());
        }
        assert!(named("PX4").is_none());
    }

    #[test]
    fn exact_guided_persists_through_takeoff_and_goto_until_the_pilot_takes_over() {
        let copter = &ardupilot::FLAVOR;
        for mode in [FlightMode::Hold, FlightMode::Takeoff, FlightMode::Offboard] {
            assert_eq!(copter.row_of(mode, 4).number, 4);
        }
        assert_eq!(copter.row_of(FlightMode::Position, 4).number, 5);
        assert_eq!(copter.row_of(FlightMode::Position, 16).number, 16);
        assert_eq!(copter.row_of(FlightMode::Hold, 3).number, 17, "an unrequested hold must be reported as BRAKE");
        assert_eq!(copter.row_of(FlightMode::Hold, 5).number, 5, "LOITER must hold without stick input");
        assert_eq!((copter.default_mode(FlightMode::Mission).number, copter.row_of(FlightMode::Mission, 27).number), (3, 27));
    }
}
