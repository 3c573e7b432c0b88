//! A thread that makes something for each name that the window requests, one after the other.

use std::sync::mpsc::{Receiver, Sender, channel};

/// The thread's ends: for names, and for names with what was made.
pub type WorkerThread<T> = (Sender<String>, Receiver<(String, T)>);

/// A worker. The thread starts with the first request and ends with the window.
#[derive(Debug)]
pub struct Worker<T> {
    make: fn(&str) -> T,
    pub(super) thread: Option<WorkerThread<T>>,
}

impl<T: Send + 'static> Worker<T> {
    /// Creates a worker with the function that runs in the thread.
    pub fn new(make: fn(&str) -> T) -> Self {
        Self { make, thread: None }
    }

    /// Requests what belongs to a name.
    pub fn request(&mut self, name: String) {
        let make = self.make;
        let (names, _) = self.thread.get_or_insert_with(|| start(make));
        // The thread runs as long as this end exists.
        let _ = names.send(name);
    }

    /// Returns the next name with what was made.
    pub fn poll(&self) -> Option<(String, T)> {
        self.thread.as_ref().and_then(|(_, finished)| finished.try_recv().ok())
    }
}

fn start<T: Send + 'static>(make: fn(&str) -> T) -> WorkerThread<T> {
    let (names, wanted) = channel::<String>();
    let (sender, finished) = channel();
    std::thread::spawn(move || {
        for name in wanted {
            let made = make(&name);
            // Sending fails only if the window has since been closed.
            let _ = sender.send((name, made));
        }
    });
    (names, finished)
}
