//! `spandrel assess` with logs from other sources: not a log, without a seed, cut off, or of another aircraft.

use spandrel_mavlink::dialect::{MavMessage, NAMED_VALUE_INT_DATA};
use spandrel_mavlink::telemetry::tlog::{self, TlogReader};
use std::path::Path;
use std::process::Command;

const PROGRAM: &str = env!("CARGO_BIN_EXE_spandrel");
const SEED: &str = "5";

/// Runs `assess` on a log of the landing drill. Returns the exit code, the JSON and the messages.
fn assess(log: &Path, vehicle: &str, more: &[&str]) -> (Option<i32>, String, String) {
    let mut command = Command::new(PROGRAM);
    let job: &[&str] = if more.contains(&"--scenario") { &[] } else { &["--scenario", "drill-landing"] };
    command.arg("assess").arg(log).args(job).args(["--vehicle", vehicle, "--json", "-"]).args(more);
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

/// Flies the landing drill. Returns its log and its scores.
fn flown(folder: &Path) -> (Vec<u8>, String) {
    flown_job(folder, &["--scenario", "drill-landing"])
}

/// Flies a short job. Returns its log and its scores.
fn flown_job(folder: &Path, job: &[&str]) -> (Vec<u8>, String) {
    let sessions = folder.join("sessions");
    let demo = ["demo", "--seed", SEED, "--speed", "max", "--log", "warn", "--sessions"];
    let output = Command::new(PROGRAM).args(demo).arg(&sessions).args(job).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let session = std::fs::read_dir(&sessions).unwrap().next().unwrap().unwrap().path();
    (std::fs::read(session.join("telemetry.tlog")).unwrap(), std::fs::read_to_string(session.join("assessment.json")).unwrap())
}

/// Returns whether a frame is the named value with the flight's seed.
fn is_seed(frame: &[u8]) -> bool {
    let messages = spandrel_mavlink::codec::Decoder::new().datagram(frame);
    messages.iter().filter_map(|frame| frame.message.as_ref()).any(
        |message| matches!(message, MavMessage::NAMED_VALUE_INT(NAMED_VALUE_INT_DATA { name, .. }) if name.to_str() == Ok("seed")),
    )
}

#[test]
fn wire_files_that_are_not_telemetry_logs_are_named_as_such() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes, found) in [
        ("empty.tlog", &b""[..], "the file is empty"),
        ("frames.csv", b"time_s,north_m\n0.0,1.0\n", "the file contains text"),
        ("flight.bin", &[0xA3, 0x95, 0x80, 0x00].repeat(50), "the file contains no MAVLink messages"),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let (code, out, err) = assess(&path, "phantom2", &[]);
        assert_eq!((code, out.as_str()), (Some(2), ""), "{name}: {err}");
        for needle in [name, "not a telemetry log", found, "8-byte timestamp"] {
            assert!(err.contains(needle), "{name}: {err}");
        }
    }
}

#[test]
fn wire_foreign_logs_are_scored_with_their_seed_and_warnings() {
    let folder = tempfile::tempdir().unwrap();
    let (log, scores) = flown(folder.path());
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };

    let whole = write("whole.tlog", &log);
    assert_eq!(assess(&whole, "phantom2", &[]), (Some(0), scores.clone(), String::new()));
    assert_eq!(assess(&whole, "phantom2", &["--seed", SEED]), (Some(0), scores.clone(), String::new()));
    let (code, _, err) = assess(&whole, "phantom2", &["--seed", "6"]);
    assert!(code == Some(2) && err.contains("whole.tlog: the flight's seed is 5: omit --seed"), "{code:?}: {err}");

    let kept = TlogReader::new(&log).filter(|record| !is_seed(record.frame));
    let unseeded: Vec<u8> = kept.flat_map(|record| tlog::record(record.timestamp_us, record.frame)).collect();
    assert!(unseeded.len() < log.len());
    let unseeded = write("unseeded.tlog", &unseeded);
    let (code, _, err) = assess(&unseeded, "phantom2", &[]);
    assert!(code == Some(2) && err.contains("unseeded.tlog") && err.contains("--seed N"), "{code:?}: {err}");
    assert_eq!(assess(&unseeded, "phantom2", &["--seed", SEED]), (Some(0), scores.clone(), String::new()));

    let cut = write("cut.tlog", &log[..log.len() - 1]);
    let left_over = log.len() - 1 - tlog::complete_len(&log[..log.len() - 1]);
    let (code, _, err) = assess(&cut, "phantom2", &[]);
    let warning = format!("cut.tlog: the last {left_over} bytes are not a complete record");
    assert!(code == Some(0) && left_over > 0 && err.contains(&warning), "{code:?}: {err}");

    let (code, _, err) = assess(&whole, "elios3", &[]);
    assert!(code == Some(0) && err.contains("was not 'elios3'"), "{code:?}: {err}");
    assert!(err.contains("84.0 deg in the log, but 98.0 deg in the vehicle file"), "{err}");
}

#[test]
fn wire_log_of_another_form_is_scored_with_the_form_that_was_flown() {
    let folder = tempfile::tempdir().unwrap();
    let job = folder.path().join("job.toml");
    let forms: String =
        ["A", "B"].map(|name| format!("\n[[forms]]\nname = \"{name}\"\ndefect_seed = 1\ndetection_pct = 75.0\n")).concat();
    let (_, drill) = spandrel_model::shipped::SCENARIOS.iter().find(|(name, _)| *name == "drill-landing").unwrap();
    // A job has either forms or difficulty levels.
    let drill = drill.split("[difficulty]").next().unwrap();
    std::fs::write(&job, drill.to_owned() + &forms).unwrap();
    let job = job.display().to_string();
    let (log, scores) = flown_job(folder.path(), &["--scenario", &job, "--form", "B"]);
    let path = folder.path().join("b.tlog");
    std::fs::write(&path, log).unwrap();
    let score = |form: &[&str]| assess(&path, "phantom2", &[&["--scenario", &job], form].concat());
    let (code, out, err) = score(&[]);
    assert_eq!((code, out), (Some(0), scores), "{err}");
    assert_eq!(score(&["--form", "B"]).0, Some(0));
    let (code, _, err) = score(&["--form", "A"]);
    assert!(code == Some(2) && err.contains("use the flight's scenario"), "{code:?} {err}");
}
