//! Enforces dependency rules that Cargo cannot: compares every path in the sources with the table in ARCHITECTURE.md.
//! Planted violations of each kind prove that the checks work.
#![allow(clippy::unwrap_used, reason = "a test")]

mod circles;
mod paths;
mod picture;
mod rules;
mod texts;
mod wildcards;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<PathBuf> = entries
        .flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|end| end == "rs"))
        .collect();
    files.sort();
    files
}

/// Returns the source files of all crates and the program.
fn all_sources(root: &Path) -> Vec<PathBuf> {
    let folders = rules::crates().map(|folder| root.join("crates").join(folder)).chain([root.to_owned()]);
    folders.flat_map(|folder| sources(&folder.join("src"))).collect()
}

#[test]
fn exact_every_import_follows_the_layer_rules() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = all_sources(root);
    assert!(files.len() > 500, "only {} files were read", files.len());
    let violations: Vec<String> = files
        .iter()
        .flat_map(|path| {
            let file = path.strip_prefix(root).unwrap().display().to_string();
            rules::violations(&file, &std::fs::read_to_string(path).unwrap())
        })
        .collect();
    assert!(violations.is_empty(), "\n{}", violations.join("\n"));
}

#[test]
fn exact_layer_diagram_matches_the_imports() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut imports = picture::Imports::new();
    for path in all_sources(root) {
        let file = path.strip_prefix(root).unwrap().display().to_string();
        rules::count_imports(&file, &std::fs::read_to_string(&path).unwrap(), &mut imports);
    }
    let (path, drawn) = (root.join("docs/src/images/layers.svg"), picture::svg(&imports));
    if std::env::var_os("SPANDREL_REFERENCE").is_some_and(|value| value == "write") {
        std::fs::write(&path, &drawn).unwrap();
    }
    let same = std::fs::read_to_string(&path).is_ok_and(|committed| committed == drawn);
    assert!(
        same,
        "docs/src/images/layers.svg does not match the imports in the code; regenerate it with SPANDREL_REFERENCE=write cargo test --test layers"
    );
}

#[test]
fn exact_files_have_no_import_cycles() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for folder in rules::crates().map(|folder| format!("crates/{folder}")).chain([".".to_owned()]) {
        let place = root.join(&folder).join("src");
        let name = |path: &PathBuf| path.strip_prefix(&place).unwrap().display().to_string();
        let files = sources(&place).into_iter().map(|path| (name(&path), std::fs::read_to_string(&path).unwrap()));
        // The program's entry point is a separate crate.
        let files: Vec<(String, String)> = files.filter(|(name, _)| name != "main.rs").collect();
        let read = circles::CrateFiles::read(files.iter().map(|(name, text)| (name.as_str(), text.as_str())));
        found.extend(
            read.find_import_cycles()
                .into_iter()
                .map(|circle| format!("{folder}/src, {} files:\n    {}", circle.len(), circle.join("\n    "))),
        );
    }
    assert!(found.is_empty(), "{} import cycles:\n{}", found.len(), found.join("\n"));
}

#[test]
fn exact_matches_on_our_enums_have_no_catch_all_arms() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let code = |path: &PathBuf| paths::without_tests(&paths::tokens(&paths::code_only(&std::fs::read_to_string(path).unwrap())));
    let files: Vec<_> = all_sources(root).into_iter().map(|path| (code(&path), path)).collect();
    let enums = files.iter().flat_map(|(code, _)| wildcards::enums(code)).collect();
    let mut found = Vec::new();
    for (code, path) in &files {
        let file = path.strip_prefix(root).unwrap().display();
        found.extend(
            wildcards::find_catch_all_arms(code, &enums).into_iter().map(|(line, name)| format!("{file}:{line}: {name}")),
        );
    }
    assert!(found.is_empty(), "{} catch-all arms:\n{}", found.len(), found.join("\n"));
}

#[test]
fn exact_every_message_in_the_catalog_is_used() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut used = BTreeSet::new();
    for path in ["crates", "src"].iter().flat_map(|folder| sources(&root.join(folder))) {
        used.extend(texts::quoted_names(&std::fs::read_to_string(path).unwrap()).map(str::to_owned));
    }
    let catalog = std::fs::read_dir(root.join("crates/text/catalog/en")).unwrap();
    let unused: Vec<String> =
        catalog.flat_map(|file| texts::unused_messages(&std::fs::read_to_string(file.unwrap().path()).unwrap(), &used)).collect();
    assert!(unused.is_empty(), "messages without code that shows them: {}", unused.join(", "));
}

#[test]
fn exact_crates_depend_only_on_lower_crates() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for entry in std::fs::read_dir(root.join("crates")).unwrap() {
        let folder = entry.unwrap().file_name().into_string().unwrap();
        assert!(rules::crates().any(|name| name == folder), "crate {folder} is missing in tests/layers/rules.rs");
        let manifest = std::fs::read_to_string(root.join("crates").join(&folder).join("Cargo.toml")).unwrap();
        let dependencies = manifest.split("[dependencies]").nth(1).unwrap().split("\n[").next().unwrap();
        for line in dependencies.lines() {
            let Some(name) = line.strip_prefix("spandrel-").and_then(|rest| rest.split(['.', ' ']).next()) else { continue };
            assert!(rules::may_depend_on(&folder).contains(&name), "{folder} must not depend on {name}");
        }
    }
}

#[test]
fn exact_architecture_page_lists_every_layer_and_real_paths() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let map = std::fs::read_to_string(root.join("ARCHITECTURE.md")).unwrap();
    for layer in rules::layers() {
        assert!(map.contains(&format!("`{layer}`")), "ARCHITECTURE.md does not contain {layer}");
    }
    let quoted = map.split('`').skip(1).step_by(2);
    let places = quoted.filter(|text| {
        ["src/", "crates/", "tests/", "tools/", "scenarios/", "vehicle-params/"].iter().any(|start| text.starts_with(start))
    });
    for place in places {
        assert!(root.join(place).exists(), "ARCHITECTURE.md refers to {place}, which does not exist");
    }
}
