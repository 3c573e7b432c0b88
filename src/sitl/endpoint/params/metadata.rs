//! What a ground station shows beside names and values: the files of MAVLink's component metadata service
//! (<https://mavlink.io/en/services/component_information.html>), made from the table and served over MAVLink FTP.

use super::Value;
use super::face::{COPTER, Face, PX4};
use super::table::{Behind, Row};
use crate::mav::ftp::checksum;
use serde_json::{Value as Json, json};
use std::io::Cursor;
use std::sync::{Arc, LazyLock};

/// COMP_METADATA_TYPE_GENERAL and COMP_METADATA_TYPE_PARAMETER.
const PARAMETER: u8 = 1;
/// Where the files lie on our own file server.
const PARAMETER_PATH: &str = "/etc/extras/parameter.json.xz";
const GENERAL_PATH: &str = "/etc/extras/general.json.xz";

/// A file, where it lies, and its checksum (CRC-32 as MAVLink FTP counts it).
#[derive(Debug, Clone)]
pub struct File {
    /// Path on the file server.
    pub path: &'static str,
    /// What clients ask for.
    pub uri: String,
    /// Checksum of the bytes.
    pub crc: u32,
    /// Content, compressed.
    pub bytes: Arc<[u8]>,
}

impl File {
    fn new(path: &'static str, json: &Json) -> Self {
        let mut bytes = Vec::new();
        // Writing to memory does not fail; an empty file would show in its checksum and in every client.
        let _ = lzma_rs::xz_compress(&mut Cursor::new(json.to_string()), &mut bytes);
        Self { path, uri: format!("mftp://{path}"), crc: checksum(0, &bytes), bytes: bytes.into() }
    }
}

/// Both files of one flavour's parameters.
#[derive(Debug)]
pub struct Files {
    /// The file that leads to all others.
    pub general: File,
    /// The file about the parameters.
    pub parameter: File,
}

/// The files about the parameters as a flavour shows them.
#[must_use]
pub fn files(face: &Face) -> &'static Files {
    static COMMON: LazyLock<Files> = LazyLock::new(|| make(&PX4));
    static OTHER: LazyLock<Files> = LazyLock::new(|| make(&COPTER));
    if face.cast { &OTHER } else { &COMMON }
}

fn make(face: &Face) -> Files {
    let parameters: Vec<Json> = face.rows().iter().map(describe).collect();
    let parameter = File::new(PARAMETER_PATH, &json!({ "version": 1, "parameters": parameters }));
    let types = json!([{ "type": PARAMETER, "uri": parameter.uri, "fileCrc": parameter.crc }]);
    let general = File::new(GENERAL_PATH, &json!({ "version": 1, "metadataTypes": types }));
    Files { general, parameter }
}

fn describe(row: &Row) -> Json {
    let real = matches!(row.default, Value::Real(_));
    let number = |value: f64| if real { json!(value as f32) } else { json!(value as i64) };
    let mut out = json!({
        "name": row.name,
        "type": if real { "Float" } else { "Int32" },
        "group": row.group,
        "category": if row.token { "System" } else { "Standard" },
        "shortDesc": row.short,
        "longDesc": if row.token && row.read_only {
            "Present because clients look for it; it tells what is so, and cannot be changed."
        } else if row.token { "Present because clients look for it; this vehicle does not depend on it." } else { row.short },
        "units": row.unit,
        "default": number(row.default.number()),
        "min": number(row.low),
        "max": number(row.high),
        "rebootRequired": false,
        "volatile": row.volatile,
    });
    if real {
        out["decimalPlaces"] = json!(2);
    }
    if matches!(row.behind, Behind::Capacity(_)) {
        // They depend on the aircraft's battery.
        for key in ["default", "min", "max"] {
            out.as_object_mut().map(|fields| fields.remove(key));
        }
    }
    if !row.values.is_empty() {
        let value = |(value, words): &(i32, &str)| json!({ "value": value, "description": words });
        out["values"] = row.values.iter().map(value).collect();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::table::ROWS;
    use super::*;

    fn unpacked(file: &File) -> Json {
        let mut text = Vec::new();
        lzma_rs::xz_decompress(&mut Cursor::new(&file.bytes), &mut text).unwrap();
        serde_json::from_slice(&text).unwrap()
    }

    #[test]
    fn exact_the_files_lead_to_each_other_and_describe_every_parameter() {
        let Files { general, parameter } = files(&PX4);
        let general = unpacked(general);
        let entry = &general["metadataTypes"][0];
        assert_eq!((entry["type"].as_u64(), entry["uri"].as_str()), (Some(1), Some(parameter.uri.as_str())));
        assert_eq!(entry["fileCrc"], parameter.crc);
        let described = unpacked(parameter);
        let names: Vec<&str> = described["parameters"].as_array().unwrap().iter().filter_map(|p| p["name"].as_str()).collect();
        assert_eq!(names, ROWS.iter().map(|row| row.name).collect::<Vec<_>>());
        // MAVLink's schema for parameter.json asks for these, and types of these names.
        for one in described["parameters"].as_array().unwrap() {
            assert!(["Int32", "Float"].contains(&one["type"].as_str().unwrap()));
        }
        let act = described["parameters"].as_array().unwrap().iter().find(|p| p["name"] == "GF_ACTION").unwrap();
        assert_eq!(act["values"][3], json!({ "value": 3, "description": "Return mode" }));
    }
}
