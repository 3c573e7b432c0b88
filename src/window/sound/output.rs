//! Plays samples on the default audio device: PulseAudio or PipeWire if one of them is running, otherwise the system's own
//! interface.

use super::inputs::Inputs;
use super::speech::SpeechVoice;
use cpal::traits::{DeviceTrait, HostTrait, StreamTrait};
use cpal::{BufferSize, ErrorKind, FromSample, SampleFormat, SizedSample, Stream, StreamConfig, SupportedBufferSize};
use spandrel_view::sound::ResampledSound;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, TryLockError, Weak};
use std::time::Duration;

/// Interval at which the thread looks for new warnings and for a lost device.
const CHECK_INTERVAL: Duration = Duration::from_millis(10);
/// Number of checks after which a lost or missing device is opened again: first 3 s, then twice as long each time, at most
/// about a minute.
const CHECKS_BEFORE_RETRY: u32 = 300;
const MAX_CHECKS_BEFORE_RETRY: u32 = 6_000;
/// Buffer of the device (estimate). A longer time delays the sound; a shorter time causes dropouts on a busy machine.
const BUFFER_MS: u32 = 40;

/// The audio device with the stream that plays on it.
struct OpenDevice {
    /// Plays until it is dropped.
    _stream: Stream,
    is_lost: Arc<AtomicBool>,
}

/// Plays sound and speaks warnings until the window is closed. Opens the device again after it was lost.
pub fn play(heard: &Weak<Mutex<Inputs>>) {
    // ALSA prints many lines when there is no device. The one warning below says the same.
    #[cfg(target_os = "linux")]
    let _messages = alsa::Output::local_error_handler();
    let (mut voice, mut device) = (SpeechVoice::default(), None::<OpenDevice>);
    let (mut wait, mut next_wait, mut reported) = (0, CHECKS_BEFORE_RETRY, false);
    while let Some(inputs) = heard.upgrade() {
        if device.as_ref().is_some_and(|open| open.is_lost.load(Ordering::Relaxed)) {
            device = None;
        }
        if device.is_none() && wait == 0 {
            match OpenDevice::open(&inputs) {
                Ok(open) => {
                    device = Some(open);
                    (next_wait, reported) = (CHECKS_BEFORE_RETRY, false);
                }
                Err(why) => {
                    if !std::mem::replace(&mut reported, true) {
                        tracing::warn!("no sound: {why}; everything else works");
                    }
                    (wait, next_wait) = (next_wait, (2 * next_wait).min(MAX_CHECKS_BEFORE_RETRY));
                }
            }
        }
        wait = wait.saturating_sub(1);
        voice.update(&inputs, device.is_some());
        drop(inputs);
        std::thread::sleep(CHECK_INTERVAL);
    }
}

impl OpenDevice {
    /// Opens the default device and starts to play.
    fn open(heard: &Arc<Mutex<Inputs>>) -> Result<Self, String> {
        let device = cpal::default_host().default_output_device().ok_or("there is no audio device")?;
        let supported = device.default_output_config().map_err(|error| error.to_string())?;
        let mut config = supported.config();
        config.buffer_size = buffer_size(config.sample_rate, supported.buffer_size());
        let is_lost = Arc::new(AtomicBool::new(false));
        let source = SoundSource { heard: Arc::downgrade(heard), sound: ResampledSound::new(config.sample_rate) };
        let stream = match supported.sample_format() {
            SampleFormat::F32 => stream::<f32>(&device, config, source, &is_lost),
            SampleFormat::I16 => stream::<i16>(&device, config, source, &is_lost),
            SampleFormat::I32 => stream::<i32>(&device, config, source, &is_lost),
            SampleFormat::U8 => stream::<u8>(&device, config, source, &is_lost),
            other => return Err(format!("the audio device needs samples in the format {other}")),
        }?;
        stream.play().map_err(|error| error.to_string())?;
        Ok(Self { _stream: stream, is_lost })
    }
}

/// Returns the device's buffer size closest to the wanted duration.
fn buffer_size(rate_hz: u32, supported: &SupportedBufferSize) -> BufferSize {
    match supported {
        SupportedBufferSize::Range { min, max } if min <= max => {
            BufferSize::Fixed((rate_hz / 1_000 * BUFFER_MS).clamp(*min, *max))
        }
        _ => BufferSize::Default,
    }
}

/// Source of the samples.
struct SoundSource {
    heard: Weak<Mutex<Inputs>>,
    sound: ResampledSound,
}

impl SoundSource {
    /// Takes over the latest inputs, unless the window is just changing them: the device must not wait.
    fn update(&mut self) {
        let Some(inputs) = self.heard.upgrade() else { return };
        let mut now = match inputs.try_lock() {
            Ok(now) => now,
            Err(TryLockError::Poisoned(now)) => now.into_inner(),
            Err(TryLockError::WouldBlock) => return,
        };
        let flight = self.sound.flight();
        flight.set_settings(now.settings);
        flight.set(now.flight.clone());
        if let Some(words) = now.words.take() {
            flight.say(words);
        }
    }
}

/// Creates a stream with samples of type `T`, the same on all channels.
fn stream<T: SizedSample + FromSample<f32>>(
    device: &cpal::Device,
    config: StreamConfig,
    mut source: SoundSource,
    is_lost: &Arc<AtomicBool>,
) -> Result<Stream, String> {
    let channels = usize::from(config.channels).max(1);
    let fill = move |samples: &mut [T], _: &cpal::OutputCallbackInfo| {
        source.update();
        for frame in samples.chunks_mut(channels) {
            frame.fill(T::from_sample(source.sound.next_sample()));
        }
    };
    let is_lost = is_lost.clone();
    let on_error = move |error: cpal::Error| match error.kind() {
        // The stream goes on.
        ErrorKind::DeviceChanged | ErrorKind::Xrun | ErrorKind::RealtimeDenied => {}
        _ if !is_lost.swap(true, Ordering::Relaxed) => tracing::warn!("the sound was interrupted: {error}"),
        _ => {}
    };
    device.build_output_stream(config, fill, on_error, None).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_buffer_lasts_forty_milliseconds_if_the_device_allows_it() {
        let size = |min, max| buffer_size(48_000, &SupportedBufferSize::Range { min, max });
        assert_eq!(size(64, 8_192), BufferSize::Fixed(1_920));
        assert_eq!(size(4_096, 8_192), BufferSize::Fixed(4_096));
        assert_eq!(size(16, 512), BufferSize::Fixed(512));
        assert_eq!(size(9, 3), BufferSize::Default);
        assert_eq!(buffer_size(48_000, &SupportedBufferSize::Unknown), BufferSize::Default);
    }
}
