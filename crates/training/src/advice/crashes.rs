//! Sentences on crashes. Contacts less than a second apart count once.

use super::flight_scan::FlightScan;
use super::wording::{self, Sentence, listed, times};
use crate::plan::PlanRule;
use crate::time_text::clock;
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_monitor::score::certification::contacts::MergedCrash;

/// Maximum number of crashes whose times are listed.
const MAX_LISTED: usize = 3;

pub(super) fn in_tasks(scan: &FlightScan<'_>, rule: &PlanRule, ids: &[u32]) -> Option<Sentence> {
    sentence(scan, rule, &wording::in_tasks(scan, ids), |crash| crash.task.is_some_and(|task| ids.contains(&task)))
}

pub(super) fn outside(scan: &FlightScan<'_>, rule: &PlanRule) -> Option<Sentence> {
    sentence(scan, rule, " between the tasks", |crash| crash.task.is_none())
}

pub(super) fn anywhere(scan: &FlightScan<'_>, rule: &PlanRule) -> Option<Sentence> {
    sentence(scan, rule, "", |_| true)
}

fn sentence(scan: &FlightScan<'_>, rule: &PlanRule, place: &str, counts: impl Fn(&MergedCrash) -> bool) -> Option<Sentence> {
    let all = &scan.evidence.assessed_session.assessment.certification.crashes;
    let is_meant = |crash: &&MergedCrash| rule.with.is_none_or(|with| with == crash.with.label()) && counts(crash);
    let crashes: Vec<&MergedCrash> = all.iter().filter(is_meant).collect();
    let hardest = crashes.iter().copied().reduce(|a, b| if b.speed_m_s > a.speed_m_s { b } else { a })?;
    let first = crashes.first()?;
    let (object, count, speed) = (object(&crashes), times(crashes.len()), hardest.speed_m_s);
    let when = if crashes.len() <= MAX_LISTED {
        format!("at {}", listed(&crashes.iter().map(|crash| clock(crash.t_s)).collect::<Vec<_>>()))
    } else {
        format!("first at {}, hardest at {} ({speed:.1} m/s)", clock(first.t_s), clock(hardest.t_s))
    };
    let frame = (hardest.frame as usize).saturating_sub(1);
    Some((format!("You hit {object} {count}{place}, {when}: {}.", remedy(hardest.with)), frame))
}

/// Names what was hit; "obstacles" if it was not always the same.
fn object(crashes: &[&MergedCrash]) -> &'static str {
    let Some(first) = crashes.first() else { return "nothing" };
    if crashes.iter().any(|crash| crash.with != first.with) {
        return "obstacles";
    }
    match first.with {
        ContactKind::None => "nothing",
        ContactKind::Bridge => "the bridge",
        ContactKind::Terrain => "the ground",
        ContactKind::Water => "the water",
        ContactKind::Vehicle => "a vehicle",
        ContactKind::Person => "a person",
        ContactKind::Other => "an obstacle",
    }
}

fn remedy(with: ContactKind) -> &'static str {
    match with {
        ContactKind::None | ContactKind::Bridge | ContactKind::Other => "keep your distance",
        ContactKind::Terrain | ContactKind::Water => "hold your altitude",
        ContactKind::Vehicle | ContactKind::Person => "stay clear of people and traffic",
    }
}
