//! Pictures whose content any viewer must recognize, compared with committed pictures.

use super::compare::{Difference, check_picture, check_picture_at, side_by_side};
use spandrel_mavlink::contract::cue::{self, CueTexts};
use spandrel_mavlink::contract::guidance::{Guidance, GuidanceStep, StandOffReading, WayTo};
use spandrel_model::defect_codes;
use spandrel_model::elements::Element;
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::scenario::{DroneSpec, PlacedDefect, RopeSpec};
use spandrel_model::time::SimTime;
use spandrel_testkit::studio::{Studio, at, dusk_job, girder_job, sunny_job};
use spandrel_view::arrange::largest_even_size_px;
use spandrel_view::camera::PinholeCamera;
use spandrel_view::flown_path::FlownPath;
use spandrel_view::hud::{self, DisplayStyle, GnssStatus, Hud, InspectorMarks, MapPath, Obstacles, TaskNames, WayBack};
use spandrel_view::path_guide::PathAids;
use spandrel_view::picture::Picture;
use spandrel_view::scene::defects::patch;
use std::path::Path;

/// Size of a scene picture, px.
const SCENE_PX: (u32, u32) = (640, 360);
/// Size of each view with a HUD, large enough for legible text.
const VIEW_PX: (u32, u32) = (640, 360);
/// Size of each defect close-up, px.
const CLOSE_UP_PX: (u32, u32) = (320, 240);
/// Fields of view at 1 m and 3 m, which fit an object half a meter wide. At 8 m, the picture is a full-resolution crop
/// of the camera's picture.
const CLOSE_UP_FOV_DEG: [f64; 2] = [30.0, 15.0];

/// Size of the tutorial's defect pictures, px, and their shared field of view, in which half a meter just fits at a
/// distance of 1 m.
const TUTORIAL_PX: (u32, u32) = (240, 180);
const TUTORIAL_FOV_DEG: f64 = 30.0;

/// Collects all errors, so that one run reports on every picture.
#[derive(Default)]
struct Gallery {
    errors: Vec<String>,
}

impl Gallery {
    fn check(&mut self, name: &str, picture: &Picture) {
        self.record(name, check_picture(name, picture));
    }

    fn record(&mut self, name: &str, compared: Result<Difference, String>) {
        match compared {
            Ok(found) => println!("{name}: mean {:.2}, worst tile {:.2}", found.mean, found.tile),
            Err(error) => self.errors.push(error),
        }
    }

    fn assert_no_errors(self) {
        assert!(self.errors.is_empty(), "{}", self.errors.join("\n"));
    }
}

#[test]
fn regress_bridges_in_summer_light() {
    let mut studio = Studio::new(sunny_job(), 7, "medium", SimTime::from_ms(95_000));
    let mut wall = Gallery::default();
    for (name, from, look, hfov_deg) in [
        ("arch-from-the-shore", at(-62.0, -70.0, 9.0), at(4.0, 0.0, 19.0), 74.0),
        ("suspension-bridge-with-traffic", at(-62.0, 136.0, 20.0), at(0.0, 151.0, 14.0), 64.0),
        ("pier-at-the-water", at(-57.0, 133.0, 5.5), at(-70.0, 150.0, 5.5), 64.0),
    ] {
        let shot = studio.seen(from, look, hfov_deg, false, SCENE_PX);
        let picture = studio.draw(&shot);
        wall.check(name, &picture);
    }
    wall.assert_no_errors();
}

/// The girder bridge from the bank, the bays between its girders in the light of the lamp, and its bearings.
#[test]
fn regress_girder_bridge() {
    let mut studio = Studio::new(girder_job(), 7, "medium", SimTime::from_ms(95_000));
    studio.without_defects();
    let mut wall = Gallery::default();
    for (name, from, look, hfov_deg, lamp) in [
        ("girder-bridge", at(-72.0, -62.0, 14.0), at(-4.0, 0.0, 13.5), 74.0, false),
        ("girder-bays", at(38.0, 2.7, 11.9), at(50.0, 4.6, 18.0), 84.0, true),
        ("girder-bearings", at(-62.0, -1.8, 13.9), at(-69.3, -1.8, 15.6), 60.0, true),
    ] {
        let shot = studio.seen(from, look, hfov_deg, lamp, SCENE_PX);
        let picture = studio.draw(&shot);
        wall.check(name, &picture);
    }
    wall.assert_no_errors();
}

/// The pad: truck, crew, and the aircraft above it with its propellers turning.
#[test]
fn regress_crew_and_drone_at_the_pad() {
    let mut studio = Studio::new(sunny_job(), 7, "medium", SimTime::from_ms(95_000));
    let mut wall = Gallery::default();
    for (name, from, drone, look, vfov_deg) in [
        ("crew-and-truck", at(-105.0, 71.0, 7.4), at(-110.2, 75.3, 6.6), at(-116.0, 79.0, 6.0), 40.0),
        ("drone-near", at(-111.0, 76.4, 7.0), at(-112.0, 78.0, 6.3), at(-112.0, 78.0, 6.3 - 0.02), 24.0),
    ] {
        let moment = studio.moment(drone, at(0.0, 150.0, 14.0), false, at(0.0, 0.0, 0.0));
        let aspect = f64::from(SCENE_PX.0) / f64::from(SCENE_PX.1);
        let eye = PinholeCamera::at(from, look, f64::to_radians(vfov_deg), aspect);
        let shot = studio.stage().inspector_shot(eye, &moment, SCENE_PX);
        let picture = studio.draw(&shot);
        wall.check(name, &picture);
    }
    wall.assert_no_errors();
}

/// Two other drones over the lake: one of another type in front, and one of the trainee's type behind it.
#[test]
fn regress_other_drones_at_the_site() {
    let mut job = sunny_job();
    let other = |name: &str, vehicle, heading_deg, place| DroneSpec {
        name: name.into(),
        vehicle,
        points_m: vec![place],
        speed_m_s: 3.0,
        heading_deg,
        at_s: 0.0,
        spread_s: 0.0,
        wait_s: 0.0,
        repeat: false,
    };
    job.drones =
        vec![other("survey", "m30", 60.0, at(-56.4, -63.0, 9.6)), other("film", "phantom2", 150.0, at(-52.5, -60.5, 10.5))];
    let mut studio = Studio::new(job, 7, "medium", SimTime::from_ms(95_000));
    studio.without_defects();
    let mut wall = Gallery::default();
    let shot = studio.seen(at(-59.0, -66.0, 9.5), at(-50.0, -56.0, 10.0), 50.0, false, SCENE_PX);
    let picture = studio.draw(&shot);
    wall.check("other-drones", &picture);
    wall.assert_no_errors();
}

/// A rope between two points in front of the arch, and one that hangs beside it.
#[test]
fn regress_ropes_at_the_site() {
    let mut job = sunny_job();
    let rope = |name: &str, points_m, length_m, diameter_m| RopeSpec {
        name: name.into(),
        points_m,
        length_m,
        diameter_m,
        mass_kg_m: 0.3,
    };
    job.ropes = vec![
        rope("strung", vec![at(-58.0, -62.0, 12.0), at(-50.0, -60.0, 12.5)], 9.0, 0.03),
        rope("hanging", vec![at(-55.5, -62.5, 12.5)], 2.5, 0.05),
    ];
    let mut studio = Studio::new(job, 7, "medium", SimTime::from_ms(95_000));
    studio.without_defects();
    let mut wall = Gallery::default();
    let shot = studio.seen(at(-59.0, -66.0, 9.5), at(-50.0, -56.0, 11.5), 60.0, false, SCENE_PX);
    let picture = studio.draw(&shot);
    wall.check("ropes", &picture);
    wall.assert_no_errors();
}

/// Distractors that may be mistaken for defects: a sealed crack, a spider web, spray paint. Formwork lines, tie holes,
/// streaks, and droppings are also visible.
#[test]
fn regress_distractors() {
    let mut studio = Studio::new(sunny_job(), 7, "medium", SimTime::from_ms(95_000));
    studio.without_defects();
    let mut wall = Gallery::default();
    let pictures = [
        (at(48.0, 2.6, 28.4), at(50.0, 2.6, 28.4), 64.0),
        (at(-49.0, 2.6, 9.73), at(-50.0, 2.6, 9.73), 44.0),
        (at(-62.5, 152.0, 2.8), at(-68.0, 153.0, 1.9), 50.0),
    ]
    .map(|(from, look, hfov_deg)| {
        let shot = studio.seen(from, look, hfov_deg, false, CLOSE_UP_PX);
        studio.draw(&shot)
    });
    wall.check("false-friends", &side_by_side(&pictures));
    wall.assert_no_errors();
}

/// Under the arch and in the interlayer at dusk: dark without the lamp, and visibly lit with it.
#[test]
fn regress_lamp_lights_dark_places() {
    // Maximum mean luma of the picture's center in the dark, out of 255, and minimum factor by which the lamp brightens
    // it.
    const MAX_DARK_LUMA: f64 = 75.0;
    const MIN_LAMP_FACTOR: f64 = 1.5;
    let mut studio = Studio::new(dusk_job(), 7, "medium", SimTime::ZERO);
    let mut wall = Gallery::default();
    for (name, from, look) in
        [("under-the-arch", at(-12.0, 0.0, 24.2), at(-8.6, 2.3, 27.6)), ("interlayer", at(12.0, 0.3, 30.6), at(8.6, 1.0, 33.2))]
    {
        let mut lumas = Vec::new();
        for (lamp, state) in [(false, "lamp-off"), (true, "lamp-on")] {
            let shot = studio.seen(from, look, 84.0, lamp, SCENE_PX);
            let picture = studio.draw(&shot);
            let (w, h) = SCENE_PX;
            lumas.push(picture.luma((w / 3, h / 3), (w - w / 3, h - h / 3)));
            wall.check(&format!("{name}-{state}"), &picture);
        }
        println!("{name}: middle of the picture {lumas:.0?} (0 to 255)");
        if lumas[0] > MAX_DARK_LUMA || lumas[1] < MIN_LAMP_FACTOR * lumas[0] {
            wall.errors.push(format!("{name}: lamp off {:.0} (at most {MAX_DARK_LUMA}), on {:.0}", lumas[0], lumas[1]));
        }
    }
    wall.assert_no_errors();
}

/// Returns a defect where a line of sight hits a bridge. Its longest extent points down or, otherwise, to the side and
/// slightly up.
fn place_defect(studio: &Studio, (from, to): (Vec3<Enu>, Vec3<Enu>), kind: u32, size_m: (f64, f64), down: bool) -> PlacedDefect {
    let ray = (to - from).unit();
    let hit = studio.site.ray(from, ray, 200.0, SimTime::ZERO).unwrap();
    let level = Vec3::new(0.0, 0.0, 1.0).cross(hit.normal).unit();
    let along = if down { level.cross(hit.normal).unit() } else { (level * 0.9 + hit.normal.cross(level) * 0.3).unit() };
    PlacedDefect {
        id: kind,
        element: if kind < 1080 { Element::SteelGirder } else { Element::RcArch },
        member: "gallery".into(),
        kind,
        condition_state: 3,
        position_m: from + ray * hit.distance_m,
        normal: hit.normal,
        along,
        length_m: size_m.0,
        width_m: size_m.1,
        line: defect_codes::is_line(kind),
        cause: None,
        stain: None,
    }
}

/// Replaces all defects with the given one, using the light at its position.
fn show_only_defect(studio: &mut Studio, defect: &PlacedDefect) {
    let light = spandrel_model::site::light::ray_bundle(64);
    let cast = |o, d, max_m| studio.site.geometry().ray(o, d, max_m);
    let sun = studio.site.light().daylight(studio.at).sun;
    let (sky, bounced) = studio.site.light().indirect_fractions(defect.position_m, defect.normal, sun, &light, &cast);
    let patches = [patch(defect, [sky as f32, bounced as f32])];
    let (gpu, renderer) = studio.renderer();
    renderer.set_patches(gpu, &patches);
}

/// Returns a picture of a defect from the given distance along its normal, slightly from the side and from below.
fn close_up(studio: &mut Studio, defect: &PlacedDefect, distance_m: f64, hfov_deg: f64, size: (u32, u32)) -> Picture {
    let aside = Vec3::new(0.0, 0.0, 1.0).cross(defect.normal).unit();
    let out = (defect.normal + aside * 0.25 - Vec3::new(0.0, 0.0, 0.12)).unit();
    let shot = studio.seen(defect.position_m + out * distance_m, defect.position_m, hfov_deg, false, size);
    studio.draw(&shot)
}

/// Returns a line of sight from the lake to a wall of the arch bridge.
pub(super) fn wall_sight_line() -> (Vec3<Enu>, Vec3<Enu>) {
    (at(-55.0, -15.0, 24.0), at(-55.0, 0.0, 24.0))
}

/// Returns a line of sight to a girder of the suspension bridge.
pub(super) fn girder_sight_line() -> (Vec3<Enu>, Vec3<Enu>) {
    (at(-20.0, 138.0, 12.7), at(-20.0, 150.0, 12.7))
}

#[test]
fn regress_defects_at_1_3_and_8_m() {
    let mut studio = Studio::new(sunny_job(), 7, "medium", SimTime::from_ms(95_000));
    let (wall_at, girder_at) = (wall_sight_line(), girder_sight_line());
    let mut wall = Gallery::default();
    for (name, sight, kind, size_m, down) in [
        ("crack", wall_at, defect_codes::CRACK, (0.9, 0.003), true),
        ("spall", wall_at, defect_codes::SPALL, (0.42, 0.30), false),
        ("exposed-rebar", wall_at, defect_codes::REBAR, (0.46, 0.24), false),
        ("efflorescence", wall_at, defect_codes::EFFLORESCENCE, (0.8, 0.42), true),
        ("abrasion", wall_at, defect_codes::ABRASION, (0.6, 0.4), false),
        ("corrosion", girder_at, defect_codes::CORROSION, (0.42, 0.3), false),
        ("fatigue-crack", girder_at, defect_codes::FATIGUE, (0.22, 0.0004), false),
        ("missing-bolts", girder_at, defect_codes::CONNECTION, (0.30, 0.16), false),
    ] {
        let defect = place_defect(&studio, sight, kind, size_m, down);
        show_only_defect(&mut studio, &defect);
        let focal_px = studio.vehicle.camera.focal_px();
        let crop_deg = 2.0 * math::atan(0.5 * f64::from(CLOSE_UP_PX.0) / focal_px).to_degrees();
        let pictures = [(1.0, CLOSE_UP_FOV_DEG[0]), (3.0, CLOSE_UP_FOV_DEG[1]), (8.0, crop_deg)]
            .map(|(distance_m, hfov_deg)| close_up(&mut studio, &defect, distance_m, hfov_deg, CLOSE_UP_PX));
        wall.check(&format!("defect-{name}"), &side_by_side(&pictures));
    }
    wall.assert_no_errors();
}

/// The tutorial compares distances: each row shows one defect through the same lens, so its size decreases with
/// distance.
#[test]
fn regress_tutorial_shows_defects_at_true_scale() {
    let mut studio = Studio::new(sunny_job(), 7, "medium", SimTime::from_ms(95_000));
    let mut wall = Gallery::default();
    for (name, sight, kind, size_m, down) in [
        ("crack", wall_sight_line(), defect_codes::CRACK, (0.9, 0.003), true),
        ("spall", wall_sight_line(), defect_codes::SPALL, (0.42, 0.30), false),
        ("efflorescence", wall_sight_line(), defect_codes::EFFLORESCENCE, (0.8, 0.42), true),
        ("corrosion", girder_sight_line(), defect_codes::CORROSION, (0.42, 0.3), false),
    ] {
        let defect = place_defect(&studio, sight, kind, size_m, down);
        show_only_defect(&mut studio, &defect);
        let row = [1.0, 3.0, 8.0].map(|distance_m| close_up(&mut studio, &defect, distance_m, TUTORIAL_FOV_DEG, TUTORIAL_PX));
        let taught =
            Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../..")).join(format!("crates/view/src/flow/pictures/{name}.jpg"));
        wall.record(name, check_picture_at(&taught, &format!("tutorial-{name}"), &side_by_side(&row)));
    }
    wall.assert_no_errors();
}

/// Returns the HUD during a normal flight.
pub(super) fn calm(studio: &Studio, position_m: Vec3<Enu>) -> Hud {
    Hud {
        speed_m_s: 2.4,
        limit_m_s: 4.4704,
        battery_pct: Some(86.0),
        min_green_pct: 70.0,
        min_yellow_pct: 30.0,
        cues: 0,
        cue_texts: CueTexts::default(),
        height_m: position_m.up() - studio.scenario.ground_team.pad_m.up(),
        home_distance_m: (position_m - studio.scenario.ground_team.pad_m).horizontal_norm(),
        mode: "Position".into(),
        gnss: Some(GnssStatus { has_fix: true, satellites: 17 }),
        radio: None,
        telemetry_age_s: 0.02,
        is_frozen: false,
        ghost: None,
        gimbal_rad: 0.1,
        zoom: 1.0,
        lamp: false,
        remaining_s: 1104.0,
        pictures: 2,
        shutter: false,
        time_s: 95.0,
        position_m,
        heading_rad: 0.0,
        roll_rad: 0.0,
        pitch_rad: 0.0,
        obstacles: None,
        way_back: None,
        flown: FlownPath::default(),
        inspector: InspectorMarks::new(&studio.scenario.ground_team, studio.scenario.ground_team.inspector_m),
        pad_m: studio.scenario.ground_team.pad_m,
        guidance: None,
        tasks: TaskNames::of(&studio.scenario),
        guidance_how: String::new(),
        lesson: None,
        tracks: MapPath::all(&studio.scenario),
        site: studio.scene.outline.clone(),
        style: DisplayStyle::default(),
    }
}

/// Compares both views side by side in every state of the HUD.
#[test]
fn regress_both_views_in_every_hud_state() {
    let mut studio = Studio::new(sunny_job(), 7, "medium", SimTime::from_ms(95_000));
    let mut wall = Gallery::default();
    let slab = (at(-30.0, -9.0, 33.0), at(-30.0, 0.0, 32.5));
    let below = (at(-22.0, -8.0, 17.0), at(-20.0, 0.0, 24.0));
    let pier = (at(-72.0, 139.0, 3.5), at(-72.0, 150.0, 3.0));
    let between = (at(14.0, 0.3, 30.8), at(0.0, 0.0, 31.5));
    for (name, (from, look), change) in [
        ("calm", slab, (|_| ()) as fn(&mut Hud)),
        ("yellow-battery-too-fast-off-path", below, |hud| {
            hud.battery_pct = Some(52.0);
            hud.speed_m_s = 6.1;
            hud.cues = cue::SPEEDING | cue::OFF_PATH;
            hud.cue_texts = ["Too fast: 14 mph, limit 10 mph", "Off path 3.4 m: left and up"].into_iter().collect();
            hud.shutter = true;
        }),
        ("red-battery-crash-too-close", pier, |hud| {
            hud.battery_pct = Some(17.0);
            hud.cues = cue::CRASH | cue::TOO_CLOSE;
            hud.cue_texts = ["Crash: bridge", "Too close: 1.2 m, limit 2.5 m"].into_iter().collect();
            hud.remaining_s = 71.0;
        }),
        ("lamp-zoom-no-satellites", between, |hud| {
            hud.lamp = true;
            hud.zoom = 2.0;
            hud.gnss = Some(GnssStatus { has_fix: false, satellites: 4 });
            hud.mode = "Altitude".into();
        }),
        ("assessment-link-lost", slab, |hud| {
            hud.battery_pct = None;
            hud.gnss = None;
            hud.telemetry_age_s = 3.4;
            hud.tracks = Vec::new();
        }),
        ("frozen-inspector-at-place-2", below, |hud| {
            hud.is_frozen = true;
            if let Some(marks) = &mut hud.inspector {
                marks.position_m = marks.places_m[1];
            }
        }),
    ] {
        let mut display = calm(&studio, from);
        change(&mut display);
        let mut moment = studio.moment(from, look, display.lamp, Vec3::new(0.5, 0.0, 0.0));
        moment.lens.hfov_rad = 2.0 * math::atan(math::tan(0.5 * moment.lens.hfov_rad) / display.zoom);
        let inspector = studio.stage().inspector(&moment, VIEW_PX);
        let marked = studio.stage().drone_marker(&inspector, &moment, DisplayStyle::default());
        let seen = largest_even_size_px(VIEW_PX, moment.lens.aspect());
        let camera = studio.stage().camera(&moment, seen);
        let shown = hud::layout(&display, f64::from(seen.0) / f64::from(seen.1));
        let views = [studio.draw_with(&inspector, &marked), studio.draw_with(&camera, &shown)];
        wall.check(&format!("views-{name}"), &side_by_side(&views));
    }
    wall.assert_no_errors();
}

/// Draws the path of a task into the camera view, and the instruments, on the way along the path and beside it.
#[test]
fn regress_practice_with_path_and_instruments() {
    let mut studio = Studio::new(sunny_job(), 7, "medium", SimTime::from_ms(95_000));
    let mut wall = Gallery::default();
    let path_m = studio.scenario.tasks[0].path_m.clone();
    let (from, ahead) = (path_m[8], path_m[40]);
    for (name, position_m, aids) in
        [("on-path", from, PathAids::Full), ("off-path", from + Vec3::new(0.0, -4.0, -2.0), PathAids::Gates)]
    {
        let moment = studio.moment(position_m, ahead + Vec3::new(0.0, 4.0, 0.0), false, Vec3::new(0.5, 0.0, 0.0));
        let (roll_rad, pitch_rad, heading_rad) = moment.drone.pose.ned_from_frd.euler();
        let to = path_m[16] - position_m;
        let bearing_rad = math::wrap_pi(math::atan2(to.east(), to.north()) - heading_rad);
        let way = WayTo { distance_m: to.horizontal_norm(), bearing_rad, up_m: to.up() };
        let guidance = Guidance {
            step: GuidanceStep::FollowPath,
            task: Some(1),
            way: Some(way),
            progress: Some(0.1),
            tasks_done: 0,
            tasks: 4,
            deviation: None,
            stand_off: Some(StandOffReading { actual_m: 6.5, recommended_m: 4.5, tolerance_m: 1.5 }),
            flown_s: 70.0,
            needed_s: 557.0,
            detour: None,
        };
        let mut sectors_m = vec![f64::INFINITY; 8];
        (sectors_m[1], sectors_m[6], sectors_m[7]) = (1.9, 4.4, 8.0);
        let display = Hud {
            guidance: Some(guidance),
            heading_rad,
            roll_rad,
            pitch_rad,
            obstacles: Some(Obstacles { sectors_m, nearest_m: Some(1.9), range_m: 12.0, too_close_m: 2.5 }),
            way_back: (aids == PathAids::Gates).then_some(WayBack { direction_rad: 5.6 }),
            ..calm(&studio, position_m)
        };
        let seen = largest_even_size_px(VIEW_PX, moment.lens.aspect());
        let camera = studio.stage().camera(&moment, seen);
        let mut items = studio.stage().path_items(&camera, &moment, Some(&guidance), aids);
        let without_map = Hud { tracks: Vec::new(), ..display.clone() };
        items.extend(hud::layout(&without_map, f64::from(seen.0) / f64::from(seen.1)));
        let size_px = (240, 360);
        let beside = studio.stage().camera(&moment, size_px);
        let instruments = hud::instruments(&display, &studio.scene.outline, (f64::from(size_px.0), f64::from(size_px.1)));
        let views = [studio.draw_with(&beside, &instruments), studio.draw_with(&camera, &items)];
        wall.check(&format!("practice-{name}"), &side_by_side(&views));
    }
    wall.assert_no_errors();
}
