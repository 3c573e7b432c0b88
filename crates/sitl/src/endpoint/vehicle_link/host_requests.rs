//! Client requests that the simulation or the host executes.

use crate::endpoint::refused_request::RefusedRequest;
use crate::endpoint::vehicle_command::VehicleCommand;
use crate::faults::{FailureType, FailureUnit, Faults};
use spandrel_mavlink::dialect::MavResult;
use spandrel_model::vehicle::Vehicle;

/// A failure to inject, or to clear if `kind` is `None`. Instances count from 1; 0 means all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FailureInjection {
    /// The unit to which the failure applies.
    pub unit: FailureUnit,
    /// Failure type; `None` clears the failure.
    pub kind: Option<FailureType>,
    /// Instance, 0 for all.
    pub instance: usize,
}

impl FailureInjection {
    /// Reads the parameters of MAV_CMD_INJECT_FAILURE: 1 unit, 2 failure type, 3 instance.
    ///
    /// # Errors
    /// Returns the result and a text if this aircraft does not support the failure.
    pub fn from_command(c: &VehicleCommand, vehicle: &Vehicle) -> Result<Self, RefusedRequest> {
        let unsupported = RefusedRequest { result: MavResult::MAV_RESULT_UNSUPPORTED, text: None };
        let whole = |k: usize| c.finite_param(k).map(|value| value as i64);
        let (unit, kind) = (whole(0).and_then(FailureUnit::from_number), whole(1).and_then(FailureType::from_number));
        let (Some(unit), Some(kind)) = (unit, kind) else { return Err(unsupported) };
        let instance = usize::try_from(whole(2).unwrap_or(0)).unwrap_or(usize::MAX);
        let cells = vehicle.battery.cells as usize;
        if unit == FailureUnit::Battery && instance > cells {
            let text = Some(format!("No battery cell {instance} (1 to {cells}, 0: whole pack)"));
            return Err(RefusedRequest { result: MavResult::MAV_RESULT_DENIED, text });
        }
        if !Faults::new(0).inject(unit, kind, instance, vehicle.rotors.len()) {
            return Err(unsupported);
        }
        Ok(Self { unit, kind, instance })
    }
}

/// A client's request for the parameter file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StorageRequest {
    /// Load the parameter file.
    Load,
    /// Save the parameter file.
    Save,
}
