//! Data dictionary page: frames export columns, assessment fields, and cohort table columns.

use crate::table::{code, table};
use crate::{check, page_head};
use serde_json::Value;
use spandrel_monitor::assess_log;
use spandrel_monitor::export::COLUMNS;
use spandrel_monitor::export::columns::ColumnReader;
use spandrel_monitor::export::fields::FIELDS;
use spandrel_testkit::job::*;
use spandrel_training::cohort::columns::definition;
use spandrel_training::cohort::{Selection, cohort, tables};
use spandrel_training::record::IncompletePolicy;
use std::collections::BTreeSet;

fn frames() -> String {
    let rows = COLUMNS.iter().map(|column| {
        let kind = match column.read {
            ColumnReader::Integer(_) => "int64",
            ColumnReader::Float(_) => "double",
            ColumnReader::Boolean(_) => "boolean",
            ColumnReader::Text(_) => "string",
        };
        let empty = if column.optional { "yes" } else { "no" };
        let words = [column.unit, column.frame, empty, column.description].map(str::to_owned);
        [vec![code(column.name), kind.to_owned()], words.to_vec()].concat()
    });
    table(&["column", "type", "unit", "frame", "may be empty", "definition"], rows)
}

fn assessment() -> String {
    let rows = FIELDS.iter().map(|field| vec![code(field.path), field.unit.to_owned(), field.description.to_owned()]);
    table(&["field", "unit", "definition"], rows)
}

/// Returns the header of every table for an empty cohort.
fn cohort_tables() -> String {
    let selection = Selection { scenarios: Vec::new(), repetitions: 3, incomplete: IncompletePolicy::Exclude };
    let cohort = cohort(&[], &selection);
    let mut out = String::new();
    for (name, text) in tables(&cohort) {
        let columns = text.lines().next().unwrap().split(',');
        let rows = columns.map(|column| {
            let known = definition(name, column).unwrap_or_else(|| panic!("{name}: {column} has no definition"));
            vec![code(column), known.unit.to_owned(), known.description.to_owned()]
        });
        out.push_str(&format!("\n### {name}\n\n{}", table(&["column", "unit", "definition"], rows)));
    }
    out
}

#[test]
fn exact_data_dictionary_matches_the_code() {
    let about = "Units and definitions of all numbers that Spandrel exports. [How a flight is scored](assessment.md) explains the terms. \
                 Spandrel writes each number with the fewest digits that parse back to the same bits.";
    let frames_about = "`spandrel export SESSION --frames FILE.csv` and `--parquet FILE.parquet` write one row per scored \
                        frame. If the telemetry has no value for a frame, the CSV cell is empty and the Parquet value is \
                        null. Flags are 1 or 0 in CSV. In Parquet, each field's metadata gives its unit, frame and \
                        definition.";
    let assessment_about = "Fields of `assessment.json`, which `spandrel assess SESSION --json FILE` also writes. `[]` stands for list elements, \
                            and `*` stands for map keys.";
    let cohort_about = "`spandrel cohort --csv FOLDER` writes these tables. After the `trainee` column, `crashes.csv` has \
                        one `task_ID` column per task. After the `seconds` column, `progress.csv` has one `on_path_ID` \
                        column per task.";
    let page = format!(
        "{}\n## Frames\n\n{frames_about}\n\n{}\n## Assessment\n\n{assessment_about}\n\n{}\n## Cohort tables\n\n{cohort_about}\n{}",
        page_head("Data dictionary", about),
        frames(),
        assessment(),
        cohort_tables(),
    );
    check("data-dictionary.md", &page);
}

/// Collects the paths of all values. The keys of a map appear as `*` if they are numbers or tasks. Empty lists and
/// nulls have no paths.
fn paths(value: &Value, at: &str, out: &mut BTreeSet<String>) {
    match value {
        Value::Object(map) => {
            let free = ["by_task", "by_element", "by_kind", "by_condition_state"].iter().any(|name| at.ends_with(name));
            for (key, inner) in map {
                let key = if free { "*" } else { key.as_str() };
                let path = if at.is_empty() { key.to_owned() } else { format!("{at}.{key}") };
                paths(inner, &path, out);
            }
        }
        Value::Array(list) => list.iter().for_each(|inner| paths(inner, &format!("{at}[]"), out)),
        Value::Null => {}
        Value::Bool(_) | Value::Number(_) | Value::String(_) => {
            out.insert(at.to_owned());
        }
    }
}

/// Compares the definitions with the assessments of two flights: one with a crash, a photo that shows a defect, a
/// dark photo and a blurred one, and one that never gets near its task.
#[test]
fn exact_data_dictionary_covers_exactly_the_assessment_fields() {
    let mut full = Tape::new();
    full.fly((0.0, 0.0, 10.0), 2.0);
    full.fly((20.0, 0.0, 10.0), 4.0);
    full.snapshot(0);
    full.hold(0.1);
    full.lamp(true);
    full.snapshot(1);
    full.fly((30.0, 0.0, 10.0), 4.0);
    full.snapshot(2);
    full.contact(1);
    full.hold(0.2);
    full.contact(0);
    full.land();
    let mut nothing = Tape::new();
    nothing.fly((0.0, 0.0, 10.0), 2.0);
    let mut seen = BTreeSet::new();
    for tape in [full, nothing] {
        let assessed_session = assess_log(&tape.log(0), &one_task(), &vehicle(), test_survey).unwrap();
        paths(&serde_json::to_value(&assessed_session.assessment).unwrap(), "", &mut seen);
    }
    let documented: BTreeSet<String> = FIELDS.iter().map(|field| field.path.to_owned()).collect();
    assert_eq!(documented.len(), FIELDS.len(), "a field is documented twice");
    let missing: Vec<&String> = seen.difference(&documented).collect();
    let gone: Vec<&String> = documented.difference(&seen).collect();
    assert!(missing.is_empty() && gone.is_empty(), "not documented: {missing:?}; documented but not in any assessment: {gone:?}");
}
