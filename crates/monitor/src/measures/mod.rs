//! Measures computed from the frames of a session, with one file per measure.

pub mod attention;
pub mod coverage;
pub mod crash;
pub mod cue_validity;
pub mod image_quality;
pub mod on_path;
pub mod on_speed;
pub mod practice_aids;
