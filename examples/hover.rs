//! Takes off, hovers in gusts for ten seconds, prints the largest position error, and lands. Run it with `cargo run
//! --example hover`.

use spandrel_model::shipped;
use spandrel_model::time::SimTime;
use spandrel_sitl::testing::Vehicle;

const HOVER_HEIGHT_M: f64 = 5.0;
const TIME_LIMIT: SimTime = SimTime::from_ms(30_000);

/// Runs one flight and prints the results.
pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut vehicle = Vehicle::builder().scenario(shipped::DRILL_HOVER).vehicle(shipped::M30).seed(7).build()?;
    vehicle.arm(TIME_LIMIT)?;
    vehicle.take_off(HOVER_HEIGHT_M)?;
    vehicle.run_until(|v| (v.height_m() - HOVER_HEIGHT_M).abs() < 0.3, TIME_LIMIT)?;
    vehicle.run(SimTime::from_ms(3_000));
    let start_m = vehicle.position_m();
    let mut max_error_m: f64 = 0.0;
    for _ in 0..100 {
        vehicle.run(SimTime::from_ms(100));
        max_error_m = max_error_m.max((vehicle.position_m() - start_m).norm());
    }
    println!("largest position error in ten seconds: {max_error_m:.2} m");
    vehicle.land()?;
    vehicle.run_until(|v| !v.armed(), TIME_LIMIT)?;
    println!("landed after {:.1} s", vehicle.now().s());
    Ok(())
}
