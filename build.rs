//! Lists the shipped scenario and vehicle files, so that the program carries them and works from any folder. A new file needs no
//! registration: it is found here.

#[path = "build/params.rs"]
mod params;

use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

/// The parameters that are stored and described, and act on nothing.
const STORED: &str = "src/sitl/endpoint/params/stored";

fn main() {
    let root = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let mut code = String::new();
    for (name, folder) in [("SCENARIOS", "scenarios"), ("VEHICLES", "vehicle-params")] {
        println!("cargo::rerun-if-changed={folder}");
        let _ = writeln!(code, "/// Shipped files of `{folder}`: stem and text.\npub const {name}: &[(&str, &str)] = &[");
        for path in toml_files(&Path::new(&root).join(folder)) {
            let text = |part: Option<&std::ffi::OsStr>| part.and_then(|part| part.to_str()).unwrap_or_default().to_owned();
            // Relative to the manifest, so that a folder that was moved builds as it is.
            let (stem, file) = (text(path.file_stem()), format!("/{folder}/{}", text(path.file_name())));
            let _ = writeln!(code, "    ({stem:?}, include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), {file:?}))),");
        }
        code.push_str("];\n");
    }
    write("shipped.rs", &code);
    println!("cargo::rerun-if-changed={STORED}");
    match params::tables(&Path::new(&root).join(STORED)) {
        Ok(code) => write("stored_params.rs", &code),
        Err(error) => println!("cargo::error={error}"),
    }
}

fn write(name: &str, code: &str) {
    let out = Path::new(&env::var("OUT_DIR").unwrap_or_default()).join(name);
    if let Err(error) = fs::write(&out, code) {
        println!("cargo::error=cannot write {}: {error}", out.display());
    }
}

fn toml_files(folder: &Path) -> Vec<std::path::PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<_> =
        entries.flatten().map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|end| end == "toml")).collect();
    files.sort();
    files
}
