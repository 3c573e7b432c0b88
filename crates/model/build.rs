//! Embeds the shipped scenario and vehicle files in the program, so that it works in any folder. New files are included
//! automatically.

use std::ffi::OsStr;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Path of the workspace root relative to this package.
const WORKSPACE_ROOT: &str = "../..";

fn main() {
    let root = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let mut code = String::new();
    for (name, folder) in [("SCENARIOS", "scenarios"), ("VEHICLES", "vehicle-params")] {
        println!("cargo::rerun-if-changed={WORKSPACE_ROOT}/{folder}");
        let files = toml_files(&Path::new(&root).join(WORKSPACE_ROOT).join(folder));
        code.push_str(&file_constants(&files, folder));
        code.push_str(&file_table(name, &files, folder));
    }
    let out = Path::new(&env::var("OUT_DIR").unwrap_or_default()).join("shipped.rs");
    if let Err(error) = fs::write(&out, code) {
        println!("cargo::error=cannot write {}: {error}", out.display());
    }
}

/// Returns Rust code that defines a constant with the text of each file.
fn file_constants(files: &[PathBuf], folder: &str) -> String {
    let mut code = String::new();
    for path in files {
        // The path is relative to the manifest, so that the source tree can be moved without a clean build.
        let (stem, file) = (to_text(path.file_stem()), format!("/{WORKSPACE_ROOT}/{folder}/{}", to_text(path.file_name())));
        let _ = writeln!(code, "/// Text of `{folder}/{stem}.toml`.");
        let _ = writeln!(
            code,
            "pub const {}: &str = include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), {file:?}));",
            constant_name(&stem)
        );
    }
    code
}

/// Returns Rust code that defines a list with the stem and text of each file.
fn file_table(name: &str, files: &[PathBuf], folder: &str) -> String {
    let mut code = format!("/// Stem and text of each shipped file in `{folder}`.\npub const {name}: &[(&str, &str)] = &[");
    for path in files {
        let stem = to_text(path.file_stem());
        let _ = write!(code, "({stem:?}, {}), ", constant_name(&stem));
    }
    code.push_str("];\n");
    code
}

/// Returns the name of a file's constant, such as `TWO_BRIDGES` for `two-bridges`.
fn constant_name(stem: &str) -> String {
    stem.to_uppercase().replace('-', "_")
}

fn to_text(part: Option<&OsStr>) -> String {
    part.and_then(|part| part.to_str()).unwrap_or_default().to_owned()
}

fn toml_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<_> =
        entries.flatten().map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    files.sort();
    files
}
