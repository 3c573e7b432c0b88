//! Feeds arbitrary bytes to the vehicle in flight. Length bytes split the input into chunks. The first byte of a chunk
//! determines whether the rest is sent as a raw datagram or, with a valid checksum, as the payload of a message that
//! the vehicle handles. The vehicle must not panic, and its state must stay finite.
#![no_main]

use mavlink::Message;
use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::dialect::{COMMAND_LONG_DATA, MANUAL_CONTROL_DATA, MavCmd, MavMessage};
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_sitl::endpoint::files::job::{DirectoryEntry, FileAction, FileError, FileJobResult};
use spandrel_sitl::endpoint::flavor::px4;
use spandrel_sitl::endpoint::{HANDLED, LinkId, LinkKind};
use spandrel_sitl::sim::{Sim, SimConfig};
use std::sync::{Arc, LazyLock};

const LINK: LinkId = LinkId(1);

static FLYING: LazyLock<Sim> = LazyLock::new(|| {
    let scenario = include_str!("../../scenarios/drill-hover.toml");
    let vehicle = include_str!("../../vehicle-params/phantom2.toml");
    let scenario = Arc::new(
        spandrel_model::scenario::read("drill-hover.toml", scenario, &|_| Err("none".into()))
            .expect("the shipped file must be valid"),
    );
    let vehicle = Arc::new(spandrel_model::vehicle::read("phantom2.toml", vehicle).expect("the shipped file must be valid"));
    let site = Arc::new(Site::build(&scenario, 1));
    let mut sim = Sim::new(SimConfig { scenario, vehicle, seed: 1, instance: 0, flavor: &px4::FLAVOR, after_crash: None }, site);
    sim.open_link(LINK, LinkKind::GroundStation, false);
    sim.handle_timeout(SimTime::from_ms(2_500));
    let mut encoder = Encoder::new(255, 190);
    let mut send = |sim: &mut Sim, message: &MavMessage| sim.handle_datagram(LINK, &encoder.encode(message));
    let command = |command, param1, param2| {
        MavMessage::COMMAND_LONG(COMMAND_LONG_DATA { command, param1, param2, target_system: 1, ..Default::default() })
    };
    let sticks = MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { target: 1, z: 800, ..Default::default() });
    send(&mut sim, &command(MavCmd::MAV_CMD_DO_SET_MODE, 1.0, 3.0));
    send(&mut sim, &command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0));
    for ms in (2_500..5_500).step_by(20) {
        send(&mut sim, &sticks);
        sim.handle_timeout(SimTime::from_ms(ms));
        while sim.poll_transmit().is_some() {}
    }
    sim
});

/// Creates a frame with the given payload bytes and a correct checksum.
fn build_frame(choice: u8, payload: &[u8]) -> Vec<u8> {
    let id = HANDLED[usize::from(choice) % HANDLED.len()];
    let [a, b, c, _] = id.to_le_bytes();
    let mut out = vec![0xFD, payload.len() as u8, 0, 0, 0, 255, 190, a, b, c];
    out.extend(payload);
    out.extend(mavlink::calculate_crc(&out[1..], MavMessage::extra_crc(id)).to_le_bytes());
    out
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let mut sim = FLYING.clone();
    sim.enable_file_jobs();
    let mut rest = bytes;
    while let [len, tail @ ..] = rest {
        let (chunk, after) = tail.split_at(usize::from(*len).min(tail.len()));
        rest = after;
        match chunk {
            [kind, choice, payload @ ..] if kind & 1 == 0 => sim.handle_datagram(LINK, &build_frame(*choice, payload)),
            _ => sim.handle_datagram(LINK, chunk),
        }
        let ms = chunk.first().map_or(0, |kind| i64::from(kind >> 4));
        let until = sim.now() + SimTime::from_ms(ms);
        sim.handle_timeout(until);
        while let Some(job) = sim.poll_file_job() {
            let outcome = match job.action {
                FileAction::Read(_, _, most) => Ok(FileJobResult::Bytes(vec![7; most.min(40_000) as usize])),
                FileAction::List(_) => Ok(FileJobResult::Entries(vec![
                    DirectoryEntry::Directory("d".repeat(300)),
                    DirectoryEntry::File(String::new(), u64::MAX),
                ])),
                FileAction::Size(_) => Ok(FileJobResult::Size(u32::MAX)),
                FileAction::Checksum { .. } => Ok(FileJobResult::Checksum { sum: u32::MAX, bytes: 5 }),
                _ => Err(FileError::Other),
            };
            sim.finish_file_job(job.ticket, outcome);
        }
        while sim.poll_transmit().is_some() {}
        let truth = &sim.truth().rigid;
        assert!(truth.position_m.is_finite() && truth.velocity_m_s.is_finite() && truth.rates_rad_s.is_finite());
    }
});
