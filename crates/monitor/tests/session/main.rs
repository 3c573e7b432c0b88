//! Whole sessions from datagrams alone: frames, measures, ends, the live monitor and its replay.

mod completion;
mod cut;
mod exported_frames;
mod feedback;
mod hostile;
mod link;
mod live;
mod output;
mod pieces;
mod shipped;
