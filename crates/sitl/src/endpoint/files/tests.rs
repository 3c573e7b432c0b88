//! Tests the server with in-memory files and a retrying client, over a link that loses, duplicates and reorders
//! packets.

use super::*;
use spandrel_mavlink::ftp::{NAK, PAYLOAD};
use spandrel_model::random::RandomStream;

const CLIENT: FileClient = (LinkId(1), (255, 190));
const OTHER: FileClient = (LinkId(2), (254, 190));

/// In-memory files by path.
#[derive(Default)]
struct MemoryFiles(BTreeMap<String, Vec<u8>>);

impl MemoryFiles {
    fn execute(&mut self, action: &FileAction) -> Result<FileJobResult, FileError> {
        let key = |path: &FilePath| path.as_str().to_owned();
        match action {
            FileAction::List(path) if path.is_root() => Ok(FileJobResult::Entries(
                self.0.iter().map(|(name, bytes)| DirectoryEntry::File(name.clone(), bytes.len() as u64)).collect(),
            )),
            FileAction::Size(path) => {
                self.0.get(&key(path)).map(|b| FileJobResult::Size(b.len() as u32)).ok_or(FileError::NotFound)
            }
            FileAction::Create(path) => {
                self.0.insert(key(path), Vec::new());
                Ok(FileJobResult::Nothing)
            }
            FileAction::Read(path, offset, most) => {
                let bytes = self.0.get(&key(path)).ok_or(FileError::NotFound)?;
                Ok(FileJobResult::Bytes(bytes.iter().skip(*offset as usize).take(*most as usize).copied().collect()))
            }
            FileAction::Write(path, offset, new) => {
                let bytes = self.0.get_mut(&key(path)).ok_or(FileError::NotFound)?;
                bytes.resize(bytes.len().max(*offset as usize + new.len()), 0);
                bytes[*offset as usize..][..new.len()].copy_from_slice(new);
                Ok(FileJobResult::Nothing)
            }
            FileAction::Remove(path) => self.0.remove(&key(path)).map(|_| FileJobResult::Nothing).ok_or(FileError::NotFound),
            FileAction::Rename(from, to) if !self.0.contains_key(&key(to)) => {
                let bytes = self.0.remove(&key(from)).ok_or(FileError::NotFound)?;
                self.0.insert(key(to), bytes);
                Ok(FileJobResult::Nothing)
            }
            FileAction::Rename(..) => Err(FileError::Exists),
            FileAction::Truncate(path, length) => {
                self.0.get_mut(&key(path)).ok_or(FileError::NotFound)?.resize(*length as usize, 0);
                Ok(FileJobResult::Nothing)
            }
            FileAction::Checksum { path, from, sum } => {
                let bytes = self.0.get(&key(path)).ok_or(FileError::NotFound)?;
                let slice = slice_at(bytes, *from, CHECKSUM_SLICE);
                Ok(FileJobResult::Checksum { sum: checksum(*sum, &slice), bytes: slice.len() as u32 })
            }
            FileAction::List(_) | FileAction::MakeDirectory(_) | FileAction::RemoveDirectory(_) => Err(FileError::NotFound),
        }
    }
}

struct FtpHarness {
    server: FileServer,
    files: MemoryFiles,
    now: SimTime,
    sequence: u16,
}

impl FtpHarness {
    fn new() -> Self {
        let mut server = FileServer::default();
        server.stored();
        Self { server, files: MemoryFiles::default(), now: SimTime::from_ms(100_000), sequence: 0 }
    }

    fn packet(&mut self, opcode: Opcode, session: u8, offset: u32, data: &[u8]) -> FtpPacket {
        self.sequence = self.sequence.wrapping_add(2);
        let mut packet = FtpPacket::read(&[0; PAYLOAD]);
        packet.data[..data.len()].copy_from_slice(data);
        FtpPacket { sequence: self.sequence, session, opcode: opcode as u8, size: data.len() as u8, offset, ..packet }
    }

    fn put(&mut self, client: FileClient, packet: &FtpPacket) -> Vec<FtpPacket> {
        self.server.receive(client, packet, self.now);
        self.advance(client)
    }

    fn advance(&mut self, client: FileClient) -> Vec<FtpPacket> {
        while let Some(job) = self.server.poll_job() {
            let outcome = self.files.execute(&job.action);
            self.server.done(job.ticket, outcome, self.now);
        }
        self.server.poll(|_| true).into_iter().filter(|(to, _)| *to == client).map(|(_, packet)| packet).collect()
    }

    fn ask(&mut self, opcode: Opcode, session: u8, offset: u32, data: &[u8]) -> FtpPacket {
        let packet = self.packet(opcode, session, offset, data);
        let answers = self.put(CLIENT, &packet);
        assert_eq!(answers.len(), 1, "{opcode:?} must be answered once, immediately");
        assert_eq!((answers[0].sequence, answers[0].request), (packet.sequence.wrapping_add(1), opcode as u8));
        answers.into_iter().next().unwrap()
    }
}

fn result_of(answer: &FtpPacket) -> Result<Vec<u8>, u8> {
    if answer.opcode == ACK { Ok(answer.data_in_use().unwrap().to_vec()) } else { Err(answer.data[0]) }
}

#[test]
fn exact_requests_without_storage_are_rejected_immediately() {
    let mut bench = FtpHarness::new();
    bench.server = FileServer::default();
    assert_eq!(result_of(&bench.ask(Opcode::ListDirectory, 0, 0, b"/")), Err(FtpError::EndOfFile as u8));
    assert_eq!(result_of(&bench.ask(Opcode::OpenFileRo, 0, 0, b"/a")), Err(FtpError::FileNotFound as u8));
    assert_eq!(result_of(&bench.ask(Opcode::CreateFile, 0, 0, b"/a")), Err(FtpError::FileProtected as u8));
}

#[test]
fn exact_every_opcode_number_is_answered() {
    let mut bench = FtpHarness::new();
    for number in 0..=255u8 {
        let mut packet = bench.packet(Opcode::None, 0, 0, b"x");
        packet.opcode = number;
        let answers = bench.put(CLIENT, &packet);
        assert_eq!(answers.len(), 1, "opcode {number}");
        assert!([ACK, NAK].contains(&answers[0].opcode));
        assert!(number < 16 || result_of(&answers[0]) == Err(FtpError::UnknownCommand as u8));
    }
}

#[test]
fn exact_files_can_be_created_written_read_renamed_and_removed() {
    let mut bench = FtpHarness::new();
    let session = bench.ask(Opcode::CreateFile, 0, 0, b"/notes.txt").session;
    assert_eq!(result_of(&bench.ask(Opcode::WriteFile, session, 0, b"hello")), Ok(Vec::new()));
    assert_eq!(result_of(&bench.ask(Opcode::WriteFile, session, 5, b" there")), Ok(Vec::new()));
    assert_eq!(
        result_of(&bench.ask(Opcode::ReadFile, session, 0, b"")),
        Err(FtpError::InvalidSession as u8),
        "the session is open for writing"
    );
    assert_eq!(result_of(&bench.ask(Opcode::TerminateSession, session, 0, b"")), Ok(Vec::new()));
    assert_eq!(result_of(&bench.ask(Opcode::TerminateSession, session, 0, b"")), Err(FtpError::InvalidSession as u8));
    assert_eq!(result_of(&bench.ask(Opcode::Rename, 0, 0, b"notes.txt\0words.txt")), Ok(Vec::new()));
    assert_eq!(result_of(&bench.ask(Opcode::ListDirectory, 0, 0, b"/")), Ok(b"Fwords.txt\t11\0".to_vec()));
    let opened = bench.ask(Opcode::OpenFileRo, 0, 0, b"words.txt");
    assert_eq!(result_of(&opened), Ok(11u32.to_le_bytes().to_vec()));
    assert_eq!(result_of(&bench.ask(Opcode::ReadFile, opened.session, 6, &[0; 20])), Ok(b"there".to_vec()));
    assert_eq!(result_of(&bench.ask(Opcode::ReadFile, opened.session, 11, &[0; 20])), Err(FtpError::EndOfFile as u8));
    assert_eq!(
        result_of(&bench.ask(Opcode::CalcFileCrc32, 0, 0, b"words.txt")),
        Ok(checksum(0, b"hello there").to_le_bytes().to_vec())
    );
    assert_eq!(result_of(&bench.ask(Opcode::RemoveFile, 0, 0, b"words.txt")), Ok(Vec::new()));
    assert_eq!(result_of(&bench.ask(Opcode::OpenFileRo, 0, 0, b"words.txt")), Err(FtpError::FileNotFound as u8));
}

#[test]
fn exact_repeated_requests_are_answered_again_but_executed_once() {
    let mut bench = FtpHarness::new();
    bench.files.0.insert("a".into(), vec![1]);
    let packet = bench.packet(Opcode::RemoveFile, 0, 0, b"a");
    let first = bench.put(CLIENT, &packet);
    assert_eq!(result_of(&first[0]), Ok(Vec::new()));
    assert_eq!(bench.put(CLIENT, &packet), first, "a duplicate must repeat the first answer, although the file is gone");
}

#[test]
fn exact_sessions_are_private_and_limited_per_client() {
    let mut bench = FtpHarness::new();
    bench.files.0.insert("a".into(), vec![1; 10]);
    let own = bench.ask(Opcode::OpenFileRo, 0, 0, b"a").session;
    let theirs = bench.packet(Opcode::ReadFile, own, 0, &[0; 5]);
    let answer = bench.put(OTHER, &theirs);
    assert_eq!(result_of(&answer[0]), Err(FtpError::InvalidSession as u8));
    for number in 1..8 {
        assert!(result_of(&bench.ask(Opcode::OpenFileRo, number, 0, b"a")).is_ok());
    }
    assert_eq!(result_of(&bench.ask(Opcode::OpenFileRo, 8, 0, b"a")), Err(FtpError::NoSessionsAvailable as u8));
    assert!(
        result_of(&bench.ask(Opcode::OpenFileRo, 7, 0, b"a")).is_ok(),
        "a new session must replace the old one with the same number"
    );
    bench.now += SimTime::from_ms(60_001);
    assert!(result_of(&bench.ask(Opcode::OpenFileRo, 0, 0, b"a")).is_ok(), "idle sessions must expire");
    assert!(result_of(&bench.ask(Opcode::ResetSessions, 0, 0, b"")).is_ok());
}

/// MAVProxy matches replies by the session it chose; MAVSDK 4 always sends 0; session numbers are per client.
#[test]
fn regress_replies_contain_the_requests_session_number() {
    let mut bench = FtpHarness::new();
    bench.files.0.insert("a".into(), vec![1; 10]);
    bench.files.0.insert("b".into(), vec![2; 10]);
    for number in [7, 200, 0] {
        let opened = bench.ask(Opcode::OpenFileRo, number, 0, b"a");
        assert_eq!((result_of(&opened).is_ok(), opened.session), (true, number));
        assert_eq!(bench.ask(Opcode::ReadFile, number, 0, &[0; 5]).session, number);
        assert_eq!(bench.ask(Opcode::ListDirectory, number, 0, b"/").session, number);
    }
    let theirs = bench.packet(Opcode::OpenFileRo, 7, 0, b"b");
    assert_eq!(bench.put(OTHER, &theirs)[0].session, 7);
    let read = bench.packet(Opcode::ReadFile, 7, 0, &[0; 3]);
    assert_eq!(result_of(&bench.put(OTHER, &read)[0]), Ok(vec![2; 3]));
    assert_eq!(result_of(&bench.ask(Opcode::ReadFile, 7, 0, &[0; 3])), Ok(vec![1; 3]));
    let left_open = bench.ask(Opcode::OpenFileRo, 7, 0, b"b");
    assert_eq!(
        (left_open.session, result_of(&bench.ask(Opcode::ReadFile, 7, 0, &[0; 3]))),
        (7, Ok(vec![2; 3])),
        "the newest session must be used"
    );
}

/// The last packet of a burst must mark it complete: if that packet is lost, MAVSDK 4 would count an additional NAK as
/// its final failed attempt.
#[test]
fn regress_burst_to_the_end_of_the_file_completes_without_a_nak() {
    let mut bench = FtpHarness::new();
    bench.files.0.insert("a".into(), vec![1; 2 * DATA_MAX + 7]);
    bench.files.0.insert("empty".into(), Vec::new());
    bench.ask(Opcode::OpenFileRo, 0, 0, b"a");
    let request = bench.packet(Opcode::BurstReadFile, 0, 0, &[0; DATA_MAX]);
    let mut heard = bench.put(CLIENT, &request);
    heard.extend((0..10).flat_map(|_| bench.advance(CLIENT)));
    let shape: Vec<(u8, u32, u8, bool)> = heard.iter().map(|p| (p.opcode, p.offset, p.size, p.burst_complete)).collect();
    let full = DATA_MAX as u8;
    assert_eq!(shape, [(ACK, 0, full, false), (ACK, 239, full, false), (ACK, 478, 7, true)]);
    assert_eq!(result_of(&bench.ask(Opcode::BurstReadFile, 0, 485, &[0; DATA_MAX])), Err(FtpError::EndOfFile as u8));
    bench.ask(Opcode::OpenFileRo, 0, 0, b"empty");
    assert_eq!(result_of(&bench.ask(Opcode::BurstReadFile, 0, 0, &[0; DATA_MAX])), Err(FtpError::EndOfFile as u8));
}

/// A duplicated or delayed request must not restart a burst or truncate a file being written.
#[test]
fn regress_late_duplicate_request_has_no_effect() {
    let mut bench = FtpHarness::new();
    bench.files.0.insert("a".into(), vec![1; 1000]);
    bench.ask(Opcode::OpenFileRo, 3, 0, b"a");
    let burst = bench.packet(Opcode::BurstReadFile, 3, 0, &[0; DATA_MAX]);
    let mut offsets: Vec<u32> = bench.put(CLIENT, &burst).iter().map(|p| p.offset).collect();
    for _ in 0..10 {
        offsets.extend(bench.put(CLIENT, &burst).iter().map(|p| p.offset).take(1));
        if offsets.len() == 5 {
            break;
        }
    }
    assert_eq!(offsets, [0, 239, 478, 717, 956]);
    let create = bench.packet(Opcode::CreateFile, 4, 0, b"new");
    bench.put(CLIENT, &create);
    bench.ask(Opcode::WriteFile, 4, 0, b"hello");
    assert!(bench.put(CLIENT, &create).is_empty(), "a late duplicate must not be answered");
    assert_eq!(bench.files.0["new"], b"hello");
    bench.now += SimTime::from_ms(2_001);
    assert_eq!(bench.put(CLIENT, &create).len(), 1);
    assert!(bench.files.0["new"].is_empty(), "a restarted client may reuse a sequence number");
}

/// A long file must be checksummed slice by slice, with other clients' jobs in between.
#[test]
fn regress_checksum_is_computed_in_slices() {
    let mut bench = FtpHarness::new();
    let slice = CHECKSUM_SLICE as usize;
    for length in [0, 5, slice, 3 * slice, 3 * slice + 1] {
        let file: Vec<u8> = (0..length).map(|k| (k % 251) as u8).collect();
        bench.files.0.insert("a".into(), file.clone());
        let request = bench.packet(Opcode::CalcFileCrc32, 0, 0, b"a");
        bench.server.receive(CLIENT, &request, bench.now);
        let mut jobs = 0;
        while let Some(job) = bench.server.poll_job() {
            let outcome = bench.files.execute(&job.action);
            bench.server.done(job.ticket, outcome, bench.now);
            jobs += 1;
        }
        assert_eq!(jobs, length / slice + 1);
        assert_eq!(result_of(&bench.advance(CLIENT)[0]), Ok(checksum(0, &file).to_le_bytes().to_vec()), "{length} bytes");
    }
}

#[test]
fn exact_generated_files_are_listed_and_read_only() {
    let mut bench = FtpHarness::new();
    bench.files.0.insert("b.ulg".into(), vec![0; 3]);
    bench.server.generate("/general.json", b"{}".to_vec());
    bench.server.generate("/extras/deep.json", b"[1]".to_vec());
    let listed = result_of(&bench.ask(Opcode::ListDirectory, 0, 0, b"/")).unwrap();
    assert_eq!(String::from_utf8(listed).unwrap(), "Dextras\0Fgeneral.json\t2\0Fb.ulg\t3\0");
    assert_eq!(result_of(&bench.ask(Opcode::ListDirectory, 0, 0, b"/extras")), Ok(b"Fdeep.json\t3\0".to_vec()));
    assert_eq!(result_of(&bench.ask(Opcode::ListDirectory, 0, 1, b"/extras")), Err(FtpError::EndOfFile as u8));
    let opened = bench.ask(Opcode::OpenFileRo, 0, 0, b"general.json");
    assert_eq!(result_of(&bench.ask(Opcode::ReadFile, opened.session, 0, &[0; 200])), Ok(b"{}".to_vec()));
    assert_eq!(result_of(&bench.ask(Opcode::RemoveFile, 0, 0, b"general.json")), Err(FtpError::FileProtected as u8));
    assert_eq!(result_of(&bench.ask(Opcode::CreateFile, 0, 0, b"/")), Err(FtpError::FileProtected as u8));
    assert_eq!(result_of(&bench.ask(Opcode::OpenFileRo, 0, 0, b"../b.ulg")), Err(FtpError::FileNotFound as u8));
}

#[test]
fn exact_generated_session_content_does_not_change_after_opening() {
    let mut bench = FtpHarness::new();
    let mut open = |number: u8, content: &[u8]| {
        let request = bench.packet(Opcode::OpenFileRo, number, 0, b"@PARAM/param.pck");
        bench.server.open_generated(CLIENT, &request, content.to_vec(), bench.now);
        bench.server.open_generated(CLIENT, &request, b"a duplicate must not generate new content".to_vec(), bench.now);
        let answers: Vec<FtpPacket> = bench.server.poll(|_| true).into_iter().map(|(_, packet)| packet).collect();
        assert_eq!(answers[0], answers[1]);
        answers[0].clone()
    };
    let (old, new) = (open(0, b"before"), open(1, b"after it"));
    assert_eq!((result_of(&old), result_of(&new)), (Ok(6u32.to_le_bytes().to_vec()), Ok(8u32.to_le_bytes().to_vec())));
    assert_eq!(result_of(&bench.ask(Opcode::ReadFile, old.session, 0, &[0; 100])), Ok(b"before".to_vec()));
    assert_eq!(result_of(&bench.ask(Opcode::ReadFile, new.session, 6, &[0; 100])), Ok(b"it".to_vec()));
    assert_eq!(result_of(&bench.ask(Opcode::ReadFile, new.session, 8, &[0; 100])), Err(FtpError::EndOfFile as u8));
    assert_eq!(
        result_of(&bench.ask(Opcode::OpenFileRo, 0, 0, b"@PARAM/param.pck")),
        Err(FtpError::FileNotFound as u8),
        "generated content must not be stored"
    );
}

#[test]
fn exact_long_listing_can_be_read_entry_by_entry() {
    let mut bench = FtpHarness::new();
    let names: Vec<String> = (0..40).map(|k| format!("flight-{k:02}.ulg")).chain(["x".repeat(250), "y".into()]).collect();
    for name in &names {
        bench.files.0.insert(name.clone(), Vec::new());
    }
    let (mut seen, mut offset) = (Vec::new(), 0);
    while let Ok(part) = result_of(&bench.ask(Opcode::ListDirectory, 0, offset, b"")) {
        let entries: Vec<String> = String::from_utf8(part).unwrap().split_terminator('\0').map(str::to_owned).collect();
        offset += entries.len() as u32;
        seen.extend(entries);
    }
    assert_eq!(seen.len(), names.len());
    assert_eq!((seen[40].as_str(), seen[41].as_str()), ("S", "Fy\t0"));
}

/// Loses 30% and duplicates 10% of the packets, in both directions.
fn impair(packets: Vec<FtpPacket>, random: &mut RandomStream) -> Vec<FtpPacket> {
    let mut out: Vec<FtpPacket> = Vec::new();
    for packet in packets {
        if random.uniform() < 0.3 {
            continue;
        }
        if random.uniform() < 0.1 {
            out.push(packet.clone());
        }
        out.insert((random.uniform() * (out.len() + 1) as f64) as usize, packet);
    }
    out
}

#[test]
fn prop_burst_download_survives_loss_duplication_and_reordering() {
    for seed in 0..20 {
        let mut random = RandomStream::new(seed, "ftp link");
        let mut bench = FtpHarness::new();
        let file: Vec<u8> = (0..40_000 + seed * 239).map(|k| (k * k % 251) as u8).collect();
        bench.files.0.insert("log.ulg".into(), file.clone());
        let session = bench.ask(Opcode::OpenFileRo, 0, 0, b"log.ulg").session;
        let mut got: BTreeMap<u32, Vec<u8>> = BTreeMap::new();
        let mut rounds = 0;
        loop {
            rounds += 1;
            assert!(rounds < 2_000, "seed {seed}: the transfer did not complete");
            let held = got.iter().fold(0, |end, (from, bytes)| if *from == end { from + bytes.len() as u32 } else { end });
            if held as usize == file.len() {
                break;
            }
            let request = bench.packet(Opcode::BurstReadFile, session, held, &[0; DATA_MAX]);
            let mut heard = Vec::new();
            for asked in impair(vec![request], &mut random) {
                heard.extend(bench.put(CLIENT, &asked));
            }
            for _ in 0..BURST_PACKETS {
                heard.extend(bench.advance(CLIENT));
            }
            for packet in impair(heard, &mut random).into_iter().filter(|packet| packet.opcode == ACK) {
                got.insert(packet.offset, packet.data_in_use().unwrap().to_vec());
            }
        }
        let whole: Vec<u8> = got.into_values().flatten().collect();
        assert_eq!(whole, file, "seed {seed}");
    }
}

#[test]
fn prop_invalid_requests_are_answered_and_leave_no_state() {
    let mut random = RandomStream::new(5, "ftp rubbish");
    let mut bench = FtpHarness::new();
    bench.files.0.insert("a".into(), vec![7; 1000]);
    for _ in 0..20_000 {
        let mut bytes = [0u8; PAYLOAD];
        bytes.iter_mut().for_each(|byte| *byte = (random.uniform() * 256.0) as u8);
        bytes[3] = (random.uniform() * 20.0) as u8;
        bytes[2] %= 5;
        if random.uniform() < 0.5 {
            bytes[4] = 1;
            bytes[12] = b'a';
        }
        if bytes[3] == Opcode::WriteFile as u8 || bytes[3] == Opcode::TruncateFile as u8 {
            bytes[9..12].fill(0);
        }
        let client = (LinkId(1 + u32::from(bytes[0] % 3)), (bytes[1], 190));
        bench.put(client, &FtpPacket::read(&bytes));
    }
    assert!(bench.server.answered.len() <= 64 && bench.server.waiting.is_empty() && bench.server.jobs.is_empty());
    for link in 1..=3 {
        bench.server.forget(LinkId(link));
    }
    assert!(bench.server.answered.len() == 0 && bench.server.bursts.is_empty());
    assert!(result_of(&bench.ask(Opcode::ListDirectory, 0, 0, b"/")).is_ok() || bench.files.0.is_empty());
}
