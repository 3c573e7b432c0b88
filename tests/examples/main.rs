//! The examples must run to completion and be shorter than sixty lines.
#![allow(clippy::unwrap_used, reason = "a test")]

#[path = "../../examples/custom_job.rs"]
mod custom_job;
#[path = "../../examples/hover.rs"]
mod hover;
#[path = "../../examples/score_tlog.rs"]
#[expect(dead_code, reason = "its main reads the command line")]
mod score_tlog;

/// Maximum number of lines in an example, so that it can be read at a glance.
const MAX_LINES: usize = 60;

#[test]
fn flight_hover_example_takes_off_and_lands() {
    hover::main().unwrap();
}

#[test]
fn val_custom_job_example_builds() {
    custom_job::main().unwrap();
}

#[test]
fn val_score_tlog_example_rejects_a_missing_log() {
    score_tlog::score(&[]).unwrap();
    let missing = ["none.tlog", "none.toml", "none.toml"].map(str::to_owned);
    assert!(score_tlog::score(&missing).is_err());
}

#[test]
fn exact_examples_are_short() {
    for name in ["custom_job", "hover", "score_tlog"] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("examples/{name}.rs"));
        let lines = std::fs::read_to_string(&path).unwrap().lines().count();
        assert!(lines <= MAX_LINES, "{name}: {lines} lines");
    }
}
