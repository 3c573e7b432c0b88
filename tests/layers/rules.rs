//! What Cargo cannot hold: the table of rooms within crates, and the capital rules of ARCHITECTURE.md.

use crate::paths::{code_only, named};

/// Each crate with the rooms that are modules of its own; every other module belongs to the room named last.
const CRATES: &[(&str, &[&str], &str)] = &[
    ("model", &["scenario", "vehicle", "site"], "base"),
    ("mavlink", &["telemetry"], "mav"),
    ("sitl", &[], "sitl"),
    ("monitor", &[], "monitor"),
    ("training", &["report", "web"], "training"),
    ("clients", &["pilot"], "rc"),
    ("view", &[], "view"),
    (PROGRAM, &[], "app"),
];
/// The package at the workspace's root.
const PROGRAM: &str = "";
/// Each room with the rooms that it may know.
const TABLE: &[(&str, &[&str])] = &[
    ("base", &[]),
    ("mav", &["base"]),
    ("scenario", &["base"]),
    ("vehicle", &["base"]),
    ("site", &["base", "scenario", "vehicle"]),
    ("telemetry", &["base", "mav", "scenario", "vehicle"]),
    ("sitl", &["base", "mav", "scenario", "vehicle", "site"]),
    ("monitor", &["base", "mav", "scenario", "vehicle", "site", "telemetry"]),
    ("pilot", &["base", "mav", "scenario", "vehicle", "site", "telemetry"]),
    ("training", &["base", "mav", "scenario", "vehicle", "site", "telemetry", "monitor"]),
    ("rc", &["base", "mav"]),
    ("report", &["base", "mav", "scenario", "vehicle", "site", "telemetry", "monitor", "training"]),
    ("web", &["base", "mav", "scenario", "vehicle", "site", "telemetry", "monitor", "training", "report"]),
    ("view", &["base", "mav", "scenario", "vehicle", "site", "telemetry"]),
    (
        "app",
        &[
            "base",
            "mav",
            "scenario",
            "vehicle",
            "site",
            "telemetry",
            "sitl",
            "monitor",
            "pilot",
            "rc",
            "training",
            "report",
            "view",
            "web",
        ],
    ),
];

/// What only the shells may touch: sockets, files, clocks, threads, processes, terminals.
const OUTSIDE: &[&[&str]] = &[
    &["std", "net"],
    &["std", "fs"],
    &["std", "thread"],
    &["std", "process"],
    &["std", "env"],
    &["std", "io", "stdin"],
    &["std", "io", "stdout"],
    &["std", "io", "stderr"],
    &["std", "time"],
    &["tokio"],
    &["sqlx"],
    &["axum"],
    &["axum_server"],
    &["getrandom"],
    &["indicatif"],
    &["tracing_subscriber"],
    &["clap"],
    &["jiff", "Timestamp", "now"],
    &["jiff", "ZonedDateTime", "now"],
];
/// What of these rooms of `std` is plain data: no clock, no socket.
const PLAIN_DATA: &[&[&str]] = &[&["std", "time", "Duration"], &["std", "net", "IpAddr"], &["std", "net", "SocketAddr"]];
/// What the autopilot may name of physics: what it drives, not what is true.
const ACTUATION: &[&str] = &["Actuators", "MAX_ROTORS"];
/// Modules of the simulator that a real autopilot replaces; the equipment's half of the interface must work without them.
const AUTOPILOT_SIDE: &[&[&str]] = &[
    &["autopilot"],
    &["backend"],
    &["endpoint", "vehicle_link"],
    &["endpoint", "flavour"],
    &["endpoint", "params"],
    &["endpoint", "snapshot"],
];
const ROOTS: &[&str] = &[
    "crate",
    "spandrel_model",
    "spandrel_mavlink",
    "spandrel_sitl",
    "spandrel_monitor",
    "spandrel_training",
    "spandrel_clients",
    "spandrel_view",
    "std",
    "core",
    "tokio",
    "sqlx",
    "axum",
    "axum_server",
    "getrandom",
    "indicatif",
    "tracing_subscriber",
    "clap",
    "jiff",
];

/// All crates but the program, by folder.
pub fn crates() -> impl Iterator<Item = &'static str> {
    CRATES.iter().map(|(folder, ..)| *folder).filter(|folder| *folder != PROGRAM)
}

/// All rooms.
pub fn rooms() -> impl Iterator<Item = &'static str> {
    TABLE.iter().map(|(room, _)| *room)
}

/// The crates that a crate may depend on: those whose rooms its rooms may know.
pub fn may_depend_on(folder: &str) -> Vec<&'static str> {
    let known = TABLE.iter().filter(|(room, _)| home(room) == folder).flat_map(|(_, known)| *known);
    crates().filter(|other| *other != folder && known.clone().any(|room| home(room) == *other)).collect()
}

/// The crate that a room lies in.
fn home(room: &str) -> &'static str {
    CRATES.iter().find(|(_, own, rest)| own.contains(&room) || *rest == room).map_or(PROGRAM, |(folder, ..)| *folder)
}

/// The room of a crate's module.
fn room_of(folder: &str, module: Option<&str>) -> Option<&'static str> {
    let (_, own, rest) = CRATES.iter().find(|(name, ..)| *name == folder)?;
    Some(own.iter().find(|room| Some(**room) == module).unwrap_or(rest))
}

/// Everything that a file (its path below the workspace's root) names and must not.
pub fn violations(file: &str, source: &str) -> Vec<String> {
    let Some((folder, module)) = place_of(file) else { return vec![format!("{file}: no crate of tests/layers/rules.rs")] };
    let room = room_of(folder, module.first().map(String::as_str)).unwrap_or("app");
    let code = code_only(source);
    let mut found: Vec<String> = named(&code, &module, ROOTS)
        .into_iter()
        .filter_map(|(line, path)| {
            let path: Vec<&str> = path.iter().map(String::as_str).collect();
            let why = forbidden(folder, room, &module, &path)?;
            Some(format!("{file}:{line}: {}: {why}", path.join("::")))
        })
        .collect();
    found.extend(clock_readings(room, file, &code));
    found.dedup();
    found
}

/// `Instant::now()` and its like, also through an imported name.
fn clock_readings(room: &str, file: &str, code: &str) -> Vec<String> {
    let reads = |line: &str| room != "app" && line.contains("::now()");
    let lines = code.lines().enumerate().filter(|(_, line)| reads(line));
    lines.map(|(k, line)| format!("{file}:{}: {}: ONLY THE PROGRAM TOUCHES THE OUTSIDE WORLD", k + 1, line.trim())).collect()
}

/// `crates/sitl/src/autopilot/core.rs` is the module `autopilot::core` of the crate `sitl`.
fn place_of(file: &str) -> Option<(&'static str, Vec<String>)> {
    let parts: Vec<&str> = file.trim_end_matches(".rs").split(['/', '\\']).collect();
    let (folder, module) = match &parts[..] {
        ["crates", folder, "src", module @ ..] => (*folder, module),
        ["src", module @ ..] => (PROGRAM, module),
        _ => return None,
    };
    let (folder, ..) = CRATES.iter().find(|(name, ..)| *name == folder)?;
    let ends_here = module.last().is_some_and(|last| ["mod", "lib", "main"].contains(last));
    let module = if ends_here { &module[..module.len() - 1] } else { module };
    Some((folder, module.iter().map(|part| (*part).to_owned()).collect()))
}

fn forbidden(folder: &str, room: &str, module: &[String], path: &[&str]) -> Option<String> {
    if room != "app" && OUTSIDE.iter().any(|outside| path.starts_with(outside)) && !PLAIN_DATA.contains(&path) {
        return Some("ONLY THE PROGRAM TOUCHES THE OUTSIDE WORLD".into());
    }
    let (root, rest) = path.split_first()?;
    let other = if *root == "crate" { folder } else { root.strip_prefix("spandrel_")? };
    let target = room_of(other, rest.first().copied())?;
    let (_, allowed) = TABLE.iter().find(|(name, _)| *name == room)?;
    if target != room && !allowed.contains(&target) {
        return Some(format!("{room} must not know {target}"));
    }
    let in_autopilot = folder == "sitl" && module.first().is_some_and(|first| first == "autopilot");
    let truth = target == "sitl" && rest.first() == Some(&"physics") && !rest.get(1).is_some_and(|name| ACTUATION.contains(name));
    if in_autopilot && truth {
        return Some("AUTOPILOT NEVER SEES PHYSICS' TRUTH".into());
    }
    let in_payload = folder == "sitl" && module.iter().map(String::as_str).take(2).eq(["endpoint", "payload"]);
    let autopilot = target == "sitl" && AUTOPILOT_SIDE.iter().any(|side| rest.starts_with(side));
    (in_payload && autopilot).then(|| "PAYLOAD NEVER KNOWS THE AUTOPILOT".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(file: &str, source: &str) -> usize {
        violations(file, source).len()
    }

    #[test]
    fn exact_the_wings_never_import_each_other() {
        assert_eq!(check("crates/monitor/src/sidecar.rs", "use spandrel_sitl::sim::Sim;"), 1);
        assert_eq!(check("crates/training/src/report/mod.rs", "use spandrel_sitl::{sim::Sim, endpoint};"), 2);
        assert_eq!(check("crates/sitl/src/sim.rs", "fn f() { spandrel_monitor::assess(); }"), 1);
        assert_eq!(check("crates/clients/src/pilot/mod.rs", "use spandrel_sitl::physics::RigidState;"), 1);
        assert_eq!(check("src/demo.rs", "use spandrel_monitor::Monitor; use spandrel_sitl::sim::Sim;"), 0);
    }

    #[test]
    fn exact_lower_rooms_never_look_up() {
        assert_eq!(check("crates/model/src/time.rs", "use spandrel_mavlink::codec::Decoder;"), 1);
        assert_eq!(check("crates/model/src/scenario/mod.rs", "use crate::site::Site;"), 1);
        assert_eq!(check("crates/mavlink/src/codec.rs", "use super::telemetry::Frame;"), 1);
        assert_eq!(check("crates/model/src/site/mod.rs", "use crate::scenario::Scenario; use super::super::vehicle::Camera;"), 0);
    }

    #[test]
    fn exact_the_autopilot_sees_what_it_drives_and_nothing_else_of_physics() {
        let file = "crates/sitl/src/autopilot/core.rs";
        assert_eq!(check(file, "use crate::physics::{Actuators, MAX_ROTORS};"), 0);
        assert_eq!(check(file, "use crate::physics::RigidState;"), 1);
        assert_eq!(check(file, "use crate::physics::{Actuators, RigidState};"), 1);
        assert_eq!(check(file, "use super::super::physics::RigidState;"), 1);
        assert_eq!(check("crates/sitl/src/autopilot/mod.rs", "use super::physics;"), 1);
        assert_eq!(check("crates/sitl/src/autopilot/mod.rs", "use crate::physics::*;"), 1);
        assert_eq!(check("crates/sitl/src/sensors/mod.rs", "use crate::physics::RigidState;"), 0);
    }

    #[test]
    fn exact_the_equipments_interface_does_not_know_the_autopilot() {
        let file = "crates/sitl/src/endpoint/payload/input.rs";
        assert_eq!(check(file, "use crate::autopilot::Estimate;"), 1);
        assert_eq!(check(file, "use crate::endpoint::vehicle_link::snapshot::VehicleSnapshot;"), 1);
        assert_eq!(check(file, "use super::super::vehicle_link::VehicleLink;"), 1);
        assert_eq!(check(file, "use crate::physics::RigidState; use crate::endpoint::link::Links;"), 0);
        assert_eq!(check("crates/sitl/src/endpoint/vehicle_link/mod.rs", "use crate::autopilot::Autopilot;"), 0);
    }

    #[test]
    fn exact_only_the_program_touches_the_outside_world() {
        for outside in [
            "use std::net::UdpSocket;",
            "let text = std::fs::read_to_string(path);",
            "use std::{collections::BTreeMap, fs};",
            "std::thread::sleep(pause);",
            "use std::time::Instant;",
            "use std::time::{Duration, SystemTime};",
            "tokio::spawn(task);",
            "sqlx::query(text);",
            "let now = Timestamp::now();",
            "std::env::var(name)",
        ] {
            assert_eq!(check("crates/monitor/src/sidecar.rs", outside), 1, "{outside}");
            assert_eq!(check("crates/sitl/src/sim.rs", outside), 1, "{outside}");
            assert_eq!(check("src/net.rs", outside), 0, "{outside}");
        }
        assert_eq!(check("crates/monitor/src/sidecar.rs", "use std::time::Duration; use std::collections::BTreeMap;"), 0);
    }

    #[test]
    fn exact_a_violation_is_named_with_file_and_line() {
        let found = violations("crates/model/src/site/mod.rs", "// a comment\n\nuse spandrel_monitor::Monitor;\n");
        assert_eq!(found, ["crates/model/src/site/mod.rs:3: spandrel_monitor::Monitor: site must not know monitor"]);
    }
}
