//! PX4's simulator interfaces: MAVLink over TCP in lockstep, where PX4 connects to the simulator, and MAVLink on the serial link of
//! a flight controller (hardware in the loop).

pub mod airframe;
mod airframe_limits;
pub mod clock_offset;
mod equipment;
mod flow_message;
mod gnss_message;
pub mod hil;
pub mod hil_plan;
#[cfg(test)]
mod hil_tests;
pub mod interface;
#[cfg(test)]
mod interface_tests;
pub mod launch;
#[cfg(test)]
mod launch_tests;
mod param_table;
mod range_messages;
mod receiver;
#[cfg(test)]
mod replay_tests;
mod scripts;
mod sensor_messages;
#[cfg(test)]
mod testing;

pub use airframe::parameters;
pub use clock_offset::{ClockOffset, MeasuredOffset};
pub use hil::Px4HilInterface;
pub use hil_plan::HilPlan;
pub use interface::{Px4Interface, RATES_HZ};
pub use launch::{hil_launch, launch};
pub use receiver::{MOTOR_COMMANDS_ID, RejectedCounts};
