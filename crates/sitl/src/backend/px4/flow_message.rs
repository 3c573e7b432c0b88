//! HIL_OPTICAL_FLOW or ODOMETRY: the flow sensor's velocity as the image motion that a downward camera would measure, or, if there
//! is no surface below within range, as the velocity of a vision system. Spandrel's cameras look in all directions and also see a
//! bridge deck above the aircraft; PX4's optical flow needs the ground.

use crate::backend::interface::StepInput;
use crate::sensors::FlowReading;
use spandrel_mavlink::dialect::{HIL_OPTICAL_FLOW_DATA, MavEstimatorType, MavFrame, MavMessage, ODOMETRY_DATA};
use spandrel_model::frames::{Frd, Rotation, Vec3};
use spandrel_model::time::SimTime;

/// Longest integration interval: twice the sensor's period.
const MAX_INTERVAL: SimTime = SimTime::from_ms(100);
/// Age at which a range is too old to convert velocities to angles.
const MAX_RANGE_AGE: SimTime = SimTime::from_ms(200);
/// Smallest range, which limits the angle, m.
const MIN_RANGE_M: f64 = 0.05;
/// Distance field of a sensor that does not measure it. PX4 takes the range from DISTANCE_SENSOR.
const NO_DISTANCE: f32 = -1.0;

/// Elements of a covariance matrix's upper triangle, and the positions of the three velocity variances in it.
const COVARIANCE_LEN: usize = 21;
const VELOCITY_VARIANCES: [usize; 3] = [0, 6, 11];

/// Integrates the gyroscope between two flow readings and remembers the range to the surface below.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FlowIntegrator {
    noise_m_s: f64,
    angle_rad: Vec3<Frd>,
    interval: SimTime,
    range: Option<(SimTime, f64)>,
}

impl FlowIntegrator {
    /// Creates an integrator at rest for a sensor with this velocity noise.
    pub(super) fn new(noise_m_s: f64) -> Self {
        Self { noise_m_s, angle_rad: Vec3::zero(), interval: SimTime::ZERO, range: None }
    }

    /// Discards the current interval and the range.
    pub(super) fn restart(&mut self) {
        *self = Self::new(self.noise_m_s);
    }

    /// Integrates one control period of length `dt`.
    pub(super) fn advance(&mut self, step: &StepInput<'_>, dt: SimTime) {
        if self.interval + dt > MAX_INTERVAL {
            (self.angle_rad, self.interval) = (Vec3::zero(), SimTime::ZERO);
        }
        let dt = if dt > MAX_INTERVAL { MAX_INTERVAL } else { dt };
        self.angle_rad += step.imus[0].rates_rad_s * dt.s();
        self.interval += dt;
        if let Some(range_m) = step.fresh.range_down_m {
            self.range = range_m.is_finite().then_some((step.now, range_m));
        }
    }

    /// Builds the message for a flow reading and starts the next interval. `None` if the reading is not finite.
    pub(super) fn message(&mut self, flow: &FlowReading, step: &StepInput<'_>, time_us: u64) -> Option<MavMessage> {
        let (angle, interval) = (self.angle_rad, self.interval);
        (self.angle_rad, self.interval) = (Vec3::zero(), SimTime::ZERO);
        let velocity = body_velocity(flow, step);
        if !velocity.is_finite() || !angle.is_finite() {
            return None;
        }
        let range = self.range.filter(|(measured, _)| step.now.saturating_sub(*measured) <= MAX_RANGE_AGE);
        Some(match range {
            Some((_, range_m)) => MavMessage::HIL_OPTICAL_FLOW(HIL_OPTICAL_FLOW_DATA {
                time_usec: time_us,
                quality: (flow.quality.clamp(0.0, 1.0) * f64::from(u8::MAX)).round() as u8,
                ..image_motion(velocity, angle, interval, range_m)
            }),
            None => MavMessage::ODOMETRY(self.vision(flow, velocity, time_us)),
        })
    }

    /// Fields that are not numbers are unknown. Only the velocity is known.
    fn vision(&self, flow: &FlowReading, velocity: Vec3<Frd>, time_us: u64) -> ODOMETRY_DATA {
        let [vx, vy, vz] = velocity.array().map(|v| v as f32);
        let mut velocity_covariance = [0.0; COVARIANCE_LEN];
        for index in VELOCITY_VARIANCES {
            velocity_covariance[index] = (self.noise_m_s * self.noise_m_s) as f32;
        }
        let unknown = f32::NAN;
        ODOMETRY_DATA {
            time_usec: time_us,
            frame_id: MavFrame::MAV_FRAME_LOCAL_FRD,
            child_frame_id: MavFrame::MAV_FRAME_BODY_FRD,
            x: unknown,
            y: unknown,
            z: unknown,
            q: [unknown; 4],
            vx,
            vy,
            vz,
            rollspeed: unknown,
            pitchspeed: unknown,
            yawspeed: unknown,
            pose_covariance: [unknown; COVARIANCE_LEN],
            velocity_covariance,
            reset_counter: 0,
            estimator_type: MavEstimatorType::MAV_ESTIMATOR_TYPE_VISION,
            quality: (flow.quality.clamp(0.0, 1.0) * 100.0).round() as i8,
        }
    }
}

/// PX4's sign convention: turning right-handed about an axis, and moving forward or to the left, increase the angle.
fn image_motion(velocity: Vec3<Frd>, angle: Vec3<Frd>, interval: SimTime, range_m: f64) -> HIL_OPTICAL_FLOW_DATA {
    let per_meter = interval.s() / range_m.max(MIN_RANGE_M);
    HIL_OPTICAL_FLOW_DATA {
        integration_time_us: interval.us() as u32,
        integrated_x: (angle.forward() - velocity.right() * per_meter) as f32,
        integrated_y: (angle.right() + velocity.forward() * per_meter) as f32,
        integrated_xgyro: angle.forward() as f32,
        integrated_ygyro: angle.right() as f32,
        integrated_zgyro: angle.down() as f32,
        distance: NO_DISTANCE,
        ..HIL_OPTICAL_FLOW_DATA::default()
    }
}

/// Rotates the measured velocity from the heading frame to the body. A camera that is fixed to the aircraft also sees the climb
/// of a tilted aircraft.
fn body_velocity(flow: &FlowReading, step: &StepInput<'_>) -> Vec3<Frd> {
    let heading = Rotation::from_euler(0.0, 0.0, step.truth.attitude.yaw_rad());
    let level = Vec3::<Frd>::new(flow.forward_m_s, flow.right_m_s, step.truth.velocity_m_s.down());
    step.truth.attitude.inverse() * (heading * level)
}
