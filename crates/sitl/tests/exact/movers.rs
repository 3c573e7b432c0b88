//! Maximum speed of traffic compared with the bound that the contact look-ahead relies on.

use spandrel_model::scenario::Scenario;
use spandrel_model::site::traffic::TrafficPlan;
use spandrel_model::time::SimTime;
use spandrel_sitl::physics::MAX_OBJECT_SPEED_M_S;

/// Returns the TASBID job with the fastest cars that a scenario file allows.
fn fastest_legal() -> Scenario {
    let text = spandrel_model::shipped::TWO_BRIDGES;
    let with = |speed: &str| {
        let text = text.replacen("car_speed_m_s = 13.4", &format!("car_speed_m_s = {speed}"), 1);
        spandrel_model::scenario::read("fast.toml", &text, &|_| Err("none".into()))
    };
    let refused = with("1e6").unwrap_err().to_string();
    let most = refused.split(" to ").nth(1).and_then(|rest| rest.split(')').next()).unwrap_or_else(|| panic!("{refused}"));
    with(&format!("{:.1}", most.parse::<f64>().unwrap())).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn prop_traffic_stays_below_the_maximum_object_speed() {
    let scenario = fastest_legal();
    let lanes: Vec<_> = scenario.bridges.iter().enumerate().flat_map(|(k, bridge)| bridge.lanes(k)).collect();
    let mut fastest: f64 = 0.0;
    for seed in 0..200 {
        let plan = TrafficPlan::new(&lanes, &scenario.traffic, &scenario.ground_team, seed);
        let times = (0..20).map(SimTime::from_ms).map(|t| SimTime::from_ns(500 * t.ns()));
        for (mover, at) in times.flat_map(|at| plan.movers().iter().map(move |mover| (mover, at))) {
            fastest = plan.placement(mover, at).map_or(0.0, |placed| placed.velocity_m_s.norm()).max(fastest);
        }
    }
    assert!(fastest > scenario.traffic.car_speed_m_s, "{fastest} m/s: at least one lane must be faster than the mean");
    assert!(fastest <= MAX_OBJECT_SPEED_M_S, "{fastest} m/s exceeds the bound of {MAX_OBJECT_SPEED_M_S} m/s");
}
