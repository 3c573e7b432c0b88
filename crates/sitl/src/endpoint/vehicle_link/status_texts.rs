//! Status texts, split into chunks as the protocol requires.

use super::VehicleLink;
use super::events::covers_whole_text;
use super::snapshot::VehicleSnapshot;
use crate::endpoint::component_ids::AUTOPILOT;
use crate::endpoint::link::{LinkKind, Links};
use crate::endpoint::text_queue::chunks;
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
