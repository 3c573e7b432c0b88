//! The two views as textures of the window.

use super::screen::Screen;
use crate::app::errors::AppError;
use crate::base::time::SimTime;
use crate::scenario::Scenario;
use crate::site::Site;
use crate::vehicle::Vehicle;
use crate::view::arrange::{Place, Which, drawn_px};
use crate::view::feed::Feed;
use crate::view::gaze::Gaze;
use crate::view::gpu::{Renderer, picture_texture, read};
use crate::view::hud::{self, Item};
use crate::view::live::Now;
use crate::view::picture::Picture;
use crate::view::quality::Quality;
use crate::view::scene::Scene;
use crate::view::stage::{self, Stage};
use std::collections::BTreeMap;

/// Without a graphics card a view has so many pixels, whatever its size on the screen (issue: 640 x 360 each on two cores).
const SOFTWARE_PX: f64 = 640.0 * 360.0;

/// A job that can be drawn.
pub struct Job {
    /// What is to do.
    pub scenario: Scenario,
    /// With what.
    pub vehicle: Vehicle,
    site: Site,
    scene: Scene,
}

impl Job {
    /// Builds site and scene: seconds of work.
    pub fn build(scenario: Scenario, vehicle: Vehicle, seed: u64, quality: &Quality, at: SimTime) -> Self {
        let site = Site::build(&scenario, seed);
        let scene = Scene::build(&scenario, &site, &vehicle, quality, at);
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
    panes: BTreeMap<u8, Pane>,
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
        let renderer = Renderer::new(&screen.gpu, quality, &job.scene);
        Self { renderer, job, panes: BTreeMap::new() }
    }

    /// From where the inspector stands to the aircraft, m.
    pub fn to_aircraft(&self, now: &Now) -> crate::base::frames::Vec3<crate::base::frames::Enu> {
        now.moment.drone.position_m - self.job.scenario.ground_team.inspector_m
    }

    /// Gives back what it holds of the window's painter.
    pub fn close(self, screen: &mut Screen) {
        self.panes.values().for_each(|pane| screen.painter.free_texture(&pane.id));
    }

    /// Draws both views.
    pub fn draw(&mut self, screen: &mut Screen, places: &[Place], now: &Now, feed: &Feed, gaze: &Gaze, map: bool) -> Vec<Shown> {
        if self.job.site.traffic().gates() != &now.gates {
            self.job.site = self.job.site.with_gates(now.gates.clone());
        }
        places.iter().map(|place| self.draw_one(screen, place, now, feed, gaze, map)).collect()
    }

    /// The camera's view as it was drawn last, without its display.
    pub fn camera(&self, screen: &Screen) -> Result<Option<Picture>, AppError> {
        Ok(self.panes.get(&(Which::Camera as u8)).map(|pane| read(&screen.gpu, &pane.whole)).transpose()?)
    }

    fn draw_one(&mut self, screen: &mut Screen, place: &Place, now: &Now, feed: &Feed, gaze: &Gaze, map: bool) -> Shown {
        let window = screen.window.inner_size();
        let on_screen = (place.width * f64::from(window.width), place.height * f64::from(window.height));
        let size_px = drawn_px(on_screen, screen.gpu.software.then_some(SOFTWARE_PX));
        let aspect = f64::from(size_px.0) / f64::from(size_px.1);
        let (job, moment) = (&self.job, &now.moment);
        let stage = job.stage();
        let (shot, items) = match place.which {
            Which::Inspector => {
                let shot = stage.looking(gaze, moment, size_px);
                let items = hud::marker(&shot.eye, aspect, moment.drone.position_m);
                (shot, items)
            }
            Which::Camera => {
                let display = stage::display(&stage, moment, &now.told, (feed, false), map);
                (stage.camera(moment, size_px), hud::layout(&display, aspect))
            }
        };
        let pane = pane(&mut self.panes, screen, place.which, size_px);
        self.renderer.draw(&screen.gpu, &shot, &pane.texture);
        Shown { place: *place, picture: pane.id, items }
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
