//! The certification profile: its requirements and the components of its scores.

use crate::report::Review;
use crate::report::formatting;
use crate::report::table::{Table, TableCell, folded};
use crate::terms::{contact_title, defect_title, element_title};
use maud::{Markup, html};
use spandrel_model::elements::Element;
use spandrel_monitor::score::certification::TaskVisits;
use spandrel_monitor::score::certification::contacts::MergedCrash;
use spandrel_monitor::score::certification::names::title;
use spandrel_monitor::score::certification::pictures::GradedPicture;
use spandrel_monitor::score::completion::verdict;
use spandrel_monitor::stored_text::all_translated;
use spandrel_text::{Language, text};

/// Renders the "Certification" section of a session report.
pub fn section(review: &Review) -> Markup {
    let c = &review.assessment.certification;
    let language = review.metadata.language;
    html! {
        p { (text!(language, "report-certification-intro")) " "
            b { @if c.passed { (text!(language, "report-certification-passed")) } @else { (verdict(false, &c.unmet, language)) "." } } }
        ul.gates {
            @for requirement in &c.requirements {
                li { span class={ "badge " (if requirement.met { "v-hit" } else { "v-false" }) } { (met_label(requirement.met, language)) }
                    " " (requirement.title(language)) ": " (requirement.reached_text(language)) " (" (requirement.limit_text(language)) ")"
                    div.note { (requirement.explanation(language)) } }
            }
        }
        @if !c.unmet.is_empty() { p { (text!(language, "report-certification-unmet", requirements = all_translated(&c.unmet, language).join("; "))) } }
        p { (measures(review)) " " (too_fine(review)) }
        (folded(language, |language| scores_table(review, language)))
        (folded(language, |language| visits_table(review, language)))
        (folded(language, |language| crashes_table(review, language)))
        (folded(language, |language| pictures_table(review, language)))
        (folded(language, |language| detection_table(review, language)))
    }
}

fn met_label(met: bool, language: Language) -> String {
    if met { text!(language, "report-certification-met") } else { text!(language, "report-certification-not-met") }
}

/// Returns the measures that no requirement shows.
fn measures(review: &Review) -> String {
    let c = &review.assessment.certification;
    text!(
        review.metadata.language,
        "report-certification-exposure",
        limit = formatting::number(review.scenario.scoring.clearance_m, 1),
        exposure = formatting::number(c.exposure_s, 1),
        contacts = c.crash_onsets,
        merged = c.crashes.len(),
        battery = formatting::number(c.battery_at_end_pct, 0),
        time = formatting::duration(c.time.flown_s),
        needed = formatting::duration(c.time.needed_s)
    )
}

/// Returns a note about the defects that are too fine for the aircraft's camera; empty if there are none.
fn too_fine(review: &Review) -> String {
    match review.assessment.certification.accuracy.defects.iter().filter(|defect| !defect.gradable).count() {
        0 => String::new(),
        count => text!(review.metadata.language, "report-certification-too-fine", count = count),
    }
}

fn scores_table(review: &Review, language: Language) -> Table {
    let scores = &review.assessment.certification.scores;
    let number = |value: Option<f64>| value.map_or(TableCell::Empty, |value| TableCell::Number(value, 1));
    let row = |id: &str, value: Option<f64>| vec![title(id, language).unwrap_or_default().into(), number(value)];
    Table {
        name: "certification-scores",
        caption: text!(language, "report-certification-scores-caption"),
        columns: vec![text!(language, "report-column-score"), text!(language, "report-column-points")],
        rows: vec![
            row("conformity", scores.conformity),
            row("precision", scores.precision),
            row("safety", Some(scores.safety)),
            row("accuracy", scores.accuracy),
            row("efficiency", Some(scores.efficiency)),
            vec![text!(language, "report-measure-certification-sum").into(), number(Some(scores.sum))],
        ],
    }
}

fn crashes_table(review: &Review, language: Language) -> Table {
    let row = |crash: &MergedCrash| {
        vec![
            TableCell::Number(crash.t_s, 1),
            contact_title(crash.with.label(), language).into(),
            TableCell::Number(crash.speed_m_s, 2),
            TableCell::Number(crash.loss, 1),
        ]
    };
    Table {
        name: "merged-contacts",
        caption: text!(language, "report-certification-contacts-caption"),
        columns: vec![
            text!(language, "report-column-time-s"),
            text!(language, "report-column-with"),
            text!(language, "report-column-speed"),
            text!(language, "report-column-points-lost"),
        ],
        rows: review.assessment.certification.crashes.iter().map(row).collect(),
    }
}

fn pictures_table(review: &Review, language: Language) -> Table {
    let row = |picture: &GradedPicture| {
        let result = match (picture.hit, picture.counted) {
            (true, _) => text!(language, "report-certification-hit"),
            (false, true) => text!(language, "report-certification-no-hit"),
            (false, false) => text!(language, "report-certification-not-counted"),
        };
        let defects = picture.found.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
        vec![picture.frame.into(), result.into(), defects.into(), all_translated(&picture.fails, language).join("; ").into()]
    };
    Table {
        name: "picture-quality",
        caption: text!(language, "report-certification-pictures-caption"),
        columns: vec![
            text!(language, "report-column-frame"),
            text!(language, "report-column-result"),
            text!(language, "report-column-new-defects"),
            text!(language, "report-column-fails"),
        ],
        rows: review.assessment.certification.accuracy.pictures.iter().map(row).collect(),
    }
}

fn visits_table(review: &Review, language: Language) -> Table {
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
        caption: text!(language, "report-certification-visits-caption"),
        columns: vec![
            text!(language, "report-column-task"),
            text!(language, "report-column-visits"),
            text!(language, "report-column-path-flown"),
            text!(language, "report-column-on-path-share"),
            text!(language, "report-column-speeding-loss"),
            text!(language, "report-column-rms-distance"),
            text!(language, "report-column-rms-speed"),
            text!(language, "report-column-rms-framing"),
            text!(language, "report-column-too-close-share"),
        ],
        rows: review.assessment.certification.tasks.iter().map(row).collect(),
    }
}

fn detection_table(review: &Review, language: Language) -> Table {
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
    tell(&text!(language, "report-column-element"), &|defect| defect.element.number().into(), &|k| {
        format!("{k} {}", element_title(element(k), language))
    });
    tell(&text!(language, "report-column-kind"), &|defect| defect.kind, &|k| defect_title(k, language));
    tell(&text!(language, "report-column-condition-state"), &|defect| u32::from(defect.condition_state), &|k| k.to_string());
    Table {
        name: "detection",
        caption: text!(language, "report-certification-detection-caption"),
        columns: vec![
            text!(language, "report-column-grouped-by"),
            text!(language, "report-column-value"),
            text!(language, "report-column-found"),
            text!(language, "report-column-placed"),
        ],
        rows,
    }
}
