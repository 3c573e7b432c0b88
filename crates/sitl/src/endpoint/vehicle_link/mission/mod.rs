//! Plans: missions, fences and rally points.

pub(super) mod ardupilot_items;
mod deferred_fields;
mod fence_and_rally;
pub(super) mod items;
mod plan_store;
mod plan_summary;
mod positions;

pub(super) use plan_store::ack;
pub use plan_store::{ItemEncoding, PlanReply, PlanStore};
pub use plan_summary::PlanSummary;
