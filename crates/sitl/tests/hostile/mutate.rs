//! Malformed and unusual datagrams: changed fields with a correct checksum; truncated, altered or joined frames; pure
//! noise.

use super::seeds;
use mavlink::{MavlinkVersion, Message};
use spandrel_mavlink::dialect::{MISSION_ITEM_INT_DATA, MavMessage, MavMissionType};
use spandrel_model::random::RandomStream;
use spandrel_sitl::endpoint::HANDLED;

const F32_VALUES: [f32; 14] = [
    f32::NAN,
    -f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    1e-42,
    -0.0,
    1.0,
    -1.0,
    1e30,
    0.5,
    90.0,
];
const I32_VALUES: [i32; 9] = [i32::MIN, i32::MAX, -1, 0, 1, 900_000_001, -900_000_001, 1_800_000_001, 467_052_000];
const U16_VALUES: [u16; 14] = [0, 1, 2, 3, 4, 5, 2000, 2001, 32_767, 32_768, 65_534, 65_535, 255, 256];
const BYTES: [u8; 10] = [0, 1, 2, 3, 7, 8, 127, 128, 254, 255];
/// PX4's number for the mission mode.
const MISSION_MODE: u32 = 4 << 16 | 4 << 24;
/// Bytes that are not valid UTF-8.
const INVALID_UTF8: [u8; 4] = [0xC3, 0x28, 0xFF, 0xFE];

/// Returns a complete frame around a payload, with a correct checksum.
pub fn frame(id: u32, payload: &[u8], sender: (u8, u8), stream: &mut RandomStream) -> Vec<u8> {
    let extra = MavMessage::extra_crc(id);
    let sequence = stream.bits() as u8;
    let old = id < 256 && stream.below(4) == 0;
    let signed = stream.below(8) == 0;
    let mut out = if old {
        vec![0xFE, payload.len() as u8, sequence, sender.0, sender.1, id as u8]
    } else {
        let [a, b, c, _] = id.to_le_bytes();
        vec![0xFD, payload.len() as u8, u8::from(signed), 0, sequence, sender.0, sender.1, a, b, c]
    };
    out.extend(payload);
    out.extend(mavlink::calculate_crc(&out[1..], extra).to_le_bytes());
    if signed && !old {
        out.extend((0..13).map(|_| stream.bits() as u8));
    }
    out
}

/// Returns a message's payload with all fields, including extensions.
pub fn payload(message: &MavMessage) -> Vec<u8> {
    let mut bytes = [0; 255];
    let base = message.ser(MavlinkVersion::V1, &mut bytes);
    let mut bytes = [0; 255];
    let used = message.ser(MavlinkVersion::V2, &mut bytes);
    // Extensions are at most a few bytes longer than the used ones; the receiver ignores bytes beyond them.
    bytes[..used.max((base + 4).min(255))].to_vec()
}

/// Changes bytes that are or could be a field: MAVLink orders fields by size, so any offset is valid for some type.
pub fn field(bytes: &mut [u8], stream: &mut RandomStream) {
    fn put<const N: usize>(bytes: &mut [u8], value: [u8; N], stream: &mut RandomStream) {
        let places = bytes.len() / N;
        if places > 0 {
            let at = N * stream.below(places);
            bytes[at..at + N].copy_from_slice(&value);
        }
    }
    match stream.below(7) {
        0 | 1 => put(bytes, F32_VALUES[stream.below(F32_VALUES.len())].to_le_bytes(), stream),
        2 => put(bytes, I32_VALUES[stream.below(I32_VALUES.len())].to_le_bytes(), stream),
        3 => put(bytes, U16_VALUES[stream.below(U16_VALUES.len())].to_le_bytes(), stream),
        4 => put(bytes, [BYTES[stream.below(BYTES.len())]], stream),
        5 => {
            let at = stream.below(bytes.len());
            let end = (at + 1 + stream.below(8)).min(bytes.len());
            bytes[at..end].fill(if stream.below(2) == 0 { 0xFF } else { stream.bits() as u8 });
        }
        _ => put(bytes, INVALID_UTF8, stream),
    }
}

/// Returns a frame with a handled message: one in three is unchanged; the rest have some changed fields.
fn handled(numbers: &[u16], stream: &mut RandomStream) -> Vec<u8> {
    let (id, mut bytes) = if stream.below(4) == 0 {
        seeds::command(numbers[stream.below(numbers.len())], stream)
    } else {
        let id = HANDLED[stream.below(HANDLED.len())];
        let good = seeds::all(id);
        (id, payload(&good[stream.below(good.len())]))
    };
    for _ in 0..[0, 1, 1, 2, 3, 4][stream.below(6)] {
        field(&mut bytes, stream);
    }
    if stream.below(6) == 0 {
        bytes.truncate(1 + stream.below(bytes.len()));
    }
    frame(id, &bytes, sender(stream), stream)
}

fn sender(stream: &mut RandomStream) -> (u8, u8) {
    match stream.below(8) {
        0 => (stream.bits() as u8, stream.bits() as u8),
        1 => (1, 191),
        2 => (254, 190),
        _ => (255, 190),
    }
}

/// Returns the frames of an upload with one frame changed, omitted, duplicated or swapped with its neighbor, and then
/// the command to fly the mission.
pub fn upload(stream: &mut RandomStream) -> Vec<Vec<u8>> {
    let (items, item): (u16, fn(u16) -> MISSION_ITEM_INT_DATA) = match stream.below(4) {
        0 => (2, seeds::item_without_position),
        1 => (3 + stream.below(2) as u16, seeds::corner),
        _ => (1 + stream.below(5) as u16, seeds::item),
    };
    let fence = item(0).mission_type == MavMissionType::MAV_MISSION_TYPE_FENCE;
    let mut messages = vec![if fence { seeds::count_fence(items) } else { seeds::count(items) }];
    messages.extend((0..items).map(|seq| MavMessage::MISSION_ITEM_INT(item(seq))));
    let mut payloads: Vec<(u32, Vec<u8>)> = messages.iter().map(|m| (m.message_id(), payload(m))).collect();
    let at = stream.below(payloads.len());
    match stream.below(6) {
        0 | 1 => field(&mut payloads[at].1, stream),
        2 => drop(payloads.remove(at)),
        3 => payloads.insert(at, payloads[at].clone()),
        4 => payloads.swap(at, 0),
        _ => {}
    }
    payloads.extend(seeds::messages(11).iter().take(1).map(|mode| {
        let mut bytes = payload(mode);
        bytes[..4].copy_from_slice(&MISSION_MODE.to_le_bytes());
        (11, bytes)
    }));
    payloads.iter().map(|(id, payload)| frame(*id, payload, (255, 190), stream)).collect()
}

/// Returns one datagram.
pub fn datagram(numbers: &[u16], stream: &mut RandomStream) -> Vec<u8> {
    if stream.below(16) == 0 {
        return (0..stream.below(400)).map(|_| if stream.below(8) == 0 { 0xFD } else { stream.bits() as u8 }).collect();
    }
    let mut bytes: Vec<u8> = (0..=stream.below(4)).flat_map(|_| handled(numbers, stream)).collect();
    let at = stream.below(bytes.len());
    match stream.below(12) {
        0 => bytes[at] ^= 1 << stream.below(8),
        1 => bytes.truncate(at),
        2 => bytes.insert(at, stream.bits() as u8),
        3 => drop(bytes.drain(..at)),
        _ => {}
    }
    bytes
}
