//! Parameter reference page for both autopilots, generated from the metadata that ground stations receive.

use crate::table::{code, table};
use crate::{check, page_head};
use serde_json::Value;
use spandrel_sitl::endpoint::params::param_view::{COPTER, PX4};
use spandrel_sitl::endpoint::params::{ParamView, metadata};
use std::io::Cursor;

fn described(face: &ParamView) -> Vec<Value> {
    let mut text = Vec::new();
    lzma_rs::xz_decompress(&mut Cursor::new(&metadata::files(face).parameter.bytes), &mut text).unwrap();
    let file: Value = serde_json::from_slice(&text).unwrap();
    file["parameters"].as_array().unwrap().clone()
}

fn text(parameter: &Value, key: &str) -> String {
    match &parameter[key] {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        // Formats a 32-bit float with its shortest exact representation.
        Value::Number(number) if parameter["type"] == "Float" => {
            number.as_f64().map_or_else(String::new, |value| (value as f32).to_string())
        }
        other => other.to_string(),
    }
}

fn range(parameter: &Value) -> String {
    match (text(parameter, "min"), text(parameter, "max")) {
        (low, high) if low.is_empty() || high.is_empty() => "aircraft-specific".to_owned(),
        (low, high) => format!("{low} to {high}"),
    }
}

/// Returns the description, including the names of values or bits.
fn meaning(parameter: &Value) -> String {
    let listed = |key: &str, number: &str| {
        let list = parameter[key].as_array()?;
        let words = list.iter().map(|one| format!("{} {}", one[number], text(one, "description")));
        Some(words.collect::<Vec<_>>().join(", "))
    };
    let short = text(parameter, "shortDesc");
    match listed("values", "value").or_else(|| listed("bitmask", "index").map(|bits| format!("bits {bits}"))) {
        Some(words) => format!("{short}: {words}."),
        None => format!("{short}."),
    }
}

fn rows(parameters: &[Value], acts: bool) -> String {
    let standard = |parameter: &&Value| (parameter["category"] == "Standard") == acts;
    let row = |parameter: &Value| {
        let default = text(parameter, "default");
        let default = if default.is_empty() { "aircraft-specific".to_owned() } else { default };
        let (name, kind, unit) = (code(&text(parameter, "name")), text(parameter, "type"), text(parameter, "units"));
        vec![name, kind, unit, range(parameter), default, meaning(parameter)]
    };
    table(&["name", "type", "unit", "range", "default", "meaning"], parameters.iter().filter(standard).map(row))
}

#[test]
fn exact_parameters_page_matches_the_code() {
    let about = "Names, units, ranges and defaults of all parameters, as the vehicle reports them to ground stations (MAVLink \
                 component metadata). Stored parameters have no effect. The vehicle keeps their values for clients that expect them.";
    let mut page = page_head("Parameters", about);
    for (title, face) in [("PX4 and generic interface", &PX4), ("ArduPilot interface", &COPTER)] {
        let parameters = described(face);
        page.push_str(&format!("\n## {title}: active parameters\n\n{}", rows(&parameters, true)));
        page.push_str(&format!("\n## {title}: stored parameters\n\n{}", rows(&parameters, false)));
    }
    check("parameters.md", &page);
}
