//! Generates Rust code from the tables of stored parameters, which clients can read but which have no effect on the vehicle.

#[path = "build/params.rs"]
mod params;

use std::path::Path;
use std::{env, fs};

const STORED: &str = "src/endpoint/vehicle_link/params/stored";

fn main() {
    let root = env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
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
