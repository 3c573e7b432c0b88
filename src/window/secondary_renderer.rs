//! A second device in software, for a second view.
//!
//! A software device works on the corners of a picture in one thread and on its pixels in all others, one after the other: a second core
//! rests meanwhile. A second device fills that rest with another picture.

use spandrel_view::gpu::{DrawCounts, Gpu, GpuError, Renderer, picture_texture, read};
use spandrel_view::picture::Picture;
use spandrel_view::quality::Quality;
use spandrel_view::scene::Scene;
use spandrel_view::shot::Shot;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};

/// What has been drawn, and what it cost.
pub type RenderedShot = (Picture, DrawCounts);

/// Draws shots in a thread of its own, on a software device of its own. Ends when it is dropped.
pub struct SecondaryRenderer {
    /// Taken when it ends.
    shots: Option<Sender<Shot>>,
    pictures: Receiver<Result<RenderedShot, GpuError>>,
    painter: Option<JoinHandle<()>>,
}

impl SecondaryRenderer {
    /// Opens the device; the scene is uploaded in the other thread.
    ///
    /// # Errors
    /// When there is no device in software, or it does not open.
    pub fn open(quality: Quality, scene: Arc<Scene>) -> Result<Self, GpuError> {
        let gpu = Gpu::open_software()?;
        let (shots, ordered) = channel();
        let (done, pictures) = channel();
        let painter = thread::spawn(move || work(&gpu, quality, scene, &ordered, &done));
        Ok(Self { shots: Some(shots), pictures, painter: Some(painter) })
    }

    /// Begins a picture.
    ///
    /// # Errors
    /// When its thread has ended.
    pub fn start(&self, shot: Shot) -> Result<(), GpuError> {
        self.shots.as_ref().and_then(|shots| shots.send(shot).ok()).ok_or_else(ended)
    }

    /// Waits for the picture that was begun first of those not yet taken.
    ///
    /// # Errors
    /// When the device fails.
    pub fn picture(&self) -> Result<RenderedShot, GpuError> {
        self.pictures.recv().map_err(|_| ended())?
    }
}

impl Drop for SecondaryRenderer {
    fn drop(&mut self) {
        drop(self.shots.take());
        // A driver that still draws when the program ends may fall over. A painter that panicked has said so.
        if let Some(painter) = self.painter.take() {
            let _ = painter.join();
        }
    }
}

fn ended() -> GpuError {
    GpuError::Failed("the thread that draws a second view has ended".to_owned())
}

fn work(gpu: &Gpu, quality: Quality, scene: Arc<Scene>, shots: &Receiver<Shot>, done: &Sender<Result<RenderedShot, GpuError>>) {
    let mut renderer = Renderer::new(gpu, quality, &scene);
    drop(scene);
    let mut canvas = picture_texture(gpu, (1, 1));
    for shot in shots {
        if (canvas.width(), canvas.height()) != shot.size_px {
            canvas = picture_texture(gpu, shot.size_px);
        }
        renderer.draw(gpu, &shot, &canvas.create_view(&wgpu::TextureViewDescriptor::default()));
        let picture = read(gpu, &canvas).and_then(|picture| gpu.fault().map_or(Ok(picture), Err));
        if done.send(picture.map(|picture| (picture, renderer.counts()))).is_err() {
            return;
        }
    }
}
