//! Finds messages in the catalog that no code uses.

use std::collections::BTreeSet;

/// Beginnings of the names that are composed at run time.
const COMPOSED: [&str; 4] = ["plan-reason-", "plan-rule-", "job-", "terms-element-"];

/// Returns the names of the messages in a catalog file.
fn messages(file: &str) -> impl Iterator<Item = &str> {
    let is_name = |name: &&str| name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(is_name_char);
    file.lines().filter_map(|line| line.split_once(" =")).map(|(name, _)| name).filter(is_name)
}

fn is_name_char(c: char) -> bool {
    c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'
}

/// Returns the quoted strings in a source file that can be names of messages.
pub fn quoted_names(source: &str) -> impl Iterator<Item = &str> {
    source.split('"').filter(|text| !text.is_empty() && text.chars().all(is_name_char))
}

/// Returns the messages of a catalog file that are not among the names that the code uses.
pub fn unused_messages(file: &str, used: &BTreeSet<String>) -> Vec<String> {
    let is_composed = |name: &str| COMPOSED.iter().any(|start| name.starts_with(start));
    messages(file).filter(|name| !is_composed(name) && !used.contains(*name)).map(str::to_owned).collect()
}

#[test]
fn exact_unused_messages_are_found() {
    let file = "# a-comment = no\nx-used = 1\nx-unused =\n    { $k ->\n        [one] y = 1\n    }\njob-any = 2\n";
    let used = quoted_names("text!(l, \"x-used\", k = 1); // x-unused").map(str::to_owned).collect();
    assert_eq!(unused_messages(file, &used), ["x-unused"]);
}
