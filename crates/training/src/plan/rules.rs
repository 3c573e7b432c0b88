//! Training plan rules and their file format.

use super::measure::{MEASURES, RuleMeasure};
use spandrel_model::scenario::{self, Difficulty, TaskKind};
use spandrel_model::shipped::SCENARIOS;
use spandrel_model::toml::{Problems, Reader, Section};

/// Default rules of the training plan, in TOML.
pub const DEFAULT_RULES: &str = include_str!("rules.toml");

/// Machine-readable scenario name of the lesson.
pub const LESSON: &str = "first-flight";
/// File format version.
const FORMAT_VERSION: i64 = 1;
/// Value of a rule's `scenario` that stands for the drill of the task's kind in `[task_drills]`.
const DRILL_OF_TASK: &str = "drill of the task";
/// Maximum value of `in_tasks`.
const MAX_IN_TASKS: i64 = 20;
/// Maximum value of `mastery_of`.
const MAX_MASTERY_SESSIONS: i64 = 20;
/// Maximum number of levels between two sessions: a scenario has at most 20.
const MAX_LEVEL_STEP: i64 = 19;

const CRASH_OBJECTS: &[(&str, Option<&str>)] = &[
    ("any", None),
    ("bridge", Some("bridge")),
    ("terrain", Some("terrain")),
    ("water", Some("water")),
    ("other", Some("other")),
    ("vehicle", Some("vehicle")),
    ("person", Some("person")),
];

/// A rule of the training plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanRule {
    /// Unique name of the rule.
    pub name: String,
    /// Group that other rules can name in `explains`; empty for none.
    pub group: String,
    /// Measure that is compared with the limit.
    pub measure: RuleMeasure,
    /// Kind of task; `None` for all kinds.
    pub task: Option<&'static str>,
    /// Number of tasks of one session in which the measure must exceed the limit; 1 evaluates each task separately.
    pub in_tasks: usize,
    /// Kind of object hit; `None` for all kinds.
    pub with: Option<&'static str>,
    /// Reason why a missed defect's best picture did not count; empty for any reason.
    pub lacked: String,
    /// Value above which the rule fires.
    pub limit: f64,
    /// Weight relative to other rules.
    pub weight: f64,
    /// Scenario to fly.
    pub scenario: String,
    /// Scenario to fly if `scenario` is not installed; empty for none.
    pub otherwise: String,
    /// Names of the rules, or of groups of rules, whose findings in the same task or session are consequences of this one.
    pub explains: Vec<String>,
    /// Text shown to the trainee, with placeholders for values.
    pub reason: String,
}

impl PlanRule {
    /// Returns whether findings of the other rule are consequences of this one's.
    #[must_use]
    pub fn explains(&self, other: &Self) -> bool {
        self.explains.iter().any(|effect| other.is_named(effect))
    }

    /// Returns whether this is the rule's name or that of its group.
    fn is_named(&self, name: &str) -> bool {
        self.name == name || (!self.group.is_empty() && self.group == name)
    }
}

/// Criterion at which a session of a drill counts toward mastery.
#[derive(Debug, Clone, PartialEq)]
pub struct DrillCriterion {
    /// Machine-readable scenario name, such as `drill-gap`.
    pub scenario: String,
    /// Limits that the session must not exceed, as rules without reasons.
    pub limits: Vec<PlanRule>,
    /// Difficulty levels of the drill; `None` if it has none, or before [`PlanRules::with_levels`].
    pub difficulty: Option<Difficulty>,
}

/// Rule by which a drill's difficulty adapts: a weighted up-down staircase. A trainee's level settles where the criterion is met
/// in a fraction `down` / (`up` + `down`) of the sessions (Kaernbach 1991).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StaircaseRule {
    /// Level of the first session, relative to the standard level.
    pub first: i8,
    /// Number of levels by which the next session is harder after a session that met the criterion.
    pub up: u8,
    /// Number of levels by which the next session is easier after a session that did not.
    pub down: u8,
}

impl StaircaseRule {
    /// Returns the fraction of sessions that meet the criterion at the level where the staircase settles, 0 to 1.
    #[must_use]
    pub fn target(&self) -> f64 {
        f64::from(self.down) / (f64::from(self.up) + f64::from(self.down))
    }
}

/// Rules and parameters of the training plan.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanRules {
    /// Maximum break between sessions, days.
    pub retention_days: f64,
    /// Scenario to fly after a longer break.
    pub retention_scenario: String,
    /// Reason for the retention scenario.
    pub retention_reason: String,
    /// Minimum break between sessions, days.
    pub rest_days: f64,
    /// Scenario to fly if no rule fires.
    pub job: String,
    /// Reason for flying the job.
    pub job_reason: String,
    /// Maximum number of scenarios in a plan.
    pub steps: usize,
    /// Minimum urgency of a scenario as a fraction of the first one's, 0 to 1.
    pub focus: f64,
    /// Number of sessions at the criterion after which a drill is done.
    pub mastery_needed: usize,
    /// Number of the latest sessions of a drill in which these may lie.
    pub mastery_of: usize,
    /// Rule by which difficulty adapts; `None` if it does not adapt.
    pub staircase: Option<StaircaseRule>,
    /// Criteria of the drills.
    pub drills: Vec<DrillCriterion>,
    /// Rules in file order.
    pub rules: Vec<PlanRule>,
}

impl PlanRules {
    /// Returns whether a scenario is the lesson or a drill, not a job.
    #[must_use]
    pub fn is_exercise(&self, scenario: &str) -> bool {
        scenario == LESSON || self.drills.iter().any(|drill| drill.scenario == scenario)
    }

    /// Returns the rules with each scenario that is not installed replaced by the rule's `otherwise`, if it has one.
    #[must_use]
    pub fn for_installed(mut self, is_installed: impl Fn(&str) -> bool) -> Self {
        for rule in &mut self.rules {
            if !rule.otherwise.is_empty() && !is_installed(&rule.scenario) {
                rule.scenario.clone_from(&rule.otherwise);
            }
        }
        self
    }

    /// Returns the rules with the drills' difficulty levels. `levels` returns those of a scenario; if it returns `None`,
    /// the drill's levels stay unchanged.
    #[must_use]
    pub fn with_levels(mut self, levels: impl Fn(&str) -> Option<Difficulty>) -> Self {
        for drill in &mut self.drills {
            drill.difficulty = levels(&drill.scenario).or_else(|| drill.difficulty.take());
        }
        self
    }

    /// Returns the rules with the difficulty levels of the shipped drills.
    #[must_use]
    pub fn with_shipped_levels(self) -> Self {
        self.with_levels(|name| {
            let (_, text) = SCENARIOS.iter().find(|(shipped, _)| *shipped == name)?;
            scenario::read(name, text, &|file| Err(file.to_owned())).ok()?.difficulty
        })
    }
}

/// Reads the rules from TOML.
///
/// # Errors
/// Returns all errors in the file.
pub fn read_rules(file: &str, text: &str) -> Result<PlanRules, Problems> {
    let mut reader = Reader::new(file, text);
    let rules = reader.parse().map(|document| {
        let mut root = reader.root(&document);
        read(&mut reader, &mut root)
    });
    match rules {
        Some(rules) if reader.problems.is_empty() => Ok(rules),
        Some(_) | None => Err(Problems(reader.problems)),
    }
}

fn read(reader: &mut Reader<'_>, root: &mut Section<'_>) -> PlanRules {
    reader.integer(root, "format", (FORMAT_VERSION, FORMAT_VERSION), None);
    let steps = reader.integer(root, "steps", (1, 20), Some(3));
    let mut read: Vec<(Section<'_>, PlanRule)> = Vec::new();
    for mut section in reader.sections(root, "rules") {
        let rule = read_rule(reader, &mut section);
        if read.iter().any(|(_, other)| other.name == rule.name) {
            reader.add_problem(&section, "name", &rule.name, "a unique name", "duplicate rule name");
        }
        reader.finish(&section);
        read.push((section, rule));
    }
    check_causes(reader, &read);
    let task_drills = read_task_drills(reader, root);
    for (section, _) in read.iter().filter(|(_, rule)| rule.scenario == DRILL_OF_TASK && !is_for_each_kind(rule)) {
        let allowed = "a rule on a measure of one task, without `task` and `in_tasks`";
        reader.add_problem(section, "scenario", DRILL_OF_TASK, allowed, "this rule has no task whose drill it could recommend");
    }
    let rules = read.into_iter().flat_map(|(_, rule)| for_each_kind(rule, &task_drills)).collect();
    let drills = read_drills(reader, root);
    let mastery_of = reader.integer(root, "mastery_of", (1, MAX_MASTERY_SESSIONS), Some(3));
    let mastery_needed = reader.integer(root, "mastery_needed", (1, mastery_of), Some(mastery_of.min(2)));
    let rules = PlanRules {
        retention_days: reader.number(root, "retention_days", (1.0, 3650.0), None),
        retention_scenario: reader.text(root, "retention_scenario", None),
        retention_reason: reader.text(root, "retention_reason", None),
        rest_days: reader.number(root, "rest_days", (0.0, 365.0), None),
        job: reader.text(root, "job", None),
        job_reason: reader.text(root, "job_reason", None),
        steps: usize::try_from(steps).unwrap_or(1),
        focus: reader.number(root, "focus", (0.0, 1.0), Some(0.0)),
        mastery_needed: usize::try_from(mastery_needed).unwrap_or(1),
        mastery_of: usize::try_from(mastery_of).unwrap_or(1),
        staircase: read_staircase(reader, root),
        drills,
        rules,
    };
    reader.finish(root);
    rules
}

/// Reads the drill of each kind of task; kinds without one are left out.
fn read_task_drills(reader: &mut Reader<'_>, root: &mut Section<'_>) -> Vec<(&'static str, String)> {
    let mut section = reader.section(root, "task_drills");
    let drills = TaskKind::ALL.iter().map(|kind| (kind.key(), reader.text(&mut section, kind.key(), Some(""))));
    let drills = drills.filter(|(_, drill)| !drill.is_empty()).collect();
    reader.finish(&section);
    drills
}

/// Returns whether a rule can stand for one rule per kind of task.
fn is_for_each_kind(rule: &PlanRule) -> bool {
    matches!(rule.measure, RuleMeasure::Task(_)) && rule.task.is_none() && rule.in_tasks == 1
}

/// Returns one rule per kind of task if the rule recommends the drill of the task, and otherwise the rule.
fn for_each_kind(rule: PlanRule, task_drills: &[(&'static str, String)]) -> Vec<PlanRule> {
    if rule.scenario != DRILL_OF_TASK {
        return vec![rule];
    }
    let of = |(kind, drill): &(&'static str, String)| PlanRule { task: Some(*kind), scenario: drill.clone(), ..rule.clone() };
    task_drills.iter().map(of).collect()
}

/// Returns the kinds of tasks to which a rule can be restricted.
fn task_kinds() -> Vec<(&'static str, Option<&'static str>)> {
    let kinds = TaskKind::ALL.iter().map(|kind| (kind.key(), Some(kind.key())));
    std::iter::once(("any", None)).chain(kinds).collect()
}

fn read_rule(reader: &mut Reader<'_>, section: &mut Section<'_>) -> PlanRule {
    let in_tasks = reader.integer(section, "in_tasks", (1, MAX_IN_TASKS), Some(1));
    let rule = PlanRule {
        name: reader.text(section, "name", None),
        group: reader.text(section, "group", Some("")),
        measure: reader.keyword(section, "measure", MEASURES, None),
        task: reader.keyword(section, "task", &task_kinds(), Some(0)),
        in_tasks: usize::try_from(in_tasks).unwrap_or(1),
        with: reader.keyword(section, "with", CRASH_OBJECTS, Some(0)),
        lacked: reader.text(section, "lacked", Some("")),
        limit: reader.number(section, "limit", (0.001, 1000.0), None),
        weight: reader.number(section, "weight", (0.01, 100.0), Some(1.0)),
        scenario: reader.text(section, "scenario", None),
        otherwise: reader.text(section, "otherwise", Some("")),
        explains: reader.texts(section, "explains"),
        reason: reader.text(section, "reason", None),
    };
    if matches!(rule.measure, RuleMeasure::Session(_)) && rule.in_tasks > 1 {
        reader.add_problem(section, "in_tasks", &rule.in_tasks.to_string(), "1", "this measure applies to the whole session");
    }
    rule
}

/// Reads how difficulty adapts.
fn read_staircase(reader: &mut Reader<'_>, root: &mut Section<'_>) -> Option<StaircaseRule> {
    let mut section = reader.section(root, "difficulty");
    let adapt = reader.boolean(&mut section, "adapt", true);
    let first = reader.integer(&mut section, "first", (-MAX_LEVEL_STEP, MAX_LEVEL_STEP), Some(0));
    let up = reader.integer(&mut section, "up", (1, MAX_LEVEL_STEP), Some(1));
    let down = reader.integer(&mut section, "down", (1, MAX_LEVEL_STEP), Some(2));
    reader.finish(&section);
    let step = |number: i64| u8::try_from(number).unwrap_or(1);
    adapt.then(|| StaircaseRule { first: i8::try_from(first).unwrap_or(0), up: step(up), down: step(down) })
}

/// Reads the drills' criteria.
fn read_drills(reader: &mut Reader<'_>, root: &mut Section<'_>) -> Vec<DrillCriterion> {
    let mut drills: Vec<DrillCriterion> = Vec::new();
    for mut section in reader.sections(root, "drills") {
        let scenario = reader.text(&mut section, "scenario", None);
        let limits = reader.sections(&mut section, "limits").into_iter().map(|limit| read_limit(reader, limit)).collect();
        if drills.iter().any(|other| other.scenario == scenario) {
            reader.add_problem(&section, "scenario", &scenario, "one table per drill", "duplicate drill");
        }
        reader.finish(&section);
        drills.push(DrillCriterion { scenario, limits, difficulty: None });
    }
    drills
}

fn read_limit(reader: &mut Reader<'_>, mut section: Section<'_>) -> PlanRule {
    let rule = PlanRule {
        name: String::new(),
        group: String::new(),
        measure: reader.keyword(&mut section, "measure", MEASURES, None),
        task: None,
        in_tasks: 1,
        with: None,
        lacked: String::new(),
        limit: reader.number(&mut section, "limit", (0.001, 1000.0), None),
        weight: 1.0,
        scenario: String::new(),
        otherwise: String::new(),
        explains: Vec::new(),
        reason: String::new(),
    };
    reader.finish(&section);
    rule
}

/// Checks that every rule or group named in `explains` exists, that no group has the name of a rule, and that no rule explains
/// itself, directly or indirectly.
fn check_causes(reader: &mut Reader<'_>, rules: &[(Section<'_>, PlanRule)]) {
    for (section, rule) in rules {
        if !rule.group.is_empty() && rules.iter().any(|(_, other)| other.name == rule.group) {
            reader.add_problem(section, "group", &rule.group, "a name that no rule has", "group with the name of a rule");
        }
        for effect in rule.explains.iter().filter(|effect| !rules.iter().any(|(_, other)| other.is_named(effect))) {
            let allowed = "names of rules or groups in this file";
            reader.add_problem(section, "explains", effect, allowed, "unknown rule or group");
        }
        if explains_itself(rule, rules) {
            let allowed = "rules that do not explain this one";
            reader.add_problem(section, "explains", &rule.explains.join(", "), allowed, "circular causes");
        }
    }
}

fn explains_itself(rule: &PlanRule, rules: &[(Section<'_>, PlanRule)]) -> bool {
    let mut reached: Vec<&PlanRule> = Vec::new();
    let mut open = vec![rule];
    while let Some(cause) = open.pop() {
        for (_, effect) in rules.iter().filter(|(_, other)| cause.explains(other)) {
            if effect.name == rule.name {
                return true;
            }
            if !reached.iter().any(|seen| seen.name == effect.name) {
                reached.push(effect);
                open.push(effect);
            }
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_shipped_rules_are_valid_and_errors_name_line_and_key() {
        assert!(read_rules("rules.toml", DEFAULT_RULES).unwrap().rules.len() > 20);
        let wrong = DEFAULT_RULES.replacen("measure = \"off_path\"", "measure = \"elegance\"", 1).replacen(
            "limit = 0.1\n",
            "limit = -1\n",
            1,
        );
        let told = read_rules("rules.toml", &wrong).unwrap_err().to_string();
        assert!(told.contains("measure = \"elegance\"") && told.contains("limit = -1"), "{told}");
        let twice = DEFAULT_RULES.replace("name = \"crashes into water\"", "name = \"hit a person\"");
        assert!(read_rules("rules.toml", &twice).unwrap_err().to_string().contains("duplicate rule name"));
    }
    #[test]
    fn exact_causes_must_exist_and_not_be_circular() {
        let unknown = DEFAULT_RULES.replacen("explains = [\n", "explains = [ \"elegance\",\n", 1);
        let told = read_rules("rules.toml", &unknown).unwrap_err().to_string();
        assert!(told.contains("elegance") && told.contains("unknown rule"), "{told}");
        let name = "name = \"off a drill path\"\n";
        assert!(DEFAULT_RULES.contains(name));
        let circular = DEFAULT_RULES.replace(name, &format!("{name}explains = [\"off a drill path\"]\n"));
        assert!(read_rules("rules.toml", &circular).unwrap_err().to_string().contains("circular causes"));
        let session = DEFAULT_RULES.replace("name = \"no pictures\"\n", "name = \"no pictures\"\nin_tasks = 2\n");
        let told = read_rules("rules.toml", &session).unwrap_err().to_string();
        assert!(told.contains("in_tasks = 2") && told.contains("(allowed: 1)"), "{told}");
    }

    /// Returns rules in which one explains `effect`, and another one has this group.
    fn two_rules(effect: &str, group: &str) -> String {
        let (head, _) = DEFAULT_RULES.split_once("[[rules]]").unwrap();
        let rule = |name: &str, more: &str| {
            format!(
                "[[rules]]\nname = \"{name}\"\nmeasure = \"battery_low\"\nlimit = 0.5\nscenario = \"practice\"\nreason = \"x\"\n{more}\n"
            )
        };
        let cause = rule("cause", &format!("explains = [\"{effect}\"]"));
        format!("{head}{cause}{}", rule("effect", &format!("group = \"{group}\"")))
    }

    #[test]
    fn exact_rule_explains_a_group_by_its_name() {
        let read = |text: &str| read_rules("own.toml", text);
        for effect in ["effect", "consequences"] {
            let rules = read(&two_rules(effect, "consequences")).unwrap().rules;
            assert!(rules[0].explains(&rules[1]) && !rules[1].explains(&rules[0]), "{effect}");
        }
        let told = read(&two_rules("others", "consequences")).unwrap_err().to_string();
        assert!(told.contains("unknown rule or group") && told.contains("others"), "{told}");
        let told = read(&two_rules("effect", "cause")).unwrap_err().to_string();
        assert!(told.contains("group with the name of a rule"), "{told}");
        let own_group = two_rules("consequences", "consequences").replace("explains = ", "group = \"consequences\"\nexplains = ");
        assert!(read(&own_group).unwrap_err().to_string().contains("circular causes"));
    }
}
