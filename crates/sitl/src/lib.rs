//! A multirotor in software that speaks MAVLink: physics, sensors, an autopilot and its interface, in one simulator without sockets or clocks.
//!
//! [`sim::Sim`] is the whole vehicle at its site. Whoever runs it says what time it is (`handle_timeout`), hands in what came from a link
//! (`handle_datagram`) and takes out what goes there (`poll_transmit`). Real time, ten times real time and as fast as possible are the same
//! code with other times, and a clone is a snapshot.
//!
//! One step, in order: readings that are due ([`sensors`]), the autopilot ([`autopilot`]: estimator, modes, control, mixer), six degrees of
//! freedom and contact ([`physics`]), then what the clients are told ([`endpoint`]). The autopilot sees readings, never the truth. Whose
//! autopilot the clients believe to see, PX4 or ArduCopter, is one table ([`endpoint::flavour`]).
//!
//! For tests and scripts, [`testing::Vehicle`] flies it by commands:
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
