//! Measures the response times of `spandrel serve` with a database of 10,000 sessions, which are renamed copies of the
//! example study. Requests the session list, its last page, one session, one trainee, and the cohort. Also checks that
//! the cohort page stays small.

use spandrel_training::record::SessionRecord;
use sqlx::{Connection, Row, SqliteConnection};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const RECORDS: &str = include_str!("../examples/cohort/records.jsonl");
const SESSION_COUNT: usize = 10_000;
const ROUNDS: usize = 31;
/// Limits (requirements) for the median response time of a page and the time to generate a cohort report.
const MAX_PAGE_TIME: Duration = Duration::from_millis(100);
const MAX_COHORT_TIME: Duration = Duration::from_secs(2);

/// Maximum size of a page for 10,000 sessions, bytes. Phones must be able to open it.
const MAX_PAGE_BYTES: usize = 1_000_000;

struct Server {
    process: Child,
    address: String,
}

impl Server {
    fn start(sessions: &Path) -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_spandrel"))
            .args(["serve", "--listen", "127.0.0.1:0", "--vehicle", "none", "--announce", "--leash", "--sessions"])
            .arg(sessions)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the server must start");
        let mut line = String::new();
        BufReader::new(process.stdout.take().expect("standard output must be piped"))
            .read_line(&mut line)
            .expect("the server must announce its address");
        let announced: serde_json::Value = serde_json::from_str(&line).expect("the announcement must be JSON");
        let address = announced["address"].as_str().unwrap_or_default().trim_start_matches("http://").to_owned();
        Self { process, address }
    }

    fn get(&self, path: &str) -> usize {
        let mut socket = TcpStream::connect(&self.address).expect("the server must listen");
        write!(socket, "GET {path} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", self.address)
            .expect("the request must be sent");
        let mut answer = Vec::new();
        socket.read_to_end(&mut answer).expect("the server must respond");
        assert!(answer.starts_with(b"HTTP/1.1 200"), "{path}: {}", String::from_utf8_lossy(&answer[..answer.len().min(300)]));
        answer.len()
    }

    #[expect(clippy::disallowed_methods, reason = "benchmarks measure wall time")]
    fn median(&self, path: &str, rounds: usize) -> (Duration, usize) {
        let mut size = 0;
        let mut times: Vec<Duration> = (0..rounds)
            .map(|_| {
                let start = Instant::now();
                size = self.get(path);
                start.elapsed()
            })
            .collect();
        times.sort();
        (times[times.len() / 2], size)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        drop(self.process.stdin.take());
        let _ = self.process.wait();
    }
}

/// Adds one session.
const INSERT: &str = "INSERT INTO sessions (id, trainee, started_unix_us, scenario, scenario_sha256, vehicle, vehicle_sha256, \
    telemetry_sha256, spandrel_version, scorer_version, end_reason, seconds, conformity, efficiency, safety, accuracy, overall, overall_max, \
    fingerprint, record) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";

/// Inserts copies of the study's records into the existing tables.
async fn insert_sessions(file: &Path) -> Result<String, sqlx::Error> {
    let originals: Vec<SessionRecord> = RECORDS.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    let mut database = SqliteConnection::connect(&format!("sqlite://{}", file.display())).await?;
    let mut change = database.begin().await?;
    let mut last = String::new();
    for k in 0..SESSION_COUNT {
        let mut r = originals[k % originals.len()].clone();
        r.trainee = format!("{}-{}", r.trainee, k / originals.len());
        r.id = format!("{}-{k}", r.id);
        let add = "INSERT OR IGNORE INTO trainees (pseudonym, role) VALUES (?, 'trainee')";
        sqlx::query(add).bind(&r.trainee).execute(&mut *change).await?;
        let text = serde_json::to_string(&r).unwrap_or_default();
        let query = sqlx::query(INSERT).bind(&r.id).bind(&r.trainee).bind(r.started_unix_us.cast_signed()).bind(&r.scenario);
        let query = query.bind(&r.scenario_sha256).bind(&r.vehicle).bind(&r.vehicle_sha256).bind(&r.telemetry_sha256);
        let query = query.bind(&r.spandrel_version).bind(r.scorer_version).bind(&r.end_reason).bind(r.seconds);
        let s = r.scores;
        let query =
            query.bind(s.conformity).bind(s.efficiency).bind(s.safety).bind(s.accuracy).bind(s.overall).bind(s.overall_max);
        query.bind(&r.fingerprint).bind(text).execute(&mut *change).await?;
        last = r.id;
    }
    change.commit().await?;
    let counted: i64 = sqlx::query("SELECT COUNT(*) FROM sessions").fetch_one(&mut database).await?.try_get(0)?;
    assert_eq!(usize::try_from(counted), Ok(SESSION_COUNT));
    Ok(last)
}

fn main() {
    let folder = tempfile::tempdir().expect("a temporary folder must be available");
    let server = Server::start(folder.path());
    let empty = server.median("/sessions", ROUNDS).0;
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("the runtime must start");
    let last = runtime.block_on(insert_sessions(&folder.path().join("records.sqlite"))).expect("the records must be inserted");
    let trainee = RECORDS
        .lines()
        .next()
        .and_then(|line| serde_json::from_str::<SessionRecord>(line).ok())
        .map(|r| r.trainee)
        .unwrap_or_default();
    let pages = [
        ("session list", "/sessions".to_owned(), ROUNDS, MAX_PAGE_TIME),
        ("last page of the session list", "/sessions?page=1000000".to_owned(), ROUNDS, MAX_PAGE_TIME),
        ("one session", format!("/sessions/{last}"), ROUNDS, MAX_PAGE_TIME),
        ("one trainee", format!("/trainees/{trainee}-0"), ROUNDS, MAX_PAGE_TIME),
        ("cohort of all trainees", "/cohort?incomplete=1".to_owned(), 5, MAX_COHORT_TIME),
        ("cohort report", "/cohort/report.html?incomplete=1".to_owned(), 5, MAX_COHORT_TIME),
        ("largest cohort table", "/cohort/tables/progress.csv?incomplete=1".to_owned(), 5, MAX_COHORT_TIME),
    ];
    let mut broken = false;
    for (name, path, rounds, ceiling) in pages {
        let (took, size) = server.median(&path, rounds);
        let times = took.as_secs_f64() / empty.as_secs_f64();
        println!(
            "{name}: median {:.1} ms, {times:.1} x the time for an empty list, {} kB (limit {} ms)",
            took.as_secs_f64() * 1e3,
            size / 1000,
            ceiling.as_millis()
        );
        broken |= took > ceiling || (path.starts_with("/cohort") && !path.contains("/tables/")) && size > MAX_PAGE_BYTES;
    }
    assert!(!broken, "limit exceeded");
}
