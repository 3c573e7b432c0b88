//! Additional HUD inputs, decoded from the telemetry frames: flight mode, satellites, cues, and texts.

use super::hud::{GnssStatus, UNKNOWN_MODE};
use mavlink::MessageData;
use spandrel_mavlink::codec::{Decoder, ReceivedFrame};
use spandrel_mavlink::contract::cue::{self, CueTexts};
use spandrel_mavlink::contract::guidance::{self, Guidance};
use spandrel_mavlink::contract::hazards::{self, HazardReport, RadioMargins};
use spandrel_mavlink::contract::lesson::{self, LessonStatus};
use spandrel_mavlink::contract::modes;
use spandrel_mavlink::contract::named_values::NamedValue;
use spandrel_mavlink::dialect::{
    DEBUG_FLOAT_ARRAY_DATA, GPS_RAW_INT_DATA, HEARTBEAT_DATA, MavFrame, MavMessage, NAMED_VALUE_FLOAT_DATA, NAMED_VALUE_INT_DATA,
    OBSTACLE_DISTANCE_DATA, STATUSTEXT_DATA,
};
use spandrel_mavlink::telemetry::GnssReport;
use spandrel_model::time::SimTime;

/// Timeout for a cue that is not repeated; the monitor repeats active cues at 5 Hz.
const CUE_TIMEOUT: SimTime = SimTime::from_ms(1_500);
/// Time for which a remark about a lesson is shown.
const REMARK_DURATION: SimTime = SimTime::from_ms(8_000);
/// Age at which distances of obstacles are out of date.
const OBSTACLE_TIMEOUT: SimTime = SimTime::from_ms(1_500);
/// Duration of the shutter indicator after a picture.
const SHUTTER_INDICATOR_DURATION: SimTime = SimTime::from_ms(300);

/// Latest values received.
#[derive(Debug, Clone, Default)]
pub struct Feed {
    mode: Option<String>,
    gnss: Option<GnssStatus>,
    cues: Option<(SimTime, i32)>,
    cue_texts: CueTexts,
    guidance: Option<(SimTime, Guidance)>,
    obstacles: Option<(SimTime, ObstacleSectors)>,
    /// Distance to the nearest surface in any direction, m.
    clearance_m: Option<(SimTime, f64)>,
    lesson: Option<(SimTime, LessonStatus)>,
    hazards: Option<(SimTime, HazardReport)>,
    /// Last remark about a lesson, without its prefix.
    lesson_remark: Option<(SimTime, String)>,
}

/// Distances of obstacles in sectors around the aircraft, from OBSTACLE_DISTANCE.
#[derive(Debug, Clone, PartialEq)]
pub struct ObstacleSectors {
    /// Distance in each sector, clockwise from the nose, m; infinite if nothing is within the range, NaN if it is unknown.
    pub sectors_m: Vec<f64>,
    /// Largest distance that can be measured, m.
    pub range_m: f64,
}

impl Feed {
    /// Checks whether [`Self::handle_datagram`] uses a message; other messages need not be decoded.
    #[must_use]
    pub fn is_relevant(message_id: u32) -> bool {
        matches!(
            message_id,
            HEARTBEAT_DATA::ID
                | GPS_RAW_INT_DATA::ID
                | NAMED_VALUE_INT_DATA::ID
                | NAMED_VALUE_FLOAT_DATA::ID
                | STATUSTEXT_DATA::ID
                | DEBUG_FLOAT_ARRAY_DATA::ID
                | OBSTACLE_DISTANCE_DATA::ID
        )
    }

    /// Processes a datagram received at simulation time `now`.
    pub fn handle_datagram(&mut self, bytes: &[u8], now: SimTime) {
        for received in Decoder::new().datagram(bytes) {
            self.handle_frame(&received, now);
        }
    }

    /// Processes a frame received at simulation time `now`.
    pub fn handle_frame(&mut self, received: &ReceivedFrame, now: SimTime) {
        if let Some(message) = &received.message {
            self.message(message, received.component_id, now);
        }
    }

    fn message(&mut self, message: &MavMessage, component: u8, now: SimTime) {
        match message {
            MavMessage::HEARTBEAT(beat) if component == 1 => {
                self.mode = Some(modes::name(beat.autopilot as u8, beat.custom_mode));
            }
            MavMessage::GPS_RAW_INT(gps) => {
                let has_fix = GnssReport::of(gps).has_fix;
                self.gnss = Some(GnssStatus { has_fix, satellites: gps.satellites_visible });
            }
            MavMessage::NAMED_VALUE_INT(named) => {
                if let Some(NamedValue::Cues(cues)) = NamedValue::from_int(named) {
                    self.set_cues(cues, now);
                }
            }
            MavMessage::NAMED_VALUE_FLOAT(named) => {
                if let Some(NamedValue::ClearanceM(clearance_m)) = NamedValue::from_float(named) {
                    self.clearance_m = Some((now, clearance_m));
                }
            }
            MavMessage::OBSTACLE_DISTANCE(data) => self.obstacles = ObstacleSectors::of(data).map(|sectors| (now, sectors)),
            MavMessage::DEBUG_FLOAT_ARRAY(_) => {
                if let Some(guidance) = Guidance::of(message) {
                    self.guidance = Some((now, guidance));
                } else if let Some(status) = LessonStatus::from_message(message) {
                    self.set_lesson(now, status);
                } else if let Some(report) = HazardReport::of(message) {
                    self.hazards = Some((now, report));
                }
            }
            MavMessage::STATUSTEXT(text) if component != 1 => {
                if let Ok(words) = text.text.to_str() {
                    self.handle_lesson_text(now, words);
                    self.handle_text(words);
                }
            }
            _ => {}
        }
    }

    /// Sets the cue mask, from telemetry or from a recording.
    pub fn set_cues(&mut self, mask: i32, now: SimTime) {
        self.cues = Some((now, mask));
        self.cue_texts.retain_active(mask);
    }

    /// Processes a text from the monitor. The text of a cue follows the mask in which the cue becomes active.
    pub fn handle_text(&mut self, words: &str) {
        self.cue_texts.add(words);
    }

    /// Returns the name of the flight mode.
    #[must_use]
    pub fn mode(&self) -> &str {
        self.mode.as_deref().unwrap_or(UNKNOWN_MODE)
    }

    /// Returns the satellite navigation status, if it has been received.
    #[must_use]
    pub fn gnss(&self) -> Option<GnssStatus> {
        self.gnss
    }

    /// Returns the next step of the job; `None` if the monitor does not guide the pilot, or has stopped.
    #[must_use]
    pub fn guidance(&self, now: SimTime) -> Option<Guidance> {
        self.guidance.filter(|(heard, _)| now.saturating_sub(*heard) <= guidance::TIMEOUT).map(|(_, guidance)| guidance)
    }

    /// Returns the distances of obstacles around the aircraft, if they are measured.
    #[must_use]
    pub fn obstacles(&self, now: SimTime) -> Option<&ObstacleSectors> {
        self.obstacles.as_ref().filter(|(heard, _)| now.saturating_sub(*heard) <= OBSTACLE_TIMEOUT).map(|(_, sectors)| sectors)
    }

    /// Returns the distance to the nearest surface in any direction, m, which the too-close cue uses; `None` if it is unknown.
    #[must_use]
    pub fn clearance_m(&self, now: SimTime) -> Option<f64> {
        self.clearance_m.filter(|(heard, _)| now.saturating_sub(*heard) <= OBSTACLE_TIMEOUT).map(|(_, clearance_m)| clearance_m)
    }

    /// Returns the margins of the radio links; `None` if the job does not simulate them.
    #[must_use]
    pub fn radio(&self, now: SimTime) -> Option<RadioMargins> {
        let recent = self.hazards.filter(|(heard, _)| now.saturating_sub(*heard) <= hazards::TIMEOUT);
        recent.and_then(|(_, report)| report.radio)
    }

    /// Returns the margin of the video link, dB; `None` if the job does not simulate it.
    #[must_use]
    pub fn video_margin_db(&self, now: SimTime) -> Option<f64> {
        self.radio(now).map(|radio| radio.video_db)
    }

    /// Returns the current step of a lesson, and what went wrong in it; `None` if there is none, or the monitor has stopped.
    #[must_use]
    pub fn lesson(&self, now: SimTime) -> Option<(LessonStatus, Option<&str>)> {
        let (_, status) = self.lesson.filter(|(heard, _)| now.saturating_sub(*heard) <= lesson::TIMEOUT)?;
        let remark = self.lesson_remark.as_ref().filter(|(heard, _)| now.saturating_sub(*heard) <= REMARK_DURATION);
        Some((status, remark.map(|(_, words)| words.as_str())))
    }

    fn set_lesson(&mut self, now: SimTime, status: LessonStatus) {
        if self.lesson.is_some_and(|(_, before)| before.step != status.step) {
            self.lesson_remark = None;
        }
        self.lesson = Some((now, status));
    }

    /// Keeps a remark about a lesson. The instruction of a step begins with its number.
    fn handle_lesson_text(&mut self, now: SimTime, words: &str) {
        if let Some(remark) = words.strip_prefix(lesson::TEXT_PREFIX)
            && !remark.starts_with(|first: char| first.is_ascii_digit())
        {
            self.lesson_remark = Some((now, remark.to_owned()));
        }
    }

    /// Returns the mask of active cues. `held`: the cues come from a recording that stores only changes, so they do not
    /// time out.
    #[must_use]
    pub fn cues(&self, now: SimTime, held: bool) -> i32 {
        self.cues.filter(|(heard, _)| held || now.saturating_sub(*heard) <= CUE_TIMEOUT).map_or(0, |(_, mask)| mask)
    }

    /// Returns the monitor's texts for the active cues with the distances as they are now: the monitor repeats its texts only after seconds.
    #[must_use]
    pub fn current_cue_texts(&self, now: SimTime) -> CueTexts {
        let stand_off_m = self.guidance(now).and_then(|guidance| guidance.stand_off).map(|reading| reading.actual_m.max(0.0));
        let mut texts = self.cue_texts.clone();
        for (bit, distance_m) in [(cue::TOO_CLOSE, self.clearance_m(now)), (cue::STAND_OFF, stand_off_m)] {
            distance_m.into_iter().for_each(|distance_m| texts.set_distance(bit, distance_m));
        }
        texts
    }

    /// Returns the monitor's texts for the active cues.
    #[must_use]
    pub fn cue_texts(&self) -> &CueTexts {
        &self.cue_texts
    }
}

impl ObstacleSectors {
    /// Decodes the sectors; `None` if they do not cover the full circle in the aircraft's frame, or all are unknown.
    fn of(data: &OBSTACLE_DISTANCE_DATA) -> Option<Self> {
        let width_deg = if data.increment_f > 0.0 { f64::from(data.increment_f) } else { f64::from(data.increment) };
        if data.frame != MavFrame::MAV_FRAME_BODY_FRD || width_deg <= 0.0 {
            return None;
        }
        let count = (360.0 / width_deg).round() as usize;
        let distances = data.distances.get(..count).filter(|distances| distances.iter().any(|one| *one != u16::MAX))?;
        let first = (f64::from(data.angle_offset) / width_deg).round().rem_euclid(count as f64) as usize;
        let mut sectors_m = vec![f64::NAN; count];
        for (k, distance) in distances.iter().enumerate() {
            sectors_m[(first + k) % count] = match *distance {
                u16::MAX => f64::NAN,
                beyond if beyond > data.max_distance => f64::INFINITY,
                cm => f64::from(cm) / 100.0,
            };
        }
        Some(Self { sectors_m, range_m: f64::from(data.max_distance) / 100.0 })
    }
}

/// Checks whether the shutter indicator of a picture taken at `taken` is still shown.
#[must_use]
pub fn shutter(taken: Option<SimTime>, now: SimTime) -> bool {
    taken.is_some_and(|taken| taken <= now && now - taken <= SHUTTER_INDICATOR_DURATION)
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_mavlink::codec::Encoder;
    use spandrel_mavlink::dialect::{GPS_RAW_INT_DATA, GpsFixType, HEARTBEAT_DATA, NAMED_VALUE_INT_DATA};
    use spandrel_model::radio::RadioWay;

    #[test]
    fn exact_frames_set_mode_satellites_and_cues() {
        let mut vehicle = Encoder::new(1, 1);
        let mut monitor = Encoder::new(1, 191);
        let mut feed = Feed::default();
        let now = SimTime::from_ms(5_000);
        feed.handle_datagram(
            &vehicle.encode(&MavMessage::HEARTBEAT(HEARTBEAT_DATA { custom_mode: 3 << 16, ..Default::default() })),
            now,
        );
        let gps = GPS_RAW_INT_DATA { fix_type: GpsFixType::GPS_FIX_TYPE_3D_FIX, satellites_visible: 11, ..Default::default() };
        feed.handle_datagram(&vehicle.encode(&MavMessage::GPS_RAW_INT(gps)), now);
        let cues = NAMED_VALUE_INT_DATA { name: "cues".into(), value: 12, ..Default::default() };
        feed.handle_datagram(&monitor.encode(&MavMessage::NAMED_VALUE_INT(cues)), now);
        assert_eq!((feed.mode(), feed.gnss()), ("Position", Some(GnssStatus { has_fix: true, satellites: 11 })));
        assert_eq!(feed.cues(now + SimTime::from_ms(1_000), false), 12);
        assert_eq!(feed.cues(now + SimTime::from_ms(2_000), false), 0, "cues expire without repetition");
        feed.handle_text("Crash: bridge member arch/rib-left/07");
        assert_eq!(feed.cue_texts().text(cue::CRASH), Some("Crash: bridge member arch/rib-left/07"));
        feed.set_cues(cue::OFF_PATH, now);
        assert_eq!(feed.cue_texts().text(cue::CRASH), Some("Crash"), "the text of an old crash is not shown again");
    }

    #[test]
    fn exact_distances_in_the_texts_are_those_of_now() {
        let now = SimTime::from_ms(5_000);
        let mut feed = Feed::default();
        feed.set_cues(cue::TOO_CLOSE, now);
        feed.handle_text("Too close: 2.48 m, limit 2.5 m");
        feed.handle_datagram(&Encoder::new(1, 1).encode(&NamedValue::ClearanceM(1.62).message(5_000)), now);
        let texts = feed.current_cue_texts(now);
        assert_eq!(texts.text(cue::TOO_CLOSE), Some("Too close: 1.6 m, limit 2.5 m"));
        let later = feed.current_cue_texts(now + OBSTACLE_TIMEOUT + SimTime::from_ms(1));
        assert_eq!(later.text(cue::TOO_CLOSE), Some("Too close: 2.48 m, limit 2.5 m"));
    }

    #[test]
    fn exact_the_nearest_surface_is_known_while_its_telemetry_continues() {
        let now = SimTime::from_ms(5_000);
        let mut feed = Feed::default();
        assert_eq!(feed.clearance_m(now), None);
        feed.handle_datagram(&Encoder::new(1, 1).encode(&NamedValue::ClearanceM(2.25).message(5_000)), now);
        assert!(Feed::is_relevant(NAMED_VALUE_FLOAT_DATA::ID));
        assert_eq!(feed.clearance_m(now + OBSTACLE_TIMEOUT), Some(2.25));
        assert_eq!(feed.clearance_m(now + OBSTACLE_TIMEOUT + SimTime::from_ms(1)), None);
    }

    #[test]
    fn exact_margin_of_the_video_link_is_known_while_its_reports_continue() {
        let radio = RadioMargins { control_db: 12.0, video_db: -1.5, way: RadioWay::AroundEdge, losses: 0 };
        let now = SimTime::from_ms(5_000);
        let mut feed = Feed::default();
        assert_eq!(feed.video_margin_db(now), None);
        let report = HazardReport { radio: Some(radio), ..HazardReport::default() };
        feed.handle_datagram(&Encoder::new(1, 1).encode(&report.message(5_000_000)), now);
        assert_eq!(feed.video_margin_db(now + hazards::TIMEOUT), Some(-1.5));
        assert_eq!(feed.video_margin_db(now + hazards::TIMEOUT + SimTime::from_ms(1)), None);
    }

    #[test]
    fn exact_obstacles_are_free_unknown_or_at_a_distance() {
        let data = |change: &dyn Fn(&mut OBSTACLE_DISTANCE_DATA)| {
            let mut data = OBSTACLE_DISTANCE_DATA {
                distances: [u16::MAX; 72],
                increment: 45,
                max_distance: 1_200,
                frame: MavFrame::MAV_FRAME_BODY_FRD,
                ..Default::default()
            };
            (data.distances[0], data.distances[1]) = (150, 1_201);
            change(&mut data);
            ObstacleSectors::of(&data)
        };
        let sectors = data(&|_| {}).unwrap();
        assert_eq!((sectors.sectors_m.len(), sectors.sectors_m[0], sectors.sectors_m[1]), (8, 1.5, f64::INFINITY));
        assert!(sectors.sectors_m[2..].iter().all(|distance_m| distance_m.is_nan()), "unknown is not free");
        assert_eq!(data(&|data| data.angle_offset = 90.0).unwrap().sectors_m[2], 1.5);
        assert_eq!(data(&|data| data.distances = [u16::MAX; 72]), None);
        assert_eq!(data(&|data| data.increment_f = f32::INFINITY), None);
        assert_eq!(data(&|data| data.increment = 0), None);
        assert_eq!(data(&|data| data.frame = MavFrame::MAV_FRAME_GLOBAL), None);
    }

    #[test]
    fn exact_unknown_satellite_count_is_none() {
        let mut feed = Feed::default();
        let gps = |satellites_visible| {
            let fix_type = GpsFixType::GPS_FIX_TYPE_3D_FIX;
            MavMessage::GPS_RAW_INT(GPS_RAW_INT_DATA { fix_type, satellites_visible, ..Default::default() })
        };
        let mut known = |count| {
            feed.handle_datagram(&Encoder::new(1, 1).encode(&gps(count)), SimTime::ZERO);
            feed.gnss().and_then(GnssStatus::known)
        };
        assert_eq!([known(0), known(11), known(u8::MAX)], [Some(0), Some(11), None]);
    }
}
