//! The shell's client, its input line, and the pending output.

use crate::endpoint::link::LinkId;
use std::collections::VecDeque;

/// Maximum pending output, bytes; the excess is discarded.
const MAX_OUTPUT_BYTES: usize = 65_536;

/// A shell client: its link, system ID and component ID.
pub(super) type ShellClient = (LinkId, (u8, u8));

/// State of the shell. It has one client at a time, as in PX4: a client that types takes it over.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct NshShell {
    pub(super) client: Option<ShellClient>,
    pub(super) line: String,
    pub(super) out: VecDeque<u8>,
}

impl NshShell {
    pub(super) fn print(&mut self, text: &str) {
        let room = MAX_OUTPUT_BYTES.saturating_sub(self.out.len());
        self.out.extend(text.bytes().take(room));
    }

    /// Resets the shell if its client's link was closed.
    pub fn disconnect(&mut self, link: LinkId) {
        if self.client.is_some_and(|(known, _)| known == link) {
            *self = Self::default();
        }
    }
}
