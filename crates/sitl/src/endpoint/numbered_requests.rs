//! Requests that their sender numbers, so that one that it repeats is carried out only once.

use super::vehicle_command::VehicleCommand;
use spandrel_mavlink::contract::practice::number_in;
use std::collections::BTreeMap;

/// Number of senders whose last request is known.
pub(super) const MAX_SENDERS: usize = 64;

/// A request with a number: the command and the number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct RequestNumber {
    from: (u8, u8),
    request: (u16, u32),
}

/// The last numbered request of each sender, by its system and component ID.
#[derive(Debug, Clone, Default)]
pub(super) struct NumberedRequests {
    pub(super) last: BTreeMap<(u8, u8), (u16, u32)>,
}

impl RequestNumber {
    /// Returns the number in parameter 2 of a command; `None` if it has none.
    ///
    /// # Errors
    /// Returns a text with the allowed values if the parameter is invalid.
    pub(super) fn of(c: &VehicleCommand) -> Result<Option<Self>, &'static str> {
        Ok(number_in(c.p[1])?.map(|number| Self { from: c.from, request: (c.number, number) }))
    }
}

impl NumberedRequests {
    /// Checks whether the sender repeats its last request, because the acknowledgment was lost.
    pub(super) fn is_repeated(&self, number: Option<RequestNumber>) -> bool {
        number.is_some_and(|number| self.last.get(&number.from) == Some(&number.request))
    }

    /// Remembers a request that was carried out.
    pub(super) fn remember(&mut self, number: Option<RequestNumber>) {
        let Some(RequestNumber { from, request }) = number else { return };
        if self.last.len() >= MAX_SENDERS && !self.last.contains_key(&from) {
            self.last.pop_first();
        }
        self.last.insert(from, request);
    }
}
