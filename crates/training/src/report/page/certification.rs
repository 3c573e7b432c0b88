//! The certification profile: its requirements and the components of its scores.

use crate::report::Review;
use crate::report::formatting;
use crate::report::table::{Table, TableCell};
use maud::{Markup, html};
use spandrel_model::defect_codes::defect_name;
use spandrel_model::elements::Element;
use spandrel_monitor::score::completion::verdict;

/// Renders the "Certification" section of a session report.
pub fn section(review: &Review) -> Markup {
    let c = &review.assessment.certification;
    let gates = [
        ("session complete", c.gates.session_complete),
        ("every task attempted", c.gates.all_tasks_attempted),
        ("no person or vehicle hit", c.gates.no_person_or_vehicle_hit),
        ("landed near the ground team", c.gates.landed_at_home),
        ("at least 20% battery at landing", c.gates.battery_reserve),
    ];
    html! {
        p { "The certification profile adds pass/fail requirements that close loopholes in the four TASBID scores. "
            b { @if c.passed { "All requirements met." } @else { (verdict(false, &c.unmet)) "." } } }
        ul.gates {
            @for (words, open) in gates {
                li { span class={ "badge " (if open { "v-hit" } else { "v-false" }) } { (if open { "met" } else { "not met" }) } " " (words) }
            }
        }
        @if !c.unmet.is_empty() { p { "Not met: " (c.unmet.join("; ")) "." } }
        p { "Closer than " (formatting::number(review.scenario.scoring.clearance_m, 1)) " m to a surface for " (formatting::number(c.exposure_s, 1))
            " s; " (c.crash_onsets) " contacts (" (c.crashes.len()) " after merging those less than a second apart); "
            (formatting::number(c.battery_at_end_pct, 0)) "% battery remaining at the end." }
        (visits_table(review).folded())
        (detection_table(review).folded())
    }
}

fn visits_table(review: &Review) -> Table {
    let row = |task: &spandrel_monitor::score::certification::TaskVisits| {
        vec![
            task.id.into(),
            task.visits.len().into(),
            TableCell::Number(100.0 * task.coverage, 1),
            TableCell::Number(100.0 * task.on_path, 1),
            TableCell::Number(task.speeding, 3),
        ]
    };
    Table {
        name: "visits",
        caption: "task visits",
        columns: vec!["task", "visits", "path flown (%)", "on-path share (%)", "speeding loss"],
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
