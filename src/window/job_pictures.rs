//! Pictures of jobs for the start page and drawings for their briefings, made in the background when they are first needed.

use super::worker::Worker;
use crate::io::files;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_view::gpu::PageImage;
use spandrel_view::hud::JobDrawing;
use spandrel_view::job_picture;
use std::collections::BTreeSet;

/// Draws the pictures of jobs.
#[derive(Debug)]
pub struct JobPictures {
    requested: BTreeSet<String>,
    worker: Worker<Option<JobLook>>,
}

/// How a job looks.
#[derive(Debug)]
pub struct JobLook {
    /// Name or path of the job.
    pub job: String,
    /// Picture for the start page.
    pub picture: PageImage,
    /// Drawings for the briefing.
    pub drawing: JobDrawing,
}

impl Default for JobPictures {
    fn default() -> Self {
        Self { requested: BTreeSet::new(), worker: Worker::new(draw) }
    }
}

impl JobPictures {
    /// Requests the picture and the drawings of a job, given by its name or path, unless it was requested before.
    pub fn request(&mut self, job: &str) {
        if self.requested.insert(job.to_owned()) {
            self.worker.request(job.to_owned());
        }
    }

    /// Returns the next finished job.
    pub fn poll(&self) -> Option<JobLook> {
        std::iter::from_fn(|| self.worker.poll()).find_map(|(_, look)| look)
    }
}

fn draw(job: &str) -> Option<JobLook> {
    // The start page works without the picture, and starting the job reports the error.
    let file = files::scenario(job).inspect_err(|error| tracing::debug!("no picture of {job}: {error}")).ok()?;
    Some(look(job.to_owned(), &file.scenario))
}

fn look(job: String, scenario: &Scenario) -> JobLook {
    let site = Site::without_defects(scenario);
    JobLook { job, picture: PageImage::new(&job_picture::draw(scenario, &site)), drawing: JobDrawing::new(scenario, &site) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_each_job_is_drawn_once_and_a_missing_one_is_skipped() {
        let mut pictures = JobPictures::default();
        assert!(pictures.poll().is_none());
        for job in ["no such job", "drill-hover", "drill-hover", "drill-gap"] {
            pictures.request(job);
        }
        let (_, drawn) = pictures.worker.thread.take().unwrap();
        // The thread ends when nobody can request another picture.
        let names: Vec<String> = drawn.iter().filter_map(|(_, look)| Some(look?.job)).collect();
        assert_eq!(names, ["drill-hover", "drill-gap"]);
    }
}
