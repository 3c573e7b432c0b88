//! Parameters with which an instructor controls the simulation. Clients address them to the autopilot component, as with the
//! built-in autopilot; the relay answers in its place.

use crate::endpoint::vehicle_link::params::param_view::ParamView;
use crate::endpoint::vehicle_link::params::{InstructorSettings, ParamRefusal, Params};
use spandrel_mavlink::dialect::{
    MavMessage, MavParamError, PARAM_ERROR_DATA, PARAM_REQUEST_READ_DATA, PARAM_SET_DATA, PARAM_VALUE_DATA,
};

/// The simulation's parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct InstructorParams {
    params: Params,
}

/// The answer to a request for one of these parameters.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ParamAnswer {
    /// Send this message to the sender.
    Reply(MavMessage),
    /// The value has changed: send this message on all links.
    Changed(MavMessage),
}

impl InstructorParams {
    /// Creates the parameters with their defaults, in the autopilot's encoding.
    pub fn new(view: &'static ParamView) -> Self {
        Self { params: Params::simulation(view) }
    }

    /// Returns the settings.
    pub fn settings(&self) -> InstructorSettings {
        self.params.instructor_settings()
    }

    /// Returns the number of changes so far.
    pub fn changes(&self) -> u64 {
        self.params.changes()
    }

    /// Answers a request for one of these parameters; `None` for any other parameter and for requests by index.
    pub fn read(&self, request: &PARAM_REQUEST_READ_DATA) -> Option<ParamAnswer> {
        let name = request.param_id.to_str().ok().filter(|_| request.param_index < 0)?;
        self.value(name).map(ParamAnswer::Reply)
    }

    /// Sets one of these parameters; `None` for any other parameter.
    pub fn set(&mut self, from: (u8, u8), set: &PARAM_SET_DATA) -> Option<ParamAnswer> {
        let name = set.param_id.to_str().ok().filter(|name| self.params.contains(name))?;
        let error = match self.params.set(name, set.param_value, set.param_type) {
            Ok(()) => return self.value(name).map(ParamAnswer::Changed),
            Err(ParamRefusal::OutOfRange) => MavParamError::MAV_PARAM_ERROR_VALUE_OUT_OF_RANGE,
            Err(ParamRefusal::Type) => MavParamError::MAV_PARAM_ERROR_TYPE_MISMATCH,
            Err(ParamRefusal::ReadOnly) => MavParamError::MAV_PARAM_ERROR_READ_ONLY,
            Err(ParamRefusal::Unknown) => MavParamError::MAV_PARAM_ERROR_DOES_NOT_EXIST,
        };
        Some(ParamAnswer::Reply(MavMessage::PARAM_ERROR(PARAM_ERROR_DATA {
            param_index: -1,
            target_system: from.0,
            target_component: from.1,
            param_id: set.param_id,
            error,
        })))
    }

    /// Returns the value of a parameter. It has no index, because it is not in the autopilot's list.
    fn value(&self, name: &str) -> Option<MavMessage> {
        let (index, name, _) = self.params.find(name).filter(|(_, name, _)| self.params.contains(name))?;
        let outgoing = self.params.outgoing(index)?;
        Some(MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
            param_value: outgoing.wire,
            param_count: 0,
            param_index: u16::MAX,
            param_id: name.into(),
            param_type: outgoing.kind,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::endpoint::vehicle_link::params::param_view;
    use spandrel_mavlink::dialect::MavParamType;

    fn set(name: &str, value: f32) -> PARAM_SET_DATA {
        PARAM_SET_DATA {
            param_value: value,
            param_id: name.into(),
            param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
            ..Default::default()
        }
    }

    #[test]
    fn wire_wind_is_set_in_both_encodings_and_other_parameters_pass() {
        for view in [&param_view::PX4, &param_view::COPTER] {
            let mut params = InstructorParams::new(view);
            let answer = params.set((252, 192), &set("SIM_WIND_SPD", 6.5));
            assert!(matches!(answer, Some(ParamAnswer::Changed(MavMessage::PARAM_VALUE(_)))), "{answer:?}");
            assert_eq!(params.settings().wind.map(|(speed, _)| speed), Some(6.5));
            let refused = params.set((252, 192), &set("SIM_WIND_SPD", 6e6));
            assert!(matches!(refused, Some(ParamAnswer::Reply(MavMessage::PARAM_ERROR(_)))), "{refused:?}");
            assert_eq!(params.set((252, 192), &set("MPC_XY_CRUISE", 3.0)), None, "the autopilot's own parameter");
            let read =
                |name: &str, index| PARAM_REQUEST_READ_DATA { param_index: index, param_id: name.into(), ..Default::default() };
            assert!(params.read(&read("SIM_TRAFFIC", -1)).is_some());
            assert_eq!(params.read(&read("SIM_TRAFFIC", 3)), None, "indices belong to the autopilot");
        }
    }
}
