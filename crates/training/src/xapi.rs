//! Exports a session as xAPI statements (Experience API 1.0.3) for a learning record store (LRS). Statement IDs are
//! derived from the content, so sending a statement again doesn't duplicate it.

use super::record::{SessionOutcome, SessionRecord, TaskRecord};
use serde_json::{Value, json};
use spandrel_model::calendar::utc;
use spandrel_monitor::score::completion::TaskState;
use spandrel_text::Language;
use uuid::Uuid;

/// xAPI version to send in the request header.
pub const VERSION: &str = "1.0.3";
/// Default home page of the accounts that identify trainees by pseudonym.
pub const DEFAULT_ACCOUNT_HOME_PAGE: &str = "https://spandrel.invalid/trainees";
/// Namespace UUID for statement IDs (RFC 9562, version 5).
const STATEMENT_NAMESPACE: Uuid = Uuid::from_u128(0x7f0c_4e0a_93c1_4d43_9b0e_5d61_5c1e_7a10);
/// Key of the extension for job completion, in the results of the session and of its scores.
const COMPLETION_EXTENSION_KEY: &str = "urn:spandrel:completion";
/// Key of the session result extension for the certification.
const CERTIFICATION_EXTENSION_KEY: &str = "urn:spandrel:certification";
/// Key of the task result extension for the fraction of the task's path that was flown.
const COVERAGE_EXTENSION_KEY: &str = "urn:spandrel:covered";
/// Prefix of verb IDs in ADL's vocabulary.
const VERB_PREFIX: &str = "http://adlnet.gov/expapi/verbs/";

/// Returns all statements about a session: the flight, its scores, the attempted tasks, and the questionnaire answers.
#[must_use]
pub fn statements(record: &SessionRecord, home: &str) -> Vec<Value> {
    let mut out = vec![flight(record, home)];
    let scores = &record.scores;
    for (name, pct) in [
        ("conformity", scores.conformity),
        ("efficiency", Some(scores.efficiency)),
        ("safety", Some(scores.safety)),
        ("accuracy", scores.accuracy),
    ] {
        if let Some(pct) = pct {
            let mut result = json!({ "score": score(pct, 100.0), "completion": record.is_complete() });
            if let Some(completion) = &record.completion {
                result["extensions"] = json!({ COMPLETION_EXTENSION_KEY: completion });
            }
            out.push(statement(record, home, &format!("scores/{name}"), ("scored", name), result));
        }
    }
    out.extend(record.tasks.iter().filter(|task| task.attempted).map(|task| task_statement(record, home, task)));
    if let Some(answers) = &record.answers {
        for (item, answer) in &answers.given {
            let name = format!("questions/{item}");
            out.push(statement(record, home, &name, ("responded", &item.to_string()), json!({ "response": answer.to_string() })));
        }
    }
    out
}

fn flight(record: &SessionRecord, home: &str) -> Value {
    let complete = record.is_complete();
    let mut result = json!({
        "completion": complete,
        "success": complete && record.certified,
        "duration": format!("PT{:.2}S", record.seconds),
        "response": record.headlines(Language::English),
    });
    // The sum of the scores is meaningful only for a complete job.
    if complete {
        result["score"] = score(record.scores.overall, record.scores.overall_max);
    }
    if let Some(completion) = &record.completion {
        let certification = json!({ "passed": record.certified, "unmet": record.unmet, "scores": record.certification.as_ref().map(|one| one.scores) });
        result["extensions"] = json!({ COMPLETION_EXTENSION_KEY: completion, CERTIFICATION_EXTENSION_KEY: certification });
    }
    let verb = if complete { "completed" } else { "attempted" };
    statement(record, home, "", (verb, &record.scenario), result)
}

fn task_statement(record: &SessionRecord, home: &str, task: &TaskRecord) -> Value {
    let mut result = json!({
        "score": score(100.0 * task.on_path, 100.0),
        "duration": format!("PT{:.2}S", task.seconds),
    });
    if let Some((state, covered)) = task.state.zip(task.covered) {
        result["completion"] = json!(state == TaskState::Done);
        result["extensions"] = json!({ COVERAGE_EXTENSION_KEY: covered });
    }
    statement(record, home, &format!("tasks/{}", task.id), ("attempted", &task.name), result)
}

fn score(raw: f64, max: f64) -> Value {
    // xAPI defines `scaled` as -1 to 1, where 1 is best.
    let scaled = if max > 0.0 { (raw / max).clamp(-1.0, 1.0) } else { 0.0 };
    json!({ "scaled": scaled, "raw": raw, "min": 0.0, "max": max.max(raw) })
}

/// Creates a statement about the job (if `below` is empty) or a part of it.
fn statement(record: &SessionRecord, home: &str, below: &str, (verb, name): (&str, &str), result: Value) -> Value {
    let slash = if below.is_empty() { "" } else { "/" };
    let activity = format!("urn:spandrel:scenario:{}{slash}{below}", record.scenario);
    let mut statement = json!({
        "actor": { "objectType": "Agent", "account": { "homePage": home, "name": record.trainee } },
        "verb": { "id": format!("{VERB_PREFIX}{verb}"), "display": { "en": verb } },
        "object": { "objectType": "Activity", "id": activity, "definition": { "name": { "en": name } } },
        "result": result,
        "context": {
            "registration": id(&record.id),
            "platform": format!("spandrel {}", record.spandrel_version),
            "extensions": {
                "urn:spandrel:session": record.id,
                "urn:spandrel:scorer-version": record.scorer_version,
                "urn:spandrel:telemetry-sha256": record.telemetry_sha256,
            },
        },
        "timestamp": utc(record.started_unix_us).0,
    });
    // The ID depends on the entire content: a changed answer gets a new ID, while an unchanged statement keeps its ID.
    let id = id(&statement.to_string());
    if let Some(fields) = statement.as_object_mut() {
        fields.insert("id".to_owned(), Value::String(id));
    }
    statement
}

fn id(text: &str) -> String {
    Uuid::new_v5(&STATEMENT_NAMESPACE, text.as_bytes()).to_string()
}

/// Formats statements as JSON lines.
#[must_use]
pub fn lines(statements: &[Value]) -> String {
    statements.iter().map(|one| one.to_string() + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{aborted_record, perfect_record};
    use std::collections::BTreeSet;

    #[test]
    fn exact_session_reports_flight_scores_tasks_and_answers() {
        let record = perfect_record("anna", 1);
        let all = statements(&record, DEFAULT_ACCOUNT_HOME_PAGE);
        assert_eq!(all.len(), 1 + 4 + 4 + 24);
        assert_eq!(all[0]["result"]["score"], json!({ "scaled": 1.0, "raw": 400.0, "min": 0.0, "max": 400.0 }));
        assert_eq!(all[0]["result"]["duration"], "PT700.25S");
        assert_eq!(all[0]["actor"]["account"]["name"], "anna");
        let ids: BTreeSet<&str> = all.iter().filter_map(|one| one["id"].as_str()).collect();
        assert_eq!(ids.len(), all.len());
        let mut bare = record;
        (bare.scores.accuracy, bare.answers) = (None, None);
        assert_eq!(statements(&bare, DEFAULT_ACCOUNT_HOME_PAGE).len(), 1 + 3 + 4);
    }

    #[test]
    fn regress_incomplete_session_is_reported_as_attempted() {
        let all = statements(&aborted_record("anna", 1), DEFAULT_ACCOUNT_HOME_PAGE);
        let flight = &all[0];
        assert!(flight["verb"]["id"].as_str().is_some_and(|verb| verb.ends_with("/attempted")), "{flight}");
        assert_eq!((&flight["result"]["completion"], &flight["result"]["success"]), (&json!(false), &json!(false)));
        assert_eq!(flight["result"]["score"], Value::Null);
        assert_eq!(
            flight["result"]["response"],
            "Incomplete: 0 of 4 tasks, 15% of the path. Not certified: task 1 not done: 60% of its path, 80% needed (and 1 more)"
        );
        assert_eq!(flight["result"]["extensions"][COMPLETION_EXTENSION_KEY]["path_share"], 0.15);
        let scored: Vec<&Value> = all.iter().filter(|one| one["verb"]["display"]["en"] == "scored").collect();
        assert_eq!(scored.len(), 4);
        for one in scored {
            let share = &one["result"]["extensions"][COMPLETION_EXTENSION_KEY]["path_share"];
            assert_eq!((&one["result"]["completion"], share), (&json!(false), &json!(0.15)), "{one}");
        }
        let perfect = statements(&perfect_record("anna", 1), DEFAULT_ACCOUNT_HOME_PAGE);
        assert!(perfect[1..5].iter().all(|one| one["result"]["completion"] == true), "{}", perfect[1]);
        let task = all.iter().find(|one| one["object"]["id"].as_str().is_some_and(|id| id.ends_with("/tasks/1"))).unwrap();
        assert_eq!(
            (&task["result"]["completion"], &task["result"]["extensions"][COVERAGE_EXTENSION_KEY]),
            (&json!(false), &json!(0.6))
        );
    }

    #[test]
    fn exact_statement_ids_depend_on_content() {
        let record = perfect_record("anna", 1);
        assert_eq!(statements(&record, DEFAULT_ACCOUNT_HOME_PAGE), statements(&record, DEFAULT_ACCOUNT_HOME_PAGE));
        let mut other = record.clone();
        if let Some(answer) = other.answers.as_mut().and_then(|answers| answers.given.values_mut().next()) {
            *answer = 5;
        }
        let ids = |record| {
            statements(record, DEFAULT_ACCOUNT_HOME_PAGE).into_iter().map(|one| one["id"].to_string()).collect::<BTreeSet<_>>()
        };
        assert_eq!(ids(&record).difference(&ids(&other)).count(), 1);
        assert!(ids(&record).is_disjoint(&ids(&perfect_record("anna", 2))));
    }

    #[test]
    fn exact_scores_stay_within_xapi_ranges() {
        assert_eq!(score(500.0, 400.0)["scaled"], 1.0);
        assert_eq!(score(1.0, 0.0)["scaled"], 0.0);
        assert!(score(500.0, 400.0)["max"].as_f64() >= score(500.0, 400.0)["raw"].as_f64());
    }
}
