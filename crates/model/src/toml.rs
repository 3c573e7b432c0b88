//! Reads values from TOML files and checks their ranges. Collects all problems with their locations instead of stopping
//! at the first one. Also records the keys that it reads, which a test compares with the documentation.

use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;
use toml_edit::{Document, Item, TableLike, Value};

/// A problem in a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Problem {
    /// File name, as passed by the caller.
    pub file: String,
    /// Line number, from 1.
    pub line: usize,
    /// Key with its path, e.g. `wind.speed_m_s`.
    pub key: String,
    /// Like `key`, but with the index of each repeated table, such as `tasks[2].name`. Not part of the printed problem.
    #[serde(skip)]
    pub location: String,
    /// Value as written; empty if missing.
    pub value: String,
    /// Description of the allowed values; empty if there is none.
    pub allowed: String,
    /// Short description of the problem, such as `out of range`.
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

/// Key of the problem of a text that is not valid TOML. Its message is the parser's.
pub const SYNTAX: &str = "syntax";

/// Maximum number of problems to display, about one screenful; the rest are only counted.
const MAX_DISPLAYED_PROBLEMS: usize = 50;

/// Splits a list of problems into the first 50, which are displayed, and the number of the rest.
#[must_use]
pub fn split_displayed(problems: &[Problem]) -> (&[Problem], usize) {
    let count = problems.len().min(MAX_DISPLAYED_PROBLEMS);
    (&problems[..count], problems.len() - count)
}

/// All problems in a file. Displayed as one problem per line; after the first 50, only the number of remaining problems
/// is shown.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Problems(pub Vec<Problem>);

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (first, more) = split_displayed(&self.0);
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

/// Allowed values and default of a key as defined by the code. A test compares them with the documentation.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct DocumentedKey {
    /// Description of allowed values.
    pub allowed: String,
    /// Default value as text, or `required`, or `none` for an optional key.
    pub default: String,
}

/// Reader for one file. Collects the problems and the keys that were read.
#[derive(Debug)]
pub struct Reader<'a> {
    file: &'a str,
    text: &'a str,
    /// Problems found so far.
    pub problems: Vec<Problem>,
    /// Keys that were read, by path; keys of repeated tables are listed once.
    pub documented_keys: BTreeMap<String, DocumentedKey>,
    /// Adjustments by full key.
    adjustments: BTreeMap<&'static str, Adjustment>,
}

/// A change to a number while it is read.
pub struct Adjustment {
    change: Box<dyn Fn(f64) -> f64>,
    /// Numbers before the change, in file order.
    own: Vec<f64>,
}

impl Adjustment {
    /// Creates an adjustment. `change` returns the number to use instead of the one in the file, within the key's range.
    #[must_use]
    pub fn new(change: impl Fn(f64) -> f64 + 'static) -> Self {
        Self { change: Box::new(change), own: Vec::new() }
    }
}

impl fmt::Debug for Adjustment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Adjustment").field("own", &self.own).finish_non_exhaustive()
    }
}

/// A table in the file, with the keys that were read from it so far.
pub struct Section<'d> {
    path: String,
    /// Like `path`, with the index of each repeated table.
    location: String,
    table: Option<&'d dyn TableLike>,
    line: usize,
    read_keys: Vec<&'static str>,
}

impl<'a> Reader<'a> {
    /// Creates a reader for one file.
    #[must_use]
    pub fn new(file: &'a str, text: &'a str) -> Self {
        Self { file, text, problems: Vec::new(), documented_keys: BTreeMap::new(), adjustments: BTreeMap::new() }
    }

    /// Parses the text; returns `None` and records a problem if there is a syntax error.
    pub fn parse(&mut self) -> Option<Document<&'a str>> {
        match Document::parse(self.text) {
            Ok(document) => Some(document),
            Err(error) => {
                let line = error.span().map_or(1, |span| self.line_at(span.start));
                self.add_problem_at(line, SYNTAX, "", "TOML 1.0", error.message());
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

    /// Records a problem at a line.
    pub fn add_problem_at(&mut self, line: usize, key: &str, value: &str, allowed: &str, message: &str) {
        self.problems.push(Problem {
            file: self.file.into(),
            line,
            key: one_line(key),
            location: one_line(key),
            value: one_line(value),
            allowed: allowed.into(),
            message: one_line(message.trim()),
        });
    }

    /// Records a problem with a key. The line is the key's line, or the table's line if the key is missing.
    pub fn add_problem(&mut self, section: &Section, key: &str, value: &str, allowed: &str, message: &str) {
        let line = section.table.and_then(|t| t.get(key)).and_then(|i| self.line_of(i)).unwrap_or(section.line);
        self.add_problem_on_line(section, key, line, value, (allowed, message));
    }

    /// Records a problem with a key whose line is known.
    fn add_problem_on_line(&mut self, section: &Section, key: &str, line: usize, value: &str, (allowed, message): (&str, &str)) {
        self.add_problem_at(line, &section.full_key(key), value, allowed, message);
        if let Some(problem) = self.problems.last_mut() {
            problem.location = one_line(&section.location_of(key));
        }
    }

    /// Replaces the documented default of a key with a description, for a default that depends on another key.
    pub fn describe_default(&mut self, section: &Section, key: &str, words: &str) {
        if let Some(asked) = self.documented_keys.get_mut(&section.full_key(key)) {
            asked.default = words.into();
        }
    }

    /// Returns the root table of the document.
    pub fn root<'d>(&self, document: &'d Document<&'a str>) -> Section<'d> {
        Section { path: String::new(), location: String::new(), table: Some(document.as_table()), line: 1, read_keys: Vec::new() }
    }

    /// Returns a nested table. If it is missing, all of its keys are treated as missing.
    pub fn section<'d>(&mut self, parent: &mut Section<'d>, key: &'static str) -> Section<'d> {
        let (path, location) = (parent.full_key(key), parent.location_of(key));
        let (item, line) = self.item(parent, key);
        let table = item.and_then(Item::as_table_like);
        if let (Some(item), None) = (item, table) {
            self.add_problem_on_line(parent, key, line, &display_value(item), ("a table", "not a table"));
        }
        Section { path, location, table, line, read_keys: Vec::new() }
    }

    /// Returns the tables in an array of tables; empty if the key is missing.
    pub fn sections<'d>(&mut self, parent: &mut Section<'d>, key: &'static str) -> Vec<Section<'d>> {
        let (path, location) = (format!("{}[]", parent.full_key(key)), parent.location_of(key));
        let (item, line) = self.item(parent, key);
        let Some(item) = item else { return Vec::new() };
        let Some(tables) = repeated_tables(item) else {
            let given = display_value(item);
            self.add_problem_on_line(parent, key, line, &given, ("an array of tables", "not an array of tables"));
            return Vec::new();
        };
        let section = |(k, (table, start)): (usize, (&'d dyn TableLike, Option<usize>))| Section {
            path: path.clone(),
            location: format!("{location}[{k}]"),
            table: Some(table),
            line: start.map_or(line, |start| self.line_at(start)),
            read_keys: Vec::new(),
        };
        tables.into_iter().enumerate().map(section).collect()
    }

    fn item<'d>(&mut self, section: &mut Section<'d>, key: &'static str) -> (Option<&'d Item>, usize) {
        section.read_keys.push(key);
        let item = section.table.and_then(|t| t.get(key));
        let line = item.and_then(|i| self.line_of(i)).unwrap_or(section.line);
        (item, line)
    }

    fn record_key(&mut self, path: &str, allowed: &str, default: String) {
        let path = path.to_string();
        self.documented_keys.entry(path).or_insert_with(|| DocumentedKey { allowed: allowed.into(), default });
    }

    /// Adjusts a number that is read later, or several in repeated tables.
    pub fn adjust(&mut self, key: &'static str, adjustment: Adjustment) {
        self.adjustments.insert(key, adjustment);
    }

    /// Ends the adjustment of a key. Returns the numbers that were adjusted, as the file states them or by default.
    pub fn take_adjusted(&mut self, key: &str) -> Vec<f64> {
        self.adjustments.remove(key).map_or_else(Vec::new, |adjustment| adjustment.own)
    }

    fn adjusted(&mut self, path: &str, own: f64) -> f64 {
        self.adjustments.get_mut(path).map_or(own, |adjustment| {
            adjustment.own.push(own);
            (adjustment.change)(own)
        })
    }

    /// Reads a number within [min, max]; required if there is no default.
    pub fn number(&mut self, section: &mut Section, key: &'static str, range: (f64, f64), default: Option<f64>) -> f64 {
        let own = self.unadjusted_number(section, key, range, default);
        self.adjusted(&section.full_key(key), own)
    }

    fn unadjusted_number(
        &mut self,
        section: &mut Section,
        key: &'static str,
        (min, max): (f64, f64),
        default: Option<f64>,
    ) -> f64 {
        let path = section.full_key(key);
        let allowed = format!("{min} to {max}");
        self.record_key(&path, &allowed, default.map_or("required".into(), |d| d.to_string()));
        let (item, line) = self.item(section, key);
        let Some(item) = item else {
            if default.is_none() {
                self.add_problem_on_line(section, key, line, "", (&allowed, "missing"));
            }
            return default.unwrap_or(min);
        };
        match as_number(item) {
            Some(value) if value >= min && value <= max => value,
            Some(_) => {
                self.add_problem_on_line(section, key, line, &display_value(item), (&allowed, "out of range"));
                default.unwrap_or(min)
            }
            None => {
                self.add_problem_on_line(section, key, line, &display_value(item), (&allowed, "not a number"));
                default.unwrap_or(min)
            }
        }
    }

    /// Reads an optional number; `None` if the key is missing.
    pub fn optional_number(&mut self, section: &mut Section, key: &'static str, range: (f64, f64)) -> Option<f64> {
        let present = section.has(key);
        let path = section.full_key(key);
        self.record_key(&path, &format!("{} to {}", range.0, range.1), "none".into());
        let own = self.unadjusted_number(section, key, range, Some(range.0));
        present.then(|| self.adjusted(&path, own))
    }

    /// Reads an integer within [min, max]; required if there is no default.
    pub fn integer(&mut self, section: &mut Section, key: &'static str, (min, max): (i64, i64), default: Option<i64>) -> i64 {
        let path = section.full_key(key);
        let allowed = format!("whole number {min} to {max}");
        self.record_key(&path, &allowed, default.map_or("required".into(), |d| d.to_string()));
        let (item, line) = self.item(section, key);
        let Some(item) = item else {
            if default.is_none() {
                self.add_problem_on_line(section, key, line, "", (&allowed, "missing"));
            }
            return default.unwrap_or(min);
        };
        match item.as_integer() {
            Some(value) if (min..=max).contains(&value) => value,
            Some(_) => {
                self.add_problem_on_line(section, key, line, &display_value(item), (&allowed, "out of range"));
                default.unwrap_or(min)
            }
            None => {
                self.add_problem_on_line(section, key, line, &display_value(item), (&allowed, "not a whole number"));
                default.unwrap_or(min)
            }
        }
    }

    /// Reads an optional integer; `None` if the key is missing.
    pub fn optional_integer(&mut self, section: &mut Section, key: &'static str, range: (i64, i64)) -> Option<i64> {
        let present = section.has(key);
        let value = self.integer(section, key, range, Some(range.0));
        self.describe_default(section, key, "none");
        present.then_some(value)
    }

    /// Reads a Boolean value.
    pub fn boolean(&mut self, section: &mut Section, key: &'static str, default: bool) -> bool {
        let path = section.full_key(key);
        self.record_key(&path, "true or false", default.to_string());
        let (item, line) = self.item(section, key);
        let Some(item) = item else { return default };
        item.as_bool().unwrap_or_else(|| {
            self.add_problem_on_line(section, key, line, &display_value(item), ("true or false", "not true or false"));
            default
        })
    }

    /// Reads a string; required if there is no default.
    pub fn text(&mut self, section: &mut Section, key: &'static str, default: Option<&str>) -> String {
        let path = section.full_key(key);
        self.record_key(&path, "text", default.map_or("required".into(), str::to_string));
        let (item, line) = self.item(section, key);
        match (item, item.and_then(Item::as_str)) {
            (_, Some(value)) => value.to_string(),
            (Some(item), None) => {
                self.add_problem_on_line(section, key, line, &display_value(item), ("text", "not a string"));
                default.unwrap_or_default().to_string()
            }
            (None, None) => {
                if default.is_none() {
                    self.add_problem_on_line(section, key, line, "", ("text", "missing"));
                }
                default.unwrap_or_default().to_string()
            }
        }
    }

    /// Reads one of several keywords and returns its value; required if there is no default.
    pub fn keyword<T: Copy>(
        &mut self,
        section: &mut Section,
        key: &'static str,
        words: &[(&'static str, T)],
        default: Option<usize>,
    ) -> T {
        let path = section.full_key(key);
        let allowed = words.iter().map(|(w, _)| *w).collect::<Vec<_>>().join(", ");
        self.record_key(&path, &allowed, default.map_or("required".into(), |d| words[d].0.to_string()));
        let (item, line) = self.item(section, key);
        let fallback = words[default.unwrap_or(0)].1;
        let Some(item) = item else {
            if default.is_none() {
                self.add_problem_on_line(section, key, line, "", (&allowed, "missing"));
            }
            return fallback;
        };
        let found = item.as_str().and_then(|text| words.iter().find(|(w, _)| *w == text));
        found.map_or_else(
            || {
                self.add_problem_on_line(section, key, line, &display_value(item), (&allowed, "unknown keyword"));
                fallback
            },
            |(_, value)| *value,
        )
    }

    /// Reads a list of exactly `N` numbers, each within the range; required if there is no default.
    pub fn numbers<const N: usize>(
        &mut self,
        section: &mut Section,
        key: &'static str,
        range: (f64, f64),
        default: Option<[f64; N]>,
    ) -> [f64; N] {
        let path = section.full_key(key);
        let allowed = format!("{N} numbers, each {} to {}", range.0, range.1);
        self.record_key(&path, &allowed, default.map_or("required".into(), |d| format!("{d:?}")));
        let (item, line) = self.item(section, key);
        let fallback = default.unwrap_or([range.0; N]);
        let Some(item) = item else {
            if default.is_none() {
                self.add_problem_on_line(section, key, line, "", (&allowed, "missing"));
            }
            return fallback;
        };
        let values = item.as_value().and_then(|v| number_list(v, range)).and_then(|v| <[f64; N]>::try_from(v).ok());
        values.unwrap_or_else(|| {
            self.add_problem_on_line(section, key, line, &display_value(item), (&allowed, "not a valid list"));
            fallback
        })
    }

    /// Reads a list of points with three numbers each; empty if the key is missing.
    pub fn points(&mut self, section: &mut Section, key: &'static str, range: (f64, f64)) -> Vec<[f64; 3]> {
        let path = section.full_key(key);
        let allowed = format!("list of [east, north, up], each {} to {}", range.0, range.1);
        self.record_key(&path, &allowed, "none".into());
        let (item, line) = self.item(section, key);
        let Some(item) = item else { return Vec::new() };
        let point = |v: &Value| number_list(v, range).and_then(|p| <[f64; 3]>::try_from(p).ok());
        let points = item.as_array().map(|array| array.iter().map(point).collect::<Option<Vec<_>>>());
        points.flatten().unwrap_or_else(|| {
            self.add_problem_on_line(section, key, line, &display_value(item), (&allowed, "not a valid list"));
            Vec::new()
        })
    }

    /// Reads a list of integers; empty if the key is missing.
    pub fn integers(&mut self, section: &mut Section, key: &'static str, (min, max): (i64, i64)) -> Vec<i64> {
        let allowed = format!("list of whole numbers, each {min} to {max}");
        self.integer_list(section, key, &allowed, &|i| (min..=max).contains(&i))
    }

    /// Reads a list of integers, each one of `values`; empty if the key is missing.
    pub fn integers_among(&mut self, section: &mut Section, key: &'static str, values: &[i64]) -> Vec<i64> {
        let words: Vec<String> = values.iter().map(ToString::to_string).collect();
        let allowed = format!("list of whole numbers among {}", words.join(", "));
        self.integer_list(section, key, &allowed, &|i| values.contains(&i))
    }

    fn integer_list(
        &mut self,
        section: &mut Section,
        key: &'static str,
        allowed: &str,
        is_allowed: &dyn Fn(i64) -> bool,
    ) -> Vec<i64> {
        let path = section.full_key(key);
        self.record_key(&path, allowed, "none".into());
        let (item, line) = self.item(section, key);
        let Some(item) = item else { return Vec::new() };
        let one = |v: &Value| v.as_integer().filter(|i| is_allowed(*i));
        let values = item.as_array().map(|array| array.iter().map(one).collect::<Option<Vec<_>>>());
        values.flatten().unwrap_or_else(|| {
            self.add_problem_on_line(section, key, line, &display_value(item), (allowed, "not a valid list"));
            Vec::new()
        })
    }

    /// Reads a list of strings; empty if the key is missing.
    pub fn texts(&mut self, section: &mut Section, key: &'static str) -> Vec<String> {
        let path = section.full_key(key);
        let allowed = "list of texts";
        self.record_key(&path, allowed, "none".into());
        let (item, line) = self.item(section, key);
        let Some(item) = item else { return Vec::new() };
        let one = |v: &Value| v.as_str().map(str::to_owned);
        let values = item.as_array().map(|array| array.iter().map(one).collect::<Option<Vec<_>>>());
        values.flatten().unwrap_or_else(|| {
            self.add_problem_on_line(section, key, line, &display_value(item), (allowed, "not a valid list"));
            Vec::new()
        })
    }

    /// Records a problem for each unknown key. Call this after reading all keys of the table.
    pub fn finish(&mut self, section: &Section) {
        let Some(table) = section.table else { return };
        for (key, item) in table.iter() {
            if section.read_keys.contains(&key) {
                continue;
            }
            let line = self.line_of(item).unwrap_or(section.line);
            let near = |s: &&&str| is_likely_typo(s, key);
            let known = section.read_keys.iter().filter(near).min_by_key(|s| edit_distance(s, key));
            let message = known.map_or("unknown key".to_string(), |k| format!("unknown key; did you mean {k}?"));
            let allowed = section.read_keys.join(", ");
            self.add_problem_on_line(section, key, line, &display_value(item), (&allowed, &message));
        }
    }
}

impl Section<'_> {
    /// Returns the full path of a key, such as `wind.speed_m_s`.
    #[must_use]
    pub fn full_key(&self, key: &str) -> String {
        if self.path.is_empty() { key.to_string() } else { format!("{}.{key}", self.path) }
    }

    /// Returns the full path of a key with the index of each repeated table, such as `tasks[2].name`.
    fn location_of(&self, key: &str) -> String {
        if self.location.is_empty() { key.to_string() } else { format!("{}.{key}", self.location) }
    }

    /// Returns the line number where the table starts, from 1.
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

/// Returns the tables of an array, each with the offset at which it starts; `None` if the item is not an array of tables.
fn repeated_tables(item: &Item) -> Option<Vec<(&dyn TableLike, Option<usize>)>> {
    if let Some(tables) = item.as_array_of_tables() {
        let start = |table: &toml_edit::Table| table.span().map(|span| span.start);
        return Some(tables.iter().map(|table| (table as &dyn TableLike, start(table))).collect());
    }
    item.as_array()?
        .iter()
        .map(|value| {
            let (table, start) = (value.as_inline_table()?, value.span()?.start);
            Some((table as &dyn TableLike, Some(start)))
        })
        .collect()
}

fn as_number(item: &Item) -> Option<f64> {
    item.as_float().or_else(|| item.as_integer().map(|i| i as f64)).filter(|v| !v.is_nan())
}

fn number_list(value: &Value, (min, max): (f64, f64)) -> Option<Vec<f64>> {
    let one = |v: &Value| v.as_float().or_else(|| v.as_integer().map(|i| i as f64)).filter(|v| *v >= min && *v <= max);
    value.as_array()?.iter().map(one).collect()
}

/// Replaces line breaks and other control characters with spaces, so that each problem stays on one line.
fn one_line(text: &str) -> String {
    text.replace(char::is_control, " ")
}

/// Returns the value as written in the file, truncated to 60 characters.
fn display_value(item: &Item) -> String {
    const MAX_CHARACTERS: usize = 60;
    let text: String = item.to_string().trim().replace('\n', " ").chars().take(MAX_CHARACTERS + 1).collect();
    if text.chars().count() > MAX_CHARACTERS {
        format!("{}…", text.chars().take(MAX_CHARACTERS).collect::<String>())
    } else {
        text
    }
}

/// Returns true if two keys differ by a likely typo: at most two edits per five characters.
fn is_likely_typo(known: &str, key: &str) -> bool {
    5 * edit_distance(known, key) <= 2 * known.chars().count().max(key.chars().count())
}

/// Returns the Levenshtein distance between two keys, for suggestions.
fn edit_distance(a: &str, b: &str) -> usize {
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
