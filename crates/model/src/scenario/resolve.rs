//! Resolved scenario files: the source text plus the seed and placed defects of a session. A resolved file has the same
//! CRC as its source.

use super::bridges::model::Model;
use super::defect_cause::{DefectCause, Stain, StainSubstance};
use super::job::{MAX_DEFECTS, PlacedDefect};
use super::point::point;
use super::siblings::SiblingLoader;
use super::{briefing_pictures, difficulty, forms, terrain};
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::toml::{Reader, Section};
use toml_edit::{Array, ArrayOfTables, DocumentMut, Item, Table, Value, value};

/// Key of the placed defects.
pub(super) const PLACED: &str = "placed";
/// Key that states that a session has no defects.
pub(super) const NONE_PLACED: &str = "none_placed";
/// Largest ID of a placed defect.
pub(super) const MAX_DEFECT_ID: u32 = 10_000;
/// Range of a placed defect's length, m.
pub const LENGTH_RANGE_M: (f64, f64) = (1e-4, 50.0);
/// Range of a placed defect's width, m.
pub const WIDTH_RANGE_M: (f64, f64) = (1e-6, 50.0);
/// Tolerance for the length of unit vectors that are rounded to three decimals.
const UNIT_TOLERANCE: f64 = 2e-3;

/// Inserts a seed, placed defects and the difficulty level into the source text. Parsing the result yields the same job with
/// exactly these defects. Invalid TOML is returned unchanged.
#[must_use]
pub fn resolve(text: &str, seed: u64, placed: &[PlacedDefect]) -> String {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return text.to_string() };
    document["seed"] = value(i64::try_from(seed).unwrap_or(i64::MAX));
    super::difficulty::state_level(&mut document);
    let mut tables = ArrayOfTables::new();
    for defect in placed {
        tables.push(defect_table(defect));
    }
    let defects = document.entry("defects").or_insert_with(|| Item::Table(Table::new()));
    if let Some(defects) = defects.as_table_like_mut() {
        defects.insert(NONE_PLACED, value(placed.is_empty()));
        defects.remove(PLACED);
        if !placed.is_empty() {
            defects.insert(PLACED, Item::ArrayOfTables(tables));
        }
    }
    document.to_string()
}

fn defect_table(defect: &PlacedDefect) -> Table {
    defect_entries(defect).into_iter().map(|(key, entry)| (key, Item::Value(entry))).collect()
}

/// Returns the keys and values of a defect's table.
pub(super) fn defect_entries(defect: &PlacedDefect) -> Vec<(&'static str, Value)> {
    let list = |v: Vec3<Enu>| Value::from(v.array().into_iter().collect::<Array>());
    let mut entries = vec![
        ("id", Value::from(i64::from(defect.id))),
        ("element", Value::from(i64::from(defect.element.number()))),
        ("member", Value::from(&defect.member)),
        ("kind", Value::from(i64::from(defect.kind))),
        ("condition_state", Value::from(i64::from(defect.condition_state))),
        ("position_m", list(defect.position_m)),
        ("normal", list(defect.normal)),
        ("along", list(defect.along)),
        ("length_m", Value::from(defect.length_m)),
        ("width_m", Value::from(defect.width_m)),
        ("line", Value::from(defect.line)),
    ];
    entries.extend(defect.cause.map(|cause| ("cause", Value::from(cause.keyword()))));
    if let Some(stain) = defect.stain {
        entries.extend([("stain", Value::from(stain.substance.keyword())), ("stain_m", Value::from(stain.length_m))]);
    }
    entries
}

/// Reads the placed defects of a resolved file; `None` for a source file.
pub(super) fn read_placed_defects(r: &mut Reader, s: &mut Section) -> Option<Vec<PlacedDefect>> {
    let none_placed = r.boolean(s, NONE_PLACED, false);
    let mut out = Vec::new();
    for mut t in r.sections(s, PLACED) {
        let defect = read_placed_defect(r, &mut t);
        if t.has("id") && out.iter().any(|other: &PlacedDefect| other.id == defect.id) {
            r.add_problem(&t, "id", &defect.id.to_string(), "a unique number", "duplicate number");
        }
        r.finish(&t);
        out.push(defect);
    }
    if out.len() > MAX_DEFECTS {
        r.add_problem(s, PLACED, &out.len().to_string(), &format!("at most {MAX_DEFECTS} [[defects.{PLACED}]]"), "too many");
    }
    (none_placed || !out.is_empty()).then_some(out)
}

fn read_placed_defect(r: &mut Reader, t: &mut Section) -> PlacedDefect {
    let unit = |r: &mut Reader, t: &mut Section, key| {
        let [e, n, u] = r.numbers(t, key, (-1.0, 1.0), None);
        let v = Vec3::new(e, n, u);
        if t.has(key) && (v.norm() - 1.0).abs() > UNIT_TOLERANCE {
            r.add_problem(t, key, &format!("length {:.4}", v.norm()), "a vector of length 1", "not a unit vector");
        }
        v
    };
    PlacedDefect {
        id: r.integer(t, "id", (1, i64::from(MAX_DEFECT_ID)), None) as u32,
        element: Element::from_number(r.integer(t, "element", (1, 999), None) as u16),
        member: r.text(t, "member", None),
        kind: r.integer(t, "kind", (1000, 9999), None) as u32,
        condition_state: r.integer(t, "condition_state", (1, 4), None) as u8,
        position_m: point(r, t, "position_m", None),
        normal: unit(r, t, "normal"),
        along: unit(r, t, "along"),
        length_m: r.number(t, "length_m", LENGTH_RANGE_M, None),
        width_m: r.number(t, "width_m", WIDTH_RANGE_M, None),
        line: r.boolean(t, "line", false),
        cause: r.keyword(t, "cause", &DefectCause::words(), Some(0)),
        stain: read_stain(r, t),
    }
}

fn read_stain(r: &mut Reader, t: &mut Section) -> Option<Stain> {
    let substance = r.keyword(t, "stain", &StainSubstance::WORDS, Some(0));
    let length_m = r.optional_number(t, "stain_m", (1e-3, 50.0));
    if substance.is_some() != length_m.is_some() {
        r.add_problem(t, "stain_m", "", "both stain and stain_m, or none", "an incomplete stain");
    }
    Some(Stain { substance: substance?, length_m: length_m? })
}

/// Returns the CRC-32 of the text in canonical form. Excludes the seed and placed defects, so that a resolved file has
/// the same CRC as its source, and the pictures of the briefing, which do not affect a flight. Each form of a job has a different
/// CRC, and so does each difficulty level.
#[must_use]
pub fn crc(text: &str) -> u32 {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return crc32fast::hash(text.as_bytes()) };
    document.remove("seed");
    document.remove(briefing_pictures::TABLE);
    forms::state_selected_form(document.as_table_mut());
    difficulty::remove_standard_level(&mut document);
    if let Some(defects) = document.get_mut("defects").and_then(Item::as_table_like_mut) {
        defects.remove(PLACED);
        defects.remove(NONE_PLACED);
    }
    crc32fast::hash(canonical_form(document.as_item()).as_bytes())
}

/// Returns the CRC-32 of the text, and of the files of the imported bridges and the elevation model if there are any.
#[must_use]
pub(super) fn crc_with_files(text: &str, siblings: SiblingLoader) -> u32 {
    add_files(crc(text), &site_files(text, siblings))
}

/// Continues a CRC with the lengths and bytes of files. Without files, it stays the same.
fn add_files(crc: u32, files: &[Vec<u8>]) -> u32 {
    let mut hasher = crc32fast::Hasher::new_with_initial(crc);
    for bytes in files {
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    }
    hasher.finalize()
}

/// Loads the files that determine the site: the elevation model, and the elements file and the model of each imported bridge, in this order.
/// Leaves out files that cannot be read, which are problems of the scenario.
fn site_files(text: &str, siblings: SiblingLoader) -> Vec<Vec<u8>> {
    let Ok(document) = text.parse::<DocumentMut>() else { return Vec::new() };
    let names = elevation_file(&document).into_iter().chain(model_files(&document));
    names.filter(|name| !name.is_empty()).filter_map(|name| siblings(&name).ok()).collect()
}

/// Returns the name of the terrain's elevation model.
fn elevation_file(document: &DocumentMut) -> Option<String> {
    let terrain = document.get(terrain::TABLE)?.as_table_like()?;
    let text = |key: &str| terrain.get(key).and_then(Item::as_str);
    (text(terrain::SOURCE) == Some(terrain::GEOTIFF)).then(|| text(terrain::FILE).unwrap_or_default().to_owned())
}

/// Returns the names of the elements file and the model of each imported bridge.
fn model_files(document: &DocumentMut) -> Vec<String> {
    let Some(bridges) = document.get("bridges").cloned().and_then(|item| item.into_array_of_tables().ok()) else {
        return Vec::new();
    };
    let models = bridges.iter().filter(|bridge| bridge.get("type").and_then(Item::as_str) == Some(Model::TYPE));
    let tables = models.filter_map(|bridge| bridge.get(Model::TYPE)?.as_table_like());
    tables
        .flat_map(|table| ["elements", "file"].map(|key| table.get(key).and_then(Item::as_str).unwrap_or_default().into()))
        .collect()
}

/// Returns the names of a scenario's variants: its forms, or its difficulty levels as numbers; empty if it has neither.
#[must_use]
pub fn variant_names(text: &str) -> Vec<String> {
    let forms = forms::form_names(text);
    let levels = || (1..=difficulty::level_count(text).unwrap_or(0)).map(|level| level.to_string()).collect();
    if forms.is_empty() { levels() } else { forms }
}

/// Returns the text of a scenario with another variant selected; `None` if there is no variant with this name.
#[must_use]
pub fn select_variant(text: &str, name: &str) -> Option<String> {
    if forms::form_names(text).iter().any(|form| form == name) {
        return Some(forms::select_form(text, name));
    }
    let level = name.parse().ok().filter(|level| (1..=difficulty::level_count(text).unwrap_or(0)).contains(level));
    level.map(|level| difficulty::select_level(text, level))
}

/// Returns the text of the variant with this CRC, as announced by a vehicle or recorded in its telemetry; `None` if there is
/// none. A scenario without variants is its own only one. `siblings` loads the files of the site.
#[must_use]
pub fn variant_with_crc(text: &str, siblings: SiblingLoader, crc: u32) -> Option<String> {
    let files = site_files(text, siblings);
    let variants = variant_names(text).into_iter().filter_map(|name| select_variant(text, &name));
    std::iter::once(text.to_owned()).chain(variants).find(|variant| add_files(self::crc(variant), &files) == crc)
}

/// Returns the canonical form of a TOML item: sorted keys without comments or formatting.
fn canonical_form(item: &Item) -> String {
    let mut out = String::new();
    write_canonical(item, "", &mut out);
    out
}

fn write_canonical(item: &Item, path: &str, out: &mut String) {
    if let Some(table) = item.as_table_like() {
        let mut keys: Vec<&str> = table.iter().map(|(key, _)| key).collect();
        keys.sort_unstable();
        for key in keys {
            if let Some(inner) = table.get(key) {
                write_canonical(inner, &format!("{path}.{key}"), out);
            }
        }
    } else if let Some(tables) = item.as_array_of_tables() {
        for (k, table) in tables.iter().enumerate() {
            write_canonical(&Item::Table(table.clone()), &format!("{path}[{k}]"), out);
        }
    } else if let Some(value) = item.as_value() {
        let mut value = value.clone();
        value.decor_mut().clear();
        out.push_str(&format!("{path}={}\n", value.to_string().replace([' ', '\n'], "")));
    }
}
