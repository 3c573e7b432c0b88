//! Random messages from every side: nothing panics, and the exchange goes on.

use crate::rig::{AUTOPILOT, MONITOR, Rig, STATION};
use mavlink::Message;
use spandrel_mavlink::codec::Encoder;
use spandrel_mavlink::dialect::MavMessage;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::AfterCrash;
use spandrel_model::time::SimTime;
use spandrel_sitl::sim::AutopilotState;

/// Largest message ID of the common dialect that the test looks for.
const MAX_ID: u32 = 13_000;
/// Random payloads for each message.
const ROUNDS: usize = 6;

/// Returns a random payload whose target is this vehicle in half of the cases: bytes 0 to 3 often contain the target.
fn payload(random: &mut RandomStream) -> Vec<u8> {
    let length = (random.uniform() * 256.0) as usize;
    (0..length).map(|_| if random.uniform() < 0.3 { 1 } else { (random.uniform() * 256.0) as u8 }).collect()
}

/// Connects a new process if a random message was a reboot command.
fn start_again(rig: &mut Rig) {
    if rig.sim.autopilot_state() == Some(AutopilotState::Disconnected) {
        rig.start();
    }
}

#[test]
fn prop_random_messages_from_every_side_are_survived() {
    let mut random = RandomStream::new(18, "random messages");
    let mut rig = Rig::ready(AfterCrash::Continue);
    let ids: Vec<u32> = (0..MAX_ID).filter(|id| MavMessage::default_message_from_id(*id).is_some()).collect();
    assert!(ids.len() > 150, "{}", ids.len());
    let mut encoders = [(STATION, 255, 190), (MONITOR, 1, 191), (AUTOPILOT, 1, 1), (AUTOPILOT, 1, 100), (STATION, 1, 1)]
        .map(|(link, system, component)| (link, Encoder::new(system, component)));
    for id in ids.iter().flat_map(|id| std::iter::repeat_n(*id, ROUNDS)) {
        for (link, encoder) in &mut encoders {
            let bytes = encoder.encode_payload(id, &payload(&mut random));
            rig.sim.handle_datagram(*link, &bytes);
        }
        let noise = payload(&mut random);
        rig.sim.handle_autopilot_bytes(&noise);
        let frame = encoders[2].1.encode_payload(id, &payload(&mut random));
        rig.sim.handle_autopilot_bytes(&frame);
        rig.exchange();
        start_again(&mut rig);
    }
    start_again(&mut rig);
    let before = rig.sim.now();
    rig.run_s(1.0);
    assert!(rig.sim.now() - before >= SimTime::from_s(1.0));
}
