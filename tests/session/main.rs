//! Whole sessions from datagrams alone: frames, measures, ends, the live monitor and its replay.

mod completion;
mod cut;
mod exported_frames;
mod feedback;
mod hostile;
#[path = "../support/inspection.rs"]
mod inspection;
#[path = "../support/job.rs"]
mod job;
mod link;
mod live;
mod output;
mod pieces;
mod records;
mod report;
mod shipped;
