//! Converts the flavor's parameters to the rule for following a target.

use super::Params;
use crate::autopilot::follow::{FollowPosition, FollowRule};

/// FLW_TGT_ALT_M value: height above the target.
const HEIGHT_ABOVE_TARGET: i32 = 2;
/// FOLL_OFS_TYPE value: offset relative to the target's course.
const RELATIVE_TO_COURSE: i32 = 1;

impl Params {
    /// Returns the rule for following a target: from FOLL_* if the flavor has them, otherwise from FLW_TGT_*.
    pub(super) fn follow_rule(&self) -> FollowRule {
        let fastest_m_s = self.number("MPC_XY_VEL_MAX");
        let Some(enable) = self.whole("FOLL_ENABLE") else {
            return FollowRule {
                enabled: true,
                position: FollowPosition::Around {
                    distance_m: self.number("FLW_TGT_DST"),
                    angle_rad: self.number("FLW_TGT_FA").to_radians(),
                    height_m: self.number("FLW_TGT_HT"),
                    relative_to_target: self.whole("FLW_TGT_ALT_M") == Some(HEIGHT_ABOVE_TARGET),
                },
                max_distance_m: f64::INFINITY,
                max_speed_m_s: self.number("FLW_TGT_MAX_VEL").min(fastest_m_s),
                smoothing: self.number("FLW_TGT_RS"),
            };
        };
        let offset = ["FOLL_OFS_X", "FOLL_OFS_Y", "FOLL_OFS_Z"].map(|name| self.number(name));
        FollowRule {
            enabled: enable != 0,
            position: FollowPosition::Offset {
                offset_m: Some(offset).filter(|offset| *offset != [0.0; 3]),
                rotates_with_course: self.whole("FOLL_OFS_TYPE") == Some(RELATIVE_TO_COURSE),
            },
            max_distance_m: self.number("FOLL_DIST_MAX"),
            max_speed_m_s: fastest_m_s,
            smoothing: 0.0,
        }
    }
}
