//! The pages of `spandrel serve` and their access control: pure functions from data to HTML, and the tables of login sessions and
//! failed logins with time as an argument. User-provided text goes through maud's escaping. Scripts and styles are separate
//! files, so that the pages' policy allows nothing inline.

pub mod access;
pub mod assets;
pub mod devices;
pub mod form;
pub mod frame;
pub mod group;
pub mod job;
pub mod live;
pub mod live_state;
pub mod login;
pub mod sessions;
pub mod settings;
pub mod throttle;
pub mod trainees;
pub mod visits;
