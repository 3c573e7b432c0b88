//! Builds the shots for both views at a given moment of a flight.

use super::camera::PinholeCamera;
use super::exposure::{Exposure, ExposureMeter, Lighting, meter};
use super::feed::{Feed, shutter};
use super::flown_path::FlownPath;
use super::ghost::GhostView;
use super::hud::{DisplayStyle, DrawItem, Hud, InspectorMarks, LessonDisplay, MapPath, Obstacles, TaskNames, WayBack, marker};
use super::inspector_camera::InspectorCamera;
use super::path_guide::{GuidedView, PathAids, ring_items};
use super::scene::{DronePose, Scene};
use super::shot::{LampBeam, SensorResponse, Shot};
use super::sky::Sky;
use super::visible_weather::VisibleWeather;
use super::visible_wind::VisibleWind;
use spandrel_mavlink::contract::cue;
use spandrel_mavlink::contract::guidance::Guidance;
use spandrel_mavlink::telemetry::Flight;
use spandrel_model::frames::{Enu, Rotation, Vec3};
use spandrel_model::math;
use spandrel_model::pose::Pose;
use spandrel_model::scenario::{LessonStep, Scenario};
use spandrel_model::site::{CameraPose, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};

/// Objects within this distance in front of the aircraft do not count as hiding it, m (about the aircraft's size).
const DRONE_CLEARANCE_M: f64 = 0.5;
/// Objects within this distance in front of the path do not count as hiding it, m.
const PATH_CLEARANCE_M: f64 = 0.2;
/// Largest distance of a surface on which the stand-off is shown, m.
const MAX_SURFACE_DISTANCE_M: f64 = 40.0;

/// Inputs that stay constant during a session.
#[derive(Debug, Clone, Copy)]
pub struct Stage<'a> {
    /// Scenario of the job.
    pub scenario: &'a Scenario,
    /// Parameters of the aircraft.
    pub vehicle: &'a Vehicle,
    /// Geometry and light of the site.
    pub site: &'a Site,
    /// Meshes of the site.
    pub scene: &'a Scene,
}

/// State of the aircraft and its camera at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneMoment {
    /// Simulation time of the state.
    pub at: SimTime,
    /// Pose of the aircraft.
    pub drone: DronePose,
    /// Velocity of the aircraft, ENU, m/s.
    pub velocity_m_s: Vec3<Enu>,
    /// Pose of the aircraft's camera.
    pub camera: CameraPose,
    /// The camera's lens at its current zoom.
    pub lens: Camera,
    /// Turn rate of the camera.
    pub turn: CameraTurnRate,
}

/// Turn rate of a gimbaled camera; zero by default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CameraTurnRate {
    /// Heading rate, rad/s, clockwise as seen from above.
    pub heading_rate_rad_s: f64,
    /// Pitch rate, rad/s, up positive.
    pub pitch_rate_rad_s: f64,
}

impl CameraTurnRate {
    /// Returns the camera's angular velocity in rad/s. `right` is the camera's right axis, which the gimbal keeps
    /// level.
    #[must_use]
    pub fn angular_velocity_rad_s(&self, right: Vec3<Enu>) -> Vec3<Enu> {
        right * self.pitch_rate_rad_s - Vec3::new(0.0, 0.0, self.heading_rate_rad_s)
    }
}

impl Stage<'_> {
    /// Returns the sun and sky at the given time.
    #[must_use]
    pub fn sky(&self, at: SimTime) -> Sky {
        Sky::new(&self.site.light().daylight(at), self.scenario.light.cloud_cover)
    }

    /// Returns the shot from the aircraft's camera, which does not show the aircraft itself.
    #[must_use]
    pub fn camera(&self, moment: &SceneMoment, size_px: (u32, u32)) -> Shot {
        self.camera_frame(moment, size_px, &mut ExposureMeter::default())
    }

    /// Returns the camera's shot as the next frame of a video, with smoothed exposure.
    #[must_use]
    pub fn camera_frame(&self, moment: &SceneMoment, size_px: (u32, u32), meter: &mut ExposureMeter) -> Shot {
        let eye = PinholeCamera::of(&moment.camera, &moment.lens);
        let shot = self.shot(eye, Some(&moment.camera), None, (moment.at, size_px), |metered| {
            SensorResponse::camera(Exposure::camera(meter.smoothed_lux(metered, moment.at), &moment.lens), None)
        });
        let before = camera_at_shutter_open(&eye, moment, shot.finish.exposure.time_s);
        Shot { finish: SensorResponse::camera(shot.finish.exposure, Some(before)), ..shot }
    }

    /// Returns the shot as seen by the inspector, who looks at the aircraft.
    #[must_use]
    pub fn inspector(&self, moment: &SceneMoment, size_px: (u32, u32)) -> Shot {
        self.inspector_view(&InspectorCamera::default(), moment, size_px, &mut ExposureMeter::default())
    }

    /// Returns the shot as seen by an inspector who looks in any direction and whose eyes adapt to the light.
    #[must_use]
    pub fn inspector_view(
        &self,
        gaze: &InspectorCamera,
        moment: &SceneMoment,
        size_px: (u32, u32),
        eyes: &mut ExposureMeter,
    ) -> Shot {
        let stands = self.site.inspector().at(moment.at).feet_m;
        let aspect = f64::from(size_px.0) / f64::from(size_px.1.max(1));
        self.eye_shot(gaze.eye(stands, moment.drone.pose.position_m, aspect), moment, size_px, eyes)
    }

    /// Returns the bracket around the aircraft, drawn over the inspector's view.
    #[must_use]
    pub fn drone_marker(&self, shot: &Shot, moment: &SceneMoment, style: DisplayStyle) -> Vec<DrawItem> {
        let (from, to) = (shot.eye.position_m, moment.drone.pose.position_m - shot.eye.position_m);
        let clear_m = (to.norm() - DRONE_CLEARANCE_M).max(0.0);
        let hidden = clear_m > 0.0 && self.site.ray(from, to.unit(), clear_m, moment.at).is_some();
        let aspect = f64::from(shot.size_px.0) / f64::from(shot.size_px.1.max(1));
        marker((&shot.eye, aspect), moment.drone.pose.position_m, hidden, style)
    }

    /// Returns the ring of a lesson's step, drawn below the rest of a shot's overlay.
    #[must_use]
    pub fn lesson_items(&self, shot: &Shot, lesson: Option<&LessonDisplay>) -> Vec<DrawItem> {
        // The message gives the way relative to an older heading, so that a ring placed by it would swing with the aircraft.
        let step = lesson.and_then(|lesson| self.scenario.lesson.get(lesson.status.step.checked_sub(1)? as usize));
        let Some(place) = step.and_then(LessonStep::place) else { return Vec::new() };
        let aspect = f64::from(shot.size_px.0) / f64::from(shot.size_px.1.max(1));
        ring_items(&shot.eye, aspect, place.position_m, place.radius_m)
    }

    /// Returns the ghost of an earlier flight, drawn below the rest of a shot's overlay.
    #[must_use]
    pub fn ghost_items(&self, shot: &Shot, ghost: Option<Pose<Enu>>) -> Vec<DrawItem> {
        let Some(pose) = ghost else { return Vec::new() };
        let aspect = f64::from(shot.size_px.0) / f64::from(shot.size_px.1.max(1));
        let is_hidden = self.site.geometry().hides(shot.eye.position_m, pose.position_m, PATH_CLEARANCE_M);
        GhostView { eye: &shot.eye, aspect, vehicle: self.vehicle, is_hidden }.items(pose)
    }

    /// Returns the path of the next task, drawn below the rest of a shot's overlay.
    #[must_use]
    pub fn path_items(&self, shot: &Shot, moment: &SceneMoment, guidance: Option<&Guidance>, aids: PathAids) -> Vec<DrawItem> {
        let Some(guidance) = guidance.filter(|_| aids != PathAids::None) else { return Vec::new() };
        let from = shot.eye.position_m;
        let is_hidden = |point_m: Vec3<Enu>| self.site.geometry().hides(from, point_m, PATH_CLEARANCE_M);
        let surface = |from_m: Vec3<Enu>, direction: Vec3<Enu>| {
            let hit = self.site.geometry().ray(from_m, direction, MAX_SURFACE_DISTANCE_M)?;
            Some((from_m + direction * hit.distance_m, hit.normal))
        };
        self.scene.paths.items(&GuidedView {
            eye: &shot.eye,
            aspect: f64::from(shot.size_px.0) / f64::from(shot.size_px.1.max(1)),
            drone_m: moment.drone.pose.position_m,
            heading_rad: moment.drone.pose.ned_from_frd.yaw_rad(),
            guidance,
            aids,
            is_hidden: &is_hidden,
            surface: &surface,
        })
    }

    /// Returns the shot as seen by a person at any position.
    #[must_use]
    pub fn inspector_shot(&self, eye: PinholeCamera, moment: &SceneMoment, size_px: (u32, u32)) -> Shot {
        self.eye_shot(eye, moment, size_px, &mut ExposureMeter::default())
    }

    fn eye_shot(&self, eye: PinholeCamera, moment: &SceneMoment, size_px: (u32, u32), eyes: &mut ExposureMeter) -> Shot {
        self.shot(eye, Some(&moment.camera), Some(&moment.drone), (moment.at, size_px), |metered| {
            SensorResponse::eyes(Exposure::eyes(eyes.smoothed_lux(metered, moment.at)))
        })
    }

    /// Returns the shot from a camera like the aircraft's at any position, with or without the aircraft in view.
    #[must_use]
    pub fn camera_view_from(
        &self,
        eye: PinholeCamera,
        lamp: Option<&CameraPose>,
        lens: &Camera,
        drone: Option<&DronePose>,
        (at, size_px): (SimTime, (u32, u32)),
    ) -> Shot {
        self.shot(eye, lamp, drone, (at, size_px), |metered| SensorResponse::camera(Exposure::camera(metered, lens), None))
    }

    fn shot(
        &self,
        eye: PinholeCamera,
        lamp: Option<&CameraPose>,
        drone: Option<&DronePose>,
        (at, size_px): (SimTime, (u32, u32)),
        finish: impl FnOnce(f64) -> SensorResponse,
    ) -> Shot {
        let sky = self.sky(at);
        let weather = VisibleWeather::at(&self.scenario.weather, self.site, &eye);
        let beam = lamp.and_then(|pose| LampBeam::of(&self.vehicle.lamp, pose));
        let lamp = lamp.filter(|pose| pose.lamp_on).map(|pose| (&self.vehicle.lamp, pose));
        let aspect = f64::from(size_px.0) / f64::from(size_px.1.max(1));
        let metered_lux = meter(self.site, &eye, aspect, &Lighting { sky: &sky, weather: &weather, lamp, query_time: at });
        Shot {
            eye,
            size_px,
            beam,
            finish: finish(metered_lux),
            time_s: at.s(),
            wind: VisibleWind::at(&self.scenario.wind, at),
            weather,
            moving: self.scene.moving(self.scenario, self.site, drone, at),
            sky,
        }
    }
}

/// Returns the camera's pose when the shutter opened, `time_s` before it closed.
fn camera_at_shutter_open(eye: &PinholeCamera, moment: &SceneMoment, time_s: f64) -> PinholeCamera {
    let back = Rotation::<Enu, Enu>::identity().rotated_by(moment.turn.angular_velocity_rad_s(eye.right) * -time_s);
    let position_m = eye.position_m - moment.velocity_m_s * time_s;
    PinholeCamera { position_m, forward: back * eye.forward, right: back * eye.right, ..*eye }
}

/// HUD inputs that neither the moment nor the feed contains.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HudInputs {
    /// Battery, %, once received.
    pub battery_pct: Option<f64>,
    /// Time of liftoff.
    pub lift_off: Option<SimTime>,
    /// Age of the latest telemetry, s.
    pub telemetry_age_s: f64,
    /// Number of pictures taken.
    pub pictures: usize,
    /// Time of the last picture.
    pub last_picture: Option<SimTime>,
    /// Time base of blinking elements, s: wall-clock time in a live flight, because simulation time may be paused or
    /// accelerated; video time otherwise.
    pub blink_time_s: f64,
    /// Whether the flight is frozen.
    pub is_frozen: bool,
}

impl HudInputs {
    /// Returns the inputs from a recorded flight.
    #[must_use]
    pub fn of(flight: &Flight, pad_height_m: f64, at: SimTime) -> Self {
        let newest = flight.truths.iter().rev().find(|truth| truth.time <= at).map(|truth| truth.time);
        let taken = flight.snapshots.all().iter().filter(|shot| shot.0 <= at);
        Self {
            battery_pct: flight.battery.at(at),
            lift_off: flight.lift_off(pad_height_m, LIFTOFF_HEIGHT_M).filter(|begun| *begun <= at),
            telemetry_age_s: newest.map_or(0.0, |newest| (at - newest).s()),
            pictures: taken.clone().count(),
            last_picture: taken.map(|shot| shot.0).max(),
            blink_time_s: at.s(),
            is_frozen: false,
        }
    }
}

/// Builds the HUD from a flight's telemetry at the given moment. `feed` supplies the remaining inputs; `held`: its cues
/// come from a recording that stores only changes. `map`: whether the reference paths may be shown.
#[must_use]
pub fn hud(stage: &Stage, moment: &SceneMoment, flight: &Flight, feed: (&Feed, bool), map: bool) -> Hud {
    let told = HudInputs::of(flight, stage.scenario.ground_team.pad_m.up(), moment.at);
    display(stage, moment, &told, feed, map)
}

/// Builds the HUD from inputs from any source.
#[must_use]
pub fn display(stage: &Stage, moment: &SceneMoment, inputs: &HudInputs, (feed, held): (&Feed, bool), map: bool) -> Hud {
    let (scenario, at) = (stage.scenario, moment.at);
    let pad_m = scenario.ground_team.pad_m;
    let from_pad = moment.drone.pose.position_m - pad_m;
    let wide = math::tan(0.5 * stage.vehicle.camera.hfov_rad);
    let (roll_rad, pitch_rad, heading_rad) = moment.drone.pose.ned_from_frd.euler();
    Hud {
        speed_m_s: moment.velocity_m_s.norm(),
        limit_m_s: scenario.scoring.speed_limit_m_s,
        battery_pct: inputs.battery_pct,
        min_green_pct: scenario.feedback.battery_green_pct,
        min_yellow_pct: scenario.feedback.battery_yellow_pct,
        cues: feed.cues(at, held),
        cue_texts: feed.current_cue_texts(at),
        height_m: from_pad.up(),
        home_distance_m: from_pad.horizontal_norm(),
        mode: feed.mode().to_owned(),
        gnss: feed.gnss(),
        radio: feed.radio(at),
        telemetry_age_s: inputs.telemetry_age_s,
        is_frozen: inputs.is_frozen,
        gimbal_rad: math::asin(moment.camera.forward.up().clamp(-1.0, 1.0)),
        zoom: wide / math::tan(0.5 * moment.lens.hfov_rad),
        lamp: moment.camera.lamp_on,
        remaining_s: scenario.scoring.time_max_s - inputs.lift_off.map_or(0.0, |begun| (at - begun).s()),
        pictures: inputs.pictures,
        shutter: shutter(inputs.last_picture, at),
        time_s: inputs.blink_time_s,
        position_m: moment.drone.pose.position_m,
        heading_rad,
        roll_rad,
        pitch_rad,
        obstacles: feed.obstacles(at).map(|sectors| Obstacles {
            sectors_m: sectors.sectors_m.clone(),
            nearest_m: feed.clearance_m(at),
            range_m: sectors.range_m,
            too_close_m: scenario.feedback.too_close_m,
        }),
        way_back: way_back(stage, moment, feed, held),
        pad_m,
        inspector: InspectorMarks::new(&scenario.ground_team, stage.site.inspector().at(at).feet_m),
        guidance: feed.guidance(at),
        guidance_how: String::new(),
        tasks: TaskNames::of(scenario),
        lesson: feed.lesson(at).map(|(status, remark)| LessonDisplay {
            how: String::new(),
            remark: remark.map(str::to_owned),
            status,
        }),
        ghost: None,
        flown: FlownPath::default(),
        tracks: if map { MapPath::all(scenario) } else { Vec::new() },
        site: stage.scene.outline.clone(),
        style: DisplayStyle::default(),
    }
}

/// Returns the direction in the camera's picture that leads back to the path, while the off-path cue is active.
fn way_back(stage: &Stage, moment: &SceneMoment, feed: &Feed, held: bool) -> Option<WayBack> {
    if cue::displayed(feed.cues(moment.at, held)) & cue::OFF_PATH == 0 {
        return None;
    }
    let drone_m = moment.drone.pose.position_m;
    let target_m = stage.scene.paths.nearest_m(feed.guidance(moment.at).and_then(|guidance| guidance.task), drone_m)?;
    let to = target_m - drone_m;
    let up = moment.camera.right.cross(moment.camera.forward);
    Some(WayBack { direction_rad: math::atan2(to.dot(moment.camera.right), to.dot(up)) })
}

/// Height above the pad at which the flight time starts, m (docs/src/reference/assessment.md, "Frames").
pub const LIFTOFF_HEIGHT_M: f64 = 0.3;

/// Returns the pose of a camera without roll that looks from one point at another.
#[must_use]
pub fn camera_aimed_at(position_m: Vec3<Enu>, target_m: Vec3<Enu>, lamp_on: bool) -> CameraPose {
    let eye = PinholeCamera::at(position_m, target_m, 1.0, 1.0);
    CameraPose { position_m, forward: eye.forward, right: eye.right, lamp_on }
}

/// Returns the pose of the aircraft on its pad with motors off.
#[must_use]
pub fn drone_on_pad(scenario: &Scenario, vehicle: &Vehicle) -> DronePose {
    let feet = vehicle.hull.feet_m.iter().map(|foot| foot.down()).fold(0.0, f64::max);
    let team = &scenario.ground_team;
    DronePose {
        pose: Pose {
            position_m: team.pad_m + Vec3::new(0.0, 0.0, feet),
            ned_from_frd: spandrel_model::frames::Rotation::from_euler(
                0.0,
                0.0,
                math::wrap_pi(team.pad_heading_deg.to_radians()),
            ),
        },
        spinning: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::site::defects::REFERENCE_CAMERA;

    const ROUNDING_ERROR: f64 = 1e-12;

    /// Returns a moment with a camera at the origin that looks north at the given pitch.
    fn moment(pitch_deg: f64, turn: CameraTurnRate) -> SceneMoment {
        let (up, north) = math::sin_cos(pitch_deg.to_radians());
        let zero = Vec3::new(0.0, 0.0, 0.0);
        SceneMoment {
            at: SimTime::ZERO,
            drone: DronePose { pose: Pose { position_m: zero, ned_from_frd: Rotation::identity() }, spinning: true },
            velocity_m_s: Vec3::new(3.0, 0.0, -2.0),
            camera: camera_aimed_at(zero, Vec3::new(0.0, north, up), false),
            lens: REFERENCE_CAMERA,
            turn,
        }
    }

    fn before(moment: &SceneMoment, time_s: f64) -> PinholeCamera {
        camera_at_shutter_open(&PinholeCamera::of(&moment.camera, &moment.lens), moment, time_s)
    }

    #[test]
    fn exact_turning_camera_pointed_elsewhere_when_the_shutter_opened() {
        let (degree, fast) = (1.0_f64.to_radians(), 100.0_f64.to_radians());
        let yawed = before(&moment(0.0, CameraTurnRate { heading_rate_rad_s: fast, pitch_rate_rad_s: 0.0 }), 0.01);
        // The camera turned clockwise, so it pointed west of north one degree earlier.
        assert!((math::atan2(yawed.forward.east(), yawed.forward.north()) + degree).abs() < ROUNDING_ERROR, "{yawed:?}");
        assert!(yawed.forward.up().abs() < ROUNDING_ERROR && yawed.right.up().abs() < ROUNDING_ERROR);
        assert!(
            (yawed.forward.dot(yawed.right)).abs() < ROUNDING_ERROR
                && (yawed.position_m - Vec3::new(-0.03, 0.0, 0.02)).norm() < ROUNDING_ERROR
        );
        // The camera turned up, so it pointed lower before, whatever its pitch.
        for pitch_deg in [0.0, -60.0, 60.0] {
            let tilted = before(&moment(pitch_deg, CameraTurnRate { heading_rate_rad_s: 0.0, pitch_rate_rad_s: fast }), 0.01);
            assert!((math::asin(tilted.forward.up()).to_degrees() - (pitch_deg - 1.0)).abs() < 1e-9, "{tilted:?}");
            assert!((tilted.right - Vec3::new(1.0, 0.0, 0.0)).norm() < ROUNDING_ERROR);
        }
        let steep = before(&moment(60.0, CameraTurnRate { heading_rate_rad_s: fast, pitch_rate_rad_s: 0.0 }), 0.01);
        assert!((steep.forward.up() - math::sin(60.0_f64.to_radians())).abs() < ROUNDING_ERROR, "its pitch stays");
    }

    #[test]
    fn exact_steady_camera_keeps_its_direction_during_exposure() {
        let still = moment(-20.0, CameraTurnRate::default());
        let (eye, opened) = (PinholeCamera::of(&still.camera, &still.lens), before(&still, 0.01));
        assert!((opened.forward - eye.forward).norm() < ROUNDING_ERROR && (opened.right - eye.right).norm() < ROUNDING_ERROR);
    }
}
