//! Reference pages that are generated from the code. Each test compares a committed page with newly generated text; run
//! the tests with `SPANDREL_REFERENCE=write` to regenerate the pages.
#![allow(clippy::unwrap_used, reason = "a test")]

// Window and gamepad options depend on features.
#[cfg(all(feature = "view", feature = "gamepad"))]
mod commands;
mod contract;
mod dictionary;
mod messages;
mod parameters;
mod pilots;
mod table;

use std::path::Path;

/// Returns the beginning of a page: the title, a note that the page is generated, and an introduction.
fn page_head(title: &str, about: &str) -> String {
    format!("# {title}\n\n<!-- Generated from the code: SPANDREL_REFERENCE=write cargo test --test reference -->\n\n{about}\n")
}

/// Compares a page with the committed file, or writes the file.
fn check(page: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/src/reference").join(page);
    if std::env::var_os("SPANDREL_REFERENCE").is_some_and(|value| value == "write") {
        std::fs::write(&path, text).unwrap();
        return;
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    let differs = committed.lines().zip(text.lines()).position(|(a, b)| a != b).unwrap_or(committed.lines().count());
    let now = text.lines().nth(differs).unwrap_or_default();
    assert!(
        committed == text,
        "{page}, line {}: expected `{now}`; regenerate the page with SPANDREL_REFERENCE=write cargo test --test reference",
        differs + 1
    );
}

/// The tables of scenario and vehicle keys are stored next to the files; the pages must include them.
#[test]
fn exact_key_pages_include_the_verified_tables() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let read = |file: &str| std::fs::read_to_string(root.join(file)).unwrap();
    let pages = [("scenario-keys.md", "scenarios/README.md", ":keys"), ("vehicle-keys.md", "vehicle-params/README.md", "")];
    for (page, table, part) in pages {
        let include = format!("{{{{#include ../../../{table}{part}}}}}");
        assert!(read(&format!("docs/src/reference/{page}")).contains(&include), "{page} lacks {include}");
        assert!(read(table).contains(if part.is_empty() { "|" } else { "<!-- ANCHOR: keys -->" }), "{table}");
    }
}
