//! Open files of the clients.

use super::Client;
use super::path::FilePath;
use crate::base::time::SimTime;
use crate::mav::ftp::Refusal;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Files that all clients together may have open.
const SESSIONS_MAX: usize = 32;
/// Files that one client may have open.
const EACH_MAX: usize = 4;
/// A session that is not used this long is ended, so that a client that died holds nothing.
const IDLE: SimTime = SimTime::from_ms(60_000);

#[derive(Debug, Clone)]
struct Session {
    owner: Client,
    path: FilePath,
    writes: bool,
    used: SimTime,
    /// What is read, where it was made for this session alone.
    content: Option<Arc<[u8]>>,
}

/// All open files, by session number.
#[derive(Debug, Clone, Default)]
pub(super) struct Sessions(BTreeMap<u8, Session>);

impl Sessions {
    /// Whether this client may open one more.
    pub fn room(&self, client: Client) -> Result<(), Refusal> {
        let own = self.0.values().filter(|session| session.owner == client).count();
        if self.0.len() >= SESSIONS_MAX || own >= EACH_MAX { Err(Refusal::NoSessionsAvailable) } else { Ok(()) }
    }

    /// Opens one and says its number.
    pub fn begin(&mut self, owner: Client, path: FilePath, writes: bool, now: SimTime) -> Result<u8, Refusal> {
        self.room(owner)?;
        let number = (0..=u8::MAX).find(|number| !self.0.contains_key(number)).ok_or(Refusal::NoSessionsAvailable)?;
        self.0.insert(number, Session { owner, path, writes, used: now, content: None });
        Ok(number)
    }

    /// Keeps what was made for a session.
    pub fn hold(&mut self, number: u8, content: Arc<[u8]>) {
        if let Some(session) = self.0.get_mut(&number) {
            session.content = Some(content);
        }
    }

    /// What was made for a session of this client.
    pub fn content(&self, client: Client, number: u8) -> Option<Arc<[u8]>> {
        self.0.get(&number).filter(|session| session.owner == client)?.content.clone()
    }

    /// The file of a session of this client, which must have been opened to be written if `writes`.
    pub fn path(&self, client: Client, number: u8, writes: bool) -> Result<FilePath, Refusal> {
        match self.0.get(&number) {
            Some(session) if session.owner == client && session.writes == writes => Ok(session.path.clone()),
            _ => Err(Refusal::InvalidSession),
        }
    }

    /// Ends one of this client's.
    pub fn end(&mut self, client: Client, number: u8) -> Option<()> {
        let own = self.0.get(&number).is_some_and(|session| session.owner == client);
        own.then(|| self.0.remove(&number)).map(|_| ())
    }

    /// Ends those of the owners that fit.
    pub fn end_where(&mut self, fits: impl Fn(Client) -> bool) {
        self.0.retain(|_, session| !fits(session.owner));
    }

    /// It is in use.
    pub fn touch(&mut self, client: Client, number: u8, now: SimTime) {
        if let Some(session) = self.0.get_mut(&number).filter(|session| session.owner == client) {
            session.used = now;
        }
    }

    /// Ends what nobody uses.
    pub fn expire(&mut self, now: SimTime) {
        self.0.retain(|_, session| now.saturating_sub(session.used) <= IDLE);
    }
}
