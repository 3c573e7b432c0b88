//! The rules: the table of rooms and the three capital rules of ARCHITECTURE.md.

use crate::paths::{code_only, named};

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
    &["jiff", "Zoned", "now"],
];
/// What of these rooms of `std` is plain data: no clock, no socket.
const PLAIN_DATA: &[&[&str]] = &[&["std", "time", "Duration"], &["std", "net", "IpAddr"], &["std", "net", "SocketAddr"]];
/// What the autopilot may name of physics: what it drives, not what is true.
const ACTUATION: &[&str] = &["Actuators", "MAX_ROTORS"];
const ROOTS: &[&str] = &[
    "crate",
    "spandrel",
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

/// True for a room of the table.
pub fn is_room(name: &str) -> bool {
    TABLE.iter().any(|(room, _)| *room == name)
}

/// All rooms.
pub fn rooms() -> impl Iterator<Item = &'static str> {
    TABLE.iter().map(|(room, _)| *room)
}

/// Everything that a file (its path below `src/`) names and must not.
pub fn violations(file: &str, source: &str) -> Vec<String> {
    let module = module_of(file);
    let room = module.first().map_or("", String::as_str);
    // lib.rs and main.rs stand above the rooms.
    let Some((_, allowed)) = TABLE.iter().find(|(name, _)| *name == room) else { return Vec::new() };
    let code = code_only(source);
    let mut found: Vec<String> = named(&code, &module, ROOTS)
        .into_iter()
        .filter_map(|(line, path)| {
            let path: Vec<&str> = path.iter().map(String::as_str).collect();
            let why = forbidden(room, allowed, &module, &path)?;
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
    lines.map(|(k, line)| format!("{file}:{}: {}: ONLY APP TOUCHES THE OUTSIDE WORLD", k + 1, line.trim())).collect()
}

/// `sitl/autopilot/core.rs` is the module `sitl::autopilot::core`.
fn module_of(file: &str) -> Vec<String> {
    let mut parts: Vec<String> = file.trim_end_matches(".rs").split(['/', '\\']).map(str::to_owned).collect();
    if parts.last().is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str())) {
        parts.pop();
    }
    parts
}

fn forbidden(room: &str, allowed: &[&str], module: &[String], path: &[&str]) -> Option<String> {
    if room != "app" && OUTSIDE.iter().any(|outside| path.starts_with(outside)) && !PLAIN_DATA.contains(&path) {
        return Some("ONLY APP TOUCHES THE OUTSIDE WORLD".into());
    }
    let [root, target, rest @ ..] = path else { return None };
    if !["crate", "spandrel"].contains(root) {
        return None;
    }
    if is_room(target) && *target != room && !allowed.contains(target) {
        return Some(format!("{room} must not know {target}"));
    }
    let in_autopilot = module.starts_with(&["sitl".to_owned(), "autopilot".to_owned()]);
    let truth =
        *target == "sitl" && rest.first() == Some(&"physics") && !rest.get(1).is_some_and(|name| ACTUATION.contains(name));
    (in_autopilot && truth).then(|| "AUTOPILOT NEVER SEES PHYSICS' TRUTH".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(file: &str, source: &str) -> usize {
        violations(file, source).len()
    }

    #[test]
    fn exact_the_wings_never_import_each_other() {
        assert_eq!(check("monitor/watch.rs", "use crate::sitl::sim::Sim;"), 1);
        assert_eq!(check("monitor/watch.rs", "use crate::{base::time::SimTime, sitl};"), 1);
        assert_eq!(check("sitl/sim.rs", "fn f() { crate::monitor::assess(); }"), 1);
        assert_eq!(check("sitl/sim.rs", "use super::super::monitor::Monitor;"), 1);
        assert_eq!(check("pilot/mod.rs", "use crate::sitl::physics::RigidState;"), 1);
        assert_eq!(check("app/demo.rs", "use crate::{monitor::Monitor, sitl::sim::Sim};"), 0);
    }

    #[test]
    fn exact_lower_rooms_never_look_up() {
        assert_eq!(check("base/time.rs", "use crate::mav::codec::Decoder;"), 1);
        assert_eq!(check("scenario/mod.rs", "use crate::site::Site;"), 1);
        assert_eq!(check("site/mod.rs", "use crate::telemetry::Frame;"), 1);
        assert_eq!(check("site/mod.rs", "use crate::scenario::Scenario; use crate::vehicle::Camera;"), 0);
        assert_eq!(check("monitor/mod.rs", "use crate::app::AppError;"), 1);
    }

    #[test]
    fn exact_the_autopilot_sees_what_it_drives_and_nothing_else_of_physics() {
        let file = "sitl/autopilot/core.rs";
        assert_eq!(check(file, "use crate::sitl::physics::{Actuators, MAX_ROTORS};"), 0);
        assert_eq!(check(file, "use crate::sitl::physics::RigidState;"), 1);
        assert_eq!(check(file, "use crate::sitl::physics::{Actuators, RigidState};"), 1);
        assert_eq!(check(file, "use super::super::physics::RigidState;"), 1);
        assert_eq!(check("sitl/autopilot/mod.rs", "use super::physics;"), 1);
        assert_eq!(check("sitl/autopilot/mod.rs", "use crate::sitl::physics::*;"), 1);
        assert_eq!(check("sitl/sensors/mod.rs", "use crate::sitl::physics::RigidState;"), 0);
    }

    #[test]
    fn exact_only_app_touches_the_outside_world() {
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
            assert_eq!(check("monitor/watch.rs", outside), 1, "{outside}");
            assert_eq!(check("sitl/sim.rs", outside), 1, "{outside}");
            assert_eq!(check("app/net.rs", outside), 0, "{outside}");
        }
        assert_eq!(check("monitor/watch.rs", "use std::time::Duration; use std::collections::BTreeMap;"), 0);
    }

    #[test]
    fn exact_a_violation_is_named_with_file_and_line() {
        let found = violations("site/mod.rs", "// a comment\n\nuse crate::monitor::Monitor;\n");
        assert_eq!(found, ["site/mod.rs:3: crate::monitor::Monitor: site must not know monitor"]);
    }
}
