//! The defect school: renders its pictures, asks its questions and stores the answers, in a thread of its own.

#[cfg(feature = "view")]
mod classroom;

use spandrel_text::{Language, text};
use spandrel_view::flow::pipe::{SchoolRequest, ToWindow};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread::JoinHandle;

/// The school as `train` sees it: a thread while a round is open.
pub struct SchoolRoom {
    sessions: PathBuf,
    round: Option<RoundThread>,
    /// Language of the round.
    language: Language,
}

/// Channels to the thread.
struct RoundThread {
    requests: Option<Sender<SchoolRequest>>,
    messages: Receiver<Result<ToWindow, String>>,
    thread: Option<JoinHandle<()>>,
}

impl Drop for RoundThread {
    /// Waits for the thread, so that it deletes its pictures. Without requests, it ends after the current picture.
    fn drop(&mut self) {
        self.requests = None;
        if let Some(thread) = self.thread.take() {
            // A panic has already been reported.
            let _ = thread.join();
        }
    }
}

impl SchoolRoom {
    /// Creates a school that stores its records in the sessions folder. It starts nothing.
    pub fn new(sessions: &Path) -> Self {
        Self { sessions: sessions.to_path_buf(), round: None, language: Language::default() }
    }

    /// Handles a request from the window. A round has the language in which it begins.
    pub fn handle(&mut self, request: SchoolRequest, language: Language) {
        match request {
            SchoolRequest::Begin(trainee) => {
                self.language = language;
                self.round = Some(RoundThread::start(self.sessions.clone(), trainee, language));
            }
            SchoolRequest::Leave => self.round = None,
            SchoolRequest::Answer(_) | SchoolRequest::Continue => {
                if let Some(requests) = self.round.as_ref().and_then(|round| round.requests.as_ref()) {
                    // The thread has just ended; its last message explains why.
                    let _ = requests.send(request);
                }
            }
        }
    }

    /// Returns the next message for the window.
    pub fn poll(&mut self) -> Option<ToWindow> {
        let failure = match self.round.as_ref()?.messages.try_recv() {
            Ok(Ok(message)) => return Some(message),
            Err(TryRecvError::Empty) => return None,
            Ok(Err(error)) => text!(self.language, "window-school-failed-because", error = error),
            Err(TryRecvError::Disconnected) => text!(self.language, "window-school-failed"),
        };
        self.round = None;
        Some(ToWindow::Refused { words: failure })
    }
}

impl RoundThread {
    fn start(sessions: PathBuf, trainee: String, language: Language) -> Self {
        let (request_sender, requests) = channel();
        let (message_sender, messages) = channel();
        let thread = std::thread::spawn(move || {
            if let Err(error) = teach((&sessions, &trainee, language), &requests, &message_sender) {
                tracing::warn!("defect school: {error}");
                // The user may have left the school.
                let _ = message_sender.send(Err(error));
            }
        });
        Self { requests: Some(request_sender), messages, thread: Some(thread) }
    }
}

/// Runs a round until it is over or the user leaves.
fn teach(
    (sessions, trainee, language): (&Path, &str, Language),
    requests: &Receiver<SchoolRequest>,
    messages: &Sender<Result<ToWindow, String>>,
) -> Result<(), String> {
    #[cfg(feature = "view")]
    return classroom::run((sessions, trainee, language), requests, messages).map_err(|error| error.to_string());
    #[cfg(not(feature = "view"))]
    {
        let _ = (sessions, trainee, requests, messages);
        Err(text!(language, "window-train-no-window"))
    }
}
