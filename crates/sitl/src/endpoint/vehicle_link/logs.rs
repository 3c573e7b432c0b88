//! Flight logs over MAVLink's log protocol: list, download and erase. Like the file server, it never accesses files
//! itself; the same host runs its jobs.

use crate::endpoint::files::job::{DirectoryEntry, FileAction, FileError, FileJob, FileJobResult};
use crate::endpoint::files::path::FilePath;
use crate::endpoint::link::LinkId;
use spandrel_mavlink::dialect::{LOG_DATA_DATA, LOG_ENTRY_DATA, MavMessage};
use std::collections::{BTreeMap, VecDeque};

/// First ticket number of log jobs, chosen to avoid collisions with the file server's.
const FIRST_TICKET: u64 = 1 << 63;
/// Log folder, with a subfolder for each day.
const LOG_FOLDER: &str = "log";
const LOG_SUFFIX: &str = ".ulg";
/// File extension of the recordings that are stored with the logs and erased along with them.
const RECORDING_SUFFIX: &str = ".mcap";
/// Data bytes in one LOG_DATA message.
const DATA_BYTES: usize = 90;
/// Bytes per file read.
const READ_CHUNK_BYTES: u32 = 64 * DATA_BYTES as u32;
/// Messages per tick for each download: about 180 kB/s at 1000 ticks/s.
const MESSAGES_PER_TICK: usize = 2;
/// Entries per tick for each listing.
const ENTRIES_PER_TICK: usize = 4;
/// Maximum number of queued listings.
const MAX_LISTINGS: usize = 64;

/// A log file.
#[derive(Debug, Clone, PartialEq)]
struct LogEntry {
    path: FilePath,
    size: u64,
}

/// What a listing is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ListingPurpose {
    /// Sends the entries from first to last on a link.
    Send(LinkId, u16, u16),
    /// Removes all logs.
    Erase,
}

#[derive(Debug, Clone, PartialEq)]
struct LogListing {
    purpose: ListingPurpose,
    folders: Vec<FilePath>,
    found: Vec<LogEntry>,
}

#[derive(Debug, Clone, PartialEq)]
struct LogDownload {
    id: u16,
    path: FilePath,
    at: u32,
    end: u32,
    pieces: VecDeque<MavMessage>,
    reading: Option<u64>,
}

/// Listings and downloads in progress.
#[derive(Debug, Clone, Default)]
pub struct LogTransfers {
    /// Whether a host runs file jobs.
    pub stored: bool,
    known: Vec<LogEntry>,
    listings: VecDeque<LogListing>,
    ticket: Option<u64>,
    entries: BTreeMap<LinkId, VecDeque<MavMessage>>,
    downloads: BTreeMap<LinkId, LogDownload>,
    jobs: VecDeque<FileJob>,
    tickets: u64,
}

impl LogTransfers {
    /// Requests entries `first` to `last` for a link.
    pub fn list(&mut self, link: LinkId, first: u16, last: u16) {
        if !self.stored {
            self.entries.insert(link, [MavMessage::LOG_ENTRY(LOG_ENTRY_DATA::default())].into());
            return;
        }
        self.begin(ListingPurpose::Send(link, first, last));
    }

    /// Erases all logs.
    pub fn erase(&mut self) {
        if self.stored {
            self.begin(ListingPurpose::Erase);
        }
    }

    fn begin(&mut self, purpose: ListingPurpose) {
        let again = self.listings.iter().any(|listing| listing.purpose == purpose);
        if !again && self.listings.len() < MAX_LISTINGS {
            let folders = FilePath::of(LOG_FOLDER.as_bytes()).into_iter().collect();
            self.listings.push_back(LogListing { purpose, folders, found: Vec::new() });
            self.continue_listing();
        }
    }

    /// Requests `count` bytes of a log for a link, starting at offset `at`.
    pub fn read(&mut self, link: LinkId, id: u16, at: u32, count: u32) {
        let Some(log) = self.known.get(usize::from(id)) else {
            // An empty message for an unknown log makes the client stop waiting.
            let end = LOG_DATA_DATA { id, ofs: at, ..LOG_DATA_DATA::default() };
            self.entries.entry(link).or_default().push_back(MavMessage::LOG_DATA(end));
            return;
        };
        let end = at.saturating_add(count);
        let download = LogDownload { id, path: log.path.clone(), at, end, pieces: VecDeque::new(), reading: None };
        self.downloads.insert(link, download);
    }

    /// Stops a link's download.
    pub fn stop(&mut self, link: LinkId) {
        self.downloads.remove(&link);
    }

    /// Releases all state for a closed link.
    pub fn forget(&mut self, link: LinkId) {
        self.stop(link);
        self.entries.remove(&link);
        self.listings.retain(|listing| !matches!(listing.purpose, ListingPurpose::Send(to, ..) if to == link));
        self.continue_listing();
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

    /// Checks whether a ticket belongs to a log job.
    #[must_use]
    pub fn owns(ticket: u64) -> bool {
        ticket >= FIRST_TICKET
    }

    fn submit_job(&mut self, action: FileAction) -> u64 {
        let ticket = FIRST_TICKET + self.tickets;
        self.tickets += 1;
        self.jobs.push_back(FileJob { ticket, action });
        ticket
    }

    /// Continues the current listing with the next folder, or finishes the listing.
    fn continue_listing(&mut self) {
        while self.ticket.is_none() {
            let Some(listing) = self.listings.front_mut() else { return };
            match listing.folders.last().cloned() {
                Some(folder) => self.ticket = Some(self.submit_job(FileAction::List(folder))),
                None => self.finish(),
            }
        }
    }

    fn finish(&mut self) {
        let Some(mut listing) = self.listings.pop_front() else { return };
        listing.found.sort_by(|a, b| a.path.cmp(&b.path));
        listing.found.truncate(usize::from(u16::MAX));
        match listing.purpose {
            ListingPurpose::Send(link, first, last) => {
                self.entries.insert(link, entries(&listing.found, first, last));
                self.known = listing.found;
            }
            ListingPurpose::Erase => {
                for log in listing.found {
                    self.submit_job(FileAction::Remove(log.path));
                }
                self.known.clear();
            }
        }
    }

    /// Handles a job's result.
    pub fn done(&mut self, ticket: u64, outcome: Result<FileJobResult, FileError>) {
        if self.ticket == Some(ticket) {
            self.ticket = None;
            self.listing_done(outcome);
            self.continue_listing();
            return;
        }
        let download = self.downloads.iter_mut().find(|(_, download)| download.reading == Some(ticket));
        let Some((link, download)) = download else { return };
        download.reading = None;
        let bytes = if let Ok(FileJobResult::Bytes(bytes)) = outcome { bytes } else { Vec::new() };
        if bytes.is_empty() {
            let end = LOG_DATA_DATA { id: download.id, ofs: download.at, ..LOG_DATA_DATA::default() };
            let link = *link;
            self.downloads.remove(&link);
            self.entries.entry(link).or_default().push_back(MavMessage::LOG_DATA(end));
            return;
        }
        for piece in bytes.chunks(DATA_BYTES) {
            let mut data =
                LOG_DATA_DATA { id: download.id, ofs: download.at, count: piece.len() as u8, ..LOG_DATA_DATA::default() };
            data.data[..piece.len()].copy_from_slice(piece);
            download.at += piece.len() as u32;
            download.pieces.push_back(MavMessage::LOG_DATA(data));
        }
        // A short read marks the end of the log.
        if bytes.len() < READ_CHUNK_BYTES as usize {
            download.end = download.at;
        }
    }

    fn listing_done(&mut self, outcome: Result<FileJobResult, FileError>) {
        let Some(listing) = self.listings.front_mut() else { return };
        let Some(folder) = listing.folders.pop() else { return };
        let Ok(FileJobResult::Entries(entries)) = outcome else { return };
        let inside = |name: &str| FilePath::of(format!("{}/{name}", folder.as_str()).as_bytes());
        for entry in entries {
            match entry {
                DirectoryEntry::Directory(name) => listing.folders.extend(inside(&name)),
                DirectoryEntry::File(name, size)
                    if name.ends_with(LOG_SUFFIX)
                        || (listing.purpose == ListingPurpose::Erase && name.ends_with(RECORDING_SUFFIX)) =>
                {
                    listing.found.extend(inside(&name).map(|path| LogEntry { path, size }));
                }
                DirectoryEntry::File(..) => {}
            }
        }
    }

    /// Returns whether there is nothing to send.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.entries.is_empty() && self.downloads.is_empty()
    }

    /// Returns the messages to send in this tick on links that are ready.
    pub fn poll(&mut self, ready: impl Fn(&LinkId) -> bool) -> Vec<(LinkId, MavMessage)> {
        let mut out = Vec::new();
        for (link, entries) in self.entries.iter_mut().filter(|(link, _)| ready(link)) {
            let few = entries.len().min(ENTRIES_PER_TICK);
            out.extend(entries.drain(..few).map(|entry| (*link, entry)));
        }
        self.entries.retain(|_, entries| !entries.is_empty());
        let mut reads = Vec::new();
        for (link, download) in self.downloads.iter_mut().filter(|(link, _)| ready(link)) {
            let few = download.pieces.len().min(MESSAGES_PER_TICK);
            out.extend(download.pieces.drain(..few).map(|piece| (*link, piece)));
            if download.pieces.is_empty() && download.reading.is_none() && download.at < download.end {
                reads.push((
                    *link,
                    FileAction::Read(download.path.clone(), download.at, READ_CHUNK_BYTES.min(download.end - download.at)),
                ));
            }
        }
        for (link, action) in reads {
            let ticket = self.submit_job(action);
            if let Some(download) = self.downloads.get_mut(&link) {
                download.reading = Some(ticket);
            }
        }
        self.downloads.retain(|_, d| d.reading.is_some() || !d.pieces.is_empty() || d.at < d.end);
        out
    }
}

fn entries(logs: &[LogEntry], first: u16, last: u16) -> VecDeque<MavMessage> {
    let count = logs.len() as u16;
    if count == 0 {
        return [MavMessage::LOG_ENTRY(LOG_ENTRY_DATA::default())].into();
    }
    let requested = logs.iter().enumerate().filter(|(id, _)| (first..=last).contains(&(*id as u16)));
    requested
        .map(|(id, log)| {
            MavMessage::LOG_ENTRY(LOG_ENTRY_DATA {
                time_utc: utc_s(log.path.as_str()).unwrap_or(0),
                size: u32::try_from(log.size).unwrap_or(u32::MAX),
                id: id as u16,
                num_logs: count,
                last_log_num: count - 1,
            })
        })
        .collect()
}

/// Parses a log's start time, in seconds since the Unix epoch, from its path
/// `log/<date>/<hours>_<minutes>_<seconds>...`.
fn utc_s(path: &str) -> Option<u32> {
    let mut parts = path.rsplit('/');
    let (time, date) = (parts.next()?, parts.next()?);
    let date: jiff::civil::Date = date.parse().ok()?;
    let field = |at: usize| time.get(at..at + 2)?.parse::<i8>().ok();
    let time = jiff::civil::Time::new(field(0)?, field(3)?, field(6)?, 0).ok()?;
    let start = date.to_datetime(time).to_zoned_datetime(jiff::tz::TimeZone::UTC).ok()?;
    u32::try_from(start.timestamp().as_second()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINK: LinkId = LinkId(4);

    fn logs() -> LogTransfers {
        LogTransfers { stored: true, ..LogTransfers::default() }
    }

    /// Runs jobs on a simulated folder with two days and three logs.
    fn execute_jobs(logs: &mut LogTransfers, removed: &mut Vec<String>) {
        while let Some(job) = logs.poll_job() {
            let outcome = match &job.action {
                FileAction::List(path) => Ok(FileJobResult::Entries(match path.as_str() {
                    "log" => vec![DirectoryEntry::Directory("2026-11-21".into()), DirectoryEntry::Directory("2026-11-20".into())],
                    "log/2026-11-20" => {
                        vec![DirectoryEntry::File("15_08_00.ulg".into(), 200), DirectoryEntry::File("notes.txt".into(), 5)]
                    }
                    _ => vec![DirectoryEntry::File("09_00_00.ulg".into(), 7_000), DirectoryEntry::File("10_00_00.ulg".into(), 0)],
                })),
                FileAction::Read(_, at, most) => Ok(FileJobResult::Bytes((*at..7_000.min(at + most)).map(|k| k as u8).collect())),
                FileAction::Remove(path) => {
                    removed.push(path.as_str().to_owned());
                    Ok(FileJobResult::Nothing)
                }
                other => panic!("{other:?}"),
            };
            logs.done(job.ticket, outcome);
        }
    }

    fn run(logs: &mut LogTransfers) -> Vec<MavMessage> {
        let mut out = Vec::new();
        for _ in 0..200 {
            execute_jobs(logs, &mut Vec::new());
            out.extend(logs.poll(|_| true).into_iter().map(|(_, message)| message));
        }
        out
    }

    #[test]
    fn exact_logs_of_all_days_are_listed_chronologically() {
        let mut logs = logs();
        logs.list(LINK, 0, u16::MAX);
        let entries: Vec<(u16, u16, u32, u32)> = run(&mut logs)
            .iter()
            .filter_map(|m| if let MavMessage::LOG_ENTRY(e) = m { Some((e.id, e.num_logs, e.size, e.time_utc)) } else { None })
            .collect();
        // 2026-11-20T15:08:00Z, and 09:00 and 10:00 on the next day.
        let at = 1_795_187_280;
        assert_eq!(entries, [(0, 3, 200, at), (1, 3, 7_000, at + 64_320), (2, 3, 0, at + 67_920)]);
        logs.list(LINK, 1, 1);
        assert_eq!(run(&mut logs).len(), 1, "only the requested messages must be sent");
    }

    #[test]
    fn exact_logs_can_be_downloaded_completely_or_in_part() {
        let mut logs = logs();
        logs.list(LINK, 0, u16::MAX);
        run(&mut logs);
        for (at, count, expected) in [(0, u32::MAX, 7_000), (90, 180, 180), (6_990, 90, 10), (7_000, 90, 0)] {
            logs.read(LINK, 1, at, count);
            let mut next = at;
            for message in run(&mut logs) {
                let MavMessage::LOG_DATA(data) = message else { continue };
                assert_eq!((data.id, data.ofs), (1, next));
                assert!(
                    data.data[..usize::from(data.count)].iter().enumerate().all(|(k, byte)| *byte == (next as usize + k) as u8)
                );
                next += u32::from(data.count);
            }
            assert_eq!(next - at, expected, "from {at}");
        }
        assert!(logs.downloads.is_empty());
    }

    #[test]
    fn exact_erase_removes_only_logs() {
        let (mut logs, mut removed) = (logs(), Vec::new());
        logs.erase();
        execute_jobs(&mut logs, &mut removed);
        assert_eq!(removed, ["log/2026-11-20/15_08_00.ulg", "log/2026-11-21/09_00_00.ulg", "log/2026-11-21/10_00_00.ulg"]);
    }

    #[test]
    fn exact_log_list_is_empty_without_a_log_folder() {
        let mut logs = LogTransfers::default();
        logs.list(LINK, 0, u16::MAX);
        logs.read(LINK, 3, 0, 90);
        let out = run(&mut logs);
        assert!(matches!(&out[0], MavMessage::LOG_ENTRY(e) if e.num_logs == 0));
        assert!(matches!(&out[1], MavMessage::LOG_DATA(d) if d.count == 0));
    }
}
