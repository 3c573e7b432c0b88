//! Status texts, split into chunks as the protocol requires.

use super::VehicleLink;
use super::events::covers_whole_text;
use super::snapshot::VehicleSnapshot;
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::link::{LinkKind, Links};
use spandrel_mavlink::dialect::{MavMessage, STATUSTEXT_DATA};

impl VehicleLink {
    /// Broadcasts the queued texts. Texts longer than 50 bytes are split into chunks, which clients reassemble by ID.
    /// Like PX4, appends a tab for ground stations if an event conveys the whole text.
    pub(crate) fn send_texts(&mut self, view: &VehicleSnapshot, links: &mut Links) {
        for (severity, text) in self.texts.take() {
            self.send_notice(&text, view.clock.boot_time_ms(), links);
            let marked = self.flavor.events && covers_whole_text(&text);
            let plain = chunks(&text);
            let tabbed = if marked { chunks(&format!("{text}\t")) } else { Vec::new() };
            let whole = plain.len() == 1 && tabbed.len() <= 1;
            let id = if whole { 0 } else { self.texts.next_id() };
            for link in links.listeners() {
                let stations = matches!(link.kind, LinkKind::GroundStation | LinkKind::Tcp | LinkKind::Serial);
                let pieces = if marked && stations { &tabbed } else { &plain };
                for (k, piece) in pieces.iter().enumerate() {
                    let text = piece.as_str().into();
                    link.send(AUTOPILOT, &MavMessage::STATUSTEXT(STATUSTEXT_DATA { severity, text, id, chunk_seq: k as u8 }));
                }
            }
        }
    }
}

/// Splits a text into chunks of at most 50 bytes, at character boundaries.
fn chunks(text: &str) -> Vec<String> {
    const MAX_CHUNK_BYTES: usize = 50;
    let mut out = vec![String::new()];
    for character in text.chars() {
        let last = out.len() - 1;
        if out[last].len() + character.len_utf8() > MAX_CHUNK_BYTES {
            out.push(String::new());
        }
        let last = out.len() - 1;
        out[last].push(character);
    }
    // A full chunk means that another one follows, so the last of several chunks must not be full.
    if out.len() > 1 && out.last().is_some_and(|last| last.len() == MAX_CHUNK_BYTES) {
        out.push(String::new());
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_last_of_several_chunks_is_never_full() {
        for (long, count) in [(0, 1), (49, 1), (50, 1), (51, 2), (99, 2), (100, 3), (150, 4)] {
            let text = "x".repeat(long);
            let pieces = chunks(&text);
            assert_eq!((pieces.len(), pieces.concat()), (count, text), "{long}");
            assert!(count == 1 || pieces[count - 1].len() < 50, "{long}");
        }
    }
}
