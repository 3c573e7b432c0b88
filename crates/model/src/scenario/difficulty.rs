//! Difficulty levels of a job: the `[difficulty]` table states which numbers of the file change with the level, and their values
//! at the easiest and at the hardest level. At the standard level, the file's own values apply.

use super::job::{Difficulty, HazardSpec, Scenario, WindModel};
use super::tasks::is_unread;
use crate::math;
use crate::numbers::format_limit;
use crate::toml::{Adjustment, Problem, Problems, Reader, Section};
use toml_edit::{DocumentMut, Item, value};

/// Key of the selected level.
const SELECTED: &str = "level";
/// Name of the table.
const TABLE: &str = "difficulty";
/// Key of the number of levels.
const LEVELS: &str = "levels";
/// Key of the standard level.
const STANDARD: &str = "standard";
/// Maximum number of levels (estimate: more than a trainee can tell apart).
const MAX_LEVELS: i64 = 20;
/// Default number of levels, and the default standard level in the middle (estimates).
const DEFAULT_LEVELS: (i64, i64) = (9, 5);
/// Number of steps per unit to which displayed values are rounded.
const DISPLAY_STEPS: f64 = 100.0;

/// A number that a level can change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quantity {
    WindSpeed,
    Turbulence,
    Threshold,
    CrownGap,
    Detection,
    DefectSize,
    HazardSeverity,
    TimeBest,
    TimeMax,
}

/// Keys, range and display of a quantity.
struct QuantityKeys {
    quantity: Quantity,
    /// Key in the `[difficulty]` table.
    key: &'static str,
    /// Full key of the number that changes.
    changes: &'static str,
    /// Allowed range of that number.
    range: (f64, f64),
    /// Whether a larger number is harder.
    more_is_harder: bool,
    /// Display name and unit.
    display: (&'static str, &'static str),
}

const QUANTITIES: [QuantityKeys; 9] = [
    QuantityKeys {
        quantity: Quantity::WindSpeed,
        key: "wind_speed_m_s",
        changes: "wind.speed_m_s",
        range: (0.0, 30.0),
        more_is_harder: true,
        display: ("wind", " m/s"),
    },
    QuantityKeys {
        quantity: Quantity::Turbulence,
        key: "turbulence",
        changes: "wind.turbulence",
        range: (0.0, 5.0),
        more_is_harder: true,
        display: ("turbulence", ""),
    },
    QuantityKeys {
        quantity: Quantity::Threshold,
        key: "threshold_m",
        changes: "tasks[].threshold_m",
        range: (0.2, 7.999),
        more_is_harder: false,
        display: ("on path within", " m"),
    },
    QuantityKeys {
        quantity: Quantity::CrownGap,
        key: "crown_gap_m",
        changes: "bridges[].arch.crown_gap_m",
        range: (2.0, 12.0),
        more_is_harder: false,
        display: ("gap", " m"),
    },
    QuantityKeys {
        quantity: Quantity::Detection,
        key: "detection_pct",
        changes: "defects.detection_pct",
        range: super::forms::DETECTION_RANGE_PCT,
        more_is_harder: false,
        display: ("predicted detection", "%"),
    },
    QuantityKeys {
        quantity: Quantity::DefectSize,
        key: "size_factor",
        changes: "defects.size_factor",
        range: (0.2, 5.0),
        more_is_harder: false,
        display: ("defect size factor", ""),
    },
    QuantityKeys {
        quantity: Quantity::HazardSeverity,
        key: "hazard_severity",
        changes: "hazards.severity",
        range: HazardSpec::SEVERITY_RANGE,
        more_is_harder: true,
        display: ("hazard severity", ""),
    },
    QuantityKeys {
        quantity: Quantity::TimeBest,
        key: "time_best_min",
        changes: "scoring.time_best_min",
        range: (0.1, 120.0),
        more_is_harder: false,
        display: ("full score up to", " min"),
    },
    QuantityKeys {
        quantity: Quantity::TimeMax,
        key: "time_max_min",
        changes: "scoring.time_max_min",
        range: (0.2, 240.0),
        more_is_harder: false,
        display: ("time limit", " min"),
    },
];

/// Position of a level between the easiest and the hardest.
#[derive(Debug, Clone, Copy)]
struct LevelPosition {
    level: u8,
    levels: u8,
    standard: u8,
}

impl LevelPosition {
    /// Interpolates linearly from the easiest value to the file's own, and from there to the hardest value. The ends and the
    /// file's own value are exact.
    fn interpolate(self, own: f64, (easiest, hardest): (f64, f64)) -> f64 {
        let part = |steps: u8, of: u8| f64::from(steps) / f64::from(of);
        let (end, share) = if self.level < self.standard {
            (easiest, part(self.standard - self.level, self.standard - 1))
        } else if self.level > self.standard {
            (hardest, part(self.level - self.standard, self.levels - self.standard))
        } else {
            return own;
        };
        own * (1.0 - share) + end * share
    }
}

/// A `[difficulty]` table whose quantities still have to be found in the rest of the file.
pub(super) struct DifficultyTable<'d> {
    section: Section<'d>,
    position: LevelPosition,
    quantities: Vec<(&'static QuantityKeys, (f64, f64))>,
}

/// Reads `level` and `[difficulty]`, and lets the reader adjust the numbers that the level changes.
pub(super) fn read<'d>(r: &mut Reader, root: &mut Section<'d>) -> Option<DifficultyTable<'d>> {
    let has_table = root.has(TABLE);
    let level = r.optional_integer(root, SELECTED, (1, MAX_LEVELS));
    r.describe_default(root, SELECTED, "the standard level");
    let mut section = r.section(root, TABLE);
    let (position, quantities) = (read_levels(r, &mut section, level), read_quantities(r, &mut section));
    r.finish(&section);
    if !has_table {
        if let Some(level) = level {
            let allowed = "only in a file with [difficulty]";
            r.add_problem(root, SELECTED, &level.to_string(), allowed, "this job has no difficulty levels");
        }
        return None;
    }
    if let Some(level) = level.filter(|level| *level > i64::from(position.levels)) {
        let allowed = format!("1 to {}", position.levels);
        r.add_problem(root, SELECTED, &level.to_string(), &allowed, "unknown difficulty level");
    }
    if quantities.is_empty() {
        let keys = QUANTITIES.map(|one| one.key).join(", ");
        r.add_problem(root, TABLE, "", &format!("at least one of {keys}"), "nothing changes with the level");
    }
    for (keys, ends) in &quantities {
        let ends = *ends;
        r.adjust(keys.changes, Adjustment::new(move |own| position.interpolate(own, ends)));
    }
    Some(DifficultyTable { section, position, quantities })
}

fn read_levels(r: &mut Reader, section: &mut Section, level: Option<i64>) -> LevelPosition {
    let levels = r.integer(section, LEVELS, (2, MAX_LEVELS), Some(DEFAULT_LEVELS.0));
    let standard = r.integer(section, STANDARD, (1, MAX_LEVELS), Some(DEFAULT_LEVELS.1));
    if standard > levels {
        r.add_problem(section, STANDARD, &standard.to_string(), &format!("1 to levels, which is {levels}"), "too large");
    }
    // Values that are too large have been reported. Within the levels, interpolation is always possible.
    let small = |number: i64| u8::try_from(number.clamp(1, levels.max(1))).unwrap_or(1);
    LevelPosition { level: small(level.unwrap_or(standard)), levels: small(levels), standard: small(standard) }
}

fn read_quantities(r: &mut Reader, section: &mut Section) -> Vec<(&'static QuantityKeys, (f64, f64))> {
    let mut out = Vec::new();
    for keys in &QUANTITIES {
        let before = r.problems.len();
        let has = section.has(keys.key);
        let [easiest, hardest] = r.numbers(section, keys.key, keys.range, Some([keys.range.0; 2]));
        r.describe_default(section, keys.key, "none");
        if !has || r.problems.len() > before {
            continue;
        }
        if easiest == hardest || (hardest > easiest) != keys.more_is_harder {
            let order = if keys.more_is_harder { "smaller" } else { "larger" };
            let allowed = format!("easiest, hardest; the first is {order}");
            r.add_problem(section, keys.key, &format!("[{easiest}, {hardest}]"), &allowed, "wrong order");
        } else {
            out.push((keys, (easiest, hardest)));
        }
    }
    out
}

impl DifficultyTable<'_> {
    /// Checks that the level changes what the table says, and describes every level.
    pub(super) fn finish(self, r: &mut Reader, scenario: &Scenario) -> Difficulty {
        if scenario.form.is_some() {
            r.add_problem_at(self.section.line(), TABLE, "", "only in a file without [[forms]]", "a job with forms");
        }
        let mut settings = vec![Vec::new(); usize::from(self.position.levels)];
        for (keys, ends) in &self.quantities {
            let own = r.take_adjusted(keys.changes);
            self.check(r, keys, *ends, &own, scenario);
            for (level, setting) in (1..).zip(&mut settings) {
                let position = LevelPosition { level, ..self.position };
                let values: Vec<f64> = own.iter().map(|own| position.interpolate(*own, *ends)).collect();
                setting.push(describe(keys, &values));
            }
        }
        Difficulty {
            level: self.position.level,
            standard: self.position.standard,
            settings: settings.into_iter().map(|parts| parts.join(", ")).collect(),
        }
    }

    fn check(&self, r: &mut Reader, keys: &QuantityKeys, (easiest, hardest): (f64, f64), own: &[f64], scenario: &Scenario) {
        let stated = format!("[{easiest}, {hardest}]");
        if let Some(condition) = unmet_condition(keys.quantity, own, scenario) {
            r.add_problem(&self.section, keys.key, &stated, condition, "has no effect in this job");
        }
        let (low, high) = (easiest.min(hardest), easiest.max(hardest));
        if let Some(outside) = own.iter().find(|own| !(low..=high).contains(*own)) {
            let allowed = format!("a range that contains {} = {}", keys.changes, format_limit(*outside));
            r.add_problem(&self.section, keys.key, &stated, &allowed, "the file's own value is outside");
        }
    }
}

/// Returns the condition that a job must meet for the quantity to have an effect; `None` if it meets it.
fn unmet_condition(quantity: Quantity, own: &[f64], scenario: &Scenario) -> Option<&'static str> {
    let is_physical = scenario.wind.model == WindModel::Physical;
    let defects = &scenario.defects;
    let has_defects = defects.count > 0 || defects.placed.is_some();
    let (met, condition) = match quantity {
        Quantity::WindSpeed | Quantity::Turbulence => (is_physical, "only with the physical wind model"),
        Quantity::CrownGap => (!own.is_empty() || scenario.bridges.iter().any(is_unread), "only with an arch bridge"),
        Quantity::Detection => (!own.is_empty() && has_defects, "only with defects and defects.detection_pct"),
        Quantity::DefectSize => {
            (defects.mean_detection.is_none() && has_defects, "only with defects and without defects.detection_pct")
        }
        Quantity::HazardSeverity => {
            let HazardSpec { compass, sky, radio, .. } = &scenario.hazards;
            (*compass || *sky || *radio, "only with hazards.compass, hazards.sky or hazards.radio")
        }
        Quantity::Threshold | Quantity::TimeBest | Quantity::TimeMax => (true, ""),
    };
    (!met).then_some(condition)
}

fn describe(keys: &QuantityKeys, values: &[f64]) -> String {
    let (name, unit) = keys.display;
    let shown = |value: f64| format_limit((value * DISPLAY_STEPS).round() / DISPLAY_STEPS);
    let (low, high) = math::range(values.iter().copied());
    if low < high { format!("{name} {} to {}{unit}", shown(low), shown(high)) } else { format!("{name} {}{unit}", shown(low)) }
}

/// Checks that the scenario is also valid at its easiest and at its hardest level. `read_level` reads it at a level.
pub(super) fn check_ends(
    file: &str,
    text: &str,
    levels: u8,
    read_level: impl Fn(&str) -> Result<Scenario, Problems>,
) -> Result<(), Problems> {
    let line = text.lines().position(|line| line.trim_start().starts_with("[difficulty]")).map_or(1, |at| at + 1);
    let mut found = Vec::new();
    for (level, end) in [(1, "easiest"), (levels, "hardest")] {
        let Err(problems) = read_level(&select_level(text, level)) else { continue };
        found.extend(problems.0.into_iter().map(|problem| Problem {
            file: file.to_owned(),
            line,
            key: TABLE.to_owned(),
            location: TABLE.to_owned(),
            value: format!("level {level}"),
            allowed: problem.allowed,
            message: format!("invalid at the {end} level: {} = {}: {}", problem.key, problem.value, problem.message),
        }));
    }
    if found.is_empty() { Ok(()) } else { Err(Problems(found)) }
}

/// Returns the text of a scenario with another difficulty level selected. Invalid TOML is returned unchanged. The reader
/// reports a level that does not exist.
#[must_use]
pub fn select_level(text: &str, level: u8) -> String {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return text.to_owned() };
    document[SELECTED] = value(i64::from(level));
    document.to_string()
}

/// Returns the number of difficulty levels in the text of a scenario; `None` if it has none or is invalid TOML.
#[must_use]
pub fn level_count(text: &str) -> Option<u8> {
    let document = text.parse::<DocumentMut>().ok()?;
    u8::try_from(stated(document.get(TABLE)?, LEVELS, DEFAULT_LEVELS.0)).ok()
}

/// Returns a number of the table, or its default.
fn stated(table: &Item, key: &str, default: i64) -> i64 {
    table.get(key).and_then(Item::as_integer).unwrap_or(default)
}

/// Adds the standard level to a document that relies on the default.
pub(super) fn state_level(document: &mut DocumentMut) {
    let standard = document.get(TABLE).map(|table| stated(table, STANDARD, DEFAULT_LEVELS.1));
    if let Some(standard) = standard.filter(|_| !document.contains_key(SELECTED)) {
        document[SELECTED] = value(standard);
    }
}

/// Removes the table from a document at the standard level. Its checksum is then that of the file without the table, because
/// the flight is the same.
pub(super) fn remove_standard_level(document: &mut DocumentMut) {
    let Some(standard) = document.get(TABLE).map(|table| stated(table, STANDARD, DEFAULT_LEVELS.1)) else { return };
    if document.get(SELECTED).is_none_or(|level| level.as_integer() == Some(standard)) {
        document.remove(SELECTED);
        document.remove(TABLE);
    }
}
