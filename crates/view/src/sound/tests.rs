//! Tests of frequencies, levels, silence, and absence of clicks.

use super::propellers::BLADES_PER_PROPELLER;
use super::speech::SPEECH_LEVEL;
use super::{ActiveAlarms, FlightSound, ResampledSound, SAMPLE_RATE_HZ, SoundInputs, SoundSettings, SpokenWords};
use crate::hud::{DisplayStyle, DisplayUnits, GnssStatus, Hud, HudColor, StatusAlarm, StatusAlarms, tests as hud_tests};
use spandrel_mavlink::contract::cue::{self, CueTexts};
use spandrel_mavlink::contract::hazards::RadioMargins;
use spandrel_model::math;
use spandrel_model::radio::RadioWay;
use spandrel_model::random::RandomStream;
use spandrel_text::Language;
use std::sync::Arc;

fn cues(cues: i32) -> ActiveAlarms {
    ActiveAlarms { cues, ..ActiveAlarms::default() }
}

fn status(alarm: StatusAlarm) -> ActiveAlarms {
    ActiveAlarms { status: [alarm].into_iter().collect(), ..ActiveAlarms::default() }
}

fn sound_inputs(rad_s: f64, distance_m: f64, mask: i32) -> SoundInputs {
    SoundInputs { rotors_rad_s: vec![rad_s; 4], distance_m, alarms: cues(mask), ..SoundInputs::default() }
}

/// Returns `seconds` of sound, recorded after the levels have settled for one second.
fn render_sound(sound: &mut FlightSound, sound_inputs: SoundInputs, seconds: f64) -> Vec<f64> {
    sound.set(sound_inputs);
    let mut out = vec![0.0_f32; SAMPLE_RATE_HZ as usize + (seconds * f64::from(SAMPLE_RATE_HZ)) as usize];
    sound.fill(&mut out);
    out[SAMPLE_RATE_HZ as usize..].iter().map(|sample| f64::from(*sample)).collect()
}

/// Returns the amplitude at one frequency (a bin of the discrete Fourier transform).
fn amplitude(samples: &[f64], hz: f64) -> f64 {
    amplitude_at(samples, hz, f64::from(SAMPLE_RATE_HZ))
}

fn amplitude_at(samples: &[f64], hz: f64, rate_hz: f64) -> f64 {
    let step = math::TAU * hz / rate_hz;
    let (mut re, mut im) = (0.0, 0.0);
    for (k, sample) in samples.iter().enumerate() {
        let (s, c) = math::sin_cos(step * k as f64);
        (re, im) = (re + sample * c, im + sample * s);
    }
    2.0 * math::hypot(re, im) / samples.len() as f64
}

const STATUS_ALARMS: [StatusAlarm; 4] =
    [StatusAlarm::LinkLost, StatusAlarm::GnssLost, StatusAlarm::ControlWeak, StatusAlarm::VideoWeak];

fn only(propellers: bool, warnings: bool) -> SoundSettings {
    SoundSettings { propellers, warnings, speech: false, volume: 1.0 }
}

#[test]
fn exact_propeller_sound_consists_of_blade_harmonics() {
    // 120 revolutions per second: two blades pass 240 times per second.
    let rad_s = 120.0 * math::TAU;
    let samples = render_sound(&mut FlightSound::new(only(true, true)), sound_inputs(rad_s, 1.0, 0), 1.0);
    let first = amplitude(&samples, BLADES_PER_PROPELLER * 120.0);
    assert!(first > 0.05, "{first}");
    for (k, share) in [(2.0, 0.5), (3.0, 0.25)] {
        let ratio = amplitude(&samples, k * BLADES_PER_PROPELLER * 120.0) / first;
        assert!((ratio - share).abs() < 0.01, "harmonic {k}: {ratio}");
    }
    for hz in [120.0, 200.0, 350.0, 1_000.0] {
        assert!(amplitude(&samples, hz) < 0.01 * first, "{hz} Hz");
    }
}

#[test]
fn exact_level_depends_on_speed_squared_and_distance() {
    let level = |turns: f64, distance_m: f64| {
        let samples = render_sound(&mut FlightSound::new(only(true, true)), sound_inputs(turns * math::TAU, distance_m, 0), 1.0);
        amplitude(&samples, BLADES_PER_PROPELLER * turns)
    };
    let near = level(80.0, 1.0);
    assert!((level(160.0, 1.0) / near - 4.0).abs() < 0.05);
    assert!((level(80.0, 30.0) / near - 0.5).abs() < 0.01, "full level at 15 m, half at 30 m");
    assert!((level(80.0, 10.0) / near - 1.0).abs() < 0.01);
}

#[test]
fn exact_only_the_most_severe_warning_sounds_at_its_pitch() {
    let pitches = [220.0, 1_050.0, 700.0, 440.0, 330.0];
    let cues = [cue::CRASH, cue::TOO_CLOSE, cue::SPEEDING, cue::OFF_PATH, cue::BATTERY_RED];
    for (own, cue) in pitches.into_iter().zip(cues) {
        let samples = render_sound(&mut FlightSound::new(only(true, true)), sound_inputs(0.0, 1.0, cue), 6.0);
        let loudest = pitches.into_iter().max_by(|a, b| amplitude(&samples, *a).total_cmp(&amplitude(&samples, *b)));
        assert_eq!(loudest, Some(own), "cue {cue}");
    }
    let all = cues.into_iter().fold(0, |mask, cue| mask | cue);
    let samples = render_sound(&mut FlightSound::new(only(true, true)), sound_inputs(0.0, 1.0, all), 6.0);
    assert!(amplitude(&samples, 220.0) > 10.0 * amplitude(&samples, 1_050.0), "a crash must have priority");
}

#[test]
fn exact_the_displayed_text_of_the_most_severe_new_cue_is_spoken() {
    let texts: CueTexts = ["Off path 3.4 m: left and up", "Too fast: 11 mph, limit 10 mph", "Battery 29%"].into_iter().collect();
    let spoken = |before, now| super::spoken(cues(before), cues(now), &texts, DisplayStyle::default());
    assert_eq!(spoken(0, cue::CRASH | cue::SPEEDING).as_deref(), Some("Crash"));
    let off = Some("Off path 3.4 meters: left and up");
    assert_eq!(spoken(cue::SPEEDING, cue::SPEEDING | cue::OFF_PATH).as_deref(), off);
    assert_eq!(spoken(0, cue::SPEEDING).as_deref(), Some("Too fast: 4.92 meters per second, limit 4.47 meters per second"));
    assert_eq!(spoken(0, cue::BATTERY_RED).as_deref(), Some("Battery 29 percent"));
    assert_eq!(spoken(0, cue::STAND_OFF | cue::OFF_PATH).as_deref(), Some("Stand-off"), "not the off-path cue");
    assert_eq!(spoken(cue::STAND_OFF | cue::OFF_PATH, cue::OFF_PATH).as_deref(), off);
    assert_eq!(spoken(cue::CRASH | cue::SPEEDING, cue::SPEEDING), None);
    let german = DisplayStyle { language: Language::German, ..DisplayStyle::default() };
    let said = super::spoken(cues(0), cues(cue::SPEEDING), &texts, german);
    assert_eq!(said.as_deref(), Some("Zu schnell: 4.92 Meter pro Sekunde, höchstens 4.47 Meter pro Sekunde"));
    let us = DisplayStyle { units: DisplayUnits::UsCustomary, ..DisplayStyle::default() };
    let said = super::spoken(cues(0), cues(cue::SPEEDING), &texts, us);
    assert_eq!(said.as_deref(), Some("Too fast: 11 miles per hour, limit 10 miles per hour"));
}

#[test]
fn exact_disabled_sounds_are_silent() {
    let flying = sound_inputs(700.0, 5.0, cue::SPEEDING);
    let peak = |settings: SoundSettings, sound_inputs: SoundInputs| {
        render_sound(&mut FlightSound::new(settings), sound_inputs, 1.0)
            .into_iter()
            .fold(0.0, |most: f64, sample| most.max(sample.abs()))
    };
    // Residual level one second after release: exp(-50).
    const RESIDUAL_LEVEL: f64 = 1e-12;
    assert!(peak(only(true, true), flying.clone()) > 0.1);
    assert!(peak(only(false, false), flying.clone()) < RESIDUAL_LEVEL);
    assert!(peak(only(true, true), SoundInputs { silent: true, ..flying.clone() }) < RESIDUAL_LEVEL);
    assert!(peak(SoundSettings { volume: 0.0, ..only(true, true) }, flying) < RESIDUAL_LEVEL);
    assert!(peak(only(true, true), sound_inputs(0.0, 5.0, 0)) < RESIDUAL_LEVEL, "stopped propellers must be silent");
}

#[test]
fn prop_sound_never_clips_or_clicks() {
    // Steepest possible slope in steady state: every source at full level with all harmonics in phase.
    let top_hz = BLADES_PER_PROPELLER * 2.0 * 1_100.0 / math::TAU;
    let harmonics: f64 = (1..=6).map(|k| f64::from(k) * math::pow(0.5, f64::from(k - 1))).sum::<f64>() / 1.968_75;
    let slope = |amplitude: f64, hz: f64| amplitude * math::TAU * hz / f64::from(SAMPLE_RATE_HZ);
    // Additional allowance for transitions of tones and levels.
    const TRANSITION_ALLOWANCE: f64 = 1.1;
    let steepest = TRANSITION_ALLOWANCE
        * (slope(0.5 * harmonics, top_hz) + slope(0.45, 2_100.0) + 0.45 / (0.008 * f64::from(SAMPLE_RATE_HZ)));
    assert!(steepest < 0.5, "the limit must be low enough to reveal a click: {steepest}");
    for seed in 0..20 {
        let mut random = RandomStream::new(seed, "sound");
        let mut sound = FlightSound::new(only(true, true));
        let mut last = 0.0_f32;
        for _ in 0..60 {
            let mut any = |most: f64| most * random.uniform();
            sound.set(SoundInputs {
                rotors_rad_s: (0..(any(9.0) as usize)).map(|_| any(4_000.0) - 500.0).collect(),
                distance_m: any(300.0) - 10.0,
                alarms: ActiveAlarms {
                    cues: any(128.0) as i32,
                    status: STATUS_ALARMS.into_iter().filter(|_| any(1.0) < 0.1).collect(),
                },
                cue_texts: CueTexts::default(),
                style: DisplayStyle::default(),
                silent: any(1.0) < 0.2,
            });
            let mut out = vec![0.0_f32; 240 + any(2_000.0) as usize];
            sound.fill(&mut out);
            for sample in out {
                assert!(sample.abs() <= 1.0, "seed {seed}: {sample}");
                assert!(f64::from((sample - last).abs()) < steepest, "seed {seed}: click of {}", (sample - last).abs());
                last = sample;
            }
        }
    }
    let mut sound = FlightSound::new(only(true, true));
    sound.set(SoundInputs { rotors_rad_s: vec![f64::NAN, f64::INFINITY], distance_m: f64::NAN, ..SoundInputs::default() });
    let mut out = [0.0_f32; 480];
    sound.fill(&mut out);
    assert!(out.iter().all(|sample| sample.is_finite()));
}

/// Returns `seconds` of resampled sound, recorded after the levels have settled for one second.
fn resampled(rate_hz: u32, seconds: f64) -> Vec<f64> {
    let mut sound = ResampledSound::new(rate_hz);
    sound.flight().set_settings(only(true, true));
    sound.flight().set(sound_inputs(120.0 * math::TAU, 1.0, 0));
    let count = (f64::from(rate_hz) * seconds) as usize;
    let samples: Vec<f64> = (0..rate_hz as usize + count).map(|_| f64::from(sound.next_sample())).collect();
    samples[rate_hz as usize..].to_vec()
}

#[test]
fn exact_resampled_sound_keeps_pitch_and_level() {
    /// Loss of linear interpolation at 960 Hz and 24 kHz: 1 - sinc²(0.04) = 0.5 %.
    const INTERPOLATION_LOSS: f64 = 0.006;
    let tone = |rate_hz: u32, hz: f64| amplitude_at(&resampled(rate_hz, 1.0), hz, f64::from(rate_hz));
    for rate_hz in [24_000, 44_100, 48_000, 96_000] {
        for hz in [240.0, 480.0, 720.0] {
            let (found, wanted) = (tone(rate_hz, hz), tone(SAMPLE_RATE_HZ, hz));
            assert!((found / wanted - 1.0).abs() < INTERPOLATION_LOSS, "{hz} Hz at {rate_hz} Hz: {found} for {wanted}");
        }
        assert!(tone(rate_hz, 350.0) < 0.01 * tone(rate_hz, 240.0));
    }
}

#[test]
fn exact_sound_at_its_own_rate_is_not_changed() {
    let mut flight = FlightSound::new(only(true, true));
    let expected = render_sound(&mut flight, sound_inputs(120.0 * math::TAU, 1.0, 0), 0.5);
    // Interpolation delays the sound by two samples.
    assert_eq!(resampled(SAMPLE_RATE_HZ, 0.5)[2..], expected[..expected.len() - 2]);
}

/// Returns the inputs for a flight as it is displayed.
fn of_display(hud: &Hud, rotors_rad_s: Vec<f64>, distance_m: f64) -> SoundInputs {
    let status = StatusAlarms::new(hud.telemetry_age_s, hud.gnss, hud.radio);
    let (cue_texts, style) = (hud.cue_texts.clone(), hud.style);
    let alarms = ActiveAlarms { cues: hud.cues, status };
    SoundInputs { rotors_rad_s, distance_m, alarms, cue_texts, style, silent: false }.with_freeze(hud.is_frozen)
}

/// Returns how long a sound is audible, as a fraction of the time.
fn audible_share(samples: &[f64]) -> f64 {
    /// Above the tones' zero crossings over 1 ms, and far below their peaks (0.45).
    const AUDIBLE_LEVEL: f64 = 0.05;
    let windows: Vec<&[f64]> = samples.chunks(SAMPLE_RATE_HZ as usize / 1_000).collect();
    let audible = windows.iter().filter(|window| window.iter().any(|sample| sample.abs() > AUDIBLE_LEVEL));
    audible.count() as f64 / windows.len() as f64
}

#[test]
fn exact_everything_that_is_displayed_as_an_alarm_sounds_and_is_spoken() {
    let radio = |control_db, video_db| Some(RadioMargins { control_db, video_db, way: RadioWay::AroundEdge, losses: 0 });
    let calm = Hud { radio: radio(20.0, 20.0), ..hud_tests::hud() };
    let no_fix = Some(GnssStatus { has_fix: false, satellites: 4 });
    // Pitch in Hz and the share of the time for which it sounds.
    let cases = [
        (Hud { telemetry_age_s: 3.0, ..calm.clone() }, "LINK LOST 3 s", (1_575.0, 0.3 / 0.5), "Link lost"),
        (Hud { telemetry_age_s: 3.0, is_frozen: true, ..calm.clone() }, "LINK LOST 3 s", (1_575.0, 0.3 / 0.5), "Link lost"),
        (Hud { gnss: no_fix, ..calm.clone() }, "GNSS lost (4)", (2_100.0, 0.1 / 1.5), "G N S S lost"),
        (Hud { radio: radio(0.0, 20.0), ..calm.clone() }, "control", (1_575.0, 0.1), "Control link weak"),
        (Hud { radio: radio(20.0, 0.0), ..calm.clone() }, "video", (1_575.0, 0.1 / 2.0), "Video link weak"),
    ];
    /// Attack and release are audible for a part of their 8 ms.
    const SHARE_TOLERANCE: f64 = 0.02;
    for (hud, words, (hz, share), said) in cases {
        let displayed = hud_tests::find(&hud, words).map(|(_, color)| color);
        assert_eq!(displayed, Some(HudColor::Orange), "{words}");
        let inputs = of_display(&hud, Vec::new(), 10.0);
        let samples = render_sound(&mut FlightSound::new(only(true, true)), inputs.clone(), 6.0);
        assert!(amplitude(&samples, hz) > 10.0 * amplitude(&samples, 1.2 * hz), "{words}: pitch");
        let audible = audible_share(&samples);
        assert!((audible - share).abs() < SHARE_TOLERANCE, "{words}: sounds for {audible} of the time, not {share}");
        let spoken = super::spoken(ActiveAlarms::default(), inputs.alarms, &hud.cue_texts, hud.style);
        assert_eq!(spoken.as_deref(), Some(said));
        assert_eq!(super::spoken(inputs.alarms, inputs.alarms, &hud.cue_texts, hud.style), None, "only once");
    }
    for hud in [calm.clone(), Hud { is_frozen: true, cues: cue::SPEEDING, ..calm }] {
        let inputs = of_display(&hud, vec![0.0; 4], 10.0);
        assert_eq!(audible_share(&render_sound(&mut FlightSound::new(only(true, true)), inputs, 3.0)), 0.0);
    }
}

#[test]
fn exact_without_a_link_only_its_alarm_sounds() {
    let hud = Hud { telemetry_age_s: 2.0, cues: cue::CRASH | cue::TOO_CLOSE, ..hud_tests::hud() };
    let inputs = of_display(&hud, vec![700.0; 4], 1.0);
    assert!(inputs.rotors_rad_s.is_empty(), "the rotor speeds are unknown");
    let samples = render_sound(&mut FlightSound::new(only(true, true)), inputs, 3.0);
    for hz in [220.0, 1_050.0] {
        assert!(amplitude(&samples, 1_575.0) > 10.0 * amplitude(&samples, hz), "{hz} Hz");
    }
    let both = ActiveAlarms { cues: cue::SPEEDING, ..status(StatusAlarm::ControlWeak) };
    let texts: CueTexts = ["Too fast: 11 mph, limit 10 mph"].into_iter().collect();
    assert_eq!(
        super::spoken(status(StatusAlarm::ControlWeak), both, &texts, DisplayStyle::default()).as_deref(),
        Some("Too fast: 4.92 meters per second, limit 4.47 meters per second"),
    );
}

/// Returns a tone as words: its rate is that of Debian's espeak-ng voices.
fn tone_words(hz: f64, seconds: f64) -> SpokenWords {
    let rate_hz = 22_050;
    let samples = (0..(seconds * f64::from(rate_hz)) as usize)
        .map(|k| math::sin(math::TAU * hz * k as f64 / f64::from(rate_hz)) as f32)
        .collect();
    SpokenWords::new(samples, rate_hz)
}

#[test]
fn exact_words_keep_their_pitch_and_duration_and_stand_out() {
    let mut sound = FlightSound::new(only(true, true));
    let rad_s = 120.0 * math::TAU;
    let blades_hz = BLADES_PER_PROPELLER * 120.0;
    let alone = amplitude(&render_sound(&mut sound, sound_inputs(rad_s, 1.0, 0), 1.0), blades_hz);
    let words = Arc::new(tone_words(1_000.0, 2.5));
    let spoken = Arc::downgrade(&words);
    sound.say(words);
    // The first second is not rendered, so that the levels have settled.
    let samples = render_sound(&mut sound, sound_inputs(rad_s, 1.0, 0), 1.0);
    assert!((amplitude(&samples, 1_000.0) - SPEECH_LEVEL).abs() < 0.02, "{}", amplitude(&samples, 1_000.0));
    assert!(
        (amplitude(&samples, blades_hz) / alone - (1.0 - SPEECH_LEVEL)).abs() < 0.01,
        "the propellers are quieter behind the words"
    );
    assert!(spoken.upgrade().is_some(), "half a second is left");
    let after = render_sound(&mut sound, sound_inputs(rad_s, 1.0, 0), 1.0);
    assert!(spoken.upgrade().is_none(), "whoever waits for the end of the words learns of it");
    assert!(amplitude(&after, 1_000.0) < 1e-3 && (amplitude(&after, blades_hz) / alone - 1.0).abs() < 0.01);
}

#[test]
fn exact_muted_words_are_silent_but_end_in_time() {
    let mut sound = FlightSound::new(only(true, true));
    let words = Arc::new(tone_words(1_000.0, 1.5));
    let spoken = Arc::downgrade(&words);
    sound.say(words);
    let samples = render_sound(&mut sound, SoundInputs { silent: true, ..SoundInputs::default() }, 1.0);
    assert!(samples.iter().all(|sample| *sample == 0.0));
    assert!(spoken.upgrade().is_none());
}

#[test]
fn exact_words_over_the_loudest_signals_do_not_clip() {
    let mut sound = FlightSound::new(only(true, true));
    sound.set(sound_inputs(2_000.0, 0.5, cue::CRASH));
    let mut settled = vec![0.0_f32; SAMPLE_RATE_HZ as usize];
    sound.fill(&mut settled);
    sound.say(Arc::new(SpokenWords::new(vec![1.0; SAMPLE_RATE_HZ as usize], SAMPLE_RATE_HZ)));
    let mut out = vec![0.0_f32; SAMPLE_RATE_HZ as usize];
    sound.fill(&mut out);
    let loudest = out.iter().fold(0.0_f32, |loudest, sample| loudest.max(sample.abs()));
    assert!((0.65..=1.0).contains(&loudest), "{loudest}");
}
