//! A simulator that receives noise on its socket must keep responding, and report on exit the number of bytes that it
//! could not parse.

use spandrel_mavlink::codec::{Decoder, Encoder};
use spandrel_mavlink::dialect::{MavMessage, PARAM_REQUEST_READ_DATA};
use spandrel_model::random::RandomStream;
use std::io::{BufRead, BufReader, Read};
use std::net::UdpSocket;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Maximum payload of a UDP datagram over IPv4, bytes.
const MAX_DATAGRAM_BYTES: usize = 65_507;
/// Time without output before a simulator counts as dead; turns a hang into a failure.
const EXIT_TIMEOUT: Duration = Duration::from_secs(30);

#[test]
fn wire_noise_on_the_socket_is_counted_and_ignored() {
    let mut sim = Command::new(env!("CARGO_BIN_EXE_spandrel"))
        .args([
            "sim",
            "--ports",
            "ephemeral",
            "--announce",
            "--leash",
            "--scenario",
            "drill-hover",
            "--seed",
            "1",
            "--log",
            "warn",
        ])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    BufReader::new(sim.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let announced: serde_json::Value = serde_json::from_str(&line).unwrap();
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    socket.connect(("127.0.0.1", announced["gcs_port"].as_u64().unwrap() as u16)).unwrap();
    socket.set_read_timeout(Some(EXIT_TIMEOUT)).unwrap();

    let mut stream = RandomStream::new(9, "noise");
    let mut encoder = Encoder::new(255, 190);
    let question = MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
        param_index: -1,
        target_system: 1,
        target_component: 1,
        param_id: "MIS_TAKEOFF_ALT".into(),
    });
    let mut answered = 0;
    for round in 0..20 {
        let length = [0, 1, 12, 280, 4_000, MAX_DATAGRAM_BYTES][round % 6];
        let noise: Vec<u8> = (0..length).map(|k| if k % 3 == 0 { 0xFD } else { stream.bits() as u8 }).collect();
        socket.send(&noise).unwrap();
        socket.send(&encoder.encode(&question)).unwrap();
        let mut buffer = [0; 2_000];
        while answered == round {
            let len = socket.recv(&mut buffer).expect("the simulator must respond");
            let frames = Decoder::new().datagram(&buffer[..len]);
            answered += frames.iter().filter(|f| matches!(f.message, Some(MavMessage::PARAM_VALUE(_)))).count();
        }
    }
    drop(sim.stdin.take());
    let mut told = String::new();
    sim.stderr.take().unwrap().read_to_string(&mut told).unwrap();
    assert!(sim.wait().unwrap().success());
    assert!(told.contains("not part of a MAVLink frame"), "{told}");
}
