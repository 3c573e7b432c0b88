//! JSON schemas that describe the message fields to Foxglove.

use serde_json::{Value, json};

fn object(fields: &[(&str, Value)]) -> Value {
    let fields: serde_json::Map<_, _> = fields.iter().map(|(name, kind)| ((*name).to_owned(), kind.clone())).collect();
    json!({ "type": "object", "properties": fields })
}

fn list(of: &Value) -> Value {
    json!({ "type": "array", "items": of })
}

fn kind(name: &str) -> Value {
    json!({ "type": name })
}

fn number() -> Value {
    kind("number")
}

fn numbers(names: &[&str]) -> Value {
    object(&names.iter().map(|name| (*name, number())).collect::<Vec<_>>())
}

fn time_schema() -> Value {
    object(&[("sec", kind("integer")), ("nsec", kind("integer"))])
}

pub(super) fn transforms() -> Value {
    let one = object(&[
        ("timestamp", time_schema()),
        ("parent_frame_id", kind("string")),
        ("child_frame_id", kind("string")),
        ("translation", numbers(&["x", "y", "z"])),
        ("rotation", numbers(&["x", "y", "z", "w"])),
    ]);
    object(&[("transforms", list(&one))])
}

pub(super) fn fix() -> Value {
    object(&[
        ("timestamp", time_schema()),
        ("frame_id", kind("string")),
        ("latitude", number()),
        ("longitude", number()),
        ("altitude", number()),
        ("position_covariance", list(&number())),
        ("position_covariance_type", kind("integer")),
    ])
}

pub(super) fn log() -> Value {
    object(&[
        ("timestamp", time_schema()),
        ("level", kind("integer")),
        ("message", kind("string")),
        ("name", kind("string")),
        ("file", kind("string")),
        ("line", kind("integer")),
    ])
}

pub(super) fn camera() -> Value {
    object(&[
        ("timestamp", time_schema()),
        ("frame_id", kind("string")),
        ("width", kind("integer")),
        ("height", kind("integer")),
        ("distortion_model", kind("string")),
        ("D", list(&number())),
        ("K", list(&number())),
        ("R", list(&number())),
        ("P", list(&number())),
    ])
}

pub(super) fn site() -> Value {
    let pose = object(&[("position", numbers(&["x", "y", "z"])), ("orientation", numbers(&["x", "y", "z", "w"]))]);
    let model = object(&[
        ("pose", pose),
        ("scale", numbers(&["x", "y", "z"])),
        ("color", numbers(&["r", "g", "b", "a"])),
        ("override_color", kind("boolean")),
        ("url", kind("string")),
        ("media_type", kind("string")),
        ("data", json!({ "type": "string", "contentEncoding": "base64" })),
    ]);
    let pair = object(&[("key", kind("string")), ("value", kind("string"))]);
    let mut fields = vec![
        ("timestamp", time_schema()),
        ("frame_id", kind("string")),
        ("id", kind("string")),
        ("lifetime", time_schema()),
        ("frame_locked", kind("boolean")),
        ("metadata", list(&pair)),
    ];
    // Foxglove requires all shape lists; only models are used.
    let shapes = ["arrows", "cubes", "spheres", "cylinders", "lines", "triangles", "texts"];
    fields.extend(shapes.map(|name| (name, list(&object(&[])))));
    fields.push(("models", list(&model)));
    let deletion = object(&[("timestamp", time_schema()), ("type", kind("integer")), ("id", kind("string"))]);
    object(&[("deletions", list(&deletion)), ("entities", list(&object(&fields)))])
}

pub(super) fn battery() -> Value {
    object(&[("timestamp", time_schema()), ("voltage_v", number()), ("current_a", number()), ("remaining_pct", number())])
}

pub(super) fn scoring() -> Value {
    object(&[
        ("timestamp", time_schema()),
        ("clearance_m", number()),
        ("lux", number()),
        ("contact", kind("string")),
        ("hits", kind("integer")),
        ("respawns", kind("integer")),
        ("lamp_on", kind("boolean")),
        ("speed_m_s", number()),
    ])
}
