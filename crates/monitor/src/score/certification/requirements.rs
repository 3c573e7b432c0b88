//! Pass/fail requirements, each with its limit and the value reached.

use super::contacts::MergedCrash;
use super::inputs::CertificationInputs;
use super::names::{explanation, title};
use crate::score::completion::describe_unfinished_task;
use crate::session::EndReason;
use serde::{Deserialize, Serialize};
use spandrel_mavlink::contract::contact::ContactKind;
use spandrel_model::numbers::{format_limit, format_with_limit};
use spandrel_model::scenario::Scenario;
use spandrel_text::{Language, text};

/// Name of the requirement to land near the ground team.
const LANDED_AT_HOME: &str = "landed_at_home";
/// Name of the requirement to fly without freezes and rewinds.
const PRACTICE_AIDS: &str = "practice_aids";

/// Side of the limit on which a value meets the requirement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LimitKind {
    /// The value must not be below the limit.
    AtLeast,
    /// The value must not exceed the limit.
    AtMost,
}

/// One requirement: its limit, and the value that the session reached.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Requirement {
    /// Machine-readable name.
    pub id: String,
    /// Name in English. [`Self::title`] returns it in the language of a page.
    pub name: String,
    /// Unit symbol of limit and value; empty for counts.
    pub unit: String,
    /// Side of the limit that meets the requirement.
    pub kind: LimitKind,
    /// Limit.
    pub limit: f64,
    /// Value reached; absent if there is no evidence for it.
    pub reached: Option<f64>,
    /// Whether the requirement applies to this job. One that does not apply counts as met.
    pub applies: bool,
    /// Whether the requirement is met.
    pub met: bool,
}

/// The requirements without numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Requirements {
    /// Whether every task is done and the session ended with a landing at home.
    pub session_complete: bool,
    /// Whether every task's path was entered.
    pub all_tasks_attempted: bool,
    /// Whether no person or vehicle was hit.
    pub no_person_or_vehicle_hit: bool,
    /// Whether the drone landed near the ground team.
    pub landed_at_home: bool,
    /// Whether the drone landed with the required battery charge.
    pub battery_reserve: bool,
}

/// Values reached that the requirements limit.
#[derive(Debug, Clone, Copy)]
pub struct Reached<'a> {
    /// Battery charge in the last frame, %.
    pub battery_pct: f64,
    /// Merged contacts.
    pub crashes: &'a [MergedCrash],
    /// Conformity, 0 to 100; `None` without evidence.
    pub conformity: Option<f64>,
    /// Precision, 0 to 100; `None` without evidence.
    pub precision: Option<f64>,
    /// Safety, 0 to 100.
    pub safety: f64,
    /// Accuracy, 0 to 100; `None` if no defect is gradable.
    pub accuracy: Option<f64>,
}

impl Requirement {
    fn new(id: &str, unit: &str, kind: LimitKind, limit: f64, reached: Option<f64>) -> Self {
        let met = reached.is_some_and(|value| match kind {
            LimitKind::AtLeast => value >= limit,
            LimitKind::AtMost => value <= limit,
        });
        let name = title(id, Language::English).unwrap_or_default();
        Self { id: id.into(), name, unit: unit.into(), kind, limit, reached, applies: true, met }
    }

    /// Returns the name; the stored one if the requirement is unknown.
    #[must_use]
    pub fn title(&self, language: Language) -> String {
        title(&self.id, language).unwrap_or_else(|| self.name.clone())
    }

    /// Returns one sentence about how the value is measured; empty if the requirement is unknown.
    #[must_use]
    pub fn explanation(&self, language: Language) -> String {
        explanation(&self.id, language).unwrap_or_default()
    }

    /// Returns the limit as text, such as "at least 20%".
    #[must_use]
    pub fn limit_text(&self, language: Language) -> String {
        if self.is_yes_or_no() {
            return yes_or_no(self.limit, language);
        }
        let limit = self.with_unit(format_limit(self.limit), language);
        match self.kind {
            LimitKind::AtLeast => text!(language, "certification-at-least", limit = limit),
            LimitKind::AtMost => text!(language, "certification-at-most", limit = limit),
        }
    }

    /// Returns the value reached as text, with enough digits to show which side of the limit it is on.
    #[must_use]
    pub fn reached_text(&self, language: Language) -> String {
        match self.reached {
            _ if !self.applies => text!(language, "certification-does-not-apply"),
            Some(value) if self.is_yes_or_no() => yes_or_no(value, language),
            Some(value) => {
                let digits = usize::from(self.unit == "m/s");
                self.with_unit(format_with_limit(value, self.limit, digits), language)
            }
            None => text!(language, "certification-no-evidence"),
        }
    }

    /// Returns whether the value is 1 for yes and 0 for no.
    fn is_yes_or_no(&self) -> bool {
        self.id == LANDED_AT_HOME
    }

    fn with_unit(&self, value: String, language: Language) -> String {
        match self.unit.as_str() {
            "" => value,
            "%" => value + "%",
            "points" => text!(language, "certification-points", value = value),
            unit => format!("{value} {unit}"),
        }
    }
}

fn yes_or_no(value: f64, language: Language) -> String {
    if value > 0.0 { text!(language, "certification-yes") } else { text!(language, "certification-no") }
}

fn is_traffic(with: ContactKind) -> bool {
    matches!(with, ContactKind::Person | ContactKind::Vehicle)
}

/// Evaluates the requirements without numbers.
#[must_use]
pub fn gates(inputs: &CertificationInputs<'_>, battery_pct: f64) -> Requirements {
    let landed = inputs.session.reason == EndReason::Landed;
    Requirements {
        session_complete: inputs.completion.complete,
        all_tasks_attempted: inputs.on_path.windows.iter().all(Option::is_some),
        no_person_or_vehicle_hit: !inputs.crashes.iter().any(|crash| is_traffic(crash.with)),
        landed_at_home: landed,
        battery_reserve: landed && battery_pct >= inputs.scenario.certification.min_battery_pct,
    }
}

/// Evaluates all requirements.
#[must_use]
pub fn requirements(inputs: &CertificationInputs<'_>, reached: &Reached<'_>) -> Vec<Requirement> {
    let params = &inputs.scenario.certification;
    let completion = &inputs.completion;
    let landed = completion.landed_at_home;
    let traffic = inputs.crashes.iter().filter(|crash| is_traffic(crash.with)).count();
    let fastest_m_s = reached.crashes.iter().map(|crash| crash.speed_m_s).fold(0.0, f64::max);
    let (least, most) = (LimitKind::AtLeast, LimitKind::AtMost);
    let points = |id: &str, limit: f64, value: Option<f64>| Requirement::new(id, "points", least, limit, value);
    let battery_pct = landed.then_some(reached.battery_pct);
    let contacts = Some(reached.crashes.len() as f64);
    let accuracy = points("accuracy", params.min_accuracy, reached.accuracy);
    let mut all = vec![
        Requirement::new("tasks_done", "", least, completion.tasks as f64, Some(completion.tasks_done as f64)),
        Requirement::new(LANDED_AT_HOME, "", least, 1.0, Some(f64::from(u8::from(landed)))),
        Requirement::new("person_or_vehicle_hits", "", most, 0.0, Some(traffic as f64)),
        Requirement::new("battery", "%", least, params.min_battery_pct, battery_pct),
        Requirement::new("contacts", "", most, params.max_contacts as f64, contacts),
        Requirement::new("contact_speed", "m/s", most, params.max_contact_speed_m_s, Some(fastest_m_s)),
        points("conformity", params.min_conformity, reached.conformity),
        points("precision", params.min_precision, reached.precision),
        points("safety", params.min_safety, Some(reached.safety)),
    ];
    let applies = reached.accuracy.is_some();
    all.push(Requirement { applies, met: accuracy.met || !applies, ..accuracy });
    let aids = f64::from(inputs.practice_aids.count());
    all.push(Requirement::new(PRACTICE_AIDS, "", most, 0.0, Some(aids)));
    all
}

/// Returns the unmet requirements as English text, each with its limit; [`crate::stored_text`] translates it. Omits the battery
/// reserve if the drone did not land.
#[must_use]
pub fn unmet(inputs: &CertificationInputs<'_>, requirements: &[Requirement]) -> Vec<String> {
    let english = Language::English;
    let open = |id: &str| requirements.iter().find(|requirement| requirement.id == id && !requirement.met);
    let mut unmet = Vec::new();
    // Nothing else matters for a flight that was practice.
    unmet.extend(inputs.practice_aids.words(english).map(|aids| text!(english, "certification-unmet-practice", aids = aids)));
    if open("person_or_vehicle_hits").is_some() {
        unmet.push(text!(english, "certification-unmet-hit"));
    }
    let done_share = inputs.completion.done_share;
    let tasks = inputs.scenario.tasks.iter().zip(inputs.states).zip(inputs.covered);
    unmet.extend(
        tasks.filter_map(|((task, state), covered)| describe_unfinished_task(task.id, *state, covered.share, done_share)),
    );
    if open(LANDED_AT_HOME).is_some() {
        unmet.push(text!(english, "certification-unmet-landing"));
    } else if let Some(battery) = open("battery") {
        let (left, needed) = (battery.reached_text(english), format_limit(battery.limit));
        unmet.push(text!(english, "certification-unmet-battery", battery = left, needed = needed));
    }
    if let Some(contacts) = open("contacts") {
        let (count, limit) = (contacts.reached_text(english), format_limit(contacts.limit));
        // The sentence is stored, and later recognized by its words.
        unmet.push(if count == "1" {
            text!(english, "certification-unmet-one-contact", limit = limit)
        } else {
            text!(english, "certification-unmet-contacts", contacts = count, limit = limit)
        });
    }
    if let Some(speed) = open("contact_speed") {
        let (reached, limit) = (speed.reached_text(english), speed.with_unit(format_limit(speed.limit), english));
        unmet.push(text!(english, "certification-unmet-contact-speed", speed = reached, limit = limit));
    }
    let scores = ["conformity", "precision", "safety", "accuracy"].into_iter().filter_map(open);
    unmet.extend(scores.map(|score| match score.reached {
        Some(value) => {
            let (value, needed) = (format_with_limit(value, score.limit, 0), format_limit(score.limit));
            text!(english, "certification-unmet-score", score = score.id.as_str(), value = value, needed = needed)
        }
        None => text!(english, "certification-unmet-no-evidence", score = score.id.as_str()),
    }));
    unmet
}

/// Returns the requirements of a scenario as text, one per line, for people who prepare jobs. Without defects, those for accuracy and
/// pictures don't apply.
#[must_use]
pub fn describe(scenario: &Scenario, language: Language) -> Vec<String> {
    let params = &scenario.certification;
    let limit = format_limit;
    let share = limit(100.0 * scenario.scoring.task_completion_fraction);
    let speed = limit(params.max_contact_speed_m_s);
    let mut lines = vec![
        text!(language, "certification-job-tasks", share = share),
        text!(language, "certification-job-landing", battery = limit(params.min_battery_pct)),
        text!(language, "certification-job-aids"),
        text!(language, "certification-job-contacts", contacts = params.max_contacts, speed = speed),
    ];
    let [conformity, precision, safety] = [params.min_conformity, params.min_precision, params.min_safety].map(limit);
    if scenario.defects.number() == 0 {
        lines.push(text!(
            language,
            "certification-job-scores-without-defects",
            conformity = conformity,
            precision = precision,
            safety = safety
        ));
        return lines;
    }
    lines.push(text!(
        language,
        "certification-job-scores",
        conformity = conformity,
        precision = precision,
        safety = safety,
        accuracy = limit(params.min_accuracy)
    ));
    lines.push(text!(
        language,
        "certification-job-pictures",
        resolution = limit(params.max_gsd_mm),
        width = limit(params.gsd_per_line_width),
        blur = limit(params.max_smear_px),
        incidence = limit(params.max_incidence_deg)
    ));
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_limits_and_values_read_as_text() {
        let english = Language::English;
        let texts =
            |requirement: Requirement| (requirement.limit_text(english), requirement.reached_text(english), requirement.met);
        let landed = |value| Requirement::new(LANDED_AT_HOME, "", LimitKind::AtLeast, 1.0, Some(value));
        assert_eq!(texts(landed(1.0)), ("yes".into(), "yes".into(), true));
        assert_eq!(texts(landed(0.0)), ("yes".into(), "no".into(), false));
        let contacts = Requirement::new("contacts", "", LimitKind::AtMost, 2.0, Some(3.0));
        assert_eq!(texts(contacts), ("at most 2".into(), "3".into(), false));
        let precision = Requirement::new("precision", "points", LimitKind::AtLeast, 45.0, None);
        assert_eq!(texts(precision), ("at least 45 points".into(), "no evidence".into(), false));
    }

    #[test]
    fn exact_requirements_are_in_the_language_of_the_page() {
        let contacts = Requirement::new("contacts", "", LimitKind::AtMost, 2.0, Some(3.0));
        assert_eq!((contacts.name.as_str(), contacts.title(Language::German)), ("contacts", "Berührungen".to_owned()));
        let precision = Requirement::new("precision", "points", LimitKind::AtLeast, 45.0, Some(44.0));
        assert_eq!(precision.limit_text(Language::German), "mindestens 45 Punkte");
        assert_eq!(precision.reached_text(Language::Spanish), "44 puntos");
        let other = Requirement { id: "elegance".into(), ..precision.clone() };
        assert_eq!(other.title(Language::German), precision.name, "the stored name of an unknown requirement");
        assert_eq!(other.explanation(Language::German), "");
        assert!(precision.explanation(Language::German).starts_with("Wie klein "));
        for shown in [precision.title(Language::Pseudo), precision.limit_text(Language::Pseudo)] {
            assert!(!shown.contains(['a', 'e', 'i', 'o', 'u']), "{shown}");
        }
    }
}
