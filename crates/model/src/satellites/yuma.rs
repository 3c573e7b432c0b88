//! Reads almanacs in the YUMA format, in which the US Coast Guard publishes the GPS almanac: one block of `key: value` lines for
//! each satellite. Lines that begin with an asterisk are headings.

use super::{Almanac, SatelliteOrbit};
use crate::math;
use crate::toml::{Problem, Problems};
use std::collections::{BTreeMap, BTreeSet};

/// Maximum number of satellites. All navigation satellites of 2026 together are about 140.
const MAX_SATELLITES: usize = 256;

/// A key of a block: its name without the unit, and the range of its value.
struct Field {
    name: &'static str,
    range: (f64, f64),
}

const fn field(name: &'static str, low: f64, high: f64) -> Field {
    Field { name, range: (low, high) }
}

const ID: usize = 0;
const HEALTH: usize = 1;
const ECCENTRICITY: usize = 2;
const APPLICABLE: usize = 3;
const INCLINATION: usize = 4;
const NODE_RATE: usize = 5;
const ROOT_OF_AXIS: usize = 6;
const NODE: usize = 7;
const PERIGEE: usize = 8;
const MEAN_ANOMALY: usize = 9;
const WEEK: usize = 12;

/// All keys, in the order of the format. Eccentricities and axes are limited to orbits of navigation satellites (estimate): the
/// axis is 9,600 to 49,000 km.
const FIELDS: [Field; 13] = [
    field("ID", 1.0, 999.0),
    field("Health", 0.0, 999.0),
    field("Eccentricity", 0.0, 0.1),
    field("Time of Applicability", 0.0, 604_800.0),
    field("Orbital Inclination", 0.0, math::PI),
    field("Rate of Right Ascen", -1e-6, 1e-6),
    field("SQRT(A)", 3_100.0, 7_000.0),
    field("Right Ascen at Week", -math::TAU, math::TAU),
    field("Argument of Perigee", -math::TAU, math::TAU),
    field("Mean Anom", -math::TAU, math::TAU),
    field("Af0", -1.0, 1.0),
    field("Af1", -1.0, 1.0),
    field("week", 0.0, 10_000.0),
];

/// One satellite's lines.
struct Block {
    line: usize,
    values: BTreeMap<usize, f64>,
}

/// Reads an almanac. `file` is the name used in messages. Satellites that are not healthy are left out.
///
/// # Errors
/// Returns all problems, each with line, key, value and allowed range.
pub fn read(file: &str, text: &str) -> Result<Almanac, Problems> {
    let mut reader = BlockReader { file, problems: Vec::new(), blocks: Vec::new() };
    for (line, content) in (1..).zip(text.lines()) {
        reader.read_line(line, content.trim());
    }
    reader.check_blocks();
    if !reader.problems.is_empty() {
        return Err(Problems(reader.problems));
    }
    let healthy = reader.blocks.iter().filter(|block| block.value(HEALTH) == 0.0);
    Ok(Almanac { orbits: healthy.map(Block::orbit).collect() })
}

struct BlockReader<'a> {
    file: &'a str,
    problems: Vec<Problem>,
    blocks: Vec<Block>,
}

impl BlockReader<'_> {
    fn read_line(&mut self, line: usize, content: &str) {
        if content.is_empty() || content.starts_with('*') {
            return;
        }
        let (key, value) = content.split_once(':').unwrap_or((content, ""));
        let (key, value) = (key.trim(), value.trim());
        match FIELDS.iter().position(|field| is_key(field, key)) {
            Some(ID) => self.begin_block(line, value),
            Some(index) => self.read_value(line, index, value),
            None => self.add_problem(line, key, value, "a key of the YUMA format", "unknown key"),
        }
    }

    fn begin_block(&mut self, line: usize, value: &str) {
        if self.blocks.len() >= MAX_SATELLITES {
            let allowed = format!("at most {MAX_SATELLITES} satellites");
            self.add_problem(line, FIELDS[ID].name, value, &allowed, "too many");
            return;
        }
        self.blocks.push(Block { line, values: BTreeMap::new() });
        self.read_value(line, ID, value);
    }

    fn read_value(&mut self, line: usize, index: usize, value: &str) {
        let Field { name, range: (low, high) } = FIELDS[index];
        let allowed = format!("{low} to {high}");
        let number = value.parse::<f64>().ok().filter(|number| (low..=high).contains(number));
        let Some(number) = number else {
            let message = if value.parse::<f64>().is_ok() { "out of range" } else { "not a number" };
            self.add_problem(line, name, value, &allowed, message);
            return;
        };
        let Some(block) = self.blocks.last_mut() else {
            self.add_problem(line, name, value, "after the line ID of a satellite", "no satellite");
            return;
        };
        if block.values.insert(index, number).is_some() {
            self.add_problem(line, name, value, "once for each satellite", "duplicate key");
        }
    }

    fn check_blocks(&mut self) {
        if self.blocks.is_empty() && self.problems.is_empty() {
            self.add_problem(1, FIELDS[ID].name, "", "at least one satellite", "no satellite");
        }
        let mut seen = BTreeSet::new();
        let mut found = Vec::new();
        for block in &self.blocks {
            let missing = (0..FIELDS.len()).find(|index| !block.values.contains_key(index));
            if let (Some(index), true) = (missing, self.problems.is_empty()) {
                found.push((block.line, FIELDS[index].name, String::new(), "missing"));
            }
            let id = block.value(ID);
            if !seen.insert(id as u32) {
                found.push((block.line, FIELDS[ID].name, id.to_string(), "duplicate satellite"));
            }
        }
        for (line, key, value, message) in found {
            self.add_problem(line, key, &value, "each key and each ID once", message);
        }
    }

    fn add_problem(&mut self, line: usize, key: &str, value: &str, allowed: &str, message: &str) {
        self.problems.push(Problem {
            file: self.file.into(),
            line,
            key: shortened(key),
            location: shortened(key),
            value: shortened(value),
            allowed: allowed.into(),
            message: message.into(),
        });
    }
}

/// Returns whether a line's key is this one. Files state units in different ways, such as `SQRT(A)  (m 1/2)` and `SQRT(A)(m^1/2)`,
/// and some write `Right Ascen at TOA`.
fn is_key(field: &Field, key: &str) -> bool {
    let plain = |text: &str| text.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_ascii_lowercase();
    let (key, name) = (plain(key).replace("attoa", "atweek"), plain(field.name));
    key.strip_prefix(&name).is_some_and(|unit| unit.is_empty() || unit.starts_with('('))
}

/// Returns at most the first 60 characters, so that a file of another kind gives messages of bearable length.
fn shortened(text: &str) -> String {
    text.chars().take(60).map(|c| if c.is_control() { ' ' } else { c }).collect()
}

impl Block {
    fn value(&self, index: usize) -> f64 {
        self.values.get(&index).copied().unwrap_or(0.0)
    }

    fn orbit(&self) -> SatelliteOrbit {
        SatelliteOrbit {
            id: self.value(ID) as u16,
            week: self.value(WEEK) as u32,
            applicable_s: self.value(APPLICABLE),
            eccentricity: self.value(ECCENTRICITY),
            inclination_rad: self.value(INCLINATION),
            node_rate_rad_s: self.value(NODE_RATE),
            root_of_axis: self.value(ROOT_OF_AXIS),
            node_rad: self.value(NODE),
            argument_of_perigee_rad: self.value(PERIGEE),
            mean_anomaly_rad: self.value(MEAN_ANOMALY),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::satellites::GpsTime;

    /// A satellite of the GPS almanac of week 906 (January 2017), as published by the US Coast Guard.
    const PRN_1: &str = "******** Week 906 almanac for PRN-01 ********
ID:                         01
Health:                     000
Eccentricity:               0.6087303162E-002
Time of Applicability(s):  61440.0000
Orbital Inclination(rad):   0.9665481118
Rate of Right Ascen(r/s):  -0.7783181344E-008
SQRT(A)  (m 1/2):           5153.653320
Right Ascen at Week(rad):   0.1162147740E+000
Argument of Perigee(rad):   0.555236630
Mean Anom(rad):            -0.1276245051E+000
Af0(s):                     0.4577636719E-004
Af1(s/s):                   0.0000000000E+000
week:                        906
";

    fn problem(from: &str, to: &str) -> String {
        let text = PRN_1.replace(from, to);
        assert_ne!(text, PRN_1, "{from}");
        read("a.alm", &text).unwrap_err().to_string()
    }

    #[test]
    fn val_positions_match_gnss_lib_py() {
        // find_sv_states of the Python package gnss_lib_py 1.1.0 for the same elements, 6 and 30 h after the time of applicability.
        // It uses the same constants.
        const TOLERANCE_M: f64 = 1.0;
        let orbit = read("a.alm", PRN_1).unwrap().orbits[0];
        for (hours, expected) in [
            (6.0, [-20_612_110.850, -14_219_065.790, -9_324_952.065]),
            (30.0, [-20_318_828.213, -14_170_157.872, -10_018_887.914]),
        ] {
            let time = GpsTime((1_024.0 + 906.0) * 604_800.0 + 61_440.0 + hours * 3_600.0);
            let found = orbit.position_ecef_m(time);
            for axis in 0..3 {
                assert!((found[axis] - expected[axis]).abs() < TOLERANCE_M, "{hours} h: {found:?} {expected:?}");
            }
        }
    }

    #[test]
    fn exact_problems_name_file_line_key_value_and_allowed_range() {
        let shown = problem("0.6087303162E-002", "0.6");
        assert_eq!(shown.trim(), "a.alm:4: Eccentricity = 0.6: out of range (allowed: 0 to 0.1)");
        let shown = problem("61440.0000", "soon");
        assert_eq!(shown.trim(), "a.alm:5: Time of Applicability = soon: not a number (allowed: 0 to 604800)");
        let shown = problem("Mean Anom(rad)", "Mean Height(m)");
        assert!(shown.starts_with("a.alm:11: Mean Height(m) = -0.1276245051E+000: unknown key"), "{shown}");
        let shown = problem("week:                        906\n", "");
        assert_eq!(shown.trim(), "a.alm:2: week: missing (allowed: each key and each ID once)");
        let shown = read("a.alm", &PRN_1.repeat(2)).unwrap_err().to_string();
        assert_eq!(shown.trim(), "a.alm:16: ID = 1: duplicate satellite (allowed: each key and each ID once)");
        let shown = read("a.alm", "").unwrap_err().to_string();
        assert_eq!(shown.trim(), "a.alm:1: ID: no satellite (allowed: at least one satellite)");
    }

    #[test]
    fn exact_other_spellings_are_read_and_unhealthy_satellites_left_out() {
        let text = PRN_1.replace("Right Ascen at Week(rad)", "Right Ascen at TOA(rad)").replace("(m 1/2)", "(m^1/2)");
        assert_eq!(read("a.alm", &text).unwrap(), read("a.alm", PRN_1).unwrap());
        let text = PRN_1.replace("Health:                     000", "Health:                     063");
        assert_eq!(read("a.alm", &text).unwrap().orbits, []);
    }
}
