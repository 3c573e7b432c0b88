//! Tests of the frame export: compares every column with known values from a recorded flight.

use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::contract::SIMULATOR_COMPONENT;
use spandrel_mavlink::dialect::{GLOBAL_POSITION_INT_DATA, MavMessage, WIND_COV_DATA};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::geodesy::LocalPlane;
use spandrel_monitor::export::{COLUMNS, FrameRow, frame_rows, frames_csv};
use spandrel_testkit::job::*;

/// Position tolerance, m: truth and estimate have a resolution of 1e-7 deg (1.1 cm) in latitude and longitude.
const POSITION_TOLERANCE_M: f64 = 0.025;
/// Angle tolerance, rad; attitudes are sent as 32-bit floats.
const ANGLE_TOLERANCE_RAD: f64 = 1e-6;
/// East, north and up errors of the autopilot's position estimate in the test flight, m.
const ESTIMATE_ERROR_M: [f64; 3] = [0.5, -0.25, 0.125];

/// Sends the autopilot's position estimate.
fn send_estimate(tape: &mut Tape) {
    let geo = LocalPlane::new(one_task().origin)
        .geo_from_enu(tape.at_m + Vec3::<Enu>::new(ESTIMATE_ERROR_M[0], ESTIMATE_ERROR_M[1], ESTIMATE_ERROR_M[2]));
    tape.send(&MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA {
        time_boot_ms: tape.now_ms,
        lat: (geo.latitude_deg * 1e7).round() as i32,
        lon: (geo.longitude_deg * 1e7).round() as i32,
        alt: (geo.altitude_m * 1e3).round() as i32,
        ..Default::default()
    }));
}

fn wind_message(tape: &Tape, [north, east, down]: [f32; 3]) -> MavMessage {
    MavMessage::WIND_COV(WIND_COV_DATA {
        time_usec: u64::from(tape.now_ms) * 1000,
        wind_x: north,
        wind_y: east,
        wind_z: down,
        ..Default::default()
    })
}

fn wind(tape: &mut Tape, velocity_m_s: [f32; 3]) {
    let message = wind_message(tape, velocity_m_s);
    tape.send(&message);
}

/// Records a flight along 30 m of the path, with a wind report at 15 m. The drone then flies 5 m north, sends no
/// telemetry for 3 s, and lands.
fn flight() -> Tape {
    let mut tape = Tape::new();
    tape.yaw_rad = 0.5;
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    tape.gimbal(-0.25);
    for east in 1..=30 {
        send_estimate(&mut tape);
        if east == 15 {
            wind(&mut tape, [1.0, 2.0, -0.5]);
        }
        tape.fly((f64::from(east), 0.0, 10.0), 4.0);
    }
    tape.clearance(2.5);
    tape.fly((30.0, 5.0, 10.0), 4.0);
    tape.hold_unrecorded(3_000);
    tape.land();
    tape
}

fn rows(tape: &Tape) -> Vec<FrameRow> {
    frame_rows(&tape.log(0), &one_task(), &vehicle()).unwrap()
}

/// Returns the cells of one column.
fn cells<'a>(csv: &'a str, name: &str) -> Vec<&'a str> {
    let at = COLUMNS.iter().position(|column| column.name == name).unwrap();
    csv.lines().skip(1).map(|line| line.split(',').nth(at).unwrap()).collect()
}

#[test]
fn exact_velocity_attitude_and_gimbal_match_telemetry() {
    let rows = rows(&flight());
    let cruise = rows.iter().find(|row| row.frame.position_m.east() > 14.0).unwrap();
    assert_eq!(cruise.frame.velocity_m_s.array(), [4.0, 0.0, 0.0]);
    let [roll, pitch, yaw] = cruise.roll_pitch_yaw_rad.unwrap();
    assert!(
        roll.abs() < ANGLE_TOLERANCE_RAD && pitch.abs() < ANGLE_TOLERANCE_RAD && (yaw - 0.5).abs() < ANGLE_TOLERANCE_RAD,
        "{roll} {pitch} {yaw}"
    );
    assert!((cruise.gimbal_pitch_rad.unwrap() + 0.25).abs() < ANGLE_TOLERANCE_RAD);
    assert_eq!(rows[0].gimbal_pitch_rad, None, "no wind report was received yet");
    let csv = frames_csv(&rows);
    assert_eq!(cells(&csv, "gimbal_pitch_deg")[0], "");
    let k = cruise.frame.index as usize - 1;
    assert_eq!(cells(&csv, "velocity_east_m_s")[k], "4");
    assert_eq!(cells(&csv, "yaw_deg")[k].parse::<f64>().unwrap().to_bits(), yaw.to_degrees().to_bits());
}

#[test]
fn exact_task_and_distance_match_flown_path() {
    let rows = rows(&flight());
    assert_eq!((rows[0].task, rows[0].on_path), (None, false), "no task was entered yet");
    let on = rows.iter().find(|row| row.frame.position_m.east() > 20.0).unwrap();
    assert!(on.on_path && on.task.unwrap().id == 1 && on.task.unwrap().distance_m.unwrap() < POSITION_TOLERANCE_M);
    // The drone is off the path beyond the 3 m threshold.
    let off = rows.iter().find(|row| row.frame.position_m.north() > 4.0).unwrap();
    let task = off.task.unwrap();
    assert_eq!((task.id, off.on_path), (1, false));
    assert!((task.distance_m.unwrap() - off.frame.position_m.north()).abs() < POSITION_TOLERANCE_M);
    assert_eq!(off.clearance_m, Some(2.5));
}

#[test]
fn exact_wind_is_the_simulators_if_it_reports_one() {
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    let truth = wind_message(&tape, [3.0, 4.0, 0.0]);
    tape.datagrams.push(Encoder::new(1, SIMULATOR_COMPONENT).encode(&truth));
    // The autopilot's estimate comes later.
    wind(&mut tape, [1.0, 2.0, -0.5]);
    tape.fly((4.0, 0.0, 10.0), 4.0);
    tape.land();
    let rows = rows(&tape);
    let winds: Vec<_> = rows.iter().filter_map(|row| row.wind_m_s).map(|wind| wind.array()).collect();
    assert!(!winds.is_empty() && winds.iter().all(|wind| *wind == [4.0, 3.0, 0.0]), "{winds:?}");
}

#[test]
fn exact_wind_persists_and_estimate_is_interpolated() {
    let rows = rows(&flight());
    let reported = rows.iter().position(|row| row.wind_m_s.is_some()).unwrap();
    let windy: Vec<&FrameRow> = rows.iter().filter(|row| row.wind_m_s.is_some()).collect();
    assert!(
        windy.iter().all(|row| row.wind_m_s.unwrap().array() == [2.0, 1.0, 0.5]),
        "wrong axis order; expected east, north, up"
    );
    assert!((rows[reported].frame.position_m.east() - 14.0).abs() < 0.2, "the wind report arrives one frame earlier, at 4 m/s");
    let lasting = 2.5 * one_task().scoring.frame_rate_hz;
    assert!((windy.len() as f64 - lasting).abs() <= 1.0, "{} frames", windy.len());
    let between =
        rows.iter().filter(|row| (1.0..29.0).contains(&row.frame.position_m.east()) && row.frame.position_m.north() < 0.1);
    let cruise: Vec<&FrameRow> = between.filter(|row| row.frame.time.ms() < rows[reported].frame.time.ms() + 3_000).collect();
    assert!(cruise.len() > 100);
    for row in cruise {
        let error = row.estimate_m.unwrap() - row.frame.position_m;
        let wrong = error.array().iter().zip(ESTIMATE_ERROR_M).map(|(is, was)| (is - was).abs()).fold(0.0, f64::max);
        assert!(wrong < POSITION_TOLERANCE_M, "frame {}: {error:?}", row.frame.index);
    }
    assert_eq!(rows.last().unwrap().estimate_m, None, "no estimate was reported after the path");
}

#[test]
fn exact_values_in_gaps_are_empty() {
    let rows = rows(&flight());
    let csv = frames_csv(&rows);
    let missing: Vec<usize> = rows.iter().filter(|row| row.frame.missing).map(|row| row.frame.index as usize - 1).collect();
    assert!(missing.len() > 60);
    for name in ["roll_deg", "pitch_deg", "yaw_deg", "gimbal_pitch_deg", "clearance_m", "wind_east_m_s", "estimated_up_m"] {
        let cells = cells(&csv, name);
        assert!(missing.iter().all(|k| cells[*k].is_empty()), "{name}");
    }
    for column in COLUMNS.iter().filter(|column| !column.optional) {
        assert!(cells(&csv, column.name).iter().all(|cell| !cell.is_empty()), "{}", column.name);
    }
}

#[test]
fn exact_estimate_is_not_interpolated_across_respawn() {
    let mut tape = Tape::new();
    tape.hold(1.0);
    tape.fly((0.0, 0.0, 10.0), 2.0);
    send_estimate(&mut tape);
    tape.hold(0.1);
    tape.int("respawns", 1);
    tape.at_m = Vec3::new(20.0, 0.0, 10.0);
    tape.hold(0.1);
    send_estimate(&mut tape);
    tape.hold(0.2);
    send_estimate(&mut tape);
    tape.land();
    let rows = rows(&tape);
    let known: Vec<f64> = rows.iter().filter_map(|row| row.estimate_m).map(|estimate_m| estimate_m.east()).collect();
    assert!(!known.is_empty());
    // After the respawn, estimates exist only between two reports.
    assert!(known.iter().all(|east| (east - 20.0 - ESTIMATE_ERROR_M[0]).abs() < POSITION_TOLERANCE_M), "{known:?}");
}

#[test]
fn exact_column_names_are_unique_and_end_with_unit() {
    for (k, column) in COLUMNS.iter().enumerate() {
        assert!(COLUMNS[..k].iter().all(|other| other.name != column.name), "duplicate column {}", column.name);
        assert!(column.description.ends_with('.'), "{}", column.name);
        let ending = match column.unit {
            "" => continue,
            "m/s" => "_m_s",
            "%" => "_pct",
            "deg" => "_deg",
            "m" => "_m",
            "s" => "_s",
            other => panic!("{}: no name suffix for unit {other}", column.name),
        };
        assert!(column.name.ends_with(ending), "{}", column.name);
    }
}
