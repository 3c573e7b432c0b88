//! Renders a second view on a second software device.
//!
//! A software device processes an image's vertices in one thread and then its pixels in all other threads, so most
//! cores are idle during the vertex phase. A second device uses that time to render another image.

use spandrel_view::gpu::{DrawCounts, Gpu, GpuError, Renderer, picture_texture, read};
use spandrel_view::picture::Picture;
use spandrel_view::quality::Quality;
use spandrel_view::scene::Scene;
use spandrel_view::shot::Shot;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};

/// A rendered image and the number of draws.
pub type RenderedShot = (Picture, DrawCounts);

/// Renders shots in a separate thread, on a separate software device. The thread ends when this is dropped.
pub struct SecondaryRenderer {
    /// Set to `None` to end the thread.
    shots: Option<Sender<Shot>>,
    pictures: Receiver<Result<RenderedShot, GpuError>>,
    render_thread: Option<JoinHandle<()>>,
}

impl SecondaryRenderer {
    /// Opens the device; the other thread uploads the scene.
    ///
    /// # Errors
    /// Returns an error if there is no software device, or it cannot be opened.
    pub fn open(quality: Quality, scene: Arc<Scene>) -> Result<Self, GpuError> {
        let gpu = Gpu::open_software()?;
        let (shots, ordered) = channel();
        let (done, pictures) = channel();
        let render_thread = thread::spawn(move || render_loop(&gpu, quality, scene, &ordered, &done));
        Ok(Self { shots: Some(shots), pictures, render_thread: Some(render_thread) })
    }

    /// Starts rendering an image.
    ///
    /// # Errors
    /// Returns an error if the thread has ended.
    pub fn start(&self, shot: Shot) -> Result<(), GpuError> {
        self.shots.as_ref().and_then(|shots| shots.send(shot).ok()).ok_or_else(ended)
    }

    /// Waits for the oldest pending image and returns it.
    ///
    /// # Errors
    /// Returns an error if the device fails.
    pub fn picture(&self) -> Result<RenderedShot, GpuError> {
        self.pictures.recv().map_err(|_| ended())?
    }
}

impl Drop for SecondaryRenderer {
    fn drop(&mut self) {
        drop(self.shots.take());
        // A driver can crash if it is still rendering when the program exits. A panic in the thread has already been
        // reported.
        if let Some(render_thread) = self.render_thread.take() {
            let _ = render_thread.join();
        }
    }
}

fn ended() -> GpuError {
    GpuError::Failed("the thread that renders the second view has ended".to_owned())
}

fn render_loop(
    gpu: &Gpu,
    quality: Quality,
    scene: Arc<Scene>,
    shots: &Receiver<Shot>,
    done: &Sender<Result<RenderedShot, GpuError>>,
) {
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
