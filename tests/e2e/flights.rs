//! Complete flights in separate processes over real UDP: reproducible demos, parallel demos, a killed monitor, and
//! child processes that must end with their parent.

use serde_json::Value;
use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::{MavMessage, TIMESYNC_DATA};
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Output, Stdio};

const PROGRAM: &str = env!("CARGO_BIN_EXE_spandrel");

fn demo(sessions: &Path, seed: &str) -> Command {
    demo_of("drill-hover", sessions, seed)
}

fn demo_of(scenario: &str, sessions: &Path, seed: &str) -> Command {
    let mut command = Command::new(PROGRAM);
    command.args(["demo", "--scenario", scenario, "--skill", "expert", "--speed", "max", "--seed", seed, "--sessions"]);
    command.arg(sessions).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn only_session(sessions: &Path) -> PathBuf {
    let folders: Vec<PathBuf> = std::fs::read_dir(sessions).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(folders.len(), 1, "{folders:?}");
    folders[0].clone()
}

fn successful_stdout(output: &Output) -> String {
    let out = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{out}{}", String::from_utf8_lossy(&output.stderr));
    out
}

fn stdout_of(args: &[&str]) -> String {
    successful_stdout(&Command::new(PROGRAM).args(args).output().unwrap())
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

#[test]
fn wire_demo_session_is_complete_and_reproducible() {
    let (first, second) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let out = successful_stdout(&demo(first.path(), "7").output().unwrap());
    successful_stdout(&demo(second.path(), "7").output().unwrap());
    let (a, b) = (only_session(first.path()), only_session(second.path()));
    for line in ["conformity", "efficiency", "safety", "accuracy", "overall", "crashes", "snapshots", "session"] {
        assert!(out.lines().any(|text| text.starts_with(line)), "no {line} in\n{out}");
    }
    assert!(out.contains(&a.display().to_string()));
    for file in ["telemetry.tlog", "scenario.toml", "vehicle.toml", "session.json", "events.jsonl", "assessment.json"] {
        assert!(std::fs::metadata(a.join(file)).is_ok_and(|file| file.len() > 0), "{file} is missing");
    }
    let (a, b) = (a.display().to_string(), b.display().to_string());
    let again = stdout_of(&["assess", &a, "--json", "-"]);
    assert_eq!(again.into_bytes(), std::fs::read(Path::new(&a).join("assessment.json")).unwrap());
    let frames = stdout_of(&["export", &a, "--frames", "-"]);
    assert!(frames.lines().count() > 30);
    assert_eq!(frames, stdout_of(&["export", &b, "--frames", "-"]));
    assert_eq!(json(&Path::new(&a).join("assessment.json"))["end"]["reason"], "landed");
}

#[test]
fn flight_expert_completes_the_girder_bridge_without_contact() {
    assert_expert_completes("girder", "3", 7);
}

#[test]
fn flight_expert_completes_the_prestressed_bridge_without_contact() {
    assert_expert_completes("prestressed", "3", 5);
}

#[test]
fn flight_expert_completes_the_truss_bridge_without_contact() {
    assert_expert_completes("truss", "3", 5);
}

#[test]
fn flight_expert_completes_the_box_girder_bridge_without_contact() {
    assert_expert_completes("box-girder", "3", 5);
}

#[test]
fn flight_expert_completes_the_masonry_arch_bridge_without_contact() {
    assert_expert_completes("masonry-arch", "3", 5);
}

#[test]
fn flight_expert_completes_the_cable_stayed_bridge_without_contact() {
    assert_expert_completes("cable-stayed", "3", 5);
}

#[test]
fn flight_expert_completes_the_winter_job_with_a_cold_battery_without_contact() {
    assert_expert_completes("winter", "3", 5);
}

/// Share of the time off the path and loss by speeding that the drills' criteria allow, as in crates/training/src/plan/rules.toml.
const MAX_OFF_PATH: f64 = 0.1;
const MAX_SPEEDING: f64 = 0.02;

#[test]
fn flight_expert_meets_the_criteria_of_the_drills_at_other_bridge_types() {
    for drill in ["drill-girder-bays", "drill-truss-panels", "drill-haunches", "drill-barrel", "drill-stay-cable"] {
        let assessment = flown(drill, "3");
        assert_eq!(assessment["end"]["reason"], "landed", "{drill}");
        assert_eq!(assessment["crashes"]["other"], 0, "{drill}: {}", assessment["crashes"]);
        let [task] = &assessment["tasks"].as_array().unwrap()[..] else { panic!("{drill}: not one task") };
        assert_eq!(task["state"], "done", "{drill}: {task}");
        assert!(task["on_path"].as_f64().unwrap() >= 1.0 - MAX_OFF_PATH, "{drill}: {task}");
        assert!(task["speeding"].as_f64().unwrap() <= MAX_SPEEDING, "{drill}: {task}");
    }
}

/// Returns the assessment of an expert's flight.
fn flown(job: &str, seed: &str) -> Value {
    let folder = tempfile::tempdir().unwrap();
    successful_stdout(&demo_of(job, folder.path(), seed).output().unwrap());
    json(&only_session(folder.path()).join("assessment.json"))
}

/// Least conformity (P_C of the TASBID paper) of an expert's flight, raw, of 100: it strays from the path for a tenth of the time at most
/// (estimate). Paths that lead along each other cost much more, because each task's window then contains the flight along others.
const MIN_CONFORMITY: f64 = 90.0;

/// Checks that the expert lands after all tasks of a job without contact, stays on their paths, and finds at least a number of the defects.
fn assert_expert_completes(job: &str, seed: &str, min_found: u64) {
    let assessment = flown(job, seed);
    assert_eq!(assessment["end"]["reason"], "landed");
    assert_eq!(assessment["crashes"]["other"], 0, "{}", assessment["crashes"]);
    let states: Vec<&str> = assessment["tasks"].as_array().unwrap().iter().filter_map(|task| task["state"].as_str()).collect();
    assert!(states.len() > 2 && states.iter().all(|state| *state == "done"), "{states:?}");
    let conformity = assessment["scores"]["conformity"]["raw"].as_f64().unwrap();
    assert!(conformity >= MIN_CONFORMITY, "{job}: {conformity}: {}", assessment["tasks"]);
    let found = assessment["snapshots"]["defects_found"].as_u64().unwrap_or(0);
    assert!(found >= min_found, "{found} defects found");
}

#[test]
fn wire_four_parallel_demos_succeed() {
    let folders: Vec<_> = (0..4).map(|_| tempfile::tempdir().unwrap()).collect();
    let running: Vec<Child> =
        folders.iter().zip(["1", "2", "3", "4"]).map(|(folder, seed)| demo(folder.path(), seed).spawn().unwrap()).collect();
    for (child, folder) in running.into_iter().zip(&folders) {
        successful_stdout(&child.wait_with_output().unwrap());
        assert!(only_session(folder.path()).join("assessment.json").is_file());
    }
}

#[test]
fn wire_demo_in_every_flavor_ends_with_scores() {
    for flavor in ["ardupilot", "generic"] {
        let folder = tempfile::tempdir().unwrap();
        let out = successful_stdout(&demo(folder.path(), "7").args(["--flavor", flavor]).output().unwrap());
        let assessment = json(&only_session(folder.path()).join("assessment.json"));
        assert_eq!(assessment["end"]["reason"], "landed", "{flavor}: {out}");
        assert!(assessment["tasks"][0]["on_path"].as_f64().unwrap() > 0.9, "{flavor}: {out}");
        assert!(
            assessment["flown_by"].to_string().contains("pilot"),
            "the sidecar must decode the autopilot's modes: {assessment}"
        );
    }
}

/// A process with a lifeline pipe, and its announcement.
struct Process {
    child: Child,
    out: BufReader<ChildStdout>,
    announced: Value,
}

impl Process {
    fn start(args: &[&str]) -> Self {
        let mut child = Command::new(PROGRAM)
            .args(args)
            .args(["--announce", "--leash", "--log", "warn"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        let mut line = String::new();
        out.read_line(&mut line).unwrap();
        let announced = serde_json::from_str(&line).unwrap_or_else(|error| panic!("{args:?} announced '{line}': {error}"));
        Self { child, out, announced }
    }

    fn port(&self) -> String {
        self.announced["port"].to_string()
    }

    /// Waits until the process ends. The lifeline pipe stays open until then.
    fn exits_successfully(mut self) -> bool {
        self.out.read_to_string(&mut String::new()).unwrap();
        self.child.wait().unwrap().success()
    }

    /// Lets the process finish and returns its output. A child that does not finish hangs the test, which counts as a
    /// failure.
    fn finish(mut self) -> (bool, String) {
        drop(self.child.stdin.take());
        let mut rest = String::new();
        self.out.read_to_string(&mut rest).unwrap();
        (self.child.wait().unwrap().success(), rest)
    }
}

#[test]
fn wire_restarted_monitor_continues_the_session() {
    let sessions = tempfile::tempdir().unwrap();
    let folder = sessions.path().display().to_string();
    let job = ["--scenario", "drill-hover", "--seed", "5"];
    let mut monitor = Process::start(&[&["monitor", "--port", "0", "--sessions", &folder], &job[..]].concat());
    let pilot = Process::start(&[&["pilot", "--port", "0", "--skill", "expert"], &job[..]].concat());
    let (monitor_port, pilot_at) = (monitor.port(), format!("127.0.0.1:{}", pilot.port()));
    // The pilot runs in lockstep and the monitor does not, so its absence must not stop the flight.
    let calls = ["--gcs", &pilot_at, "--lockstep", &pilot_at, "--monitor-port", &monitor_port, "--speed", "8"];
    let sim = Process::start(&[&["sim", "--ports", "ephemeral"], &job[..], &calls[..]].concat());

    let session = PathBuf::from(monitor.announced["session"].as_str().unwrap());
    let log = session.join("telemetry.tlog");
    let flying = || std::fs::read_to_string(session.join("events.jsonl")).is_ok_and(|events| events.contains("lift"));
    while !flying() {
        assert!(monitor.child.try_wait().unwrap().is_none(), "the monitor ended before lift-off");
        std::thread::yield_now();
    }
    monitor.child.kill().unwrap();
    monitor.child.wait().unwrap();
    let before = std::fs::read(&log).unwrap();

    let session_text = session.display().to_string();
    let again = Process::start(&["monitor", "--port", &monitor_port, "--session", &session_text]);
    assert!(again.exits_successfully(), "the second monitor failed");
    let whole = spandrel_mavlink::telemetry::tlog::complete_len(&before);
    assert_eq!(std::fs::read(&log).unwrap()[..whole], before[..whole], "received data was lost");
    assert_eq!(json(&session.join("session.json"))["monitor_starts"], 2);
    assert_eq!(json(&session.join("assessment.json"))["end"]["reason"], "landed");
    let (_, report) = pilot.finish();
    assert!(report.contains("landed"), "{report}");
    assert!(sim.finish().0);
}

#[test]
fn wire_lost_lockstep_peer_ends_the_run_with_a_reason() {
    let socket = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    let peer = socket.local_addr().unwrap().to_string();
    let sim = Command::new(PROGRAM)
        .args(["sim", "--ports", "ephemeral", "--scenario", "drill-hover", "--seed", "1", "--gcs", &peer, "--lockstep", &peer])
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // Sends one response, which starts lockstep, and no further ones.
    let mut bytes = [0u8; 2048];
    let (token, from) = loop {
        let (len, from) = socket.recv_from(&mut bytes).unwrap();
        let asked = Decoder::new().datagram(&bytes[..len]).into_iter().find_map(|frame| match frame.message {
            Some(MavMessage::TIMESYNC(sync)) if sync.tc1 == 0 => Some(sync.ts1),
            _ => None,
        });
        if let Some(token) = asked {
            break (token, from);
        }
    };
    let answer = MavMessage::TIMESYNC(TIMESYNC_DATA { tc1: 1, ts1: token, ..Default::default() });
    socket.send_to(&Encoder::new(255, 190).encode(&answer), from).unwrap();
    let output = sim.wait_with_output().unwrap();
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(err.contains("has not answered TIMESYNC"), "{err}");
}

#[test]
fn wire_same_seed_gives_the_same_digest_without_clients() {
    let run = |seed: &str| {
        stdout_of(&[
            "sim",
            "--ports",
            "ephemeral",
            "--speed",
            "max",
            "--end-after",
            "5",
            "--digest",
            "--scenario",
            "drill-hover",
            "--seed",
            seed,
        ])
    };
    let digest = run("3");
    assert_eq!(digest.trim().len(), 64, "{digest}");
    assert_eq!(digest, run("3"));
    assert_ne!(digest, run("4"));
}

#[cfg(target_os = "linux")]
#[test]
fn wire_children_end_when_their_parent_is_killed() {
    let sessions = tempfile::tempdir().unwrap();
    let mut command = demo(sessions.path(), "9");
    let mut parent = command.args(["--log", "error"]).spawn().unwrap();
    let children = |of: u32| {
        let text = std::fs::read_to_string(format!("/proc/{of}/task/{of}/children")).unwrap_or_default();
        text.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    let mut family = children(parent.id());
    while family.len() < 3 {
        assert!(parent.try_wait().unwrap().is_none(), "the demo ended early");
        family = children(parent.id());
        std::thread::yield_now();
    }
    parent.kill().unwrap();
    parent.wait().unwrap();
    // A zombie without a parent is reaped by init; a running process keeps its command line.
    let alive = |pid: &String| std::fs::read(format!("/proc/{pid}/cmdline")).is_ok_and(|line| !line.is_empty());
    while family.iter().any(alive) {
        std::thread::yield_now();
    }
}
