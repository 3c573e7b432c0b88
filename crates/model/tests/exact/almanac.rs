//! Almanac files that a scenario names.

use spandrel_model::satellites::Almanac;
use spandrel_model::scenario::{self, Scenario};
use spandrel_model::shipped;
use spandrel_model::toml::Problems;

const HEALTHY: &str = "ID: 7\nHealth: 000\nEccentricity: 0.01\nTime of Applicability(s): 61440.0\nOrbital Inclination(rad): 0.96
Rate of Right Ascen(r/s): -0.78E-008\nSQRT(A)  (m 1/2): 5153.65\nRight Ascen at Week(rad): 0.1\nArgument of Perigee(rad): 0.5
Mean Anom(rad): -0.1\nAf0(s): 0.0\nAf1(s/s): 0.0\nweek: 398\n";

fn read(almanac: &str, file_text: &str) -> Result<Scenario, Problems> {
    let text = format!("{}\n[hazards]\nsky = true\n{almanac}", shipped::without_hazards(shipped::TWO_BRIDGES));
    scenario::read("job.toml", &text, &|name| {
        if name == "gps.alm" { Ok(file_text.as_bytes().to_vec()) } else { Err("not found".into()) }
    })
}

#[test]
fn exact_job_reads_the_almanac_beside_it_and_none_for_the_nominal_orbits() {
    let almanac = |line: &str| read(line, HEALTHY).unwrap().hazards.almanac;
    let ids = |almanac: &Almanac| almanac.orbits.iter().map(|orbit| orbit.id).collect::<Vec<_>>();
    assert_eq!(almanac("almanac = \"gps.alm\"\n").as_deref().map(ids), Some(vec![7]));
    assert_eq!(almanac(""), None);
    assert_eq!(almanac("almanac = \"nominal\"\n"), None);
}

#[test]
fn exact_problems_of_the_almanac_name_its_file_and_line() {
    let wrong = HEALTHY.replace("5153.65", "51.5");
    let shown = read("almanac = \"gps.alm\"\n", &wrong).unwrap_err().to_string();
    assert_eq!(shown.trim(), "gps.alm:7: SQRT(A) = 51.5: out of range (allowed: 3100 to 7000)");
    let shown = read("almanac = \"other.alm\"\n", HEALTHY).unwrap_err().to_string();
    assert!(shown.contains("hazards.almanac = other.alm: not found (allowed: nominal, or a YUMA almanac file"), "{shown}");
}
