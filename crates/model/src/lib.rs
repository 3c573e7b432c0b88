//! Types shared by the simulated vehicle and the monitor, which otherwise communicate only over MAVLink: time, coordinate frames,
//! geodesy, random streams, and a job's scenario, aircraft and site.
//!
//! Time is an integer number of nanoseconds ([`time::SimTime`]). The type of a vector includes its frame ([`frames`]:
//! `Enu`, `Ned`, `Frd`), and the name of a number includes its unit. All random numbers come from named, seeded streams
//! ([`random`]), and all transcendental functions from [`math`]. The same inputs therefore yield bit-identical results
//! on every machine.
//!
//! A job is a [`scenario::Scenario`] and an aircraft is a [`vehicle::Vehicle`]. Both are parsed from TOML files, and all problems
//! in a file are reported together. [`site::Site`] is built from a scenario and a seed and answers queries: distance to the
//! nearest surface, first hit of a ray, illuminance, and visibility of defects in a photo. Queries that involve moving objects
//! take the time as an argument.
//!
//! ```
//! use spandrel_model::frames::Vec3;
//! use spandrel_model::site::Site;
//! use spandrel_model::time::SimTime;
//! use spandrel_model::{scenario, shipped};
//!
//! # fn main() -> Result<(), spandrel_model::toml::Problems> {
//! let job = scenario::read("two-bridges.toml", shipped::TWO_BRIDGES, &|file| Err(format!("{file} not found")))?;
//! let site = Site::build(&job, 7);
//! let beside_the_pad = job.ground_team.pad_m + Vec3::new(0.0, 60.0, 8.0);
//! let nearest = site.nearest(beside_the_pad, 100.0, SimTime::ZERO).expect("the arch bridge is within 100 m");
//! println!("{} is {:.1} m away", site.object_name(nearest.object), nearest.distance_m);
//! assert!(nearest.distance_m > 0.0);
//! # Ok(())
//! # }
//! ```

pub mod calendar;
pub mod defect_codes;
pub mod elements;
pub mod foxglove;
pub mod frames;
pub mod geodesy;
pub mod key_table;
pub mod math;
pub mod mesh;
pub mod numbers;
pub mod pose;
pub mod radio;
pub mod random;
pub mod raster;
pub mod satellites;
pub mod scenario;
pub mod shipped;
pub mod site;
pub mod speed_unit;
pub mod stick_response;
pub mod time;
pub mod toml;
pub mod vehicle;
