//! Frames and the order of the motors.

use super::super::frame::frame;
use super::aircraft;
use spandrel_model::frames::Vec3;
use spandrel_model::math;
use spandrel_model::vehicle::{Rotor, Vehicle};

/// Returns an aircraft with rotors at these azimuths, degrees, and rotation directions.
fn with_rotors(rotors: &[(f64, f64)]) -> Vehicle {
    let rotor = |(azimuth_deg, spin): &(f64, f64)| {
        let (sin, cos) = math::sin_cos(azimuth_deg.to_radians());
        Rotor { position_m: Vec3::new(0.3 * cos, 0.3 * sin, 0.0), spin: *spin }
    };
    Vehicle { rotors: rotors.iter().map(rotor).collect(), ..aircraft("phantom2") }
}

#[test]
fn exact_shipped_aircraft_are_quad_x_in_ardupilots_order() {
    for id in ["phantom2", "f450", "m30", "elios3"] {
        let frame = frame(&aircraft(id)).expect(id);
        assert_eq!((frame.class, frame.kind, frame.motor_of_rotor), (1, 1, vec![0, 1, 2, 3]), "{id}");
    }
}

#[test]
fn exact_rotors_in_another_order_are_mapped() {
    let clockwise = with_rotors(&[(45.0, 1.0), (135.0, -1.0), (-135.0, 1.0), (-45.0, -1.0)]);
    assert_eq!(frame(&clockwise).expect("quad X").motor_of_rotor, [0, 3, 1, 2]);
}

#[test]
fn exact_other_layouts_get_their_frame() {
    let plus = with_rotors(&[(0.0, -1.0), (90.0, 1.0), (180.0, -1.0), (-90.0, 1.0)]);
    let reversed = with_rotors(&[(45.0, -1.0), (-135.0, -1.0), (-45.0, 1.0), (135.0, 1.0)]);
    let hexa = with_rotors(&[(30.0, 1.0), (90.0, -1.0), (150.0, 1.0), (-150.0, -1.0), (-90.0, 1.0), (-30.0, -1.0)]);
    let octa: Vec<_> = (0..8).map(|k| (22.5 + 45.0 * f64::from(k), if k % 2 == 0 { -1.0 } else { 1.0 })).collect();
    for (vehicle, class, kind) in [(plus, 1, 0), (reversed, 1, 18), (hexa, 2, 1), (with_rotors(&octa), 3, 1)] {
        let frame = frame(&vehicle).expect("frame");
        assert_eq!((frame.class, frame.kind), (class, kind));
    }
}

#[test]
fn exact_layouts_without_a_frame_are_refused_with_the_allowed_ones() {
    let wrong_spin = with_rotors(&[(45.0, 1.0), (-135.0, 1.0), (-45.0, 1.0), (135.0, -1.0)]);
    let mut uneven = aircraft("phantom2");
    uneven.rotors[0].position_m = uneven.rotors[0].position_m * 1.5;
    for bad in [wrong_spin, uneven, with_rotors(&[(0.0, 1.0), (120.0, 1.0), (-120.0, -1.0)])] {
        let error = frame(&bad).expect_err("no frame").to_string();
        assert!(error.contains("phantom2") && error.contains("quad X") && error.contains("rotors.position_m"), "{error}");
    }
}
