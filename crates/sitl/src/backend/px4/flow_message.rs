//! HIL_OPTICAL_FLOW: the flow sensor's velocity as the image motion that a downward camera would measure.

use crate::backend::interface::StepInput;
use crate::sensors::FlowReading;
use spandrel_mavlink::dialect::{HIL_OPTICAL_FLOW_DATA, MavMessage};
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

/// Integrates the gyroscope between two flow readings and remembers the range to the surface below.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct FlowIntegrator {
    angle_rad: Vec3<Frd>,
    interval: SimTime,
    range: Option<(SimTime, f64)>,
}

impl FlowIntegrator {
    /// Creates an integrator at rest.
    pub(super) fn new() -> Self {
        Self { angle_rad: Vec3::zero(), interval: SimTime::ZERO, range: None }
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

    /// Builds the message for a flow reading and starts the next interval. `None` without a recent range: PX4 can use image
    /// motion only if it knows the distance.
    pub(super) fn message(&mut self, flow: &FlowReading, step: &StepInput<'_>, time_us: u64) -> Option<MavMessage> {
        let (angle, interval) = (self.angle_rad, self.interval);
        (self.angle_rad, self.interval) = (Vec3::zero(), SimTime::ZERO);
        let (measured, range_m) = self.range?;
        if step.now.saturating_sub(measured) > MAX_RANGE_AGE || interval == SimTime::ZERO {
            return None;
        }
        let per_meter = interval.s() / range_m.max(MIN_RANGE_M);
        let velocity = body_velocity(flow, step);
        // PX4's sign convention: turning right-handed about an axis, and moving forward or to the left, increase the angle.
        let x = angle.forward() - velocity.right() * per_meter;
        let y = angle.right() + velocity.forward() * per_meter;
        (x.is_finite() && y.is_finite()).then(|| {
            MavMessage::HIL_OPTICAL_FLOW(HIL_OPTICAL_FLOW_DATA {
                time_usec: time_us,
                integration_time_us: interval.us() as u32,
                integrated_x: x as f32,
                integrated_y: y as f32,
                integrated_xgyro: angle.forward() as f32,
                integrated_ygyro: angle.right() as f32,
                integrated_zgyro: angle.down() as f32,
                distance: NO_DISTANCE,
                quality: (flow.quality.clamp(0.0, 1.0) * f64::from(u8::MAX)).round() as u8,
                ..HIL_OPTICAL_FLOW_DATA::default()
            })
        })
    }
}

/// Rotates the measured velocity from the heading frame to the body. A camera that is fixed to the aircraft also sees the climb
/// of a tilted aircraft.
fn body_velocity(flow: &FlowReading, step: &StepInput<'_>) -> Vec3<Frd> {
    let heading = Rotation::from_euler(0.0, 0.0, step.truth.attitude.yaw_rad());
    let level = Vec3::<Frd>::new(flow.forward_m_s, flow.right_m_s, step.truth.velocity_m_s.down());
    step.truth.attitude.inverse() * (heading * level)
}
