//! A site prepared for rendering, and cameras in it.

use spandrel_model::frames::{Enu, Rotation, Vec3};
use spandrel_model::math;
use spandrel_model::pose::Pose;
use spandrel_model::scenario::Scenario;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};
use spandrel_view::camera::PinholeCamera;
use spandrel_view::gpu::{Gpu, Overlay, Renderer};
use spandrel_view::hud::DrawItem;
use spandrel_view::picture::Picture;
use spandrel_view::quality::Quality;
use spandrel_view::scene::{DronePose, Scene};
use spandrel_view::shot::Shot;
use spandrel_view::stage::{SceneMoment, Stage, camera_aimed_at, drone_on_pad};
use std::sync::Arc;

/// A midsummer morning, 2026-06-21 09:00 UTC: high sun in the southeast.
pub const MORNING_UNIX_S: i64 = 1_782_032_400;

pub fn at(east: f64, north: f64, up: f64) -> Vec3<Enu> {
    Vec3::new(east, north, up)
}

/// Returns the TASBID job.
pub fn two_bridges() -> Scenario {
    let text = spandrel_model::shipped::TWO_BRIDGES;
    spandrel_model::scenario::read("two-bridges.toml", text, &|_| Err("none".into())).unwrap()
}

/// Returns the TASBID job on a bright summer day.
pub fn sunny_job() -> Scenario {
    let mut scenario = two_bridges();
    scenario.light.start_unix_s = MORNING_UNIX_S;
    scenario.light.cloud_cover = 0.2;
    scenario
}

/// Returns the girder bridge's job on a sunny morning.
pub fn girder_job() -> Scenario {
    let text = spandrel_model::shipped::GIRDER;
    let mut scenario = spandrel_model::scenario::read("girder.toml", text, &|_| Err("none".into())).unwrap();
    scenario.light.cloud_cover = 0.2;
    scenario
}

/// Returns the masonry arch bridge's job on a sunny morning.
pub fn masonry_job() -> Scenario {
    let text = spandrel_model::shipped::MASONRY_ARCH;
    let mut scenario = spandrel_model::scenario::read("masonry-arch.toml", text, &|_| Err("none".into())).unwrap();
    scenario.light.cloud_cover = 0.2;
    scenario
}

/// Returns the TASBID job at dusk: forty minutes after its start time, just after sunset.
pub fn dusk_job() -> Scenario {
    let mut scenario = two_bridges();
    scenario.light.start_unix_s += 2_400;
    scenario
}

/// Returns the aircraft used in the TASBID job.
pub fn phantom() -> Vehicle {
    spandrel_model::vehicle::read("phantom2.toml", spandrel_model::shipped::PHANTOM2).unwrap()
}

/// A site with its renderer.
pub struct Studio {
    pub scenario: Scenario,
    pub vehicle: Vehicle,
    pub site: Site,
    pub scene: Arc<Scene>,
    pub gpu: Gpu,
    /// Simulation time at which the images are drawn.
    pub at: SimTime,
    renderer: Renderer,
    overlay: Overlay,
}

impl Studio {
    /// Creates a studio with the software renderer, which works on every machine.
    pub fn new(scenario: Scenario, seed: u64, quality: &str, at: SimTime) -> Self {
        Self::on(Gpu::open_software().unwrap(), scenario, seed, quality, at)
    }

    pub fn on(gpu: Gpu, scenario: Scenario, seed: u64, quality: &str, at: SimTime) -> Self {
        let quality = Quality::by_name(quality).unwrap();
        let vehicle = phantom();
        let site = Site::build(&scenario, seed);
        let scene = Arc::new(Scene::build(&scenario, &site, &vehicle, &quality, at));
        let renderer = Renderer::new(&gpu, quality, &scene);
        let overlay = Overlay::new(&gpu);
        Self { scenario, vehicle, site, scene, gpu, at, renderer, overlay }
    }

    pub fn stage(&self) -> Stage<'_> {
        Stage { scenario: &self.scenario, vehicle: &self.vehicle, site: &self.site, scene: &self.scene }
    }

    pub fn draw(&mut self, shot: &Shot) -> Picture {
        self.renderer.picture(&self.gpu, shot).unwrap()
    }

    pub fn draw_with(&mut self, shot: &Shot, items: &[DrawItem]) -> Picture {
        self.renderer.picture_with(&self.gpu, shot, &mut self.overlay, items).unwrap()
    }

    pub fn renderer(&mut self) -> (&Gpu, &mut Renderer) {
        (&self.gpu, &mut self.renderer)
    }

    /// Draws the same scene with other settings.
    pub fn set_quality(&mut self, quality: Quality) {
        self.renderer = Renderer::new(&self.gpu, quality, &self.scene);
    }

    /// Removes the site's defects from the images.
    pub fn without_defects(&mut self) {
        self.renderer.set_patches(&self.gpu, &[]);
    }

    /// Returns a shot with the aircraft's camera from one point toward another, with a horizontal field of view of
    /// `hfov_deg`.
    pub fn seen(&self, from: Vec3<Enu>, look: Vec3<Enu>, hfov_deg: f64, lamp: bool, size_px: (u32, u32)) -> Shot {
        let lens = Camera { hfov_rad: hfov_deg.to_radians(), ..self.vehicle.camera };
        let pose = camera_aimed_at(from, look, lamp);
        let standing = drone_on_pad(&self.scenario, &self.vehicle);
        self.stage().camera_view_from(PinholeCamera::of(&pose, &lens), Some(&pose), &lens, Some(&standing), (self.at, size_px))
    }

    /// Returns a scene with the aircraft in flight at `from`, its camera aimed at `look`.
    pub fn moment(&self, from: Vec3<Enu>, look: Vec3<Enu>, lamp: bool, velocity_m_s: Vec3<Enu>) -> SceneMoment {
        let to = look - from;
        let yaw = math::atan2(to.east(), to.north());
        let drone =
            DronePose { pose: Pose { position_m: from, ned_from_frd: Rotation::from_euler(0.02, -0.05, yaw) }, spinning: true };
        let camera = camera_aimed_at(from + to.unit() * 0.1, look, lamp);
        SceneMoment { at: self.at, drone, velocity_m_s, camera, lens: self.vehicle.camera, turn: Default::default() }
    }
}
