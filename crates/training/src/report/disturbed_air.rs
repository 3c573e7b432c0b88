//! Times and places at which the bridges disturbed the air around the aircraft, as the vehicle reported it.

use super::bridge_zone::BridgeZone;
use super::formatting;
use super::interval_total::IntervalTotal;
use super::radio_losses::MAX_REPORT_AGE_S;
use super::table::{Table, TableCell};
use spandrel_mavlink::contract::hazards::HazardReport;
use spandrel_mavlink::telemetry::{Frame, Navigation};
use spandrel_model::frames::{Enu, Vec3};
use spandrel_model::scenario::Scenario;
use spandrel_text::{Language, text};

/// Velocity that the bridges add, from which the air counts as disturbed, m/s (estimate: an aircraft leans or moves visibly).
pub const NOTABLE_ADDED_M_S: f64 = 0.5;
/// Largest number of places where the air was disturbed most.
const MAX_PLACES: usize = 3;
/// Time between two such places, s, and their distance, m, which make them different ones.
const APART: (f64, f64) = (5.0, 10.0);

/// A moment at which the bridges disturbed the air most.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisturbedPlace {
    /// Time since lift-off, s.
    pub at_s: f64,
    /// Position of the aircraft, m.
    pub position_m: Vec3<Enu>,
    /// Velocity that the bridges added to the wind, m/s.
    pub added_m_s: Vec3<Enu>,
    /// Where that is; `None` in a job without bridges.
    pub zone: Option<BridgeZone>,
}

/// Disturbed air of a flight. It is empty if the job does not simulate wakes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DisturbedAir {
    /// Time in disturbed air.
    pub time: IntervalTotal,
    /// Places where the air was disturbed most, the strongest first.
    pub places: Vec<DisturbedPlace>,
}

impl DisturbedAir {
    /// Measures a flight.
    #[must_use]
    pub fn measure(scenario: &Scenario, frames: &[Frame], navigation: &Navigation) -> Self {
        let (Some(first), Some(last)) = (frames.first(), frames.last()) else { return Self::default() };
        let reports = navigation.hazards().between(first.time, last.time);
        let added = |report: &HazardReport| report.wake_m_s.map_or(Vec3::zero(), |added| added.enu());
        let is_disturbed = |report: &HazardReport| added(report).norm() >= NOTABLE_ADDED_M_S;
        let mut all: Vec<DisturbedPlace> = reports
            .iter()
            .filter(|(_, _, report)| is_disturbed(report))
            .map(|(time, _, report)| {
                let frame = frames.partition_point(|frame| frame.time < *time).min(frames.len() - 1);
                let position_m = frames[frame].position_m;
                let zone = BridgeZone::of(scenario, position_m);
                DisturbedPlace { at_s: (*time - first.time).s(), position_m, added_m_s: added(report), zone }
            })
            .collect();
        all.sort_by(|a, b| b.added_m_s.norm().total_cmp(&a.added_m_s.norm()));
        let mut places: Vec<DisturbedPlace> = Vec::new();
        for place in all {
            let is_same = |known: &DisturbedPlace| {
                (known.at_s - place.at_s).abs() < APART.0 || (known.position_m - place.position_m).norm() < APART.1
            };
            if places.len() < MAX_PLACES && !places.iter().any(is_same) {
                places.push(place);
            }
        }
        Self { time: IntervalTotal::of_reports(reports, (first.time, last.time), MAX_REPORT_AGE_S, is_disturbed), places }
    }

    /// Returns what is worth mentioning, as sentences.
    #[must_use]
    pub fn sentences(&self, scenario: &Scenario, language: Language) -> Vec<String> {
        let Some(strongest) = self.places.first() else { return Vec::new() };
        let IntervalTotal { total_s, longest_s, longest_from_s } = self.time;
        let [total, longest, from] = [total_s, longest_s, longest_from_s].map(formatting::clock);
        let least = formatting::number(NOTABLE_ADDED_M_S, 1);
        let (at, speed) = (formatting::clock(strongest.at_s), formatting::number(strongest.added_m_s.norm(), 1));
        let place = strongest.zone.map_or_else(String::new, |zone| zone.words(scenario, language));
        vec![
            text!(language, "report-air-disturbed", least = least, total = total, longest = longest, from = from),
            text!(language, "report-air-strongest", speed = speed, at = at, place = place),
        ]
    }

    /// Returns the places as a table.
    #[must_use]
    pub fn table(&self, scenario: &Scenario, language: Language) -> Table {
        let row = |(number, place): (usize, &DisturbedPlace)| {
            let [east, north, up] = place.position_m.array().map(|value| TableCell::Number(value, 1));
            vec![
                number.into(),
                TableCell::Clock(place.at_s),
                place.zone.map_or(TableCell::Empty, |zone| zone.words(scenario, language).into()),
                TableCell::Number(place.added_m_s.norm(), 1),
                TableCell::Number(place.added_m_s.up(), 1),
                east,
                north,
                up,
            ]
        };
        Table {
            name: "air",
            caption: text!(language, "report-air-caption"),
            columns: vec![
                text!(language, "report-column-number"),
                text!(language, "report-column-time"),
                text!(language, "report-column-place"),
                text!(language, "report-column-added-air"),
                text!(language, "report-column-added-updraft"),
                text!(language, "report-column-east"),
                text!(language, "report-column-north"),
                text!(language, "report-column-height"),
            ],
            rows: (1..).zip(&self.places).map(row).collect(),
        }
    }
}
