//! A simulated multirotor with a MAVLink interface: physics, sensors, autopilot and protocol endpoint in one simulator
//! that does not use sockets or clocks.
//!
//! [`sim::Sim`] is the complete vehicle at its site. The host advances time (`handle_timeout`), passes in received
//! datagrams (`handle_datagram`) and sends outgoing ones (`poll_transmit`). The same code runs in real time, at ten
//! times real time and at unlimited speed; only the timestamps differ. A clone of the simulator is a snapshot.
//!
//! Each step runs in this order: sensors ([`sensors`]), the autopilot ([`autopilot`]: estimator, failsafes, navigator,
//! control), six-degree-of-freedom motion and contact ([`physics`]), then outgoing telemetry ([`endpoint`]). The
//! autopilot receives only sensor readings, never the true state. One table selects the emulated autopilot, PX4 or
//! ArduCopter ([`endpoint::flavor`]). A real PX4 or ArduPilot can fly the vehicle instead ([`backend`]).
//!
//! For tests and scripts, [`testing::Vehicle`] controls the vehicle with commands:
//!
//! ```
//! use spandrel_model::shipped;
//! use spandrel_model::time::SimTime;
//! use spandrel_sitl::testing::Vehicle;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut vehicle = Vehicle::builder().scenario(shipped::DRILL_HOVER).seed(7).build()?;
//! vehicle.arm(SimTime::from_s(30.0))?;
//! vehicle.take_off(5.0)?;
//! let took = vehicle.run_until(|v| v.height_m() > 4.5, SimTime::from_s(20.0))?;
//! println!("5 m after {:.1} s", took.s());
//! # Ok(())
//! # }
//! ```

pub mod autopilot;
pub mod backend;
pub mod endpoint;
pub mod faults;
pub mod log;
pub mod physics;
pub mod sensors;
pub mod sim;
pub mod testing;
