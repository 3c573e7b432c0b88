//! Plans: upload, whole or in part, and download of missions, fences and rally points.
#![allow(deprecated, reason = "clients still know MISSION_REQUEST alone")]

use super::mission_positions::relative;
use super::snapshot::PlanSummary;
use super::{deferred_fields, fence_and_rally, items};
use crate::autopilot::MissionStep;
use crate::autopilot::fence::{FenceZone, RallyPoint};
use crate::autopilot::mission::DeferredFields;
use spandrel_mavlink::dialect::{
    MISSION_ACK_DATA, MISSION_COUNT_DATA, MISSION_ITEM_INT_DATA, MISSION_REQUEST_DATA, MISSION_REQUEST_INT_DATA, MavCmd,
    MavMessage, MavMissionResult, MavMissionType,
};
use spandrel_model::frames::{Ned, Vec3};
use spandrel_model::geodesy::LocalPlane;
use spandrel_model::time::SimTime;

/// Items that a plan may have.
const MOST_ITEMS: u16 = 2_000;
/// A stalled upload is given up after this long, s (clients retry for less).
const STALL_S: f64 = 10.0;
/// One in so many requests for a first item that does not come goes out in the other form (estimate: a second at the usual patience).
const OTHER_FORM_EVERY: u8 = 4;
/// A silent uploader is asked again after this long, s, as PX4 does it.
const ASK_AGAIN_S: f64 = 0.25;
/// One whose answers come sooner is asked again sooner: after so many times its usual delay, but not before this, s. MAVSDK gives an item up
/// after five half-seconds without a request; at 0.25 s only one repetition fits into each.
const OVERDUE: f64 = 4.0;
const ASK_AGAIN_SOONEST_S: f64 = 0.12;
/// Requests without an answer after which earlier items are requested on a link that reorders datagrams, each time further back: an uploader that
/// a delayed request has set back ignores requests for later items (MAVSDK). Fewer would use up MAVSDK's five attempts where requests are only lost.
const STEP_BACK_AFTER: u8 = 4;
/// Number of steps, each twice as far as the last: up to 128 items back, more than pass while a request is delayed.
const STEPS_BACK: u8 = 8;
/// Weight of the newest delay in the usual one.
const DELAY_WEIGHT: f64 = 0.25;
/// So often the acknowledgement of an upload that has lost something is sent again.
const ACKNOWLEDGED_AGAIN: u8 = 4;

/// Who speaks: system and component.
pub type PlanPeer = (u8, u8);

/// Plans and a running upload.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanStore {
    plans: [Vec<MISSION_ITEM_INT_DATA>; 3],
    ids: [u32; 3],
    upload: Option<PlanUpload>,
    /// Who finished an upload last, with which item: the acknowledgement may have been lost.
    done: Option<(PlanPeer, MavMissionType, u16)>,
    ack_repeat: Option<AckRepeat>,
    /// Seconds of simulation time in a second of the uploader's.
    speed_factor: f64,
    /// Items of the wire's mission before the first that is flown.
    lead: u16,
    /// Items that ArduPilot alone has are taken: splines, delays until a time of day.
    splines: bool,
    /// What is 0 in an item is where the vehicle is then.
    zero_is_here: bool,
    /// In which form items are asked for first.
    form: ItemEncoding,
}

/// The two messages by which an item of an upload is asked for. Clients know both, or one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ItemEncoding {
    /// MISSION_REQUEST_INT.
    #[default]
    Int,
    /// MISSION_REQUEST.
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
            zero_is_here: false,
            form: ItemEncoding::Int,
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
struct PlanUpload {
    from: PlanPeer,
    kind: MavMissionType,
    items: Vec<MISSION_ITEM_INT_DATA>,
    /// The items replace a part of the plan, from this place on.
    part: bool,
    first: u16,
    count: u16,
    last_received: SimTime,
    last_request: SimTime,
    /// Something had to be asked for again: the link loses datagrams.
    is_lossy: bool,
    form: ItemEncoding,
    /// So it is for the item that is waited for: its delay tells nothing.
    is_retry: bool,
    /// Requests since the last item without an answer.
    unanswered: u8,
    /// Usual time from a request to its item, s.
    delay_s: Option<f64>,
    /// Number of the item that was requested last: the first that is missing, or an earlier one that leads a set-back uploader on.
    requested: u16,
    /// Number after that of an item which arrived again without a request: perhaps the uploader goes on from there.
    set_back_to: Option<u16>,
    /// Such an item has arrived: the link reorders or duplicates datagrams.
    reorders: bool,
}

impl PlanUpload {
    fn begin(from: PlanPeer, kind: MavMissionType, form: ItemEncoding, now: SimTime) -> Self {
        Self {
            from,
            kind,
            items: Vec::new(),
            part: false,
            first: 0,
            count: 0,
            last_received: now,
            last_request: now,
            is_lossy: false,
            form,
            is_retry: false,
            unanswered: 0,
            delay_s: None,
            requested: 0,
            set_back_to: None,
            reorders: false,
        }
    }

    /// Number of the first item that has not arrived.
    fn missing(&self) -> u16 {
        self.first + self.items.len() as u16
    }

    /// An item that the vehicle already has. If it was requested, the next one is due; else `poll_retries` goes on from it once the missing item is
    /// overdue. A request at every repeated item would double all that follows, and clients that count repetitions give up.
    fn repeated(&mut self, seq: u16, now: SimTime) -> Option<MavMessage> {
        if seq == self.requested {
            (self.requested, self.last_request, self.is_retry, self.unanswered) = (seq + 1, now, true, 0);
            return Some(self.question());
        }
        (self.set_back_to, self.reorders) = (Some(seq + 1), true);
        None
    }

    /// Number of the item to request when nothing has answered the last request.
    fn overdue(&mut self) -> u16 {
        if let Some(seq) = self.set_back_to.take() {
            return seq;
        }
        match self.unanswered.checked_sub(STEP_BACK_AFTER).filter(|_| self.reorders) {
            // Every other request is for the missing item: a client that never repeats an item waits for that one.
            Some(turn) if turn.is_multiple_of(2) => self.missing().saturating_sub(1 << (turn / 2 % STEPS_BACK)).max(self.first),
            Some(_) => self.missing(),
            None => self.requested,
        }
    }

    /// An answer is overdue this long after the request, s.
    fn patience_s(&self, pace: f64) -> f64 {
        let usual_s = self.delay_s.map_or(ASK_AGAIN_S * pace, |delay_s| OVERDUE * delay_s);
        usual_s.clamp(ASK_AGAIN_SOONEST_S * pace, ASK_AGAIN_S * pace)
    }

    /// The item that was waited for has come.
    fn answered(&mut self, now: SimTime) {
        (self.unanswered, self.set_back_to) = (0, None);
        if !std::mem::take(&mut self.is_retry) {
            let delay_s = (now - self.last_request).s();
            self.delay_s = Some(self.delay_s.map_or(delay_s, |usual_s| usual_s + DELAY_WEIGHT * (delay_s - usual_s)));
        }
        self.last_request = now;
    }
}

/// The acknowledgement of an upload over a link that loses datagrams. It is sent again: clients only wait for it (MAVSDK), so that a lost
/// one would undo an upload that was complete.
#[derive(Debug, Clone, PartialEq)]
struct AckRepeat {
    to: PlanPeer,
    message: MavMessage,
    sent: SimTime,
    left: u8,
}

/// What came of a message.
#[derive(Debug, Clone, PartialEq)]
pub enum PlanReply {
    /// Answer the sender.
    Say(MavMessage),
    /// A plan is complete or gone: answer, and let the autopilot have it.
    New(MavMissionType, MavMessage),
    /// Nothing.
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

/// An acknowledgement to a peer.
#[must_use]
pub fn ack(to: PlanPeer, kind: MavMissionType, result: MavMissionResult) -> MavMessage {
    ack_with(to, kind, result, 0)
}

/// An acknowledgement with the id of the plan that is accepted.
fn ack_with(to: PlanPeer, kind: MavMissionType, result: MavMissionResult, opaque_id: u32) -> MavMessage {
    MavMessage::MISSION_ACK(MISSION_ACK_DATA {
        target_system: to.0,
        target_component: to.1,
        mavtype: result,
        mission_type: kind,
        opaque_id,
    })
}

/// A plan's id: the checksum of its items, never 0 for a plan that has some.
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
    /// No plans yet; so many items of the wire's missions (home) are not flown. What is kept is
    /// numbered without them.
    #[must_use]
    pub fn with_lead_items(lead: u16) -> Self {
        Self { lead, ..Self::default() }
    }

    /// Whether splines and delays until a time of day are taken in missions.
    #[must_use]
    pub fn with_splines(self, splines: bool) -> Self {
        Self { splines, ..self }
    }

    /// Whether 0 in an item is where the vehicle is then.
    #[must_use]
    pub fn with_zero_as_here(self, zero_is_here: bool) -> Self {
        Self { zero_is_here, ..self }
    }

    /// The form in which items are asked for first.
    #[must_use]
    pub fn with_encoding(self, form: ItemEncoding) -> Self {
        Self { form, ..self }
    }

    /// The item as it is judged and flown: with a place in the stead of one that is left open.
    fn with_default_position(&self, item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane) -> MISSION_ITEM_INT_DATA {
        if self.zero_is_here { deferred_fields::filled(item, plane) } else { item.clone() }
    }

    /// What each item of the mission leaves open.
    #[must_use]
    pub fn deferred_fields(&self) -> Vec<DeferredFields> {
        if self.zero_is_here { self.plans[0].iter().map(deferred_fields::of).collect() } else { Vec::new() }
    }

    /// An uploader has sent an item in a form: it is asked in the same one, unless the autopilot knows only one.
    pub fn note_form(&mut self, from: PlanPeer, form: ItemEncoding) {
        if let Some(upload) = self.upload.as_mut().filter(|u| u.from == from && self.form == ItemEncoding::Int) {
            upload.form = form;
        }
    }

    /// An uploader does not know the form in which it was asked: the question in the other one.
    pub fn switch_encoding(&mut self, from: PlanPeer, now: SimTime) -> Option<MavMessage> {
        let upload = self.upload.as_mut().filter(|u| u.from == from)?;
        upload.form = upload.form.other();
        upload.last_request = now;
        Some(upload.question())
    }

    /// The fence names a place to return to.
    #[must_use]
    pub fn has_fence_return(&self) -> bool {
        self.plans[1].iter().any(fence_and_rally::is_return)
    }

    /// Items of a plan as the wire counts them.
    fn count(&self, kind: MavMissionType, slot: usize) -> u16 {
        let kept = self.plans[slot].len() as u16;
        if kept == 0 { 0 } else { kept + self.lead(kind) }
    }

    /// Items of a plan of this kind that are not kept.
    fn lead(&self, kind: MavMissionType) -> u16 {
        if kind == MavMissionType::MAV_MISSION_TYPE_MISSION { self.lead } else { 0 }
    }

    /// Whether this is home's item of a mission that is there.
    #[must_use]
    pub fn is_home(&self, kind: MavMissionType, seq: u16) -> bool {
        seq < self.lead(kind) && !self.plans[0].is_empty()
    }

    /// Uploaders that are not kept in step take longer by this factor.
    pub fn set_speed_factor(&mut self, pace: f64) {
        self.speed_factor = pace;
    }

    /// Items of mission, fence and rally points, as parameters show them.
    #[must_use]
    pub fn totals(&self) -> [u16; 3] {
        [self.count(MavMissionType::MAV_MISSION_TYPE_MISSION, 0), self.plans[1].len() as u16, self.plans[2].len() as u16]
    }

    /// What stations see of the plans.
    #[must_use]
    pub fn summary(&self) -> PlanSummary {
        PlanSummary { mission_items: self.plans[0].len() as u16, ids: self.ids, lead: self.lead }
    }

    /// The fence's areas.
    #[must_use]
    pub fn zones(&self, plane: &LocalPlane) -> Vec<FenceZone> {
        fence_and_rally::zones(&self.plans[1], plane)
    }

    /// The rally points.
    #[must_use]
    pub fn rally_points(&self, plane: &LocalPlane, home_up_m: f64) -> Vec<RallyPoint> {
        fence_and_rally::rally_points(&self.plans[2], plane, home_up_m)
    }

    /// Items of the mission.
    #[must_use]
    pub fn mission(&self) -> &[MISSION_ITEM_INT_DATA] {
        &self.plans[0]
    }

    /// Adds an item at the end of the mission.
    pub fn add(&mut self, item: MISSION_ITEM_INT_DATA) {
        let seq = self.plans[0].len() as u16;
        if seq < MOST_ITEMS {
            self.plans[0].push(MISSION_ITEM_INT_DATA { seq, ..item });
            self.ids[0] = id_of(&self.plans[0]);
        }
    }

    /// No mission is kept any more.
    pub fn drop_mission(&mut self) {
        self.plans[0].clear();
        self.ids[0] = 0;
    }

    /// Somebody wants the list.
    #[must_use]
    pub fn list(&mut self, from: PlanPeer, kind: MavMissionType) -> MavMessage {
        self.forget_acknowledged(from);
        let Some(slot) = slot(kind) else { return ack(from, kind, MavMissionResult::MAV_MISSION_UNSUPPORTED) };
        MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
            count: self.count(kind, slot),
            target_system: from.0,
            target_component: from.1,
            mission_type: kind,
            opaque_id: self.ids[slot],
        })
    }

    /// Somebody wants one item.
    #[must_use]
    pub fn item(&self, from: PlanPeer, kind: MavMissionType, seq: u16) -> MavMessage {
        let index = seq.checked_sub(self.lead(kind)).map(usize::from);
        let item = slot(kind).zip(index).and_then(|(slot, index)| self.plans[slot].get(index));
        match item {
            Some(item) => {
                let mut item = renumbered(item.clone(), i32::from(self.lead(kind)));
                (item.target_system, item.target_component) = from;
                MavMessage::MISSION_ITEM_INT(item)
            }
            None => ack(from, kind, MavMissionResult::MAV_MISSION_INVALID_SEQUENCE),
        }
    }

    /// A peer says something new about plans: it has its acknowledgement, or waits for it no more.
    fn forget_acknowledged(&mut self, from: PlanPeer) {
        self.ack_repeat.take_if(|echo| echo.to == from);
    }

    /// Somebody begins an upload. A second station in the middle of one is refused.
    pub fn begin(&mut self, from: PlanPeer, kind: MavMissionType, count: u16, now: SimTime) -> PlanReply {
        self.forget_acknowledged(from);
        let refuse = |result| PlanReply::Say(ack(from, kind, result));
        if self.is_busy(from, now) {
            return refuse(MavMissionResult::MAV_MISSION_DENIED);
        }
        let Some(slot) = slot(kind) else { return refuse(MavMissionResult::MAV_MISSION_UNSUPPORTED) };
        if count > MOST_ITEMS {
            return refuse(MavMissionResult::MAV_MISSION_NO_SPACE);
        }
        self.done = None;
        if count == 0 {
            self.upload = None;
            self.plans[slot].clear();
            self.ids[slot] = 0;
            let done = ack(from, kind, MavMissionResult::MAV_MISSION_ACCEPTED);
            return PlanReply::New(kind, done);
        }
        let upload = PlanUpload { count, ..PlanUpload::begin(from, kind, self.form, now) };
        PlanReply::Say(self.upload.insert(upload).question())
    }

    /// Somebody replaces the items from `first` to `last`, which are there.
    pub fn begin_part(&mut self, from: PlanPeer, kind: MavMissionType, (first, last): (i16, i16), now: SimTime) -> PlanReply {
        self.forget_acknowledged(from);
        let refuse = |result| PlanReply::Say(ack(from, kind, result));
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
            part: true,
            first,
            requested: first,
            count: last - first + 1,
            ..PlanUpload::begin(from, kind, self.form, now)
        };
        PlanReply::Say(self.upload.insert(upload).question())
    }

    /// Somebody else is in the middle of an upload.
    fn is_busy(&self, from: PlanPeer, now: SimTime) -> bool {
        self.upload.as_ref().is_some_and(|u| u.from != from && (now - u.last_received).s() < STALL_S * self.speed_factor)
    }

    /// An item of an upload.
    pub fn receive(&mut self, from: PlanPeer, item: &MISSION_ITEM_INT_DATA, plane: &LocalPlane, now: SimTime) -> PlanReply {
        let lead = self.lead(item.mission_type);
        let judged = self.with_default_position(item, plane);
        let Some(upload) = self.upload.as_mut().filter(|u| u.from == from && u.kind == item.mission_type) else {
            return self.reply_without_upload(from, item);
        };
        upload.last_received = now;
        let wanted = upload.missing();
        if item.seq < wanted && item.seq >= upload.first {
            return upload.repeated(item.seq, now).map_or(PlanReply::Nothing, PlanReply::Say);
        }
        if item.seq != wanted {
            // Out of turn: the missing item has been requested, and `poll_retries` requests it again.
            return PlanReply::Nothing;
        }
        upload.answered(now);
        let kept = slot(upload.kind).map_or(0, |slot| self.plans[slot].len());
        let total = if upload.part { kept as u16 + lead } else { upload.count };
        // Home is the vehicle's own, whatever is sent for it.
        let spline = item.command == MavCmd::MAV_CMD_NAV_SPLINE_WAYPOINT && !self.splines;
        let day = item.command == MavCmd::MAV_CMD_NAV_DELAY && item.param1 < 0.0 && !self.splines;
        let unknown = spline.then_some(MavMissionResult::MAV_MISSION_UNSUPPORTED);
        let unknown = unknown.or(day.then_some(MavMissionResult::MAV_MISSION_INVALID_PARAM1));
        let refusal = if wanted < lead { None } else { unknown.or_else(|| items::check_item(&judged, lead..total, plane).err()) };
        if let Some(result) = refusal {
            let kind = upload.kind;
            self.upload = None;
            return PlanReply::Say(ack(from, kind, result));
        }
        let mut item = item.clone();
        item.current = 0;
        upload.items.push(item);
        upload.requested = upload.missing();
        if (upload.items.len() as u16) < upload.count {
            return PlanReply::Say(upload.question());
        }
        self.upload.take().map_or(PlanReply::Nothing, |upload| self.complete(upload, now))
    }

    /// All items have come.
    fn complete(&mut self, upload: PlanUpload, now: SimTime) -> PlanReply {
        let PlanUpload { from, kind, items, first, part, is_lossy: loses, .. } = upload;
        let Some(slot) = slot(kind) else { return PlanReply::Nothing };
        let lead = self.lead(kind);
        let mut whole = if part { self.plans[slot].clone() } else { Vec::new() };
        let last = first + items.len().saturating_sub(1) as u16;
        let flown = items.into_iter().skip(usize::from(lead.saturating_sub(first)));
        let items: Vec<_> = flown.map(|item| renumbered(item, -i32::from(lead))).collect();
        let first = usize::from(first.saturating_sub(lead));
        let until = (first + items.len()).min(whole.len());
        whole.splice(first.min(until)..until, items);
        if let Err(result) = fence_and_rally::is_complete(&whole).and_then(|()| items::whole(&whole)) {
            return PlanReply::Say(ack(from, kind, result));
        }
        self.ids[slot] = id_of(&whole);
        self.plans[slot] = whole;
        self.done = Some((from, kind, last));
        let done = ack_with(from, kind, MavMissionResult::MAV_MISSION_ACCEPTED, self.ids[slot]);
        self.ack_repeat = loses.then(|| AckRepeat { to: from, message: done.clone(), sent: now, left: ACKNOWLEDGED_AGAIN });
        PlanReply::New(kind, done)
    }

    /// An item outside of an upload: an error, unless it repeats one of the plan that this peer has just finished. Its last item means that the
    /// acknowledgement was lost; an earlier one was only delayed, and an error would undo the acknowledgement that is under way.
    fn reply_without_upload(&self, from: PlanPeer, item: &MISSION_ITEM_INT_DATA) -> PlanReply {
        let last = self.done.filter(|&(peer, kind, _)| (peer, kind) == (from, item.mission_type)).map(|(_, _, last)| last);
        match last.filter(|_| self.is_kept(item)) {
            Some(last) if item.seq < last => PlanReply::Nothing,
            Some(last) if item.seq == last => {
                PlanReply::Say(ack(from, item.mission_type, MavMissionResult::MAV_MISSION_ACCEPTED))
            }
            _ => PlanReply::Say(ack(from, item.mission_type, MavMissionResult::MAV_MISSION_ERROR)),
        }
    }

    /// Whether an item of the wire is the one that is kept under its number.
    fn is_kept(&self, item: &MISSION_ITEM_INT_DATA) -> bool {
        let lead = self.lead(item.mission_type);
        let index = item.seq.checked_sub(lead).map(usize::from);
        let kept = slot(item.mission_type).zip(index).and_then(|(slot, index)| self.plans[slot].get(index));
        // Not-a-number fields differ from themselves: place and command decide.
        let same = |kept: &MISSION_ITEM_INT_DATA| {
            (kept.seq + lead, kept.command, kept.frame, kept.x, kept.y) == (item.seq, item.command, item.frame, item.x, item.y)
        };
        // Home is not kept: any item for it is the same.
        item.seq < lead || kept.is_some_and(same)
    }

    /// An item that the dialect cannot hold (unknown command or frame) ends the upload.
    pub fn receive_unknown(&mut self, from: PlanPeer) -> PlanReply {
        match self.upload.take_if(|u| u.from == from) {
            Some(upload) => PlanReply::Say(ack(from, upload.kind, MavMissionResult::MAV_MISSION_UNSUPPORTED)),
            None => PlanReply::Nothing,
        }
    }

    /// Empties plans.
    pub fn clear(&mut self, from: PlanPeer, kind: MavMissionType) -> PlanReply {
        self.forget_acknowledged(from);
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
        PlanReply::New(kind, done)
    }

    /// The uploader has given up or finished.
    pub fn acknowledged(&mut self, from: PlanPeer) {
        self.upload.take_if(|u| u.from == from);
    }

    /// Asks a silent uploader again, gives up a stalled upload, or acknowledges one again; returns whom to send what.
    pub fn poll_retries(&mut self, now: SimTime) -> Option<(PlanPeer, MavMessage)> {
        let Some(upload) = self.upload.as_mut() else { return self.acknowledge_again(now) };
        let (from, kind) = (upload.from, upload.kind);
        if (now - upload.last_received).s() > STALL_S * self.speed_factor {
            self.upload = None;
            return Some((from, ack(from, kind, MavMissionResult::MAV_MISSION_OPERATION_CANCELLED)));
        }
        if (now - upload.last_request).s() > upload.patience_s(self.speed_factor) {
            upload.last_request = now;
            (upload.is_lossy, upload.is_retry) = (true, true);
            upload.unanswered = upload.unanswered.saturating_add(1);
            upload.requested = upload.overdue();
            // A client that has sent none yet may know only the other form. On a link that loses datagrams most know the first.
            if upload.items.is_empty() && self.form == ItemEncoding::Int {
                upload.form =
                    if upload.unanswered.is_multiple_of(OTHER_FORM_EVERY) { ItemEncoding::Float } else { ItemEncoding::Int };
            }
            return Some((from, upload.question()));
        }
        None
    }

    fn acknowledge_again(&mut self, now: SimTime) -> Option<(PlanPeer, MavMessage)> {
        let echo = self.ack_repeat.as_mut()?;
        if (now - echo.sent).s() <= ASK_AGAIN_S * self.speed_factor {
            return None;
        }
        (echo.sent, echo.left) = (now, echo.left - 1);
        let again = (echo.to, echo.message.clone());
        self.ack_repeat.take_if(|echo| echo.left == 0);
        Some(again)
    }

    /// The mission as the autopilot flies it. `home_m` is home about the origin.
    #[must_use]
    pub fn steps(&self, plane: &LocalPlane, home_m: Option<Vec3<Ned>>) -> Vec<MissionStep> {
        let all = &self.plans[0];
        let home_up_m = home_m.map_or(0.0, |home| -home.down());
        let step = |k| Some(items::step(&self.with_default_position(&items::aimed(all, k)?, plane), plane, home_up_m));
        let mut steps: Vec<MissionStep> = (0..all.len()).filter_map(step).collect();
        deferred_fields::assume_previous_positions(&mut steps, &self.deferred_fields(), home_m);
        steps
    }

    /// Which items of the mission give their height over home.
    #[must_use]
    pub fn home_relative_steps(&self) -> Vec<bool> {
        self.plans[0].iter().map(|item| relative(item.frame) == Some(true)).collect()
    }
}

/// An item with its number, and that of a jump's aim, moved by so much.
fn renumbered(mut item: MISSION_ITEM_INT_DATA, by: i32) -> MISSION_ITEM_INT_DATA {
    item.seq = (i32::from(item.seq) + by).max(0) as u16;
    if item.command == MavCmd::MAV_CMD_DO_JUMP {
        item.param1 = (item.param1 + by as f32).max(0.0);
    }
    item
}

impl PlanUpload {
    /// Requests an item.
    fn question(&self) -> MavMessage {
        let seq = self.requested;
        let ((target_system, target_component), mission_type) = (self.from, self.kind);
        match self.form {
            ItemEncoding::Int => {
                MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA { seq, target_system, target_component, mission_type })
            }
            ItemEncoding::Float => {
                MavMessage::MISSION_REQUEST(MISSION_REQUEST_DATA { seq, target_system, target_component, mission_type })
            }
        }
    }
}
