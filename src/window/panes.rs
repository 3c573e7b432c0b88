//! Renders the two views to the window's textures.

use super::screen::WindowSurface;
use crate::errors::AppError;
use crate::window::secondary_renderer::SecondaryRenderer;
use spandrel_model::frames::Enu;
use spandrel_model::pose::Pose;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::site::aircraft_hull::{BodyProbe, probes};
use spandrel_model::site::inspector_path::InspectorPosition;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_view::arrange::{ViewKind, ViewRect, render_size_px};
use spandrel_view::exposure::ExposureMeter;
use spandrel_view::feed::Feed;
use spandrel_view::flow::ControlNames;
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
use spandrel_view::video_link::VideoReceiver;
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
    /// Parts of the aircraft's hull.
    hull: Arc<[BodyProbe]>,
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
        let hull = probes(&vehicle).into();
        Self { scenario, vehicle, site, scene, hull }
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
    /// The camera picture that the second device is rendering.
    begun: Option<BegunView>,
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
    pub control_names: ControlNames<'a>,
    /// Language, units and text size.
    pub style: DisplayStyle,
}

/// Inputs for rendering one frame of the views.
#[derive(Clone, Copy)]
pub struct ViewFrame<'a> {
    /// The window.
    pub screen: &'a WindowSurface,
    /// Views in their stacking order.
    pub places: &'a [ViewRect],
    /// State of the flight.
    pub now: &'a LiveMoment,
    /// Telemetry of the flight.
    pub feed: &'a Feed,
    /// The user's view settings.
    pub options: &'a ViewOptions<'a>,
}

impl ViewFrame<'_> {
    /// Returns a view's place, if it is shown.
    fn place(&self, which: ViewKind) -> Option<ViewRect> {
        self.places.iter().find(|view_rect| view_rect.which == which).copied()
    }

    /// Returns a view's picture size in px for its place.
    fn size_px(&self, view_rect: &ViewRect) -> (u32, u32) {
        let window = self.screen.window.inner_size();
        let on_screen = (view_rect.width * f64::from(window.width), view_rect.height * f64::from(window.height));
        render_size_px(on_screen, self.screen.gpu.software.then_some(SOFTWARE_VIEW_PIXELS))
    }
}

/// A view that the second device is rendering.
struct BegunView {
    view_rect: ViewRect,
    size_px: (u32, u32),
    items: Vec<DrawItem>,
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
            begun: None,
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

    /// Renders both views. With a second device, the camera's picture is the one that [`Self::begin_camera`] has begun.
    ///
    /// # Errors
    /// Returns an error if a device fails.
    pub fn draw(&mut self, frame: &ViewFrame, flown: FlownPath) -> Result<Vec<PaneContent>, AppError> {
        let mut display = self.display(frame);
        display.flown = flown;
        let mut shown = Vec::new();
        if let Some(view_rect) = frame.place(ViewKind::Map) {
            let items = hud::large_map(&display, &self.job.scene.outline, logical_size_px(frame.screen, &view_rect));
            shown.push(PaneContent { view_rect, picture: None, items });
            // The other views need no map of their own.
            display.tracks = Vec::new();
        }
        if let Some(view_rect) = frame.place(ViewKind::Instruments) {
            let items = hud::instruments(&display, &self.job.scene.outline, logical_size_px(frame.screen, &view_rect));
            shown.push(PaneContent { view_rect, picture: None, items });
            // The instruments include a map.
            display.tracks = Vec::new();
        }
        if let Some(view_rect) = frame.place(ViewKind::Inspector) {
            let (shot, items) = self.inspector_shot(frame, &view_rect, &display);
            shown.push(self.draw_here(frame.screen, view_rect, &shot, items));
        }
        if let Some(view_rect) = self.camera_place(frame) {
            let content = if self.secondary.is_some() {
                self.finish_camera(frame, view_rect, &display)?
            } else {
                let (shot, items) = self.camera_shot(frame, &view_rect, &display);
                self.draw_here(frame.screen, view_rect, &shot, items)
            };
            shown.push(content);
        }
        // Restores the stacking order of the views.
        shown.sort_by_key(|view| frame.places.iter().position(|view_rect| view_rect.which == view.view_rect.which));
        Ok(shown)
    }

    /// Starts rendering the camera's next picture on the second device, if there is one. The device renders it while the window shows
    /// the last pictures and draws the inspector's next view, which keeps all cores busy.
    ///
    /// # Errors
    /// Returns an error if a device fails.
    pub fn begin_camera(&mut self, frame: &ViewFrame) -> Result<(), AppError> {
        let (Some(view_rect), None, true) = (self.camera_place(frame), &self.begun, self.secondary.is_some()) else {
            return Ok(());
        };
        let mut display = self.display(frame);
        if [ViewKind::Instruments, ViewKind::Map].into_iter().any(|which| frame.place(which).is_some()) {
            // They include a map.
            display.tracks = Vec::new();
        }
        self.begun = Some(self.start_camera(frame, view_rect, &display)?);
        Ok(())
    }

    /// Returns the state of the displays.
    fn display(&mut self, frame: &ViewFrame) -> Hud {
        let (now, options) = (frame.now, frame.options);
        if !self.job.site.has_changes(&now.site_changes) {
            self.job.site = self.job.site.with_changes(now.site_changes.clone());
        }
        self.job.site.set_live_drones(now.live_drones(&self.job.hull));
        let mut display = stage::display(&self.job.stage(), &now.moment, &now.hud, (frame.feed, false), options.map);
        display.style = options.style;
        display.ghost = options.ghost;
        let language = options.style.language;
        if let Some(lesson) = &mut display.lesson {
            lesson.how = how_to(lesson.status.task, language, &options.control_names);
        }
        if let Some(guidance) = &display.guidance {
            display.guidance_how = step_how_to(guidance.step, language, &options.control_names);
        }
        display
    }

    /// Draws a view on the window's device.
    fn draw_here(&mut self, screen: &WindowSurface, view_rect: ViewRect, shot: &Shot, items: Vec<DrawItem>) -> PaneContent {
        let pane = pane(&mut self.panes, screen, view_rect.which, shot.size_px);
        self.renderer.draw(&screen.gpu, shot, &pane.texture);
        PaneContent { view_rect, picture: Some(pane.picture.clone()), items }
    }

    /// Starts the camera's picture on the second device.
    fn start_camera(&mut self, frame: &ViewFrame, view_rect: ViewRect, display: &Hud) -> Result<BegunView, AppError> {
        let (shot, items) = self.camera_shot(frame, &view_rect, display);
        let begun = BegunView { view_rect, size_px: shot.size_px, items };
        if let Some(secondary) = &self.secondary {
            secondary.start(shot)?;
        }
        Ok(begun)
    }

    /// Waits for the camera's picture from the second device. A picture that was begun for another layout is scaled, with the overlay
    /// of the new layout.
    fn finish_camera(&mut self, frame: &ViewFrame, view_rect: ViewRect, display: &Hud) -> Result<PaneContent, AppError> {
        let begun = match self.begun.take() {
            Some(begun) => begun,
            None => self.start_camera(frame, view_rect, display)?,
        };
        let items = if begun.view_rect == view_rect { begun.items } else { self.camera_shot(frame, &view_rect, display).1 };
        let picture = self.secondary.as_ref().map(SecondaryRenderer::picture).transpose()?.map(|(picture, _)| picture);
        let pane = pane(&mut self.panes, frame.screen, ViewKind::Camera, begun.size_px);
        if let Some(picture) = &picture {
            fill(&frame.screen.gpu, &pane.whole, picture);
        }
        let content = PaneContent { view_rect, picture: Some(pane.picture.clone()), items };
        self.last_image = picture;
        Ok(content)
    }

    /// Returns the camera's last image, without the head-up display.
    pub fn camera(&self, screen: &WindowSurface) -> Result<Option<Picture>, AppError> {
        if self.secondary.is_some() {
            return Ok(self.last_image.clone());
        }
        Ok(self.panes.get(&(ViewKind::Camera as u8)).map(|pane| read(&screen.gpu, &pane.whole)).transpose()?)
    }

    /// Returns the rectangle of the camera's view, which has its sensor's aspect ratio.
    fn camera_place(&self, frame: &ViewFrame) -> Option<ViewRect> {
        let window = frame.screen.window.inner_size();
        let shape = f64::from(window.width.max(1)) / f64::from(window.height.max(1));
        frame.place(ViewKind::Camera).map(|view_rect| view_rect.fit_aspect(self.job.vehicle.camera.aspect(), shape))
    }

    /// Returns the inspector's shot and overlay.
    fn inspector_shot(&mut self, frame: &ViewFrame, view_rect: &ViewRect, display: &Hud) -> (Shot, Vec<DrawItem>) {
        let (stage, moment, options) = (self.job.stage(), &frame.now.moment, frame.options);
        let meter = &mut self.exposure_meters[0];
        let shot = stage.inspector_view(&options.inspector_camera, moment, frame.size_px(view_rect), meter);
        let mut items = overlay_items(&stage, &shot, moment, display, options);
        items.extend(stage.drone_marker(&shot, moment, options.style));
        (shot, items)
    }

    /// Returns the camera's shot and overlay.
    fn camera_shot(&mut self, frame: &ViewFrame, view_rect: &ViewRect, display: &Hud) -> (Shot, Vec<DrawItem>) {
        let now = &frame.now.moment;
        let video = self.video.receive(now, frame.feed.video_margin_db(now.at));
        let (stage, moment, meter) = (self.job.stage(), &video.moment, &mut self.exposure_meters[1]);
        let shot = stage.camera_frame(moment, frame.size_px(view_rect), meter).with_lost_blocks(video.lost_blocks);
        let mut items = overlay_items(&stage, &shot, moment, display, frame.options);
        items.extend(hud::layout_px(display, logical_size_px(frame.screen, view_rect)));
        (shot, items)
    }
}

/// Returns the overlay of both views: the path, the lesson's targets, and the ghost.
fn overlay_items(stage: &Stage, shot: &Shot, moment: &SceneMoment, display: &Hud, options: &ViewOptions) -> Vec<DrawItem> {
    // A lesson explains the ribbon and the gates.
    let aids = if display.lesson.is_some() && options.path_aids != PathAids::None { PathAids::Full } else { options.path_aids };
    let mut items = stage.path_items(shot, moment, display.guidance.as_ref(), aids);
    items.extend(stage.lesson_items(shot, display.lesson.as_ref()));
    items.extend(stage.ghost_items(shot, options.ghost));
    items
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
