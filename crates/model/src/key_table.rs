//! The tables of keys in the READMEs of scenarios and vehicles: what each key means and which values it allows. A test compares
//! them with the code.

use crate::toml::DocumentedKey;

/// A row in a table of keys.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyDescription {
    /// Key with its path; `[]` marks a repeated table, as in `tasks[].name`.
    pub key: String,
    /// Allowed values and default.
    pub documented: DocumentedKey,
    /// Meaning of the key, in Markdown.
    pub meaning: String,
}

const HEADER: &str = "| key | allowed | default | meaning |";

/// Returns the rows of all tables of keys in a README, in file order. Rows that do not have four columns are omitted.
#[must_use]
pub fn parse(readme: &str) -> Vec<KeyDescription> {
    let tables = readme.split(HEADER).skip(1).flat_map(|rest| rest.lines().skip(1).take_while(|line| !line.is_empty()));
    tables.filter_map(row).collect()
}

fn row(line: &str) -> Option<KeyDescription> {
    let cells: Vec<&str> = line.strip_prefix("| `")?.strip_suffix(" |")?.splitn(4, " | ").collect();
    let [key, allowed, default, meaning] = cells[..] else { return None };
    Some(KeyDescription {
        key: key.trim_end_matches('`').to_owned(),
        documented: DocumentedKey { allowed: allowed.into(), default: default.into() },
        meaning: meaning.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_rows_of_all_tables_are_read() {
        let table = |row: &str| format!("# Head\n\n{HEADER}\n|---|---|---|---|\n{row}\n\nText | with | bars |\n");
        let first = table("| `wind.up_m_s` | -10 to 10 | 0 | Vertical wind | not `x` |");
        let rows = parse(&format!("{first}{}", table("| broken |")));
        let documented = DocumentedKey { allowed: "-10 to 10".into(), default: "0".into() };
        assert_eq!(rows, [KeyDescription { key: "wind.up_m_s".into(), documented, meaning: "Vertical wind | not `x`".into() }]);
    }
}
