//! Exports a session as a SCORM 1.2 package for a learning management system (LMS): a page that shows the session
//! report and reports the score, status and duration through the LMS's script interface.

use super::Review;
use super::formatting;
use maud::{DOCTYPE, PreEscaped, html};
use serde_json::{Value, json};
use spandrel_monitor::Assessment;
use spandrel_monitor::score::completion::verdict;
use spandrel_text::{Language, text};

/// Script that reads the result from the page and reports it to the LMS.
const SCRIPT: &str = include_str!("assets/scorm.js");

/// Returns the names and contents of the package's files; `report` is the HTML report.
#[must_use]
pub fn files(review: &Review, report: &str) -> Vec<(&'static str, String)> {
    vec![
        ("imsmanifest.xml", manifest(review)),
        ("index.html", index(review)),
        ("scorm.js", SCRIPT.to_owned()),
        ("report.html", report.to_owned()),
    ]
}

fn manifest(review: &Review) -> String {
    let title = title(review);
    // maud's HTML escaping is also valid for XML.
    let body = html! {
        manifest identifier={ "spandrel-" (review.metadata.telemetry_sha256.get(..16).unwrap_or_default()) } version="1.0"
            xmlns="http://www.imsproject.org/xsd/imscp_rootv1p1p2" xmlns:adlcp="http://www.adlnet.org/xsd/adlcp_rootv1p2" {
            metadata { schema { "ADL SCORM" } schemaversion { "1.2" } }
            organizations default="organization" {
                organization identifier="organization" {
                    (PreEscaped("<title>")) (title) (PreEscaped("</title>"))
                    item identifier="item" identifierref="resource" isvisible="true" { (PreEscaped("<title>")) (title) (PreEscaped("</title>")) }
                }
            }
            resources {
                resource identifier="resource" type="webcontent" adlcp:scormtype="sco" href="index.html" {
                    @for file in ["index.html", "scorm.js", "report.html"] { file href=(file) {} }
                }
            }
        }
    };
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}\n", body.into_string())
}

fn title(review: &Review) -> String {
    format!("{}, {}", review.title(review.metadata.language), review.metadata.started_utc)
}

/// Returns the result as SCORM data and as text. An incomplete session has no score, because a partial sum would be misleading.
fn result(assessment: &Assessment, language: Language) -> (Value, String) {
    let (scores, certification) = (&assessment.scores, &assessment.certification);
    let time = scorm_timespan(assessment.end.seconds);
    let verdict = verdict(certification.passed, &certification.unmet, language);
    if !assessment.completion.complete {
        let result = json!({ "cmi.core.lesson_status": "incomplete", "cmi.core.session_time": time });
        return (result, format!("{}. {verdict}", assessment.completion.headline(language)));
    }
    let pct = if scores.overall_max > 0.0 { 100.0 * scores.overall / scores.overall_max } else { 0.0 };
    let result = json!({
        "cmi.core.score.min": "0",
        "cmi.core.score.max": "100",
        "cmi.core.score.raw": format!("{pct:.2}"),
        "cmi.core.lesson_status": if certification.passed { "passed" } else { "failed" },
        "cmi.core.session_time": time,
    });
    (result, text!(language, "report-scorm-result", points = formatting::number(pct, 0), verdict = verdict))
}

/// Returns the texts that the package's script shows.
fn texts(language: Language) -> Value {
    json!({
        "missing": text!(language, "report-scorm-missing"),
        "sent": text!(language, "report-scorm-sent"),
        "refused": text!(language, "report-scorm-refused"),
    })
}

fn index(review: &Review) -> String {
    let language = review.metadata.language;
    let (result, words) = result(&review.assessment, language);
    let page = html! {
        (DOCTYPE)
        html lang=(language.tag()) {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'self'; style-src 'unsafe-inline'; frame-src 'self'";
                title { (title(review)) }
                style { "body{margin:0;font:16px system-ui,sans-serif}p{margin:.5rem 1rem}iframe{border:0;width:100%;height:calc(100vh - 3rem)}" }
            }
            body data-result=(result) data-texts=(texts(language)) {
                p role="status" id="told" { (words) ". " }
                iframe src="report.html" title=(text!(language, "report-kicker")) {}
                script src="scorm.js" {}
            }
        }
    };
    page.into_string()
}

/// Formats a duration as a SCORM CMITimespan, HHHH:MM:SS.SS.
fn scorm_timespan(seconds: f64) -> String {
    let hundredths = (seconds.max(0.0) * 100.0).round() as u64;
    let (s, rest) = (hundredths / 100, hundredths % 100);
    format!("{:04}:{:02}:{:02}.{rest:02}", s / 3600, s / 60 % 60, s % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_durations_follow_scorm_format() {
        assert_eq!(scorm_timespan(0.0), "0000:00:00.00");
        assert_eq!(scorm_timespan(3_725.678), "0001:02:05.68");
        assert_eq!(scorm_timespan(-1.0), "0000:00:00.00");
    }
}
