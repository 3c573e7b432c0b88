//! The briefing as a page to print.

use super::files::ScenarioFile;
use crate::errors::AppError;
use spandrel_model::site::Site;
use spandrel_model::vehicle::Vehicle;
use spandrel_text::Language;
use spandrel_training::briefing::Briefing;
use spandrel_training::report::page;

/// Returns the page with the briefing for a job and an aircraft: drawings of the site, texts and the instructor's pictures.
///
/// # Errors
/// Returns an error if a picture cannot be read.
pub fn briefing_page(job: &ScenarioFile, vehicle: &Vehicle, language: Language) -> Result<String, AppError> {
    let site = Site::without_defects(&job.scenario);
    let briefing = Briefing::new(&job.scenario, vehicle, &site, language);
    let pictures: Vec<Option<String>> = job.load_pictures()?.iter().map(|picture| Some(picture.data_uri())).collect();
    Ok(page::briefing(&briefing, (&job.scenario, &site), &pictures, language))
}
