//! MAVLink 2 message signing (<https://mavlink.io/en/guide/message_signing.html>): signs frames, verifies them, and rejects
//! replayed frames.

use super::checksum::checksum;
use super::codec::ReceivedFrame;
use super::dialect::MavMessage;
use mavlink::Message;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Layout of a MAVLink 2 frame: start byte, offset of the incompatibility flags, offset of the message ID, header length.
const STX: u8 = 0xFD;
const FLAGS_OFFSET: usize = 2;
const MESSAGE_ID_OFFSET: usize = 7;
const HEADER_LEN: usize = 10;
/// Incompatibility flag that marks a signed frame.
const FLAG_SIGNED: u8 = 0x01;
/// Length of the signature block (link ID, 48-bit timestamp, 48-bit signature), bytes.
const SIGNATURE_LEN: usize = 13;
/// Message ID of RADIO_STATUS, which telemetry radios send unsigned because they have no key.
const RADIO_STATUS_MESSAGE_ID: u32 = 109;
/// Maximum age of a new stream's first timestamp, in timestamp units (one minute).
const MAX_NEW_STREAM_LAG: u64 = 6_000_000;
/// Maximum amount by which a timestamp may be ahead of a valid clock, in timestamp units (one day, to tolerate a wrong
/// time zone). Accepting a later timestamp would make all valid frames too old, even after a restart.
const MAX_TIMESTAMP_LEAD: u64 = 8_640_000_000;
/// Timestamp of 2024-01-01T00:00:00Z. An earlier clock has not been set.
const MIN_VALID_CLOCK: u64 = 28_401_840_000_000;
/// Maximum number of streams (system, component, link ID) whose last timestamps are stored.
const MAX_STREAMS: usize = 512;
/// Epoch of signing timestamps: 2015-01-01T00:00:00Z in Unix time, µs.
const SIGNING_EPOCH_UNIX_US: u64 = 1_420_070_400_000_000;

/// Signing key: a secret shared by both ends of a link.
#[derive(Clone, PartialEq, Eq)]
pub struct SigningKey(pub [u8; 32]);

impl std::fmt::Debug for SigningKey {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Key(secret)")
    }
}

impl SigningKey {
    /// Derives the key from a passphrase with SHA-256, as MAVProxy, Mission Planner and QGroundControl do.
    #[must_use]
    pub fn from_passphrase(text: &str) -> Self {
        Self(Sha256::digest(text.as_bytes()).into())
    }

    fn signature(&self, frame: &[u8], tail: &[u8]) -> [u8; 6] {
        let digest = Sha256::new().chain_update(self.0).chain_update(frame).chain_update(tail).finalize();
        let mut out = [0; 6];
        out.copy_from_slice(&digest[..6]);
        out
    }
}

/// Converts Unix time (µs) to a signing timestamp in units of 10 µs since 2015.
#[must_use]
pub fn stamp(unix_us: u64) -> u64 {
    unix_us.saturating_sub(SIGNING_EPOCH_UNIX_US) / 10
}

/// Maximum value of a 48-bit timestamp.
const MAX_TIMESTAMP: u64 = (1 << 48) - 1;

fn is_valid_timestamp(stamp: &u64) -> bool {
    *stamp <= MAX_TIMESTAMP
}

/// Result of verifying a frame's signature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SignatureVerdict {
    /// The frame is signed with the correct key and is not a replay.
    Good,
    /// The frame is not signed.
    Unsigned,
    /// The frame was signed with another key or modified.
    Forged,
    /// The frame is signed with the correct key, but was replayed or is too old.
    Replayed,
    /// The frame is signed with the correct key, but its timestamp is too far in the future.
    Ahead,
}

/// Signs and verifies frames for one end of a link.
#[derive(Debug, Clone, PartialEq)]
pub struct Signing {
    key: SigningKey,
    link_id: u8,
    /// Latest timestamp that was sent or accepted.
    newest: u64,
    /// Latest timestamp of the local clock.
    clock: u64,
    last_timestamps: BTreeMap<(u8, u8, u8), u64>,
}

impl Signing {
    /// Creates the signing state. `stamp` must not be earlier than the last timestamp used with this key.
    #[must_use]
    pub fn new(key: SigningKey, link_id: u8, stamp: u64) -> Self {
        Self { key, link_id, newest: stamp, clock: stamp, last_timestamps: BTreeMap::new() }
    }

    /// Signs a complete MAVLink 2 frame of the dialect with a timestamp later than all previous ones. Returns already
    /// signed frames and any other data unchanged.
    #[must_use]
    pub fn sign(&mut self, mut frame: Vec<u8>, stamp: u64) -> Vec<u8> {
        let whole =
            frame.first() == Some(&STX) && frame.len() >= HEADER_LEN + 2 && frame.len() == HEADER_LEN + usize::from(frame[1]) + 2;
        if !whole || frame[FLAGS_OFFSET] & FLAG_SIGNED != 0 {
            return frame;
        }
        self.newest = (self.newest + 1).max(stamp);
        frame[FLAGS_OFFSET] |= FLAG_SIGNED;
        let id = u32::from_le_bytes([frame[MESSAGE_ID_OFFSET], frame[MESSAGE_ID_OFFSET + 1], frame[MESSAGE_ID_OFFSET + 2], 0]);
        let end = frame.len() - 2;
        let crc = checksum(&frame[1..end], MavMessage::extra_crc(id));
        frame[end..].copy_from_slice(&crc.to_le_bytes());
        let mut tail = [self.link_id, 0, 0, 0, 0, 0, 0];
        tail[1..].copy_from_slice(&self.newest.to_le_bytes()[..6]);
        let signature = self.key.signature(&frame, &tail);
        frame.extend_from_slice(&tail);
        frame.extend_from_slice(&signature);
        frame
    }

    /// Returns the latest timestamp that was sent or accepted.
    #[must_use]
    pub fn newest(&self) -> u64 {
        self.newest
    }

    /// Returns the reference time for a new stream: the local clock if it was set, otherwise the latest timestamp sent or
    /// accepted.
    fn reference_time(&self) -> u64 {
        if self.clock >= MIN_VALID_CLOCK { self.clock } else { self.newest }
    }

    /// Returns the latest timestamp that is accepted, which depends on the local clock.
    fn max_valid_timestamp(&self) -> u64 {
        if self.clock >= MIN_VALID_CLOCK { self.clock + MAX_TIMESTAMP_LEAD } else { MAX_TIMESTAMP }
    }

    /// Returns, as text, the state needed to reject replays after a restart with the same key. The first line is the
    /// latest timestamp. Each other line describes a stream: system, component, link ID and last timestamp.
    #[must_use]
    pub fn save(&self) -> String {
        let lines =
            self.last_timestamps.iter().map(|((system, component, link), last)| format!("{system} {component} {link} {last}\n"));
        std::iter::once(format!("{}\n", self.newest)).chain(lines).collect()
    }

    /// Restores saved state. Timestamps too far in the future are ignored: they cannot be valid, and would cause every valid
    /// frame to be rejected.
    ///
    /// # Errors
    /// Returns the number of the first invalid line, counting from 1, and leaves the state unchanged.
    pub fn restore(&mut self, memory: &str) -> Result<(), usize> {
        let stream = |line: &str| -> Option<((u8, u8, u8), u64)> {
            let words: Vec<&str> = line.split(' ').collect();
            let [system, component, link, last] = words.as_slice() else { return None };
            Some((
                (system.parse().ok()?, component.parse().ok()?, link.parse().ok()?),
                last.parse().ok().filter(is_valid_timestamp)?,
            ))
        };
        let mut lines = memory.lines();
        let newest = lines.next().and_then(|line| line.parse().ok()).filter(is_valid_timestamp).ok_or(1usize)?;
        let streams = lines.enumerate().map(|(k, line)| stream(line).ok_or(k + 2));
        let heard = streams.take(MAX_STREAMS).collect::<Result<BTreeMap<_, _>, _>>()?;
        let latest = self.max_valid_timestamp();
        self.newest = self.newest.max(Some(newest).filter(|newest| *newest <= latest).unwrap_or(0));
        self.last_timestamps.extend(heard.into_iter().filter(|(_, last)| *last <= latest));
        Ok(())
    }

    /// Verifies a frame, and stores its timestamp if the frame is accepted. `stamp` is the current time.
    pub fn verify(&mut self, frame: &ReceivedFrame, stamp: u64) -> SignatureVerdict {
        let bytes = &frame.bytes;
        if bytes.first() != Some(&STX)
            || bytes.get(FLAGS_OFFSET).is_none_or(|flags| flags & FLAG_SIGNED == 0)
            || bytes.len() < SIGNATURE_LEN
        {
            return SignatureVerdict::Unsigned;
        }
        self.clock = self.clock.max(stamp);
        self.newest = self.newest.max(stamp);
        let (signed, signature) = bytes.split_at(bytes.len() - 6);
        let (body, tail) = signed.split_at(signed.len() - 7);
        if self.key.signature(body, tail) != signature {
            return SignatureVerdict::Forged;
        }
        let stamp = tail[1..].iter().rev().fold(0, |stamp, byte| (stamp << 8) | u64::from(*byte));
        if stamp > self.max_valid_timestamp() {
            return SignatureVerdict::Ahead;
        }
        let reference_time = self.reference_time();
        let stream = (frame.system_id, frame.component_id, tail[0]);
        if self.last_timestamps.len() >= MAX_STREAMS {
            // Frames from removed streams are too old even to start a new stream, so no frame is accepted twice.
            self.last_timestamps.retain(|_, last| *last + MAX_NEW_STREAM_LAG >= reference_time);
        }
        let new = match self.last_timestamps.get(&stream) {
            Some(last) => stamp > *last,
            None => stamp + MAX_NEW_STREAM_LAG >= reference_time && self.last_timestamps.len() < MAX_STREAMS,
        };
        if !new {
            return SignatureVerdict::Replayed;
        }
        self.last_timestamps.insert(stream, stamp);
        self.newest = self.newest.max(stamp);
        SignatureVerdict::Good
    }
}

/// Returns whether a link that requires signatures accepts a frame with this verdict.
#[must_use]
pub fn is_accepted(frame: &ReceivedFrame, verdict: SignatureVerdict) -> bool {
    verdict == SignatureVerdict::Good || (verdict == SignatureVerdict::Unsigned && frame.message_id == RADIO_STATUS_MESSAGE_ID)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::{Decoder, Encoder};
    use crate::dialect::HEARTBEAT_DATA;

    const NOW: u64 = 30_000_000_000_000;

    fn frame(system: u8) -> Vec<u8> {
        Encoder::new(system, 1).encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA { custom_mode: 7, ..HEARTBEAT_DATA::default() }))
    }

    fn read(bytes: &[u8]) -> ReceivedFrame {
        let mut frames = Decoder::new().datagram(bytes);
        assert_eq!(frames.len(), 1);
        frames.remove(0)
    }

    fn pair() -> (Signing, Signing) {
        let key = SigningKey::from_passphrase("bridge");
        (Signing::new(key.clone(), 3, NOW), Signing::new(key, 0, NOW))
    }

    #[test]
    fn exact_signed_frame_is_accepted_once() {
        let (mut ours, mut theirs) = pair();
        let first = read(&ours.sign(frame(1), NOW));
        let second = read(&ours.sign(frame(1), NOW));
        assert_eq!(first.message, read(&frame(1)).message);
        assert_eq!(theirs.verify(&first, NOW), SignatureVerdict::Good);
        assert_eq!(theirs.verify(&first, NOW), SignatureVerdict::Replayed);
        assert_eq!(theirs.verify(&second, NOW), SignatureVerdict::Good, "same clock, later timestamp");
        assert_eq!(theirs.verify(&first, NOW), SignatureVerdict::Replayed);
    }

    #[test]
    fn exact_forged_altered_and_unsigned_frames_are_rejected() {
        let (mut ours, mut theirs) = pair();
        let good = ours.sign(frame(1), NOW);
        let mut stranger = Signing::new(SigningKey::from_passphrase("brigde"), 3, NOW);
        assert_eq!(theirs.verify(&read(&stranger.sign(frame(1), NOW)), NOW), SignatureVerdict::Forged);
        for k in good.len() - SIGNATURE_LEN..good.len() {
            let mut altered = good.clone();
            altered[k] ^= 1;
            assert_eq!(theirs.verify(&read(&altered), NOW), SignatureVerdict::Forged, "byte {k}");
        }
        let bare = read(&frame(1));
        assert_eq!(theirs.verify(&bare, NOW), SignatureVerdict::Unsigned);
        assert!(!is_accepted(&bare, SignatureVerdict::Unsigned));
        assert_eq!(theirs.verify(&read(&good), NOW), SignatureVerdict::Good, "a rejected frame does not use up its timestamp");
    }

    #[test]
    fn exact_new_stream_may_lag_at_most_one_minute() {
        let (mut ours, _) = pair();
        let old = read(&ours.sign(frame(1), NOW));
        let verdict = |late: u64| Signing::new(SigningKey::from_passphrase("bridge"), 0, NOW + 1 + late).verify(&old, NOW);
        assert_eq!(
            (verdict(MAX_NEW_STREAM_LAG), verdict(MAX_NEW_STREAM_LAG + 1)),
            (SignatureVerdict::Good, SignatureVerdict::Replayed)
        );
    }

    #[test]
    fn exact_streams_are_independent_and_bounded() {
        let (mut ours, mut theirs) = pair();
        let early = ours.sign(frame(1), NOW);
        let late = ours.sign(frame(2), NOW + 500);
        assert_eq!(theirs.verify(&read(&late), NOW), SignatureVerdict::Good);
        assert_eq!(theirs.verify(&read(&early), NOW), SignatureVerdict::Good, "timestamps of different systems are independent");
        for link in 0..=255 {
            for system in 10..14 {
                let mut one = Signing::new(SigningKey::from_passphrase("bridge"), link, NOW);
                theirs.verify(&read(&one.sign(frame(system), NOW)), NOW);
            }
        }
        assert_eq!(theirs.last_timestamps.len(), MAX_STREAMS);
    }

    #[test]
    fn exact_silent_streams_are_evicted_and_their_frames_stay_rejected() {
        let mut guard = Signing::new(SigningKey::from_passphrase("bridge"), 0, NOW);
        let mut first = Signing::new(SigningKey::from_passphrase("bridge"), 0, NOW);
        let old = read(&first.sign(frame(9), NOW));
        assert_eq!(guard.verify(&old, NOW), SignatureVerdict::Good);
        for link in 0..=255 {
            for system in 10..12 {
                let mut one = Signing::new(SigningKey::from_passphrase("bridge"), link, NOW);
                guard.verify(&read(&one.sign(frame(system), NOW)), NOW);
            }
        }
        let later = NOW + 2 * MAX_NEW_STREAM_LAG;
        let newcomer = read(&Signing::new(SigningKey::from_passphrase("bridge"), 7, later).sign(frame(77), later));
        assert_eq!(guard.verify(&newcomer, later), SignatureVerdict::Good);
        assert_eq!((guard.last_timestamps.len(), guard.verify(&old, later)), (1, SignatureVerdict::Replayed));
    }

    #[test]
    fn exact_old_frames_are_rejected_after_a_restart() {
        let (mut ours, mut theirs) = pair();
        let before = read(&ours.sign(frame(1), NOW));
        assert_eq!(theirs.verify(&before, NOW), SignatureVerdict::Good);
        let soon = NOW + MAX_NEW_STREAM_LAG / 2;
        let mut forgetful = Signing::new(SigningKey::from_passphrase("bridge"), 0, soon);
        assert_eq!(forgetful.verify(&before, soon), SignatureVerdict::Good, "without saved state the replay is accepted");
        let mut again = Signing::new(SigningKey::from_passphrase("bridge"), 0, soon);
        again.restore(&theirs.save()).unwrap();
        assert_eq!(again.verify(&before, soon), SignatureVerdict::Replayed);
        let after = read(&ours.sign(frame(1), NOW));
        assert_eq!(again.verify(&after, soon), SignatureVerdict::Good, "a slow clock is still accepted");
        let other = read(&Signing::new(SigningKey::from_passphrase("bridge"), 5, NOW).sign(frame(2), NOW));
        assert_eq!(again.verify(&other, soon), SignatureVerdict::Good, "a new stream may lag behind");
        // Outgoing timestamps do not decrease even if the clock is set back.
        let mut set_back = Signing::new(SigningKey::from_passphrase("bridge"), 0, 5);
        set_back.restore(&again.save()).unwrap();
        assert!(set_back.newest() >= soon);
    }

    /// Without this check, a single frame from a former key holder or a sender with a wrong clock would make all other
    /// frames too old, and the saved state would make this permanent.
    #[test]
    fn regress_frame_from_far_future_is_rejected_without_side_effects() {
        let (mut ours, mut theirs) = pair();
        let far = |stamp: u64| read(&Signing::new(SigningKey::from_passphrase("bridge"), 9, stamp - 1).sign(frame(7), stamp));
        for stamp in [NOW + MAX_TIMESTAMP_LEAD + 1, MAX_TIMESTAMP] {
            assert_eq!(theirs.verify(&far(stamp), NOW), SignatureVerdict::Ahead);
        }
        assert_eq!((theirs.newest(), theirs.last_timestamps.len()), (NOW, 0));
        assert_eq!(theirs.verify(&far(NOW + MAX_TIMESTAMP_LEAD), NOW), SignatureVerdict::Good, "a clock that is one day ahead");
        let honest = read(&ours.sign(frame(1), NOW));
        assert_eq!(theirs.verify(&honest, NOW), SignatureVerdict::Good, "a correct clock at the same time");
        // Such a timestamp is removed from saved state.
        let mut again = Signing::new(SigningKey::from_passphrase("bridge"), 0, NOW);
        again.restore(&format!("{MAX_TIMESTAMP}\n7 1 9 {MAX_TIMESTAMP}\n1 1 3 {NOW}\n")).unwrap();
        assert_eq!((again.newest(), again.last_timestamps.len()), (NOW, 1));
        let next = read(&ours.sign(frame(1), NOW));
        assert_eq!(again.verify(&next, NOW), SignatureVerdict::Good);
        assert_eq!(again.verify(&next, NOW), SignatureVerdict::Replayed);
        // A receiver whose clock was never set accepts all timestamps that are not too old.
        let mut clockless = Signing::new(SigningKey::from_passphrase("bridge"), 0, 5);
        assert_eq!(clockless.verify(&honest, 5), SignatureVerdict::Good);
    }

    #[test]
    fn exact_invalid_saved_state_is_rejected_with_line_number() {
        let mut guard = Signing::new(SigningKey::from_passphrase("bridge"), 0, NOW);
        let begin = guard.clone();
        for (text, line) in [
            ("", 1),
            ("soon\n", 1),
            ("-5\n", 1),
            ("5\n1 1 0\n", 2),
            ("5\n1 1 0 6\n1 1 256 6\n", 3),
            ("5\n1 1 0 281474976710656\n", 2),
        ] {
            assert_eq!(guard.restore(text), Err(line), "{text:?}");
        }
        assert_eq!(guard, begin);
    }

    #[test]
    fn exact_timestamps_count_ten_microseconds_since_2015() {
        assert_eq!(stamp(SIGNING_EPOCH_UNIX_US), 0);
        assert_eq!(stamp(SIGNING_EPOCH_UNIX_US + 1_000_000), 100_000);
        assert_eq!(stamp(0), 0);
    }

    #[test]
    fn val_signature_matches_pymavlink() {
        // Frame from pymavlink 2.4: HEARTBEAT(6, 8, 0, 0, 4) from 255/190, sequence 0, key sha256("bridge"), link 5, timestamp
        // 30000000000000.
        let theirs: Vec<u8> = PYMAVLINK.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect();
        let mut ours = Signing::new(SigningKey::from_passphrase("bridge"), 5, NOW - 1);
        let mut plain = theirs[..theirs.len() - SIGNATURE_LEN].to_vec();
        plain[FLAGS_OFFSET] = 0;
        assert_eq!(ours.sign(plain, NOW), theirs);
        let mut guard = Signing::new(SigningKey::from_passphrase("bridge"), 0, NOW);
        assert_eq!(guard.verify(&read(&theirs), NOW), SignatureVerdict::Good);
    }

    const PYMAVLINK: &str =
        "fd 09 01 00 00 ff be 00 00 00 00 00 00 00 06 08 00 04 03 da b0 05 00 e0 57 eb 48 1b 75 5a 6a ba 8c f2";
}
