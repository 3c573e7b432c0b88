//! Lists the catalog's files for `include_str!`, and the English messages with their variables. The macro `text!` checks each
//! call against this list at compile time.

use fluent_syntax::ast::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use variables::variables;

mod variables;

/// Folders of the catalog; the first one is the reference.
const FOLDERS: [&str; 3] = ["en", "de", "es"];

fn main() -> Result<(), Box<dyn Error>> {
    let catalog = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?).join("catalog");
    println!("cargo::rerun-if-changed={}", catalog.display());
    let mut code = String::new();
    let mut messages = BTreeMap::new();
    for (index, folder) in FOLDERS.iter().enumerate() {
        let files = files(&catalog.join(folder))?;
        writeln!(code, "const {}: &[&str] = &[", folder.to_uppercase())?;
        for file in &files {
            writeln!(code, "    include_str!({:?}),", file.display().to_string())?;
            if index == 0 {
                read_messages(file, &mut messages)?;
            }
        }
        writeln!(code, "];")?;
    }
    writeln!(code, "const MESSAGES: &[(&str, &[&str])] = &[")?;
    for (id, variables) in &messages {
        let variables: Vec<&String> = variables.iter().collect();
        writeln!(code, "    ({id:?}, &{variables:?}),")?;
    }
    writeln!(code, "];")?;
    fs::write(Path::new(&env::var("OUT_DIR")?).join("messages.rs"), code)?;
    Ok(())
}

/// Returns the catalog files in a folder, sorted by name.
fn files(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        println!("cargo::rerun-if-changed={}", path.display());
        if path.extension().is_some_and(|extension| extension == "ftl") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn read_messages(file: &Path, messages: &mut BTreeMap<String, BTreeSet<String>>) -> Result<(), Box<dyn Error>> {
    let text = fs::read_to_string(file)?;
    let resource = fluent_syntax::parser::parse(text).map_err(|(_, errors)| format!("{}: {errors:?}", file.display()))?;
    for entry in resource.body {
        let Entry::Message(message) = entry else { continue };
        let variables = message.value.as_ref().map(variables).unwrap_or_default();
        if messages.insert(message.id.name.clone(), variables).is_some() {
            return Err(format!("{}: {} is defined twice", file.display(), message.id.name).into());
        }
    }
    Ok(())
}
