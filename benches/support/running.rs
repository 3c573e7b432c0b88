//! A real simulator beside a bench, in real time, and who talks to it.
#![allow(dead_code, reason = "each bench uses its part")]

use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::MavMessage;
use std::io::{BufRead, BufReader};
use std::net::UdpSocket;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

/// A simulator that says nothing for so long is gone.
const GONE: Duration = Duration::from_secs(5);

#[expect(clippy::disallowed_methods, reason = "a bench measures wall time")]
pub fn now() -> Instant {
    Instant::now()
}

/// A simulator that ends with this.
pub struct Running {
    child: Child,
    told: BufReader<ChildStdout>,
}

/// How late a simulator was, in wall time.
pub struct Lateness {
    /// The most that its ticks were late, ms.
    pub latest_ms: f64,
    /// How often they were so late that its clock let time go.
    pub slips: u64,
}

impl Running {
    /// Ends it, and reads how late it was.
    pub fn end(mut self) -> Lateness {
        drop(self.child.stdin.take());
        let told = self.line();
        let number = |key: &str| told[key].as_f64().expect("a number");
        Lateness { latest_ms: number("latest_ms"), slips: number("slips") as u64 }
    }

    fn line(&mut self) -> serde_json::Value {
        let mut line = String::new();
        self.told.read_line(&mut line).expect("one line");
        serde_json::from_str(&line).expect("JSON")
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // Its standard input closes, which ends it; a child that is gone already is no error.
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}

/// A ground station.
pub struct Client {
    pub socket: UdpSocket,
    pub encoder: Encoder,
    decoder: Decoder,
    buffer: Vec<u8>,
}

impl Client {
    pub fn new(port: u16, system: u8) -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a free port");
        socket.connect(("127.0.0.1", port)).expect("loopback");
        socket.set_read_timeout(Some(GONE)).expect("a timeout");
        Self { socket, encoder: Encoder::new(system, 190), decoder: Decoder::new(), buffer: vec![0; 65_536] }
    }

    pub fn send(&mut self, message: &MavMessage) {
        let frame = self.encoder.encode(message);
        self.socket.send(&frame).expect("loopback takes it");
    }

    /// Simulation time in a second of wall time, over at least so much of it; and how much it was, s.
    pub fn pace(&mut self, over: Duration) -> (f64, f64) {
        let (sim_begin, wall_begin) = self.clock();
        let (mut sim_end, mut wall_end) = (sim_begin, wall_begin);
        while wall_end - wall_begin < over {
            (sim_end, wall_end) = self.clock();
        }
        let wall_s = (wall_end - wall_begin).as_secs_f64();
        (f64::from(sim_end - sim_begin) / 1e3 / wall_s, wall_s)
    }

    fn clock(&mut self) -> (u32, Instant) {
        self.wait(|m| if let MavMessage::SYSTEM_TIME(t) = m { Some((t.time_boot_ms, now())) } else { None })
    }

    pub fn wait<T>(&mut self, mut pick: impl FnMut(&MavMessage) -> Option<T>) -> T {
        loop {
            let len = self.socket.recv(&mut self.buffer).expect("the simulator speaks");
            let frames = self.decoder.datagram(&self.buffer[..len]);
            if let Some(found) = frames.iter().filter_map(|frame| frame.message.as_ref()).find_map(&mut pick) {
                return found;
            }
        }
    }
}

/// A simulator in real time, and the port that ground stations dial.
pub fn start() -> (Running, u16) {
    let job = ["sim", "--scenario", "drill-hover", "--seed", "7", "--ports", "ephemeral", "--log", "warn"];
    let mut child = Command::new(env!("CARGO_BIN_EXE_spandrel"))
        .args(job)
        .args(["--announce", "--leash", "--lateness"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let told = BufReader::new(child.stdout.take().expect("piped"));
    let mut running = Running { child, told };
    let port = running.line()["gcs_port"].as_u64().expect("a port");
    (running, port as u16)
}
