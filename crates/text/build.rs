//! Lists the catalog's files for `include_str!`, and the English messages with their variables. The macro `text!` checks each
//! call against this list at compile time.

use fluent_syntax::ast::{CallArguments, Entry, Expression, InlineExpression, Pattern, PatternElement};
use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

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
        let mut variables = BTreeSet::new();
        if let Some(pattern) = &message.value {
            collect_pattern(pattern, &mut variables);
        }
        if messages.insert(message.id.name.clone(), variables).is_some() {
            return Err(format!("{}: {} is defined twice", file.display(), message.id.name).into());
        }
    }
    Ok(())
}

fn collect_pattern(pattern: &Pattern<String>, variables: &mut BTreeSet<String>) {
    for element in &pattern.elements {
        if let PatternElement::Placeable { expression } = element {
            collect_expression(expression, variables);
        }
    }
}

fn collect_expression(expression: &Expression<String>, variables: &mut BTreeSet<String>) {
    match expression {
        Expression::Inline(inline) => collect_inline(inline, variables),
        Expression::Select { selector, variants } => {
            collect_inline(selector, variables);
            variants.iter().for_each(|variant| collect_pattern(&variant.value, variables));
        }
    }
}

fn collect_inline(inline: &InlineExpression<String>, variables: &mut BTreeSet<String>) {
    match inline {
        InlineExpression::VariableReference { id } => drop(variables.insert(id.name.clone())),
        InlineExpression::Placeable { expression } => collect_expression(expression, variables),
        InlineExpression::FunctionReference { arguments, .. } => collect_arguments(arguments, variables),
        InlineExpression::TermReference { arguments, .. } => {
            arguments.iter().for_each(|arguments| collect_arguments(arguments, variables));
        }
        InlineExpression::StringLiteral { .. }
        | InlineExpression::NumberLiteral { .. }
        | InlineExpression::MessageReference { .. } => {}
    }
}

fn collect_arguments(arguments: &CallArguments<String>, variables: &mut BTreeSet<String>) {
    arguments.positional.iter().for_each(|argument| collect_inline(argument, variables));
    arguments.named.iter().for_each(|argument| collect_inline(&argument.value, variables));
}
