//! Builders for messages from the equipment and the scoring feed.

pub(crate) mod battery;
pub(crate) mod camera;
pub(crate) mod gimbal;
pub(crate) mod lamp;
pub(crate) mod truth;
