//! The defect school: pictures of known defects at 1, 3 and 8 m, the question what they show, and spaced repetition of what was
//! missed. The caller renders the pictures and stores the record.

mod card;
mod gallery;
mod record;
mod round;

#[cfg(test)]
mod tests;

pub use card::{Card, Distance, Subject};
pub use gallery::{SchoolPicture, gallery, picture_camera, school_scenario};
pub use record::{BOX_COUNT, SchoolRecord, SchoolRecordError};
pub use round::{Answer, CARDS_PER_ROUND, Question, Round, RoundSummary, Verdict};
