//! Columns of the frame export. CSV, Parquet and the data dictionary are generated from this list.

use super::FrameRow;
use spandrel_model::frames::{Enu, Vec3};
use std::fmt::Write;

/// Data type of a column and the function that reads its value from a row. The function returns `None` if the telemetry
/// does not contain the value.
#[derive(Debug, Clone, Copy)]
pub enum ColumnReader {
    /// Integer column.
    Integer(fn(&FrameRow) -> Option<i64>),
    /// Floating-point column.
    Float(fn(&FrameRow) -> Option<f64>),
    /// Boolean column; 1 or 0 in CSV.
    Boolean(fn(&FrameRow) -> bool),
    /// String column with a fixed set of values.
    Text(fn(&FrameRow) -> &'static str),
}

/// A column of the frame export.
#[derive(Debug, Clone, Copy)]
pub struct Column {
    /// Column name, ending in the unit if there is one.
    pub name: &'static str,
    /// Unit symbol; empty for counts, fractions, flags and strings.
    pub unit: &'static str,
    /// Coordinate frame or positive direction; empty if none applies.
    pub frame: &'static str,
    /// One-sentence definition of the value.
    pub description: &'static str,
    /// Whether values may be missing. A missing value is empty in CSV and null in Parquet.
    pub optional: bool,
    /// Data type and the function that reads the value.
    pub read: ColumnReader,
}

const POSITION_FRAME: &str = "east, north, up from the scenario's origin";
const VELOCITY_FRAME: &str = "east, north, up";
const STICK_FRAME: &str = "body, -1 to 1";
const ATTITUDE_FRAME: &str = "body (forward, right, down) against north, east, down";

const fn column(
    name: &'static str,
    unit: &'static str,
    frame: &'static str,
    description: &'static str,
    read: ColumnReader,
) -> Column {
    Column { name, unit, frame, description, optional: false, read }
}

const fn optional_column(
    name: &'static str,
    unit: &'static str,
    frame: &'static str,
    description: &'static str,
    read: ColumnReader,
) -> Column {
    Column { name, unit, frame, description, optional: true, read }
}

fn east(vector: Option<Vec3<Enu>>) -> Option<f64> {
    vector.map(Vec3::<Enu>::east)
}

fn north(vector: Option<Vec3<Enu>>) -> Option<f64> {
    vector.map(Vec3::<Enu>::north)
}

fn up(vector: Option<Vec3<Enu>>) -> Option<f64> {
    vector.map(Vec3::<Enu>::up)
}

fn attitude_deg(row: &FrameRow, angle: usize) -> Option<f64> {
    row.roll_pitch_yaw_rad.map(|angles| angles[angle].to_degrees())
}

/// All columns in order. The names and order of released columns never change; new columns are appended.
pub const COLUMNS: &[Column] = &[
    column("frame", "", "", "Frame number; 1 is lift-off.", ColumnReader::Integer(|r| Some(i64::from(r.frame.index)))),
    column("t_s", "s", "", "Simulation time since lift-off.", ColumnReader::Float(|r| Some(r.since_lift_off_s))),
    column("fb", "", STICK_FRAME, "Stick position, positive forward.", ColumnReader::Float(|r| Some(r.frame.sticks[0]))),
    column("rl", "", STICK_FRAME, "Stick position, positive to the right.", ColumnReader::Float(|r| Some(r.frame.sticks[1]))),
    column("ud", "", STICK_FRAME, "Stick position, positive up.", ColumnReader::Float(|r| Some(r.frame.sticks[2]))),
    column("rt", "", STICK_FRAME, "Stick position, positive clockwise.", ColumnReader::Float(|r| Some(r.frame.sticks[3]))),
    column("light", "", "", "Whether the lamp is on.", ColumnReader::Boolean(|r| r.frame.light)),
    column(
        "snapshot",
        "",
        "",
        "Whether a picture was taken since the previous frame.",
        ColumnReader::Boolean(|r| r.frame.snapshot),
    ),
    column("east_m", "m", POSITION_FRAME, "True east position.", ColumnReader::Float(|r| Some(r.frame.position_m.east()))),
    column("north_m", "m", POSITION_FRAME, "True north position.", ColumnReader::Float(|r| Some(r.frame.position_m.north()))),
    column("up_m", "m", POSITION_FRAME, "True height above the origin.", ColumnReader::Float(|r| Some(r.frame.position_m.up()))),
    column(
        "speed_m_s",
        "m/s",
        "",
        "Magnitude of the true 3D velocity over ground.",
        ColumnReader::Float(|r| Some(r.frame.speed_m_s())),
    ),
    column(
        "battery_pct",
        "%",
        "",
        "Remaining battery charge; 100 before the first report.",
        ColumnReader::Float(|r| Some(r.frame.battery_pct)),
    ),
    column(
        "contact",
        "",
        "",
        "Most severe contact since the previous frame: none, bridge, terrain, water, vehicle, person or other. Landings \
         and takeoffs at home are reported as none.",
        ColumnReader::Text(|r| r.frame.contact.label()),
    ),
    column(
        "missing",
        "",
        "",
        "Whether the frame is in a telemetry gap longer than 1 s; if so, position and velocity repeat the last received values.",
        ColumnReader::Boolean(|r| r.frame.missing),
    ),
    column(
        "velocity_east_m_s",
        "m/s",
        VELOCITY_FRAME,
        "True east velocity.",
        ColumnReader::Float(|r| Some(r.frame.velocity_m_s.east())),
    ),
    column(
        "velocity_north_m_s",
        "m/s",
        VELOCITY_FRAME,
        "True north velocity.",
        ColumnReader::Float(|r| Some(r.frame.velocity_m_s.north())),
    ),
    column(
        "velocity_up_m_s",
        "m/s",
        VELOCITY_FRAME,
        "True vertical velocity, positive up.",
        ColumnReader::Float(|r| Some(r.frame.velocity_m_s.up())),
    ),
    optional_column(
        "roll_deg",
        "deg",
        ATTITUDE_FRAME,
        "True roll angle, positive with the right side down.",
        ColumnReader::Float(|r| attitude_deg(r, 0)),
    ),
    optional_column(
        "pitch_deg",
        "deg",
        ATTITUDE_FRAME,
        "True pitch angle, positive with the nose up.",
        ColumnReader::Float(|r| attitude_deg(r, 1)),
    ),
    optional_column(
        "yaw_deg",
        "deg",
        ATTITUDE_FRAME,
        "True heading, clockwise from north, -180 to 180.",
        ColumnReader::Float(|r| attitude_deg(r, 2)),
    ),
    optional_column(
        "gimbal_pitch_deg",
        "deg",
        "horizon",
        "Camera pitch relative to the horizon, positive up.",
        ColumnReader::Float(|r| r.gimbal_pitch_rad.map(f64::to_degrees)),
    ),
    optional_column(
        "task",
        "",
        "",
        "Task whose path the drone is on or, if none, the last task entered; empty until a task is entered.",
        ColumnReader::Integer(|r| r.task.map(|task| i64::from(task.id))),
    ),
    column("on_path", "", "", "Whether the drone is on a task's path.", ColumnReader::Boolean(|r| r.on_path)),
    optional_column(
        "path_distance_m",
        "m",
        "",
        "Distance to the path of `task`, measured with the scenario's path rule.",
        ColumnReader::Float(|r| r.task.and_then(|task| task.distance_m)),
    ),
    optional_column(
        "clearance_m",
        "m",
        "",
        "Distance from the drone's center to the nearest surface, excluding the pad.",
        ColumnReader::Float(|r| r.clearance_m),
    ),
    optional_column(
        "wind_east_m_s",
        "m/s",
        VELOCITY_FRAME,
        "East wind component relative to the ground.",
        ColumnReader::Float(|r| east(r.wind_m_s)),
    ),
    optional_column(
        "wind_north_m_s",
        "m/s",
        VELOCITY_FRAME,
        "North wind component relative to the ground.",
        ColumnReader::Float(|r| north(r.wind_m_s)),
    ),
    optional_column(
        "wind_up_m_s",
        "m/s",
        VELOCITY_FRAME,
        "Vertical wind component relative to the ground, positive up.",
        ColumnReader::Float(|r| up(r.wind_m_s)),
    ),
    optional_column(
        "estimated_east_m",
        "m",
        POSITION_FRAME,
        "East position estimated by the autopilot.",
        ColumnReader::Float(|r| east(r.estimate_m)),
    ),
    optional_column(
        "estimated_north_m",
        "m",
        POSITION_FRAME,
        "North position estimated by the autopilot.",
        ColumnReader::Float(|r| north(r.estimate_m)),
    ),
    optional_column(
        "estimated_up_m",
        "m",
        POSITION_FRAME,
        "Height above the origin estimated by the autopilot.",
        ColumnReader::Float(|r| up(r.estimate_m)),
    ),
    column(
        "interpolated",
        "",
        "",
        "Whether the frame is in a telemetry gap of 0.2 to 1 s; if so, position and velocity are interpolated.",
        ColumnReader::Boolean(|r| r.frame.interpolated),
    ),
];

/// Typical CSV line length, bytes, used to size the output buffer.
const TYPICAL_LINE_BYTES: usize = 360;

/// Returns the frames as CSV: a header line followed by one line per frame.
#[must_use]
pub fn frames_csv(rows: &[FrameRow]) -> String {
    let names: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
    let mut csv = String::with_capacity((rows.len() + 1) * TYPICAL_LINE_BYTES);
    csv.push_str(&names.join(","));
    csv.push('\n');
    for row in rows {
        for (k, column) in COLUMNS.iter().enumerate() {
            if k > 0 {
                csv.push(',');
            }
            write_cell(&mut csv, column.read, row);
        }
        csv.push('\n');
    }
    csv
}

/// Appends one cell to the CSV text. Ignores the write result because writing to a string cannot fail.
fn write_cell(csv: &mut String, read: ColumnReader, row: &FrameRow) {
    let _ = match read {
        ColumnReader::Integer(value) => value(row).map_or(Ok(()), |value| write!(csv, "{value}")),
        ColumnReader::Float(value) => value(row).map_or(Ok(()), |value| write!(csv, "{value}")),
        ColumnReader::Boolean(value) => write!(csv, "{}", u8::from(value(row))),
        ColumnReader::Text(value) => write!(csv, "{}", value(row)),
    };
}
