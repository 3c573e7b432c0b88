//! Pictures of jobs for the start page, drawn in the background when they are first shown.

use crate::io::files;
use spandrel_model::site::Site;
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

/// The thread's ends: for requests, and for pictures with their jobs.
type DrawingThread = (Sender<String>, Receiver<(String, Picture)>);

impl JobPictures {
    /// Requests the picture of a job, given by its name or path, unless it was requested before.
    pub fn request(&mut self, job: &str) {
        if !self.requested.insert(job.to_owned()) {
            return;
        }
        let (jobs, _) = self.thread.get_or_insert_with(start);
        // The thread runs as long as this end exists.
        let _ = jobs.send(job.to_owned());
    }

    /// Returns the next finished picture.
    pub fn poll(&self) -> Option<(String, Picture)> {
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
                    let picture = job_picture::draw(&file.scenario, &Site::without_defects(&file.scenario));
                    // Sending fails only if the window has since been closed.
                    let _ = sender.send((job, picture));
                }
                // The start page works without the picture, and starting the job reports the error.
                Err(error) => tracing::debug!("no picture of {job}: {error}"),
            }
        }
    });
    (jobs, drawn)
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
        let names: Vec<String> = drawn.iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["drill-hover", "drill-gap"]);
    }
}
