//! Rules that Cargo cannot enforce: the table of layers within crates, and the main rules of ARCHITECTURE.md.

use crate::paths::{code_only, rooted_paths, rooted_paths_in, tokens, without_tests};
use crate::picture::Imports;

/// A module that is a separate layer, and the name of the layer.
type ModuleLayer = (&'static str, &'static str);
/// Each crate with the modules that are separate layers, and the layer of all other modules.
const CRATES: &[(&str, &[ModuleLayer], &str)] = &[
    ("model", &[("scenario", "scenario"), ("vehicle", "vehicle"), ("site", "site")], "base"),
    ("text", &[], "text"),
    ("mavlink", &[("telemetry", "telemetry")], "mav"),
    ("sitl", &[], "sitl"),
    ("monitor", &[], "monitor"),
    ("training", &[("report", "report"), ("web", "web")], "training"),
    ("clients", &[("pilot", "pilot")], "rc"),
    ("view", &[], "view"),
    (PROGRAM, &[("errors", "errors"), ("io", "io"), ("records", "records"), ("web", "server"), ("window", "window")], "cli"),
];
/// The package at the workspace root.
const PROGRAM: &str = "";
/// Each layer with the layers that it may use.
const ALLOWED_IMPORTS: &[(&str, &[&str])] = &[
    ("base", &[]),
    ("text", &[]),
    ("mav", &["base"]),
    ("scenario", &["base"]),
    ("vehicle", &["base"]),
    ("site", &["base", "scenario", "vehicle"]),
    ("telemetry", &["base", "mav", "scenario", "vehicle"]),
    ("sitl", &["base", "mav", "scenario", "vehicle", "site"]),
    ("monitor", &["base", "text", "mav", "scenario", "vehicle", "site", "telemetry"]),
    ("pilot", &["base", "mav", "scenario", "vehicle", "site", "telemetry"]),
    ("training", &["base", "text", "mav", "scenario", "vehicle", "site", "telemetry", "monitor"]),
    ("rc", &["base", "text", "mav"]),
    ("report", &["base", "text", "mav", "scenario", "vehicle", "site", "telemetry", "monitor", "training"]),
    ("web", &["base", "text", "mav", "scenario", "vehicle", "site", "telemetry", "monitor", "training", "report"]),
    ("view", &["base", "text", "mav", "scenario", "vehicle", "site", "telemetry"]),
    ("errors", &[]),
    ("io", &["errors"]),
    ("records", &["errors", "io"]),
    ("server", &["errors", "io", "records"]),
    ("window", &["errors", "io"]),
    ("cli", &["errors", "io", "records", "server", "window"]),
];

/// Paths that only the main program may use: sockets, files, clocks, threads, processes, terminals.
const OUTSIDE_WORLD_PATHS: &[&[&str]] = &[
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
/// Items in these modules of `std` that are plain data rather than clocks or sockets.
const PLAIN_DATA_ITEMS: &[&[&str]] = &[&["std", "time", "Duration"], &["std", "net", "IpAddr"], &["std", "net", "SocketAddr"]];
/// Items of the physics module that the autopilot may use: actuator commands, not the true state.
const ACTUATION_ITEMS: &[&str] = &["Actuators", "MAX_ROTORS"];
/// Modules of the simulator that a real autopilot would replace. The equipment interface must not depend on them.
const AUTOPILOT_MODULES: &[&[&str]] = &[
    &["autopilot"],
    &["backend"],
    &["endpoint", "vehicle_link"],
    &["endpoint", "flavor"],
    &["endpoint", "params"],
    &["endpoint", "snapshot"],
];
const ROOTS: &[&str] = &[
    "crate",
    "spandrel_model",
    "spandrel_mavlink",
    "spandrel_sitl",
    "spandrel_text",
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

/// Returns all crates except the program, by folder.
pub fn crates() -> impl Iterator<Item = &'static str> {
    CRATES.iter().map(|(folder, ..)| *folder).filter(|folder| *folder != PROGRAM)
}

/// Returns all layers.
pub fn layers() -> impl Iterator<Item = &'static str> {
    ALLOWED_IMPORTS.iter().map(|(layer, _)| *layer)
}

/// Returns the crates that a crate may depend on: those with layers that its own layers may use.
pub fn may_depend_on(folder: &str) -> Vec<&'static str> {
    let known = ALLOWED_IMPORTS.iter().filter(|(layer, _)| folder_of(layer) == folder).flat_map(|(_, known)| *known);
    crates().filter(|other| *other != folder && known.clone().any(|layer| folder_of(layer) == *other)).collect()
}

/// Returns the crate that contains a layer.
fn folder_of(layer: &str) -> &'static str {
    let holds = |own: &[ModuleLayer], rest: &str| rest == layer || own.iter().any(|(_, name)| *name == layer);
    CRATES.iter().find(|(_, own, rest)| holds(own, rest)).map_or(PROGRAM, |(folder, ..)| *folder)
}

/// Returns the layer of a crate's module.
fn layer_of(folder: &str, module: Option<&str>) -> Option<&'static str> {
    let (_, own, rest) = CRATES.iter().find(|(name, ..)| *name == folder)?;
    Some(own.iter().find(|(name, _)| Some(*name) == module).map_or(rest, |(_, layer)| layer))
}

/// Returns all rule violations in a file, given by its path in the workspace.
pub fn violations(file: &str, source: &str) -> Vec<String> {
    let Some((folder, module)) = module_of(file) else {
        return vec![format!("{file}: not in a crate listed in tests/layers/rules.rs")];
    };
    let layer = layer_of(folder, module.first().map(String::as_str)).unwrap_or_default();
    let code = code_only(source);
    let mut found: Vec<String> = rooted_paths(&code, &module, ROOTS)
        .into_iter()
        .filter_map(|(line, path)| {
            let path: Vec<&str> = path.iter().map(String::as_str).collect();
            let why = violated_rule(folder, layer, &module, &path)?;
            Some(format!("{file}:{line}: {}: {why}", path.join("::")))
        })
        .collect();
    found.extend(clock_violations(folder, file, &code));
    found.dedup();
    found
}

/// Adds the number of names that a file imports from each other layer to `imports`.
pub fn count_imports(file: &str, source: &str, imports: &mut Imports) {
    let Some((folder, module)) = module_of(file) else { return };
    let Some(layer) = layer_of(folder, module.first().map(String::as_str)) else { return };
    for (_, path) in rooted_paths_in(&without_tests(&tokens(&code_only(source))), &module, ROOTS) {
        let path: Vec<&str> = path.iter().map(String::as_str).collect();
        if let Some(target) = target_of(folder, &path).filter(|target| *target != layer) {
            *imports.entry((layer, target)).or_default() += 1;
        }
    }
}

/// Returns the display name of the folder with a layer's crate.
pub fn crate_label(layer: &str) -> String {
    match folder_of(layer) {
        PROGRAM => "src".to_owned(),
        folder => format!("crates/{folder}"),
    }
}

/// Returns the layer that a path points to.
fn target_of(folder: &str, path: &[&str]) -> Option<&'static str> {
    let (root, rest) = path.split_first()?;
    let other = if *root == "crate" { folder } else { root.strip_prefix("spandrel_")? };
    layer_of(other, rest.first().copied())
}

/// Returns uses of `Instant::now()` and similar functions, including uses through imported names.
fn clock_violations(folder: &str, file: &str, code: &str) -> Vec<String> {
    let reads = |line: &str| folder != PROGRAM && line.contains("::now()");
    let lines = code.lines().enumerate().filter(|(_, line)| reads(line));
    lines
        .map(|(k, line)| {
            format!("{file}:{}: {}: ONLY THE PROGRAM AND THE PYTHON PACKAGE TOUCH THE OUTSIDE WORLD", k + 1, line.trim())
        })
        .collect()
}

/// Returns the crate and module of a file: `crates/sitl/src/autopilot/core.rs` is the `autopilot::core` module of the
/// `sitl` crate.
fn module_of(file: &str) -> Option<(&'static str, Vec<String>)> {
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

fn violated_rule(folder: &str, layer: &str, module: &[String], path: &[&str]) -> Option<String> {
    if folder != PROGRAM
        && OUTSIDE_WORLD_PATHS.iter().any(|outside| path.starts_with(outside))
        && !PLAIN_DATA_ITEMS.contains(&path)
    {
        return Some("ONLY THE PROGRAM AND THE PYTHON PACKAGE TOUCH THE OUTSIDE WORLD".into());
    }
    let target = target_of(folder, path)?;
    let rest = &path[1..];
    let (_, allowed) = ALLOWED_IMPORTS.iter().find(|(name, _)| *name == layer)?;
    let library = folder == PROGRAM && folder_of(target) != PROGRAM;
    if target != layer && !library && !allowed.contains(&target) {
        return Some(format!("{layer} must not use {target}"));
    }
    let in_autopilot = folder == "sitl" && module.first().is_some_and(|first| first == "autopilot");
    let truth =
        target == "sitl" && rest.first() == Some(&"physics") && !rest.get(1).is_some_and(|name| ACTUATION_ITEMS.contains(name));
    if in_autopilot && truth {
        return Some("THE AUTOPILOT NEVER SEES THE TRUE STATE".into());
    }
    let in_payload = folder == "sitl" && module.iter().map(String::as_str).take(2).eq(["endpoint", "payload"]);
    let autopilot = target == "sitl" && AUTOPILOT_MODULES.iter().any(|side| rest.starts_with(side));
    (in_payload && autopilot).then(|| "THE EQUIPMENT INTERFACE NEVER SEES THE AUTOPILOT".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(file: &str, source: &str) -> usize {
        violations(file, source).len()
    }

    #[test]
    fn exact_simulator_and_monitor_do_not_import_each_other() {
        assert_eq!(check("crates/monitor/src/sidecar.rs", "use spandrel_sitl::sim::Sim;"), 1);
        assert_eq!(check("crates/training/src/report/mod.rs", "use spandrel_sitl::{sim::Sim, endpoint};"), 2);
        assert_eq!(check("crates/sitl/src/sim.rs", "fn f() { spandrel_monitor::assess(); }"), 1);
        assert_eq!(check("crates/clients/src/pilot/mod.rs", "use spandrel_sitl::physics::RigidState;"), 1);
        assert_eq!(check("src/cli/demo.rs", "use spandrel_monitor::Monitor; use spandrel_sitl::sim::Sim;"), 0);
    }

    #[test]
    fn exact_lower_layers_never_import_higher_ones() {
        assert_eq!(check("crates/model/src/time.rs", "use spandrel_mavlink::codec::Decoder;"), 1);
        assert_eq!(check("crates/model/src/scenario/mod.rs", "use crate::site::Site;"), 1);
        assert_eq!(check("crates/mavlink/src/codec.rs", "use super::telemetry::Frame;"), 1);
        assert_eq!(check("crates/model/src/site/mod.rs", "use crate::scenario::Scenario; use super::super::vehicle::Camera;"), 0);
    }

    #[test]
    fn exact_program_layers_import_only_lower_layers() {
        assert_eq!(check("src/io/links.rs", "use crate::errors::AppError; use super::net::SocketHub;"), 0);
        assert_eq!(check("src/web/server.rs", "use crate::{errors::AppError, io::stop, records::Database};"), 0);
        assert_eq!(check("src/cli/serve.rs", "use crate::web::WebServer; use crate::window;"), 0);
        assert_eq!(check("src/lib.rs", "pub use crate::cli::main;"), 0);
        assert_eq!(check("src/errors.rs", "use crate::io::clock;"), 1);
        assert_eq!(check("src/io/links.rs", "use crate::cli::ports::PortArgs;"), 1);
        assert_eq!(check("src/records/mod.rs", "use super::web::WebServer; use crate::window;"), 2);
        assert_eq!(check("src/web/server.rs", "use crate::cli::serve::Args;"), 1);
        assert_eq!(check("src/window/mod.rs", "use crate::records::Database; use crate::cli;"), 2);
    }

    #[test]
    fn exact_autopilot_imports_only_actuation_from_physics() {
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
    fn exact_payload_interface_does_not_use_the_autopilot() {
        let file = "crates/sitl/src/endpoint/payload/input.rs";
        assert_eq!(check(file, "use crate::autopilot::Estimate;"), 1);
        assert_eq!(check(file, "use crate::endpoint::vehicle_link::snapshot::VehicleSnapshot;"), 1);
        assert_eq!(check(file, "use super::super::vehicle_link::VehicleLink;"), 1);
        assert_eq!(check(file, "use crate::physics::RigidState; use crate::endpoint::link::Links;"), 0);
        assert_eq!(check("crates/sitl/src/endpoint/vehicle_link/mod.rs", "use crate::autopilot::Autopilot;"), 0);
    }

    #[test]
    fn exact_only_the_program_does_io() {
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
            assert_eq!(check("src/io/net.rs", outside), 0, "{outside}");
        }
        assert_eq!(check("crates/monitor/src/sidecar.rs", "use std::time::Duration; use std::collections::BTreeMap;"), 0);
    }

    #[test]
    fn exact_violations_include_file_and_line() {
        let found = violations("crates/model/src/site/mod.rs", "// a comment\n\nuse spandrel_monitor::Monitor;\n");
        assert_eq!(found, ["crates/model/src/site/mod.rs:3: spandrel_monitor::Monitor: site must not use monitor"]);
    }
}
