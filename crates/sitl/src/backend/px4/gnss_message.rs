//! HIL_GPS: position, velocity and accuracy of the GNSS receiver.

use crate::backend::interface::StepInput;
use crate::sensors::GnssReading;
use spandrel_mavlink::dialect::{HIL_GPS_DATA, MavMessage};
use spandrel_mavlink::units::{cm, cm_u16, deg_e7, heading_cdeg, mm};
use spandrel_model::math;

/// Fix types below this one have no position.
const FIRST_FIX_WITH_POSITION: u8 = 2;
/// Value of an unknown course or accuracy.
const UNKNOWN: u16 = u16::MAX;
/// Speed below which the course is unknown, m/s (estimate).
const MIN_SPEED_FOR_COURSE_M_S: f64 = 0.1;

/// Builds the message for a GNSS reading.
pub(super) fn message(gnss: &GnssReading, step: &StepInput<'_>) -> MavMessage {
    let unix_us = step.start_unix_s.saturating_mul(1_000_000).saturating_add(step.now.us());
    let base = HIL_GPS_DATA {
        time_usec: unix_us.unsigned_abs(),
        satellites_visible: gnss.satellites,
        eph: UNKNOWN,
        epv: UNKNOWN,
        cog: UNKNOWN,
        ..HIL_GPS_DATA::default()
    };
    let finite = gnss.position_m.is_finite() && gnss.velocity_m_s.is_finite();
    if gnss.fix < FIRST_FIX_WITH_POSITION || !finite {
        return MavMessage::HIL_GPS(base);
    }
    let (geo, v) = (step.plane.geo_from_enu(gnss.position_m.enu()), gnss.velocity_m_s);
    let moving = v.horizontal_norm() > MIN_SPEED_FOR_COURSE_M_S;
    MavMessage::HIL_GPS(HIL_GPS_DATA {
        fix_type: gnss.fix,
        lat: deg_e7(geo.latitude_deg),
        lon: deg_e7(geo.longitude_deg),
        alt: mm(geo.altitude_m),
        // PX4 reads the accuracy in meters here, in hundredths. The dialect describes both fields as dilution of precision.
        eph: cm_u16(gnss.eph_m),
        epv: cm_u16(gnss.epv_m),
        vel: cm_u16(v.horizontal_norm()),
        vn: cm(v.north()),
        ve: cm(v.east()),
        vd: cm(v.down()),
        cog: if moving { heading_cdeg(math::atan2(v.east(), v.north())) } else { UNKNOWN },
        ..base
    })
}
