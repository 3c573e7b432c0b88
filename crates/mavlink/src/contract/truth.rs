//! Ground truth: HIL_STATE_QUATERNION at 50 Hz. `time_usec` is the time since simulation start, which is the flight's
//! reference clock.

use super::continuity::is_jump;
use crate::dialect::HIL_STATE_QUATERNION_DATA;
use crate::units::{cm, deg_e7, milli_g, mm};
use spandrel_model::frames::{Enu, Frd, Ned, Rotation, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::pose::Motion;
use spandrel_model::time::SimTime;

/// A ground-truth message as received: the simulator's true state at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// Time since simulation start.
    pub time: SimTime,
    /// Motion, relative to the scenario origin.
    pub motion: Motion<Enu>,
}

impl Truth {
    /// Returns whether the aircraft was respawned between this message and a later one (see [`is_jump`]).
    #[must_use]
    pub fn jumps_to(&self, next: &Self) -> bool {
        let (here, there) = (&self.motion, &next.motion);
        let fastest_m_s = here.velocity_m_s.norm().max(there.velocity_m_s.norm());
        is_jump((there.position_m - here.position_m).norm(), fastest_m_s, next.time - self.time)
    }
}

/// Ground truth as published by the vehicle, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PublishedTruth {
    /// Time since simulation start, us.
    pub time_us: u64,
    /// Position; the altitude is above the WGS84 ellipsoid.
    pub place: Geo,
    /// Velocity in the scenario frame, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Attitude: rotation from the body frame to NED.
    pub ned_from_frd: Rotation<Frd, Ned>,
    /// Angular rates in the body frame, rad/s.
    pub rates_rad_s: Vec3<Frd>,
    /// Specific force in the body frame, m/s^2.
    pub specific_force_m_s2: Vec3<Frd>,
    /// True airspeed, m/s.
    pub airspeed_m_s: f64,
}

impl PublishedTruth {
    /// Encodes the ground truth as a HIL_STATE_QUATERNION message.
    #[must_use]
    pub fn message(&self) -> HIL_STATE_QUATERNION_DATA {
        let (w, v, force) = (self.rates_rad_s, self.velocity_m_s, self.specific_force_m_s2);
        HIL_STATE_QUATERNION_DATA {
            time_usec: self.time_us,
            attitude_quaternion: self.ned_from_frd.wxyz().map(|c| c as f32),
            rollspeed: w.forward() as f32,
            pitchspeed: w.right() as f32,
            yawspeed: w.down() as f32,
            lat: deg_e7(self.place.latitude_deg),
            lon: deg_e7(self.place.longitude_deg),
            alt: mm(self.place.altitude_m),
            vx: cm(v.north()),
            vy: cm(v.east()),
            vz: cm(v.down()),
            ind_airspeed: cm(self.airspeed_m_s).unsigned_abs(),
            true_airspeed: cm(self.airspeed_m_s).unsigned_abs(),
            xacc: milli_g(force.forward()),
            yacc: milli_g(force.right()),
            zacc: milli_g(force.down()),
        }
    }
}

/// Converts the timestamp of a truth message. Values beyond the range of [`SimTime`] (292 years) are invalid; they
/// saturate, which preserves the message order.
#[must_use]
pub fn clock(time_usec: u64) -> SimTime {
    SimTime::from_us(i64::try_from(time_usec).unwrap_or(i64::MAX).min(i64::MAX / 1_000))
}

/// Decodes a truth message; `None` if its quaternion does not represent a rotation.
#[must_use]
pub fn read(wire: &HIL_STATE_QUATERNION_DATA, plane: &LocalPlane) -> Option<Truth> {
    let geo = Geo {
        latitude_deg: f64::from(wire.lat) * 1e-7,
        longitude_deg: f64::from(wire.lon) * 1e-7,
        altitude_m: f64::from(wire.alt) * 1e-3,
    };
    let velocity: Vec3<Ned> = Vec3::new(f64::from(wire.vx) * 0.01, f64::from(wire.vy) * 0.01, f64::from(wire.vz) * 0.01);
    Some(Truth {
        time: clock(wire.time_usec),
        motion: Motion {
            position_m: plane.enu_from_geo(geo),
            velocity_m_s: velocity.enu(),
            ned_from_frd: Rotation::from_wxyz(wire.attitude_quaternion.map(f64::from))?,
        },
    })
}
