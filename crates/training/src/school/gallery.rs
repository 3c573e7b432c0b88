//! The pictures that can be asked about: close-ups of the defects of a job, and of sound surfaces near them.

use super::card::{Card, Distance, Subject};
use spandrel_model::defect_codes;
use spandrel_model::elements::{Element, ElementMaterial};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::math;
use spandrel_model::random::RandomStream;
use spandrel_model::scenario::{DefectSpec, PlacedDefect, Scenario};
use spandrel_model::site::close_up::{SurfaceSpot, close_up_pose};
use spandrel_model::site::visibility::{MIN_EXTENT_PX, MIN_LINE_WIDTH_PX};
use spandrel_model::site::{CameraPose, DefectView, Site};
use spandrel_model::time::SimTime;
use spandrel_model::vehicle::{Camera, Vehicle};

/// Numbers of areas, of cracks, and of defects on steel in the school's site (estimates: several pictures of every kind).
const AREA_COUNT: usize = 30;
const LINE_COUNT: usize = 15;
const STEEL_COUNT: usize = 15;
/// Largest condition state whose cracks may be thin. The edges of worse ones crumble.
const MAX_THIN_STATE: u8 = 3;
/// Factor by which a defect that can be seen must exceed the scorer's smallest extent and line width (estimate: clear to a
/// beginner).
const CLEAR_FACTOR: f64 = 2.0;
/// Largest extent and line width, px, of a defect that nobody can see (estimates: less than the grain of the surface).
const HIDDEN_EXTENT_PX: f64 = 4.0;
const HIDDEN_LINE_WIDTH_PX: f64 = 0.2;
/// Number of positions beside a defect that are tried for a picture of a sound surface, and their distance from it, m.
const SOUND_ATTEMPTS: usize = 6;
const SOUND_DISTANCE_M: (f64, f64) = (0.6, 3.0);
/// Height from which the surface beside a defect is searched for, m.
const PROBE_HEIGHT_M: f64 = 0.3;
/// Largest difference between the heights of two spots on the same surface, m.
const FLATNESS_M: f64 = 0.01;
/// Fraction of the photograph's width and height that a school picture shows, around its middle (estimate: at the resolution of
/// the photograph, it fills most of a usual window).
const PICTURE_FRACTION: f64 = 0.25;
/// The same for a picture and its surroundings. The scorer counts the middle 80% of them (estimate: most defects are smaller than a
/// picture from 3 m).
const SURROUNDINGS_FRACTION: f64 = 0.5;

/// A picture that can be taken.
#[derive(Debug, Clone, PartialEq)]
pub struct SchoolPicture {
    /// Subject and distance.
    pub card: Card,
    /// Camera pose.
    pub pose: CameraPose,
    /// Element at the middle.
    pub element: Element,
    /// The defect at the middle; `None` for a sound surface.
    pub defect: Option<PlacedDefect>,
    /// Whether the defect can be seen: true for a sound surface, too, on which there is nothing else to see.
    pub visible: bool,
    /// Size of a pixel of the photograph on the surface, m.
    pub pixel_m: f64,
}

/// Returns a scenario whose site has enough defects of all kinds for the school. Takes as long as building three sites.
#[must_use]
pub fn school_scenario(job: &Scenario, seed: u64) -> Scenario {
    let steel = Element::ALL.iter().filter(|element| element.material() == ElementMaterial::Steel).copied().collect();
    // Few members that the job's paths reach are steel, and few defects of concrete are cracks. No camera can resolve fatigue
    // cracks from the paths, so they are only possible answers.
    let sets = [(AREA_COUNT, 0, Vec::new()), (LINE_COUNT, LINE_COUNT, Vec::new()), (STEEL_COUNT, 0, steel)];
    let mut stream = RandomStream::new(seed, "school.defects");
    let mut placed = Vec::new();
    for (count, lines, elements) in sets {
        let set_seed = stream.bits() >> 1;
        let defects = DefectSpec {
            count,
            placement: job.defects.placement,
            size_factor: 1.0,
            elements,
            kinds: Vec::new(),
            seed: Some(set_seed),
            mean_detection: None,
            line_count: Some(lines),
            placed: None,
        };
        placed.extend(Site::build(&Scenario { defects, ..job.clone() }, set_seed).defects().iter().cloned());
    }
    for (defect, id) in placed.iter_mut().zip(1..) {
        defect.id = id;
        if defect.line && defect.condition_state <= MAX_THIN_STATE {
            // A job has only cracks that its paths let a camera resolve. The school has thinner ones, too.
            defect.width_m = crack_width_m(defect.kind, &mut stream);
        }
    }
    Scenario { defects: DefectSpec { placed: Some(placed), ..job.defects.clone() }, ..job.clone() }
}

/// Draws the width of a crack from its whole catalog, with as many thin ones as wide ones.
fn crack_width_m(kind: u32, stream: &mut RandomStream) -> f64 {
    let [(low, _), (_, high)] = [2, 3].map(|condition_state| defect_codes::size_ranges(kind, condition_state).width);
    math::exp(stream.range(math::ln(low), math::ln(high)))
}

/// Returns the camera of the school's pictures: the middle of the aircraft's photograph at its full resolution.
#[must_use]
pub fn picture_camera(camera: &Camera) -> Camera {
    middle_part(camera, PICTURE_FRACTION)
}

/// Returns the camera whose picture is a part of another camera's picture, around its middle.
fn middle_part(camera: &Camera, fraction: f64) -> Camera {
    let part = |px: u32| (f64::from(px) * fraction) as u32;
    let hfov_rad = 2.0 * math::atan(fraction * math::tan(0.5 * camera.hfov_rad));
    Camera { width_px: part(camera.width_px), height_px: part(camera.height_px), hfov_rad, ..*camera }
}

/// Returns the pictures of all defects and of sound surfaces near them. A picture in which a defect is neither clear nor
/// invisible is left out.
#[must_use]
pub fn gallery(site: &Site, vehicle: &Vehicle, seed: u64) -> Vec<SchoolPicture> {
    let mut stream = RandomStream::new(seed, "school.sound");
    let studio = Studio { site, vehicle, surroundings: middle_part(&vehicle.camera, SURROUNDINGS_FRACTION) };
    let mut pictures = Vec::new();
    for defect in site.defects() {
        pictures.extend(Distance::ALL.into_iter().filter_map(|distance| studio.of_defect(defect, distance)));
        let distance = Distance::ALL[stream.below(Distance::ALL.len())];
        pictures.extend((0..SOUND_ATTEMPTS).find_map(|_| studio.of_surface_near(defect, distance, &mut stream)));
    }
    pictures
}

/// Inputs for choosing pictures.
struct Studio<'a> {
    site: &'a Site,
    vehicle: &'a Vehicle,
    /// Camera of the picture and its surroundings, from which no other defect may reach into the picture.
    surroundings: Camera,
}

impl Studio<'_> {
    fn of_defect(&self, defect: &PlacedDefect, distance: Distance) -> Option<SchoolPicture> {
        let spot = SurfaceSpot { position_m: defect.position_m, normal: defect.normal };
        let pose = close_up_pose(self.site, spot, f64::from(distance.m()), SimTime::ZERO)?;
        let views = self.views(&pose);
        let alone = views.iter().all(|view| view.defect_id == defect.id || !is_in_picture(view));
        let view = views.iter().find(|view| view.defect_id == defect.id)?;
        let visible = visibility(view)?;
        let card = Card { distance, subject: Subject::Defect(defect.kind) };
        alone.then(|| SchoolPicture { defect: Some(defect.clone()), visible, ..self.picture(card, pose, defect.element) })
    }

    /// Returns a picture of the same surface at some distance from a defect, if no defect is in it.
    fn of_surface_near(&self, defect: &PlacedDefect, distance: Distance, stream: &mut RandomStream) -> Option<SchoolPicture> {
        let (s, c) = math::sin_cos(stream.range(0.0, math::TAU));
        let aside = stream.range(SOUND_DISTANCE_M.0, SOUND_DISTANCE_M.1);
        let along = defect.along * c + defect.normal.cross(defect.along) * s;
        let position_m = defect.position_m + along * aside;
        let above = position_m + defect.normal * PROBE_HEIGHT_M;
        let hit = self.site.ray(above, -defect.normal, 2.0 * PROBE_HEIGHT_M, SimTime::ZERO)?;
        let member = self.site.members().get(hit.object.0 as usize)?;
        if member.name != defect.member || (hit.distance_m - PROBE_HEIGHT_M).abs() > FLATNESS_M {
            return None;
        }
        let spot = SurfaceSpot { position_m, normal: defect.normal };
        let pose = close_up_pose(self.site, spot, f64::from(distance.m()), SimTime::ZERO)?;
        let empty = self.views(&pose).iter().all(|view| !is_in_picture(view));
        let half_m = 0.5 * f64::from(self.surroundings.width_px) * self.pixel_m(distance);
        (empty && !self.is_stained(position_m, half_m))
            .then(|| self.picture(Card { distance, subject: Subject::Sound }, pose, defect.element))
    }

    /// Returns a picture without a defect.
    fn picture(&self, card: Card, pose: CameraPose, element: Element) -> SchoolPicture {
        SchoolPicture { card, pose, element, defect: None, visible: true, pixel_m: self.pixel_m(card.distance) }
    }

    /// Returns the size of a pixel on the surface, m.
    fn pixel_m(&self, distance: Distance) -> f64 {
        f64::from(distance.m()) / self.surroundings.focal_px()
    }

    /// Returns whether a stain that belongs to a defect is within a distance of a position.
    fn is_stained(&self, position_m: Vec3<Enu>, distance_m: f64) -> bool {
        let mut stains = self.site.defects().iter().filter_map(PlacedDefect::stain_patch);
        stains.any(|stain| (stain.center_m - position_m).norm() < distance_m + 0.5 * stain.length_m)
    }

    /// Returns the defects in front of the camera.
    fn views(&self, pose: &CameraPose) -> Vec<DefectView> {
        self.site.view_defects(pose, &self.surroundings, &self.vehicle.lamp, SimTime::ZERO)
    }
}

/// Returns true if a defect may appear in a picture.
fn is_in_picture(view: &DefectView) -> bool {
    view.in_frame && view.unoccluded && view.extent_px > HIDDEN_EXTENT_PX
}

/// Returns whether a defect can be seen; `None` in doubt.
fn visibility(view: &DefectView) -> Option<bool> {
    let hidden = view.extent_px < HIDDEN_EXTENT_PX || (view.line && view.width_px < HIDDEN_LINE_WIDTH_PX);
    let wide = !view.line || view.width_px >= CLEAR_FACTOR * MIN_LINE_WIDTH_PX;
    let clear = view.hit && wide && view.extent_px >= CLEAR_FACTOR * MIN_EXTENT_PX;
    (hidden || clear).then_some(clear)
}
