//! Creates a job from a shipped scenario and queries its site for members, defects, and distances. Run it with `cargo
//! run --example custom_job`.

use spandrel_model::frames::Vec3;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;
use spandrel_model::{scenario, shipped};

/// Builds the site of the job and prints information about it.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A job is a TOML file. scenarios/README.md documents its keys. This job has a different name and no cars or
    // trucks.
    let text = shipped::TWO_BRIDGES.replace("name = \"two-bridges\"", "name = \"quiet-bridges\"");
    let mut job = scenario::read("quiet-bridges.toml", &text, &|file| Err(format!("{file} does not exist")))?;
    job.traffic.cars = 0;
    job.traffic.trucks = 0;

    let site = Site::build(&job, 7);
    println!("{}: {} members, {} defects", job.name, site.members().len(), site.defects().len());
    for defect in site.defects().iter().take(3) {
        let distance_m = (defect.position_m - job.ground_team.pad_m).norm();
        println!("defect {} is {distance_m:.0} m from the pad", defect.id);
    }
    let above_pad_m = job.ground_team.pad_m + Vec3::new(0.0, 0.0, 10.0);
    if let Some(nearest) = site.nearest(above_pad_m, 200.0, SimTime::ZERO) {
        println!(
            "nearest object to a point 10 m above the pad: {}, {:.1} m away",
            site.object_name(nearest.object),
            nearest.distance_m
        );
    }
    Ok(())
}
