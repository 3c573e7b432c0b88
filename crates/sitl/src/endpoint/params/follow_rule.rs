//! Converts the flavour's parameters to the rule for following a target.

use super::Params;
use crate::autopilot::follow::{FollowPosition, FollowRule};

/// FLW_TGT_ALT_M value: height above the target.
const OVER_TARGET: i32 = 2;
/// FOLL_OFS_TYPE value: offset relative to the target's course.
const ALONG_COURSE: i32 = 1;

/// Uses FOLL_* if the flavour has them, otherwise FLW_TGT_*.
pub(super) fn rule(p: &Params) -> FollowRule {
    let fastest_m_s = p.number("MPC_XY_VEL_MAX");
    let Some(enable) = p.whole("FOLL_ENABLE") else {
        return FollowRule {
            enabled: true,
            place: FollowPosition::Around {
                distance_m: p.number("FLW_TGT_DST"),
                angle_rad: p.number("FLW_TGT_FA").to_radians(),
                height_m: p.number("FLW_TGT_HT"),
                over_target: p.whole("FLW_TGT_ALT_M") == Some(OVER_TARGET),
            },
            farthest_m: f64::INFINITY,
            fastest_m_s: p.number("FLW_TGT_MAX_VEL").min(fastest_m_s),
            smoothing: p.number("FLW_TGT_RS"),
        };
    };
    let offset = ["FOLL_OFS_X", "FOLL_OFS_Y", "FOLL_OFS_Z"].map(|name| p.number(name));
    FollowRule {
        enabled: enable != 0,
        place: FollowPosition::Offset {
            offset_m: Some(offset).filter(|offset| *offset != [0.0; 3]),
            along_course: p.whole("FOLL_OFS_TYPE") == Some(ALONG_COURSE),
        },
        farthest_m: p.number("FOLL_DIST_MAX"),
        fastest_m_s,
        smoothing: 0.0,
    }
}
