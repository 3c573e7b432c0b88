//! The MAVLink FTP server, sans-IO: packets in, packets out, and jobs for whoever holds the files.

pub mod allowance;
mod answered;
mod burst;
pub mod job;
pub mod path;
mod session;

use super::LinkId;
use answered::Answered;
use burst::Bursts;
use job::{Action, CHECKSUM_MAX, CHECKSUM_SLICE, Done, Entry, FileError, Job};
use path::FilePath;
use session::Sessions;
use spandrel_mavlink::ftp::{ACK, DATA_MAX, Opcode, Packet, Refusal, checksum};
use spandrel_model::time::SimTime;
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

/// Who asks: over which link, system, component.
pub type Client = (LinkId, (u8, u8));

/// Jobs that may wait, of all clients and of one. A request beyond that counts as lost on its way, as ArduPilot does it: its client asks
/// again.
const JOBS_MAX: usize = 64;
const JOBS_EACH: usize = 32;
/// Packets of one burst; the client then asks for the next.
const BURST_PACKETS: u32 = 128;

/// The server.
#[derive(Debug, Clone, Default)]
pub struct Server {
    sessions: Sessions,
    /// Somebody holds files and does the jobs.
    stored: bool,
    /// Files that are made up, not stored: read-only, at their paths.
    made_up: BTreeMap<FilePath, Arc<[u8]>>,
    waiting: BTreeMap<u64, Waiting>,
    jobs: VecDeque<Job>,
    tickets: u64,
    answered: Answered,
    answers: VecDeque<(Client, Packet)>,
    bursts: Bursts,
}

/// A request whose job is under way.
#[derive(Debug, Clone)]
struct Waiting {
    client: Client,
    request: Packet,
    opens: Option<(FilePath, bool)>,
    /// Bytes of a checksum so far.
    summed: u32,
}

impl Server {
    /// Somebody does the jobs from now on; until then nothing is there but what is made up.
    pub fn stored(&mut self) {
        self.stored = true;
    }

    /// Serves one more file that is not stored anywhere.
    pub fn make_up(&mut self, path: &str, content: impl Into<Arc<[u8]>>) {
        if let Some(path) = FilePath::of(path.as_bytes()) {
            self.made_up.insert(path, content.into());
        }
    }

    /// A client is gone.
    pub fn forget(&mut self, link: LinkId) {
        self.sessions.end_where(|client| client.0 == link);
        self.answered.forget(link);
        self.bursts.end_where(|client| client.0 == link);
        self.answers.retain(|(client, _)| client.0 != link);
        self.waiting.retain(|_, waiting| waiting.client.0 != link);
    }

    /// The action of the next job.
    #[must_use]
    pub fn next_action(&self) -> Option<&Action> {
        self.jobs.front().map(|job| &job.action)
    }

    /// The next job.
    pub fn poll_job(&mut self) -> Option<Job> {
        self.jobs.pop_front()
    }

    /// Answers that may go out in this tick: all but bursts at once, bursts a few at a time on links that are ready for them.
    pub fn poll(&mut self, ready: impl Fn(&LinkId) -> bool) -> Vec<(Client, Packet)> {
        let mut out: Vec<_> = self.answers.drain(..).collect();
        out.extend(self.bursts.poll(ready));
        out
    }

    /// True for a request that was heard before; its answer, if there is one by now, was lost and goes out again, without doing the work
    /// twice.
    fn is_again(&mut self, client: Client, request: &Packet, now: SimTime) -> bool {
        if let Some(answer) = self.answered.to(client, request) {
            self.answers.push_back((client, answer.clone()));
            return true;
        }
        self.bursts.is_under_way(client, request)
            || self.sessions.is_repetition(client, request, now)
            || self.waiting.values().any(|waiting| waiting.client == client && waiting.request == *request)
    }

    /// Opens a file whose content is made for this session alone: what others do meanwhile changes nothing in it.
    pub fn open_made(&mut self, client: Client, request: &Packet, content: Vec<u8>, now: SimTime) {
        if self.is_again(client, request, now) {
            return;
        }
        self.sessions.expire(now);
        let size = content.len() as u32;
        let path = request.sized().and_then(FilePath::of).map(|path| (path, false));
        let answer = self.opened(client, request, path, size, now);
        if answer.opcode == ACK {
            self.sessions.hold(client, answer.session, content.into());
        }
        self.say(client, request, answer);
    }

    /// A request came in.
    pub fn receive(&mut self, client: Client, request: &Packet, now: SimTime) {
        if self.is_again(client, request, now) {
            return;
        }
        self.sessions.expire(now);
        self.sessions.touch(client, request.session, now);
        match self.act(client, request) {
            Ok(Act::Bytes(bytes)) if request.opcode == Opcode::BurstReadFile as u8 => self.burst(client, request, &bytes),
            Ok(Act::Bytes(bytes)) if bytes.is_empty() => self.say(client, request, request.refuse(Refusal::EndOfFile)),
            Ok(Act::Bytes(bytes)) => self.say(client, request, request.acknowledge(&bytes)),
            Ok(Act::Answer(data)) => self.say(client, request, request.acknowledge(&data)),
            Ok(Act::Job(action, opens)) => self.ask(client, request, action, opens, now),
            Err(why) => self.say(client, request, request.refuse(why)),
        }
    }

    /// A job is done.
    pub fn done(&mut self, ticket: u64, outcome: Result<Done, FileError>, now: SimTime) {
        if self.goes_on(ticket, &outcome) {
            return;
        }
        let Some(Waiting { client, request, opens, .. }) = self.waiting.remove(&ticket) else { return };
        let outcome = if request.opcode == Opcode::ListDirectory as u8 { self.with_made_up(&request, outcome) } else { outcome };
        let answer = match outcome {
            Err(error) => request.refuse(error.refusal()),
            Ok(Done::Entries(entries)) => list(&request, entries),
            Ok(Done::Bytes(bytes)) if request.opcode == Opcode::BurstReadFile as u8 => {
                return self.burst(client, &request, &bytes);
            }
            Ok(Done::Bytes(bytes)) if bytes.is_empty() => request.refuse(Refusal::EndOfFile),
            Ok(Done::Bytes(bytes)) => request.acknowledge(&bytes),
            // The rest of a longer file was left out: a sum over a part would be a wrong one.
            Ok(Done::Checksum { bytes, .. }) if bytes >= CHECKSUM_SLICE => request.refuse(Refusal::Fail),
            Ok(Done::Checksum { sum, .. }) => request.acknowledge(&sum.to_le_bytes()),
            Ok(Done::Size(_) | Done::Nothing) if opens.is_some() => {
                let size = if let Ok(Done::Size(size)) = outcome { size } else { 0 };
                self.opened(client, &request, opens, size, now)
            }
            Ok(Done::Size(size)) => request.acknowledge(&size.to_le_bytes()),
            Ok(Done::Nothing) => request.acknowledge(&[]),
        };
        self.say(client, &request, answer);
    }

    /// A checksum has not come to the end of its file: its next slice waits behind the jobs of others.
    fn goes_on(&mut self, ticket: u64, outcome: &Result<Done, FileError>) -> bool {
        let Some(waiting) = self.waiting.get_mut(&ticket) else { return false };
        let Ok(Done::Checksum { sum, bytes }) = outcome else { return false };
        waiting.summed = waiting.summed.saturating_add(*bytes);
        if *bytes < CHECKSUM_SLICE || waiting.summed > CHECKSUM_MAX {
            return false;
        }
        let Some(path) = waiting.request.sized().and_then(FilePath::of) else { return false };
        let action = Action::Checksum { path, from: waiting.summed, sum: *sum };
        self.jobs.push_back(Job { ticket, action });
        true
    }

    fn act(&mut self, client: Client, request: &Packet) -> Result<Act, Refusal> {
        let data = request.sized().ok_or(Refusal::InvalidDataSize)?;
        let opcode = Opcode::of(request.opcode).ok_or(Refusal::UnknownCommand)?;
        let path = || FilePath::of(data).ok_or(Refusal::FileNotFound);
        let act = match opcode {
            Opcode::None => Act::Answer(Vec::new()),
            Opcode::TerminateSession => {
                self.sessions.end(client, request.session).ok_or(Refusal::InvalidSession)?;
                self.bursts.end(client, request.session);
                Act::Answer(Vec::new())
            }
            Opcode::ResetSessions => {
                self.sessions.end_where(|owner| owner == client);
                self.bursts.end_where(|owner| owner == client);
                Act::Answer(Vec::new())
            }
            Opcode::ListDirectory => Act::Job(Action::List(path()?), None),
            Opcode::OpenFileRo => self.open(client, request.session, path()?)?,
            Opcode::CreateFile | Opcode::OpenFileWo => {
                let path = self.writable(path()?)?;
                self.sessions.room(client, request.session)?;
                let action = if opcode == Opcode::CreateFile { Action::Create } else { Action::Size };
                Act::Job(action(path.clone()), Some((path, true)))
            }
            Opcode::ReadFile | Opcode::BurstReadFile => return self.read(client, request, opcode),
            Opcode::WriteFile => {
                let path = self.sessions.path(client, request.session, true)?;
                Act::Job(Action::Write(path, request.offset, data.to_vec()), None)
            }
            Opcode::RemoveFile => Act::Job(Action::Remove(self.writable(path()?)?), None),
            Opcode::CreateDirectory => Act::Job(Action::MakeDirectory(self.writable(path()?)?), None),
            Opcode::RemoveDirectory => Act::Job(Action::RemoveDirectory(self.writable(path()?)?), None),
            Opcode::TruncateFile => Act::Job(Action::Truncate(self.writable(path()?)?, request.offset), None),
            Opcode::Rename => {
                let middle = data.iter().position(|byte| *byte == 0).ok_or(Refusal::InvalidDataSize)?;
                let part = |bytes| FilePath::of(bytes).ok_or(Refusal::FileNotFound);
                let (from, to) = (part(&data[..middle])?, part(&data[middle + 1..])?);
                Act::Job(Action::Rename(self.writable(from)?, self.writable(to)?), None)
            }
            Opcode::CalcFileCrc32 => {
                let path = path()?;
                match self.made_up.get(&path) {
                    Some(content) => Act::Answer(checksum(0, content).to_le_bytes().to_vec()),
                    None => Act::Job(Action::Checksum { path, from: 0, sum: 0 }, None),
                }
            }
        };
        Ok(act)
    }

    /// What is made up cannot be written, and nothing can take the root's place.
    fn writable(&self, path: FilePath) -> Result<FilePath, Refusal> {
        if path.is_root() || self.made_up.contains_key(&path) { Err(Refusal::FileProtected) } else { Ok(path) }
    }

    fn open(&mut self, client: Client, number: u8, path: FilePath) -> Result<Act, Refusal> {
        self.sessions.room(client, number)?;
        Ok(Act::Job(Action::Size(path.clone()), Some((path, false))))
    }

    fn opened(&mut self, client: Client, request: &Packet, opens: Option<(FilePath, bool)>, size: u32, now: SimTime) -> Packet {
        let Some((path, writes)) = opens else { return request.refuse(Refusal::Fail) };
        self.bursts.end(client, request.session);
        match self.sessions.begin(client, request, path, writes, now) {
            Ok(()) => request.acknowledge(&size.to_le_bytes()),
            Err(why) => request.refuse(why),
        }
    }

    fn read(&mut self, client: Client, request: &Packet, opcode: Opcode) -> Result<Act, Refusal> {
        let path = self.sessions.path(client, request.session, false)?;
        let packets = if opcode == Opcode::BurstReadFile { BURST_PACKETS } else { 1 };
        let most = packets * chunk(request);
        Ok(match self.sessions.content(client, request.session) {
            Some(content) => Act::Bytes(cut(&content, request.offset, most)),
            None => Act::Job(Action::Read(path, request.offset, most), None),
        })
    }

    /// One stream of packets. The last one ends it, also at the end of the file: a refusal behind it would make a client that has lost the
    /// last packet give up (MAVSDK 4). Only a request at the end of the file is refused.
    fn burst(&mut self, client: Client, request: &Packet, bytes: &[u8]) {
        if bytes.is_empty() {
            return self.say(client, request, request.refuse(Refusal::EndOfFile));
        }
        let (mut offset, mut asked, mut packets) = (request.offset, request.clone(), VecDeque::new());
        for piece in bytes.chunks(chunk(request) as usize) {
            packets.push_back(Packet { offset, ..asked.acknowledge(piece) });
            offset = offset.saturating_add(piece.len() as u32);
            asked.sequence = asked.sequence.wrapping_add(1);
        }
        if let Some(last) = packets.back_mut() {
            last.burst_complete = true;
        }
        self.bursts.begin(client, request, packets);
    }

    fn ask(&mut self, client: Client, request: &Packet, action: Action, opens: Option<(FilePath, bool)>, now: SimTime) {
        let own = self.waiting.values().filter(|waiting| waiting.client == client).count();
        if self.waiting.len() >= JOBS_MAX || own >= JOBS_EACH {
            return;
        }
        self.tickets += 1;
        let ticket = self.tickets;
        self.waiting.insert(ticket, Waiting { client, request: request.clone(), opens, summed: 0 });
        if let Some(outcome) = self.by_itself(&action) {
            self.done(ticket, outcome, now);
            return;
        }
        self.jobs.push_back(Job { ticket, action });
    }

    /// What is made up needs nobody's help; a listing is completed when it comes back.
    fn by_itself(&self, action: &Action) -> Option<Result<Done, FileError>> {
        match action {
            Action::Size(path) => self.made_up.get(path).map(|content| Ok(Done::Size(content.len() as u32))),
            Action::Read(path, offset, most) => {
                self.made_up.get(path).map(|content| Ok(Done::Bytes(cut(content, *offset, *most))))
            }
            _ => None,
        }
        .or_else(|| (!self.stored).then(|| Self::nothing_stored(action)))
    }

    fn nothing_stored(action: &Action) -> Result<Done, FileError> {
        match action {
            Action::List(path) if path.is_root() => Ok(Done::Entries(Vec::new())),
            Action::Create(_) | Action::MakeDirectory(_) => Err(FileError::Protected),
            _ => Err(FileError::NotFound),
        }
    }

    /// A listing with what is made up in that directory; a directory that holds nothing else is there all the same.
    fn with_made_up(&self, request: &Packet, outcome: Result<Done, FileError>) -> Result<Done, FileError> {
        let Some(path) = request.sized().and_then(FilePath::of) else { return outcome };
        let mut made_up: Vec<Entry> = Vec::new();
        for (name, content) in &self.made_up {
            let entry = name.below(&path).map(|rest| match rest.split_once('/') {
                Some((directory, _)) => Entry::Directory(directory.to_owned()),
                None => Entry::File(rest.to_owned(), content.len() as u64),
            });
            made_up.extend(entry.filter(|entry| !made_up.contains(entry)));
        }
        match outcome {
            Ok(Done::Entries(stored)) => {
                made_up.extend(stored.into_iter().filter(|entry| !made_up.contains(entry)).collect::<Vec<_>>());
                Ok(Done::Entries(made_up))
            }
            Err(FileError::NotFound) if !made_up.is_empty() => Ok(Done::Entries(made_up)),
            other => other,
        }
    }

    fn say(&mut self, client: Client, request: &Packet, answer: Packet) {
        self.answered.keep(client, request, &answer);
        self.answers.push_back((client, answer));
    }
}

/// What follows from a request.
enum Act {
    /// An acknowledgement at once.
    Answer(Vec<u8>),
    /// What was read.
    Bytes(Vec<u8>),
    /// Work, and the file that it opens (writable?).
    Job(Action, Option<(FilePath, bool)>),
}

/// At most so many bytes from an offset.
fn cut(content: &[u8], offset: u32, most: u32) -> Vec<u8> {
    let from = (offset as usize).min(content.len());
    let to = from.saturating_add(most as usize).min(content.len());
    content[from..to].to_vec()
}

/// Bytes a packet that a read asks for; 0 means a whole packet.
fn chunk(request: &Packet) -> u32 {
    match usize::from(request.size) {
        0 => DATA_MAX as u32,
        size => size.min(DATA_MAX) as u32,
    }
}

/// As many entries as a packet holds, from the one that the offset numbers.
fn list(request: &Packet, entries: Vec<Entry>) -> Packet {
    let mut data = Vec::new();
    for entry in entries.iter().skip(request.offset as usize) {
        let text = match entry {
            Entry::Directory(name) => format!("D{name}\0"),
            Entry::File(name, size) => format!("F{name}\t{size}\0"),
        };
        // A name that no packet holds is skipped, so that the entries behind it can be reached.
        let text = if text.len() > DATA_MAX { "S\0".to_owned() } else { text };
        if data.len() + text.len() > DATA_MAX {
            break;
        }
        data.extend_from_slice(text.as_bytes());
    }
    if data.is_empty() { request.refuse(Refusal::EndOfFile) } else { request.acknowledge(&data) }
}

#[cfg(test)]
mod tests;
