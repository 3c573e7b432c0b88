//! What the head-up display tells besides the flight itself: mode, satellites, cues, words. Read from the same frames as everything else.

use super::hud::Gnss;
use mavlink::MessageData;
use spandrel_mavlink::codec::{Decoder, Received};
use spandrel_mavlink::dialect::{
    GPS_RAW_INT_DATA, GpsFixType, HEARTBEAT_DATA, MavAutopilot, MavMessage, NAMED_VALUE_INT_DATA, STATUSTEXT_DATA,
};
use spandrel_model::time::SimTime;

/// A cue without news for this long is over: the monitor repeats it at 5 Hz.
const CUES_LAST: SimTime = SimTime::from_ms(1_500);
/// A picture counts as taken just now for this long.
const SHUTTER: SimTime = SimTime::from_ms(300);

/// What has been heard so far.
#[derive(Debug, Clone, Default)]
pub struct Feed {
    mode: Option<String>,
    gnss: Option<Gnss>,
    cues: Option<(SimTime, i32)>,
    hit: Option<String>,
}

impl Feed {
    /// True for messages that [`Self::hear`] listens to: the rest need no decoding.
    #[must_use]
    pub fn listens(message_id: u32) -> bool {
        matches!(message_id, HEARTBEAT_DATA::ID | GPS_RAW_INT_DATA::ID | NAMED_VALUE_INT_DATA::ID | STATUSTEXT_DATA::ID)
    }

    /// Takes what a datagram holds, heard at this simulation time.
    pub fn hear(&mut self, bytes: &[u8], now: SimTime) {
        for received in Decoder::new().datagram(bytes) {
            self.take(&received, now);
        }
    }

    /// Takes a frame, heard at this simulation time.
    pub fn take(&mut self, received: &Received, now: SimTime) {
        if let Some(message) = &received.message {
            self.message(message, received.component_id, now);
        }
    }

    fn message(&mut self, message: &MavMessage, component: u8, now: SimTime) {
        match message {
            MavMessage::HEARTBEAT(beat) if component == 1 => {
                let copter = beat.autopilot == MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA;
                self.mode = Some(mode_name(copter, beat.custom_mode));
            }
            MavMessage::GPS_RAW_INT(gps) => {
                let fixed = !matches!(
                    gps.fix_type,
                    GpsFixType::GPS_FIX_TYPE_NO_GPS | GpsFixType::GPS_FIX_TYPE_NO_FIX | GpsFixType::GPS_FIX_TYPE_2D_FIX
                );
                self.gnss = Some(Gnss { fixed, satellites: gps.satellites_visible });
            }
            MavMessage::NAMED_VALUE_INT(named) if named.name.to_str() == Ok("cues") => self.cue(named.value, now),
            MavMessage::STATUSTEXT(text) if component != 1 => {
                if let Ok(words) = text.text.to_str() {
                    self.words(words);
                }
            }
            _ => {}
        }
    }

    /// A mask of cues, from the wire or from a record.
    pub fn cue(&mut self, mask: i32, now: SimTime) {
        self.cues = Some((now, mask));
    }

    /// The monitor's words: those of a crash name what was hit.
    pub fn words(&mut self, words: &str) {
        if let Some(what) = words.strip_prefix("Crash: ") {
            self.hit = Some(what.to_owned());
        }
    }

    /// The mode in words.
    #[must_use]
    pub fn mode(&self) -> &str {
        self.mode.as_deref().unwrap_or("no mode")
    }

    /// Satellite navigation, if it has been heard of.
    #[must_use]
    pub fn gnss(&self) -> Option<Gnss> {
        self.gnss
    }

    /// Cues that are on. `held`: they come from a record that tells changes only.
    #[must_use]
    pub fn cues(&self, now: SimTime, held: bool) -> i32 {
        self.cues.filter(|(heard, _)| held || now.saturating_sub(*heard) <= CUES_LAST).map_or(0, |(_, mask)| mask)
    }

    /// What was hit last.
    #[must_use]
    pub fn hit(&self) -> Option<&str> {
        self.hit.as_deref()
    }
}

/// True while the shutter of a picture taken at `taken` still shows.
#[must_use]
pub fn shutter(taken: Option<SimTime>, now: SimTime) -> bool {
    taken.is_some_and(|taken| taken <= now && now - taken <= SHUTTER)
}

/// Names of PX4's and ArduCopter's modes as their ground stations show them.
#[must_use]
pub fn mode_name(copter: bool, custom_mode: u32) -> String {
    let known = if copter {
        match custom_mode {
            0 => "Stabilize",
            1 => "Acro",
            2 => "Alt Hold",
            3 => "Auto",
            4 | 20 => "Guided",
            5 => "Loiter",
            6 => "RTL",
            7 => "Circle",
            9 => "Land",
            16 => "PosHold",
            17 => "Brake",
            21 => "Smart RTL",
            23 => "Follow",
            27 => "Auto RTL",
            _ => "",
        }
    } else {
        match custom_mode.to_le_bytes() {
            [_, _, 1, _] => "Manual",
            [_, _, 2, _] => "Altitude",
            [_, _, 3, 1] => "Orbit",
            [_, _, 3, _] => "Position",
            [_, _, 4, 2] => "Take-off",
            [_, _, 4, 3] => "Hold",
            [_, _, 4, 4] => "Mission",
            [_, _, 4, 5] => "Return",
            [_, _, 4, 6] => "Land",
            [_, _, 4, 8] => "Follow",
            [_, _, 4, _] => "Auto",
            [_, _, 5, _] => "Acro",
            [_, _, 6, _] => "Offboard",
            [_, _, 7, _] => "Stabilized",
            _ => "",
        }
    };
    if known.is_empty() { format!("mode {custom_mode}") } else { known.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::codec::Encoder;
    use spandrel_mavlink::dialect::{GPS_RAW_INT_DATA, HEARTBEAT_DATA, NAMED_VALUE_INT_DATA};

    #[test]
    fn exact_mode_satellites_and_cues_come_from_frames() {
        let mut vehicle = Encoder::new(1, 1);
        let mut monitor = Encoder::new(1, 191);
        let mut feed = Feed::default();
        let now = SimTime::from_ms(5_000);
        feed.hear(&vehicle.encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA { custom_mode: 3 << 16, ..Default::default() })), now);
        let gps = GPS_RAW_INT_DATA { fix_type: GpsFixType::GPS_FIX_TYPE_3D_FIX, satellites_visible: 11, ..Default::default() };
        feed.hear(&vehicle.encode(&MavMessage::GPS_RAW_INT(gps)), now);
        let cues = NAMED_VALUE_INT_DATA { name: "cues".into(), value: 12, ..Default::default() };
        feed.hear(&monitor.encode(&MavMessage::NAMED_VALUE_INT(cues)), now);
        assert_eq!((feed.mode(), feed.gnss()), ("Position", Some(Gnss { fixed: true, satellites: 11 })));
        assert_eq!(feed.cues(now + SimTime::from_ms(1_000), false), 12);
        assert_eq!(feed.cues(now + SimTime::from_ms(2_000), false), 0, "the monitor has fallen silent");
        feed.words("Crash: bridge member arch/rib-left/07");
        assert_eq!(feed.hit(), Some("bridge member arch/rib-left/07"));
    }

    #[test]
    fn exact_satellites_that_nobody_counts_are_not_known() {
        let mut feed = Feed::default();
        let gps = |satellites_visible| {
            let fix_type = GpsFixType::GPS_FIX_TYPE_3D_FIX;
            MavMessage::GPS_RAW_INT(GPS_RAW_INT_DATA { fix_type, satellites_visible, ..Default::default() })
        };
        let mut known = |count| {
            feed.hear(&Encoder::new(1, 1).encode(&gps(count)), SimTime::ZERO);
            feed.gnss().and_then(Gnss::known)
        };
        assert_eq!([known(0), known(11), known(u8::MAX)], [Some(0), Some(11), None]);
    }

    #[test]
    fn exact_modes_have_the_names_of_their_ground_stations() {
        assert_eq!(mode_name(false, 4 << 16 | 5 << 24), "Return");
        assert_eq!(mode_name(true, 5), "Loiter");
        assert_eq!(mode_name(true, 99), "mode 99");
    }
}
