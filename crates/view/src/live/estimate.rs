//! Pose of a vehicle that does not send ground truth, from its own estimate: ATTITUDE or ATTITUDE_QUATERNION, and
//! GLOBAL_POSITION_INT.

use spandrel_mavlink::contract::truth::Truth;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::frames::{Frd, Ned, Rotation, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::pose::Motion;
use spandrel_model::time::SimTime;

/// Latest attitude, stored until a position with a timestamp arrives.
#[derive(Debug, Clone, Default)]
pub struct EstimatedPose {
    ned_from_frd: Option<Rotation<Frd, Ned>>,
}

impl EstimatedPose {
    /// Processes a message. Returns a pose when a position message completes it.
    pub fn take(&mut self, message: &MavMessage, plane: &LocalPlane) -> Option<Truth> {
        match message {
            MavMessage::ATTITUDE(a) => {
                self.ned_from_frd = Some(Rotation::from_euler(f64::from(a.roll), f64::from(a.pitch), f64::from(a.yaw)));
                None
            }
            MavMessage::ATTITUDE_QUATERNION(a) => {
                self.ned_from_frd = Rotation::from_wxyz([a.q1, a.q2, a.q3, a.q4].map(f64::from)).or(self.ned_from_frd);
                None
            }
            MavMessage::GLOBAL_POSITION_INT(p) => {
                let geo = Geo {
                    latitude_deg: f64::from(p.lat) * 1e-7,
                    longitude_deg: f64::from(p.lon) * 1e-7,
                    altitude_m: f64::from(p.alt) * 1e-3,
                };
                let velocity: Vec3<Ned> = Vec3::new(f64::from(p.vx) * 0.01, f64::from(p.vy) * 0.01, f64::from(p.vz) * 0.01);
                Some(Truth {
                    time: SimTime::from_ms(i64::from(p.time_boot_ms)),
                    motion: Motion {
                        position_m: plane.enu_from_geo(geo),
                        velocity_m_s: velocity.enu(),
                        ned_from_frd: self.ned_from_frd?,
                    },
                })
            }
            _ => None,
        }
    }
}
