//! A client of a file server.

use crate::endpoint::link::LinkId;

/// A client: its link, system ID and component ID.
pub type FileClient = (LinkId, (u8, u8));
