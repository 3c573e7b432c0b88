//! A site on a graphics device, for rendering one image at a time.

use crate::errors::AppError;
use crate::io::progress::ProgressLog;
use spandrel_model::scenario::{PlacedDefect, Scenario};
use spandrel_model::site::Site;
use spandrel_model::site::changes::SiteChanges;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_view::gpu::{Gpu, Overlay, Renderer};
use spandrel_view::hud;
use spandrel_view::masks::LabelMask;
use spandrel_view::picture::Picture;
use spandrel_view::quality::Quality;
use spandrel_view::scene::{LoadingStep, Scene};
use spandrel_view::shot::Shot;
use spandrel_view::stage::Stage;

/// Returns the aspect ratio (width divided by height).
pub fn aspect((width, height): (u32, u32)) -> f64 {
    f64::from(width) / f64::from(height)
}

/// Converts an option's value in seconds to a simulation time.
pub fn sim_time_arg(name: &str, seconds: f64) -> Result<SimTime, AppError> {
    if (0.0..=86_400.0).contains(&seconds) {
        Ok(SimTime::from_s(seconds))
    } else {
        Err(AppError::invalid(format!("--{name} {seconds}: out of range (allowed: 0 to 86400 s of simulation time)")))
    }
}

/// A site with its scene and the device that renders it.
pub struct SceneDrawing {
    /// Graphics device or software renderer.
    pub gpu: Gpu,
    site: Site,
    scene: Scene,
    quality: Quality,
}

impl SceneDrawing {
    /// Opens a device and builds the site, which takes several seconds.
    pub fn new(scenario: &Scenario, vehicle: &Vehicle, seed: u64, quality: Quality, at: SimTime) -> Result<Self, AppError> {
        let progress = ProgressLog::start("loading scene");
        let drawing = Self::new_in_steps(scenario, vehicle, seed, (quality, at), &|_| {})?;
        progress.finish();
        Ok(drawing)
    }

    /// Builds the site like [`Self::new`], and reports each step before it begins.
    ///
    /// # Errors
    /// Returns an error if there is no graphics device.
    pub fn new_in_steps(
        scenario: &Scenario,
        vehicle: &Vehicle,
        seed: u64,
        (quality, at): (Quality, SimTime),
        report: &dyn Fn(LoadingStep),
    ) -> Result<Self, AppError> {
        let gpu = Gpu::open()?;
        tracing::info!("rendering with {}", gpu.name);
        Ok(Self::build(gpu, scenario, vehicle, seed, (quality, at), report))
    }

    /// Builds the site for a device that is already open.
    pub fn on(gpu: Gpu, scenario: &Scenario, vehicle: &Vehicle, seed: u64, (quality, at): (Quality, SimTime)) -> Self {
        Self::build(gpu, scenario, vehicle, seed, (quality, at), &|_| {})
    }

    fn build(
        gpu: Gpu,
        scenario: &Scenario,
        vehicle: &Vehicle,
        seed: u64,
        (quality, at): (Quality, SimTime),
        report: &dyn Fn(LoadingStep),
    ) -> Self {
        report(LoadingStep::Site);
        let site = Site::build(scenario, seed);
        let scene = Scene::build_in_steps(scenario, &site, vehicle, (&quality, at), report);
        report(LoadingStep::Upload);
        Self { gpu, site, scene, quality }
    }

    /// Returns the device for the next site.
    pub fn into_gpu(self) -> Gpu {
        self.gpu
    }

    /// Sets the bridge closures and the inspector's walks to those of a recorded flight.
    pub fn with_changes(self, changes: SiteChanges) -> Self {
        Self { site: self.site.with_changes(changes), ..self }
    }

    /// Returns the static parts of the scene.
    pub fn stage<'a>(&'a self, scenario: &'a Scenario, vehicle: &'a Vehicle) -> Stage<'a> {
        Stage { scenario, vehicle, site: &self.site, scene: &self.scene }
    }

    /// Creates a renderer for a sequence of images.
    pub fn scene_renderer(&self) -> SceneRenderer<'_> {
        SceneRenderer {
            gpu: &self.gpu,
            renderer: Renderer::new(&self.gpu, self.quality, &self.scene),
            overlay: Overlay::new(&self.gpu),
        }
    }

    /// Returns the site.
    pub fn site(&self) -> &Site {
        &self.site
    }

    /// Returns the site's defects.
    pub fn defects(&self) -> &[PlacedDefect] {
        self.site.defects()
    }
}

/// Renders shots of a scene on its device.
pub struct SceneRenderer<'a> {
    gpu: &'a Gpu,
    renderer: Renderer,
    overlay: Overlay,
}

impl SceneRenderer<'_> {
    /// Renders a shot with its overlay.
    pub fn draw(&mut self, shot: &Shot, items: &[hud::DrawItem]) -> Result<Picture, AppError> {
        Ok(self.renderer.picture_with(self.gpu, shot, &mut self.overlay, items)?)
    }

    /// Returns the element and defect that each pixel of a shot shows.
    pub fn labels(&mut self, shot: &Shot) -> Result<LabelMask, AppError> {
        Ok(self.renderer.labels(self.gpu, shot)?)
    }
}
