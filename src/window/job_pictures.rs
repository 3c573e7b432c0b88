//! Pictures of jobs for the start page and drawings for their briefings, made in the background when they are first needed.

use crate::io::files;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_view::hud::JobDrawing;
use spandrel_view::job_picture;
use spandrel_view::picture::Picture;
use std::collections::BTreeSet;
use std::sync::mpsc::{Receiver, Sender, channel};

/// Draws the pictures of jobs. The thread starts with the first request and ends with the window.
#[derive(Debug, Default)]
pub struct JobPictures {
    requested: BTreeSet<String>,
    thread: Option<DrawingThread>,
}

/// How a job looks.
#[derive(Debug)]
pub struct JobLook {
    /// Name or path of the job.
    pub job: String,
    /// Picture for the start page.
    pub picture: Picture,
    /// Drawings for the briefing.
    pub drawing: JobDrawing,
}

/// The thread's ends: for requests, and for finished jobs.
type DrawingThread = (Sender<String>, Receiver<JobLook>);

impl JobPictures {
    /// Requests the picture and the drawings of a job, given by its name or path, unless it was requested before.
    pub fn request(&mut self, job: &str) {
        if !self.requested.insert(job.to_owned()) {
            return;
        }
        let (jobs, _) = self.thread.get_or_insert_with(start);
        // The thread runs as long as this end exists.
        let _ = jobs.send(job.to_owned());
    }

    /// Returns the next finished job.
    pub fn poll(&self) -> Option<JobLook> {
        self.thread.as_ref().and_then(|(_, drawn)| drawn.try_recv().ok())
    }
}

fn start() -> DrawingThread {
    let (jobs, wanted) = channel::<String>();
    let (sender, drawn) = channel();
    std::thread::spawn(move || {
        for job in wanted {
            match files::scenario(&job) {
                Ok(file) => {
                    // Sending fails only if the window has since been closed.
                    let _ = sender.send(look(job, &file.scenario));
                }
                // The start page works without the picture, and starting the job reports the error.
                Err(error) => tracing::debug!("no picture of {job}: {error}"),
            }
        }
    });
    (jobs, drawn)
}

fn look(job: String, scenario: &Scenario) -> JobLook {
    let site = Site::without_defects(scenario);
    JobLook { job, picture: job_picture::draw(scenario, &site), drawing: JobDrawing::new(scenario, &site) }
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
        let (_, drawn) = pictures.thread.take().unwrap();
        // The thread ends when nobody can request another picture.
        let names: Vec<String> = drawn.iter().map(|look| look.job).collect();
        assert_eq!(names, ["drill-hover", "drill-gap"]);
    }
}
