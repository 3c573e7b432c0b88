//! Prints the assessment from its JSON. Numbers are rounded only for this output.

use super::invocation::typed;
use crate::errors::AppError;
use crate::io::report;
use serde::Deserialize;
use serde_json::Value;
use spandrel_monitor::folder::REPORT;
use spandrel_monitor::score::certification::requirements::Requirement;
use spandrel_monitor::score::completion::{self, Completion, TaskState};
use spandrel_text::Language;
use spandrel_training::advice::SessionAdvice;
use std::fmt::Write;
use std::path::Path;

/// Prints a session's location and the address of its report.
pub fn print_locations(session: &Path) {
    println!("session       {}", session.display());
    let page = session.join(REPORT);
    if page.is_file() {
        println!("report        {}", report::address(&page));
    }
}

/// Prints a session's scores and the location of its files.
///
/// # Errors
/// Returns an error if the session has no assessment.
pub fn report_outcome(session: &Path) -> Result<(), AppError> {
    let path = session.join(spandrel_monitor::folder::ASSESSMENT);
    let text = std::fs::read_to_string(&path)
        .map_err(|_| AppError::failed(format!("the session was not scored; the recorded data is in {}", session.display())))?;
    let assessment = serde_json::from_str(&text).map_err(|error| AppError::failed(format!("{}: {error}", path.display())))?;
    print!("{}", scores_text(&assessment, report::saved_advice(session).as_ref()));
    print_locations(session);
    Ok(())
}

/// Formats a session's advice, scores, tasks, crashes, pictures and end as text.
pub fn scores_text(assessment: &Value, advice: Option<&SessionAdvice>) -> String {
    let mut out = String::new();
    let scores = &assessment["scores"];
    let completion = Completion::deserialize(&assessment["completion"]).ok();
    let complete = completion.is_none_or(|completion| completion.complete);
    if let Some(completion) = completion {
        let _ = writeln!(out, "{}", completion.headline(Language::English));
    }
    if !complete {
        verdict(&mut out, &assessment["certification"]);
    }
    if let Some(advice) = advice {
        to_do_better(&mut out, advice);
    }
    if !complete {
        let _ = writeln!(out, "\nscores for the completed part of the flight:");
    } else if advice.is_some() {
        let _ = writeln!(out);
    }
    let _ = writeln!(out, "{:<14}{:>8}{:>11}", "score", "raw", "of 100");
    for name in ["conformity", "efficiency", "safety", "accuracy"] {
        let _ = match (number(&scores[name]["raw"]), number(&scores[name]["pct"])) {
            (Some(raw), Some(pct)) => writeln!(out, "{name:<14}{raw:>8.2}{pct:>11.2}"),
            _ => writeln!(out, "{name:<14}{:>19}", "not applicable"),
        };
    }
    if complete && let (Some(overall), Some(most)) = (number(&scores["overall"]), number(&scores["overall_max"])) {
        let _ = writeln!(out, "{:<14}{:>8}{overall:>11.2}  of {most:.0}", "overall", "");
        verdict(&mut out, &assessment["certification"]);
    }
    tasks(&mut out, assessment);
    crashes(&mut out, &assessment["crashes"]);
    picture_table(&mut out, &assessment["snapshots"]);
    end(&mut out, assessment);
    requirements(&mut out, &assessment["certification"]["requirements"]);
    out
}

/// Lists what to do better, and the scenario to fly next.
fn to_do_better(out: &mut String, advice: &SessionAdvice) {
    let _ = writeln!(out, "\nto do better:");
    for (k, words) in advice.sentences().enumerate() {
        let _ = if advice.points.len() > 1 { writeln!(out, "{}. {words}", k + 1) } else { writeln!(out, "{words}") };
    }
    if let Some(next) = &advice.next {
        let _ = writeln!(out, "next flight   {}", typed(&next.command));
    }
}

/// Lists every requirement of the certification profile with its limit and the value reached.
fn requirements(out: &mut String, requirements: &Value) {
    let Ok(requirements) = Vec::<Requirement>::deserialize(requirements) else { return };
    if requirements.is_empty() {
        return;
    }
    let _ = writeln!(out, "\n{:<30}{:<16}needed", "certification", "reached");
    for one in requirements {
        let state = if one.met { "met" } else { "not met" };
        let _ = writeln!(
            out,
            "{:<30}{:<16}{:<22}{state}",
            one.title(Language::English),
            one.reached_text(Language::English),
            one.limit_text(Language::English)
        );
    }
}

fn verdict(out: &mut String, certification: &Value) {
    if let Some(passed) = certification["passed"].as_bool() {
        let unmet = Vec::<String>::deserialize(&certification["unmet"]).unwrap_or_default();
        let _ = writeln!(out, "{}", completion::verdict(passed, &unmet, Language::English));
    }
}

fn tasks(out: &mut String, assessment: &Value) {
    let done_share = number(&assessment["completion"]["done_share"]).unwrap_or_default();
    for task in assessment["tasks"].as_array().into_iter().flatten() {
        let id = task["id"].as_u64().unwrap_or_default();
        let state = TaskState::deserialize(&task["state"]).ok().zip(number(&task["covered"]));
        let state = state
            .map_or(String::new(), |(state, covered)| format!("{}, ", state.description(covered, done_share, Language::English)));
        let _ = match (task["attempted"].as_bool(), number(&task["on_path"]), number(&task["speeding"])) {
            (Some(true), Some(on_path), Some(speeding)) => {
                writeln!(out, "task {id}        {state}on path {:.1}% of the time, speeding loss {speeding:.3}", 100.0 * on_path)
            }
            _ => writeln!(out, "task {id}        not attempted"),
        };
    }
}

fn crashes(out: &mut String, crashes: &Value) {
    let count = |key: &str| crashes[key].as_u64().unwrap_or_default();
    let mut places = Vec::new();
    for (place, number) in crashes["by_task"].as_object().into_iter().flatten() {
        if number.as_u64().is_some_and(|number| number > 0) {
            let place = if place.parse::<u32>().is_ok() { format!("task {place}") } else { place.clone() };
            places.push(format!("{place}: {number}"));
        }
    }
    let places = if places.is_empty() { String::new() } else { format!(" ({})", places.join(", ")) };
    let (other, person, vehicle) = (count("other"), count("person"), count("vehicle"));
    let _ = writeln!(
        out,
        "crashes       {other} with structures or the ground, {person} with people, {vehicle} with vehicles{places}"
    );
}

fn picture_table(out: &mut String, snapshots: &Value) {
    let count = |key: &str| snapshots[key].as_u64().unwrap_or_default();
    let (taken, hits, found, placed) = (count("taken"), count("hits"), count("defects_found"), count("defects_placed"));
    let _ = writeln!(out, "snapshots     {taken} taken, {hits} with defects; {found} of {placed} defects found");
}

fn end(out: &mut String, assessment: &Value) {
    let end = &assessment["end"];
    let seconds = number(&end["seconds"]).unwrap_or_default();
    let reason = end["reason"].as_str().unwrap_or("unknown");
    let missing = assessment["telemetry"]["missing_frames"].as_u64().unwrap_or_default();
    let minutes = (seconds / 60.0).floor();
    let _ = writeln!(
        out,
        "end           {reason} after {minutes:.0} min {:.0} s of flight, {missing} missing frames",
        seconds - 60.0 * minutes
    );
}

fn number(value: &Value) -> Option<f64> {
    value.as_f64()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn exact_scores_table_rounds_numbers() {
        let assessment = json!({
            "completion": {"complete": true, "tasks_done": 2, "tasks": 2, "path_share": 0.914, "landed_at_home": true, "done_share": 0.8},
            "certification": {"passed": false, "unmet": ["12% battery at landing, 20% needed"]},
            "scores": {"conformity": {"raw": 62.126, "pct": 81.0625}, "efficiency": {"raw": 100.0, "pct": 100.0},
                "safety": {"raw": -9.0, "pct": 91.0}, "accuracy": null, "overall": 272.0625, "overall_max": 300.0},
            "tasks": [{"id": 1, "attempted": true, "state": "done", "covered": 0.93, "on_path": 0.875, "speeding": 0.25}],
            "crashes": {"other": 3, "person": 0, "vehicle": 0, "by_task": {"1": 2, "outside": 1, "2": 0}},
            "snapshots": {"taken": 5, "hits": 3, "defects_found": 4, "defects_placed": 10},
            "end": {"reason": "landed", "frames": 22500, "seconds": 750.0}, "telemetry": {"missing_frames": 0}
        });
        let expected = "\
Complete: 2 of 2 tasks, 91% of the path
score              raw     of 100
conformity       62.13      81.06
efficiency      100.00     100.00
safety           -9.00      91.00
accuracy           not applicable
overall                    272.06  of 300
Not certified: 12% battery at landing, 20% needed
task 1        done (93% of path), on path 87.5% of the time, speeding loss 0.250
crashes       3 with structures or the ground, 0 with people, 0 with vehicles (task 1: 2, outside: 1)
snapshots     5 taken, 3 with defects; 4 of 10 defects found
end           landed after 12 min 30 s of flight, 0 missing frames
";
        assert_eq!(scores_text(&assessment, None), expected);
    }

    #[test]
    fn exact_advice_follows_the_headline() {
        let advice: SessionAdvice = serde_json::from_value(json!({
            "points": [{"words": "You left the path.", "rule": "off the path in one task", "frame": 31, "t_s": 1.0, "drill": "drill-hover"},
                {"words": "You hit the bridge once.", "rule": "crashes in one task", "frame": 61, "t_s": 2.0, "drill": "drill-orbit"}],
            "next": {"scenario": "drill-hover", "command": "spandrel train --trainee anna --scenario drill-hover"}
        }))
        .unwrap();
        let completion =
            json!({"complete": true, "tasks_done": 2, "tasks": 2, "path_share": 0.9, "landed_at_home": true, "done_share": 0.8});
        let expected = "\
Complete: 2 of 2 tasks, 90% of the path

to do better:
1. You left the path.
2. You hit the bridge once.
next flight   spandrel train --trainee anna --scenario drill-hover

score              raw     of 100
";
        let text = scores_text(&json!({"completion": completion}), Some(&advice));
        assert!(text.starts_with(expected), "{text}");
        let note = SessionAdvice { note: Some("Nothing to correct: fly the next job.".into()), ..SessionAdvice::default() };
        let text = scores_text(&json!({"completion": completion}), Some(&note));
        assert!(text.contains("\nto do better:\nNothing to correct: fly the next job.\n\nscore"), "{text}");
    }

    #[test]
    fn exact_requirements_are_listed_with_limit_and_value() {
        let requirement = |id: &str, unit: &str, kind: &str, limit: f64, reached: Value, met: bool| json!({"id": id, "name": id, "unit": unit, "kind": kind, "limit": limit, "reached": reached, "applies": true, "met": met});
        let mut text = String::new();
        let list = [
            requirement("battery", "%", "at_least", 20.0, json!(19.6), false),
            requirement("contact_speed", "m/s", "at_most", 1.0, json!(0.4), true),
            requirement("conformity", "points", "at_least", 75.0, Value::Null, false),
        ];
        requirements(&mut text, &json!(list));
        let expected = "
certification                 reached         needed
battery at landing            19.6%           at least 20%          not met
fastest contact               0.4 m/s         at most 1 m/s         met
coverage-weighted conformity  no evidence     at least 75 points    not met
";
        assert_eq!(text, expected);
    }

    #[test]
    fn regress_incomplete_sessions_have_no_overall_score() {
        let score = |pct: f64| json!({"raw": pct, "pct": pct});
        let assessment = json!({
            "completion": {"complete": false, "tasks_done": 0, "tasks": 2, "path_share": 0.31, "landed_at_home": true, "done_share": 0.8},
            "certification": {"passed": false, "unmet": ["task 1 not done: 64% of its path, 80% needed", "task 2 not attempted"]},
            "scores": {"conformity": score(50.0), "efficiency": score(100.0), "safety": score(100.0), "accuracy": null,
                "overall": 250.0, "overall_max": 300.0},
            "tasks": [{"id": 1, "attempted": true, "state": "part", "covered": 0.64, "on_path": 0.5, "speeding": 0.0},
                {"id": 2, "attempted": false, "state": "not_attempted", "covered": 0.0}],
        });
        let text = scores_text(&assessment, None);
        let start = "Incomplete: 0 of 2 tasks, 31% of the path\n\
            Not certified: task 1 not done: 64% of its path, 80% needed (and 1 more)\n\n\
            scores for the completed part of the flight:\n";
        assert!(text.starts_with(start), "{text}");
        let advice = SessionAdvice { note: Some("Fly it to the end.".into()), ..SessionAdvice::default() };
        let advised = scores_text(&assessment, Some(&advice));
        assert!(advised.contains("to do better:\nFly it to the end.\n\nscores for the completed part"), "{advised}");
        assert!(!text.contains("overall") && !text.contains("of 300") && text.contains("partly flown (64% of path)"), "{text}");
    }
}
