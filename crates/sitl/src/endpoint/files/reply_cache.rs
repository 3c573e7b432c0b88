//! Cache of sent replies: a repeated request gets the same reply and is not executed again.

use super::client::FileClient;
use crate::endpoint::link::LinkId;
use spandrel_mavlink::ftp::{FtpError, FtpPacket, NAK};
use std::collections::BTreeMap;

/// Number of sessions whose last reply is kept.
const MAX_REPLIES: usize = 64;

/// Each session's last request and reply.
#[derive(Debug, Clone, Default)]
pub(super) struct ReplyCache {
    last: BTreeMap<(FileClient, u8), (u64, FtpPacket, FtpPacket)>,
    count: u64,
}

impl ReplyCache {
    /// Returns the reply to this exact request if it was the session's last request.
    pub fn cached_reply(&self, client: FileClient, request: &FtpPacket) -> Option<&FtpPacket> {
        let (_, asked, answer) = self.last.get(&(client, request.session))?;
        (asked == request).then_some(answer)
    }

    /// Stores a reply and evicts the oldest if the cache is full. A late request to a closed session does not replace
    /// the reply to its close request, because that reply may have been lost.
    pub fn keep(&mut self, client: FileClient, request: &FtpPacket, answer: &FtpPacket) {
        let ended = answer.data_in_use() == Some(&[FtpError::InvalidSession as u8]) && answer.opcode == NAK;
        if ended && self.last.contains_key(&(client, request.session)) {
            return;
        }
        self.count += 1;
        self.last.insert((client, request.session), (self.count, request.clone(), answer.clone()));
        if self.last.len() > MAX_REPLIES
            && let Some(oldest) = self.last.iter().min_by_key(|(_, (count, ..))| *count).map(|(key, _)| *key)
        {
            self.last.remove(&oldest);
        }
    }

    /// Removes the cached replies for a closed link.
    pub fn forget(&mut self, link: LinkId) {
        self.last.retain(|((from, _), _), _| *from != link);
    }

    /// Returns the number of stored replies.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.last.len()
    }
}
