//! Makes a job of one's own from a shipped one, and asks the site what stands where. Run it by `cargo run --example custom_job`.

use spandrel_model::frames::Vec3;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::{scenario, shipped};

/// Makes the job and asks.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A job is a TOML file; scenarios/README.md explains every key. This one gets other traffic and a name.
    let text = shipped::TWO_BRIDGES.replace("name = \"two-bridges\"", "name = \"quiet-bridges\"");
    let mut job = scenario::read("quiet-bridges.toml", &text, &|file| Err(format!("{file} is not there")))?;
    job.traffic.cars = 0;
    job.traffic.trucks = 0;

    let site = Site::build(&job, 7);
    println!("{}: {} members, {} defects", job.name, site.members().len(), site.defects().len());
    for defect in site.defects().iter().take(3) {
        let away_m = (defect.position_m - job.ground_team.pad_m).norm();
        println!("defect {} is {away_m:.0} m from the pad", defect.id);
    }
    let over_the_pad = job.ground_team.pad_m + Vec3::new(0.0, 0.0, 10.0);
    if let Some(nearest) = site.nearest(over_the_pad, 200.0, SimTime::ZERO) {
        println!("nearest to 10 m over the pad: {} at {:.1} m", site.object_name(nearest.object), nearest.distance_m);
    }
    Ok(())
}
