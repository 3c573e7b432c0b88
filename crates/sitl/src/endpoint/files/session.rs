//! The clients' open files. Session numbers are per client.

use super::client::FileClient;
use super::path::FilePath;
use spandrel_mavlink::ftp::{FtpError, FtpPacket};
use spandrel_model::time::SimTime;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Maximum number of open files for all clients combined.
const MAX_SESSIONS: usize = 32;
/// Maximum number of open files per client; MAVProxy transfers up to five in parallel.
const MAX_SESSIONS_PER_CLIENT: usize = 8;
/// Timeout after which an idle session is closed, so that clients that have disappeared do not tie up resources.
const IDLE_TIMEOUT: SimTime = SimTime::from_ms(60_000);
/// Time within which an identical open request counts as a repeat, regardless of what arrived in between, because
/// networks duplicate and reorder datagrams. A later request comes from a client that has restarted its sequence
/// numbers (estimate: longer than network delays).
const REPEAT_WINDOW: SimTime = SimTime::from_ms(2_000);

#[derive(Debug, Clone)]
struct FileSession {
    path: FilePath,
    writable: bool,
    last_used: SimTime,
    opened: SimTime,
    /// The request that opened the session.
    request: FtpPacket,
    /// Content generated for this session, if any.
    content: Option<Arc<[u8]>>,
}

/// All open files, by client and session number.
#[derive(Debug, Clone, Default)]
pub(super) struct FileSessions(BTreeMap<(FileClient, u8), FileSession>);

impl FileSessions {
    /// Checks whether this client may open a file under this session number. An open session with the same number is
    /// replaced.
    pub fn check_capacity(&self, client: FileClient, number: u8) -> Result<(), FtpError> {
        let own = self.0.keys().filter(|(owner, _)| *owner == client).count();
        let full = self.0.len() >= MAX_SESSIONS || own >= MAX_SESSIONS_PER_CLIENT;
        if full && !self.0.contains_key(&(client, number)) { Err(FtpError::NoSessionsAvailable) } else { Ok(()) }
    }

    /// Opens a file under the session number in the request.
    pub fn begin(
        &mut self,
        owner: FileClient,
        request: &FtpPacket,
        path: FilePath,
        writable: bool,
        now: SimTime,
    ) -> Result<(), FtpError> {
        self.check_capacity(owner, request.session)?;
        let session = FileSession { path, writable, last_used: now, opened: now, request: request.clone(), content: None };
        self.0.insert((owner, request.session), session);
        Ok(())
    }

    /// Checks whether this request has just opened its session.
    pub fn is_repeated_open(&self, client: FileClient, request: &FtpPacket, now: SimTime) -> bool {
        let session = self.0.get(&(client, request.session));
        session.is_some_and(|session| session.request == *request && now.saturating_sub(session.opened) <= REPEAT_WINDOW)
    }

    /// Stores the content generated for a session.
    pub fn set_content(&mut self, client: FileClient, number: u8, content: Arc<[u8]>) {
        if let Some(session) = self.0.get_mut(&(client, number)) {
            session.content = Some(content);
        }
    }

    /// Returns the content generated for one of this client's sessions.
    pub fn content(&self, client: FileClient, number: u8) -> Option<Arc<[u8]>> {
        self.0.get(&(client, number))?.content.clone()
    }

    /// Returns the path of one of this client's sessions. The session must be open for writing if `writable` is set,
    /// and for reading otherwise.
    pub fn path(&self, client: FileClient, number: u8, writable: bool) -> Result<FilePath, FtpError> {
        match self.0.get(&(client, number)) {
            Some(session) if session.writable == writable => Ok(session.path.clone()),
            _ => Err(FtpError::InvalidSession),
        }
    }

    /// Closes one of this client's sessions.
    pub fn end(&mut self, client: FileClient, number: u8) -> Option<()> {
        self.0.remove(&(client, number)).map(|_| ())
    }

    /// Closes the sessions of all matching clients.
    pub fn close_matching(&mut self, fits: impl Fn(FileClient) -> bool) {
        self.0.retain(|(owner, _), _| !fits(*owner));
    }

    /// Resets a session's idle timer.
    pub fn touch(&mut self, client: FileClient, number: u8, now: SimTime) {
        if let Some(session) = self.0.get_mut(&(client, number)) {
            session.last_used = now;
        }
    }

    /// Closes idle sessions.
    pub fn expire(&mut self, now: SimTime) {
        self.0.retain(|_, session| now.saturating_sub(session.last_used) <= IDLE_TIMEOUT);
    }
}
