//! Exit codes, messages and files of subcommands that do not need a flight.

use std::path::Path;
use std::process::{Command, Output};

fn spandrel(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_spandrel")).args(args).output().unwrap()
}

fn code_and_output(output: &Output) -> (Option<i32>, String, String) {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

#[test]
fn wire_invalid_arguments_and_files_exit_with_2_and_list_allowed_values() {
    for (args, needle) in [
        (vec!["train", "--trainee", "../up"], "letters, digits"),
        (vec!["demo", "--speed", "0"], "0.1 to 100, or max"),
        (vec!["demo", "--seed", "-1"], "0 to 2147483647"),
        (vec!["demo", "--skill", "ace"], "expert"),
        (vec!["sim", "--flavor", "slugs"], "ardupilot"),
        (vec!["sim", "--drones", "9"], "1..=8"),
        (vec!["sim", "--drones", "2", "--instances", "2"], "cannot be used with"),
        (vec!["monitor", "--scenario", "no-such-job"], "two-bridges"),
        (vec!["monitor", "--vehicle", "no-such-drone"], "phantom2"),
        (vec!["monitor", "--session", "no-such-folder"], "not a session folder"),
        (vec!["pilot", "--connect", "somewhere"], "HOST:PORT"),
        (vec!["assess", "no-such.tlog"], "--scenario and --vehicle"),
        (vec!["export", "two-bridges", "--frames", "-"], "needs a session folder"),
        (vec!["export", "two-bridges"], "--glb"),
        (vec!["check", "no-such-file.toml"], "1 problem in 1 file"),
    ] {
        let (code, out, err) = code_and_output(&spandrel(&args));
        assert_eq!(code, Some(2), "{args:?}: {out}{err}");
        assert!(err.contains(needle), "{args:?}: {err}");
        assert!(!err.contains("panicked"), "{args:?}: {err}");
    }
}

/// Opening the vehicle to a network without a key must cause a warning; local access must not.
#[test]
fn wire_unsigned_network_access_causes_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let key = folder.path().join("key");
    std::fs::write(&key, "steelspan").unwrap();
    let private = std::os::unix::fs::PermissionsExt::from_mode(0o600);
    std::fs::set_permissions(&key, private).unwrap();
    let key = key.display().to_string();
    let alone = ["sim", "--scenario", "drill-hover", "--end-after", "0.1", "--speed", "max", "--gcs", "none", "--sdk", "none"];
    let ports = ["--gcs-port", "0", "--payload-port", "0", "--tcp-port", "none", "--monitor-port", "none"];
    for (more, warned) in [
        (vec![], false),
        (vec!["--listen", "0.0.0.0"], true),
        (vec!["--listen", "0.0.0.0", "--signing-key", key.as_str()], false),
    ] {
        let (code, _, err) = code_and_output(&spandrel(&[&alone[..], &ports[..], &more[..]].concat()));
        assert_eq!(code, Some(0), "{more:?}: {err}");
        assert_eq!(err.contains("without --signing-key"), warned, "{more:?}: {err}");
    }
}

/// Two runs of drones that share a site have the same digests, the drones' digests differ, and a single drone has the digest that it
/// has without the option.
#[test]
fn wire_drones_that_share_a_site_are_reproducible() {
    let alone = ["sim", "--scenario", "drill-hover", "--seed", "4", "--end-after", "4", "--speed", "max", "--digest"];
    let ports = ["--ports", "ephemeral", "--gcs", "none", "--sdk", "none", "--tcp-port", "none", "--monitor-port", "none"];
    let digests = |more: &[&str]| {
        let (code, out, err) = code_and_output(&spandrel(&[&alone[..], &ports[..], more].concat()));
        assert_eq!(code, Some(0), "{more:?}: {err}");
        out.lines().map(str::to_owned).collect::<Vec<String>>()
    };
    let three = digests(&["--drones", "3"]);
    assert_eq!(three, digests(&["--drones", "3"]));
    assert!(three.len() == 3 && three[0] != three[1] && three[1] != three[2] && three[0] != three[2], "{three:?}");
    assert_eq!(digests(&["--drones", "1"]), digests(&[]));
    assert_eq!(three[0], digests(&[])[0], "on the ground, far from each other, the first drone is the one that flies alone");
}

#[test]
fn wire_check_reports_all_problems_as_text_and_json() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.display().to_string()
    };
    let job = spandrel_model::shipped::DRILL_HOVER;
    let good = write("good.toml", job);
    let bad = write("bad.toml", &job.replace("spacing_m = 8.0", "spacing_m = -8.0").replace("turbulence", "turbulance"));
    let (code, out, _) = code_and_output(&spandrel(&["check", &good]));
    assert_eq!((code, out.lines().last()), (Some(0), Some("1 file valid")));
    // The other lines explain the certification and the difficulty levels.
    let is_about = |line: &str| line.contains("good.toml: to be certified: ") || line.contains("good.toml: level ");
    let is_note = |line: &&str| line.starts_with("note: ") && is_about(line);
    assert_eq!(out.lines().filter(is_note).count(), out.lines().count() - 1, "{out}");
    assert!(out.contains("coverage-weighted conformity at least 75"), "{out}");
    assert!(out.contains("level 9 of 9: wind 8 m/s, on path within 0.8 m"), "{out}");

    let (code, out, err) = code_and_output(&spandrel(&["check", &good, &bad]));
    assert_eq!(code, Some(2));
    assert_eq!(out.lines().filter(|line| !line.starts_with("note: ")).count(), 2, "{out}");
    assert!(out.contains("bad.toml:13: terrain.spacing_m = -8.0"), "{out}");
    assert!(out.contains("turbulance") && err.contains("2 problems in 2 files"), "{out}{err}");

    let (code, out, _) = code_and_output(&spandrel(&["check", &bad, "--json"]));
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(code, Some(2));
    let problem = &json["problems"][0];
    assert_eq!((problem["line"].as_u64(), problem["key"].as_str()), (Some(13), Some("terrain.spacing_m")));
    assert!(["file", "value", "allowed", "message"].iter().all(|key| problem[key].is_string()), "{problem}");
}

/// Maximum size of a report on thousands of problems, bytes: 50 problems of about 400 bytes, most of them the list of allowed keys.
const MAX_REPORT_BYTES: usize = 25_000;

#[test]
fn regress_long_problem_lists_are_truncated() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("keys.toml");
    let unknown: String = (0..10_000).map(|k| format!("unknown_{k} = 1\n")).collect();
    std::fs::write(&path, unknown + spandrel_model::shipped::DRILL_HOVER).unwrap();
    let path = path.display().to_string();
    for (args, code) in [(vec!["check", &path], 2), (vec!["export", &path, "--glb", "-"], 2), (vec!["check", &path, "--json"], 2)]
    {
        let (ended, out, err) = code_and_output(&spandrel(&args));
        assert_eq!(ended, Some(code), "{args:?}");
        assert!(out.len() + err.len() < MAX_REPORT_BYTES, "{args:?}: {} bytes", out.len() + err.len());
        let more = if args.contains(&"--json") { "\"more_problems\": 9950" } else { "and 9950 more problems" };
        assert!(out.contains(more) || err.contains(more), "{args:?}: {out}{err}");
    }
}

#[test]
fn wire_only_exports_use_standard_output() {
    let (code, out, _) =
        code_and_output(&spandrel(&["export", "two-bridges", "--seed", "7", "--scenario", "-", "--log", "trace"]));
    assert_eq!(code, Some(0));
    let json: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(json["tasks"].as_array().map(Vec::len), Some(4));
    assert_eq!(json["defects"].as_array().map(Vec::len), Some(10));
}

#[test]
fn wire_program_works_in_any_folder() {
    let elsewhere = tempfile::tempdir().unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_spandrel"));
    let output = Command::new(program).args(["export", "practice", "--glb", "p.glb"]).current_dir(&elsewhere).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(std::fs::read(elsewhere.path().join("p.glb")).unwrap().starts_with(b"glTF"));
}

#[test]
fn wire_port_in_use_is_reported() {
    let taken = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port().to_string();
    let sessions = tempfile::tempdir().unwrap();
    let folder = sessions.path().display().to_string();
    let (code, _, err) = code_and_output(&spandrel(&["monitor", "--port", &port, "--sessions", &folder]));
    assert_eq!(code, Some(1));
    assert_eq!(std::fs::read_dir(&sessions).unwrap().count(), 0, "a session folder was left over");
    assert!(err.contains("is in use") && err.contains(&port), "{err}");
}

#[test]
fn wire_every_subcommand_help_has_examples_and_exit_codes() {
    for subcommand in ["train", "demo", "monitor", "pilot", "assess", "export", "check"] {
        let (code, out, _) = code_and_output(&spandrel(&[subcommand, "--help"]));
        assert_eq!(code, Some(0));
        assert!(out.contains("Examples:") && out.contains("Exit codes:"), "{subcommand}");
    }
}

#[test]
fn wire_incomplete_vehicle_file_is_recognized() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("drone.toml");
    std::fs::write(&path, spandrel_model::shipped::PHANTOM2.replace("\nmass_kg", "\nmas_kg")).unwrap();
    let (code, out, _) = code_and_output(&spandrel(&["check", &path.display().to_string()]));
    assert_eq!(code, Some(2));
    assert!(out.lines().all(|line| line.contains("mas")) && out.contains("mass_kg: missing"), "{out}");
}

#[test]
fn wire_conflicting_keys_are_reported_with_their_values() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("job.toml");
    let limits = "[scoring]\nspeed_limit_mph = 20.0\nmax_speed_mph = 15.0\ntime_best_min = 30.0\n";
    std::fs::write(&path, format!("{}\n{limits}", spandrel_model::shipped::DRILL_HOVER)).unwrap();
    let (code, out, _) = code_and_output(&spandrel(&["check", &path.display().to_string()]));
    assert_eq!(code, Some(2));
    assert!(out.contains("max_speed_mph = 15") && out.contains("time_max_min = 25"), "{out}");
}

#[test]
fn wire_demo_session_works_without_derived_files() {
    let folder = tempfile::tempdir().unwrap();
    let job = folder.path().join("job.toml");
    std::fs::write(&job, format!("seed = 5\n{}", spandrel_model::shipped::DRILL_LANDING)).unwrap();
    let (job, sessions) = (job.display().to_string(), folder.path().join("sessions"));
    let place = sessions.display().to_string();
    let demo = ["demo", "--scenario", &job, "--speed", "max", "--sessions", &place, "--trainee", "anna-b", "--log", "warn"];
    let (code, _, err) = code_and_output(&spandrel(&demo));
    assert_eq!(code, Some(0), "{err}");
    let session = std::fs::read_dir(&sessions).unwrap().next().unwrap().unwrap().path();
    let described = |key: &str| -> serde_json::Value {
        let text = std::fs::read_to_string(session.join("session.json")).unwrap();
        serde_json::from_str::<serde_json::Value>(&text).unwrap()[key].clone()
    };
    assert_eq!((described("seed"), described("trainee")), (5.into(), "anna-b".into()));

    // Only the log and the two TOML files are needed; all other files derive from them.
    let live = std::fs::read_to_string(session.join("assessment.json")).unwrap();
    let started = described("started_utc");
    ["session.json", "assessment.json"].iter().for_each(|name| std::fs::remove_file(session.join(name)).unwrap());
    let at = session.display().to_string();
    let (code, again, err) = code_and_output(&spandrel(&["assess", &at, "--json", "-"]));
    assert_eq!((code, again == live), (Some(0), true), "{err}");

    // Simulates a monitor that was killed while it was writing its last event.
    let events = session.join("events.jsonl");
    let whole = std::fs::read_to_string(&events).unwrap();
    std::fs::write(&events, format!("{whole}{{\"t_s\":1")).unwrap();
    let (code, _, err) = code_and_output(&spandrel(&["monitor", "--session", &at, "--port", "0", "--speed", "max"]));
    assert_eq!(code, Some(0), "{err}");
    let after = std::fs::read_to_string(&events).unwrap();
    assert!(
        after.starts_with(&whole) && after.lines().all(|line| serde_json::from_str::<serde_json::Value>(line).is_ok()),
        "{after}"
    );
    assert_eq!((described("trainee"), described("started_utc")), ("anna-b".into(), started));
    assert_eq!(std::fs::read_to_string(session.join("assessment.json")).unwrap(), live);

    let log = session.join("telemetry.tlog").display().to_string();
    let (code, _, err) = code_and_output(&spandrel(&["assess", &log, "--scenario", "drill-hover", "--vehicle", "phantom2"]));
    assert_eq!(code, Some(2), "{err}");
    assert!(err.contains("a different scenario"), "{err}");
}
