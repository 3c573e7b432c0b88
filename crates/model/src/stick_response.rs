//! How the sticks command motion in position mode: the three responses that inspection aircraft offer.

use crate::math;

/// A response of the aircraft to the sticks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StickResponse {
    /// Gentle around the center, with the accelerations and the jerk of a consumer aircraft's normal mode.
    #[default]
    Position,
    /// Proportional to the stick, and as quick as the airframe allows.
    Sport,
    /// Slow in every direction, for pictures close to a structure.
    Tripod,
}

/// Limits of a response. A limit of the airframe that is smaller applies instead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StickLimits {
    /// Horizontal speed with the stick fully deflected, m/s.
    pub horizontal_m_s: f64,
    /// Climb and descent rate with the stick fully deflected, m/s.
    pub vertical_m_s: f64,
    /// Yaw rate with the stick fully deflected, rad/s.
    pub yaw_rate_rad_s: f64,
    /// Acceleration, m/s².
    pub acceleration_m_s2: f64,
    /// Deceleration when the stick is moved back, m/s².
    pub deceleration_m_s2: f64,
    /// Jerk, m/s³.
    pub jerk_m_s3: f64,
}

/// Share of the cubic part in position and tripod mode (PX4: MPC_XY_MAN_EXPO, MPC_Z_MAN_EXPO and MPC_YAW_EXPO 0.6).
const EXPO: f64 = 0.6;
/// Newton steps that invert the stick curve to the last bits. The curve is convex, so that they converge from full deflection.
const NEWTON_STEPS: u32 = 8;

impl StickResponse {
    /// The responses with their names in files, in the order of their numbers in the parameter SPAN_RESPONSE.
    pub const ALL: [(&'static str, Self); 3] = [("position", Self::Position), ("sport", Self::Sport), ("tripod", Self::Tripod)];

    /// Returns the response with a number of the parameter SPAN_RESPONSE.
    #[must_use]
    pub fn from_number(number: i32) -> Option<Self> {
        usize::try_from(number).ok().and_then(|index| Self::ALL.get(index)).map(|(_, response)| *response)
    }

    /// Returns the name in files and messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, response)| *response == self).map_or("", |(name, _)| name)
    }

    /// Returns the number in the parameter SPAN_RESPONSE.
    #[must_use]
    pub fn number(self) -> i32 {
        self as i32
    }

    /// Returns the limits.
    #[must_use]
    pub fn limits(self) -> StickLimits {
        let unlimited = f64::INFINITY;
        match self {
            // Accelerations as PX4's MPC_ACC_HOR_MAX 5 and between its MPC_ACC_DOWN_MAX 3 and MPC_ACC_UP_MAX 4; MPC_JERK_MAX 8.
            Self::Position => StickLimits {
                horizontal_m_s: unlimited,
                vertical_m_s: unlimited,
                yaw_rate_rad_s: unlimited,
                acceleration_m_s2: 4.0,
                deceleration_m_s2: 5.0,
                jerk_m_s3: 8.0,
            },
            Self::Sport => StickLimits {
                horizontal_m_s: unlimited,
                vertical_m_s: unlimited,
                yaw_rate_rad_s: unlimited,
                acceleration_m_s2: unlimited,
                deceleration_m_s2: unlimited,
                jerk_m_s3: unlimited,
            },
            // Estimates: the tripod modes of consumer aircraft allow 1 to 5 m/s.
            Self::Tripod => StickLimits {
                horizontal_m_s: 2.0,
                vertical_m_s: 1.0,
                yaw_rate_rad_s: 30.0 * math::PI / 180.0,
                acceleration_m_s2: 2.0,
                deceleration_m_s2: 3.0,
                jerk_m_s3: 6.0,
            },
        }
    }

    /// Returns the fraction of the full speed for a stick deflection, both in [-1, 1].
    #[must_use]
    pub fn speed_fraction(self, stick: f64) -> f64 {
        let expo = self.expo();
        (1.0 - expo) * stick + expo * stick * stick * stick
    }

    /// Returns the stick deflection for a fraction of the full speed, both in [-1, 1].
    #[must_use]
    pub fn deflection(self, speed_fraction: f64) -> f64 {
        let (expo, wanted) = (self.expo(), speed_fraction.abs().min(1.0));
        if expo == 0.0 {
            return speed_fraction.clamp(-1.0, 1.0);
        }
        let mut stick = 1.0;
        for _ in 0..NEWTON_STEPS {
            stick -= (self.speed_fraction(stick) - wanted) / (1.0 - expo + 3.0 * expo * stick * stick);
        }
        stick.copysign(speed_fraction)
    }

    fn expo(self) -> f64 {
        if self == Self::Sport { 0.0 } else { EXPO }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding in the inversion of the curve.
    const ROUNDING: f64 = 1e-14;

    #[test]
    fn val_position_mode_has_the_stick_curve_of_px4() {
        // PX4's math::expo(0.3, 0.6) = 0.4 x 0.3 + 0.6 x 0.027.
        assert!((StickResponse::Position.speed_fraction(0.3) - 0.1362).abs() < ROUNDING);
        assert!((StickResponse::Sport.speed_fraction(0.3) - 0.3).abs() < ROUNDING);
    }

    #[test]
    fn exact_deflection_inverts_the_stick_curve() {
        for (_, response) in StickResponse::ALL {
            for k in -100..=100 {
                let fraction = f64::from(k) / 100.0;
                let back = response.speed_fraction(response.deflection(fraction));
                assert!((back - fraction).abs() < ROUNDING, "{response:?} {fraction} {back}");
            }
            assert_eq!(StickResponse::from_number(response.number()), Some(response));
        }
        assert_eq!(StickResponse::from_number(-1).or(StickResponse::from_number(3)), None);
    }
}
