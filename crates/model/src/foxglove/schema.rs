//! JSON schemas that describe the message fields to Foxglove.

use serde_json::{Value, json};

fn object(fields: &[(&str, Value)]) -> Value {
    let fields: serde_json::Map<_, _> = fields.iter().map(|(name, kind)| ((*name).to_owned(), kind.clone())).collect();
    json!({ "type": "object", "properties": fields })
}

fn array(of: &Value) -> Value {
    json!({ "type": "array", "items": of })
}

fn primitive(name: &str) -> Value {
    json!({ "type": name })
}

fn number() -> Value {
    primitive("number")
}

fn number_fields(names: &[&str]) -> Value {
    object(&names.iter().map(|name| (*name, number())).collect::<Vec<_>>())
}

fn time_schema() -> Value {
    object(&[("sec", primitive("integer")), ("nsec", primitive("integer"))])
}

pub(super) fn transforms() -> Value {
    let one = object(&[
        ("timestamp", time_schema()),
        ("parent_frame_id", primitive("string")),
        ("child_frame_id", primitive("string")),
        ("translation", number_fields(&["x", "y", "z"])),
        ("rotation", number_fields(&["x", "y", "z", "w"])),
    ]);
    object(&[("transforms", array(&one))])
}

pub(super) fn fix() -> Value {
    object(&[
        ("timestamp", time_schema()),
        ("frame_id", primitive("string")),
        ("latitude", number()),
        ("longitude", number()),
        ("altitude", number()),
        ("position_covariance", array(&number())),
        ("position_covariance_type", primitive("integer")),
    ])
}

pub(super) fn log() -> Value {
    object(&[
        ("timestamp", time_schema()),
        ("level", primitive("integer")),
        ("message", primitive("string")),
        ("name", primitive("string")),
        ("file", primitive("string")),
        ("line", primitive("integer")),
    ])
}

pub(super) fn camera() -> Value {
    object(&[
        ("timestamp", time_schema()),
        ("frame_id", primitive("string")),
        ("width", primitive("integer")),
        ("height", primitive("integer")),
        ("distortion_model", primitive("string")),
        ("D", array(&number())),
        ("K", array(&number())),
        ("R", array(&number())),
        ("P", array(&number())),
    ])
}

pub(super) fn site() -> Value {
    let pose = object(&[("position", number_fields(&["x", "y", "z"])), ("orientation", number_fields(&["x", "y", "z", "w"]))]);
    let model = object(&[
        ("pose", pose),
        ("scale", number_fields(&["x", "y", "z"])),
        ("color", number_fields(&["r", "g", "b", "a"])),
        ("override_color", primitive("boolean")),
        ("url", primitive("string")),
        ("media_type", primitive("string")),
        ("data", json!({ "type": "string", "contentEncoding": "base64" })),
    ]);
    let pair = object(&[("key", primitive("string")), ("value", primitive("string"))]);
    let mut fields = vec![
        ("timestamp", time_schema()),
        ("frame_id", primitive("string")),
        ("id", primitive("string")),
        ("lifetime", time_schema()),
        ("frame_locked", primitive("boolean")),
        ("metadata", array(&pair)),
    ];
    // Foxglove requires all shape lists; only models are used.
    let shapes = ["arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts"];
    fields.extend(shapes.map(|name| (name, array(&object(&[])))));
    fields.push(("models", array(&model)));
    let deletion = object(&[("timestamp", time_schema()), ("type", primitive("integer")), ("id", primitive("string"))]);
    object(&[("deletions", array(&deletion)), ("entities", array(&object(&fields)))])
}

pub(super) fn battery() -> Value {
    object(&[("timestamp", time_schema()), ("voltage_v", number()), ("current_a", number()), ("remaining_pct", number())])
}

pub(super) fn scoring() -> Value {
    object(&[
        ("timestamp", time_schema()),
        ("clearance_m", number()),
        ("lux", number()),
        ("contact", primitive("string")),
        ("hits", primitive("integer")),
        ("respawns", primitive("integer")),
        ("lamp_on", primitive("boolean")),
        ("speed_m_s", number()),
    ])
}
