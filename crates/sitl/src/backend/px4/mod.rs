//! PX4's simulator interface: MAVLink over TCP in lockstep. PX4 connects to the simulator.

pub mod airframe;
mod airframe_limits;
pub mod command_line;
mod equipment;
mod flow_message;
mod gnss_message;
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
pub use command_line::shell_command;
pub use interface::{Px4Interface, RATES_HZ};
pub use launch::launch;
pub use receiver::RejectedCounts;
