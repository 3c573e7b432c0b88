//! Answers that have gone out: a request that comes again is answered again, and its work is not done twice.

use super::super::LinkId;
use super::FileClient;
use spandrel_mavlink::ftp::{FtpError, FtpPacket, NAK};
use std::collections::BTreeMap;

/// Sessions whose last answer is kept.
const ANSWERS_MAX: usize = 64;

/// The last request of each session, and its answer.
#[derive(Debug, Clone, Default)]
pub(super) struct ReplyCache {
    last: BTreeMap<(FileClient, u8), (u64, FtpPacket, FtpPacket)>,
    count: u64,
}

impl ReplyCache {
    /// The answer to this very request, if it was its session's last.
    pub fn cached_reply(&self, client: FileClient, request: &FtpPacket) -> Option<&FtpPacket> {
        let (_, asked, answer) = self.last.get(&(client, request.session))?;
        (asked == request).then_some(answer)
    }

    /// Keeps an answer; the oldest makes room. A request that comes late to a session that has ended leaves the answer about its end in place:
    /// that one may have been lost.
    pub fn keep(&mut self, client: FileClient, request: &FtpPacket, answer: &FtpPacket) {
        let ended = answer.sized() == Some(&[FtpError::InvalidSession as u8]) && answer.opcode == NAK;
        if ended && self.last.contains_key(&(client, request.session)) {
            return;
        }
        self.count += 1;
        self.last.insert((client, request.session), (self.count, request.clone(), answer.clone()));
        if self.last.len() > ANSWERS_MAX
            && let Some(oldest) = self.last.iter().min_by_key(|(_, (count, ..))| *count).map(|(key, _)| *key)
        {
            self.last.remove(&oldest);
        }
    }

    /// A link is gone.
    pub fn forget(&mut self, link: LinkId) {
        self.last.retain(|((from, _), _), _| *from != link);
    }

    /// Answers that are kept.
    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.last.len()
    }
}
