//! Instructor's notes to the monitor. A note is a TUNNEL message with a private payload type, so that only the monitor receives
//! it and it never appears on a trainee's display. It is recorded with the other telemetry.

use super::codec::{Encoder, ReceivedFrame};

/// Message ID of TUNNEL.
const TUNNEL_MESSAGE_ID: u32 = 385;
/// Payload type of notes; types 32768 and above are reserved for private use.
const NOTE_PAYLOAD_TYPE: u16 = 33_077;
/// Number of bytes before the text: payload type, target system, target component, text length.
const HEADER_LEN: usize = 5;
/// Maximum text length, bytes.
pub const MAX_TEXT_LEN: usize = 128;

/// Encodes a note for a component. Text longer than [`MAX_TEXT_LEN`] is truncated at a character boundary.
#[must_use]
pub fn encode(encoder: &mut Encoder, system: u8, component: u8, text: &str) -> Vec<u8> {
    let end = (0..=MAX_TEXT_LEN.min(text.len())).rfind(|at| text.is_char_boundary(*at)).unwrap_or(0);
    let text = &text[..end];
    let [low, high] = NOTE_PAYLOAD_TYPE.to_le_bytes();
    let mut payload = vec![low, high, system, component, u8::try_from(text.len()).unwrap_or(0)];
    payload.extend_from_slice(text.as_bytes());
    encoder.encode_payload(TUNNEL_MESSAGE_ID, &payload)
}

/// Returns the target (system and component) and the text of a note; `None` if the frame is not a note.
#[must_use]
pub fn decode(frame: &ReceivedFrame) -> Option<((u8, u8), String)> {
    if frame.message_id != TUNNEL_MESSAGE_ID {
        return None;
    }
    let payload = frame.payload(HEADER_LEN + MAX_TEXT_LEN);
    let [low, high, system, component, length, text @ ..] = payload.as_slice() else { return None };
    if u16::from_le_bytes([*low, *high]) != NOTE_PAYLOAD_TYPE {
        return None;
    }
    let text = text.get(..usize::from(*length))?;
    let plain: String = String::from_utf8_lossy(text).chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    Some(((*system, *component), plain))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::Decoder;
    use crate::router::target;

    fn sent(text: &str) -> ReceivedFrame {
        Decoder::new().datagram(&encode(&mut Encoder::new(252, 192), 1, 191, text)).remove(0)
    }

    #[test]
    fn wire_note_round_trips_and_targets_only_the_monitor() {
        for text in ["too fast at the pier", "", "Brücke", &"x".repeat(MAX_TEXT_LEN)] {
            let frame = sent(text);
            assert_eq!(decode(&frame), Some(((1, 191), text.to_owned())));
            assert_eq!(target(&frame), (1, 191));
        }
        assert_eq!(
            decode(&sent(&"ü".repeat(100))).map(|(_, text)| text),
            Some("ü".repeat(64)),
            "truncated at a character boundary"
        );
        assert_eq!(decode(&sent("a\nb")).map(|(_, text)| text), Some("a b".into()));
    }

    #[test]
    fn wire_other_tunnel_payloads_are_not_notes() {
        let mut encoder = Encoder::new(1, 1);
        let other = Decoder::new().datagram(&encoder.encode_payload(TUNNEL_MESSAGE_ID, &[1, 0, 1, 191, 2, b'h', b'i'])).remove(0);
        assert_eq!(decode(&other), None);
        // The length field exceeds the payload.
        let [low, high] = NOTE_PAYLOAD_TYPE.to_le_bytes();
        let long = Decoder::new().datagram(&encoder.encode_payload(TUNNEL_MESSAGE_ID, &[low, high, 1, 191, 200, b'h'])).remove(0);
        assert_eq!(decode(&long), None);
    }
}
