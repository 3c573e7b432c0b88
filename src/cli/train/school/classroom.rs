//! A round of the defect school.

use crate::cli::render::scene_drawing::{SceneDrawing, SceneRenderer};
use crate::errors::AppError;
use crate::io::clock::unix_us;
use crate::io::png::png;
use crate::io::replace::replace;
use crate::io::trainee_id::TraineeId;
use crate::io::{files, school_record};
use spandrel_model::scenario::Scenario;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_text::{Language, text};
use spandrel_training::school::{
    CARDS_PER_ROUND, Question, Round, RoundSummary, SchoolPicture, SchoolRecord, Verdict, gallery, picture_camera,
    school_scenario,
};
use spandrel_view::camera::PinholeCamera;
use spandrel_view::flow::pipe::{SchoolPage, SchoolRequest, ToWindow};
use spandrel_view::quality::Quality;
use spandrel_view::scene::LoadingStep;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, Sender};

/// Job whose bridges the pictures show, the aircraft whose camera takes them, and the quality of the pictures: fine enough for
/// surfaces from 1 m, and quick without a graphics card.
const JOB: &str = "two-bridges";
const AIRCRAFT: &str = "phantom2";
const QUALITY: &str = "medium";
/// Microseconds in a second.
const US_PER_S: u64 = 1_000_000;

/// Asks a round of questions.
///
/// # Errors
/// Returns an error if the record is invalid, a picture cannot be rendered, or a file cannot be written.
pub fn run(
    (sessions, trainee, language): (&Path, &str, Language),
    requests: &Receiver<SchoolRequest>,
    messages: &Sender<Result<ToWindow, String>>,
) -> Result<(), AppError> {
    trainee.parse::<TraineeId>().map_err(AppError::invalid)?;
    let mut record = school_record::find(sessions, trainee)?.unwrap_or_default();
    record.rounds = record.rounds.saturating_add(1);
    // Every round has defects of its own, so that nobody learns the pictures by heart.
    let seed = u64::from(record.rounds);
    let scenario = school_scenario(&files::scenario(JOB)?.scenario, seed);
    let vehicle = files::vehicle(AIRCRAFT)?.vehicle;
    let quality = Quality::by_name(QUALITY).ok_or_else(|| AppError::failed(format!("no quality preset {QUALITY}")))?;
    // The window has gone if a message cannot be sent.
    let report = |step: LoadingStep| drop(messages.send(Ok(ToWindow::Loading { words: step.words(language) })));
    let drawing = SceneDrawing::new_in_steps(&scenario, &vehicle, seed, (quality, SimTime::ZERO), &report)?;
    let round = Round::new(&record, gallery(drawing.site(), &vehicle, seed), seed, unix_s());
    let folder = PictureFolder::create(sessions)?;
    school_record::create(sessions, trainee)?;
    let mut studio = Studio { scenario: &scenario, vehicle: &vehicle, drawing: &drawing, renderer: drawing.scene_renderer() };
    let mut lesson = Lesson { round, record, sessions, trainee, folder, number: 0, picture: None, language };
    let mut page = Some(lesson.ask(&mut studio)?);
    while let Some(shown) = page.take() {
        if messages.send(Ok(ToWindow::School(shown))).is_err() {
            return Ok(());
        }
        while page.is_none() {
            page = match requests.recv() {
                Ok(SchoolRequest::Answer(number)) => lesson.answer(number)?,
                Ok(SchoolRequest::Continue) => Some(lesson.advance(&mut studio)?),
                Ok(SchoolRequest::Begin(_) | SchoolRequest::Leave) | Err(_) => return Ok(()),
            };
        }
    }
    Ok(())
}

/// Renders pictures.
struct Studio<'a> {
    scenario: &'a Scenario,
    vehicle: &'a Vehicle,
    drawing: &'a SceneDrawing,
    renderer: SceneRenderer<'a>,
}

impl Studio<'_> {
    fn picture(&mut self, picture: &SchoolPicture) -> Result<Vec<u8>, AppError> {
        let lens = picture_camera(&self.vehicle.camera);
        let eye = PinholeCamera::of(&picture.pose, &lens);
        let size = (lens.width_px, lens.height_px);
        let stage = self.drawing.stage(self.scenario, self.vehicle);
        let shot = stage.camera_view_from(eye, Some(&picture.pose), &lens, None, (SimTime::ZERO, size));
        png(&self.renderer.draw(&shot, &[])?)
    }
}

/// A round with its record.
struct Lesson<'a> {
    round: Round,
    record: SchoolRecord,
    sessions: &'a Path,
    trainee: &'a str,
    folder: PictureFolder,
    /// Number of pictures so far.
    number: u32,
    picture: Option<String>,
    language: Language,
}

impl Lesson<'_> {
    /// Renders the current question's picture and returns its page, or the result at the end of the round.
    fn ask(&mut self, studio: &mut Studio) -> Result<SchoolPage, AppError> {
        let Some(question) = self.round.question() else {
            self.picture = None;
            return Ok(summary_page(&self.round.summary(self.language), self.record.mastered(), self.language));
        };
        self.number += 1;
        let path = self.folder.0.join(format!("{}.png", self.number));
        replace(&path, &studio.picture(&question.picture)?)?;
        self.picture = Some(path.display().to_string());
        Ok(question_page(question, self.round.position(), self.picture.clone(), self.language))
    }

    /// Returns the page with the verdict; `None` if there is nothing to answer.
    fn answer(&mut self, number: usize) -> Result<Option<SchoolPage>, AppError> {
        let Some(verdict) = self.round.answer(number, &mut self.record, unix_s(), self.language) else { return Ok(None) };
        school_record::save(self.sessions, self.trainee, &self.record)?;
        Ok(Some(verdict_page(verdict, self.round.position(), self.picture.clone(), self.language)))
    }

    fn advance(&mut self, studio: &mut Studio) -> Result<SchoolPage, AppError> {
        self.round.advance();
        self.ask(studio)
    }
}

/// A folder for the pictures, which is deleted at the end. Its name starts with a dot, so that it is not taken for a session.
struct PictureFolder(PathBuf);

impl PictureFolder {
    fn create(sessions: &Path) -> Result<Self, AppError> {
        // An earlier round of this process may still be deleting its folder.
        static ROUND_COUNTER: AtomicU32 = AtomicU32::new(0);
        let number = ROUND_COUNTER.fetch_add(1, Ordering::Relaxed);
        let path = sessions.join(format!(".school-{}-{number}", std::process::id()));
        std::fs::create_dir_all(&path).map_err(|error| AppError::failed(format!("{}: {error}", path.display())))?;
        Ok(Self(path))
    }
}

impl Drop for PictureFolder {
    fn drop(&mut self) {
        if let Err(error) = std::fs::remove_dir_all(&self.0) {
            tracing::warn!("{}: cannot delete: {error}", self.0.display());
        }
    }
}

fn unix_s() -> u64 {
    unix_us() / US_PER_S
}

fn title((number, count): (usize, usize), language: Language) -> String {
    text!(language, "window-school-title", number = number, count = count)
}

fn question_page(question: &Question, position: (usize, usize), picture: Option<String>, language: Language) -> SchoolPage {
    let again = (question.misses > 0).then(|| text!(language, "window-school-again"));
    let answers = question.answers.iter().map(|answer| answer.words(language)).collect();
    let lines = again.into_iter().chain([question.words(language), text!(language, "window-school-question")]).collect();
    SchoolPage { picture, title: title(position, language), lines, answers, right: None, over: false }
}

fn verdict_page(verdict: Verdict, position: (usize, usize), picture: Option<String>, language: Language) -> SchoolPage {
    let Verdict { right, words } = verdict;
    SchoolPage { picture, title: title(position, language), lines: words, answers: Vec::new(), right: Some(right), over: false }
}

fn summary_page(summary: &RoundSummary, mastered: usize, language: Language) -> SchoolPage {
    let mut lines = vec![text!(language, "window-school-right", right = summary.right, asked = summary.asked)];
    if !summary.missed.is_empty() {
        lines.push(text!(language, "window-school-missed", kinds = summary.missed.join(", ")));
    }
    if summary.asked < CARDS_PER_ROUND {
        lines.push(text!(language, "window-school-no-more"));
    }
    lines.push(text!(language, "window-school-mastered", count = mastered));
    SchoolPage {
        picture: None,
        title: text!(language, "window-school-complete"),
        lines,
        answers: Vec::new(),
        right: None,
        over: true,
    }
}
