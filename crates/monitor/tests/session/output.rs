//! Tests of the names that external tools rely on: JSON keys and CSV columns.

use serde_json::Value;
use spandrel_monitor::export::{self, ScenarioExport};
use spandrel_testkit::job::*;

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// Checks that these keys exist, in this order.
fn check_keys(value: &Value, wanted: &[&str]) {
    let kept: Vec<&str> = keys(value).into_iter().filter(|key| wanted.contains(key)).collect();
    assert_eq!(kept, wanted);
}

#[test]
fn exact_assessment_json_keys_are_stable() {
    let mut tape = clean_flight();
    tape.contact(0);
    let value = serde_json::to_value(&score_tape(&tape, &one_task()).assessment).unwrap();
    assert_eq!(
        keys(&value),
        [
            "profile",
            "scores",
            "completion",
            "tasks",
            "crashes",
            "snapshots",
            "end",
            "telemetry",
            "flown_by",
            "practice_aids",
            "certification"
        ]
    );
    assert_eq!(value["profile"], "paper");
    check_keys(&value["scores"], &["conformity", "efficiency", "safety", "accuracy", "overall"]);
    assert_eq!(keys(&value["scores"]["conformity"]), ["raw", "pct"]);
    assert!(value["scores"]["overall"].is_number());
    assert_eq!(
        keys(&value["tasks"][0]),
        ["id", "attempted", "state", "covered", "first_frame", "last_frame", "on_path", "speeding"]
    );
    let completion = ["complete", "tasks_done", "tasks", "path_share", "landed_at_home", "done_share"];
    assert_eq!(keys(&value["completion"]), completion);
    assert_eq!(keys(&value["crashes"]), ["other", "person", "vehicle", "by_task"]);
    assert_eq!(keys(&value["crashes"]["by_task"]), ["1", "outside"]);
    let snapshots = ["taken", "hits", "defects_found", "defects_placed", "precision", "recall", "f_beta"];
    check_keys(&value["snapshots"], &snapshots);
    assert_eq!(keys(&value["end"]), ["reason", "frames", "seconds", "battery_failed"]);
    check_keys(&value["telemetry"], &["missing_frames"]);
    assert_eq!(value["end"]["reason"], "landed");
}

/// The intervals are in order, and each frame is in exactly one of them. A frame's control source is that of the last
/// preceding heartbeat.
#[test]
fn exact_assessment_lists_control_source_intervals() {
    let mut tape = Tape::new();
    tape.beat(true, 3 << 16);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.beat(true, 4 << 24 | 4 << 16);
    tape.hold(2.0);
    tape.beat(true, 3 << 16);
    tape.hold(1.0);
    tape.land();
    let value = serde_json::to_value(&score_tape(&tape, &one_task()).assessment).unwrap();
    let stretches = value["flown_by"].as_array().unwrap();
    let by: Vec<&str> = stretches.iter().map(|s| s["by"].as_str().unwrap()).collect();
    assert_eq!(by, ["pilot", "mission", "pilot"]);
    let frames = |s: &Value, key: &str| s[key].as_u64().unwrap();
    assert_eq!(frames(&stretches[0], "from_frame"), 1);
    assert!(stretches.windows(2).all(|pair| frames(&pair[0], "to_frame") + 1 == frames(&pair[1], "from_frame")));
    assert_eq!(frames(&stretches[2], "to_frame"), value["end"]["frames"].as_u64().unwrap());
    let two_seconds = (2.0 * one_task().scoring.frame_rate_hz) as u64;
    let flown = frames(&stretches[1], "to_frame") + 1 - frames(&stretches[1], "from_frame");
    assert!(flown.abs_diff(two_seconds) <= 1, "{flown}");
}

#[test]
fn exact_job_without_defects_is_scored_out_of_300() {
    let empty = |_: &spandrel_model::scenario::Scenario,
                 _: u64|
     -> std::sync::Arc<dyn spandrel_monitor::measures::attention::SiteSurvey> {
        std::sync::Arc::new(TestSurvey::of(0))
    };
    let log = clean_flight().log(0);
    let assessed_session = spandrel_monitor::assess_log(&log, &one_task(), &vehicle(), empty).unwrap();
    let value = serde_json::to_value(&assessed_session.assessment).unwrap();
    assert!(value["scores"]["accuracy"].is_null() && value["snapshots"]["f_beta"].is_null());
    assert_eq!((&value["scores"]["overall"], &value["scores"]["overall_max"]), (&300.0.into(), &300.0.into()));
}

#[test]
fn exact_frames_csv_columns_are_stable_and_numbers_round_trip() {
    let mut tape = Tape::new();
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.snapshot(0);
    tape.lamp(true);
    tape.contact(1);
    tape.hold(0.2);
    tape.contact(0);
    tape.land();
    let rows = export::frame_rows(&tape.log(0), &one_task(), &vehicle()).unwrap();
    let frames = score_tape(&tape, &one_task()).frames;
    assert!(rows.iter().map(|row| &row.frame).eq(&frames), "the exported frames equal the scored frames");
    let csv = export::frames_csv(&rows);
    let mut lines = csv.lines();
    // The names and order of released columns never change, because other tools read them by position.
    let released = "frame,t_s,fb,rl,ud,rt,light,snapshot,east_m,north_m,up_m,speed_m_s,battery_pct,contact,missing,";
    assert!(lines.next().unwrap().starts_with(released));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), frames.len());
    for (row, frame) in rows.iter().zip(&frames) {
        assert_eq!(row.len(), export::COLUMNS.len());
        assert_eq!(row[0], frame.index.to_string());
        assert_eq!(row[8].parse::<f64>().unwrap().to_bits(), frame.position_m.east().to_bits());
        assert_eq!(row[11].parse::<f64>().unwrap().to_bits(), frame.speed_m_s().to_bits());
    }
    assert_eq!(rows[0][1], "0");
    assert_eq!(rows.iter().filter(|row| row[7] == "1").count(), 1, "a picture is marked in one frame only");
    assert!(rows.iter().any(|row| row[13] == "bridge") && rows.iter().any(|row| row[6] == "1"));
    assert!(rows.iter().all(|row| (-1.0..=1.0).contains(&row[2].parse::<f64>().unwrap())));
}

#[test]
fn exact_scenario_export_json_keys_are_stable() {
    let mut scenario = one_task();
    scenario.scoring.beta = f64::INFINITY;
    let value = serde_json::to_value(ScenarioExport::new(&scenario, &TestSurvey::of(2).defects)).unwrap();
    let top =
        ["name", "frame_rate_hz", "speed_limit_m_s", "max_speed_m_s", "time_best_s", "time_max_s", "beta", "tasks", "defects"];
    check_keys(&value, &top);
    assert_eq!(value["beta"], "inf");
    check_keys(&value["tasks"][0], &["id", "name", "threshold_m", "closed", "path_enu_m"]);
    check_keys(&value["defects"][0], &["id", "element", "kind", "position_enu_m", "normal_enu", "size_m"]);
    assert_eq!(value["certification"]["min_battery_pct"], 20.0);
    assert_eq!(value["tasks"][0]["path_enu_m"][0], serde_json::json!([10.0, 0.0, 10.0]));
}
