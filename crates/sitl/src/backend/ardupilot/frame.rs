//! ArduPilot's frames: number, position and rotation direction of the motors.

use spandrel_model::math;
use spandrel_model::vehicle::{Rotor, Vehicle};

/// Largest difference between a rotor's azimuth and the frame's, degrees. ArduPilot's mixer assumes the frame's azimuths.
const AZIMUTH_TOLERANCE_DEG: f64 = 10.0;
/// Largest difference between the distances of two rotors from the center of mass, as a fraction.
const ARM_TOLERANCE: f64 = 0.15;

/// A motor of a frame: azimuth clockwise from the nose, degrees, and rotation direction (+1 for counterclockwise).
type Motor = (f64, f64);

/// A frame that ArduPilot's copter firmware supports.
#[derive(Debug, PartialEq)]
struct KnownFrame {
    name: &'static str,
    class: u8,
    kind: u8,
    /// Motors in ArduPilot's order.
    motors: &'static [Motor],
}

const CCW: f64 = 1.0;
const CW: f64 = -1.0;

/// The frames with one rotor per arm and the classes and types of FRAME_CLASS and FRAME_TYPE.
const KNOWN_FRAMES: [KnownFrame; 7] = [
    KnownFrame { name: "quad X", class: 1, kind: 1, motors: &[(45.0, CCW), (-135.0, CCW), (-45.0, CW), (135.0, CW)] },
    KnownFrame { name: "quad +", class: 1, kind: 0, motors: &[(90.0, CCW), (-90.0, CCW), (0.0, CW), (180.0, CW)] },
    KnownFrame { name: "quad X reversed", class: 1, kind: 18, motors: &[(135.0, CCW), (45.0, CW), (-135.0, CW), (-45.0, CCW)] },
    KnownFrame {
        name: "hexa X",
        class: 2,
        kind: 1,
        motors: &[(90.0, CW), (-90.0, CCW), (-30.0, CW), (150.0, CCW), (30.0, CCW), (-150.0, CW)],
    },
    KnownFrame {
        name: "hexa +",
        class: 2,
        kind: 0,
        motors: &[(0.0, CW), (180.0, CCW), (-120.0, CW), (60.0, CCW), (-60.0, CCW), (120.0, CW)],
    },
    KnownFrame {
        name: "octa X",
        class: 3,
        kind: 1,
        motors: &[(22.5, CW), (-157.5, CW), (67.5, CCW), (157.5, CCW), (-22.5, CCW), (-112.5, CCW), (-67.5, CW), (112.5, CW)],
    },
    KnownFrame {
        name: "octa +",
        class: 3,
        kind: 0,
        motors: &[(0.0, CW), (180.0, CW), (45.0, CCW), (135.0, CCW), (-45.0, CCW), (-135.0, CCW), (-90.0, CW), (90.0, CW)],
    },
];

/// The frame of an aircraft.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    /// Value of FRAME_CLASS.
    pub class: u8,
    /// Value of FRAME_TYPE.
    pub kind: u8,
    /// For each rotor of the aircraft, the zero-based number of ArduPilot's motor at its place.
    pub motor_of_rotor: Vec<usize>,
}

/// The aircraft's rotors match none of ArduPilot's frames.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "aircraft {aircraft:?}: ArduPilot has no frame for its {rotors} rotors. Allowed: quad X, quad +, quad X with reversed rotors, \
     hexa X, hexa +, octa X, octa +, with arms of equal length. Change rotors.position_m and rotors.spin in the aircraft file"
)]
pub struct FrameError {
    /// Aircraft ID.
    pub aircraft: String,
    /// Number of rotors.
    pub rotors: usize,
}

/// Returns the frame with the aircraft's rotor positions and rotation directions. Errors if there is none.
pub fn frame(vehicle: &Vehicle) -> Result<Frame, FrameError> {
    let no_frame = || FrameError { aircraft: vehicle.id.clone(), rotors: vehicle.rotors.len() };
    if !equal_arms(&vehicle.rotors) {
        return Err(no_frame());
    }
    let found = KNOWN_FRAMES.iter().find_map(|known| {
        let motor_of_rotor = match_motors(&vehicle.rotors, known.motors)?;
        Some(Frame { class: known.class, kind: known.kind, motor_of_rotor })
    });
    found.ok_or_else(no_frame)
}

/// Returns the motor at the place of each rotor if the rotors and the motors correspond one to one.
fn match_motors(rotors: &[Rotor], motors: &[Motor]) -> Option<Vec<usize>> {
    if rotors.len() != motors.len() {
        return None;
    }
    let found = rotors.iter().map(|rotor| motors.iter().position(|motor| fits(rotor, *motor)));
    let indices = found.collect::<Option<Vec<_>>>()?;
    let each_once = (0..motors.len()).all(|motor| indices.contains(&motor));
    each_once.then_some(indices)
}

fn fits(rotor: &Rotor, (azimuth_deg, spin): Motor) -> bool {
    let azimuth_rad = math::atan2(rotor.position_m.right(), rotor.position_m.forward());
    let difference_rad = math::wrap_pi(azimuth_rad - azimuth_deg.to_radians());
    difference_rad.abs() <= AZIMUTH_TOLERANCE_DEG.to_radians() && rotor.spin * spin > 0.0
}

fn equal_arms(rotors: &[Rotor]) -> bool {
    let arms = || rotors.iter().map(|rotor| math::hypot(rotor.position_m.forward(), rotor.position_m.right()));
    let longest = arms().fold(0.0, f64::max);
    arms().all(|arm| arm >= (1.0 - ARM_TOLERANCE) * longest)
}
