//! End-to-end tests of sessions from datagrams: frames, measures, session ends, the live monitor and its replay.
#![allow(clippy::unwrap_used, reason = "a test")]

mod chunked_reading;
mod completion;
mod corrupt_input;
mod cue_validity;
mod exported_frames;
mod feedback;
mod guidance;
mod link;
mod live;
mod output;
mod planted;
mod shipped;
mod truncation;
