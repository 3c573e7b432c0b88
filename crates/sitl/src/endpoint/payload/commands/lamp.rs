//! Lamp commands: the illuminator service and its aliases relay 0, actuator 1 and servo output 9.

use super::super::equipment::Payload;
use super::super::input::PayloadInput;
use super::handler::{ACCEPTED, DENIED, PayloadCommand, accepted_if};
use crate::endpoint::vehicle_command::VehicleCommand;
use spandrel_mavlink::dialect::{MavCmd, MavResult};

/// Servo output for the lamp: the first one after the eight motor outputs, which is ArduPilot's first auxiliary output.
const LAMP_SERVO: f64 = 9.0;
/// Pulse width above which the lamp is on, and the range of valid pulse widths, microseconds.
const ON_THRESHOLD_US: f64 = 1_500.0;
const VALID_PULSES_US: std::ops::RangeInclusive<f64> = 800.0..=2_200.0;

pub(super) const ROWS: &[PayloadCommand] = &[
    (MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, |c, i, p| switch(c.p[0], i, p)),
    (MavCmd::MAV_CMD_DO_ILLUMINATOR_CONFIGURE, |c, _, _| configure(c)),
    (MavCmd::MAV_CMD_DO_SET_RELAY, |c, i, p| if c.p[0] == 0.0 { switch(c.p[1], i, p) } else { DENIED }),
    (MavCmd::MAV_CMD_DO_REPEAT_RELAY, |c, i, p| {
        accepted_if(c.p[0] == 0.0 && i.vehicle.lamp.luminous_flux_lm > 0.0 && p.lamp.repeat(c.p[1], c.p[2], i.clock.now))
    }),
    (MavCmd::MAV_CMD_DO_SET_ACTUATOR, actuator),
    (MavCmd::MAV_CMD_DO_SET_SERVO, |c, i, p| {
        let is_valid = c.p[0] == LAMP_SERVO && VALID_PULSES_US.contains(&c.p[1]);
        if is_valid { switch(f64::from(u8::from(c.p[1] > ON_THRESHOLD_US)), i, p) } else { DENIED }
    }),
];

fn switch(value: f64, input: &PayloadInput, payload: &mut Payload) -> MavResult {
    if !(value == 0.0 || value == 1.0) || input.vehicle.lamp.luminous_flux_lm <= 0.0 {
        return DENIED;
    }
    payload.lamp.switch(value > 0.5);
    ACCEPTED
}

/// Parameters 1 to 6 are actuator values, and 7 is the actuator set. Actuator 1 of set 0 is the lamp, which is on for
/// values above 0; the vehicle has no other actuators.
fn actuator(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> MavResult {
    let others = (1..6).any(|k| c.finite_param(k).is_some_and(|value| value != 0.0));
    match (c.finite_param(6).unwrap_or(0.0), c.finite_param(0)) {
        (0.0, Some(value)) if (-1.0..=1.0).contains(&value) => switch(f64::from(u8::from(value > 0.0)), input, payload),
        (0.0, None) => accepted_if(!others),
        _ => DENIED,
    }
}

/// Parameters: 1 mode (0 and 1 change nothing), 2 brightness in percent, 3 strobe period, 4 duty cycle. Dimming and
/// strobing are denied: the lamp is either on or off, because image exposure assumes full brightness.
fn configure(c: &VehicleCommand) -> MavResult {
    let mode = matches!(c.finite_param(0), None | Some(0.0 | 1.0));
    let strobes = c.finite_param(2).is_some_and(|period| period != 0.0) || !matches!(c.finite_param(3), None | Some(0.0 | 100.0));
    accepted_if(mode && !strobes && matches!(c.finite_param(1), None | Some(100.0)))
}
