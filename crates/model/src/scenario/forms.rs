//! Forms of a job: alternative sets of defects in one scenario file. One form is selected; its settings replace those of
//! the `[defects]` table.

use super::job::{DefectSpec, SelectedForm};
use crate::toml::{Reader, Section};
use toml_edit::{DocumentMut, Item, Table, value};

/// Key of the selected form.
const SELECTED: &str = "form";
/// Key of the forms.
const FORMS: &str = "forms";
/// Maximum number of forms (estimate: more than anybody repeats one job).
const MAX_FORMS: usize = 26;
/// Allowed range of `detection_pct`. Beyond it, defects would have to be invisible or impossible to miss.
pub(super) const DETECTION_RANGE_PCT: (f64, f64) = (5.0, 97.0);

/// A form in the file.
struct Form {
    name: String,
    defect_seed: u64,
    mean_detection: Option<f64>,
}

/// Reads `form` and `[[forms]]`, and applies the selected form to the defects.
pub(super) fn read(r: &mut Reader, root: &mut Section, defects: &mut DefectSpec) -> Option<SelectedForm> {
    let selected = r.text(root, SELECTED, Some(""));
    r.describe_default(root, SELECTED, "the first form");
    let forms = read_forms(r, root, defects);
    if forms.is_empty() {
        if root.has(SELECTED) {
            r.add_problem(root, SELECTED, &selected, "only in a file with [[forms]]", "this job has no forms");
        }
        return None;
    }
    let available: Vec<String> = forms.iter().map(|form| form.name.clone()).collect();
    let chosen = if root.has(SELECTED) { forms.iter().find(|form| form.name == selected) } else { forms.first() };
    let Some(form) = chosen else {
        r.add_problem(root, SELECTED, &selected, &available.join(", "), "unknown form");
        return None;
    };
    defects.seed = Some(form.defect_seed);
    defects.mean_detection = form.mean_detection.or(defects.mean_detection);
    Some(SelectedForm { name: form.name.clone(), available })
}

fn read_forms(r: &mut Reader, root: &mut Section, defects: &DefectSpec) -> Vec<Form> {
    let mut forms: Vec<Form> = Vec::new();
    for mut s in r.sections(root, FORMS) {
        let name = r.text(&mut s, "name", None);
        let legal = (1..=8).contains(&name.len()) && name.bytes().all(|b| b.is_ascii_alphanumeric());
        if s.has("name") && !legal {
            r.add_problem(&s, "name", &name, "1 to 8 characters: A-Z, a-z and 0-9", "invalid name");
        } else if forms.iter().any(|form| form.name == name) {
            r.add_problem(&s, "name", &name, "a unique name", "duplicate name");
        }
        let defect_seed = r.integer(&mut s, "defect_seed", (0, i64::from(i32::MAX)), None) as u64;
        let detection_pct = r.optional_number(&mut s, "detection_pct", DETECTION_RANGE_PCT);
        if detection_pct.or(defects.mean_detection).is_none() {
            r.add_problem(&s, "detection_pct", "", "here or in [defects]", "a form without a predicted detection");
        }
        r.finish(&s);
        forms.push(Form { name, defect_seed, mean_detection: detection_pct.map(|pct| pct / 100.0) });
    }
    if forms.len() > MAX_FORMS {
        r.add_problem(root, FORMS, &forms.len().to_string(), "at most 26 [[forms]]", "too many");
    }
    forms
}

/// Returns the text of a scenario with another form selected. Invalid TOML is returned unchanged. The reader reports a form
/// that does not exist.
#[must_use]
pub fn select_form(text: &str, form: &str) -> String {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return text.to_owned() };
    document[SELECTED] = value(form);
    document.to_string()
}

/// Returns the names of the forms in the text of a scenario, in file order; empty if it has none or is invalid TOML.
#[must_use]
pub fn form_names(text: &str) -> Vec<String> {
    let Ok(document) = text.parse::<DocumentMut>() else { return Vec::new() };
    let tables = document.get(FORMS).and_then(Item::as_array_of_tables);
    let name = |form: &Table| Some(form.get("name")?.as_str()?.to_owned());
    tables.into_iter().flatten().filter_map(name).collect()
}

/// Adds the selected form to a document that relies on the default, so that both have the same checksum.
pub(super) fn state_selected_form(document: &mut Table) {
    let first = |forms: &Item| Some(forms.as_array_of_tables()?.get(0)?.get("name")?.as_str()?.to_owned());
    if document.contains_key(SELECTED) {
        return;
    }
    if let Some(name) = document.get(FORMS).and_then(first) {
        document.insert(SELECTED, value(name));
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Scenario, read, resolve, select_variant, variant_names, variant_with_crc};
    use super::*;
    use crate::shipped::{PILOT_STUDY, TWO_BRIDGES};
    use crate::toml::Problems;

    fn no_file(file: &str) -> Result<Vec<u8>, String> {
        Err(format!("no file {file}"))
    }

    fn parse(text: &str) -> Result<Scenario, Problems> {
        read("job.toml", text, &no_file)
    }

    fn problem(from: &str, to: &str) -> String {
        assert!(PILOT_STUDY.contains(from), "{from}");
        let text = parse(&PILOT_STUDY.replacen(from, to, 1)).unwrap_err().to_string();
        text.split_once(": ").map(|(_, words)| words.to_owned()).unwrap()
    }

    #[test]
    fn exact_selected_form_replaces_seed_and_detection() {
        assert_eq!(form_names(PILOT_STUDY), ["A", "B", "C", "H"]);
        let job = |form: &str| parse(&select_form(PILOT_STUDY, form)).unwrap();
        let defects = |form: &str| (job(form).defects.seed, job(form).defects.mean_detection);
        assert_eq!(defects("B"), (Some(2), Some(0.95)), "the detection of [defects]");
        assert_eq!(defects("H"), (Some(4), Some(0.25)), "the detection of the form");
        assert_eq!((job("H").name_with_form(), job("H").name), ("pilot-study@H".to_owned(), "pilot-study".to_owned()));
        assert_eq!(parse(TWO_BRIDGES).unwrap().name_with_form(), "two-bridges");
    }

    #[test]
    fn exact_each_form_has_its_own_checksum_which_survives_resolving() {
        let source = select_form(PILOT_STUDY, "B");
        let job = parse(&source).unwrap();
        let resolved = parse(&resolve(&source, 5, &[])).unwrap();
        assert_eq!((resolved.crc, &resolved.form), (job.crc, &job.form));
        let checksums = ["A", "B", "C", "H"].map(|form| parse(&select_form(PILOT_STUDY, form)).unwrap().crc);
        assert_eq!(parse(PILOT_STUDY).unwrap().crc, checksums[0], "the first form is the default");
        assert!((0..4).all(|k| !checksums[..k].contains(&checksums[k])), "{checksums:?}");
        for (form, crc) in ["A", "B", "C", "H"].into_iter().zip(checksums) {
            let found = variant_with_crc(PILOT_STUDY, &no_file, crc).unwrap();
            assert_eq!(parse(&found).unwrap().form.unwrap().name, form);
        }
        assert_eq!(variant_with_crc(PILOT_STUDY, &no_file, checksums[0] ^ 1), None);
        assert_eq!(variant_names(PILOT_STUDY), ["A", "B", "C", "H"]);
        assert_eq!((variant_names(TWO_BRIDGES), select_variant(TWO_BRIDGES, "1")), (Vec::new(), None));
        assert_eq!(variant_with_crc(TWO_BRIDGES, &no_file, parse(TWO_BRIDGES).unwrap().crc).as_deref(), Some(TWO_BRIDGES));
    }

    #[test]
    fn regress_wrong_forms_are_reported() {
        let unknown = parse(&select_form(PILOT_STUDY, "X")).unwrap_err().to_string();
        assert!(unknown.ends_with("form = X: unknown form (allowed: A, B, C, H)"), "{unknown}");
        let none = parse(&select_form(TWO_BRIDGES, "A")).unwrap_err().to_string();
        assert!(none.ends_with("form = A: this job has no forms (allowed: only in a file with [[forms]])"), "{none}");
        assert_eq!(problem("name = \"B\"", "name = \"A\""), "forms[].name = A: duplicate name (allowed: a unique name)");
        let invalid = "forms[].name = B 2: invalid name (allowed: 1 to 8 characters: A-Z, a-z and 0-9)";
        assert_eq!(problem("name = \"B\"", "name = \"B 2\""), invalid);
        let missing = problem("lines = 2\ndetection_pct = 95", "lines = 2");
        assert!(missing.starts_with("forms[].detection_pct"), "{missing}");
        let lines = problem("lines = 2", "lines = 11");
        assert_eq!(lines, "defects.lines = 11: too many (allowed: at most count)");
    }

    #[test]
    fn regress_small_stand_off_needs_a_closer_warning() {
        let expected =
            "tasks[].stand_off_m = 2: too small for the too-close warning (allowed: at least 4, or too_close_m at most 1.5)";
        assert_eq!(problem("threshold_m = 1.75\ntoo_close_m = 1.5", "threshold_m = 1.75\ntoo_close_m = 1.6"), expected);
    }
}
