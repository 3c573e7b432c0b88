//! Scores a telemetry log. The scenario and the vehicle must match the recorded flight. Run it with `cargo run
//! --example score_tlog -- flight.tlog scenario.toml vehicle.toml`.

use spandrel_model::{scenario, vehicle};
use spandrel_monitor::assess_log;
use spandrel_monitor::sidecar::build_site;
use std::error::Error;
use std::fs;
use std::path::Path;

/// Scores the telemetry log from the command line.
pub fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    score(&arguments)
}

/// Prints the scores of a log, or the usage message if the number of arguments is not three.
pub fn score(arguments: &[String]) -> Result<(), Box<dyn Error>> {
    let [log, job, aircraft] = arguments else {
        println!("usage: score_tlog TLOG SCENARIO VEHICLE");
        return Ok(());
    };
    // The files that the scenario names, such as a height field, must be in the same folder.
    let beside = Path::new(job).parent().unwrap_or(Path::new(".")).to_owned();
    let sibling = |name: &str| fs::read(beside.join(name)).map_err(|error| error.to_string());
    let scenario = scenario::read(job, &fs::read_to_string(job)?, &sibling)?;
    let vehicle = vehicle::read(aircraft, &fs::read_to_string(aircraft)?)?;
    let assessed_session = assess_log(&fs::read(log)?, &scenario, &vehicle, build_site)?;
    let scores = &assessed_session.assessment.scores;
    println!("conformity {:?}", scores.conformity);
    println!("efficiency {:?}", scores.efficiency);
    println!("safety     {:?}", scores.safety);
    println!("accuracy   {:?}", scores.accuracy);
    println!("frames     {}", assessed_session.frames.len());
    Ok(())
}
