//! Transport: links to peers, with their stream schedules, capacity limits, signing and outgoing queues. This module
//! does not depend on the vehicle.

mod budget;
mod datagram;
mod link_id;
mod links;
mod lockstep;
mod peer_link;
mod signing;
mod signing_policy;
mod stream_schedule;

pub use budget::LinkBudget;
pub use datagram::ReceivedDatagram;
pub use link_id::{LinkId, LinkKind, Transmit};
pub use links::Links;
pub use lockstep::is_time_request;
pub use peer_link::{LockstepState, PeerLink};
pub use signing_policy::{FrameAdmission, SigningPolicy};
pub use stream_schedule::{ScheduledStream, StreamSchedule};
