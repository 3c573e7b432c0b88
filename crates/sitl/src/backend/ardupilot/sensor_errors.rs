//! Errors of the barometer and the compass, written to ArduPilot's simulation parameters: ArduPilot derives both sensors from the
//! true state and adds the errors that these parameters describe.

use crate::backend::interface::StepInput;
use crate::sensors::magnetometer::earth_field_gauss;
use spandrel_mavlink::dialect::{MavMessage, MavParamType, PARAM_SET_DATA};
use spandrel_model::time::SimTime;

/// Interval of updates: errors that change faster are averaged.
const UPDATE_INTERVAL: SimTime = SimTime::from_ms(200);
/// Number of updates after which an unchanged value is sent again, in case that a message was lost.
const REPEAT_UPDATES: u32 = 25;
/// Smallest change of the barometer's error that is sent, m.
const BARO_RESOLUTION_M: f64 = 0.03;
/// Smallest change of the compass error that is sent, milligauss.
const COMPASS_RESOLUTION_MGAUSS: f64 = 1.5;
/// Offset of the simulated compass that its calibration removes, milligauss. ArduPilot takes an offset of zero for a compass that
/// was never calibrated.
pub const COMPASS_OFFSETS_MGAUSS: [f64; 3] = [5.0, 13.0, -18.0];

/// A parameter and the value that ArduPilot got last.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Remote {
    name: &'static str,
    sent: f64,
    resolution: f64,
    /// Updates since the value was sent.
    age: u32,
}

impl Remote {
    fn new(name: &'static str, default: f64, resolution: f64) -> Self {
        // Sent with the first update, because an ArduPilot that starts again has the values of its last flight.
        Self { name, sent: default, resolution, age: REPEAT_UPDATES }
    }
}

/// Mean of the readings since the last update.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Mean {
    sum: f64,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    fn take(&mut self) -> Option<f64> {
        let mean = (self.count > 0).then(|| self.sum / f64::from(self.count));
        *self = Self::default();
        mean
    }
}

/// The errors that ArduPilot simulates and the ones that it should simulate.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorErrors {
    system_id: u8,
    due: Option<SimTime>,
    baro_m: Mean,
    compass_mgauss: [Mean; 3],
    baro: Remote,
    baro_off: Remote,
    compass: [Remote; 3],
    compass_off: Remote,
}

impl SensorErrors {
    /// Creates the state for an ArduPilot with this system ID that has just started.
    pub fn new(system_id: u8) -> Self {
        let [x, y, z] = COMPASS_OFFSETS_MGAUSS;
        let offset = |name, default| Remote::new(name, default, COMPASS_RESOLUTION_MGAUSS);
        Self {
            system_id,
            due: None,
            baro_m: Mean::default(),
            compass_mgauss: [Mean::default(); 3],
            baro: Remote::new("SIM_BARO_GLITCH", 0.0, BARO_RESOLUTION_M),
            baro_off: Remote::new("SIM_BARO_DISABLE", 0.0, 0.5),
            compass: [offset("SIM_MAG1_OFS_X", x), offset("SIM_MAG1_OFS_Y", y), offset("SIM_MAG1_OFS_Z", z)],
            compass_off: Remote::new("SIM_MAG1_FAIL", 0.0, 0.5),
        }
    }

    /// Returns to the state of an ArduPilot that has just started.
    pub fn start_anew(&mut self) {
        *self = Self::new(self.system_id);
    }

    /// Takes the readings of a step and returns the parameters that changed. Call it once per step.
    pub fn update(&mut self, step: &StepInput<'_>) -> Vec<MavMessage> {
        self.measure(step);
        if *self.due.get_or_insert(step.now + UPDATE_INTERVAL) > step.now {
            return Vec::new();
        }
        self.due = Some(step.now + UPDATE_INTERVAL);
        let mut out = Vec::new();
        let baro_m = self.baro_m.take();
        push(&mut out, self.system_id, &mut self.baro_off, f64::from(u8::from(baro_m.is_none())));
        if let Some(error_m) = baro_m {
            push(&mut out, self.system_id, &mut self.baro, error_m);
        }
        let mut compass_works = true;
        for ((remote, mean), base) in self.compass.iter_mut().zip(&mut self.compass_mgauss).zip(COMPASS_OFFSETS_MGAUSS) {
            match mean.take() {
                // ArduPilot subtracts the offset from the true field.
                Some(error) => push(&mut out, self.system_id, remote, base - error),
                None => compass_works = false,
            }
        }
        push(&mut out, self.system_id, &mut self.compass_off, f64::from(u8::from(!compass_works)));
        out
    }

    fn measure(&mut self, step: &StepInput<'_>) {
        if let Some(up_m) = step.fresh.baro_up_m {
            self.baro_m.add(up_m - step.truth.position_m.enu().up());
        }
        if let Some(field) = step.fresh.mag_gauss {
            let error = field - step.truth.attitude.inverse() * earth_field_gauss(step.plane.origin());
            for (mean, gauss) in self.compass_mgauss.iter_mut().zip(error.array()) {
                mean.add(gauss * 1000.0);
            }
        }
    }
}

/// Appends a PARAM_SET if the value changed noticeably or was sent long ago.
fn push(out: &mut Vec<MavMessage>, system_id: u8, remote: &mut Remote, value: f64) {
    remote.age += 1;
    if (value - remote.sent).abs() < remote.resolution && remote.age < REPEAT_UPDATES {
        return;
    }
    remote.sent = value;
    remote.age = 0;
    out.push(MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value: value as f32,
        target_system: system_id,
        target_component: 1,
        param_id: remote.name.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    }));
}
