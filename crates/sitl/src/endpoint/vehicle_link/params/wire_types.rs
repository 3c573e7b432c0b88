//! Short names for parameter wire types.

use spandrel_mavlink::dialect::MavParamType;

pub(super) const INT8: MavParamType = MavParamType::MAV_PARAM_TYPE_INT8;
pub(super) const INT16: MavParamType = MavParamType::MAV_PARAM_TYPE_INT16;
pub(super) const INT32: MavParamType = MavParamType::MAV_PARAM_TYPE_INT32;
pub(super) const REAL32: MavParamType = MavParamType::MAV_PARAM_TYPE_REAL32;
