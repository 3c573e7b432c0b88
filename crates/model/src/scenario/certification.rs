//! Limits and cut scores of the certification profile: the `[certification]` table of a scenario file. The defaults are
//! estimates; docs/src/reference/assessment.md, "Certification", states the reason for each.

use crate::toml::{Reader, Section};
use serde::Serialize;

/// Requirements of the certification profile. Exports contain these names, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CertificationParams {
    /// Minimum battery charge at landing, %.
    pub min_battery_pct: f64,
    /// Maximum number of contacts, after merging those less than a second apart.
    pub max_contacts: usize,
    /// Maximum speed of any contact, m/s.
    pub max_contact_speed_m_s: f64,
    /// Minimum conformity, 0 to 100.
    pub min_conformity: f64,
    /// Minimum precision, 0 to 100.
    pub min_precision: f64,
    /// Minimum safety, 0 to 100.
    pub min_safety: f64,
    /// Minimum accuracy, 0 to 100.
    pub min_accuracy: f64,
    /// Fraction of a task's path below which the task counts as not inspected, 0 to 1.
    #[serde(rename = "min_inspected_share")]
    pub min_inspected_fraction: f64,
    /// Speed along the path from which the job's own time is computed, m/s.
    pub inspection_speed_m_s: f64,
    /// Time that the job allows for each defect, s.
    pub time_per_defect_s: f64,
    /// Time that the job allows for takeoff, landing and the transits between the tasks, s.
    pub transit_time_s: f64,
    /// Flight time at which the efficiency is 0, as a multiple of the job's own time.
    pub max_time_ratio: f64,
    /// Largest ground sampling distance of a picture that counts, mm per pixel.
    pub max_gsd_mm: f64,
    /// Largest ground sampling distance for a crack or other line, as a fraction of its width.
    pub gsd_per_line_width: f64,
    /// Largest motion blur of a picture that counts, px.
    pub max_smear_px: f64,
    /// Largest angle between the line of sight and the surface normal, degrees.
    pub max_incidence_deg: f64,
}

impl Default for CertificationParams {
    fn default() -> Self {
        Self {
            min_battery_pct: 20.0,
            max_contacts: 2,
            max_contact_speed_m_s: 1.0,
            min_conformity: 75.0,
            min_precision: 45.0,
            min_safety: 85.0,
            min_accuracy: 50.0,
            min_inspected_fraction: 0.1,
            inspection_speed_m_s: 1.0,
            time_per_defect_s: 15.0,
            transit_time_s: 120.0,
            max_time_ratio: 2.0,
            max_gsd_mm: 2.54,
            gsd_per_line_width: 0.1,
            max_smear_px: 1.0,
            max_incidence_deg: 60.0,
        }
    }
}

/// Reads the `[certification]` table. Missing keys get the default.
pub(super) fn read(r: &mut Reader, root: &mut Section) -> CertificationParams {
    let d = CertificationParams::default();
    let mut s = r.section(root, "certification");
    let max_contacts = r.integer(&mut s, "max_contacts", (0, 1_000), Some(d.max_contacts as i64)) as usize;
    let mut n = |key: &'static str, range: (f64, f64), default: f64| r.number(&mut s, key, range, Some(default));
    let params = CertificationParams {
        min_battery_pct: n("min_battery_pct", (0.0, 100.0), d.min_battery_pct),
        max_contacts,
        max_contact_speed_m_s: n("max_contact_speed_m_s", (0.0, 20.0), d.max_contact_speed_m_s),
        min_conformity: n("min_conformity", (0.0, 100.0), d.min_conformity),
        min_precision: n("min_precision", (0.0, 100.0), d.min_precision),
        min_safety: n("min_safety", (0.0, 100.0), d.min_safety),
        min_accuracy: n("min_accuracy", (0.0, 100.0), d.min_accuracy),
        min_inspected_fraction: n("min_inspected_pct", (0.0, 100.0), 100.0 * d.min_inspected_fraction) / 100.0,
        inspection_speed_m_s: n("inspection_speed_m_s", (0.05, 20.0), d.inspection_speed_m_s),
        time_per_defect_s: n("time_per_defect_s", (0.0, 600.0), d.time_per_defect_s),
        transit_time_s: n("transit_time_s", (0.0, 3_600.0), d.transit_time_s),
        max_time_ratio: n("max_time_ratio", (1.1, 20.0), d.max_time_ratio),
        max_gsd_mm: n("max_gsd_mm", (0.01, 100.0), d.max_gsd_mm),
        gsd_per_line_width: n("gsd_per_line_width", (0.01, 10.0), d.gsd_per_line_width),
        max_smear_px: n("max_smear_px", (0.1, 100.0), d.max_smear_px),
        max_incidence_deg: n("max_incidence_deg", (1.0, 60.0), d.max_incidence_deg),
    };
    r.finish(&s);
    params
}
