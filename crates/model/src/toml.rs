//! Reads numbers with ranges from TOML and collects all problems with their locations instead of stopping at the first. Records
//! the keys that are read, so that the documentation of the keys can be checked against the code.

use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;
use toml_edit::{Document, Item, TableLike, Value};

/// One problem in a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Problem {
    /// File name as given by the caller.
    pub file: String,
    /// Line number, from 1.
    pub line: usize,
    /// Key with its path, e.g. `wind.speed_m_s`.
    pub key: String,
    /// Value as written; empty if missing.
    pub value: String,
    /// Allowed values.
    pub allowed: String,
    /// Description of the problem.
    pub message: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.file, self.line, self.key)?;
        if !self.value.is_empty() {
            write!(f, " = {}", self.value)?;
        }
        write!(f, ": {}", self.message)?;
        if !self.allowed.is_empty() {
            write!(f, " (allowed: {})", self.allowed)?;
        }
        Ok(())
    }
}

/// Maximum number of problems listed; the others are only counted. A page or terminal shows about 50.
const LISTED_MOST: usize = 50;

/// Returns the first problems of a list and the number of further problems.
#[must_use]
pub fn listed(problems: &[Problem]) -> (&[Problem], usize) {
    let count = problems.len().min(LISTED_MOST);
    (&problems[..count], problems.len() - count)
}

/// All problems of a file. Formatted as one problem per line; after the first 50, the number of further problems.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Problems(pub Vec<Problem>);

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (first, more) = listed(&self.0);
        for (k, problem) in first.iter().enumerate() {
            if k > 0 {
                writeln!(f)?;
            }
            write!(f, "{problem}")?;
        }
        if more > 0 { write!(f, "\nand {more} more problems") } else { Ok(()) }
    }
}

impl std::error::Error for Problems {}

/// Documentation of a key, as defined by the code (for the documentation test).
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct DocumentedKey {
    /// Description of the allowed values.
    pub allowed: String,
    /// Default as written, or `required`.
    pub default: String,
}

/// Parser state of one file: problems and keys read.
#[derive(Debug)]
pub struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    /// Problems so far.
    pub problems: Vec<Problem>,
    /// All keys read; repeated tables count once.
    pub documented_keys: BTreeMap<String, DocumentedKey>,
}

/// A table of the file and the keys read from it so far.
pub struct Section<'d> {
    path: String,
    table: Option<&'d dyn TableLike>,
    line: usize,
    read_keys: Vec<&'static str>,
}

impl<'a> Reader<'a> {
    /// Creates a reader for one file.
    #[must_use]
    pub fn new(file: &'a str, text: &'a str) -> Self {
        Self { file, text, problems: Vec::new(), documented_keys: BTreeMap::new() }
    }

    /// Parses the text; a syntax error is recorded as a problem.
    pub fn parse(&mut self) -> Option<Document<&'a str>> {
        match Document::parse(self.text) {
            Ok(document) => Some(document),
            Err(error) => {
                let line = error.span().map_or(1, |span| self.line_at(span.start));
                self.problem(line, "syntax", "", "TOML 1.0", error.message());
                None
            }
        }
    }

    fn line_at(&self, offset: usize) -> usize {
        1 + self.text.as_bytes().iter().take(offset).filter(|b| **b == b'\n').count()
    }

    fn line_of(&self, item: &Item) -> Option<usize> {
        item.span().map(|span| self.line_at(span.start))
    }

    /// Records a problem.
    pub fn problem(&mut self, line: usize, key: &str, value: &str, allowed: &str, message: &str) {
        self.problems.push(Problem {
            file: self.file.into(),
            line,
            key: one_line(key),
            value: one_line(value),
            allowed: allowed.into(),
            message: one_line(message.trim()),
        });
    }

    /// Records a problem with a key other than its range, at the line of the key, or of the table if the key is missing.
    pub fn add_problem(&mut self, section: &Section, key: &str, value: &str, allowed: &str, message: &str) {
        let line = section.table.and_then(|t| t.get(key)).and_then(|i| self.line_of(i)).unwrap_or(section.line);
        self.problem(line, &section.full(key), value, allowed, message);
    }

    /// Documents the condition on which the default of a key depends.
    pub fn default_depends(&mut self, section: &Section, key: &str, words: &str) {
        if let Some(asked) = self.documented_keys.get_mut(&section.full(key)) {
            asked.default = words.into();
        }
    }

    /// Returns the root table.
    pub fn root<'d>(&self, document: &'d Document<&'a str>) -> Section<'d> {
        Section { path: String::new(), table: Some(document.as_table()), line: 1, read_keys: Vec::new() }
    }

    /// Returns a nested table; if it is missing, its keys take their defaults.
    pub fn section<'d>(&mut self, parent: &mut Section<'d>, key: &'static str) -> Section<'d> {
        let path = parent.full(key);
        let (item, line) = self.item(parent, key);
        let table = item.and_then(Item::as_table_like);
        if let (Some(item), None) = (item, table) {
            self.problem(line, &path, &displayed(item), "a table", "not a table");
        }
        Section { path, table, line, read_keys: Vec::new() }
    }

    /// Returns the tables of an array of tables.
    pub fn sections<'d>(&mut self, parent: &mut Section<'d>, key: &'static str) -> Vec<Section<'d>> {
        let path = parent.full(key);
        let (item, line) = self.item(parent, key);
        let Some(item) = item else { return Vec::new() };
        if let Some(array) = item.as_array_of_tables() {
            let line_of = |table: &toml_edit::Table| table.span().map_or(line, |span| self.line_at(span.start));
            return array
                .iter()
                .map(|t| Section { path: format!("{path}[]"), table: Some(t), line: line_of(t), read_keys: Vec::new() })
                .collect();
        }
        let inline = item.as_array().map(|a| a.iter().map(|v| v.as_inline_table().zip(v.span())).collect::<Option<Vec<_>>>());
        if let Some(tables) = inline.flatten() {
            let section = |(t, span): (&'d toml_edit::InlineTable, std::ops::Range<usize>)| Section {
                path: format!("{path}[]"),
                table: Some(t),
                line: self.line_at(span.start),
                read_keys: Vec::new(),
            };
            return tables.into_iter().map(section).collect();
        }
        self.problem(line, &path, &displayed(item), "an array of tables", "not an array of tables");
        Vec::new()
    }

    fn item<'d>(&mut self, section: &mut Section<'d>, key: &'static str) -> (Option<&'d Item>, usize) {
        section.read_keys.push(key);
        let item = section.table.and_then(|t| t.get(key));
        let line = item.and_then(|i| self.line_of(i)).unwrap_or(section.line);
        (item, line)
    }

    fn record(&mut self, path: &str, allowed: &str, default: String) {
        let path = path.to_string();
        self.documented_keys.entry(path).or_insert_with(|| DocumentedKey { allowed: allowed.into(), default });
    }

    /// Reads a number within [min, max]; required if there is no default.
    pub fn number(&mut self, section: &mut Section, key: &'static str, (min, max): (f64, f64), default: Option<f64>) -> f64 {
        let path = section.full(key);
        let allowed = format!("{min} to {max}");
        self.record(&path, &allowed, default.map_or("required".into(), |d| d.to_string()));
        let (item, line) = self.item(section, key);
        let Some(item) = item else {
            if default.is_none() {
                self.problem(line, &path, "", &allowed, "missing");
            }
            return default.unwrap_or(min);
        };
        match as_number(item) {
            Some(value) if value >= min && value <= max => value,
            Some(_) => {
                self.problem(line, &path, &displayed(item), &allowed, "out of range");
                default.unwrap_or(min)
            }
            None => {
                self.problem(line, &path, &displayed(item), &allowed, "not a number");
                default.unwrap_or(min)
            }
        }
    }

    /// Reads an optional number.
    pub fn optional(&mut self, section: &mut Section, key: &'static str, range: (f64, f64)) -> Option<f64> {
        let present = section.has(key);
        let path = section.full(key);
        self.record(&path, &format!("{} to {}", range.0, range.1), "none".into());
        let value = self.number(section, key, range, Some(range.0));
        present.then_some(value)
    }

    /// Reads an integer within [min, max].
    pub fn integer(&mut self, section: &mut Section, key: &'static str, (min, max): (i64, i64), default: Option<i64>) -> i64 {
        let path = section.full(key);
        let allowed = format!("whole number {min} to {max}");
        self.record(&path, &allowed, default.map_or("required".into(), |d| d.to_string()));
        let (item, line) = self.item(section, key);
        let Some(item) = item else {
            if default.is_none() {
                self.problem(line, &path, "", &allowed, "missing");
            }
            return default.unwrap_or(min);
        };
        match item.as_integer() {
            Some(value) if (min..=max).contains(&value) => value,
            Some(_) => {
                self.problem(line, &path, &displayed(item), &allowed, "out of range");
                default.unwrap_or(min)
            }
            None => {
                self.problem(line, &path, &displayed(item), &allowed, "not a whole number");
                default.unwrap_or(min)
            }
        }
    }

    /// Reads an optional integer.
    pub fn optional_integer(&mut self, section: &mut Section, key: &'static str, range: (i64, i64)) -> Option<i64> {
        let present = section.has(key);
        let value = self.integer(section, key, range, Some(range.0));
        self.default_depends(section, key, "none");
        present.then_some(value)
    }

    /// Reads true or false.
    pub fn flag(&mut self, section: &mut Section, key: &'static str, default: bool) -> bool {
        let path = section.full(key);
        self.record(&path, "true or false", default.to_string());
        let (item, line) = self.item(section, key);
        let Some(item) = item else { return default };
        item.as_bool().unwrap_or_else(|| {
            self.problem(line, &path, &displayed(item), "true or false", "not true or false");
            default
        })
    }

    /// Reads a string; required if there is no default.
    pub fn text(&mut self, section: &mut Section, key: &'static str, default: Option<&str>) -> String {
        let path = section.full(key);
        self.record(&path, "text", default.map_or("required".into(), str::to_string));
        let (item, line) = self.item(section, key);
        match (item, item.and_then(Item::as_str)) {
            (_, Some(value)) => value.to_string(),
            (Some(item), None) => {
                self.problem(line, &path, &displayed(item), "text", "not a string");
                default.unwrap_or_default().to_string()
            }
            (None, None) => {
                if default.is_none() {
                    self.problem(line, &path, "", "text", "missing");
                }
                default.unwrap_or_default().to_string()
            }
        }
    }

    /// Reads one of several keywords.
    pub fn choice<T: Copy>(
        &mut self,
        section: &mut Section,
        key: &'static str,
        words: &[(&'static str, T)],
        default: Option<usize>,
    ) -> T {
        let path = section.full(key);
        let allowed = words.iter().map(|(w, _)| *w).collect::<Vec<_>>().join(", ");
        self.record(&path, &allowed, default.map_or("required".into(), |d| words[d].0.to_string()));
        let (item, line) = self.item(section, key);
        let fallback = words[default.unwrap_or(0)].1;
        let Some(item) = item else {
            if default.is_none() {
                self.problem(line, &path, "", &allowed, "missing");
            }
            return fallback;
        };
        let found = item.as_str().and_then(|text| words.iter().find(|(w, _)| *w == text));
        found.map_or_else(
            || {
                self.problem(line, &path, &displayed(item), &allowed, "not one of these");
                fallback
            },
            |(_, value)| *value,
        )
    }

    /// Reads a list of exactly `n` numbers, each within [min, max].
    pub fn numbers<const N: usize>(
        &mut self,
        section: &mut Section,
        key: &'static str,
        range: (f64, f64),
        default: Option<[f64; N]>,
    ) -> [f64; N] {
        let path = section.full(key);
        let allowed = format!("{N} numbers, each {} to {}", range.0, range.1);
        self.record(&path, &allowed, default.map_or("required".into(), |d| format!("{d:?}")));
        let (item, line) = self.item(section, key);
        let fallback = default.unwrap_or([range.0; N]);
        let Some(item) = item else {
            if default.is_none() {
                self.problem(line, &path, "", &allowed, "missing");
            }
            return fallback;
        };
        let values = item.as_value().and_then(|v| list(v, range)).and_then(|v| <[f64; N]>::try_from(v).ok());
        values.unwrap_or_else(|| {
            self.problem(line, &path, &displayed(item), &allowed, "not a valid list");
            fallback
        })
    }

    /// Reads a list of points of three numbers each; empty if missing.
    pub fn points(&mut self, section: &mut Section, key: &'static str, range: (f64, f64)) -> Vec<[f64; 3]> {
        let path = section.full(key);
        let allowed = format!("list of [east, north, up], each {} to {}", range.0, range.1);
        self.record(&path, &allowed, "none".into());
        let (item, line) = self.item(section, key);
        let Some(item) = item else { return Vec::new() };
        let point = |v: &Value| list(v, range).and_then(|p| <[f64; 3]>::try_from(p).ok());
        let points = item.as_array().map(|array| array.iter().map(point).collect::<Option<Vec<_>>>());
        points.flatten().unwrap_or_else(|| {
            self.problem(line, &path, &displayed(item), &allowed, "not a valid list");
            Vec::new()
        })
    }

    /// Reads a list of integers; empty if missing.
    pub fn integers(&mut self, section: &mut Section, key: &'static str, (min, max): (i64, i64)) -> Vec<i64> {
        let path = section.full(key);
        let allowed = format!("list of whole numbers, each {min} to {max}");
        self.record(&path, &allowed, "none".into());
        let (item, line) = self.item(section, key);
        let Some(item) = item else { return Vec::new() };
        let one = |v: &Value| v.as_integer().filter(|i| (min..=max).contains(i));
        let values = item.as_array().map(|array| array.iter().map(one).collect::<Option<Vec<_>>>());
        values.flatten().unwrap_or_else(|| {
            self.problem(line, &path, &displayed(item), &allowed, "not a valid list");
            Vec::new()
        })
    }

    /// Reports unknown keys. Call this after all keys of the table have been read.
    pub fn finish(&mut self, section: &Section) {
        let Some(table) = section.table else { return };
        for (key, item) in table.iter() {
            if section.read_keys.contains(&key) {
                continue;
            }
            let line = self.line_of(item).unwrap_or(section.line);
            let near = |s: &&&str| is_near_miss(s, key);
            let known = section.read_keys.iter().filter(near).min_by_key(|s| difference(s, key));
            let message = known.map_or("unknown key".to_string(), |k| format!("unknown key; did you mean {k}?"));
            let allowed = section.read_keys.join(", ");
            self.problem(line, &section.full(key), &displayed(item), &allowed, &message);
        }
    }
}

impl Section<'_> {
    /// Returns the key with its path.
    #[must_use]
    pub fn full(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_string() } else { format!("{}.{key}", self.path) }
    }

    /// Returns the line of the table.
    #[must_use]
    pub fn line(&self) -> usize {
        self.line
    }

    /// Returns true if the file contains the key.
    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.table.is_some_and(|t| t.contains_key(key))
    }
}

fn as_number(item: &Item) -> Option<f64> {
    item.as_float().or_else(|| item.as_integer().map(|i| i as f64)).filter(|v| !v.is_nan())
}

fn list(value: &Value, (min, max): (f64, f64)) -> Option<Vec<f64>> {
    let one = |v: &Value| v.as_float().or_else(|| v.as_integer().map(|i| i as f64)).filter(|v| *v >= min && *v <= max);
    value.as_array()?.iter().map(one).collect()
}

/// Removes line breaks and other control characters so that each problem stays on one line.
fn one_line(text: &str) -> String {
    text.replace(char::is_control, " ")
}

/// Returns the value as written, truncated.
fn displayed(item: &Item) -> String {
    const LONGEST: usize = 60;
    let text: String = item.to_string().trim().replace('\n', " ").chars().take(LONGEST + 1).collect();
    if text.chars().count() > LONGEST { format!("{}…", text.chars().take(LONGEST).collect::<String>()) } else { text }
}

/// Returns true if two keys differ by a likely typing error: at most two edits per five characters.
fn is_near_miss(known: &str, key: &str) -> bool {
    5 * difference(known, key) <= 2 * known.chars().count().max(key.chars().count())
}

/// Returns the Levenshtein distance, for suggestions.
fn difference(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let cost = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = cost.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
