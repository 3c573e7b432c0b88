//! Renders the two views to the window's textures.

use super::screen::WindowSurface;
use crate::errors::AppError;
use crate::window::secondary_renderer::SecondaryRenderer;
use spandrel_model::frames::Enu;
use spandrel_model::pose::Pose;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::site::inspector_path::InspectorPosition;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_view::arrange::{ViewKind, ViewRect, render_size_px};
use spandrel_view::exposure::ExposureMeter;
use spandrel_view::feed::Feed;
use spandrel_view::flow::KeyNames;
use spandrel_view::flown_path::FlownPath;
use spandrel_view::gpu::{PanePicture, Renderer, fill, picture_texture, read};
use spandrel_view::hud::lesson_words::{how_to, step_how_to};
use spandrel_view::hud::{self, DisplayStyle, DrawItem, Hud};
use spandrel_view::inspector_camera::InspectorCamera;
use spandrel_view::live::LiveMoment;
use spandrel_view::path_guide::PathAids;
use spandrel_view::picture::Picture;
use spandrel_view::quality::Quality;
use spandrel_view::scene::{LoadingStep, Scene};
use spandrel_view::shot::Shot;
use spandrel_view::stage::{self, SceneMoment, Stage};
use spandrel_view::video_link::{ReceivedFrame, VideoReceiver};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Number of pixels in a view without a graphics card, regardless of the view's size on the screen (issue: 640 x 360
/// each on two cores).
const SOFTWARE_VIEW_PIXELS: f64 = 640.0 * 360.0;

/// A flight whose scene has been built.
pub struct RenderJob {
    /// The flight's scenario.
    pub scenario: Scenario,
    /// The flight's aircraft.
    pub vehicle: Vehicle,
    site: Site,
    scene: Arc<Scene>,
}

impl RenderJob {
    /// Builds the site and the scene, which takes several seconds; reports each step before it begins.
    pub fn build(
        scenario: Scenario,
        vehicle: Vehicle,
        seed: u64,
        (quality, at): (&Quality, SimTime),
        report: &dyn Fn(LoadingStep),
    ) -> Self {
        report(LoadingStep::Site);
        let site = Site::build(&scenario, seed);
        let scene = Arc::new(Scene::build_in_steps(&scenario, &site, &vehicle, (quality, at), report));
        report(LoadingStep::Upload);
        Self { scenario, vehicle, site, scene }
    }

    fn stage(&self) -> Stage<'_> {
        Stage { scenario: &self.scenario, vehicle: &self.vehicle, site: &self.site, scene: &self.scene }
    }
}

/// A view's texture.
struct ViewPane {
    whole: wgpu::Texture,
    texture: wgpu::TextureView,
    picture: PanePicture,
    size_px: (u32, u32),
}

/// A flight's two views.
pub struct ViewPanes {
    job: RenderJob,
    renderer: Renderer,
    /// Second device for the camera's view, if the window's own device is a software renderer.
    secondary: Option<SecondaryRenderer>,
    panes: BTreeMap<u8, ViewPane>,
    /// The second device's last image.
    last_image: Option<Picture>,
    /// Exposure meters for the inspector's view and the camera's view.
    exposure_meters: [ExposureMeter; 2],
    /// Receiver of the camera's picture.
    video: VideoReceiver,
}

/// The user's view settings.
#[derive(Debug, Clone, Copy)]
pub struct ViewOptions<'a> {
    /// Direction and zoom of the inspector's view.
    pub inspector_camera: InspectorCamera,
    /// Whether the reference paths may be shown on a map.
    pub map: bool,
    /// How much of the path is drawn into the pictures.
    pub path_aids: PathAids,
    /// Ghost of an earlier flight.
    pub ghost: Option<Pose<Enu>>,
    /// Names of the keys.
    pub key_names: &'a KeyNames,
    /// Language, units and text size.
    pub style: DisplayStyle,
}

/// A view to show.
pub struct PaneContent {
    /// Position in the window.
    pub view_rect: ViewRect,
    /// Rendered image; `None` for instruments and the map.
    pub picture: Option<PanePicture>,
    /// The view's overlay.
    pub items: Vec<DrawItem>,
}

impl ViewPanes {
    /// Uploads the scene to the device.
    pub fn new(screen: &WindowSurface, quality: Quality, job: RenderJob) -> Self {
        let open = || {
            SecondaryRenderer::open(quality, Arc::clone(&job.scene))
                .inspect_err(|error| tracing::info!("rendering both views on one device: {error}"))
        };
        let aside = if screen.gpu.software { open().ok() } else { None };
        let renderer = Renderer::new(&screen.gpu, quality, &job.scene);
        Self {
            renderer,
            secondary: aside,
            job,
            panes: BTreeMap::new(),
            last_image: None,
            exposure_meters: Default::default(),
            video: VideoReceiver::default(),
        }
    }

    /// Returns the vector from the inspector to the aircraft in meters.
    pub fn inspector_to_aircraft(&self, now: &LiveMoment) -> spandrel_model::frames::Vec3<spandrel_model::frames::Enu> {
        now.moment.drone.pose.position_m - self.inspector(now).feet_m
    }

    /// Returns the inspector.
    pub fn inspector(&self, now: &LiveMoment) -> InspectorPosition {
        self.job.site.inspector().at(now.moment.at)
    }

    /// Renders both views.
    ///
    /// # Errors
    /// Returns an error if a device fails.
    pub fn draw(
        &mut self,
        screen: &WindowSurface,
        places: &[ViewRect],
        now: &LiveMoment,
        (feed, flown): (&Feed, FlownPath),
        options: &ViewOptions,
    ) -> Result<Vec<PaneContent>, AppError> {
        if !self.job.site.has_changes(&now.site_changes) {
            self.job.site = self.job.site.with_changes(now.site_changes.clone());
        }
        let mut display = stage::display(&self.job.stage(), &now.moment, &now.hud, (feed, false), options.map);
        display.style = options.style;
        display.ghost = options.ghost;
        display.flown = flown;
        let (language, key) = (options.style.language, |binding: &str| options.key_names.name(binding));
        if let Some(lesson) = &mut display.lesson {
            lesson.how = how_to(lesson.status.task, language, &key);
        }
        if let Some(guidance) = &display.guidance {
            display.guidance_how = step_how_to(guidance.step, language, &key);
        }
        let video = self.video.receive(&now.moment, feed.video_margin_db(now.moment.at));
        let mut shown = Vec::new();
        if let Some(view_rect) = places.iter().find(|view_rect| view_rect.which == ViewKind::Map) {
            let items = hud::large_map(&display, &self.job.scene.outline, logical_size_px(screen, view_rect));
            shown.push(PaneContent { view_rect: *view_rect, picture: None, items });
            // The other views need no map of their own.
            display.tracks = Vec::new();
        }
        if let Some(view_rect) = places.iter().find(|view_rect| view_rect.which == ViewKind::Instruments) {
            let items = hud::instruments(&display, &self.job.scene.outline, logical_size_px(screen, view_rect));
            shown.push(PaneContent { view_rect: *view_rect, picture: None, items });
            // The instruments include a map.
            display.tracks = Vec::new();
        }
        // Start the camera's view first, because the second device renders it while this device renders the other view.
        let mut order: Vec<&ViewRect> =
            places.iter().filter(|view_rect| !matches!(view_rect.which, ViewKind::Instruments | ViewKind::Map)).collect();
        order.sort_by_key(|view_rect| view_rect.which != ViewKind::Camera);
        let mut begun = false;
        for view_rect in order {
            let view_rect = self.fit_view(screen, *view_rect);
            let (shot, items) = self.render(screen, &view_rect, (&now.moment, &video), &display, options);
            let pane = pane(&mut self.panes, screen, view_rect.which, shot.size_px);
            shown.push(PaneContent { view_rect, picture: Some(pane.picture.clone()), items });
            match &self.secondary {
                Some(aside) if view_rect.which == ViewKind::Camera => {
                    aside.start(shot)?;
                    begun = true;
                }
                _ => self.renderer.draw(&screen.gpu, &shot, &pane.texture),
            }
        }
        if begun {
            self.copy_secondary_image(screen)?;
        }
        // Restores the stacking order of the views.
        shown.sort_by_key(|view| places.iter().position(|view_rect| view_rect.which == view.view_rect.which));
        Ok(shown)
    }

    fn copy_secondary_image(&mut self, screen: &WindowSurface) -> Result<(), AppError> {
        let Some(aside) = &self.secondary else { return Ok(()) };
        let (picture, _) = aside.picture()?;
        if let Some(pane) = self.panes.get(&(ViewKind::Camera as u8)) {
            fill(&screen.gpu, &pane.whole, &picture);
        }
        self.last_image = Some(picture);
        Ok(())
    }

    /// Returns the camera's last image, without the head-up display.
    pub fn camera(&self, screen: &WindowSurface) -> Result<Option<Picture>, AppError> {
        if self.secondary.is_some() {
            return Ok(self.last_image.clone());
        }
        Ok(self.panes.get(&(ViewKind::Camera as u8)).map(|pane| read(&screen.gpu, &pane.whole)).transpose()?)
    }

    /// Returns a view's rectangle. The camera's view has its sensor's aspect ratio.
    fn fit_view(&self, screen: &WindowSurface, view_rect: ViewRect) -> ViewRect {
        let window = screen.window.inner_size();
        match view_rect.which {
            ViewKind::Inspector | ViewKind::Instruments | ViewKind::Map => view_rect,
            ViewKind::Camera => {
                let shape = f64::from(window.width.max(1)) / f64::from(window.height.max(1));
                view_rect.fit_aspect(self.job.vehicle.camera.aspect(), shape)
            }
        }
    }

    /// Returns a view's shot and overlay.
    fn render(
        &mut self,
        screen: &WindowSurface,
        view_rect: &ViewRect,
        (moment, video): (&SceneMoment, &ReceivedFrame),
        display: &Hud,
        options: &ViewOptions,
    ) -> (Shot, Vec<DrawItem>) {
        let window = screen.window.inner_size();
        let on_screen = (view_rect.width * f64::from(window.width), view_rect.height * f64::from(window.height));
        let size_px = render_size_px(on_screen, screen.gpu.software.then_some(SOFTWARE_VIEW_PIXELS));
        let (stage, [eyes, film]) = (self.job.stage(), &mut self.exposure_meters);
        // A lesson explains the ribbon and the gates.
        let aids =
            if display.lesson.is_some() && options.path_aids != PathAids::None { PathAids::Full } else { options.path_aids };
        match view_rect.which {
            ViewKind::Inspector | ViewKind::Instruments | ViewKind::Map => {
                let shot = stage.inspector_view(&options.inspector_camera, moment, size_px, eyes);
                let mut items = stage.path_items(&shot, moment, display.guidance.as_ref(), aids);
                items.extend(stage.lesson_items(&shot, display.lesson.as_ref()));
                items.extend(stage.ghost_items(&shot, options.ghost));
                items.extend(stage.drone_marker(&shot, moment, options.style));
                (shot, items)
            }
            ViewKind::Camera => {
                let moment = &video.moment;
                let shot = stage.camera_frame(moment, size_px, film).with_lost_blocks(video.lost_blocks);
                let mut items = stage.path_items(&shot, moment, display.guidance.as_ref(), aids);
                items.extend(stage.lesson_items(&shot, display.lesson.as_ref()));
                items.extend(stage.ghost_items(&shot, options.ghost));
                items.extend(hud::layout_px(display, logical_size_px(screen, view_rect)));
                (shot, items)
            }
        }
    }
}

/// Returns a view's size in px at standard pixel density: text keeps its normal size on the screen, so displays with a larger
/// scale factor use more pixels for it.
fn logical_size_px(screen: &WindowSurface, view_rect: &ViewRect) -> (f64, f64) {
    let (window, scale) = (screen.window.inner_size(), screen.window.scale_factor());
    (view_rect.width * f64::from(window.width) / scale, view_rect.height * f64::from(window.height) / scale)
}

/// Returns a view's texture, and recreates it if the size has changed.
fn pane<'a>(panes: &'a mut BTreeMap<u8, ViewPane>, screen: &WindowSurface, which: ViewKind, size_px: (u32, u32)) -> &'a ViewPane {
    let key = which as u8;
    if panes.get(&key).is_none_or(|pane| pane.size_px != size_px) {
        let whole = picture_texture(&screen.gpu, size_px);
        let texture = whole.create_view(&wgpu::TextureViewDescriptor::default());
        let picture = screen.painter.picture(&screen.gpu, &texture);
        panes.insert(key, ViewPane { whole, texture, picture, size_px });
    }
    &panes[&key]
}
