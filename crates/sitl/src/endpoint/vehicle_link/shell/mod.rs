//! The console over SERIAL_CONTROL, like PX4's MAVLink shell: it reads a line and returns its output and a prompt.

mod console;
mod topics;

use super::VehicleLink;
use super::commands;
use super::inbound::InboundMessage;
use super::params::ParamValue;
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::link::Links;
use crate::endpoint::vehicle_command::VehicleCommand;
pub use console::NshShell;
use spandrel_mavlink::dialect::{MavCmd, MavMessage, MavResult, SERIAL_CONTROL_DATA, SerialControlDev, SerialControlFlag};

/// Data bytes in SERIAL_CONTROL.
const CHUNK_BYTES: usize = 70;
/// Maximum line length, bytes.
const MAX_LINE_BYTES: usize = 256;
/// Maximum number of messages per tick.
const MESSAGES_PER_TICK: usize = 4;
const PROMPT: &str = "nsh> ";
/// PX4's mode numbers, by their names in the shell.
const MODES: [(&str, f64, f64); 11] = [
    ("manual", 1.0, 0.0),
    ("acro", 5.0, 0.0),
    ("stabilized", 7.0, 0.0),
    ("altctl", 2.0, 0.0),
    ("posctl", 3.0, 0.0),
    ("offboard", 6.0, 0.0),
    ("auto:takeoff", 4.0, 2.0),
    ("auto:loiter", 4.0, 3.0),
    ("auto:mission", 4.0, 4.0),
    ("auto:rtl", 4.0, 5.0),
    ("auto:land", 4.0, 6.0),
];

/// Handles bytes for the shell. A message without the RESPOND flag closes it.
pub(super) fn bytes(v: &mut VehicleLink, m: &SERIAL_CONTROL_DATA, a: &mut InboundMessage) {
    let ours = m.device == SerialControlDev::SERIAL_CONTROL_DEV_SHELL && v.flavor.shell;
    if !ours || m.flags.contains(SerialControlFlag::SERIAL_CONTROL_FLAG_REPLY) {
        return;
    }
    let from = (a.link, a.from);
    if !m.flags.contains(SerialControlFlag::SERIAL_CONTROL_FLAG_RESPOND) {
        if v.shell.client == Some(from) {
            v.shell = NshShell::default();
        }
        return;
    }
    if v.shell.client != Some(from) {
        v.shell = NshShell { client: Some(from), ..NshShell::default() };
        v.shell.print(PROMPT);
    }
    let data = &m.data[..usize::from(m.count).min(CHUNK_BYTES)];
    for character in String::from_utf8_lossy(data).chars() {
        match character {
            '\n' | '\r' if v.shell.line.is_empty() && character == '\r' => {}
            '\n' | '\r' => run_line(v, a),
            '\u{8}' | '\u{7f}' => {
                v.shell.line.pop();
            }
            other if !other.is_control() && v.shell.line.len() < MAX_LINE_BYTES => {
                v.shell.line.push(other);
                v.shell.print(other.encode_utf8(&mut [0; 4]));
            }
            _ => {}
        }
    }
}

/// Executes the line.
fn run_line(v: &mut VehicleLink, a: &mut InboundMessage) {
    let line = std::mem::take(&mut v.shell.line);
    let words: Vec<&str> = line.split_whitespace().collect();
    let output = match words.split_first() {
        None => String::new(),
        Some((&"help" | &"?", _)) => help(),
        Some((&"ver", rest)) => version(v, rest),
        Some((&"param", rest)) => parameters(v, rest, a),
        Some((&"commander", rest)) => commander(v, rest, a),
        Some((&"listener", rest)) => topics::listen(&a.view(v), rest),
        Some((unknown, _)) => format!("nsh: {unknown}: command not found\n"),
    };
    v.shell.print(&format!("\n{output}{PROMPT}"));
}

fn help() -> String {
    let commands = ["commander", "help", "listener", "param", "ver"].map(|name| format!("  {name}\n"));
    format!("Builtin Apps:\n{}", commands.concat())
}

fn version(v: &VehicleLink, rest: &[&str]) -> String {
    let version = v.flavor.software_version.to_be_bytes();
    let number = format!("{}.{}.{}", version[0], version[1], version[2]);
    let lines = [
        ("hw", "HW arch: SPANDREL_SITL\n".to_owned()),
        ("git", format!("FW version: {number} dev ({})\n", v.flavor.software_version)),
        ("os", format!("OS: Spandrel {}\n", env!("CARGO_PKG_VERSION"))),
        ("uid", format!("UID: system {}\n", v.system_id)),
    ];
    match rest {
        ["all"] => lines.map(|(_, line)| line).concat(),
        [part] if lines.iter().any(|(name, _)| name == part) => {
            lines.into_iter().filter(|(name, _)| name == part).map(|(_, line)| line).collect()
        }
        _ => "Usage: ver {all|hw|git|os|uid}\n".into(),
    }
}

fn parameters(v: &mut VehicleLink, rest: &[&str], a: &mut InboundMessage) -> String {
    let shown = |(name, value): (&str, ParamValue)| match value {
        ParamValue::Int(whole) => format!("x   {name} : {whole}\n"),
        ParamValue::Real(real) => format!("x   {name} : {real:.4}\n"),
    };
    match rest {
        ["show"] | ["show", _] => {
            let pattern = rest.get(1).copied().unwrap_or("*");
            let fits = |name: &str| pattern.strip_suffix('*').map_or(name == pattern, |start| name.starts_with(start));
            let found: Vec<String> = v.parameters().filter(|(name, _)| fits(name)).map(shown).collect();
            format!("Symbols: x = used, + = saved, * = unsaved\n{}\n {} parameters\n", found.concat(), found.len())
        }
        ["get", name] => match v.params.find(name) {
            Some((_, name, value)) => shown((name, value)),
            None => format!("ERROR: parameter {name} not found\n"),
        },
        ["set", name, value] => set_parameter(v, name, value, a),
        _ => "Usage: param {show [NAME[*]]|get NAME|set NAME VALUE}\n".into(),
    }
}

fn set_parameter(v: &mut VehicleLink, name: &str, value: &str, a: &mut InboundMessage) -> String {
    let Some((_, _, before)) = v.params.find(name) else { return format!("ERROR: parameter {name} not found\n") };
    let parsed = match before {
        ParamValue::Int(_) => value.parse().ok().map(ParamValue::Int),
        ParamValue::Real(_) => value.parse().ok().map(ParamValue::Real),
    };
    let Some(parsed) = parsed else { return format!("ERROR: {value} is not a valid value for {name}\n") };
    if v.params.set_value(name, parsed).is_err() {
        let (low, high) = v.params.range(name).unwrap_or((0.0, 0.0));
        return format!("ERROR: {name} = {value} rejected: out of range ({low} to {high}) or read-only\n");
    }
    v.parameters_changed(a.autopilot, a.payload, a.links);
    format!("  {name}: curr: {value}\n")
}

fn commander(v: &mut VehicleLink, rest: &[&str], a: &mut InboundMessage) -> String {
    let forced = |rest: &[&str]| if rest.contains(&"-f") { 21_196.0 } else { 0.0 };
    let command = match rest {
        ["arm", more @ ..] => (MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [1.0, forced(more), 0.0]),
        ["disarm", more @ ..] => (MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [0.0, forced(more), 0.0]),
        ["takeoff"] => (MavCmd::MAV_CMD_NAV_TAKEOFF, [0.0; 3]),
        ["land"] => (MavCmd::MAV_CMD_NAV_LAND, [0.0; 3]),
        ["mode", name] => match MODES.iter().find(|(known, ..)| known == name) {
            Some((_, main, sub)) => (MavCmd::MAV_CMD_DO_SET_MODE, [1.0, *main, *sub]),
            None => return format!("ERROR: unknown mode {name}; modes: {}\n", MODES.map(|(name, ..)| name).join(" ")),
        },
        ["check"] => return check(a),
        ["status"] => return status(v, a),
        _ => return "Usage: commander {arm [-f]|disarm [-f]|takeoff|land|mode NAME|check|status}\n".into(),
    };
    let (number, [p0, p1, p2]) = command;
    let nan = f64::NAN;
    let p = [p0, p1, p2, nan, nan, nan, nan];
    let number = number as u16;
    let command =
        VehicleCommand { number, p, frame: 0, component: AUTOPILOT, system: v.system_id, from: a.from, whole: false, own: false };
    match commands::execute(&command, v, a) {
        MavResult::MAV_RESULT_ACCEPTED => String::new(),
        result => format!("Command failed: {result:?}\n"),
    }
}

fn check(a: &InboundMessage) -> String {
    let reasons = &a.autopilot.status().arming_blockers;
    let lines: Vec<String> = reasons.iter().map(|reason| format!("WARN: Preflight Fail: {reason}\n")).collect();
    let verdict = if reasons.is_empty() { "OK" } else { "FAILED" };
    format!("{}Preflight check: {verdict}\n", lines.concat())
}

fn status(v: &VehicleLink, a: &InboundMessage) -> String {
    let s = a.autopilot.status();
    let armed = if s.armed { "Armed" } else { "Disarmed" };
    let failsafe = s.failsafe.as_deref().unwrap_or("none");
    format!("Arm state: {armed}\nNavigation mode: {}\nFailsafe: {failsafe}\n", v.flavor.row_of(s.mode, v.requested_mode).name)
}

impl VehicleLink {
    /// Sends pending shell output, a few messages per tick.
    pub(super) fn send_shell(&mut self, links: &mut Links) {
        let Some((id, (target_system, target_component))) = self.shell.client else { return };
        let Some(link) = links.get_mut(id) else { return };
        for _ in 0..MESSAGES_PER_TICK {
            if self.shell.out.is_empty() || link.is_busy() {
                return;
            }
            let count = self.shell.out.len().min(CHUNK_BYTES);
            let mut data = [0; CHUNK_BYTES];
            data.iter_mut().zip(self.shell.out.drain(..count)).for_each(|(slot, byte)| *slot = byte);
            let message = MavMessage::SERIAL_CONTROL(SERIAL_CONTROL_DATA {
                baudrate: 0,
                timeout: 0,
                device: SerialControlDev::SERIAL_CONTROL_DEV_SHELL,
                flags: SerialControlFlag::SERIAL_CONTROL_FLAG_REPLY,
                count: count as u8,
                data,
                target_system,
                target_component,
            });
            link.send(AUTOPILOT, &message);
        }
    }
}
