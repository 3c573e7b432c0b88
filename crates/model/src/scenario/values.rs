//! The values in a scenario's text, by their locations, for a form. Also reads files that are valid TOML but not valid scenarios.

use super::toml_text::shown;
use crate::key_table::{self, KeyDescription};
use crate::shipped::SCENARIO_README;
use std::collections::BTreeMap;
use std::sync::LazyLock;
use toml_edit::{Document, Item, TableLike, Value};

/// Keys of a table that determine which other keys it uses.
pub const KIND_KEYS: [&str; 3] = ["source", "kind", "step"];

/// Returns the description of every key of a scenario, in the order of the documentation.
#[must_use]
pub fn key_descriptions() -> &'static [KeyDescription] {
    static TABLE: LazyLock<Vec<KeyDescription>> = LazyLock::new(|| key_table::parse(SCENARIO_README));
    &TABLE
}

/// Returns the description of the key at a location, such as `tasks[2].name`.
#[must_use]
pub fn describe(location: &str) -> Option<&'static KeyDescription> {
    let key = without_indices(location);
    key_descriptions().iter().find(|described| described.key == key)
}

/// Returns a location with `[]` instead of each index: the key as in the documentation.
#[must_use]
pub fn without_indices(location: &str) -> String {
    let mut parts = location.split('[');
    let mut key = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        key.push('[');
        key.push_str(part.trim_start_matches(|c: char| c.is_ascii_digit()));
    }
    key
}

/// The values in a scenario's text.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ScenarioValues {
    /// Text of each value by its location, such as `tasks[2].name`: strings without quotes, lists on one line.
    pub texts: BTreeMap<String, String>,
    /// Number of tables of each repeated table by its location, such as `tasks` or `wind.events`.
    pub counts: BTreeMap<String, usize>,
}

impl ScenarioValues {
    /// Reads the values; `None` if the text is not valid TOML.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        let document = Document::parse(text).ok()?;
        let mut values = Self::default();
        values.add_table(document.as_table(), "");
        Some(values)
    }

    /// Returns the text of a value; `None` if it is missing.
    #[must_use]
    pub fn get(&self, location: &str) -> Option<&str> {
        self.texts.get(location).map(String::as_str)
    }

    /// Returns the number of tables of a repeated table.
    #[must_use]
    pub fn count(&self, location: &str) -> usize {
        self.counts.get(location).copied().unwrap_or(0)
    }

    fn add_table(&mut self, table: &dyn TableLike, path: &str) {
        for (key, item) in table.iter() {
            let location = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
            self.add_item(item, &location);
        }
    }

    fn add_item(&mut self, item: &Item, location: &str) {
        if let Some(table) = item.as_table_like() {
            self.add_table(table, location);
        } else if let Some(tables) = item.as_array_of_tables() {
            self.add_repeated(tables.iter().map(|table| table as &dyn TableLike), location);
        } else if let Some(array) = item.as_array().filter(|array| !array.is_empty() && array.iter().all(Value::is_inline_table))
        {
            self.add_repeated(array.iter().filter_map(Value::as_inline_table).map(|table| table as &dyn TableLike), location);
        } else if let Some(value) = item.as_value() {
            self.texts.insert(location.to_owned(), shown(value));
        }
    }

    fn add_repeated<'d>(&mut self, tables: impl Iterator<Item = &'d dyn TableLike>, location: &str) {
        let mut count = 0;
        for (k, table) in tables.enumerate() {
            count = k + 1;
            self.add_table(table, &format!("{location}[{k}]"));
        }
        self.counts.insert(location.to_owned(), count);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shipped::PRACTICE;

    #[test]
    fn exact_values_are_listed_by_location() {
        let values = ScenarioValues::read(PRACTICE).unwrap();
        assert_eq!(values.get("tasks[2].kind"), Some("interlayer"));
        assert_eq!(values.get("ground_team.pad_m"), Some("[-112.0, 78.0, 5.0]"));
        assert_eq!((values.count("tasks"), values.count("bridges"), values.count("lesson")), (4, 2, 0));
        let inline = ScenarioValues::read("tasks = [{ name = \"a\" }, { name = \"b\" }]\nbroken = 1").unwrap();
        assert_eq!((inline.get("tasks[1].name"), inline.count("tasks")), (Some("b"), 2));
        assert_eq!(ScenarioValues::read("a = "), None);
    }

    #[test]
    fn exact_every_documented_key_is_found_by_its_location() {
        assert_eq!(describe("tasks[12].stand_off_m").unwrap().documented.allowed, "2 to 50");
        assert_eq!(describe("bridges[0].arch.span_m").unwrap().documented.default, "98");
        assert_eq!(describe("wind.events[1].kind").unwrap().documented.allowed, "gust, change");
        assert!(describe("tasks.name").is_none() && describe("wind.x").is_none());
        assert!(key_descriptions().len() > 150);
    }
}
