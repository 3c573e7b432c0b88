//! The truth feed: HIL_STATE_QUATERNION at 50 Hz. `time_usec` counts from simulation start and is the one clock of a flight.

use super::continuity::is_jump;
use crate::dialect::HIL_STATE_QUATERNION_DATA;
use crate::units::{cm, deg_e7, milli_g, mm};
use spandrel_model::frames::{Enu, Frd, Ned, Rotation, Vec3};
use spandrel_model::geodesy::{Geo, LocalPlane};
use spandrel_model::time::SimTime;

/// The simulator's truth at one instant, as a reader of the wire has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// Since simulation start.
    pub time: SimTime,
    /// Position, m from the scenario's origin.
    pub position_m: Vec3<Enu>,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Enu>,
    /// Attitude.
    pub ned_from_frd: Rotation<Frd, Ned>,
}

impl Truth {
    /// The aircraft was put back between this sample and a later one ([`is_jump`]).
    #[must_use]
    pub fn jumps_to(&self, next: &Self) -> bool {
        let fastest_m_s = self.velocity_m_s.norm().max(next.velocity_m_s.norm());
        is_jump((next.position_m - self.position_m).norm(), fastest_m_s, next.time - self.time)
    }
}

/// What the vehicle publishes, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Published {
    /// Since simulation start, us.
    pub time_us: u64,
    /// Position over the WGS84 ellipsoid as the scenario's plane has it.
    pub place: Geo,
    /// Velocity, m/s.
    pub velocity_m_s: Vec3<Ned>,
    /// Attitude.
    pub ned_from_frd: Rotation<Frd, Ned>,
    /// Turn rates, rad/s.
    pub rates_rad_s: Vec3<Frd>,
    /// Specific force, m/s^2.
    pub specific_force_m_s2: Vec3<Frd>,
    /// Speed through the air, m/s.
    pub airspeed_m_s: f64,
}

impl Published {
    /// The message.
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

/// The clock of a truth message. One beyond the range of [`SimTime`] (292 years) is a broken frame; saturating keeps it in order instead
/// of wrapping.
#[must_use]
pub fn clock(time_usec: u64) -> SimTime {
    SimTime::from_us(i64::try_from(time_usec).unwrap_or(i64::MAX).min(i64::MAX / 1_000))
}

/// Reads a truth message; `None` when its attitude is no rotation.
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
        position_m: plane.enu_from_geo(geo),
        velocity_m_s: velocity.enu(),
        ned_from_frd: Rotation::from_wxyz(wire.attitude_quaternion.map(f64::from))?,
    })
}
