//! Places random defects. A line of sight from a task's path finds an exposed face within reach, [`crate::elements`] lists the
//! defect codes permitted there, and [`super::visibility`] decides whether the defect can be photographed without leaving the
//! path by more than the task's threshold. Each seed yields different positions. `causes` places defects where their causes
//! produce them instead.

use super::causes;
use super::defect_checks::{EDGE_MARGIN_M, fits_in_face, is_exposed};
pub use super::defect_checks::{PlacementContext, find_view};
use super::defect_slots::{Slot, draw_slots, resize};
use super::faces::{MemberFace, face_at};
use super::light::tangent_vectors;
use super::query_types::Surface;
pub use super::reference_camera::{CAMERA_CLEARANCE_M, REFERENCE_CAMERA, REFERENCE_LAMP};
use super::visibility;
use crate::defect_codes;
use crate::elements::Element;
use crate::frames::{Enu, Vec3};
use crate::math;
use crate::random::RandomStream;
use crate::scenario::{DefectPlacement, DefectSpec, PlacedDefect, Task, TaskKind};
use crate::vehicle::{Camera, Lamp};

/// Half angle of the search cone about the path's viewing direction, rad (estimate of camera pan and tilt).
const SEARCH_CONE_HALF_ANGLE_RAD: f64 = 0.9;
/// Unit vector pointing up.
const UP: Vec3<Enu> = Vec3::new(0.0, 0.0, 1.0);
/// Maximum distance of the search for faces, m (estimate; thin lines fail the visibility check at much shorter
/// distances).
const MAX_SEARCH_DISTANCE_M: f64 = 20.0;
/// Minimum distance between the centers of two defects, m, so that a photo rarely shows two defects.
const MIN_SEPARATION_M: f64 = 2.0;
/// Maximum number of attempts per defect. The first third requires the full separation; later attempts reduce it
/// gradually.
const MAX_ATTEMPTS: usize = 3000;

/// Returns the properties of an aircraft's camera and lamp that fall short of the reference, each with both values.
/// Empty if there are none.
#[must_use]
pub fn reference_shortfalls(camera: &Camera, lamp: &Lamp) -> Vec<String> {
    let candela = |l: &Lamp| l.luminous_flux_lm / (math::TAU * (1.0 - math::cos(0.5 * l.beam_angle_rad)));
    let wanting = [
        ("focal length (px)", camera.focal_px(), REFERENCE_CAMERA.focal_px()),
        ("lamp intensity (cd)", candela(lamp), candela(&REFERENCE_LAMP)),
        // Use the reciprocal, so that a higher value is better in every row.
        (
            "light sensitivity (1/lx)",
            1.0 / visibility::required_illuminance_lux(camera),
            1.0 / visibility::required_illuminance_lux(&REFERENCE_CAMERA),
        ),
        ("gimbal up limit (rad)", camera.gimbal_pitch_max_rad, REFERENCE_CAMERA.gimbal_pitch_max_rad),
        ("gimbal down limit (rad)", -camera.gimbal_pitch_min_rad, -REFERENCE_CAMERA.gimbal_pitch_min_rad),
    ];
    // Angles converted from degrees have a rounding error.
    let short = |has: f64, needs: f64| has.is_nan() || has < needs * (1.0 - 1e-9);
    wanting
        .iter()
        .filter(|w| short(w.1, w.2))
        .map(|(what, has, needs)| format!("{what}: {has:.4}, must be at least {needs:.4}"))
        .collect()
}

/// Returns the defects of a session: those in a resolved file, or otherwise defects drawn from the seed. Returns fewer
/// than requested only if the settings leave no position that can be photographed (for example, no bridge within reach
/// of a task, or defect codes that are not permitted on any element within reach).
#[must_use]
pub fn place_defects(settings: &DefectSpec, context: &PlacementContext, seed: u64) -> Vec<PlacedDefect> {
    if let Some(placed) = &settings.placed {
        return placed.clone();
    }
    let tasks: Vec<&Task> = context.tasks.iter().filter(|t| !t.path_m.is_empty()).collect();
    let seed = settings.seed.unwrap_or(seed);
    let mut stream = RandomStream::new(seed, "site.defects");
    let mut defects: Vec<PlacedDefect> = Vec::new();
    if tasks.is_empty() {
        return defects;
    }
    let slots = draw_slots(settings, seed);
    if settings.placement == DefectPlacement::Causes {
        return causes::place_by_cause(settings, context, &slots, seed);
    }
    let first = stream.below(tasks.len());
    for (k, slot) in slots.iter().enumerate() {
        let found = (0..tasks.len()).find_map(|turn| {
            let task = tasks[(first + k + turn) % tasks.len()];
            (0..MAX_ATTEMPTS).find_map(|attempt| try_place((settings, slot), context, task, (attempt, &defects), &mut stream))
        });
        if let Some(mut defect) = found {
            defect.id = defects.len() as u32 + 1;
            defects.push(defect);
        }
    }
    defects
}

/// Draws a line of sight, a defect code and a size; `None` if the defect cannot be placed there.
fn try_place(
    (settings, slot): (&DefectSpec, &Slot),
    context: &PlacementContext,
    task: &Task,
    (attempt, others): (usize, &[PlacedDefect]),
    stream: &mut RandomStream,
) -> Option<PlacedDefect> {
    let n = stream.below(task.path_m.len());
    // On a free path without a target, the camera does not necessarily point toward a structure.
    let is_aimless = task.kind == TaskKind::Free && !task.inspects_surface;
    let direction = if is_aimless {
        draw_direction_in_cone(UP, math::PI, stream)
    } else {
        draw_direction_in_cone(task.viewing_directions.get(n).copied().unwrap_or(UP), SEARCH_CONE_HALF_ANGLE_RAD, stream)
    };
    let kind_draw = stream.uniform();
    let condition_state = if stream.uniform() < 0.5 { 2 } else { 3 };
    let roll = stream.range(0.0, math::PI);
    let hit = (context.cast)(task.path_m[n], direction, MAX_SEARCH_DISTANCE_M)?;
    let member = (hit.surface == Surface::Bridge).then(|| context.members.get(hit.object.0 as usize)).flatten()?;
    let kind = choose_code((settings, slot), member.element, kind_draw)?;
    let (length_m, width_m) = defect_codes::draw_size(kind, condition_state, settings.size_factor, stream);
    let face = face_at(&member.solid, task.path_m[n] + direction * hit.distance_m)?;
    let mut defect = PlacedDefect {
        id: 0,
        element: member.element,
        member: member.name.clone(),
        kind,
        condition_state,
        position_m: face.point_m,
        normal: face.normal,
        along: defect_direction(kind, &face, roll),
        length_m,
        width_m,
        line: defect_codes::is_line(kind),
        cause: None,
        stain: None,
    };
    if let Some(target) = slot.detection {
        resize(&mut defect, target, context, stream)?;
    }
    let separation = MIN_SEPARATION_M * (1.5 - 1.5 * attempt as f64 / MAX_ATTEMPTS as f64).min(1.0);
    let apart = others.iter().all(|o| (o.position_m - defect.position_m).norm() >= separation);
    (apart
        && fits_in_face(&defect, &face, EDGE_MARGIN_M)
        && is_exposed(&defect, hit.object.0, context.cast, EDGE_MARGIN_M)
        && find_view(&defect, task, context).is_some())
    .then_some(defect)
}

fn choose_code((settings, slot): (&DefectSpec, &Slot), element: Element, draw: f64) -> Option<u32> {
    if !settings.elements.is_empty() && !settings.elements.contains(&element) {
        return None;
    }
    let suits = |k: u32| slot.line.is_none_or(|line| line == defect_codes::is_line(k));
    let wanted = |k: &&u32| (settings.kinds.is_empty() || settings.kinds.contains(*k)) && suits(**k);
    let legal: Vec<u32> = element.permitted_defects().iter().filter(wanted).copied().collect();
    legal.get((draw * legal.len() as f64) as usize).copied()
}

/// Returns the direction of a defect's longest dimension. Stains run down walls; corrosion, exposed reinforcement and connection
/// defects follow the member; all others have a random angle.
pub(super) fn defect_direction(kind: u32, face: &MemberFace, roll_rad: f64) -> Vec3<Enu> {
    let down = Vec3::new(0.0, 0.0, -1.0);
    let downhill = down - face.normal * face.normal.dot(down);
    let long = face.long_axis();
    match kind {
        defect_codes::EFFLORESCENCE if downhill.norm() > 0.3 => downhill.unit(),
        defect_codes::CORROSION | defect_codes::REBAR | defect_codes::CONNECTION => long,
        _ => {
            let (s, c) = math::sin_cos(roll_rad);
            (long * c + face.normal.cross(long) * s).unit()
        }
    }
}

/// Draws a direction uniformly within a cone about an axis.
fn draw_direction_in_cone(axis: Vec3<Enu>, half_angle_rad: f64, stream: &mut RandomStream) -> Vec3<Enu> {
    let z = stream.range(math::cos(half_angle_rad), 1.0);
    let (s, c) = math::sin_cos(stream.range(0.0, math::TAU));
    let r = (1.0 - z * z).max(0.0).sqrt();
    let axis = axis.unit();
    let (a, b) = tangent_vectors(axis);
    a * (r * c) + b * (r * s) + axis * z
}

#[cfg(test)]
mod tests {
    use super::super::boxes::OrientedBox;
    use super::super::defect_checks::end_points;
    use super::super::detection;
    use super::super::query_types::{ObjectId, RayHit};
    use super::*;
    use crate::scenario::bridges::{Member, Solid};

    const SEED_COUNT: u64 = 50;

    /// Creates a box-shaped member between two corners. Faces are counterclockwise seen from outside.
    fn member(name: &str, element: Element, low: [f64; 3], high: [f64; 3]) -> Member {
        let vertices_m = (0..8)
            .map(|k| {
                let pick = |axis: usize| if k >> axis & 1 == 1 { high[axis] } else { low[axis] };
                Vec3::new(pick(0), pick(1), pick(2))
            })
            .collect();
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Member {
            name: name.into(),
            element,
            solid: Solid { vertices_m, faces: faces.map(|f| f.to_vec()).to_vec(), surface: None },
        }
    }

    /// Creates a concrete wall with a steel girder in front of part of it. The task's path is 4 m south of the wall.
    fn members() -> Vec<Member> {
        vec![
            member("test/wall", Element::RcPierWall, [0.0, 0.0, 0.0], [40.0, 1.0, 10.0]),
            member("test/girder", Element::SteelGirder, [0.0, -0.8, 7.0], [40.0, 0.0, 9.0]),
            member("test/rail", Element::OtherRailing, [0.0, -0.8, 0.0], [40.0, 0.0, 0.5]),
        ]
    }

    fn task() -> Task {
        Task {
            id: 1,
            name: "wall".into(),
            bridge: Some(0),
            kind: TaskKind::SlabSide,
            threshold_m: 2.5,
            closed: false,
            path_m: (0..=40).map(|k| Vec3::new(f64::from(k), -4.0, 5.0)).collect(),
            viewing_directions: vec![Vec3::new(0.0, 1.0, 0.0); 41],
            inspects_surface: true,
            stand_off: None,
            too_close_m: None,
            dark: false,
        }
    }

    fn solids(members: &[Member]) -> Vec<OrientedBox> {
        members
            .iter()
            .map(|m| {
                let (a, b) = (m.solid.vertices_m[0], m.solid.vertices_m[7]);
                let half = (b - a) * 0.5;
                let axes = [Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::new(0.0, 0.0, 1.0)];
                OrientedBox { center_m: (a + b) * 0.5, axes, half_m: half.array() }
            })
            .collect()
    }

    fn settings() -> DefectSpec {
        DefectSpec { count: 10, size_factor: 1.0, ..DefectSpec::default() }
    }

    /// Calls `with` with the placement context and the boxes of the test site, under the given ambient illuminance.
    fn with_test_site<T>(lux: f64, with: impl FnOnce(&PlacementContext, &[OrientedBox]) -> T) -> T {
        let (members, tasks) = (members(), [task()]);
        let solids = solids(&members);
        let cast = |o: Vec3<Enu>, d: Vec3<Enu>, max: f64| {
            let hits = solids.iter().enumerate().filter_map(|(k, s)| s.ray(o, d, max).map(|h| (k, h)));
            let first = hits.fold(None, |best: Option<(usize, (f64, Vec3<Enu>))>, h| match best {
                Some(b) if b.1.0 <= h.1.0 => Some(b),
                _ => Some(h),
            });
            first.map(|(k, (distance_m, normal))| RayHit {
                distance_m,
                normal,
                surface: Surface::Bridge,
                object: ObjectId(k as u32),
            })
        };
        let clearance = |p: Vec3<Enu>| solids.iter().map(|s| s.nearest(p).0).fold(f64::INFINITY, f64::min);
        let ambient = move |_: Vec3<Enu>, _: Vec3<Enu>| lux;
        let context = PlacementContext {
            members: &members,
            tasks: &tasks,
            cast: &cast,
            ambient: &ambient,
            clearance_m: &clearance,
            water_up_m: 0.0,
        };
        with(&context, &solids)
    }

    #[test]
    fn prop_defects_are_permitted_on_the_surface_and_photographable() {
        /// Maximum distance of a defect's ends from its member, m.
        const SURFACE_TOLERANCE_M: f64 = 1e-3;
        with_test_site(1000.0, |context, solids| {
            for seed in 0..SEED_COUNT {
                let placed = place_defects(&settings(), context, seed);
                assert_eq!(placed.len(), 10, "seed {seed}");
                for d in &placed {
                    assert!(d.element.permitted_defects().contains(&d.kind), "{d:?}");
                    let k = context.members.iter().position(|m| m.name == d.member).expect("a member of the site");
                    assert_eq!(context.members[k].element, d.element);
                    for p in end_points(d, 0.0).iter().chain([&d.position_m]) {
                        assert!(solids[k].nearest(*p).0.abs() < SURFACE_TOLERANCE_M, "{d:?}");
                        let covered = solids.iter().enumerate().any(|(j, s)| j != k && s.nearest(*p).0 < SURFACE_TOLERANCE_M);
                        assert!(!covered, "covered by another member: {d:?}");
                    }
                    let pose = find_view(d, &context.tasks[0], context).expect("photographable");
                    let near = |p: &Vec3<Enu>| (*p - pose.position_m).norm();
                    let off = context.tasks[0].path_m.iter().map(near).fold(f64::INFINITY, f64::min);
                    assert!(off <= context.tasks[0].threshold_m, "{off} m off the path");
                }
            }
        });
    }

    #[test]
    fn prop_positions_depend_on_the_seed() {
        with_test_site(1000.0, |context, _| {
            let all: Vec<_> = (0..SEED_COUNT).map(|seed| place_defects(&settings(), context, seed)).collect();
            for (k, a) in all.iter().enumerate() {
                assert!(all[k + 1..].iter().all(|b| a.iter().all(|d| b.iter().all(|e| d.position_m != e.position_m))));
            }
            assert_eq!(all[7], place_defects(&settings(), context, 7));
        });
    }

    #[test]
    fn prop_placement_respects_elements_codes_and_resolved_files() {
        with_test_site(1000.0, |context, _| {
            let cracks = DefectSpec { elements: vec![Element::RcPierWall], kinds: vec![defect_codes::CRACK], ..settings() };
            let placed = place_defects(&cracks, context, 3);
            assert_eq!(placed.len(), 10);
            assert!(placed.iter().all(|d| d.element == Element::RcPierWall && d.kind == defect_codes::CRACK && d.line));
            let resolved = DefectSpec { placed: Some(placed[..2].to_vec()), ..settings() };
            assert_eq!(place_defects(&resolved, context, 99), placed[..2].to_vec());
            let illegal = DefectSpec { elements: vec![Element::SteelGirder], kinds: vec![defect_codes::CRACK], ..settings() };
            assert!(place_defects(&illegal, context, 3).is_empty());
        });
    }

    #[test]
    fn prop_sizes_follow_from_the_predicted_detection() {
        /// Rounding of a sum of ten probabilities.
        const ROUNDING: f64 = 1e-9;
        with_test_site(1000.0, |context, _| {
            for (seed, mean) in [(1, 0.75), (2, 0.55), (3, 0.9)] {
                let wanted = DefectSpec { mean_detection: Some(mean), line_count: Some(3), seed: Some(seed), ..settings() };
                let placed = place_defects(&wanted, context, 99);
                assert_eq!((placed.len(), placed.iter().filter(|d| d.line).count()), (10, 3));
                let predicted =
                    |d: &PlacedDefect| detection::predicted_detection(d, context.tasks, &REFERENCE_CAMERA, context.cast);
                let found = placed.iter().map(predicted).sum::<f64>() / 10.0;
                assert!((found - mean).abs() < ROUNDING, "{found}, expected {mean}");
                assert!(placed.iter().all(|d| find_view(d, &context.tasks[0], context).is_some()), "photographable");
                assert_eq!(placed, place_defects(&wanted, context, 98), "independent of the session's seed");
            }
        });
    }

    #[test]
    fn prop_dark_sites_have_defects_only_within_lamp_range() {
        with_test_site(0.0, |context, _| {
            let placed = place_defects(&settings(), context, 5);
            assert_eq!(placed.len(), 10);
            for d in &placed {
                let pose = find_view(d, &context.tasks[0], context).expect("photographable");
                let lamp = visibility::lamp_lux(&REFERENCE_LAMP, &pose, d.position_m, d.normal);
                assert!(lamp >= visibility::required_illuminance_lux(&REFERENCE_CAMERA), "{lamp} lx");
            }
        });
    }

    #[test]
    fn exact_camera_and_lamp_shortfalls_are_listed() {
        assert!(reference_shortfalls(&REFERENCE_CAMERA, &REFERENCE_LAMP).is_empty());
        let coarse = Camera { width_px: 1920, gimbal_pitch_max_rad: 0.5, ..REFERENCE_CAMERA };
        let dark = Lamp { luminous_flux_lm: 0.0, ..REFERENCE_LAMP };
        let words = reference_shortfalls(&coarse, &dark).join("; ");
        assert!(words.contains("focal") && words.contains("lamp") && words.contains("gimbal up"), "{words}");
        assert!(!words.contains("light sensitivity") && !words.contains("gimbal down"), "{words}");
    }

    #[test]
    fn prop_size_ranges_differ_by_condition_state() {
        for kind in defect_codes::ALL {
            let (fair, poor) = (defect_codes::size_ranges(*kind, 2), defect_codes::size_ranges(*kind, 3));
            assert!(fair.length_m.0 > 0.0 && fair.length_m.0 < fair.length_m.1);
            assert!(poor.length_m.1 > fair.length_m.1, "{kind}");
        }
        assert!(
            defect_codes::size_ranges(defect_codes::CRACK, 2).width.1 < defect_codes::size_ranges(defect_codes::CRACK, 3).width.0
        );
    }
}
