//! The command that sends the inspector to another place of the site. The simulation starts the walk with the next tick.

use super::super::equipment::Payload;
use super::super::input::PayloadInput;
use super::handler::ACCEPTED;
use crate::endpoint::refused_request::RefusedRequest;
use crate::endpoint::vehicle_command::VehicleCommand;
use spandrel_mavlink::contract::walk::WalkRequest;
use spandrel_mavlink::dialect::MavResult;
use spandrel_model::site::Site;
use spandrel_model::time::SimTime;

/// Handles the command; `None` for other commands and for mission items.
pub(crate) fn handle(c: &VehicleCommand, input: &PayloadInput, payload: &mut Payload) -> Option<MavResult> {
    if c.own {
        return None;
    }
    let request = WalkRequest::of(c.number, c.p[0])?.map_err(|text| denied(text.to_owned()));
    Some(match request.and_then(|request| admit(request.place, input.site, input.clock.now)) {
        Ok(place) => {
            payload.request_walk(place);
            ACCEPTED
        }
        Err(refusal) => {
            refusal.text.iter().for_each(|text| payload.changes.add_warning(text));
            refusal.result
        }
    })
}

fn denied(text: String) -> RefusedRequest {
    RefusedRequest { result: MavResult::MAV_RESULT_DENIED, text: Some(text) }
}

/// Returns the place if the inspector can walk there now, or is there already.
fn admit(place: u8, site: &Site, now: SimTime) -> Result<u8, RefusedRequest> {
    let inspector = site.inspector();
    let Some(place_m) = inspector.place_m(place) else { return Err(denied(missing_place(place, inspector.place_count()))) };
    let Some(walk) = inspector.walk_to(place, now) else { return Ok(place) };
    if walk.code().is_none() {
        return Err(denied("Walk: too late in this simulation".to_owned()));
    }
    if !inspector.may_turn(now) {
        let text = Some("Walk: too many turns; wait for the arrival".to_owned());
        return Err(RefusedRequest { result: MavResult::MAV_RESULT_TEMPORARILY_REJECTED, text });
    }
    match site.way_obstacle(inspector.at(walk.at).feet_m, place_m) {
        Some((obstacle, _)) => Err(denied(format!("Way to place {place} blocked by {}", obstacle.name()))),
        None => Ok(place),
    }
}

fn missing_place(place: u8, count: u8) -> String {
    if count == 1 { "Walk: this job has only place 1".to_owned() } else { format!("No place {place} (allowed: 1 to {count})") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::frames::Vec3;
    use spandrel_model::scenario::{self, Scenario};
    use spandrel_model::shipped::TWO_BRIDGES;
    use spandrel_model::site::changes::SiteChanges;
    use spandrel_model::site::inspector_walks::{InspectorWalks, MAX_TURNS, Walk};

    fn job() -> Scenario {
        scenario::read("job.toml", TWO_BRIDGES, &|file| Err(file.to_owned())).unwrap()
    }

    fn refusal(site: &Site, place: u8, now: SimTime) -> (MavResult, String) {
        let refusal = admit(place, site, now).expect_err("refused");
        let text = refusal.text.expect("a text");
        // A longer text would need several STATUSTEXT messages.
        assert!(text.len() <= 50, "{text}");
        (refusal.result, text)
    }

    #[test]
    fn exact_each_reason_refuses_with_a_short_text() {
        let mut job = job();
        let here_m = job.ground_team.inspector_m;
        // The line to the second place crosses the landing pad, and the third place is in the lake.
        job.ground_team.places_m =
            vec![job.ground_team.pad_m * 2.0 - here_m, Vec3::new(0.0, 78.0, 0.0), here_m - Vec3::new(3.0, 4.0, 0.0)];
        let site = Site::without_defects(&job);
        let now = SimTime::from_ms(5_000);
        let denied = MavResult::MAV_RESULT_DENIED;
        assert_eq!(refusal(&site, 5, now), (denied, "No place 5 (allowed: 1 to 4)".to_owned()));
        assert_eq!(refusal(&site, 2, now), (denied, "Way to place 2 blocked by the landing pad".to_owned()));
        assert_eq!(refusal(&site, 3, now).0, denied);
        assert_eq!(refusal(&site, 4, SimTime::from_s(215_000.0)), (denied, "Walk: too late in this simulation".to_owned()));
        assert_eq!((admit(4, &site, now), admit(1, &site, now)), (Ok(4), Ok(1)));
        job.ground_team.places_m.clear();
        let alone = Site::without_defects(&job);
        assert_eq!(usize::from(spandrel_mavlink::contract::walk::MAX_PLACE), scenario::places::MAX_PLACES);
        assert_eq!(refusal(&alone, 2, now), (denied, "Walk: this job has only place 1".to_owned()));
    }

    #[test]
    fn exact_walks_without_an_arrival_are_limited() {
        let mut job = job();
        job.ground_team.places_m = vec![job.ground_team.inspector_m - Vec3::new(6.0, 8.0, 0.0)];
        let mut site = Site::without_defects(&job);
        let mut walks = InspectorWalks::default();
        // 0.3 s toward place 2, then 0.1 s back, so that no walk ends.
        let sent = |k: i64| (if k % 2 == 0 { 2 } else { 1 }, SimTime::from_ms(1_000 + 200 * k + 100 * (k % 2)));
        for (place, now) in (0..MAX_TURNS as i64).map(sent) {
            assert_eq!(admit(place, &site, now), Ok(place), "{now}");
            walks.apply_code(site.inspector().walk_to(place, now).and_then(Walk::code).unwrap());
            site = site.with_changes(SiteChanges { walks: walks.clone(), ..SiteChanges::default() });
        }
        let (place, now) = sent(MAX_TURNS as i64);
        assert_eq!(refusal(&site, place, now).0, MavResult::MAV_RESULT_TEMPORARILY_REJECTED);
        assert_eq!(admit(place, &site, SimTime::from_ms(60_000)), Ok(place), "after the arrival");
    }
}
