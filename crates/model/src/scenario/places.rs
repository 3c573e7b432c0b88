//! Places to which the inspector can walk. This reader checks what the file alone shows; `spandrel check` also builds the site and
//! checks the ground, the water and the bridges there.

use super::job::GroundTeam;
use super::point::MAX_COORDINATE_M;
use crate::frames::{Enu, Vec3};
use crate::toml::{Reader, Section};

/// Key with the places.
pub const KEY: &str = "places_m";
/// Maximum number of places, with `inspector_m` as place 1: a place has one digit in the code of a walk.
pub const MAX_PLACES: usize = 8;
/// Maximum horizontal distance of a place from the landing pad, m (estimate: a walk of six minutes; a small drone is hardly visible
/// from farther away).
pub const MAX_DISTANCE_M: f64 = 500.0;
/// Minimum horizontal distance between two places, m (estimate: nobody walks for less).
pub const MIN_SPACING_M: f64 = 2.0;
/// Minimum distance of a person from the edge of the landing pad, m (estimate: half a person's width and an arm's length).
pub const PAD_MARGIN_M: f64 = 0.5;

/// Reads the places from 2 on; `team` contains place 1 and the landing pad, or `None` if one of them has a problem.
pub(super) fn read(r: &mut Reader, s: &mut Section, team: Option<&GroundTeam>) -> Vec<Vec3<Enu>> {
    let list = r.points(s, KEY, (-MAX_COORDINATE_M, MAX_COORDINATE_M));
    let places: Vec<Vec3<Enu>> = list.into_iter().map(|[east, north, up]| Vec3::new(east, north, up)).collect();
    if places.len() >= MAX_PLACES {
        let given = format!("{} places", places.len());
        r.add_problem(s, KEY, &given, &format!("at most {} places", MAX_PLACES - 1), "too many");
    }
    let Some(team) = team else { return places };
    let all: Vec<Vec3<Enu>> = std::iter::once(team.inspector_m).chain(places.iter().copied()).collect();
    for (k, place) in all.iter().enumerate().skip(1) {
        if let Some((allowed, message)) = problem(*place, k + 1, &all[..k], team) {
            r.add_problem(s, KEY, &shown(*place), &allowed, &message);
        }
    }
    places
}

/// Returns a place as in a file, for messages.
#[must_use]
pub fn shown(place_m: Vec3<Enu>) -> String {
    let [east, north, up] = place_m.array();
    format!("[{east}, {north}, {up}]")
}

/// Returns what is allowed, and what is wrong with the place that has this number.
fn problem(place: Vec3<Enu>, number: usize, before: &[Vec3<Enu>], team: &GroundTeam) -> Option<(String, String)> {
    let distance_m = (place - team.pad_m).horizontal_norm();
    if distance_m > MAX_DISTANCE_M {
        let message = format!("place {number} is {distance_m:.0} m from the landing pad");
        return Some((format!("at most {MAX_DISTANCE_M} m from the landing pad"), message));
    }
    if is_on_pad(place, team.pad_m, team.pad_half_m) {
        let allowed = format!("at least {PAD_MARGIN_M} m from the edge of the landing pad");
        return Some((allowed, format!("place {number} is on the landing pad")));
    }
    let mut spacings_m = (1..).zip(before.iter().map(|other| (place - *other).horizontal_norm()));
    let (other, spacing_m) = spacings_m.find(|(_, spacing_m)| *spacing_m < MIN_SPACING_M)?;
    let message = format!("place {number} is {spacing_m:.1} m from place {other}");
    Some((format!("at least {MIN_SPACING_M} m from every other place"), message))
}

/// Returns whether a person at a place stands on the landing pad or at its edge.
#[must_use]
pub fn is_on_pad(place_m: Vec3<Enu>, pad_m: Vec3<Enu>, pad_half_m: f64) -> bool {
    let away = place_m - pad_m;
    away.east().abs().max(away.north().abs()) < pad_half_m + PAD_MARGIN_M
}
