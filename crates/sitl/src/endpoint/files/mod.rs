//! The MAVLink FTP server, sans-IO: packets in, packets out, and file jobs for the host.

mod burst;
mod client;
pub mod job;
pub mod job_allowance;
pub mod path;
mod replies;
mod reply_cache;
mod session;

use super::link::LinkId;
use burst::BurstReads;
pub use client::FileClient;
use job::{CHECKSUM_SLICE, DirectoryEntry, FileAction, FileError, FileJob, FileJobResult, MAX_CHECKSUM_BYTES};
use path::FilePath;
pub(super) use replies::send_replies;
use reply_cache::ReplyCache;
use session::FileSessions;
use spandrel_mavlink::ftp::{ACK, DATA_MAX, FtpError, FtpPacket, Opcode, checksum};
use spandrel_model::time::SimTime;
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

/// Maximum number of pending jobs, in total and per client. Further requests are dropped, as in ArduPilot; the client
/// retries.
const MAX_JOBS: usize = 64;
const MAX_JOBS_PER_CLIENT: usize = 32;
/// Maximum number of packets per burst; the client then requests the next burst.
const BURST_PACKETS: u32 = 128;

/// The MAVLink FTP server.
#[derive(Debug, Clone, Default)]
pub struct FileServer {
    sessions: FileSessions,
    /// Whether a host runs file jobs.
    stored: bool,
    /// Generated, read-only files by path; they are not stored on disk.
    generated: BTreeMap<FilePath, Arc<[u8]>>,
    waiting: BTreeMap<u64, PendingRequest>,
    jobs: VecDeque<FileJob>,
    tickets: u64,
    answered: ReplyCache,
    answers: VecDeque<(FileClient, FtpPacket)>,
    bursts: BurstReads,
}

/// A request with a job in progress.
#[derive(Debug, Clone)]
struct PendingRequest {
    client: FileClient,
    request: FtpPacket,
    opens: Option<(FilePath, bool)>,
    /// Number of bytes included in the checksum so far.
    checksummed_bytes: u32,
}

impl FileServer {
    /// Enables file jobs, which the host must run. Without them, the server has only generated files.
    pub fn stored(&mut self) {
        self.stored = true;
    }

    /// Serves a generated file at `path`.
    pub fn generate(&mut self, path: &str, content: impl Into<Arc<[u8]>>) {
        if let Some(path) = FilePath::of(path.as_bytes()) {
            self.generated.insert(path, content.into());
        }
    }

    /// Releases all state for a closed link.
    pub fn forget(&mut self, link: LinkId) {
        self.sessions.close_matching(|client| client.0 == link);
        self.answered.forget(link);
        self.bursts.end_matching(|client| client.0 == link);
        self.answers.retain(|(client, _)| client.0 != link);
        self.waiting.retain(|_, waiting| waiting.client.0 != link);
    }

    /// Returns the next job's action.
    #[must_use]
    pub fn next_action(&self) -> Option<&FileAction> {
        self.jobs.front().map(|job| &job.action)
    }

    /// Removes and returns the next job.
    pub fn poll_job(&mut self) -> Option<FileJob> {
        self.jobs.pop_front()
    }

    /// Returns the replies to send in this tick: all ordinary replies, and a few burst packets on links that are ready
    /// for them.
    pub fn poll(&mut self, ready: impl Fn(&LinkId) -> bool) -> Vec<(FileClient, FtpPacket)> {
        let mut out: Vec<_> = self.answers.drain(..).collect();
        out.extend(self.bursts.poll(ready));
        out
    }

    /// Checks for a repeated request. A repeat is not executed again; if its reply is available, the reply is resent.
    fn is_duplicate(&mut self, client: FileClient, request: &FtpPacket, now: SimTime) -> bool {
        if let Some(answer) = self.answered.cached_reply(client, request) {
            self.answers.push_back((client, answer.clone()));
            return true;
        }
        self.bursts.is_active(client, request)
            || self.sessions.is_repeated_open(client, request, now)
            || self.waiting.values().any(|waiting| waiting.client == client && waiting.request == *request)
    }

    /// Opens a file whose content was generated for this session; later changes do not affect it.
    pub fn open_generated(&mut self, client: FileClient, request: &FtpPacket, content: Vec<u8>, now: SimTime) {
        if self.is_duplicate(client, request, now) {
            return;
        }
        self.sessions.expire(now);
        let size = content.len() as u32;
        let path = request.data_in_use().and_then(FilePath::of).map(|path| (path, false));
        let answer = self.opened(client, request, path, size, now);
        if answer.opcode == ACK {
            self.sessions.set_content(client, answer.session, content.into());
        }
        self.queue_reply(client, request, answer);
    }

    /// Handles a request.
    pub fn receive(&mut self, client: FileClient, request: &FtpPacket, now: SimTime) {
        if self.is_duplicate(client, request, now) {
            return;
        }
        self.sessions.expire(now);
        self.sessions.touch(client, request.session, now);
        match self.act(client, request) {
            Ok(RequestStep::Bytes(bytes)) if request.opcode == Opcode::BurstReadFile as u8 => self.burst(client, request, &bytes),
            Ok(RequestStep::Bytes(bytes)) if bytes.is_empty() => {
                self.queue_reply(client, request, request.error_reply(FtpError::EndOfFile))
            }
            Ok(RequestStep::Bytes(bytes)) => self.queue_reply(client, request, request.acknowledge(&bytes)),
            Ok(RequestStep::Answer(data)) => self.queue_reply(client, request, request.acknowledge(&data)),
            Ok(RequestStep::Job(action, opens)) => self.start_job(client, request, action, opens, now),
            Err(why) => self.queue_reply(client, request, request.error_reply(why)),
        }
    }

    /// Handles a job's result.
    pub fn done(&mut self, ticket: u64, outcome: Result<FileJobResult, FileError>, now: SimTime) {
        if self.queue_next_slice(ticket, &outcome) {
            return;
        }
        let Some(PendingRequest { client, request, opens, .. }) = self.waiting.remove(&ticket) else { return };
        let outcome =
            if request.opcode == Opcode::ListDirectory as u8 { self.add_generated_entries(&request, outcome) } else { outcome };
        let answer = match outcome {
            Err(error) => request.error_reply(error.refusal()),
            Ok(FileJobResult::Entries(entries)) => list(&request, entries),
            Ok(FileJobResult::Bytes(bytes)) if request.opcode == Opcode::BurstReadFile as u8 => {
                return self.burst(client, &request, &bytes);
            }
            Ok(FileJobResult::Bytes(bytes)) if bytes.is_empty() => request.error_reply(FtpError::EndOfFile),
            Ok(FileJobResult::Bytes(bytes)) => request.acknowledge(&bytes),
            // The file exceeds the limit, and a checksum of its first part alone would be wrong.
            Ok(FileJobResult::Checksum { bytes, .. }) if bytes >= CHECKSUM_SLICE => request.error_reply(FtpError::Fail),
            Ok(FileJobResult::Checksum { sum, .. }) => request.acknowledge(&sum.to_le_bytes()),
            Ok(FileJobResult::Size(_) | FileJobResult::Nothing) if opens.is_some() => {
                let size = if let Ok(FileJobResult::Size(size)) = outcome { size } else { 0 };
                self.opened(client, &request, opens, size, now)
            }
            Ok(FileJobResult::Size(size)) => request.acknowledge(&size.to_le_bytes()),
            Ok(FileJobResult::Nothing) => request.acknowledge(&[]),
        };
        self.queue_reply(client, &request, answer);
    }

    /// Queues the next slice of an unfinished checksum behind other jobs. Returns false if there is none.
    fn queue_next_slice(&mut self, ticket: u64, outcome: &Result<FileJobResult, FileError>) -> bool {
        let Some(waiting) = self.waiting.get_mut(&ticket) else { return false };
        let Ok(FileJobResult::Checksum { sum, bytes }) = outcome else { return false };
        waiting.checksummed_bytes = waiting.checksummed_bytes.saturating_add(*bytes);
        if *bytes < CHECKSUM_SLICE || waiting.checksummed_bytes > MAX_CHECKSUM_BYTES {
            return false;
        }
        let Some(path) = waiting.request.data_in_use().and_then(FilePath::of) else { return false };
        let action = FileAction::Checksum { path, from: waiting.checksummed_bytes, sum: *sum };
        self.jobs.push_back(FileJob { ticket, action });
        true
    }

    fn act(&mut self, client: FileClient, request: &FtpPacket) -> Result<RequestStep, FtpError> {
        let data = request.data_in_use().ok_or(FtpError::InvalidDataSize)?;
        let opcode = Opcode::of(request.opcode).ok_or(FtpError::UnknownCommand)?;
        let path = || FilePath::of(data).ok_or(FtpError::FileNotFound);
        let act = match opcode {
            Opcode::None => RequestStep::Answer(Vec::new()),
            Opcode::TerminateSession => {
                self.sessions.end(client, request.session).ok_or(FtpError::InvalidSession)?;
                self.bursts.end(client, request.session);
                RequestStep::Answer(Vec::new())
            }
            Opcode::ResetSessions => {
                self.sessions.close_matching(|owner| owner == client);
                self.bursts.end_matching(|owner| owner == client);
                RequestStep::Answer(Vec::new())
            }
            Opcode::ListDirectory => RequestStep::Job(FileAction::List(path()?), None),
            Opcode::OpenFileRo => self.open(client, request.session, path()?)?,
            Opcode::CreateFile | Opcode::OpenFileWo => {
                let path = self.writable(path()?)?;
                self.sessions.check_capacity(client, request.session)?;
                let action = if opcode == Opcode::CreateFile { FileAction::Create } else { FileAction::Size };
                RequestStep::Job(action(path.clone()), Some((path, true)))
            }
            Opcode::ReadFile | Opcode::BurstReadFile => return self.read(client, request, opcode),
            Opcode::WriteFile => {
                let path = self.sessions.path(client, request.session, true)?;
                RequestStep::Job(FileAction::Write(path, request.offset, data.to_vec()), None)
            }
            Opcode::RemoveFile => RequestStep::Job(FileAction::Remove(self.writable(path()?)?), None),
            Opcode::CreateDirectory => RequestStep::Job(FileAction::MakeDirectory(self.writable(path()?)?), None),
            Opcode::RemoveDirectory => RequestStep::Job(FileAction::RemoveDirectory(self.writable(path()?)?), None),
            Opcode::TruncateFile => RequestStep::Job(FileAction::Truncate(self.writable(path()?)?, request.offset), None),
            Opcode::Rename => {
                let middle = data.iter().position(|byte| *byte == 0).ok_or(FtpError::InvalidDataSize)?;
                let part = |bytes| FilePath::of(bytes).ok_or(FtpError::FileNotFound);
                let (from, to) = (part(&data[..middle])?, part(&data[middle + 1..])?);
                RequestStep::Job(FileAction::Rename(self.writable(from)?, self.writable(to)?), None)
            }
            Opcode::CalcFileCrc32 => {
                let path = path()?;
                match self.generated.get(&path) {
                    Some(content) => RequestStep::Answer(checksum(0, content).to_le_bytes().to_vec()),
                    None => RequestStep::Job(FileAction::Checksum { path, from: 0, sum: 0 }, None),
                }
            }
        };
        Ok(act)
    }

    /// Checks that a path is writable: generated files and the root are protected.
    fn writable(&self, path: FilePath) -> Result<FilePath, FtpError> {
        if path.is_root() || self.generated.contains_key(&path) { Err(FtpError::FileProtected) } else { Ok(path) }
    }

    fn open(&mut self, client: FileClient, number: u8, path: FilePath) -> Result<RequestStep, FtpError> {
        self.sessions.check_capacity(client, number)?;
        Ok(RequestStep::Job(FileAction::Size(path.clone()), Some((path, false))))
    }

    fn opened(
        &mut self,
        client: FileClient,
        request: &FtpPacket,
        opens: Option<(FilePath, bool)>,
        size: u32,
        now: SimTime,
    ) -> FtpPacket {
        let Some((path, writes)) = opens else { return request.error_reply(FtpError::Fail) };
        self.bursts.end(client, request.session);
        match self.sessions.begin(client, request, path, writes, now) {
            Ok(()) => request.acknowledge(&size.to_le_bytes()),
            Err(why) => request.error_reply(why),
        }
    }

    fn read(&mut self, client: FileClient, request: &FtpPacket, opcode: Opcode) -> Result<RequestStep, FtpError> {
        let path = self.sessions.path(client, request.session, false)?;
        let packets = if opcode == Opcode::BurstReadFile { BURST_PACKETS } else { 1 };
        let most = packets * chunk(request);
        Ok(match self.sessions.content(client, request.session) {
            Some(content) => RequestStep::Bytes(slice_at(&content, request.offset, most)),
            None => RequestStep::Job(FileAction::Read(path, request.offset, most), None),
        })
    }

    /// Queues one burst. Its last packet marks the burst as complete, even at the end of the file. If a NAK followed
    /// instead, a client that lost that packet would give up (MAVSDK 4). Only a request that starts at the end of the
    /// file is rejected.
    fn burst(&mut self, client: FileClient, request: &FtpPacket, bytes: &[u8]) {
        if bytes.is_empty() {
            return self.queue_reply(client, request, request.error_reply(FtpError::EndOfFile));
        }
        let (mut offset, mut asked, mut packets) = (request.offset, request.clone(), VecDeque::new());
        for piece in bytes.chunks(chunk(request) as usize) {
            packets.push_back(FtpPacket { offset, ..asked.acknowledge(piece) });
            offset = offset.saturating_add(piece.len() as u32);
            asked.sequence = asked.sequence.wrapping_add(1);
        }
        if let Some(last) = packets.back_mut() {
            last.burst_complete = true;
        }
        self.bursts.begin(client, request, packets);
    }

    fn start_job(
        &mut self,
        client: FileClient,
        request: &FtpPacket,
        action: FileAction,
        opens: Option<(FilePath, bool)>,
        now: SimTime,
    ) {
        let own = self.waiting.values().filter(|waiting| waiting.client == client).count();
        if self.waiting.len() >= MAX_JOBS || own >= MAX_JOBS_PER_CLIENT {
            return;
        }
        self.tickets += 1;
        let ticket = self.tickets;
        self.waiting.insert(ticket, PendingRequest { client, request: request.clone(), opens, checksummed_bytes: 0 });
        if let Some(outcome) = self.is_generated(&action) {
            self.done(ticket, outcome, now);
            return;
        }
        self.jobs.push_back(FileJob { ticket, action });
    }

    /// Returns the result for generated files, which do not require a job. Generated entries are added to a listing
    /// when its job completes.
    fn is_generated(&self, action: &FileAction) -> Option<Result<FileJobResult, FileError>> {
        match action {
            FileAction::Size(path) => self.generated.get(path).map(|content| Ok(FileJobResult::Size(content.len() as u32))),
            FileAction::Read(path, offset, most) => {
                self.generated.get(path).map(|content| Ok(FileJobResult::Bytes(slice_at(content, *offset, *most))))
            }
            FileAction::List(_)
            | FileAction::Create(_)
            | FileAction::Write(..)
            | FileAction::Remove(_)
            | FileAction::MakeDirectory(_)
            | FileAction::RemoveDirectory(_)
            | FileAction::Truncate(..)
            | FileAction::Rename(..)
            | FileAction::Checksum { .. } => None,
        }
        .or_else(|| (!self.stored).then(|| Self::without_storage(action)))
    }

    fn without_storage(action: &FileAction) -> Result<FileJobResult, FileError> {
        match action {
            FileAction::List(path) if path.is_root() => Ok(FileJobResult::Entries(Vec::new())),
            FileAction::Create(_) | FileAction::MakeDirectory(_) => Err(FileError::Protected),
            FileAction::List(_)
            | FileAction::Size(_)
            | FileAction::Read(..)
            | FileAction::Write(..)
            | FileAction::Remove(_)
            | FileAction::RemoveDirectory(_)
            | FileAction::Truncate(..)
            | FileAction::Rename(..)
            | FileAction::Checksum { .. } => Err(FileError::NotFound),
        }
    }

    /// Adds the generated files to a directory listing. A directory that contains only generated files also exists.
    fn add_generated_entries(
        &self,
        request: &FtpPacket,
        outcome: Result<FileJobResult, FileError>,
    ) -> Result<FileJobResult, FileError> {
        let Some(path) = request.data_in_use().and_then(FilePath::of) else { return outcome };
        let mut made_up: Vec<DirectoryEntry> = Vec::new();
        for (name, content) in &self.generated {
            let entry = name.below(&path).map(|rest| match rest.split_once('/') {
                Some((directory, _)) => DirectoryEntry::Directory(directory.to_owned()),
                None => DirectoryEntry::File(rest.to_owned(), content.len() as u64),
            });
            made_up.extend(entry.filter(|entry| !made_up.contains(entry)));
        }
        match outcome {
            Ok(FileJobResult::Entries(stored)) => {
                made_up.extend(stored.into_iter().filter(|entry| !made_up.contains(entry)).collect::<Vec<_>>());
                Ok(FileJobResult::Entries(made_up))
            }
            Err(FileError::NotFound) if !made_up.is_empty() => Ok(FileJobResult::Entries(made_up)),
            other => other,
        }
    }

    fn queue_reply(&mut self, client: FileClient, request: &FtpPacket, answer: FtpPacket) {
        self.answered.keep(client, request, &answer);
        self.answers.push_back((client, answer));
    }
}

/// Next step in handling a request.
enum RequestStep {
    /// Acknowledge immediately with this data.
    Answer(Vec<u8>),
    /// Return the data read.
    Bytes(Vec<u8>),
    /// Run a job. Includes the file that it opens, and whether the file is writable.
    Job(FileAction, Option<(FilePath, bool)>),
}

/// Returns at most `most` bytes from an offset.
fn slice_at(content: &[u8], offset: u32, most: u32) -> Vec<u8> {
    let from = (offset as usize).min(content.len());
    let to = from.saturating_add(most as usize).min(content.len());
    content[from..to].to_vec()
}

/// Returns the requested number of bytes per packet; a request for 0 means the maximum.
fn chunk(request: &FtpPacket) -> u32 {
    match usize::from(request.size) {
        0 => DATA_MAX as u32,
        size => size.min(DATA_MAX) as u32,
    }
}

/// Returns as many entries as fit into a packet, starting with the entry whose number is given by the offset.
fn list(request: &FtpPacket, entries: Vec<DirectoryEntry>) -> FtpPacket {
    let mut data = Vec::new();
    for entry in entries.iter().skip(request.offset as usize) {
        let text = match entry {
            DirectoryEntry::Directory(name) => format!("D{name}\0"),
            DirectoryEntry::File(name, size) => format!("F{name}\t{size}\0"),
        };
        // Skip a name that is too long for a packet, so that the entries after it remain accessible.
        let text = if text.len() > DATA_MAX { "S\0".to_owned() } else { text };
        if data.len() + text.len() > DATA_MAX {
            break;
        }
        data.extend_from_slice(text.as_bytes());
    }
    if data.is_empty() { request.error_reply(FtpError::EndOfFile) } else { request.acknowledge(&data) }
}

#[cfg(test)]
mod tests;
