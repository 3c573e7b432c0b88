//! Stick input: MANUAL_CONTROL with its buttons, and transmitter channels.

use super::buttons::{self, ButtonContext};
use super::ground_station::is_accepted_station;
use super::inbound::InboundMessage;
use super::{VehicleLink, aux_functions, commands, mode_requests};
use crate::autopilot::Sticks;
use crate::endpoint::payload::commands as payload;
use crate::endpoint::payload::gimbal::GimbalState;
use spandrel_mavlink::dialect::{MANUAL_CONTROL_DATA, MavResult, MavSeverity, RC_CHANNELS_OVERRIDE_DATA};

/// Applies stick input. In the mode that accepts go-to commands, the yaw stick does not trigger a takeover.
fn apply_sticks(v: &VehicleLink, sticks: Sticks, a: &mut InboundMessage) {
    let is_guided = v.is_guided(a.autopilot);
    a.autopilot.set_sticks_in_guided(is_guided);
    a.autopilot.sticks(sticks, a.now());
}

pub(super) fn manual_control(v: &mut VehicleLink, m: &MANUAL_CONTROL_DATA, a: &mut InboundMessage) {
    if !v.accepts_sticks || !is_accepted_station(v, a) {
        return;
    }
    let from = (a.link, a.from);
    if let Some(sticks) = v.manual.manual_control(from, m, a.now()) {
        apply_sticks(v, sticks, a);
    }
    if let Some(pitch) = v.manual.gimbal(from, m)
        && a.payload.gimbal.accepts_control_from(a.from)
    {
        let camera = &a.aircraft.vehicle.camera;
        a.payload.gimbal.set(GimbalState::stick_to_angle(camera, pitch), camera);
    }
    if v.manual.is_controlling_sender(from) {
        press_buttons(v, m, a);
    }
    broadcast_stick_changes(v);
}

pub(super) fn channels(v: &mut VehicleLink, c: &RC_CHANNELS_OVERRIDE_DATA, a: &mut InboundMessage) {
    // A receiver signals a lost transmitter with an unusually short throttle pulse; its channels are then ignored.
    let lost = v.params.throttle_loss_pulse_us().is_some_and(|least| c.chan3_raw > 0 && c.chan3_raw < least);
    if !v.accepts_sticks || !is_accepted_station(v, a) || lost {
        return;
    }
    let from = (a.link, a.from);
    let was_holder = v.manual.is_controlling_sender(from);
    if let Some(sticks) = v.manual.channels(from, c, a.now()) {
        apply_sticks(v, sticks, a);
    } else if was_holder && !v.manual.is_controlling_sender((a.link, a.from)) {
        a.autopilot.release_sticks();
    }
    v.manual.apply_aux_channels(from, c, a.now());
    mode_requests::apply_mode_switch(v, c, a);
    aux_functions::read_switches(v, c, a);
    broadcast_stick_changes(v);
}

fn press_buttons(v: &mut VehicleLink, m: &MANUAL_CONTROL_DATA, a: &mut InboundMessage) {
    for button in v.manual.button_state.of(m) {
        let camera = &a.aircraft.vehicle.camera;
        let context = ButtonContext {
            lamp_on: a.payload.lamp.on,
            pitch_deg: a.payload.gimbal.pitch_rad.to_degrees(),
            pitch_range_deg: (camera.gimbal_pitch_min_rad.to_degrees(), camera.gimbal_pitch_max_rad.to_degrees()),
            take_off_m: a.autopilot.tuning.takeoff_height_m,
        };
        let Some(command) = buttons::command(button, &v.params, &context, a.from) else { continue };
        let result = commands::execute(&command, v, a);
        if result != MavResult::MAV_RESULT_ACCEPTED && payload::handles(&command) {
            let why = payload::refusal_text(&command, a.input, a.payload);
            v.push_text(MavSeverity::MAV_SEVERITY_CRITICAL, &format!("Button: {why}"));
        }
    }
}

/// Broadcasts every change of the stick control source.
fn broadcast_stick_changes(v: &mut VehicleLink) {
    while let Some(text) = v.manual.poll_text() {
        v.push_text(MavSeverity::MAV_SEVERITY_NOTICE, &text);
    }
}
