//! Open files of the clients. Each client numbers its own.

use super::FileClient;
use super::path::FilePath;
use spandrel_mavlink::ftp::{FtpError, FtpPacket};
use spandrel_model::time::SimTime;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Files that all clients together may have open.
const SESSIONS_MAX: usize = 32;
/// Files that one client may have open; MAVProxy moves five at once.
const EACH_MAX: usize = 8;
/// A session that is not used this long is ended, so that a client that died holds nothing.
const IDLE: SimTime = SimTime::from_ms(60_000);
/// A request to open that comes again within this time is a repetition, whatever came in between: networks double and reorder datagrams.
/// Later it is a new one by a client whose sequence numbers begin anew (estimate: longer than networks hold datagrams back).
const REPETITION: SimTime = SimTime::from_ms(2_000);

#[derive(Debug, Clone)]
struct FileSession {
    path: FilePath,
    writes: bool,
    used: SimTime,
    opened: SimTime,
    /// The request that opened it.
    request: FtpPacket,
    /// What is read, where it was made for this session alone.
    content: Option<Arc<[u8]>>,
}

/// All open files, by client and its number.
#[derive(Debug, Clone, Default)]
pub(super) struct FileSessions(BTreeMap<(FileClient, u8), FileSession>);

impl FileSessions {
    /// Whether this client may open a file under this number. One that it has open under it gives way.
    pub fn room(&self, client: FileClient, number: u8) -> Result<(), FtpError> {
        let own = self.0.keys().filter(|(owner, _)| *owner == client).count();
        let full = self.0.len() >= SESSIONS_MAX || own >= EACH_MAX;
        if full && !self.0.contains_key(&(client, number)) { Err(FtpError::NoSessionsAvailable) } else { Ok(()) }
    }

    /// Opens a file under the number that the request names.
    pub fn begin(
        &mut self,
        owner: FileClient,
        request: &FtpPacket,
        path: FilePath,
        writes: bool,
        now: SimTime,
    ) -> Result<(), FtpError> {
        self.room(owner, request.session)?;
        let session = FileSession { path, writes, used: now, opened: now, request: request.clone(), content: None };
        self.0.insert((owner, request.session), session);
        Ok(())
    }

    /// This request has just opened the session that it names.
    pub fn is_repetition(&self, client: FileClient, request: &FtpPacket, now: SimTime) -> bool {
        let session = self.0.get(&(client, request.session));
        session.is_some_and(|session| session.request == *request && now.saturating_sub(session.opened) <= REPETITION)
    }

    /// Keeps what was made for a session.
    pub fn hold(&mut self, client: FileClient, number: u8, content: Arc<[u8]>) {
        if let Some(session) = self.0.get_mut(&(client, number)) {
            session.content = Some(content);
        }
    }

    /// What was made for a session of this client.
    pub fn content(&self, client: FileClient, number: u8) -> Option<Arc<[u8]>> {
        self.0.get(&(client, number))?.content.clone()
    }

    /// The file of a session of this client, which must have been opened to be written if `writes`.
    pub fn path(&self, client: FileClient, number: u8, writes: bool) -> Result<FilePath, FtpError> {
        match self.0.get(&(client, number)) {
            Some(session) if session.writes == writes => Ok(session.path.clone()),
            _ => Err(FtpError::InvalidSession),
        }
    }

    /// Ends one of this client's.
    pub fn end(&mut self, client: FileClient, number: u8) -> Option<()> {
        self.0.remove(&(client, number)).map(|_| ())
    }

    /// Ends those of the owners that fit.
    pub fn close_matching(&mut self, fits: impl Fn(FileClient) -> bool) {
        self.0.retain(|(owner, _), _| !fits(*owner));
    }

    /// It is in use.
    pub fn touch(&mut self, client: FileClient, number: u8, now: SimTime) {
        if let Some(session) = self.0.get_mut(&(client, number)) {
            session.used = now;
        }
    }

    /// Ends what nobody uses.
    pub fn expire(&mut self, now: SimTime) {
        self.0.retain(|_, session| now.saturating_sub(session.used) <= IDLE);
    }
}
