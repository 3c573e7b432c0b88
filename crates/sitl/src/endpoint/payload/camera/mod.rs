//! The camera component: modes, geotagged images, capture series, recording, zoom, and memory card.

mod capture_mode;
mod capture_record;
mod series;
pub mod settings;
pub mod storage_card;
pub mod stream;
mod summary;
pub mod zoom;

use super::changes::PayloadChange;
pub use capture_mode::CaptureMode;
pub use capture_record::CaptureRecord;
use mavlink::MessageData;
use series::CaptureSeries;
use spandrel_mavlink::dialect::{
    CAMERA_CAPTURE_STATUS_DATA, CAMERA_FOV_STATUS_DATA, CAMERA_SETTINGS_DATA, MavMessage, STORAGE_INFORMATION_DATA,
};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Camera;
use storage_card::{CARD_CAPACITY_MIB, StorageCard};
pub use summary::CameraSummary;
use zoom::{ZoomCommand, ZoomLens};

/// Time within which a capture command with the previous sequence number counts as a repeat.
const REPEAT_WINDOW: SimTime = SimTime::from_ms(5_000);
/// Maximum rate of recording status messages, Hz.
const MAX_STATUS_RATE_HZ: f64 = 10.0;
const MIB: f64 = 1_048_576.0;

/// Camera settings other than mode and zoom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CameraSettings {
    /// Whether images are saved at high quality, which requires more storage.
    pub high_quality: bool,
    /// Video bit rate, Mbit/s.
    pub video_bit_rate_mbit_s: u32,
}

impl Default for CameraSettings {
    fn default() -> Self {
        Self { high_quality: true, video_bit_rate_mbit_s: 60 }
    }
}

impl CameraSettings {
    /// Size of one image, MiB (estimate: 12 MP JPEG at low and high compression).
    #[must_use]
    pub fn picture_size_mib(&self) -> f64 {
        if self.high_quality { 6.0 } else { 3.0 }
    }

    /// Video data rate, MiB/s.
    #[must_use]
    pub fn video_data_rate_mib_s(&self) -> f64 {
        f64::from(self.video_bit_rate_mbit_s) * 1e6 / 8.0 / MIB
    }
}

/// The reason the camera rejected a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CameraError {
    /// The command contains invalid values.
    Invalid,
    /// The memory card is full.
    Full,
    /// Recording requires video mode.
    PhotoMode,
    /// Not possible while recording.
    Recording,
}

impl CameraError {
    /// Returns the text to send; `None` if the command itself was invalid.
    #[must_use]
    pub fn text(self) -> Option<&'static str> {
        match self {
            Self::Invalid => None,
            Self::Full => Some("Camera: memory card full"),
            Self::PhotoMode => Some("Camera: recording requires video mode"),
            Self::Recording => Some("Camera: not available while recording"),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct VideoRecording {
    since: SimTime,
    /// Interval between status messages, and the time at which the next one is due.
    status: Option<(SimTime, SimTime)>,
}

/// A single-image command: sender, sequence number, time.
type CaptureCommand = ((u8, u8), u32, SimTime);

/// Whether the camera component sends heartbeats; simple clients mistake them for the vehicle's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CameraAnnouncement {
    /// Enabled by the parameter.
    pub parameter: bool,
    /// Disabled at program startup.
    pub disabled_at_start: bool,
}

impl Default for CameraAnnouncement {
    fn default() -> Self {
        Self { parameter: true, disabled_at_start: false }
    }
}

/// Camera state.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CameraState {
    /// Capture mode.
    pub mode: CaptureMode,
    /// Zoom lens.
    pub zoom: ZoomLens,
    /// Settings other than mode and zoom.
    pub settings: CameraSettings,
    /// Live video stream.
    pub stream: stream::StreamReport,
    /// Whether the component sends heartbeats.
    pub announced: CameraAnnouncement,
    series: CaptureSeries,
    card: StorageCard,
    recording: Option<VideoRecording>,
    last: Option<CaptureCommand>,
}

impl CameraState {
    /// Returns a summary of the camera's state.
    #[must_use]
    pub fn summary(&self, now: SimTime) -> CameraSummary {
        CameraSummary {
            announced: self.announced.parameter && !self.announced.disabled_at_start,
            pictures: self.image_count(),
            interval_s: self.series.interval_s(),
            series: self.series.is_distance_triggered(),
            mode: self.mode,
            recording: self.recording.map(|recording| now - recording.since),
            used_mib: self.used_storage_mib(now),
            zoom: self.zoom.level(),
            video_bit_rate_mbit_s: self.settings.video_bit_rate_mbit_s,
            stream: self.stream.running(now),
        }
    }

    /// Returns the number of images in the image log.
    #[must_use]
    pub fn image_count(&self) -> usize {
        self.card.images().len()
    }

    /// Returns the used storage in MiB, including the current recording.
    fn used_storage_mib(&self, now: SimTime) -> f64 {
        let running = self.recording.map_or(0.0, |recording| (now - recording.since).s() * self.settings.video_data_rate_mib_s());
        (self.card.used_storage_mib() + running).min(CARD_CAPACITY_MIB)
    }

    /// Checks whether the card is too full for another image.
    #[must_use]
    pub fn is_full(&self, now: SimTime) -> bool {
        self.used_storage_mib(now) + self.settings.picture_size_mib() > CARD_CAPACITY_MIB
    }

    /// Starts a series or takes one image. If `count` is 0, the series continues until it is stopped.
    ///
    /// # Errors
    /// Returns an error if the card is full or a value is invalid.
    pub fn start(&mut self, interval_s: f64, count: f64, now: SimTime) -> Result<(), CameraError> {
        if self.is_full(now) {
            return Err(CameraError::Full);
        }
        if self.series.start(interval_s, count, now) { Ok(()) } else { Err(CameraError::Invalid) }
    }

    /// Takes an image every `distance_m` meters, starting at `here`, and one immediately if `first` is set. A distance
    /// of 0 stops the series.
    ///
    /// # Errors
    /// Returns an error if the card is full or a value is invalid.
    pub fn start_distance_triggered_series(
        &mut self,
        distance_m: f64,
        first: bool,
        here: Vec3<Enu>,
        now: SimTime,
    ) -> Result<(), CameraError> {
        if distance_m > 0.0 && self.is_full(now) {
            return Err(CameraError::Full);
        }
        if self.series.start_distance_triggered_series(distance_m, first, here, now) { Ok(()) } else { Err(CameraError::Invalid) }
    }

    /// Checks whether a numbered single-image command repeats the last one. Clients send repeats after a lost
    /// acknowledgment.
    #[must_use]
    pub fn is_repeated(&self, from: (u8, u8), number: u32, now: SimTime) -> bool {
        self.last.is_some_and(|(who, last, at)| who == from && last == number && now - at <= REPEAT_WINDOW)
    }

    /// Records a single-image command as executed.
    pub fn record_capture_command(&mut self, from: (u8, u8), number: u32, now: SimTime) {
        self.last = Some((from, number, now));
    }

    /// Stops every series.
    pub fn stop(&mut self) {
        self.series.stop();
    }

    /// Changes the mode.
    ///
    /// # Errors
    /// Returns an error while recording.
    pub fn set_mode(&mut self, mode: CaptureMode) -> Result<(), CameraError> {
        if self.recording.is_some() && mode != self.mode {
            return Err(CameraError::Recording);
        }
        self.mode = mode;
        Ok(())
    }

    /// Starts recording and sends the status at `status_hz` Hz (0: only on request). If a recording is in progress, it
    /// continues.
    ///
    /// # Errors
    /// Returns an error in photo mode, if the card is full, or if the rate is invalid.
    pub fn start_recording(&mut self, status_hz: f64, now: SimTime) -> Result<(), CameraError> {
        if self.mode != CaptureMode::Video {
            return Err(CameraError::PhotoMode);
        }
        if self.is_full(now) {
            return Err(CameraError::Full);
        }
        if !(status_hz.is_finite() && status_hz >= 0.0) {
            return Err(CameraError::Invalid);
        }
        let every = (status_hz > 0.0).then(|| SimTime::period(status_hz.clamp(1e-3, MAX_STATUS_RATE_HZ)));
        let since = self.recording.map_or(now, |running| running.since);
        self.recording = Some(VideoRecording { since, status: every.map(|every| (every, now + every)) });
        Ok(())
    }

    /// Stops the recording.
    pub fn stop_recording(&mut self, now: SimTime) {
        if let Some(recording) = self.recording.take() {
            let room = CARD_CAPACITY_MIB - self.card.used_storage_mib();
            self.card.add_video(((now - recording.since).s() * self.settings.video_data_rate_mib_s()).min(room));
        }
    }

    /// Formats the card, or only resets the image counter.
    ///
    /// # Errors
    /// Returns an error while recording.
    pub fn format(&mut self, whole: bool) -> Result<(), CameraError> {
        if self.recording.is_some() {
            return Err(CameraError::Recording);
        }
        if whole {
            self.card.format();
        } else {
            self.card.clear_log();
        }
        Ok(())
    }

    /// Resets the camera to its defaults: photo mode, widest zoom, high quality.
    ///
    /// # Errors
    /// Returns an error while recording.
    pub fn reset(&mut self, camera: &Camera) -> Result<(), CameraError> {
        if self.recording.is_some() {
            return Err(CameraError::Recording);
        }
        self.mode = CaptureMode::Photo;
        self.settings = CameraSettings::default();
        self.zoom.command(ZoomCommand::Level(0.0), camera);
        Ok(())
    }

    /// Changes the settings.
    ///
    /// # Errors
    /// Returns an error if the video bit rate would change while recording.
    pub fn set(&mut self, settings: CameraSettings) -> Result<(), CameraError> {
        if self.recording.is_some() && settings.video_bit_rate_mbit_s != self.settings.video_bit_rate_mbit_s {
            return Err(CameraError::Recording);
        }
        self.settings = settings;
        Ok(())
    }

    /// Advances the simulation: moves the lens, sends the recording status, and stops the recording when the card is
    /// full.
    pub fn step(&mut self, now: SimTime, dt_s: f64, changes: &mut PayloadChange) {
        if self.zoom.step(dt_s) {
            changes.add_message(CAMERA_SETTINGS_DATA::ID);
            changes.add_message(CAMERA_FOV_STATUS_DATA::ID);
        }
        if self.recording.is_none() {
            return;
        }
        if self.used_storage_mib(now) >= CARD_CAPACITY_MIB {
            self.stop_recording(now);
            changes.add_warning("Memory card full");
            changes.add_message(STORAGE_INFORMATION_DATA::ID);
            changes.add_message(CAMERA_CAPTURE_STATUS_DATA::ID);
            return;
        }
        if let Some((every, next)) = self.recording.as_mut().and_then(|recording| recording.status.as_mut())
            && *next <= now
        {
            *next += *every;
            changes.add_message(CAMERA_CAPTURE_STATUS_DATA::ID);
        }
    }

    /// Returns true if the next image should be captured at `now`; if so, call [`CameraState::take`].
    #[must_use]
    pub fn due(&self, now: SimTime, here: Vec3<Enu>) -> bool {
        self.series.due(now, here) && !self.is_full(now)
    }

    /// Captures and stores the next image and returns its message. A full card ends every series.
    pub fn take(&mut self, image: CaptureRecord, now: SimTime, here: Vec3<Enu>) -> MavMessage {
        let message = image.message();
        self.card.add_picture(image, self.settings.picture_size_mib());
        self.series.taken(now, here);
        if self.is_full(now) {
            self.series.cancel();
        }
        message
    }

    /// Returns a stored image's message for resending.
    #[must_use]
    pub fn recorded_capture(&self, index: usize) -> Option<MavMessage> {
        self.card.images().get(index).map(CaptureRecord::message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FIXED: Camera = spandrel_model::site::defects::REFERENCE_CAMERA;

    #[test]
    fn exact_full_card_ends_a_series_and_picture_indices_are_unique() {
        let (mut camera, mut now) = (CameraState::default(), SimTime::ZERO);
        let here = Vec3::zero();
        assert!(camera.start(1.0, 0.0, now).is_ok());
        let mut indices = Vec::new();
        while camera.due(now, here) {
            let pictures = camera.summary(now).pictures;
            let message = camera.take(CaptureRecord::numbered(pictures), now, here);
            let MavMessage::CAMERA_IMAGE_CAPTURED(image) = message else { panic!("{message:?}") };
            indices.push(image.image_index);
            now += SimTime::from_s(1.0);
        }
        let most = (CARD_CAPACITY_MIB / CameraSettings::default().picture_size_mib()) as i32;
        assert!(indices.iter().copied().eq(0..most), "{} pictures", indices.len());
        let left = CARD_CAPACITY_MIB - camera.summary(now).used_mib;
        assert!(
            (0.0..CameraSettings::default().picture_size_mib()).contains(&left),
            "reported free storage does not match: {left}"
        );
        assert!(camera.is_full(now) && camera.summary(now).interval_s.is_none());
        assert_eq!(camera.start(0.0, 1.0, now), Err(CameraError::Full));
        assert_eq!(camera.start_distance_triggered_series(5.0, false, here, now), Err(CameraError::Full));
        assert_eq!(camera.format(true), Ok(()));
        assert_eq!((camera.summary(now).pictures, camera.summary(now).used_mib), (0, 0.0));
    }

    #[test]
    fn regress_single_pictures_requested_in_one_tick_are_all_taken_during_a_series() {
        let (mut camera, now, here) = (CameraState::default(), SimTime::ZERO, Vec3::zero());
        for (interval_s, count) in [(0.0, 1.0), (0.0, 1.0), (1.0, 2.0), (0.0, 1.0)] {
            assert!(camera.start(interval_s, count, now).is_ok());
        }
        let mut taken = 0;
        while camera.due(now, here) {
            let _ = camera.take(CaptureRecord::numbered(taken), now, here);
            taken += 1;
        }
        assert_eq!(taken, 4, "three single images and the first image of the series must be taken");
        assert_eq!(camera.summary(now).interval_s, Some(1.0), "the series must continue");
        assert!(camera.start(0.0, 1.0, now).is_ok());
        camera.stop();
        assert!(camera.due(now, here), "an image accepted before the stop must still be taken");
        let _ = camera.take(CaptureRecord::numbered(taken), now, here);
        assert!(!camera.due(now + SimTime::from_s(2.0), here));
    }

    #[test]
    fn exact_recording_fills_the_card_at_its_rate_and_stops_when_full() {
        let mut camera = CameraState { mode: CaptureMode::Video, ..CameraState::default() };
        let mut changes = PayloadChange::default();
        assert_eq!(camera.start_recording(0.0, SimTime::ZERO), Ok(()));
        // 60 Mbit/s is 7.5 MB/s.
        let after = SimTime::from_s(100.0);
        assert!((camera.summary(after).used_mib * MIB - 750e6).abs() < 1.0);
        let end = SimTime::from_s(CARD_CAPACITY_MIB * MIB / 7.5e6 + 0.01);
        camera.step(after, 0.01, &mut changes);
        assert_eq!(camera.summary(after).recording, Some(after));
        camera.step(end, 0.01, &mut changes);
        assert_eq!(camera.summary(end).recording, None);
        assert_eq!(camera.summary(end).used_mib, CARD_CAPACITY_MIB);
        assert_eq!(camera.start_recording(0.0, end), Err(CameraError::Full));
    }

    #[test]
    fn exact_recording_locks_mode_and_card_and_reports_status_at_the_requested_rate() {
        let mut camera = CameraState::default();
        assert_eq!(camera.start_recording(1.0, SimTime::ZERO), Err(CameraError::PhotoMode));
        assert_eq!(camera.set_mode(CaptureMode::Video), Ok(()));
        assert_eq!(camera.start_recording(-1.0, SimTime::ZERO), Err(CameraError::Invalid));
        assert_eq!(camera.start_recording(2.0, SimTime::ZERO), Ok(()));
        assert_eq!(camera.set_mode(CaptureMode::Photo), Err(CameraError::Recording));
        assert_eq!(camera.format(true), Err(CameraError::Recording));
        assert_eq!(camera.reset(&FIXED), Err(CameraError::Recording));
        let told = (1..=4_000).filter(|ms| {
            let mut changes = PayloadChange::default();
            camera.step(SimTime::from_ms(*ms), 0.001, &mut changes);
            changes.take().0.contains(&CAMERA_CAPTURE_STATUS_DATA::ID)
        });
        assert_eq!(told.count(), 8, "the status must be sent twice per second for four seconds");
        // A repeated start command, for example after a lost acknowledgment, must not interrupt the recording.
        assert_eq!(camera.start_recording(0.0, SimTime::from_ms(4_000)), Ok(()));
        assert_eq!(camera.summary(SimTime::from_ms(5_000)).recording, Some(SimTime::from_ms(5_000)));
        camera.stop_recording(SimTime::from_ms(5_000));
        assert_eq!(camera.reset(&FIXED), Ok(()));
        assert_eq!(camera.mode, CaptureMode::Photo);
    }

    #[test]
    fn exact_only_recent_commands_with_the_same_sender_and_number_count_as_repeats() {
        let mut camera = CameraState::default();
        let at = SimTime::from_ms;
        assert!(!camera.is_repeated((255, 190), 1, at(0)));
        camera.record_capture_command((255, 190), 1, at(0));
        assert!(camera.is_repeated((255, 190), 1, at(500)));
        assert!(!camera.is_repeated((255, 190), 2, at(500)));
        assert!(!camera.is_repeated((254, 190), 1, at(500)));
        assert!(!camera.is_repeated((255, 190), 1, REPEAT_WINDOW + at(1)));
    }
}
