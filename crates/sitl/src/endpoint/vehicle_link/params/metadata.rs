//! Metadata shown by ground stations: the files of MAVLink's component metadata service
//! (<https://mavlink.io/en/services/component_information.html>), generated from the parameter table and served over
//! MAVLink FTP.

use super::ParamValue;
use super::copter_behavior::depends_on_aircraft;
use super::param_view::{COPTER, PX4, ParamView};
use super::row::{ParamSource, Row};
use crate::endpoint::vehicle_link::events;
use serde_json::{Value as Json, json};
use spandrel_mavlink::ftp::checksum;
use std::io::Cursor;
use std::sync::{Arc, LazyLock};

/// The value of COMP_METADATA_TYPE_PARAMETER.
const PARAMETER_METADATA: u8 = 1;
/// The value of COMP_METADATA_TYPE_EVENTS.
const EVENTS_METADATA: u8 = 4;
/// Paths of the files on the vehicle's file server.
const PARAMETER_PATH: &str = "/etc/extras/parameter.json.xz";
const EVENTS_PATH: &str = "/etc/extras/all_events.json.xz";
const GENERAL_PATH: &str = "/etc/extras/general.json.xz";

/// A metadata file with its path and its checksum (CRC-32 as defined by MAVLink FTP).
#[derive(Debug, Clone)]
pub struct MetadataFile {
    /// Path on the file server.
    pub path: &'static str,
    /// URI sent to clients.
    pub uri: String,
    /// Checksum of the compressed content.
    pub crc: u32,
    /// Compressed content.
    pub bytes: Arc<[u8]>,
}

impl MetadataFile {
    fn new(path: &'static str, json: &Json) -> Self {
        let mut bytes = Vec::new();
        // Writing to memory cannot fail; an empty file would be noticed by its checksum and by every client.
        let _ = lzma_rs::xz_compress(&mut Cursor::new(json.to_string()), &mut bytes);
        Self { path, uri: format!("mftp://{path}"), crc: checksum(0, &bytes), bytes: bytes.into() }
    }
}

/// A flavor's metadata files.
#[derive(Debug)]
pub struct MetadataFiles {
    /// The general metadata file, which lists the other files.
    pub general: MetadataFile,
    /// The parameter metadata file.
    pub parameter: MetadataFile,
    /// The events metadata file, if the flavor sends events.
    pub events: Option<MetadataFile>,
}

/// Returns a flavor's metadata files.
#[must_use]
pub fn files(face: &ParamView) -> &'static MetadataFiles {
    static COMMON: LazyLock<MetadataFiles> = LazyLock::new(|| build_metadata_files(&PX4));
    static OTHER: LazyLock<MetadataFiles> = LazyLock::new(|| build_metadata_files(&COPTER));
    if face.cast { &OTHER } else { &COMMON }
}

fn build_metadata_files(face: &ParamView) -> MetadataFiles {
    let parameters: Vec<Json> = face.rows().iter().map(describe).collect();
    let parameter = MetadataFile::new(PARAMETER_PATH, &json!({ "version": 1, "parameters": parameters }));
    let events = (!face.cast).then(|| MetadataFile::new(EVENTS_PATH, &events::definitions()));
    let mut types = vec![json!({ "type": PARAMETER_METADATA, "uri": parameter.uri, "fileCrc": parameter.crc })];
    types.extend(events.iter().map(|file| json!({ "type": EVENTS_METADATA, "uri": file.uri, "fileCrc": file.crc })));
    let general = MetadataFile::new(GENERAL_PATH, &json!({ "version": 1, "metadataTypes": types }));
    MetadataFiles { general, parameter, events }
}

/// Returns the long description, which states whether setting the parameter has an effect.
fn long(row: &Row) -> String {
    if row.token && row.read_only {
        format!("{}. This parameter describes the vehicle and cannot be changed.", row.short)
    } else if row.token {
        format!("{}. No effect on this vehicle; the value is stored only for clients that expect it.", row.short)
    } else {
        row.short.into()
    }
}

fn describe(row: &Row) -> Json {
    let real = matches!(row.default, ParamValue::Real(_));
    let number = |value: f64| if real { json!(value as f32) } else { json!(value as i64) };
    let mut out = json!({
        "name": row.name,
        "type": if real { "Float" } else { "Int32" },
        "group": row.group,
        "category": if row.token { "System" } else { "Standard" },
        "shortDesc": row.short,
        "longDesc": long(row),
        "default": number(row.default.number()),
        "min": number(row.low),
        "max": number(row.high),
    });
    // Values equal to the schema's defaults are omitted because the file is sent over slow links.
    if !row.unit.is_empty() {
        out["units"] = json!(row.unit);
    }
    if row.volatile {
        out["volatile"] = json!(true);
    }
    if real {
        out["decimalPlaces"] = json!(2);
    }
    if depends_on_aircraft(row) {
        out.as_object_mut().map(|fields| fields.remove("default"));
    }
    if matches!(row.source, ParamSource::Capacity(_)) {
        // Depends on the aircraft's battery.
        for key in ["min", "max"] {
            out.as_object_mut().map(|fields| fields.remove(key));
        }
    }
    if !row.bits.is_empty() {
        let bit = |(index, words): &(i32, &str)| json!({ "index": index, "description": words });
        out["bitmask"] = row.bits.iter().map(bit).collect();
    }
    if !row.values.is_empty() {
        let value = |(value, words): &(i32, &str)| json!({ "value": value, "description": words });
        out["values"] = row.values.iter().map(value).collect();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::table;
    use super::*;

    fn decompressed(file: &MetadataFile) -> Json {
        let mut text = Vec::new();
        lzma_rs::xz_decompress(&mut Cursor::new(&file.bytes), &mut text).unwrap();
        serde_json::from_slice(&text).unwrap()
    }

    #[test]
    fn exact_metadata_files_reference_each_other_and_describe_every_parameter() {
        let MetadataFiles { general, parameter, .. } = files(&PX4);
        let general = decompressed(general);
        let entry = &general["metadataTypes"][0];
        assert_eq!((entry["type"].as_u64(), entry["uri"].as_str()), (Some(1), Some(parameter.uri.as_str())));
        assert_eq!(entry["fileCrc"], parameter.crc);
        let described = decompressed(parameter);
        let names: Vec<&str> = described["parameters"].as_array().unwrap().iter().filter_map(|p| p["name"].as_str()).collect();
        assert_eq!(names, table::rows().iter().map(|row| row.name).collect::<Vec<_>>());
        // MAVLink's schema for parameter.json requires these fields and type names.
        for one in described["parameters"].as_array().unwrap() {
            assert!(["Int32", "Float"].contains(&one["type"].as_str().unwrap()));
        }
        let act = described["parameters"].as_array().unwrap().iter().find(|p| p["name"] == "GF_ACTION").unwrap();
        assert_eq!(act["values"][3], json!({ "value": 3, "description": "Return mode" }));
    }
}
