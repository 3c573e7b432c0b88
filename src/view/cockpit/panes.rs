//! The two views as textures of the window.

use super::screen::Screen;
use crate::aside::Aside;
use crate::errors::AppError;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::Vehicle;
use spandrel_view::arrange::{Place, Which, drawn_px};
use spandrel_view::exposure::Adaptation;
use spandrel_view::feed::Feed;
use spandrel_view::gaze::Gaze;
use spandrel_view::gpu::{Renderer, fill, picture_texture, read};
use spandrel_view::hud::{self, Item};
use spandrel_view::live::Now;
use spandrel_view::picture::Picture;
use spandrel_view::quality::Quality;
use spandrel_view::scene::Scene;
use spandrel_view::shot::Shot;
use spandrel_view::stage::{self, Stage};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Without a graphics card a view has so many pixels, whatever its size on the screen (issue: 640 x 360 each on two cores).
const SOFTWARE_PX: f64 = 640.0 * 360.0;

/// A job that can be drawn.
pub struct Job {
    /// What is to do.
    pub scenario: Scenario,
    /// With what.
    pub vehicle: Vehicle,
    site: Site,
    scene: Arc<Scene>,
}

impl Job {
    /// Builds site and scene: seconds of work.
    pub fn build(scenario: Scenario, vehicle: Vehicle, seed: u64, quality: &Quality, at: SimTime) -> Self {
        let site = Site::build(&scenario, seed);
        let scene = Arc::new(Scene::build(&scenario, &site, &vehicle, quality, at));
        Self { scenario, vehicle, site, scene }
    }

    fn stage(&self) -> Stage<'_> {
        Stage { scenario: &self.scenario, vehicle: &self.vehicle, site: &self.site, scene: &self.scene }
    }
}

/// A view's picture.
struct Pane {
    whole: wgpu::Texture,
    texture: wgpu::TextureView,
    id: egui::TextureId,
    size_px: (u32, u32),
}

/// Both views.
pub struct Panes {
    job: Job,
    renderer: Renderer,
    /// Draws what the camera sees, where the window's own device is software too.
    aside: Option<Aside>,
    panes: BTreeMap<u8, Pane>,
    /// What was drawn aside last.
    seen: Option<Picture>,
    /// How the views follow the light: the inspector's, the camera's.
    meters: [Adaptation; 2],
}

/// One view as it is to be shown.
pub struct Shown {
    /// Where.
    pub place: Place,
    /// Its picture.
    pub picture: egui::TextureId,
    /// What lies over it.
    pub items: Vec<Item>,
}

impl Panes {
    /// Uploads a job's scene.
    pub fn new(screen: &Screen, quality: Quality, job: Job) -> Self {
        let open = || {
            Aside::open(quality, Arc::clone(&job.scene))
                .inspect_err(|error| tracing::info!("one device draws both views: {error}"))
        };
        let aside = if screen.gpu.software { open().ok() } else { None };
        let renderer = Renderer::new(&screen.gpu, quality, &job.scene);
        Self { renderer, aside, job, panes: BTreeMap::new(), seen: None, meters: Default::default() }
    }

    /// From where the inspector stands to the aircraft, m.
    pub fn to_aircraft(&self, now: &Now) -> spandrel_model::frames::Vec3<spandrel_model::frames::Enu> {
        now.moment.drone.position_m - self.job.scenario.ground_team.inspector_m
    }

    /// Gives back what it holds of the window's painter.
    pub fn close(self, screen: &mut Screen) {
        self.panes.values().for_each(|pane| screen.painter.free_texture(&pane.id));
    }

    /// Draws both views.
    ///
    /// # Errors
    /// When a device fails.
    pub fn draw(
        &mut self,
        screen: &mut Screen,
        places: &[Place],
        now: &Now,
        feed: &Feed,
        gaze: &Gaze,
        map: bool,
    ) -> Result<Vec<Shown>, AppError> {
        if self.job.site.traffic().gates() != &now.gates {
            self.job.site = self.job.site.with_gates(now.gates.clone());
        }
        // What is drawn aside begins first: the other view is worked out and drawn meanwhile.
        let mut order: Vec<&Place> = places.iter().collect();
        order.sort_by_key(|place| place.which != Which::Camera);
        let (mut shown, mut begun) = (Vec::new(), false);
        for place in order {
            let place = self.framed(screen, *place);
            let (shot, items) = self.look(screen, &place, now, feed, gaze, map);
            let pane = pane(&mut self.panes, screen, place.which, shot.size_px);
            shown.push(Shown { place, picture: pane.id, items });
            match &self.aside {
                Some(aside) if place.which == Which::Camera => {
                    aside.begin(shot)?;
                    begun = true;
                }
                _ => self.renderer.draw(&screen.gpu, &shot, &pane.texture),
            }
        }
        if begun {
            self.take_aside(screen)?;
        }
        // One over the other as they were placed.
        shown.sort_by_key(|view| places.iter().position(|place| place.which == view.place.which));
        Ok(shown)
    }

    fn take_aside(&mut self, screen: &Screen) -> Result<(), AppError> {
        let Some(aside) = &self.aside else { return Ok(()) };
        let (picture, _) = aside.picture()?;
        if let Some(pane) = self.panes.get(&(Which::Camera as u8)) {
            fill(&screen.gpu, &pane.whole, &picture);
        }
        self.seen = Some(picture);
        Ok(())
    }

    /// The camera's view as it was drawn last, without its display.
    pub fn camera(&self, screen: &Screen) -> Result<Option<Picture>, AppError> {
        if self.aside.is_some() {
            return Ok(self.seen.clone());
        }
        Ok(self.panes.get(&(Which::Camera as u8)).map(|pane| read(&screen.gpu, &pane.whole)).transpose()?)
    }

    /// A view's picture in its place: the camera's has its sensor's shape.
    fn framed(&self, screen: &Screen, place: Place) -> Place {
        let window = screen.window.inner_size();
        match place.which {
            Which::Inspector => place,
            Which::Camera => {
                let shape = f64::from(window.width.max(1)) / f64::from(window.height.max(1));
                place.fitted(self.job.vehicle.camera.aspect(), shape)
            }
        }
    }

    /// What a view shows, and what lies over it.
    fn look(&mut self, screen: &Screen, place: &Place, now: &Now, feed: &Feed, gaze: &Gaze, map: bool) -> (Shot, Vec<Item>) {
        let window = screen.window.inner_size();
        let on_screen = (place.width * f64::from(window.width), place.height * f64::from(window.height));
        let size_px = drawn_px(on_screen, screen.gpu.software.then_some(SOFTWARE_PX));
        let moment = &now.moment;
        let (stage, [eyes, film]) = (self.job.stage(), &mut self.meters);
        match place.which {
            Which::Inspector => {
                let shot = stage.looking(gaze, moment, size_px, eyes);
                let items = stage.marked(&shot, moment);
                (shot, items)
            }
            Which::Camera => {
                let display = stage::display(&stage, moment, &now.told, (feed, false), map);
                // Type is as large as it is read: a display of a larger scale has more pixels for it.
                let scale = screen.window.scale_factor();
                (stage.filmed(moment, size_px, film), hud::layout_px(&display, (on_screen.0 / scale, on_screen.1 / scale)))
            }
        }
    }
}

/// The texture of a view, made anew when its size has changed.
fn pane<'a>(panes: &'a mut BTreeMap<u8, Pane>, screen: &mut Screen, which: Which, size_px: (u32, u32)) -> &'a Pane {
    let key = which as u8;
    if panes.get(&key).is_none_or(|pane| pane.size_px != size_px) {
        if let Some(old) = panes.remove(&key) {
            screen.painter.free_texture(&old.id);
        }
        let whole = picture_texture(&screen.gpu, size_px);
        let texture = whole.create_view(&wgpu::TextureViewDescriptor::default());
        let id = screen.painter.register_native_texture(&screen.gpu.device, &texture, wgpu::FilterMode::Linear);
        panes.insert(key, Pane { whole, texture, id, size_px });
    }
    &panes[&key]
}
