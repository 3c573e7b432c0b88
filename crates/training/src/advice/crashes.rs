//! Sentences on crashes. Contacts less than a second apart count once.

use super::flight_scan::FlightScan;
use super::wording::{Place, Sentence, listed};
use crate::plan::PlanRule;
use crate::time_text::clock;
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_monitor::score::certification::contacts::MergedCrash;
use spandrel_text::{Language, text};

/// Maximum number of crashes whose times are listed.
const MAX_LISTED: usize = 3;

pub(super) fn in_tasks(scan: &FlightScan<'_>, rule: &PlanRule, ids: &[u32]) -> Option<Sentence> {
    sentence(scan, rule, Place::of(scan, ids), |crash| crash.task.is_some_and(|task| ids.contains(&task)))
}

pub(super) fn outside(scan: &FlightScan<'_>, rule: &PlanRule) -> Option<Sentence> {
    sentence(scan, rule, Place { kind: "between", ..Place::none() }, |crash| crash.task.is_none())
}

pub(super) fn anywhere(scan: &FlightScan<'_>, rule: &PlanRule) -> Option<Sentence> {
    sentence(scan, rule, Place::none(), |_| true)
}

fn sentence(scan: &FlightScan<'_>, rule: &PlanRule, place: Place, counts: impl Fn(&MergedCrash) -> bool) -> Option<Sentence> {
    let all = &scan.evidence.assessed_session.assessment.certification.crashes;
    let is_meant = |crash: &&MergedCrash| rule.with.is_none_or(|with| with == crash.with.label()) && counts(crash);
    let crashes: Vec<&MergedCrash> = all.iter().filter(is_meant).collect();
    let hardest = crashes.iter().copied().reduce(|a, b| if b.speed_m_s > a.speed_m_s { b } else { a })?;
    let words = text!(
        scan.language,
        "advice-crash",
        object = object(&crashes),
        count = crashes.len(),
        place = place.kind,
        tasks = place.tasks,
        when = when(&crashes, hardest, scan.language),
        remedy = remedy(hardest.with)
    );
    Some((words, (hardest.frame as usize).saturating_sub(1)))
}

/// Describes when crashes happened.
fn when(crashes: &[&MergedCrash], hardest: &MergedCrash, language: Language) -> String {
    let times: Vec<String> = crashes.iter().map(|crash| clock(crash.t_s)).collect();
    if times.len() <= MAX_LISTED {
        return text!(language, "advice-crash-times", times = listed(&times, language));
    }
    let (first, hardest_at) = (times.first().cloned().unwrap_or_default(), clock(hardest.t_s));
    let speed = format!("{:.1}", hardest.speed_m_s);
    text!(language, "advice-crash-first-and-hardest", first = first, hardest = hardest_at, speed = speed)
}

/// Names what was hit; `several` if it was not always the same.
fn object(crashes: &[&MergedCrash]) -> &'static str {
    match crashes.split_first() {
        Some((first, rest)) if rest.iter().all(|crash| crash.with == first.with) => first.with.label(),
        Some(_) => "several",
        None => ContactKind::None.label(),
    }
}

/// Names what to do: `distance`, `altitude` or `people`.
fn remedy(with: ContactKind) -> &'static str {
    match with {
        ContactKind::None | ContactKind::Bridge | ContactKind::Other => "distance",
        ContactKind::Terrain | ContactKind::Water => "altitude",
        ContactKind::Vehicle | ContactKind::Person => "people",
    }
}
