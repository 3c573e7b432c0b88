//! Draws defects among the places of all causes. Each defect meets the same conditions as one that is placed anywhere: it fits on its face,
//! nothing covers it, and a camera can photograph it from within the task's threshold.

use super::measures::{self, Measure};
use super::place::{Anchor, Place};
use super::structure::{REACH_M, Structure};
use super::{
    bending, cable, drain, edge, fasteners, frost, leaking_joint, reinforcement, seepage, shear, shrinkage, swelling, water_line,
    weld,
};
use crate::frames::{Enu, Vec3};
use crate::random::RandomStream;
use crate::scenario::{DefectCause, DefectSpec, PlacedDefect, Stain, StainSubstance, Task, downhill};
use crate::site::defect_checks::{EDGE_MARGIN_M, PlacementContext, find_view, fits_in_face, is_exposed};
use crate::site::defect_slots::{Slot, resize};

/// Minimum distance between the centers of two defects, m, so that a photo rarely shows two defects.
const MIN_SEPARATION_M: f64 = 2.0;
/// Attempts for one cause at one task. The first third requires the full separation; later ones reduce it gradually.
const ATTEMPTS: usize = 300;
/// Number of path points that are skipped when places within reach are searched for.
const PATH_STEP: usize = 3;
/// Length of a stain relative to its defect's extent, and its limits, m (estimates).
const STAIN_FACTOR: (f64, f64) = (0.8, 2.5);
const STAIN_LENGTH_M: (f64, f64) = (0.15, 1.5);
/// Share of the defects with water behind them that have a stain in condition states 2, 3 and 4 (estimate: dry years wash them off).
const STAIN_SHARES: [f64; 3] = [0.5, 0.85, 1.0];

/// Functions that list the places of each cause.
const SOURCES: [fn(&Structure) -> Vec<Place>; 14] = [
    bending::places,
    shear::places,
    shrinkage::places,
    swelling::places,
    leaking_joint::places,
    drain::places,
    reinforcement::places,
    edge::places,
    water_line::places,
    weld::places,
    fasteners::places,
    cable::places,
    seepage::places,
    frost::places,
];

/// Places of one cause within reach of one task, with the sums of their weights.
struct Choice {
    cause: DefectCause,
    places: Vec<usize>,
    sums: Vec<f64>,
}

/// Places the defects of a session by their causes, which take turns, so that a session shows as many as possible.
#[must_use]
pub(crate) fn place_by_cause(settings: &DefectSpec, context: &PlacementContext, slots: &[Slot], seed: u64) -> Vec<PlacedDefect> {
    let tasks: Vec<&Task> = context.tasks.iter().filter(|task| !task.path_m.is_empty()).collect();
    let structure = Structure::new(context.members, &tasks, context.water_up_m);
    let places = permitted_places(settings, &structure);
    let choices: Vec<Vec<Choice>> = tasks.iter().map(|task| choices(&places, task, &structure)).collect();
    let mut sampler = Sampler {
        settings,
        context,
        structure: &structure,
        places: &places,
        stream: RandomStream::new(seed, "site.defects.causes"),
        placed: Vec::new(),
        turns: Vec::new(),
    };
    let first = sampler.stream.below(tasks.len().max(1));
    for (k, slot) in slots.iter().enumerate() {
        let found = (0..tasks.len()).find_map(|turn| {
            let number = (first + k + turn) % tasks.len();
            sampler.at_task(slot, tasks[number], &choices[number])
        });
        if let Some(mut defect) = found {
            defect.id = sampler.placed.len() as u32 + 1;
            sampler.placed.push(defect);
        }
    }
    sampler.placed
}

/// Returns the places whose element and defect the settings and the manual permit.
fn permitted_places(settings: &DefectSpec, structure: &Structure) -> Vec<Place> {
    let is_permitted = |place: &Place| {
        let element = structure.members[structure.surfaces[place.surface].member].element;
        let element_fits = settings.elements.is_empty() || settings.elements.contains(&element);
        let kind_fits = settings.kinds.is_empty() || settings.kinds.contains(&place.kind);
        element_fits && kind_fits && place.weight > 0.0 && element.permitted_defects().contains(&place.kind)
    };
    SOURCES.iter().flat_map(|source| source(structure)).filter(is_permitted).collect()
}

/// Returns the places within reach of a task, by cause.
fn choices(places: &[Place], task: &Task, structure: &Structure) -> Vec<Choice> {
    let path: Vec<Vec3<Enu>> = task.path_m.iter().step_by(PATH_STEP).copied().collect();
    let in_reach = |place: &Place| {
        let normal = structure.surfaces[place.surface].face.normal;
        path.iter().any(|p| (*p - place.point_m).norm_squared() < REACH_M * REACH_M && (*p - place.point_m).dot(normal) > 0.0)
    };
    let near: Vec<usize> = (0..places.len()).filter(|k| in_reach(&places[*k])).collect();
    let of_cause = |cause: DefectCause| {
        let own: Vec<usize> = near.iter().copied().filter(|k| places[*k].cause == cause).collect();
        let sums = own.iter().scan(0.0, |sum, k| {
            *sum += places[*k].weight;
            Some(*sum)
        });
        Choice { cause, sums: sums.collect(), places: own }
    };
    DefectCause::ALL.iter().map(|(_, cause)| of_cause(*cause)).filter(|choice| !choice.places.is_empty()).collect()
}

struct Sampler<'a> {
    settings: &'a DefectSpec,
    context: &'a PlacementContext<'a>,
    structure: &'a Structure<'a>,
    places: &'a [Place],
    stream: RandomStream,
    placed: Vec<PlacedDefect>,
    /// Causes of the defects so far, and causes that found no place, with the task where they failed.
    turns: Vec<(DefectCause, Option<u32>)>,
}

impl Sampler<'_> {
    /// Places one defect near a task's path: by the cause that had the fewest turns so far, and at random among several.
    fn at_task(&mut self, slot: &Slot, task: &Task, choices: &[Choice]) -> Option<PlacedDefect> {
        let mut order: Vec<(usize, f64, usize)> = choices
            .iter()
            .enumerate()
            .map(|(k, choice)| (self.turns_of(choice.cause, task.id), self.stream.uniform(), k))
            .collect();
        order.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for (_, _, k) in order {
            let choice = &choices[k];
            let found = (0..ATTEMPTS).find_map(|attempt| self.attempt(slot, task, choice, attempt));
            // A cause without a place that can be photographed waits for its next turn, too, because its attempts take long.
            self.turns.push((choice.cause, found.is_none().then_some(task.id)));
            if found.is_some() {
                return found;
            }
        }
        None
    }

    fn turns_of(&self, cause: DefectCause, task: u32) -> usize {
        self.turns.iter().filter(|(one, failed_at)| *one == cause && failed_at.is_none_or(|at| at == task)).count()
    }

    fn attempt(&mut self, slot: &Slot, task: &Task, choice: &Choice, attempt: usize) -> Option<PlacedDefect> {
        let draw = self.stream.uniform() * choice.sums.last()?;
        let number = choice.sums.partition_point(|sum| *sum <= draw).min(choice.places.len() - 1);
        let place = &self.places[choice.places[number]];
        let jitter = place.jitter_m.map(|direction| direction * self.stream.range(-1.0, 1.0));
        let stain_draw = (self.stream.uniform(), self.stream.range(STAIN_FACTOR.0, STAIN_FACTOR.1));
        let measure = measures::draw(place, self.settings.size_factor, &mut self.stream)?;
        if slot.line.is_some_and(|line| line != place.line) {
            return None;
        }
        let point_m = place.point_m + jitter[0] + jitter[1];
        let mut defect = self.defect(place, point_m, measure);
        if let Some(target) = slot.detection {
            resize(&mut defect, target, self.context, &mut self.stream)?;
            defect.position_m = center(place, point_m, defect.length_m, defect.width_m);
        }
        let surface = &self.structure.surfaces[place.surface];
        let separation = MIN_SEPARATION_M * (1.5 - 1.5 * attempt as f64 / ATTEMPTS as f64).min(1.0);
        let apart = self.placed.iter().all(|other| (other.position_m - defect.position_m).norm() >= separation);
        let fits = apart
            && fits_in_face(&defect, &surface.face.at(defect.position_m), place.margin_m)
            && is_exposed(&defect, surface.member as u32, self.context.cast, place.margin_m)
            && find_view(&defect, task, self.context).is_some();
        fits.then(|| PlacedDefect { stain: self.stain(place, &defect, stain_draw), ..defect })
    }

    fn defect(&self, place: &Place, point_m: Vec3<Enu>, measure: Measure) -> PlacedDefect {
        let surface = &self.structure.surfaces[place.surface];
        let member = &self.structure.members[surface.member];
        PlacedDefect {
            id: 0,
            element: member.element,
            member: member.name.clone(),
            kind: place.kind,
            condition_state: measure.condition_state,
            position_m: center(place, point_m, measure.length_m, measure.width_m),
            normal: surface.face.normal,
            along: place.along,
            length_m: measure.length_m,
            width_m: measure.width_m,
            line: place.line,
            cause: Some(place.cause),
            stain: None,
        }
    }

    /// Returns the stain of a defect, as long as its face permits.
    fn stain(&self, place: &Place, defect: &PlacedDefect, (share_draw, factor): (f64, f64)) -> Option<Stain> {
        let substance = place.stain?;
        if share_draw >= STAIN_SHARES[usize::from(defect.condition_state.clamp(2, 4)) - 2] {
            return None;
        }
        let face = self.structure.surfaces[place.surface].face.at(defect.position_m);
        let Some(down) = downhill(defect.normal) else {
            // Rust runs along undersides only as a thin film, which is not drawn.
            let length_m = 0.8 * defect.length_m;
            return (substance == StainSubstance::Lime).then_some(Stain { substance, length_m });
        };
        let extent_m = defect.half_extent_m(down);
        let room_m = face.boundary_m(defect.position_m, down)? - extent_m - EDGE_MARGIN_M;
        let length_m = (2.0 * extent_m * factor).clamp(STAIN_LENGTH_M.0, STAIN_LENGTH_M.1).min(room_m);
        let stain = Stain { substance, length_m };
        let stained = PlacedDefect { stain: Some(stain), ..defect.clone() };
        let patch = stained.stain_patch().filter(|_| length_m >= STAIN_LENGTH_M.0)?;
        let across = defect.normal.cross(patch.along);
        let half_m = 0.5 * patch.width_m;
        let inside = [-1.0, 1.0].iter().all(|side| {
            [-1.0, 1.0].iter().all(|end| {
                let corner = patch.center_m + patch.along * (0.5 * end * patch.length_m) + across * (side * half_m);
                face.edge_distance_m(corner) > 0.0
            })
        });
        inside.then_some(stain)
    }
}

/// Returns the center of a defect of this size at a place.
fn center(place: &Place, point_m: Vec3<Enu>, length_m: f64, width_m: f64) -> Vec3<Enu> {
    let margin_m = place.margin_m + 1e-3;
    match place.anchor {
        Anchor::Center => point_m,
        Anchor::Start => point_m + place.along * (0.5 * length_m + margin_m),
        Anchor::End => point_m - place.along * (0.5 * length_m + margin_m),
        Anchor::Side(inward) => point_m + inward * (0.5 * width_m + margin_m),
    }
}
