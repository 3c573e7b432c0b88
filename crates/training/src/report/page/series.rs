//! The data block for the page's script: time series, marks, reference paths and the 3D model. The JSON contains no
//! `<`, so it cannot end the surrounding script element.

use crate::report::Review;
use crate::report::assets::base64;
use crate::report::mesh::{self, QuantizedMesh};
use crate::report::plots::colors::CLEARANCE_LIMITS_M;
use serde_json::{Value, json};
use spandrel_mavlink::telemetry::Frame;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_text::{Language, text};

/// Maximum sampling rate of the time series, Hz.
const MAX_SAMPLE_RATE_HZ: f64 = 10.0;
/// Maximum number of samples in a time series.
const MAX_SAMPLES: usize = 15_000;
/// Number of terrain samples along each side of the 3D model.
const TERRAIN_SAMPLES: usize = 72;
/// Distance between a defect's mark and the surface along the normal, m. It makes the mark invisible from the other
/// side.
const DEFECT_MARK_OFFSET_M: f64 = 0.5;

/// Returns a session report's data block as JSON.
#[must_use]
pub fn data(review: &Review) -> String {
    let block = json!({
        "series": series(review),
        "limits": { "speed": review.scenario.scoring.speed_limit_m_s, "close": review.scenario.feedback.too_close_m,
            "clearances": CLEARANCE_LIMITS_M },
        "tasks": review.scenario.tasks.iter().enumerate().map(|(k, task)| json!({ "id": task.id, "name": review.task_name(k, review.metadata.language), "within": task.threshold_m,
            "closed": task.closed, "path": task.path_m.iter().map(|p| place(*p)).collect::<Vec<_>>() })).collect::<Vec<_>>(),
        "pictures": review.pictures.iter().map(|picture| json!({ "number": picture.number, "t": round_to_digits(picture.t_s, 2),
            "at": place(picture.pose.position_m), "look": place(picture.pose.forward), "verdict": picture.verdict.class() })).collect::<Vec<_>>(),
        "crashes": review.crashes.iter().map(|crash| place(review.frames[crash.frame].position_m)).collect::<Vec<_>>(),
        "defects": review.defects.iter().map(|defect_outcome| json!({ "id": defect_outcome.defect.id, "at": place(defect_outcome.defect.position_m + defect_outcome.defect.normal * DEFECT_MARK_OFFSET_M),
            "found": defect_outcome.found_by.is_some() })).collect::<Vec<_>>(),
        "mesh": mesh(&mesh::mesh(review.site.members())),
        "ground": ground(review),
        "texts": texts(review.metadata.language),
    });
    escape_json(&block.to_string())
}

/// Returns the texts that the session report's script shows. It replaces `%moment`, `%task` and `%path`.
fn texts(language: Language) -> Value {
    json!({
        "play": text!(language, "report-flight-play"),
        "pause": text!(language, "report-flight-pause"),
        "states": [
            text!(language, "report-between-tasks"),
            text!(language, "report-off-path"),
            text!(language, "report-on-path"),
        ],
        "slider": text!(language, "report-flight-slider", moment = "%moment", task = "%task", path = "%path"),
        "model": text!(language, "report-flight-3d-label"),
    })
}

/// Returns the texts that the comparison's script shows. It replaces `%session` and `%task`.
fn comparison_texts(language: Language) -> Value {
    json!({
        "play": text!(language, "report-flight-play"),
        "pause": text!(language, "report-flight-pause"),
        "notFlying": text!(language, "compare-not-flying"),
        "slider": text!(language, "compare-slider", session = "%session", task = "%task"),
    })
}

/// Returns a comparison's data block as JSON: the time series of both flights and the events that can be used to align
/// them.
#[must_use]
pub fn comparison(both: [&Review; 2], alignment_events: &[AlignmentEvent]) -> String {
    let flight = |k: usize| {
        let starts: Vec<f64> = alignment_events.iter().map(|line_up| line_up.at_s[k]).collect();
        let tasks = both[k]
            .scenario
            .tasks
            .iter()
            .enumerate()
            .map(|(task, one)| format!("{} · {}", one.id, both[k].task_name(task, both[k].metadata.language)));
        json!({ "series": series(both[k]), "starts": starts, "tasks": tasks.collect::<Vec<_>>() })
    };
    let scenario = &both[0].scenario;
    let block = json!({
        "flights": [flight(0), flight(1)],
        "limits": { "speed": scenario.scoring.speed_limit_m_s, "close": scenario.feedback.too_close_m },
        "texts": comparison_texts(both[0].metadata.language),
    });
    escape_json(&block.to_string())
}

/// An event in both flights that can be used to align them in time.
#[derive(Debug, Clone, PartialEq)]
pub struct AlignmentEvent {
    /// Name of the event, shown in the alignment menu.
    pub name: String,
    /// Time of the event in each flight, s since lift-off.
    pub at_s: [f64; 2],
}

/// Returns lift-off and, if both flights are from the same job, the start of each task that both entered.
#[must_use]
pub fn alignment_events(both: [&Review; 2], same_job: bool) -> Vec<AlignmentEvent> {
    let language = both[0].metadata.language;
    let mut found = vec![AlignmentEvent { name: text!(language, "compare-lift-off"), at_s: [0.0, 0.0] }];
    let tasks = both[0].scenario.tasks.iter().enumerate().filter(|_| same_job);
    found.extend(tasks.filter_map(|(k, task)| {
        let entry_s = |review: &Review| review.on_path.windows.get(k).copied().flatten().map(|window| review.t_s(window.first));
        let name = text!(language, "compare-start-of-task", task = task.id);
        Some(AlignmentEvent { name, at_s: [entry_s(both[0])?, entry_s(both[1])?] })
    }));
    found
}

/// Escapes `<` in JSON so that the text cannot end the surrounding script element.
fn escape_json(json: &str) -> String {
    json.replace('<', "\\u003c")
}

fn series(review: &Review) -> Value {
    let rate_hz = review.scenario.scoring.frame_rate_hz;
    let stride = ((rate_hz / MAX_SAMPLE_RATE_HZ).round() as usize).max(review.frames.len().div_ceil(MAX_SAMPLES)).max(1);
    let picked: Vec<(usize, &Frame)> = review.frames.iter().enumerate().step_by(stride).collect();
    let column = |value: &dyn Fn(usize, &Frame) -> Value| picked.iter().map(|(i, frame)| value(*i, frame)).collect::<Vec<_>>();
    let at = |k: usize| move |_: usize, frame: &Frame| round_to_digits(frame.position_m.array()[k], 2);
    let stick = |k: usize| move |_: usize, frame: &Frame| round_to_digits(frame.sticks[k], 2);
    let known = |value: Option<f64>| value.map_or(Value::Null, |value| round_to_digits(value, 2));
    json!({
        "t": column(&|i, _| round_to_digits(review.t_s(i), 2)),
        "e": column(&at(0)), "n": column(&at(1)), "u": column(&at(2)),
        "speed": column(&|_, frame| round_to_digits(frame.speed_m_s(), 2)),
        "distance": column(&|i, _| known(review.track[i].distance_m)),
        "clearance": column(&|_, frame| known(frame.clearance_m)),
        "battery": column(&|_, frame| round_to_digits(frame.battery_pct, 1)),
        "wind": column(&|i, _| known(review.wind(i).map(|(speed_m_s, _)| speed_m_s))),
        "wind_from": column(&|i, _| review.wind(i).map_or(Value::Null, |(_, from_deg)| round_to_digits(from_deg, 0))),
        "fb": column(&stick(0)), "rl": column(&stick(1)), "ud": column(&stick(2)), "rt": column(&stick(3)),
        "task": column(&|i, _| review.track[i].task.map_or(Value::Null, |task| json!(task))),
        "state": column(&|i, _| json!(u8::from(review.track[i].inside) + u8::from(review.track[i].on))),
    })
}

fn mesh(mesh: &QuantizedMesh) -> Value {
    let bytes = |triples: &[[u16; 3]]| triples.iter().flatten().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    json!({ "origin": mesh.origin_m, "step": mesh.step_m, "corners": base64(&bytes(&mesh.corners)),
        "triangles": base64(&bytes(&mesh.triangles)) })
}

/// Returns terrain heights in meters over a square around the origin, row by row from the southwest corner.
fn ground(review: &Review) -> Value {
    let half = 0.5 * review.scenario.terrain.size_m;
    let coordinate = |k: usize| -half + 2.0 * half * k as f64 / (TERRAIN_SAMPLES - 1) as f64;
    let heights = (0..TERRAIN_SAMPLES).flat_map(|row| (0..TERRAIN_SAMPLES).map(move |column| (row, column)));
    let heights: Vec<Value> =
        heights.map(|(row, column)| round_to_digits(review.site.ground_up_m(coordinate(column), coordinate(row)), 1)).collect();
    json!({ "half": half, "side": TERRAIN_SAMPLES, "heights": heights, "water": review.scenario.terrain.water_level_m })
}

fn place(point: Vec3<Enu>) -> [Value; 3] {
    point.array().map(|value| round_to_digits(value, 2))
}

/// Rounds a value to `digits` decimals (0 to 2) to keep the data block small.
fn round_to_digits(value: f64, digits: i32) -> Value {
    let scale = match digits {
        0 => 1.0,
        1 => 10.0,
        _ => 100.0,
    };
    // JSON cannot represent NaN or infinity; both become null.
    json!((value * scale).round() / scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_data_block_is_escaped_and_round_trips() {
        let evil = json!({ "name": "</script><script>alert(1)</script><!--" });
        let text = escape_json(&evil.to_string());
        assert!(!text.contains('<'));
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), evil);
        assert_eq!(round_to_digits(1.005, 1), json!(1.0));
        assert_eq!(round_to_digits(f64::INFINITY, 2), Value::Null);
    }
}
