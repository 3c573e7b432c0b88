//! Starts a real-time simulator process and a client for it.
#![allow(dead_code, reason = "each benchmark uses only some of it")]

use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::MavMessage;
use std::io::{BufRead, BufReader};
use std::net::UdpSocket;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

/// Maximum time without data. After that, the simulator is assumed to have exited.
const SILENCE_TIMEOUT: Duration = Duration::from_secs(5);

#[expect(clippy::disallowed_methods, reason = "benchmarks measure wall time")]
pub fn now() -> Instant {
    Instant::now()
}

/// A simulator process. Dropping this value stops the process.
pub struct SimulatorProcess {
    child: Child,
    output: BufReader<ChildStdout>,
}

/// Simulator delays relative to real time.
pub struct Lateness {
    /// Longest tick delay, ms.
    pub latest_ms: f64,
    /// Number of times the simulation clock skipped time instead of catching up.
    pub slips: u64,
}

impl SimulatorProcess {
    /// Stops the simulator and returns the delays that it reported.
    pub fn end(mut self) -> Lateness {
        drop(self.child.stdin.take());
        let told = self.line();
        let number = |key: &str| told[key].as_f64().expect("the value must be a number");
        Lateness { latest_ms: number("latest_ms"), slips: number("slips") as u64 }
    }

    fn line(&mut self) -> serde_json::Value {
        let mut line = String::new();
        self.output.read_line(&mut line).expect("the simulator must print a line");
        serde_json::from_str(&line).expect("the line must be JSON")
    }
}

impl Drop for SimulatorProcess {
    fn drop(&mut self) {
        // Closing standard input stops the simulator, which may already have exited.
        drop(self.child.stdin.take());
        let _ = self.child.wait();
    }
}

/// A ground station client.
pub struct Client {
    pub socket: UdpSocket,
    pub encoder: Encoder,
    decoder: Decoder,
    buffer: Vec<u8>,
}

impl Client {
    pub fn new(port: u16, system: u8) -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a port must be free");
        socket.connect(("127.0.0.1", port)).expect("loopback must be available");
        socket.set_read_timeout(Some(SILENCE_TIMEOUT)).expect("the timeout must be valid");
        Self { socket, encoder: Encoder::new(system, 190), decoder: Decoder::new(), buffer: vec![0; 65_536] }
    }

    pub fn send(&mut self, message: &MavMessage) {
        let frame = self.encoder.encode(message);
        self.socket.send(&frame).expect("sending over loopback must work");
    }

    /// Returns the ratio of simulation time to wall time, measured over at least the given duration. Also returns the
    /// wall time of the measurement, in seconds.
    pub fn speed_factor(&mut self, over: Duration) -> (f64, f64) {
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
            let len = self.socket.recv(&mut self.buffer).expect("the simulator must keep sending");
            let frames = self.decoder.datagram(&self.buffer[..len]);
            if let Some(found) = frames.iter().filter_map(|frame| frame.message.as_ref()).find_map(&mut pick) {
                return found;
            }
        }
    }
}

/// Starts a real-time simulator. Returns its process and its ground station port.
pub fn start() -> (SimulatorProcess, u16) {
    let job = ["sim", "--scenario", "drill-hover", "--seed", "7", "--ports", "ephemeral", "--log", "warn"];
    let mut child = Command::new(env!("CARGO_BIN_EXE_spandrel"))
        .args(job)
        .args(["--announce", "--leash", "--lateness"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program must start");
    let told = BufReader::new(child.stdout.take().expect("standard output must be piped"));
    let mut running = SimulatorProcess { child, output: told };
    let port = running.line()["gcs_port"].as_u64().expect("the port must be a number");
    (running, port as u16)
}
