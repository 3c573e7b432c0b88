//! Plans: full and partial upload, and download, of missions, fences and rally points.
#![allow(deprecated, reason = "some clients support only MISSION_REQUEST")]

use super::plan_summary::PlanSummary;
use super::positions::relative;
use super::{deferred_fields, fence_and_rally, items};
use crate::autopilot::MissionStep;
use crate::autopilot::fence::FenceZone;
use crate::autopilot::home::RallyPoint;
use crate::autopilot::mission::DeferredFields;
use spandrel_mavlink::dialect::{
    MISSION_ACK_DATA, MISSION_COUNT_DATA, MISSION_ITEM_INT_DATA, MISSION_REQUEST_DATA, MISSION_REQUEST_INT_DATA, MavCmd,
    MavMessage, MavMissionResult, MavMissionType,
};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::time::SimTime;

/// Maximum number of items in a plan.
const MAX_ITEMS: u16 = 2_000;
/// Timeout after which a stalled upload is canceled, s; longer than clients keep retrying.
const STALL_TIMEOUT_S: f64 = 10.0;
/// Every nth retry of the first item request uses the other encoding (estimate: one second at the usual timeout).
const ENCODING_SWITCH_RETRIES: u8 = 4;
/// Timeout after which a mission item request is repeated, s, as in PX4.
const RETRY_INTERVAL_S: f64 = 0.25;
/// For an uploader that usually responds faster, the request is repeated after this multiple of its usual delay, but
/// not before the minimum interval, s. MAVSDK gives up on an item after five half-second periods without a request; at
/// 0.25 s, only one retry fits into each period.
const RETRY_DELAY_FACTOR: f64 = 4.0;
const MIN_RETRY_INTERVAL_S: f64 = 0.12;
/// On a link that reorders datagrams, number of unanswered requests after which earlier items are requested, stepping
/// further back each time. An uploader that a delayed request has set back ignores requests for later items (MAVSDK). A
/// lower number would use up MAVSDK's five attempts when requests are merely lost.
const STEP_BACK_THRESHOLD: u8 = 4;
/// Number of steps back, each twice as far as the previous one: up to 128 items, more than are transferred while a
/// request is delayed.
const MAX_STEPS_BACK: u8 = 8;
/// Weight of the latest delay in the moving average.
const DELAY_WEIGHT: f64 = 0.25;
/// Number of times the acknowledgment of an upload over a lossy link is repeated.
const ACK_REPEAT_COUNT: u8 = 4;

/// A peer: its system and component ID.
pub type PlanPeer = (u8, u8);

/// Stored plans and the upload in progress.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanStore {
    plans: [Vec<MISSION_ITEM_INT_DATA>; 3],
    ids: [u32; 3],
    upload: Option<PlanUpload>,
    /// Peer, plan type and last item of the last finished upload, because its acknowledgment may have been lost.
    done: Option<(PlanPeer, MavMissionType, u16)>,
    ack_repeat: Option<AckRepeat>,
    /// Seconds of simulation time per second of the uploader's time.
    speed_factor: f64,
    /// Number of items at the start of a transferred mission that are not flown (home).
    lead: u16,
    /// Whether items specific to ArduPilot are accepted: such as splines and delays until a time of day.
    splines: bool,
    /// Whether zero coordinates in an item mean the vehicle's position at that time.
    zero_means_current_position: bool,
    /// Encoding to try first when requesting items.
    encoding: ItemEncoding,
}

/// The two messages that request an item in an upload. Clients support one or both of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ItemEncoding {
    /// Items are requested with MISSION_REQUEST_INT.
    #[default]
    Int,
    /// Items are requested with MISSION_REQUEST.
    Float,
}

impl ItemEncoding {
    fn other(self) -> Self {
        match self {
            Self::Int => Self::Float,
            Self::Float => Self::Int,
        }
    }
}

impl Default for PlanStore {
    fn default() -> Self {
        Self {
            plans: Default::default(),
            ids: [0; 3],
            upload: None,
            done: None,
            ack_repeat: None,
            speed_factor: 1.0,
            lead: 0,
            splines: false,
            zero_means_current_position: false,
            encoding: ItemEncoding::Int,
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
struct PlanUpload {
    from: PlanPeer,
    kind: MavMissionType,
    items: Vec<MISSION_ITEM_INT_DATA>,
    /// Whether the items replace part of the plan, starting at `first`.
    is_partial: bool,
    first: u16,
    count: u16,
    last_received: SimTime,
    last_request: SimTime,
    /// Whether a request had to be repeated, which means that the link loses datagrams.
    is_lossy: bool,
    encoding: ItemEncoding,
    /// Whether the current item was requested again, in which case its delay is meaningless.
    is_retry: bool,
    /// Number of unanswered requests since the last item.
    unanswered: u8,
    /// Usual delay between a request and its item, s.
    delay_s: Option<f64>,
    /// Sequence number of the last requested item: the first missing item, or an earlier one that lets an uploader
    /// catch up.
    requested: u16,
    /// Sequence number after an item that was received again without a request: the uploader may continue from there.
    set_back_to: Option<u16>,
    /// Whether such an item has arrived, which means that the link reorders or duplicates datagrams.
    reorders: bool,
}

impl PlanUpload {
    fn begin(from: PlanPeer, kind: MavMissionType, encoding: ItemEncoding, now: SimTime) -> Self {
        Self {
            from,
            kind,
            items: Vec::new(),
            is_partial: false,
            first: 0,
            count: 0,
            last_received: now,
            last_request: now,
            is_lossy: false,
            encoding,
            is_retry: false,
            unanswered: 0,
            delay_s: None,
            requested: 0,
            set_back_to: None,
            reorders: false,
        }
    }

    /// Returns the number of the first missing item.
    fn missing(&self) -> u16 {
        self.first + self.items.len() as u16
    }

    /// Handles an item that was already received. If the item was requested, requests the next one. Otherwise,
    /// `poll_retries` continues from it once the missing item is overdue. Requesting another item for every repeat
    /// would double all subsequent traffic, and clients that count repeats would give up.
    fn repeated(&mut self, seq: u16, now: SimTime) -> Option<MavMessage> {
        if seq == self.requested {
            (self.requested, self.last_request, self.is_retry, self.unanswered) = (seq + 1, now, true, 0);
            return Some(self.item_request());
        }
        (self.set_back_to, self.reorders) = (Some(seq + 1), true);
        None
    }

    /// Returns the number of the item to request after a timeout.
    fn overdue(&mut self) -> u16 {
        if let Some(seq) = self.set_back_to.take() {
            return seq;
        }
        match self.unanswered.checked_sub(STEP_BACK_THRESHOLD).filter(|_| self.reorders) {
            // Alternate with the missing item: a client that never repeats an item waits for that one.
            Some(turn) if turn.is_multiple_of(2) => {
                self.missing().saturating_sub(1 << (turn / 2 % MAX_STEPS_BACK)).max(self.first)
            }
            Some(_) => self.missing(),
            None => self.requested,
        }
    }

    /// Returns a request's timeout in seconds.
    fn retry_interval_s(&self, pace: f64) -> f64 {
        let usual_s = self.delay_s.map_or(RETRY_INTERVAL_S * pace, |delay_s| RETRY_DELAY_FACTOR * delay_s);
        usual_s.clamp(MIN_RETRY_INTERVAL_S * pace, RETRY_INTERVAL_S * pace)
    }

    /// Records that the expected item has arrived.
    fn record_item_arrival(&mut self, now: SimTime) {
        (self.unanswered, self.set_back_to) = (0, None);
        if !std::mem::take(&mut self.is_retry) {
            let delay_s = (now - self.last_request).s();
            self.delay_s = Some(self.delay_s.map_or(delay_s, |usual_s| usual_s + DELAY_WEIGHT * (delay_s - usual_s)));
        }
        self.last_request = now;
    }
}

/// A repeated acknowledgment for an upload over a lossy link. Clients wait for the acknowledgment without sending
/// anything (MAVSDK), so losing it would make a complete upload fail.
#[derive(Debug, Clone, PartialEq)]
struct AckRepeat {
    to: PlanPeer,
    message: MavMessage,
    sent: SimTime,
    left: u8,
}

/// Result of handling a message.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanReply {
    /// Send a reply.
    Reply(MavMessage),
    /// A plan was completed or cleared: send a reply and update the autopilot.
    Updated(MavMissionType, MavMessage),
    /// Do nothing.
    Nothing,
}

fn slot(kind: MavMissionType) -> Option<usize> {
    match kind {
        MavMissionType::MAV_MISSION_TYPE_MISSION => Some(0),
        MavMissionType::MAV_MISSION_TYPE_FENCE => Some(1),
        MavMissionType::MAV_MISSION_TYPE_RALLY => Some(2),
        MavMissionType::MAV_MISSION_TYPE_ALL => None,
    }
}

/// Creates an acknowledgment.
#[must_use]
pub fn ack(to: PlanPeer, kind: MavMissionType, result: MavMissionResult) -> MavMessage {
    ack_with_id(to, kind, result, 0)
}

/// Creates an acknowledgment with the ID of the accepted plan.
fn ack_with_id(to: PlanPeer, kind: MavMissionType, result: MavMissionResult, opaque_id: u32) -> MavMessage {
    MavMessage::MISSION_ACK(MISSION_ACK_DATA {
        target_system: to.0,
        target_component: to.1,
        mavtype: result,
        mission_type: kind,
        opaque_id,
    })
}

/// Returns the ID of a plan: the checksum of its items, never 0 for a plan with items.
fn id_of(items: &[MISSION_ITEM_INT_DATA]) -> u32 {
    if items.is_empty() {
        return 0;
    }
    let mut crc = crc32fast::Hasher::new();
    for item in items {
        let whole = [item.x, item.y, item.command as i32, item.frame as i32];
        let real = [item.param1, item.param2, item.param3, item.param4, item.z];
        whole.iter().for_each(|value| crc.update(&value.to_le_bytes()));
        real.iter().for_each(|value| crc.update(&value.to_bits().to_le_bytes()));
    }
    crc.finalize().max(1)
}

impl PlanStore {
    /// Creates an empty store. The first `lead` items of transferred missions (home) are not flown; stored items are
    /// numbered without these.
    #[must_use]
    pub fn with_lead_items(lead: u16) -> Self {
        Self { lead, ..Self::default() }
    }

    /// Sets whether missions may contain splines and delays until a time of day.
    #[must_use]
    pub fn with_splines(self, splines: bool) -> Self {
        Self { splines, ..self }
    }

    /// Sets whether zero coordinates mean the vehicle's position at that time.
    #[must_use]
    pub fn with_zero_as_current_position(self, zero_means_current_position: bool) -> Self {
        Self { zero_means_current_position, ..self }
    }

    /// Sets the encoding to try first when requesting items.
    #[must_use]
    pub fn with_encoding(self, encoding: ItemEncoding) -> Self {
        Self { encoding, ..self }
    }

    /// Returns the item for validation and conversion, with a placeholder for an open position.
    fn with_default_position(&self, item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane) -> MISSION_ITEM_INT_DATA {
        if self.zero_means_current_position { deferred_fields::with_placeholder(item, plane) } else { item.clone() }
    }

    /// Returns the fields that each mission item leaves open.
    #[must_use]
    pub fn deferred_fields(&self) -> Vec<DeferredFields> {
        if self.zero_means_current_position { self.plans[0].iter().map(deferred_fields::of).collect() } else { Vec::new() }
    }

    /// Requests further items in the encoding that an uploader used, unless the autopilot supports only one.
    pub fn use_encoding_of(&mut self, from: PlanPeer, encoding: ItemEncoding) {
        if let Some(upload) = self.upload.as_mut().filter(|u| u.from == from && self.encoding == ItemEncoding::Int) {
            upload.encoding = encoding;
        }
    }

    /// Switches the encoding for an uploader that does not support the current one, and returns the new request.
    pub fn switch_encoding(&mut self, from: PlanPeer, now: SimTime) -> Option<MavMessage> {
        let upload = self.upload.as_mut().filter(|u| u.from == from)?;
        upload.encoding = upload.encoding.other();
        upload.last_request = now;
        Some(upload.item_request())
    }

    /// Checks whether the fence contains a return point.
    #[must_use]
    pub fn has_fence_return(&self) -> bool {
        self.plans[1].iter().any(fence_and_rally::is_return)
    }

    /// Returns the number of items in a plan as transferred.
    fn count(&self, kind: MavMissionType, slot: usize) -> u16 {
        let stored = self.plans[slot].len() as u16;
        if stored == 0 { 0 } else { stored + self.lead(kind) }
    }

    /// Returns the number of items of this plan type that are not stored.
    fn lead(&self, kind: MavMissionType) -> u16 {
        if kind == MavMissionType::MAV_MISSION_TYPE_MISSION { self.lead } else { 0 }
    }

    /// Checks whether this is the home item of an existing mission.
    #[must_use]
    pub fn is_home(&self, kind: MavMissionType, seq: u16) -> bool {
        seq < self.lead(kind) && !self.plans[0].is_empty()
    }

    /// Sets the simulation speed, which scales the timeouts of uploaders that are not in lockstep.
    pub fn set_speed_factor(&mut self, pace: f64) {
        self.speed_factor = pace;
    }

    /// Returns the number of mission items, fence items and rally points, for the parameters.
    #[must_use]
    pub fn totals(&self) -> [u16; 3] {
        [self.count(MavMissionType::MAV_MISSION_TYPE_MISSION, 0), self.plans[1].len() as u16, self.plans[2].len() as u16]
    }

    /// Returns a summary of the plans.
    #[must_use]
    pub fn summary(&self) -> PlanSummary {
        PlanSummary { mission_items: self.plans[0].len() as u16, ids: self.ids, lead: self.lead }
    }

    /// Returns the fence's areas.
    #[must_use]
    pub fn zones(&self, plane: &LocalPlane) -> Vec<FenceZone> {
        fence_and_rally::zones(&self.plans[1], plane)
    }

    /// Returns the rally points.
    #[must_use]
    pub fn rally_points(&self, plane: &LocalPlane, home_up_m: f64) -> Vec<RallyPoint> {
        fence_and_rally::rally_points(&self.plans[2], plane, home_up_m)
    }

    /// Returns the mission items.
    #[must_use]
    pub fn mission(&self) -> &[MISSION_ITEM_INT_DATA] {
        &self.plans[0]
    }

    /// Appends an item to the mission.
    pub fn add(&mut self, item: MISSION_ITEM_INT_DATA) {
        let seq = self.plans[0].len() as u16;
        if seq < MAX_ITEMS {
            self.plans[0].push(MISSION_ITEM_INT_DATA { seq, ..item });
            self.ids[0] = id_of(&self.plans[0]);
        }
    }

    /// Deletes the mission.
    pub fn clear_mission(&mut self) {
        self.plans[0].clear();
        self.ids[0] = 0;
    }

    /// Handles a list request; returns the item count.
    #[must_use]
    pub fn list(&mut self, from: PlanPeer, kind: MavMissionType) -> MavMessage {
        self.stop_ack_repeats(from);
        let Some(slot) = slot(kind) else { return ack(from, kind, MavMissionResult::MAV_MISSION_UNSUPPORTED) };
        MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
            count: self.count(kind, slot),
            target_system: from.0,
            target_component: from.1,
            mission_type: kind,
            opaque_id: self.ids[slot],
        })
    }

    /// Handles an item request.
    #[must_use]
    pub fn item(&self, from: PlanPeer, kind: MavMissionType, seq: u16) -> MavMessage {
        let index = seq.checked_sub(self.lead(kind)).map(usize::from);
        let item = slot(kind).zip(index).and_then(|(slot, index)| self.plans[slot].get(index));
        match item {
            Some(item) => {
                let mut item = shift_sequence(item.clone(), i32::from(self.lead(kind)));
                (item.target_system, item.target_component) = from;
                MavMessage::MISSION_ITEM_INT(item)
            }
            None => ack(from, kind, MavMissionResult::MAV_MISSION_INVALID_SEQUENCE),
        }
    }

    /// Stops repeating the acknowledgment to a peer that sends another plan message: the peer has received the
    /// acknowledgment or no longer waits for it.
    fn stop_ack_repeats(&mut self, from: PlanPeer) {
        self.ack_repeat.take_if(|echo| echo.to == from);
    }

    /// Starts an upload. Rejected while another station is uploading.
    pub fn begin(&mut self, from: PlanPeer, kind: MavMissionType, count: u16, now: SimTime) -> PlanReply {
        self.stop_ack_repeats(from);
        let refuse = |result| PlanReply::Reply(ack(from, kind, result));
        if self.is_busy(from, now) {
            return refuse(MavMissionResult::MAV_MISSION_DENIED);
        }
        let Some(slot) = slot(kind) else { return refuse(MavMissionResult::MAV_MISSION_UNSUPPORTED) };
        if count > MAX_ITEMS {
            return refuse(MavMissionResult::MAV_MISSION_NO_SPACE);
        }
        self.done = None;
        if count == 0 {
            self.upload = None;
            self.plans[slot].clear();
            self.ids[slot] = 0;
            let done = ack(from, kind, MavMissionResult::MAV_MISSION_ACCEPTED);
            return PlanReply::Updated(kind, done);
        }
        let upload = PlanUpload { count, ..PlanUpload::begin(from, kind, self.encoding, now) };
        PlanReply::Reply(self.upload.insert(upload).item_request())
    }

    /// Starts a partial upload that replaces the existing items `first` to `last`.
    pub fn begin_partial(&mut self, from: PlanPeer, kind: MavMissionType, (first, last): (i16, i16), now: SimTime) -> PlanReply {
        self.stop_ack_repeats(from);
        let refuse = |result| PlanReply::Reply(ack(from, kind, result));
        if self.is_busy(from, now) {
            return refuse(MavMissionResult::MAV_MISSION_DENIED);
        }
        let Some(slot) = slot(kind) else { return refuse(MavMissionResult::MAV_MISSION_UNSUPPORTED) };
        let known = self.count(kind, slot);
        let (Ok(first), Ok(last)) = (u16::try_from(first), u16::try_from(last)) else {
            return refuse(MavMissionResult::MAV_MISSION_INVALID_SEQUENCE);
        };
        if first > last || last >= known {
            return refuse(MavMissionResult::MAV_MISSION_INVALID_SEQUENCE);
        }
        self.done = None;
        let upload = PlanUpload {
            is_partial: true,
            first,
            requested: first,
            count: last - first + 1,
            ..PlanUpload::begin(from, kind, self.encoding, now)
        };
        PlanReply::Reply(self.upload.insert(upload).item_request())
    }

    /// Checks whether another peer is uploading.
    fn is_busy(&self, from: PlanPeer, now: SimTime) -> bool {
        self.upload.as_ref().is_some_and(|u| u.from != from && (now - u.last_received).s() < STALL_TIMEOUT_S * self.speed_factor)
    }

    /// Handles an uploaded item.
    pub fn receive(&mut self, from: PlanPeer, item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane, now: SimTime) -> PlanReply {
        let lead = self.lead(item.mission_type);
        let checked = self.with_default_position(item, plane);
        let Some(upload) = self.upload.as_mut().filter(|u| u.from == from && u.kind == item.mission_type) else {
            return self.reply_without_upload(from, item);
        };
        upload.last_received = now;
        let missing = upload.missing();
        if item.seq < missing && item.seq >= upload.first {
            return upload.repeated(item.seq, now).map_or(PlanReply::Nothing, PlanReply::Reply);
        }
        if item.seq != missing {
            // Out of order: the missing item has been requested, and `poll_retries` requests it again.
            return PlanReply::Nothing;
        }
        upload.record_item_arrival(now);
        let stored = slot(upload.kind).map_or(0, |slot| self.plans[slot].len());
        let total = if upload.is_partial { stored as u16 + lead } else { upload.count };
        // The home item is ignored: the vehicle keeps its own home.
        let spline = item.command == MavCmd::MAV_CMD_NAV_SPLINE_WAYPOINT && !self.splines;
        let day = item.command == MavCmd::MAV_CMD_NAV_DELAY && item.param1 < 0.0 && !self.splines;
        let unknown = spline.then_some(MavMissionResult::MAV_MISSION_UNSUPPORTED);
        let unknown = unknown.or(day.then_some(MavMissionResult::MAV_MISSION_INVALID_PARAM1));
        let refusal =
            if missing < lead { None } else { unknown.or_else(|| items::check_item(&checked, lead..total, plane).err()) };
        if let Some(result) = refusal {
            let kind = upload.kind;
            self.upload = None;
            return PlanReply::Reply(ack(from, kind, result));
        }
        let mut item = item.clone();
        item.current = 0;
        upload.items.push(item);
        upload.requested = upload.missing();
        if (upload.items.len() as u16) < upload.count {
            return PlanReply::Reply(upload.item_request());
        }
        self.upload.take().map_or(PlanReply::Nothing, |upload| self.complete(upload, now))
    }

    /// Finishes an upload once all items have arrived.
    fn complete(&mut self, upload: PlanUpload, now: SimTime) -> PlanReply {
        let PlanUpload { from, kind, items, first, is_partial: part, is_lossy: loses, .. } = upload;
        let Some(slot) = slot(kind) else { return PlanReply::Nothing };
        let lead = self.lead(kind);
        let mut whole = if part { self.plans[slot].clone() } else { Vec::new() };
        let last = first + items.len().saturating_sub(1) as u16;
        let flown = items.into_iter().skip(usize::from(lead.saturating_sub(first)));
        let items: Vec<_> = flown.map(|item| shift_sequence(item, -i32::from(lead))).collect();
        let first = usize::from(first.saturating_sub(lead));
        let until = (first + items.len()).min(whole.len());
        whole.splice(first.min(until)..until, items);
        if let Err(result) = fence_and_rally::is_complete(&whole).and_then(|()| items::whole(&whole)) {
            return PlanReply::Reply(ack(from, kind, result));
        }
        self.ids[slot] = id_of(&whole);
        self.plans[slot] = whole;
        self.done = Some((from, kind, last));
        let done = ack_with_id(from, kind, MavMissionResult::MAV_MISSION_ACCEPTED, self.ids[slot]);
        self.ack_repeat = loses.then(|| AckRepeat { to: from, message: done.clone(), sent: now, left: ACK_REPEAT_COUNT });
        PlanReply::Updated(kind, done)
    }

    /// Handles an item without an upload in progress. This is an error unless it repeats an item from the plan that
    /// this peer has just finished. A repeat of the last item means that the acknowledgment was lost. A repeat of an
    /// earlier item was only delayed, and an error would invalidate the acknowledgment in transit.
    fn reply_without_upload(&self, from: PlanPeer, item: &MISSION_ITEM_INT_DATA) -> PlanReply {
        let last = self.done.filter(|&(peer, kind, _)| (peer, kind) == (from, item.mission_type)).map(|(_, _, last)| last);
        match last.filter(|_| self.matches_stored(item)) {
            Some(last) if item.seq < last => PlanReply::Nothing,
            Some(last) if item.seq == last => {
                PlanReply::Reply(ack(from, item.mission_type, MavMissionResult::MAV_MISSION_ACCEPTED))
            }
            _ => PlanReply::Reply(ack(from, item.mission_type, MavMissionResult::MAV_MISSION_ERROR)),
        }
    }

    /// Checks whether a received item matches the stored item with its number.
    fn matches_stored(&self, item: &MISSION_ITEM_INT_DATA) -> bool {
        let lead = self.lead(item.mission_type);
        let index = item.seq.checked_sub(lead).map(usize::from);
        let stored = slot(item.mission_type).zip(index).and_then(|(slot, index)| self.plans[slot].get(index));
        // NaN fields never compare equal: compare position and command only.
        let same = |stored: &MISSION_ITEM_INT_DATA| {
            (stored.seq + lead, stored.command, stored.frame, stored.x, stored.y)
                == (item.seq, item.command, item.frame, item.x, item.y)
        };
        // Home is not stored: any home item matches.
        item.seq < lead || stored.is_some_and(same)
    }

    /// Rejects an upload that contains an item the dialect cannot represent (unknown command or frame).
    pub fn receive_undefined_item(&mut self, from: PlanPeer) -> PlanReply {
        match self.upload.take_if(|u| u.from == from) {
            Some(upload) => PlanReply::Reply(ack(from, upload.kind, MavMissionResult::MAV_MISSION_UNSUPPORTED)),
            None => PlanReply::Nothing,
        }
    }

    /// Clears plans.
    pub fn clear(&mut self, from: PlanPeer, kind: MavMissionType) -> PlanReply {
        self.stop_ack_repeats(from);
        self.upload.take_if(|u| u.from == from);
        self.done = None;
        match slot(kind) {
            Some(slot) => {
                self.plans[slot].clear();
                self.ids[slot] = 0;
            }
            None => {
                self.plans.iter_mut().for_each(Vec::clear);
                self.ids = [0; 3];
            }
        }
        let done = ack(from, kind, MavMissionResult::MAV_MISSION_ACCEPTED);
        PlanReply::Updated(kind, done)
    }

    /// Ends an upload that the client canceled or finished.
    pub fn acknowledged(&mut self, from: PlanPeer) {
        self.upload.take_if(|u| u.from == from);
    }

    /// Repeats an overdue request, cancels a stalled upload, or repeats an acknowledgment. Returns the message and its
    /// recipient.
    pub fn poll_retries(&mut self, now: SimTime) -> Option<(PlanPeer, MavMessage)> {
        let Some(upload) = self.upload.as_mut() else { return self.repeat_acknowledgment(now) };
        let (from, kind) = (upload.from, upload.kind);
        if (now - upload.last_received).s() > STALL_TIMEOUT_S * self.speed_factor {
            self.upload = None;
            return Some((from, ack(from, kind, MavMissionResult::MAV_MISSION_OPERATION_CANCELLED)));
        }
        if (now - upload.last_request).s() > upload.retry_interval_s(self.speed_factor) {
            upload.last_request = now;
            (upload.is_lossy, upload.is_retry) = (true, true);
            upload.unanswered = upload.unanswered.saturating_add(1);
            upload.requested = upload.overdue();
            // A client that has not sent any item yet may support only the other encoding. On a lossy link, most
            // clients support the first.
            if upload.items.is_empty() && self.encoding == ItemEncoding::Int {
                upload.encoding = if upload.unanswered.is_multiple_of(ENCODING_SWITCH_RETRIES) {
                    ItemEncoding::Float
                } else {
                    ItemEncoding::Int
                };
            }
            return Some((from, upload.item_request()));
        }
        None
    }

    fn repeat_acknowledgment(&mut self, now: SimTime) -> Option<(PlanPeer, MavMessage)> {
        let echo = self.ack_repeat.as_mut()?;
        if (now - echo.sent).s() <= RETRY_INTERVAL_S * self.speed_factor {
            return None;
        }
        (echo.sent, echo.left) = (now, echo.left - 1);
        let again = (echo.to, echo.message.clone());
        self.ack_repeat.take_if(|echo| echo.left == 0);
        Some(again)
    }

    /// Returns the mission as autopilot steps. `home_m` is home's position relative to the origin in meters.
    #[must_use]
    pub fn steps(&self, plane: &LocalPlane, home_m: Option<Vec3<Ned>>) -> Vec<MissionStep> {
        let all = &self.plans[0];
        let home_up_m = home_m.map_or(0.0, |home| -home.down());
        let step =
            |k| Some(items::step(&self.with_default_position(&items::resolve_next_waypoint(all, k)?, plane), plane, home_up_m));
        let mut steps: Vec<MissionStep> = (0..all.len()).filter_map(step).collect();
        deferred_fields::fill_from_previous_steps(&mut steps, &self.deferred_fields(), home_m);
        steps
    }

    /// Returns whether the altitude of each mission item is relative to home.
    #[must_use]
    pub fn home_relative_steps(&self) -> Vec<bool> {
        self.plans[0].iter().map(|item| relative(item.frame) == Some(true)).collect()
    }
}

/// Shifts an item's sequence number and a jump's target by `by`.
fn shift_sequence(mut item: MISSION_ITEM_INT_DATA, by: i32) -> MISSION_ITEM_INT_DATA {
    item.seq = (i32::from(item.seq) + by).max(0) as u16;
    if item.command == MavCmd::MAV_CMD_DO_JUMP {
        item.param1 = (item.param1 + by as f32).max(0.0);
    }
    item
}

impl PlanUpload {
    /// Creates the request for the next item.
    fn item_request(&self) -> MavMessage {
        let seq = self.requested;
        let ((target_system, target_component), mission_type) = (self.from, self.kind);
        match self.encoding {
            ItemEncoding::Int => {
                MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA { seq, target_system, target_component, mission_type })
            }
            ItemEncoding::Float => {
                MavMessage::MISSION_REQUEST(MISSION_REQUEST_DATA { seq, target_system, target_component, mission_type })
            }
        }
    }
}
