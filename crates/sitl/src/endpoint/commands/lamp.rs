//! The lamp: the illuminator service, and its aliases relay 0, actuator 1 and servo output 9.

use super::super::Payload;
use super::super::snapshot::VehicleSnapshot;
use super::VehicleCommand;
use super::payload::{ACCEPTED, DENIED, PayloadCommand, verdict};
use spandrel_mavlink::dialect::{MavCmd, MavResult};

/// The servo output that the lamp hangs on: the first after eight motors, ArduPilot's first auxiliary one.
const SERVO: f64 = 9.0;
/// Pulses longer than the middle are on, microseconds, and those that a servo output knows.
const MIDDLE_US: f64 = 1_500.0;
const PULSES_US: std::ops::RangeInclusive<f64> = 800.0..=2_200.0;

pub(super) const ROWS: &[PayloadCommand] = &[
    (MavCmd::MAV_CMD_ILLUMINATOR_ON_OFF, |c, v, p| switch(c.p[0], v, p)),
    (MavCmd::MAV_CMD_DO_ILLUMINATOR_CONFIGURE, |c, _, _| configure(c)),
    (MavCmd::MAV_CMD_DO_SET_RELAY, |c, v, p| if c.p[0] == 0.0 { switch(c.p[1], v, p) } else { DENIED }),
    (MavCmd::MAV_CMD_DO_REPEAT_RELAY, |c, v, p| {
        verdict(c.p[0] == 0.0 && v.vehicle.lamp.flux_lm > 0.0 && p.lamp.repeat(c.p[1], c.p[2], v.now))
    }),
    (MavCmd::MAV_CMD_DO_SET_ACTUATOR, actuator),
    (MavCmd::MAV_CMD_DO_SET_SERVO, |c, v, p| {
        let legal = c.p[0] == SERVO && PULSES_US.contains(&c.p[1]);
        if legal { switch(f64::from(u8::from(c.p[1] > MIDDLE_US)), v, p) } else { DENIED }
    }),
];

fn switch(value: f64, view: &VehicleSnapshot, payload: &mut Payload) -> MavResult {
    if !(value == 0.0 || value == 1.0) || view.vehicle.lamp.flux_lm <= 0.0 {
        return DENIED;
    }
    payload.lamp.switch(value > 0.5);
    ACCEPTED
}

/// Six values and the number of their set; actuator 1 of set 0 is the lamp, on above its middle, and there is no other.
fn actuator(c: &VehicleCommand, view: &VehicleSnapshot, payload: &mut Payload) -> MavResult {
    let others = (1..6).any(|k| c.finite_param(k).is_some_and(|value| value != 0.0));
    match (c.finite_param(6).unwrap_or(0.0), c.finite_param(0)) {
        (0.0, Some(value)) if (-1.0..=1.0).contains(&value) => switch(f64::from(u8::from(value > 0.0)), view, payload),
        (0.0, None) => verdict(!others),
        _ => DENIED,
    }
}

/// Mode in parameter 1 (0 and 1 leave it as it is), brightness in per cent in parameter 2, strobe period and duty: this lamp is on or off, it
/// neither dims nor strobes, and the light of a picture is judged by that.
fn configure(c: &VehicleCommand) -> MavResult {
    let mode = matches!(c.finite_param(0), None | Some(0.0 | 1.0));
    let strobes = c.finite_param(2).is_some_and(|period| period != 0.0) || !matches!(c.finite_param(3), None | Some(0.0 | 100.0));
    verdict(mode && !strobes && matches!(c.finite_param(1), None | Some(100.0)))
}
