//! Renders a session's camera view as a video, with its photographs as chapters.

use super::args::Args;
use super::recorded::RecordedFlight;
use super::scene_drawing::{SceneDrawing, aspect, sim_time_arg};
use crate::cli::picture_args::{parse_quality, parse_size};
use crate::errors::AppError;
use crate::io::progress::ProgressLog;
use crate::io::replace::replace;
use crate::io::report;
use crate::io::user_language::user_language;
use crate::records::reliability_beside;
use spandrel_model::time::SimTime;
use spandrel_monitor::folder::VIDEO;
use spandrel_text::Language;
use spandrel_training::report::pictures::ReviewedPicture;
use spandrel_view::arrange::largest_even_size_px;
use spandrel_view::exposure::ExposureMeter;
use spandrel_view::gpu::{Gpu, GpuError};
use spandrel_view::hud;
use spandrel_view::stage;
use spandrel_view::video::{H264Encoder, Mp4Chunk, Mp4Writer, webvtt};
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Bits per pixel (estimate: 6 Mbit/s at 1080p30, typical of small cameras).
const BITS_PER_PIXEL: f64 = 0.1;
/// Interval between key frames, s; players can seek to key frames.
const KEY_FRAME_INTERVAL_S: f64 = 2.0;
/// Maximum duration of a photograph's chapter, s; a chapter ends where the next one starts.
const MAX_CHAPTER_DURATION_S: f64 = 4.0;

/// Renders the video to a file, or to the session folder, and writes its chapters next to it.
pub fn run(args: &Args, file: Option<&Path>) -> Result<(), AppError> {
    if args.only_with_gpu && !has_graphics_card()? {
        tracing::info!("no graphics card: the video is not rendered");
        return Ok(());
    }
    match file {
        Some(path) => render(args, path, |recorded| span(args, recorded)),
        None => render_for_report(args),
    }
}

fn has_graphics_card() -> Result<bool, AppError> {
    match Gpu::open() {
        Ok(gpu) => Ok(!gpu.software),
        Err(GpuError::NoDevice(_)) => Ok(false),
        Err(error @ (GpuError::Failed(_) | GpuError::TooLarge(..))) => Err(error.into()),
    }
}

/// Renders the video to the session folder, and rewrites the report, which shows it.
fn render_for_report(args: &Args) -> Result<(), AppError> {
    let session = Path::new(&args.what);
    if args.span.is_some() {
        return Err(AppError::invalid(
            "--span: the video in the session folder always shows the entire flight; specify a file: --video FILE",
        ));
    }
    // The report's times count from lift-off.
    render(args, &session.join(VIDEO), |recorded| Ok(recorded.scored_span()))?;
    report::write(session, user_language(), &|job| reliability_beside(session, job))?;
    Ok(())
}

/// Renders the part of the flight between the times that `span` returns.
fn render(
    args: &Args,
    path: &Path,
    span: impl FnOnce(&RecordedFlight) -> Result<(SimTime, SimTime), AppError>,
) -> Result<(), AppError> {
    let preset = parse_quality(&args.quality)?;
    let within_px = parse_size(args.size.as_deref().unwrap_or("1280x720"))?;
    if !(1.0..=60.0).contains(&args.fps) {
        return Err(AppError::invalid(format!("--fps {}: out of range (allowed: 1 to 60)", args.fps)));
    }
    let track = path.with_extension("vtt");
    if track == path {
        return Err(AppError::invalid(format!(
            "--video {}: this file name is reserved for the chapters; choose another extension, for example .mp4",
            path.display()
        )));
    }
    let recorded = RecordedFlight::read(Path::new(&args.what))?;
    let (from, to) = span(&recorded)?;
    let size_px = largest_even_size_px(within_px, recorded.vehicle().camera.aspect());
    let drawing = SceneDrawing::new(recorded.scenario(), recorded.vehicle(), recorded.seed(), preset, from)?;
    let drawing = drawing.with_changes(recorded.site_changes());
    let bits_s = BITS_PER_PIXEL * f64::from(size_px.0) * f64::from(size_px.1) * args.fps;
    let mut encoder = H264Encoder::new(size_px, args.fps, bits_s as u32, (KEY_FRAME_INTERVAL_S * args.fps).ceil() as u32)?;
    let (mut film, head) = Mp4Writer::new(size_px, args.fps)?;
    let mut file = VideoFile::create(path)?;
    file.write(&head)?;
    let (mut scene_renderer, mut replay_feed, mut progress) =
        (drawing.scene_renderer(), recorded.replay_feed(), ProgressLog::start("rendering video"));
    let mut meter = ExposureMeter::default();
    let count = ((to - from).s() * args.fps).floor() as u32 + 1;
    let picture_s = 1.0 / args.fps;
    for k in 0..count {
        let at = from + SimTime::from_s(f64::from(k) / args.fps);
        progress.report(|| format!("{:.1} of {:.1} s", (at - from).s(), (to - from).s()));
        let moment = recorded.moment(at)?;
        let stage = drawing.stage(recorded.scenario(), recorded.vehicle());
        let items = if args.no_hud {
            Vec::new()
        } else {
            hud::layout(&stage::hud(&stage, &moment, &recorded.flight, (replay_feed.advance_to(at), true), true), aspect(size_px))
        };
        let picture = scene_renderer.draw(&stage.camera_frame(&moment, size_px, &mut meter), &items)?;
        file.write(&film.push(&encoder.encode(&picture)?)?)?;
    }
    for piece in film.finish()? {
        file.write(&piece)?;
    }
    file.finish()?;
    progress.finish();
    replace(&track, webvtt::write(&chapters(&report::pictures(&recorded.folder)?, (from, to), picture_s)).as_bytes())?;
    println!("video         {} ({count} frames), chapters {}", path.display(), track.display());
    Ok(())
}

/// Returns the requested part of the flight as start and end times.
fn span(args: &Args, recorded: &RecordedFlight) -> Result<(SimTime, SimTime), AppError> {
    let (first, last) = recorded.span();
    let Some(text) = &args.span else { return Ok((first, last)) };
    let wrong = || {
        let (first, last) = (first.s(), last.s());
        AppError::invalid(format!(
            "--span {text}: not a valid range (allowed: FROM,TO in s of simulation time within {first:.1} to {last:.1}, for example 60,90)"
        ))
    };
    let (from, to) = text.split_once(',').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| wrong());
    let (from, to) = (sim_time_arg("span", number(from)?)?, sim_time_arg("span", number(to)?)?);
    if from < first || to > last || from >= to { Err(wrong()) } else { Ok((from, to)) }
}

/// Returns a chapter for each photograph in the span; the title is the photograph's verdict. Each chapter lasts at
/// least one frame.
fn chapters(taken: &[ReviewedPicture], (from, to): (SimTime, SimTime), picture_s: f64) -> Vec<webvtt::Chapter> {
    let within: Vec<&ReviewedPicture> = taken.iter().filter(|picture| (from..=to).contains(&picture.time)).collect();
    let next = |k: usize| within.get(k + 1).map_or(to, |next: &&ReviewedPicture| next.time);
    within
        .iter()
        .enumerate()
        .map(|(k, picture)| webvtt::Chapter {
            from_s: (picture.time - from).s(),
            to_s: match (picture.time + SimTime::from_s(MAX_CHAPTER_DURATION_S)).min(next(k)) {
                end if end > picture.time => (end - from).s(),
                _ => (picture.time - from).s() + picture_s,
            },
            title: chapter_title(picture),
        })
        .collect()
}

/// Returns a chapter's title. It is in English, as are all files that other programs read.
fn chapter_title(picture: &ReviewedPicture) -> String {
    let (verdict, reason) = (picture.verdict.name(Language::English), picture.reason.words(Language::English));
    format!("Picture {}: {verdict} ({reason})", picture.number)
}

/// A video file. It has a temporary name until it is complete, so an existing video is not replaced before then.
struct VideoFile<'a> {
    path: &'a Path,
    part: PathBuf,
    file: File,
}

impl<'a> VideoFile<'a> {
    fn create(path: &'a Path) -> Result<Self, AppError> {
        let mut part = path.to_path_buf().into_os_string();
        part.push(".part");
        let part = PathBuf::from(part);
        let file = File::create(&part).map_err(|error| AppError::invalid(format!("{}: {error}", part.display())))?;
        Ok(Self { path, part, file })
    }

    fn write(&mut self, piece: &Mp4Chunk) -> Result<(), AppError> {
        let written = self.file.seek(SeekFrom::Start(piece.at)).and_then(|_| self.file.write_all(&piece.bytes));
        written.map_err(|error| AppError::failed(format!("{}: {error}", self.part.display())))
    }

    fn finish(self) -> Result<(), AppError> {
        std::fs::rename(&self.part, self.path).map_err(|error| AppError::failed(format!("{}: {error}", self.path.display())))
    }
}

impl Drop for VideoFile<'_> {
    fn drop(&mut self) {
        // A file that still has its temporary name is incomplete.
        let _ = std::fs::remove_file(&self.part);
    }
}
