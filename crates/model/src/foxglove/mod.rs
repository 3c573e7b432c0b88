//! JSON messages for Foxglove: five standard message types (frame transforms, location fix, log, camera calibration,
//! scene update; <https://docs.foxglove.dev/docs/sdk/schemas>) and two custom types.
//!
//! Frame axes: `site` is east, north, up from the scenario origin, m; `drone` is forward, left, up; `camera` is right,
//! down, forward.

mod schema;

use super::frames::{Frd, Ned, Rotation, Vec3};
use super::geodesy::Geo;
use nalgebra::{Quaternion, UnitQuaternion};
use serde_json::{Value, json};

/// Frame ID of the estimated aircraft pose.
pub const DRONE_ESTIMATE: &str = "drone_estimate";
/// Frame ID of the true aircraft pose.
pub const DRONE: &str = "drone";
/// Camera frame ID.
pub const CAMERA: &str = "camera";
/// Site frame ID; axes east, north, up.
pub const SITE: &str = "site";

/// Message topic. The discriminant is the index into [`CHANNELS`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Topic {
    /// Transforms of the drone and camera frames.
    Transforms = 0,
    /// Geographic position with its accuracy.
    Fix,
    /// Log messages.
    Log,
    /// Camera calibration.
    Camera,
    /// Site geometry.
    Site,
    /// Battery state.
    Battery,
    /// Signals used for scoring: clearance, light and contacts.
    Scoring,
}

/// A channel: a topic and its schema.
#[derive(Debug, Clone, Copy)]
pub struct Channel {
    /// Topic name.
    pub topic: &'static str,
    /// Schema name.
    pub schema: &'static str,
    fields: fn() -> Value,
}

impl Channel {
    /// Returns the JSON schema of the channel's messages.
    #[must_use]
    pub fn json_schema(&self) -> String {
        let mut schema = (self.fields)();
        schema["title"] = self.schema.into();
        schema.to_string()
    }
}

/// All channels, in the order of [`Topic`].
pub const CHANNELS: [Channel; 7] = [
    Channel { topic: "/tf", schema: "foxglove.FrameTransforms", fields: schema::transforms },
    Channel { topic: "/fix", schema: "foxglove.LocationFix", fields: schema::fix },
    Channel { topic: "/log", schema: "foxglove.Log", fields: schema::log },
    Channel { topic: "/camera", schema: "foxglove.CameraCalibration", fields: schema::camera },
    Channel { topic: "/site", schema: "foxglove.SceneUpdate", fields: schema::site },
    Channel { topic: "/battery", schema: "spandrel.Battery", fields: schema::battery },
    Channel { topic: "/scoring", schema: "spandrel.Scoring", fields: schema::scoring },
];

/// One message on a channel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChannelMessage {
    /// Message topic.
    pub topic: Topic,
    /// UTC, nanoseconds since the Unix epoch.
    pub unix_ns: u64,
    /// Message content, JSON.
    pub json: String,
}

impl ChannelMessage {
    fn new(topic: Topic, unix_ns: u64, value: &Value) -> Self {
        Self { topic, unix_ns, json: value.to_string() }
    }
}

/// Position, m, and orientation of a frame relative to `site`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FramePose {
    position_m: [f64; 3],
    rotation: UnitQuaternion<f64>,
}

fn enu_from_ned() -> UnitQuaternion<f64> {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    UnitQuaternion::new_unchecked(Quaternion::new(0.0, half, half, 0.0))
}

impl FramePose {
    /// Creates the pose of the aircraft from its position and attitude.
    #[must_use]
    pub fn drone(position_m: Vec3<Ned>, attitude: Rotation<Frd, Ned>) -> Self {
        // A half turn about the forward axis converts forward, left, up to forward, right, down.
        let frd_from_flu = UnitQuaternion::new_unchecked(Quaternion::new(0.0, 1.0, 0.0, 0.0));
        let rotation = enu_from_ned() * attitude.raw() * frd_from_flu;
        Self { position_m: position_m.enu().array(), rotation }
    }

    /// Creates the pose of a roll-stabilized camera that points `pitch_rad` above the horizon, with the lens at `lens_m` in the
    /// body frame.
    #[must_use]
    pub fn camera(position_m: Vec3<Ned>, attitude: Rotation<Frd, Ned>, lens_m: Vec3<Frd>, pitch_rad: f64) -> Self {
        // Converts forward, right, down to right, down, forward.
        let frd_from_optical = UnitQuaternion::new_unchecked(Quaternion::new(0.5, 0.5, 0.5, 0.5));
        let looks = Rotation::from_euler(0.0, pitch_rad, attitude.yaw_rad());
        let rotation = enu_from_ned() * looks.raw() * frd_from_optical;
        Self { position_m: (position_m + attitude * lens_m).enu().array(), rotation }
    }
}

fn time(unix_ns: u64) -> Value {
    json!({ "sec": unix_ns / 1_000_000_000, "nsec": unix_ns % 1_000_000_000 })
}

fn xyz([x, y, z]: [f64; 3]) -> Value {
    json!({ "x": x, "y": y, "z": z })
}

/// Creates a message with the poses of frames relative to `site`.
#[must_use]
pub fn transforms(unix_ns: u64, frames: &[(&str, FramePose)]) -> ChannelMessage {
    let one = |(name, pose): &(&str, FramePose)| {
        let q = pose.rotation.coords;
        json!({
            "timestamp": time(unix_ns),
            "parent_frame_id": SITE,
            "child_frame_id": name,
            "translation": xyz(pose.position_m),
            "rotation": { "x": q.x, "y": q.y, "z": q.z, "w": q.w },
        })
    };
    ChannelMessage::new(Topic::Transforms, unix_ns, &json!({ "transforms": frames.iter().map(one).collect::<Vec<_>>() }))
}

/// Creates a location fix with its horizontal and vertical accuracy, m (1 sigma).
#[must_use]
pub fn fix(unix_ns: u64, geo: Geo, horizontal_m: f64, vertical_m: f64) -> ChannelMessage {
    let (h, v) = (horizontal_m * horizontal_m, vertical_m * vertical_m);
    let value = json!({
        "timestamp": time(unix_ns),
        "frame_id": SITE,
        "latitude": geo.latitude_deg,
        "longitude": geo.longitude_deg,
        "altitude": geo.altitude_m,
        "position_covariance": [h, 0.0, 0.0, 0.0, h, 0.0, 0.0, 0.0, v],
        // Covariance type DIAGONAL_KNOWN.
        "position_covariance_type": 2,
    });
    ChannelMessage::new(Topic::Fix, unix_ns, &value)
}

/// Creates a log message from a MAVLink severity (0 emergency to 7 debug) and a text.
#[must_use]
pub fn log(unix_ns: u64, severity: u8, text: &str) -> ChannelMessage {
    // Foxglove levels: FATAL 5, ERROR 4, WARNING 3, INFO 2, DEBUG 1.
    let level = match severity {
        0 | 1 => 5,
        2 | 3 => 4,
        4 => 3,
        5 | 6 => 2,
        _ => 1,
    };
    let value = json!({ "timestamp": time(unix_ns), "level": level, "message": text, "name": "vehicle", "file": "", "line": 0 });
    ChannelMessage::new(Topic::Log, unix_ns, &value)
}

/// Creates the calibration message of an ideal pinhole camera from its focal length, image width and image height, in
/// px.
#[must_use]
pub fn camera(unix_ns: u64, focal_px: f64, (width_px, height_px): (u32, u32)) -> ChannelMessage {
    let (f, w, h) = (focal_px, width_px, height_px);
    let (cx, cy) = (0.5 * f64::from(w), 0.5 * f64::from(h));
    let value = json!({
        "timestamp": time(unix_ns),
        "frame_id": CAMERA,
        "width": w,
        "height": h,
        "distortion_model": "plumb_bob",
        "D": [0.0, 0.0, 0.0, 0.0, 0.0],
        "K": [f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0],
        "R": [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        "P": [f, 0.0, cx, 0.0, 0.0, f, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
    });
    ChannelMessage::new(Topic::Camera, unix_ns, &value)
}

/// Creates a scene update that shows the site's model permanently. `glb_base64` is a binary glTF file in Base64.
#[must_use]
pub fn site(unix_ns: u64, glb_base64: &str) -> ChannelMessage {
    let none: [Value; 0] = [];
    let value = json!({
        "deletions": none,
        "entities": [{
            "timestamp": time(unix_ns),
            "frame_id": SITE,
            "id": "site",
            "lifetime": { "sec": 0, "nsec": 0 },
            "frame_locked": true,
            "metadata": none,
            "arrows": none, "cubes": none, "spheres": none, "cylinders": none, "lines": none, "triangles": none, "texts": none,
            "models": [{
                "pose": { "position": xyz([0.0; 3]), "orientation": { "x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0 } },
                "scale": xyz([1.0; 3]),
                "color": { "r": 0.7, "g": 0.7, "b": 0.7, "a": 1.0 },
                "override_color": false,
                "url": "",
                "media_type": "model/gltf-binary",
                "data": glb_base64,
            }],
        }],
    });
    ChannelMessage::new(Topic::Site, unix_ns, &value)
}

/// Creates a battery message from the voltage (V) and current (A), if known, and the remaining charge (%).
#[must_use]
pub fn battery(unix_ns: u64, volts_amperes: Option<(f64, f64)>, remaining_pct: f64) -> ChannelMessage {
    let value = json!({
        "timestamp": time(unix_ns),
        "voltage_v": volts_amperes.map(|(v, _)| v),
        "current_a": volts_amperes.map(|(_, a)| a),
        "remaining_pct": remaining_pct,
    });
    ChannelMessage::new(Topic::Battery, unix_ns, &value)
}

/// Signals used for scoring.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ScoringSignals {
    /// Distance from the center of the drone to the nearest surface, m.
    pub clearance_m: f64,
    /// Ambient illuminance at the drone, lx, if known.
    pub lux: Option<f64>,
    /// Label of the surface type that the aircraft touches.
    pub contact: &'static str,
    /// Number of contacts so far.
    pub hits: i32,
    /// Number of respawns so far.
    pub respawns: i32,
    /// True while the lamp is on.
    pub lamp_on: bool,
    /// Speed, m/s.
    pub speed_m_s: f64,
}

/// Creates a message with the scoring signals.
#[must_use]
pub fn scoring(unix_ns: u64, s: &ScoringSignals) -> ChannelMessage {
    // JSON cannot represent infinity; null means that no surface is within range.
    let clearance = if s.clearance_m.is_finite() { json!(s.clearance_m) } else { Value::Null };
    let value = json!({
        "timestamp": time(unix_ns),
        "clearance_m": clearance,
        "lux": s.lux,
        "contact": s.contact,
        "hits": s.hits,
        "respawns": s.respawns,
        "lamp_on": s.lamp_on,
        "speed_m_s": s.speed_m_s,
    });
    ChannelMessage::new(Topic::Scoring, unix_ns, &value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// Tolerance for rounding errors of unit quaternions.
    const ROUNDING_TOLERANCE: f64 = 1e-12;

    fn rotated(pose: &FramePose, axis: [f64; 3]) -> [f64; 3] {
        (pose.rotation * Vector3::from(axis)).into()
    }

    fn assert_close(a: [f64; 3], b: [f64; 3]) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < ROUNDING_TOLERANCE), "{a:?} {b:?}");
    }

    #[test]
    fn exact_frames_have_the_documented_axes() {
        let east = Rotation::from_euler(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        let drone = FramePose::drone(Vec3::new(1.0, 2.0, -3.0), east);
        assert_eq!(drone.position_m, [2.0, 1.0, 3.0]);
        assert_close(rotated(&drone, [1.0, 0.0, 0.0]), [1.0, 0.0, 0.0]);
        assert_close(rotated(&drone, [0.0, 1.0, 0.0]), [0.0, 1.0, 0.0]);
        assert_close(rotated(&drone, [0.0, 0.0, 1.0]), [0.0, 0.0, 1.0]);
        // Looking straight up at a soffit: forward points up, and the image's top points backward.
        let up = FramePose::camera(Vec3::zero(), east, Vec3::new(0.1, 0.0, 0.0), std::f64::consts::FRAC_PI_2);
        assert_close(up.position_m, [0.1, 0.0, 0.0]);
        assert_close(rotated(&up, [0.0, 0.0, 1.0]), [0.0, 0.0, 1.0]);
        assert_close(rotated(&up, [1.0, 0.0, 0.0]), [0.0, -1.0, 0.0]);
        let level = FramePose::camera(Vec3::zero(), east, Vec3::zero(), 0.0);
        assert_close(rotated(&level, [0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
        assert_close(rotated(&level, [0.0, 1.0, 0.0]), [0.0, 0.0, -1.0]);
    }

    /// Checks that a message and its schema have the same fields with the same types.
    fn assert_matches_schema(value: &Value, schema: &Value, at: &str) {
        match (schema["type"].as_str().expect("typed"), value) {
            ("object", Value::Object(fields)) => {
                let known = schema["properties"].as_object().expect("fields");
                assert_eq!(known.keys().collect::<Vec<_>>(), fields.keys().collect::<Vec<_>>(), "{at}");
                known.iter().for_each(|(name, kind)| assert_matches_schema(&fields[name], kind, &format!("{at}.{name}")));
            }
            ("array", Value::Array(items)) => items.iter().for_each(|item| assert_matches_schema(item, &schema["items"], at)),
            ("integer", Value::Number(n)) => assert!(n.is_i64() || n.is_u64(), "{at}"),
            ("number", Value::Number(_)) | ("string", Value::String(_)) | ("boolean", Value::Bool(_)) => {}
            (kind, other) => panic!("{at}: {kind} {other}"),
        }
    }

    #[test]
    fn exact_messages_match_their_schemas() {
        let pose = FramePose::drone(Vec3::zero(), Rotation::identity());
        let geo = Geo { latitude_deg: 1.0, longitude_deg: 2.0, altitude_m: 3.0 };
        let at = 1_700_000_000_123_456_789;
        let all = [
            transforms(at, &[(DRONE, pose), (CAMERA, pose)]),
            fix(at, geo, 1.0, 2.0),
            log(at, 4, "a \"text\""),
            camera(at, 1000.0, (1920, 1080)),
            site(at, "AAAA"),
            battery(at, Some((11.1, 5.0)), 88.0),
            scoring(at, &ScoringSignals { lux: Some(9.0), ..ScoringSignals::default() }),
        ];
        for (number, message) in all.iter().enumerate() {
            assert_eq!(message.topic as usize, number);
            let schema: Value = serde_json::from_str(&CHANNELS[number].json_schema()).unwrap();
            assert_matches_schema(&serde_json::from_str(&message.json).unwrap(), &schema, CHANNELS[number].topic);
        }
        assert!(all[2].json.contains(r#""sec":1700000000,"nsec":123456789"#));
        assert!(
            scoring(at, &ScoringSignals { clearance_m: f64::INFINITY, ..ScoringSignals::default() })
                .json
                .contains(r#""clearance_m":null"#)
        );
    }
}
