//! Things to do better after a flight: at most three sentences, each with a number and a moment. They are the causes that the
//! training plan lists, in the plan's order; this module only finds the moments and the words.

mod camera;
mod crashes;
mod flight_scan;
mod pictures;
mod session_end;
mod technique;
mod wording;

pub use flight_scan::{FlightEvidence, MissedDefect};

use crate::plan::{PlanReason, PlanRule, PlanRules, PlanStep, RuleMeasure, SessionMeasure, TaskMeasure};
use crate::record::{SessionOutcome, SessionRecord};
use flight_scan::FlightScan;
use serde::{Deserialize, Serialize};
use spandrel_monitor::stored_text::translated;
use spandrel_text::{Language, text};
use std::collections::BTreeMap;
use wording::Sentence;

/// Maximum number of things to do better: more are not remembered in the next flight.
pub const MAX_POINTS: usize = 3;

/// Advice after a session, and the recommended next flight. The sentences are in English, so that files do not depend on the
/// language; [`SessionAdvice::in_language`] returns them in another one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SessionAdvice {
    /// At most [`MAX_POINTS`] things to do better, in the plan's order.
    pub points: Vec<AdvicePoint>,
    /// Sentence to show if there are no points, in English.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// The note in other languages, by language tag.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub note_translations: BTreeMap<String, String>,
    /// Scenario to fly next; `None` if the rules are invalid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub next: Option<NextFlight>,
}

/// One thing to do better.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AdvicePoint {
    /// Sentence shown to the trainee, in English.
    pub words: String,
    /// The sentence in other languages, by language tag.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub translations: BTreeMap<String, String>,
    /// Name of the plan's rule that fired.
    pub rule: String,
    /// Number of the frame that shows it best, from 1.
    pub frame: u32,
    /// Time of that frame since lift-off, s.
    pub t_s: f64,
    /// Scenario that trains it.
    pub drill: String,
}

/// The scenario to fly next.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct NextFlight {
    /// Machine-readable scenario name, such as `drill-gap`.
    pub scenario: String,
    /// Command that flies it.
    pub command: String,
}

impl SessionAdvice {
    /// Returns the sentences to show, at least one for a session with advice.
    pub fn sentences(&self) -> impl Iterator<Item = &str> {
        self.points.iter().map(|point| point.words.as_str()).chain(self.note.as_deref())
    }

    /// Returns the advice with its sentences in a language. A sentence without a translation stays in English.
    #[must_use]
    pub fn in_language(&self, language: Language) -> Self {
        let mut advice = self.clone();
        for point in &mut advice.points {
            translate(&mut point.words, &point.translations, language);
        }
        if let Some(note) = &mut advice.note {
            translate(note, &advice.note_translations, language);
        }
        advice
    }
}

/// Replaces a sentence by its translation, if there is one.
fn translate(words: &mut String, translations: &BTreeMap<String, String>, language: Language) {
    if let Some(translated) = translations.get(language.tag()) {
        words.clone_from(translated);
    }
}

/// Returns the languages into which advice is translated: all except English.
pub fn translation_languages() -> impl Iterator<Item = Language> + Clone {
    Language::ALL.into_iter().filter(|language| *language != Language::English)
}

/// Returns a sentence in other languages, by language tag.
fn translations(
    languages: impl Iterator<Item = Language>,
    mut words: impl FnMut(Language) -> String,
) -> BTreeMap<String, String> {
    languages.map(|language| (language.tag().to_owned(), words(language))).collect()
}

/// Scenario to fly after a lesson.
const FIRST_DRILL: &str = "drill-hover";

/// Returns the advice after a lesson: what counts is that every step was done, not the scores.
#[must_use]
pub fn lesson_advice(trainee: &str) -> SessionAdvice {
    let note = |language| text!(language, "advice-lesson");
    SessionAdvice {
        points: Vec::new(),
        note: Some(note(Language::English)),
        note_translations: translations(translation_languages(), note),
        next: Some(NextFlight {
            scenario: FIRST_DRILL.to_owned(),
            command: format!("spandrel train --trainee {trainee} --scenario {FIRST_DRILL}"),
        }),
    }
}

/// A cause in the plan, with all tasks in which the same measure is above its limit.
struct Cause<'a> {
    step: usize,
    reason: &'a PlanReason,
    rule: &'a PlanRule,
    tasks: Vec<u32>,
}

/// Returns the advice after a session, with translations into the given languages. `plan` returns the plan for this session alone
/// in a language; except for the words, it is the same in all languages.
#[must_use]
pub fn session_advice(
    plan: impl Fn(Language) -> Vec<PlanStep>,
    rules: &PlanRules,
    evidence: &FlightEvidence<'_>,
    languages: impl Iterator<Item = Language> + Clone,
) -> SessionAdvice {
    let steps = plan(Language::English);
    let translated: Vec<TranslatedPlan> =
        languages.clone().map(|language| TranslatedPlan { language, steps: plan(language) }).collect();
    let mut scan = FlightScan::new(evidence);
    let causes = chosen(causes(&steps, rules));
    let points: Vec<AdvicePoint> = causes.iter().map(|cause| point(cause, &steps, &translated, &mut scan)).collect();
    let next =
        steps.first().map(|step| NextFlight { scenario: step.scenario.clone(), command: step.command(&evidence.record.trainee) });
    let mut note = |language| {
        scan.language = language;
        let missed = pictures::missed(&scan, "all", |_| true);
        no_findings(evidence.record, missed.map(|(words, _)| words), language)
    };
    SessionAdvice {
        note: points.is_empty().then(|| note(Language::English)),
        note_translations: if points.is_empty() { translations(languages, note) } else { BTreeMap::new() },
        points,
        next,
    }
}

/// The plan's steps in another language.
struct TranslatedPlan {
    language: Language,
    steps: Vec<PlanStep>,
}

/// Returns the plan's causes in its order. Causes with the same measure are one: they are the same habit in several tasks.
fn causes<'a>(steps: &'a [PlanStep], rules: &'a PlanRules) -> Vec<Cause<'a>> {
    let mut causes: Vec<Cause<'a>> = Vec::new();
    let reasons = steps.iter().enumerate().flat_map(|(step, one)| one.reasons.iter().map(move |reason| (step, reason)));
    for (step, reason) in reasons.filter(|(_, reason)| reason.consequence_of.is_none()) {
        let Some(rule) = rules.rules.iter().find(|rule| rule.name == reason.rule) else { continue };
        let same = |known: &&mut Cause<'a>| {
            (known.rule.measure, known.rule.with, &known.rule.lacked) == (rule.measure, rule.with, &rule.lacked)
        };
        match causes.iter_mut().find(same) {
            Some(known) => {
                known.tasks.extend(reason.tasks.iter().filter(|task| !known.tasks.contains(task)).copied().collect::<Vec<_>>());
                known.tasks.sort_unstable();
            }
            None => causes.push(Cause { step, reason, rule, tasks: reason.tasks.clone() }),
        }
    }
    causes
}

/// Selects the most urgent cause of each step of the plan, then the next ones, and returns them in the plan's order.
fn chosen(causes: Vec<Cause<'_>>) -> Vec<Cause<'_>> {
    let is_first = |k: &usize| causes[..*k].iter().all(|earlier| earlier.step != causes[*k].step);
    let (mut picks, rest): (Vec<usize>, Vec<usize>) = (0..causes.len()).partition(is_first);
    picks.extend(rest);
    picks.truncate(MAX_POINTS);
    causes.into_iter().enumerate().filter(|(k, _)| picks.contains(k)).map(|(_, cause)| cause).collect()
}

fn point(cause: &Cause<'_>, steps: &[PlanStep], translated: &[TranslatedPlan], scan: &mut FlightScan<'_>) -> AdvicePoint {
    let (words, frame) = sentence_or_reason(cause, steps, Language::English, scan);
    let words_in = |plan: &TranslatedPlan| {
        let (words, _) = sentence_or_reason(cause, &plan.steps, plan.language, scan);
        (plan.language.tag().to_owned(), words)
    };
    AdvicePoint {
        words,
        translations: translated.iter().map(words_in).collect(),
        rule: cause.rule.name.clone(),
        frame: u32::try_from(frame + 1).unwrap_or(u32::MAX),
        t_s: scan.t_s(frame),
        drill: steps.get(cause.step).map_or_else(String::new, |step| step.scenario.clone()),
    }
}

/// Returns the sentence for a cause in a language; the plan's reason in this language and the last frame if the flight's frames do
/// not show it.
fn sentence_or_reason(cause: &Cause<'_>, steps: &[PlanStep], language: Language, scan: &mut FlightScan<'_>) -> Sentence {
    scan.language = language;
    sentence(cause, scan).unwrap_or_else(|| (reason_words(cause, steps), scan.last_frame()))
}

/// Returns a cause's reason in the language of a plan.
fn reason_words(cause: &Cause<'_>, steps: &[PlanStep]) -> String {
    let reasons = steps.get(cause.step).map_or(&[][..], |step| &step.reasons);
    let wanted = (&cause.reason.rule, &cause.reason.tasks);
    let same = reasons.iter().find(|reason| (&reason.rule, &reason.tasks) == wanted);
    same.unwrap_or(cause.reason).words.clone()
}

/// Returns the sentence for a cause; `None` if the flight's frames do not show it.
fn sentence(cause: &Cause<'_>, scan: &FlightScan<'_>) -> Option<Sentence> {
    let (rule, tasks) = (cause.rule, cause.tasks.as_slice());
    match rule.measure {
        RuleMeasure::Task(measure) => task_sentence(measure, rule, tasks, scan),
        RuleMeasure::Session(measure) => session_sentence(measure, rule, scan),
    }
}

fn task_sentence(measure: TaskMeasure, rule: &PlanRule, tasks: &[u32], scan: &FlightScan<'_>) -> Option<Sentence> {
    match measure {
        TaskMeasure::OffPath => technique::off_path(scan, tasks),
        TaskMeasure::OffHeight => technique::off_height(scan, tasks),
        TaskMeasure::Speeding => technique::speeding(scan, tasks),
        TaskMeasure::Crashes => crashes::in_tasks(scan, rule, tasks),
        TaskMeasure::NotAttempted => session_end::not_attempted(scan, tasks),
        TaskMeasure::NotCovered => session_end::not_covered(scan, tasks),
        TaskMeasure::BesidePath => technique::beside_path(scan, tasks),
        TaskMeasure::TooFar => technique::stand_off(scan, tasks, rule.limit, 1.0),
        TaskMeasure::TooClose => technique::stand_off(scan, tasks, rule.limit, -1.0),
        TaskMeasure::UnevenStandOff => technique::uneven_stand_off(scan, tasks),
        TaskMeasure::TooLow => technique::height(scan, tasks, rule.limit, -1.0),
        TaskMeasure::TooHigh => technique::height(scan, tasks, rule.limit, 1.0),
        TaskMeasure::UnevenHeight => technique::uneven_height(scan, tasks),
        TaskMeasure::LowClearance => technique::low_clearance(scan, tasks),
        TaskMeasure::Framing => camera::framing(scan, tasks),
        TaskMeasure::LampOff => camera::lamp_off(scan, tasks),
        TaskMeasure::StickReversals => technique::reversals(scan, tasks, &[0, 1, 2]),
        TaskMeasure::YawReversals => technique::reversals(scan, tasks, &[3]),
        TaskMeasure::StickJumps => technique::jumps(scan, tasks),
        TaskMeasure::UnlitPictures => pictures::unlit(scan, tasks),
        TaskMeasure::MissedAtTask => pictures::none_found(scan, tasks),
    }
}

fn session_sentence(measure: SessionMeasure, rule: &PlanRule, scan: &FlightScan<'_>) -> Option<Sentence> {
    match measure {
        SessionMeasure::CrashesOutside => crashes::outside(scan, rule),
        SessionMeasure::CrashesAll => crashes::anywhere(scan, rule),
        SessionMeasure::Missed if !rule.lacked.is_empty() => pictures::failed(scan, &rule.lacked),
        SessionMeasure::Missed => pictures::missed(scan, "all", |_| true),
        SessionMeasure::MissedSevere => pictures::missed(scan, "severe", pictures::is_severe),
        SessionMeasure::MissedInView => pictures::missed_in_view(scan),
        SessionMeasure::MissedHidden => pictures::missed(scan, "hidden", |defect| defect.hidden),
        SessionMeasure::MissedLines => pictures::missed(scan, "cracks", |defect| defect.line),
        SessionMeasure::PoorPictures => pictures::poor(scan, &rule.lacked),
        SessionMeasure::NoPictures => pictures::none_taken(scan),
        SessionMeasure::FalseSnapshots => pictures::without_defect(scan),
        SessionMeasure::MovingPictures => pictures::in_motion(scan),
        SessionMeasure::DriftingPictures => pictures::while_drifting(scan),
        SessionMeasure::Overtime => session_end::overtime(scan),
        SessionMeasure::TurningPictures => pictures::while_turning(scan),
        SessionMeasure::Landing => session_end::landing(scan),
        SessionMeasure::Slow => session_end::slow(scan),
        SessionMeasure::NotLanded => session_end::not_landed(scan),
        SessionMeasure::BatteryLow => session_end::battery_low(scan),
        SessionMeasure::BatteryFailed => session_end::battery_failed(scan),
        SessionMeasure::Exposure => technique::exposure(scan),
    }
}

/// Returns the note on a flight without findings, and the best chance to find one more defect if it missed some. It praises only a
/// flight that did the job.
fn no_findings(record: &SessionRecord, missed: Option<String>, language: Language) -> String {
    let verdict = match (record.is_complete(), record.unmet.first()) {
        (true, _) if record.certified && missed.is_none() => return text!(language, "advice-nothing-to-correct"),
        (true, _) if record.certified => text!(language, "advice-certified"),
        (true, Some(unmet)) => text!(language, "advice-not-certified", unmet = translated(unmet, language)),
        (true, None) => text!(language, "advice-fly-again"),
        (false, _) => text!(language, "advice-not-finished"),
    };
    match missed {
        Some(missed) => format!("{verdict} {missed}"),
        None => verdict,
    }
}

#[cfg(test)]
mod tests;
