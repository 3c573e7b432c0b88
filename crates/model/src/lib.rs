//! What vehicle and monitor share, and the only thing that they share beside the MAVLink wire: time, frames, geodesy, random streams, and a
//! job's scenario, aircraft and site.
//!
//! Time is a whole number of nanoseconds ([`time::SimTime`]). A vector carries its frame in its type ([`frames`]: `Enu`, `Ned`, `Frd`), a
//! number carries its unit in its name. Whatever is random comes from a stream with a name and a seed ([`random`]), and sines and logarithms
//! come from [`math`] alone, so that the same inputs give the same bits on every machine.
//!
//! A job is a [`scenario::Scenario`], read from TOML with every problem of the file reported at once; an aircraft is a [`vehicle::Vehicle`].
//! [`site::Site`] is built from a scenario and a seed and answers queries about it: distance to the nearest surface, what a ray hits, how
//! bright it is, which defects a picture shows. What moves takes the time as an argument.
//!
//! ```
//! use spandrel_model::frames::Vec3;
//! use spandrel_model::site::Site;
//! use spandrel_model::time::SimTime;
//! use spandrel_model::{scenario, shipped};
//!
//! # fn main() -> Result<(), spandrel_model::toml::Problems> {
//! let job = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &|file| Err(format!("{file} is not there")))?;
//! let site = Site::build(&job, 7);
//! let beside_the_pad = job.ground_team.pad_m + Vec3::new(0.0, 60.0, 8.0);
//! let nearest = site.nearest(beside_the_pad, 100.0, SimTime::ZERO).expect("the arch bridge is within 100 m");
//! println!("{} is {:.1} m away", site.object_name(nearest.object), nearest.distance_m);
//! assert!(nearest.distance_m > 0.0);
//! # Ok(())
//! # }
//! ```

pub mod calendar;
pub mod foxglove;
pub mod frames;
pub mod geodesy;
pub mod math;
pub mod numbers;
pub mod random;
pub mod scenario;
pub mod shipped;
pub mod site;
pub mod time;
pub mod toml;
pub mod vehicle;
