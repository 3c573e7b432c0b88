//! The certification profile: its requirements and the components of its scores.

use crate::report::Review;
use crate::report::formatting;
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};
use spandrel_model::defect_codes::defect_name;
use spandrel_model::elements::Element;
use spandrel_monitor::score::certification::TaskVisits;
use spandrel_monitor::score::certification::contacts::MergedCrash;
use spandrel_monitor::score::certification::pictures::GradedPicture;
use spandrel_monitor::score::completion::verdict;
use spandrel_text::Language;

/// Renders the "Certification" section of a session report.
pub fn section(review: &Review) -> Markup {
    let c = &review.assessment.certification;
    html! {
        p { "The certification profile adds pass/fail requirements that close loopholes in the four TASBID scores. "
            b { @if c.passed { "All requirements met." } @else { (verdict(false, &c.unmet, Language::English)) "." } } }
        ul.gates {
            @for requirement in &c.requirements {
                li { span class={ "badge " (if requirement.met { "v-hit" } else { "v-false" }) } { (if requirement.met { "met" } else { "not met" }) }
                    " " (requirement.name) ": " (requirement.reached_text(Language::English)) " (" (requirement.limit_text(Language::English)) ")" }
            }
        }
        @if !c.unmet.is_empty() { p { "Not met: " (c.unmet.join("; ")) "." } }
        p { "Closer than " (formatting::number(review.scenario.scoring.clearance_m, 1)) " m to a surface for " (formatting::number(c.exposure_s, 1))
            " s; " (c.crash_onsets) " contacts (" (c.crashes.len()) " after merging those less than a second apart); "
            (formatting::number(c.battery_at_end_pct, 0)) "% battery remaining at the end; flight time " (formatting::duration(c.time.flown_s))
            " (this job needs " (formatting::duration(c.time.needed_s)) "). " (too_fine(review)) }
        (scores_table(review).folded())
        (visits_table(review).folded())
        (crashes_table(review).folded())
        (pictures_table(review).folded())
        (detection_table(review).folded())
    }
}

/// Returns a note about the defects that are too fine for the aircraft's camera; empty if there are none.
fn too_fine(review: &Review) -> String {
    match review.assessment.certification.accuracy.defects.iter().filter(|defect| !defect.gradable).count() {
        0 => String::new(),
        1 => "1 defect is too fine for this camera and does not count toward the accuracy.".to_owned(),
        many => format!("{many} defects are too fine for this camera and do not count toward the accuracy."),
    }
}

fn scores_table(review: &Review) -> Table {
    let scores = &review.assessment.certification.scores;
    let row =
        |name: &str, value: Option<f64>| vec![name.into(), value.map_or(TableCell::Empty, |value| TableCell::Number(value, 1))];
    Table {
        name: "certification-scores",
        caption: "certification scores",
        columns: vec!["score", "points"],
        rows: vec![
            row("conformity", scores.conformity),
            row("precision", scores.precision),
            row("safety", Some(scores.safety)),
            row("accuracy", scores.accuracy),
            row("efficiency", Some(scores.efficiency)),
            row("sum", Some(scores.sum)),
        ],
    }
}

fn crashes_table(review: &Review) -> Table {
    let row = |crash: &MergedCrash| {
        vec![
            TableCell::Number(crash.t_s, 1),
            crash.with.label().into(),
            TableCell::Number(crash.speed_m_s, 2),
            TableCell::Number(crash.loss, 1),
        ]
    };
    Table {
        name: "merged-contacts",
        caption: "merged contacts",
        columns: vec!["time (s)", "with", "speed (m/s)", "points lost"],
        rows: review.assessment.certification.crashes.iter().map(row).collect(),
    }
}

fn pictures_table(review: &Review) -> Table {
    let row = |picture: &GradedPicture| {
        let result = match (picture.hit, picture.counted) {
            (true, _) => "hit",
            (false, true) => "no hit",
            (false, false) => "not counted",
        };
        let defects = picture.found.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
        vec![picture.frame.into(), result.into(), defects.into(), picture.fails.join("; ").into()]
    };
    Table {
        name: "picture-quality",
        caption: "pictures by image quality",
        columns: vec!["frame", "result", "new defects", "why defects in the picture did not count"],
        rows: review.assessment.certification.accuracy.pictures.iter().map(row).collect(),
    }
}

fn visits_table(review: &Review) -> Table {
    let number = |value: Option<f64>, digits: usize| value.map_or(TableCell::Empty, |value| TableCell::Number(value, digits));
    let row = |task: &TaskVisits| {
        vec![
            task.id.into(),
            task.visits.len().into(),
            TableCell::Number(100.0 * task.coverage, 1),
            TableCell::Number(100.0 * task.on_path, 1),
            TableCell::Number(task.speeding, 3),
            number(task.precision.map(|precision| precision.rms_distance_ratio), 3),
            number(task.precision.map(|precision| precision.rms_speeding_ratio), 3),
            number(task.precision.and_then(|precision| precision.rms_framing_deg), 1),
            number(task.precision.map(|precision| 100.0 * precision.low_clearance_share), 1),
        ]
    };
    Table {
        name: "visits",
        caption: "task visits",
        columns: vec![
            "task",
            "visits",
            "path flown (%)",
            "on-path share (%)",
            "speeding loss",
            "RMS distance / threshold",
            "RMS speed above limit / limit",
            "RMS framing error (deg)",
            "too close (% of time)",
        ],
        rows: review.assessment.certification.tasks.iter().map(row).collect(),
    }
}

fn detection_table(review: &Review) -> Table {
    let mut rows = Vec::new();
    let mut put = |by: &str, name: String, found: usize, placed: usize| {
        rows.push(vec![by.into(), name.into(), found.into(), placed.into()]);
    };
    let defect_outcomes = &review.defects;
    let mut tell = |by: &str, key: &dyn Fn(&spandrel_model::scenario::PlacedDefect) -> u32, name: &dyn Fn(u32) -> String| {
        let keys: std::collections::BTreeSet<u32> =
            defect_outcomes.iter().map(|defect_outcome| key(&defect_outcome.defect)).collect();
        for k in keys {
            let mine: Vec<_> = defect_outcomes.iter().filter(|defect_outcome| key(&defect_outcome.defect) == k).collect();
            put(by, name(k), mine.iter().filter(|defect_outcome| defect_outcome.found_by.is_some()).count(), mine.len());
        }
    };
    let element = |number: u32| Element::from_number(number as u16);
    tell("element", &|defect| defect.element.number().into(), &|k| format!("{k} {}", element(k).name()));
    tell("kind", &|defect| defect.kind, &|k| defect_name(k).to_owned());
    tell("condition state", &|defect| u32::from(defect.condition_state), &|k| k.to_string());
    Table {
        name: "detection",
        caption: "defects found by element, kind and condition state",
        columns: vec!["grouped by", "value", "found", "placed"],
        rows,
    }
}
