//! Files over a link that loses 30% of the datagrams, delays them by 200 ms, and reorders and duplicates them, in both
//! directions: reading, reading in bursts, and writing.

use super::impaired::{Client, LIMIT_S, TIMEOUT_MS};
use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::*;
use spandrel_mavlink::ftp::{ACK, DATA_MAX, FtpError, FtpPacket, NAK, Opcode, checksum};
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::files::job::{CHECKSUM_SLICE, FileAction, FileError, FileJobResult};
use spandrel_sitl::endpoint::params::{metadata, param_view};
use spandrel_testkit::station::{GCS, Station};
use std::collections::BTreeMap;

/// Retry interval of a client that repeats requests before a response can arrive, ms. Its repeats therefore arrive
/// after its next requests.
const SHORT_TIMEOUT_MS: i64 = 350;
/// Time without data after which a burst counts as complete, ms.
const SILENCE_MS: i64 = 700;
const PARAMETER_FILE: &str = "/etc/extras/parameter.json.xz";

/// In-memory files by path.
#[derive(Default)]
pub(super) struct Disk(BTreeMap<String, Vec<u8>>);

impl Disk {
    pub(super) fn work(&mut self, action: &FileAction) -> Result<FileJobResult, FileError> {
        match action {
            FileAction::Create(path) => {
                self.0.insert(path.as_str().to_owned(), Vec::new());
                Ok(FileJobResult::Nothing)
            }
            FileAction::Size(path) => self.file(path.as_str()).map(|file| FileJobResult::Size(file.len() as u32)),
            FileAction::Read(path, offset, most) => {
                let file = self.file(path.as_str())?;
                Ok(FileJobResult::Bytes(file.iter().skip(*offset as usize).take(*most as usize).copied().collect()))
            }
            FileAction::Write(path, offset, bytes) => {
                let file = self.0.get_mut(path.as_str()).ok_or(FileError::NotFound)?;
                let (from, to) = (*offset as usize, *offset as usize + bytes.len());
                file.resize(file.len().max(to), 0);
                file[from..to].copy_from_slice(bytes);
                Ok(FileJobResult::Nothing)
            }
            FileAction::Checksum { path, from, sum } => {
                let file = self.file(path.as_str())?;
                let slice: Vec<u8> = file.iter().skip(*from as usize).take(CHECKSUM_SLICE as usize).copied().collect();
                Ok(FileJobResult::Checksum { sum: checksum(*sum, &slice), bytes: slice.len() as u32 })
            }
            _ => Err(FileError::Other),
        }
    }

    fn file(&self, path: &str) -> Result<&Vec<u8>, FileError> {
        self.0.get(path).ok_or(FileError::NotFound)
    }
}

/// An FTP client that retries indefinitely.
struct Ftp {
    client: Client,
    sequence: u16,
    timeout_ms: i64,
}

fn of(message: &MavMessage) -> Option<FtpPacket> {
    if let MavMessage::FILE_TRANSFER_PROTOCOL(f) = message { Some(FtpPacket::read(&f.payload)) } else { None }
}

impl Ftp {
    fn new(seed: u64, timeout_ms: i64) -> Self {
        let mut client = Client::new(seed);
        client.station.sim.enable_file_jobs();
        Self { client, sequence: 0, timeout_ms }
    }

    fn request(&mut self, opcode: Opcode, session: u8, offset: u32, data: &[u8]) -> (u16, MavMessage) {
        let mut field = [0; DATA_MAX];
        field[..data.len()].copy_from_slice(data);
        let reads = matches!(opcode, Opcode::ReadFile | Opcode::BurstReadFile);
        let size = if reads { DATA_MAX as u8 } else { data.len() as u8 };
        let blank = FtpPacket::read(&[0; 251]);
        let packet = FtpPacket { sequence: self.sequence, session, opcode: opcode as u8, size, offset, data: field, ..blank };
        let expected = self.sequence.wrapping_add(1);
        self.sequence = self.sequence.wrapping_add(2);
        let payload = packet.write();
        let message = FILE_TRANSFER_PROTOCOL_DATA { target_network: 0, target_system: 1, target_component: 1, payload };
        (expected, MavMessage::FILE_TRANSFER_PROTOCOL(message))
    }

    fn ask(&mut self, opcode: Opcode, session: u8, offset: u32, data: &[u8]) -> FtpPacket {
        let (expected, message) = self.request(opcode, session, offset, data);
        let answer = self.client.ask_every(self.timeout_ms, &message, |m| of(m).filter(|p| p.sequence == expected));
        assert_eq!(answer.request, opcode as u8);
        answer
    }

    fn open(&mut self, path: &str) -> (u8, usize) {
        let open = self.ask(Opcode::OpenFileRo, 0, 0, path.as_bytes());
        assert_eq!(open.opcode, ACK);
        (open.session, u32::from_le_bytes(open.data[..4].try_into().unwrap()) as usize)
    }

    /// Reads a file in bursts, each starting at the first missing byte.
    fn read_in_bursts(&mut self, path: &str) -> (Vec<u8>, usize) {
        let (session, size) = self.open(path);
        let mut parts: BTreeMap<usize, Vec<u8>> = BTreeMap::new();
        let mut bursts = 0;
        let begin = self.client.station.sim.now();
        loop {
            let whole = parts.iter().fold(0, |end, (at, part)| if *at == end { end + part.len() } else { end });
            if whole == size {
                break;
            }
            assert!((self.client.station.sim.now() - begin).s() < LIMIT_S, "{whole} of {size} bytes");
            self.burst(session, whole, &mut parts);
            bursts += 1;
        }
        assert_eq!(self.ask(Opcode::TerminateSession, session, 0, &[]).opcode, ACK);
        (parts.into_values().flatten().collect(), bursts)
    }

    /// Requests one burst and stores the parts received.
    fn burst(&mut self, session: u8, from: usize, parts: &mut BTreeMap<usize, Vec<u8>>) {
        let (_, message) = self.request(Opcode::BurstReadFile, session, from as u32, &[]);
        self.client.send(&message);
        let mut silent_since = self.client.station.sim.now();
        while self.client.station.sim.now() - silent_since < SimTime::from_ms(SILENCE_MS) {
            let heard: Vec<FtpPacket> = self.client.tick().iter().filter_map(of).collect();
            for packet in heard.iter().filter(|p| p.request == Opcode::BurstReadFile as u8 && p.session == session) {
                silent_since = self.client.station.sim.now();
                match packet.opcode {
                    ACK => drop(parts.insert(packet.offset as usize, packet.data_in_use().unwrap().to_vec())),
                    NAK => assert_eq!(packet.data[0], FtpError::EndOfFile as u8),
                    other => panic!("opcode {other}"),
                }
            }
        }
    }

    fn write(&mut self, path: &str, content: &[u8]) {
        let created = self.ask(Opcode::CreateFile, 0, 0, path.as_bytes());
        assert_eq!(created.opcode, ACK);
        for (k, piece) in content.chunks(DATA_MAX).enumerate() {
            let written = self.ask(Opcode::WriteFile, created.session, (k * DATA_MAX) as u32, piece);
            assert_eq!(written.opcode, ACK, "piece {k}: {:?}", written.data_in_use());
        }
        let ended = self.ask(Opcode::TerminateSession, created.session, 0, &[]);
        assert_eq!(ended.opcode, ACK, "{:?}", ended.data_in_use());
        let sum = self.ask(Opcode::CalcFileCrc32, 0, 0, path.as_bytes());
        assert_eq!(sum.data_in_use(), Some(checksum(0, content).to_le_bytes().as_slice()));
    }
}

fn content(length: usize) -> Vec<u8> {
    (0..length).map(|k| (k * k % 251) as u8).collect()
}

#[test]
fn wire_file_download_survives_a_bad_link() {
    let mut ftp = Ftp::new(3, TIMEOUT_MS);
    let (session, size) = ftp.open(PARAMETER_FILE);
    let mut file: Vec<u8> = Vec::new();
    while file.len() < size {
        let part = ftp.ask(Opcode::ReadFile, session, file.len() as u32, &[]);
        let piece = part.data_in_use().unwrap();
        assert!(!piece.is_empty() && part.offset == file.len() as u32);
        file.extend(piece);
    }
    assert_eq!(file, metadata::files(&param_view::PX4).parameter.bytes.to_vec());
    assert_eq!(ftp.ask(Opcode::TerminateSession, session, 0, &[]).opcode, ACK);
}

#[test]
fn wire_burst_download_survives_a_bad_link() {
    let mut ftp = Ftp::new(4, TIMEOUT_MS);
    let long = content(100_000);
    ftp.client.disk.0.insert("survey.bin".into(), long.clone());
    let (file, bursts) = ftp.read_in_bursts("/survey.bin");
    assert!(file == long, "{} of {} bytes", file.len(), long.len());
    // Without losses, 100 kB take four bursts.
    assert!(bursts > 4, "{bursts} bursts: the link must lose some packets");
    let (shipped, _) = ftp.read_in_bursts(PARAMETER_FILE);
    assert!(shipped == metadata::files(&param_view::PX4).parameter.bytes.to_vec());
}

/// Includes a client that repeats its requests before responses can arrive.
#[test]
fn wire_file_upload_survives_a_bad_link() {
    for (seed, timeout_ms) in [(6, TIMEOUT_MS), (7, SHORT_TIMEOUT_MS), (8, SHORT_TIMEOUT_MS), (9, SHORT_TIMEOUT_MS)] {
        let mut ftp = Ftp::new(seed, timeout_ms);
        for (path, length) in [("/first.bin", 9_000), ("/second.bin", 1_000), ("/first.bin", 3_000)] {
            let content = content(length);
            ftp.write(path, &content);
            assert!(ftp.client.disk.0[&path[1..]] == content, "{path} from seed {seed}");
        }
    }
}

/// Returns a file whose checksum takes more jobs than the accumulated allowance.
fn long_file() -> Vec<u8> {
    content(200 * CHECKSUM_SLICE as usize + 5)
}

/// Returns the FTP responses sent within one second if the host advances time in steps of this size, and the maximum
/// number of jobs between two ticks.
fn responses_in_one_second(at_once_ms: i64) -> (Vec<FtpPacket>, usize) {
    let mut station = Station::new("drill-hover", 7);
    station.run_ms(100);
    let sim = &mut station.sim;
    sim.enable_file_jobs();
    let mut disk = Disk::default();
    disk.0.insert("long".into(), long_file());
    let mut encoder = Encoder::new(255, 190);
    let mut request = |opcode: Opcode, sequence: u16, path: &[u8]| {
        let mut data = [0; DATA_MAX];
        data[..path.len()].copy_from_slice(path);
        let packet = FtpPacket { sequence, opcode: opcode as u8, size: path.len() as u8, data, ..FtpPacket::read(&[0; 251]) };
        let payload = packet.write();
        encoder.encode(&MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
            target_network: 0,
            target_system: 1,
            target_component: 1,
            payload,
        }))
    };
    sim.handle_datagram(GCS, &request(Opcode::CalcFileCrc32, 1, b"/long"));
    (2..60).for_each(|k| sim.handle_datagram(GCS, &request(Opcode::OpenFileRo, 7 * k, b"/none")));
    let (begin, mut heard, mut most): (SimTime, Vec<FtpPacket>, usize) = (sim.now(), Vec::new(), 0);
    while sim.now() - begin < SimTime::from_ms(1_000) {
        let until = sim.now() + SimTime::from_ms(at_once_ms);
        let (mut tick, mut jobs) = (sim.now(), 0);
        loop {
            sim.handle_timeout(until);
            if !sim.has_file_job() {
                break;
            }
            jobs = if sim.now() == tick { jobs } else { 0 };
            tick = sim.now();
            while let Some(job) = sim.poll_file_job() {
                let outcome = disk.work(&job.action);
                sim.finish_file_job(job.ticket, outcome);
                jobs += 1;
            }
            most = most.max(jobs);
        }
        while let Some(transmit) = sim.poll_transmit() {
            let frames = Decoder::new().datagram(&transmit.bytes);
            heard.extend(frames.iter().filter_map(|frame| frame.message.as_ref().and_then(of)));
        }
    }
    let checked = heard.iter().any(|packet| packet.request == Opcode::CalcFileCrc32 as u8);
    assert!(checked, "the checksum must arrive within one second");
    (heard, most)
}

/// CreateFile, TruncateFile to 256 MiB and CalcFileCRC32 once blocked the vehicle for 28 s. A tick must wait only for a
/// few small jobs, and the order of the responses must not depend on the host's time steps.
#[test]
fn regress_file_jobs_run_in_slices_between_ticks() {
    let (one, most) = responses_in_one_second(1);
    assert!((1..=40).contains(&most), "{most} jobs between two ticks");
    let last = one.last().map(|packet| packet.request);
    assert_eq!(last, Some(Opcode::CalcFileCrc32 as u8), "the other client's request must be served between the slices");
    let sum = checksum(0, &long_file());
    assert_eq!(one.last().and_then(|packet| packet.data_in_use().map(<[u8]>::to_vec)), Some(sum.to_le_bytes().to_vec()));
    for at_once_ms in [7, 50] {
        assert!(responses_in_one_second(at_once_ms).0 == one, "time steps of {at_once_ms} ms");
    }
}
