//! The form of the scenario editor: which keys it shows, in groups. Meanings and allowed values come from the documentation of the
//! keys ([`key_descriptions`]).

use spandrel_model::key_table::KeyDescription;
use spandrel_model::scenario::values::{KIND_KEYS, ScenarioValues, describe, key_descriptions, without_indices};
use spandrel_model::toml::Problem;

/// Maximum number of pictures, bridges, tasks or events with fields: as many as a job may have. Files with more have a problem
/// anyway.
const MAX_GROUPS: usize = 64;

/// A group of keys: those that most jobs need, and the tables whose other keys are under "More keys". A table name that ends with `*`
/// stands for all tables whose names begin so.
struct Layout {
    id: &'static str,
    /// Location of the repeated table with one group of fields for each table; empty if there is none.
    repeated: &'static str,
    main: &'static [&'static str],
    tables: &'static [&'static str],
}

const LAYOUT: &[Layout] = &[
    Layout { id: "job", repeated: "", main: &["name", "title", "briefing"], tables: &[""] },
    Layout {
        id: "pictures",
        repeated: "briefing_pictures",
        main: &["briefing_pictures[].file", "briefing_pictures[].caption"],
        tables: &[],
    },
    Layout {
        id: "place",
        repeated: "",
        main: &[
            "origin.latitude_deg",
            "origin.longitude_deg",
            "origin.altitude_m",
            "terrain.source",
            "terrain.height_m",
            "terrain.water_level_m",
            "ground_team.pad_m",
            "ground_team.inspector_m",
            "ground_team.places_m",
            "ground_team.truck_m",
        ],
        tables: &["origin", "terrain", "ground_team"],
    },
    Layout {
        id: "bridges",
        repeated: "bridges",
        main: &["bridges[].name", "bridges[].type", "bridges[].centre_m", "bridges[].heading_deg"],
        tables: &["bridges[]", "bridges[].*"],
    },
    Layout {
        id: "tasks",
        repeated: "tasks",
        main: &[
            "tasks[].name",
            "tasks[].kind",
            "tasks[].bridge",
            "tasks[].span_number",
            "tasks[].support_number",
            "tasks[].points_relative_to",
            "tasks[].points_m",
            "tasks[].stand_off_m",
            "tasks[].too_close_m",
        ],
        tables: &["tasks[]"],
    },
    Layout {
        id: "defects",
        repeated: "",
        main: &["defects.count", "defects.placement", "defects.size_factor", "defects.detection_pct", "defects.lines"],
        tables: &["defects"],
    },
    Layout {
        id: "traffic",
        repeated: "",
        main: &["traffic.cars", "traffic.trucks", "traffic.pedestrians", "traffic.car_speed_m_s"],
        tables: &["traffic"],
    },
    Layout {
        id: "drones",
        repeated: "drones",
        main: &["drones[].name", "drones[].vehicle", "drones[].points_m", "drones[].speed_m_s", "drones[].repeat"],
        tables: &["drones[]"],
    },
    Layout {
        id: "ropes",
        repeated: "ropes",
        main: &["ropes[].name", "ropes[].points_m", "ropes[].length_m"],
        tables: &["ropes[]"],
    },
    Layout {
        id: "wind",
        repeated: "",
        main: &["wind.level", "wind.speed_m_s", "wind.from_deg", "wind.turbulence"],
        tables: &["wind"],
    },
    Layout {
        id: "gusts",
        repeated: "wind.events",
        main: &[
            "wind.events[].kind",
            "wind.events[].at_s",
            "wind.events[].from_deg",
            "wind.events[].duration_s",
            "wind.events[].peak_m_s",
            "wind.events[].over_s",
            "wind.events[].speed_m_s",
        ],
        tables: &[],
    },
    Layout {
        id: "light",
        repeated: "",
        main: &["light.start_utc", "light.cloud_cover", "weather.visibility_m", "weather.rain_mm_h", "weather.snow_mm_h"],
        tables: &["light", "weather"],
    },
    Layout {
        id: "rules",
        repeated: "",
        main: &[
            "rules.after_crash",
            "rules.battery",
            "rules.low_battery_return",
            "rules.gnss_shadow",
            "rules.stick_response",
            "hazards.compass",
            "hazards.wakes",
            "hazards.water",
            "rules.battery_temperature_c",
            "hazards.sky",
            "hazards.radio",
            "scoring.speed_limit_mph",
            "scoring.time_best_min",
            "scoring.time_max_min",
        ],
        tables: &["rules", "hazards", "scoring", "feedback", "certification"],
    },
];

/// Returns the documentation of all keys that the form can show.
#[cfg(test)]
pub(super) fn form_keys() -> impl Iterator<Item = &'static KeyDescription> {
    let is_in =
        |layout: &Layout, key: &str| layout.main.contains(&key) || layout.tables.iter().any(|entry| is_table(entry, parent(key)));
    key_descriptions().iter().filter(move |described| LAYOUT.iter().any(|layout| is_in(layout, &described.key)))
}

/// How a field is edited.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Control {
    /// One line of text or a list.
    Line,
    /// A number.
    Number,
    /// Several lines of text.
    Lines,
    /// East, north and up, which can be set on the plan.
    Position,
    /// One of these words.
    Choice(Vec<String>),
}

/// A field of the form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Location of its key, such as `tasks[2].name`.
    pub location: String,
    /// Documentation of the key.
    pub description: &'static KeyDescription,
    /// How it is edited.
    pub control: Control,
    /// Value in the file; empty if the key is missing.
    pub value: String,
}

/// Fields of one table of a repeated table, such as a task.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldGroup {
    /// Location of the table, such as `tasks[2]`.
    pub location: String,
    /// Name of the bridge, the task or the picture's file, or the kind of the event.
    pub name: String,
    /// Fields that most jobs need.
    pub main: Vec<Field>,
    /// All other fields.
    pub more: Vec<Field>,
}

/// A section of the form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FormSection {
    /// Identifier in the page.
    pub id: &'static str,
    /// Location of the repeated table whose tables are the groups, if any.
    pub repeated: Option<&'static str>,
    /// Fields that most jobs need.
    pub main: Vec<Field>,
    /// All other fields.
    pub more: Vec<Field>,
    /// Pictures, bridges, tasks or events.
    pub groups: Vec<FieldGroup>,
}

/// The form for a scenario's text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScenarioForm {
    /// Sections in order.
    pub sections: Vec<FormSection>,
}

impl ScenarioForm {
    /// Creates the form; `None` if the text is not valid TOML.
    #[must_use]
    pub fn read(text: &str) -> Option<Self> {
        let values = ScenarioValues::read(text)?;
        Some(Self { sections: LAYOUT.iter().map(|layout| section(layout, &values)).collect() })
    }

    /// Returns all fields.
    pub fn fields(&self) -> impl Iterator<Item = &Field> {
        self.sections.iter().flat_map(|section| {
            let grouped = section.groups.iter().flat_map(|group| group.main.iter().chain(&group.more));
            section.main.iter().chain(&section.more).chain(grouped)
        })
    }

    /// Returns the element that shows a problem: its field, or the group or section that contains its key.
    #[must_use]
    pub fn element_for(&self, problem: &Problem) -> Option<String> {
        let at = problem.location.as_str();
        if self.fields().any(|field| field.location == at) {
            return Some(element_id(at));
        }
        let inside = |table: &str| at.strip_prefix(table).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']));
        let mut groups = self.sections.iter().flat_map(|section| &section.groups);
        if let Some(group) = groups.find(|group| inside(&group.location)) {
            return Some(element_id(&group.location));
        }
        let of_repeated = self.sections.iter().find(|section| section.repeated.is_some_and(inside));
        let of_table = || LAYOUT.iter().find(|layout| layout.tables.iter().any(|table| !table.is_empty() && inside(table)));
        of_repeated.map(|section| section.id).or_else(|| of_table().map(|layout| layout.id)).map(section_id)
    }
}

/// Returns the ID of the element of a field or group.
#[must_use]
pub fn element_id(location: &str) -> String {
    let name: String = location.chars().filter(|c| *c != ']').map(|c| if c == '[' || c == '.' { '-' } else { c }).collect();
    format!("field-{name}")
}

/// Returns the ID of the element of a section.
#[must_use]
pub fn section_id(id: &str) -> String {
    format!("section-{id}")
}

fn section(layout: &'static Layout, values: &ScenarioValues) -> FormSection {
    let mut section = FormSection { id: layout.id, repeated: None, main: Vec::new(), more: Vec::new(), groups: Vec::new() };
    if layout.repeated.is_empty() {
        (section.main, section.more) = fields(layout, "", values);
    } else {
        section.repeated = Some(layout.repeated);
        section.groups = (0..values.count(layout.repeated).min(MAX_GROUPS)).map(|k| group(layout, k, values)).collect();
    }
    section
}

fn group(layout: &Layout, k: usize, values: &ScenarioValues) -> FieldGroup {
    let location = format!("{}[{k}]", layout.repeated);
    let (main, more) = fields(layout, &location, values);
    let name =
        ["name", "kind", "file"].iter().find_map(|key| values.get(&format!("{location}.{key}"))).unwrap_or_default().to_owned();
    FieldGroup { location, name, main, more }
}

/// Returns the main fields and the other fields. `table` is the location of the repeated table, if any.
fn fields(layout: &Layout, table: &str, values: &ScenarioValues) -> (Vec<Field>, Vec<Field>) {
    let with_index = |key: &str| key.replacen(&format!("{}[]", layout.repeated), table, usize::from(!table.is_empty()));
    let shown = |description: &'static KeyDescription| {
        let location = with_index(&description.key);
        is_used(description, &location, values).then(|| field(description, location, values))
    };
    let main = layout.main.iter().filter_map(|key| shown(describe(key)?)).collect();
    let others = layout.tables.iter().flat_map(|table| {
        key_descriptions()
            .iter()
            .filter(move |described| is_table(table, parent(&described.key)) && !layout.main.contains(&described.key.as_str()))
    });
    (main, others.filter_map(shown).collect())
}

/// Returns whether an entry of [`Layout::tables`] stands for a table.
fn is_table(entry: &str, table: &str) -> bool {
    entry == table || entry.strip_suffix('*').is_some_and(|start| table.starts_with(start))
}

fn parent(location: &str) -> &str {
    location.rsplit_once('.').map_or("", |(table, _)| table)
}

/// Returns whether the table uses the key, as its documentation states, or the file contains it.
fn is_used(description: &KeyDescription, location: &str, values: &ScenarioValues) -> bool {
    if values.get(location).is_some() {
        return true;
    }
    let table = parent(location);
    if let Some((bridge, kind)) = table.rsplit_once("].") {
        return values.get(&format!("{bridge}].type")) == Some(kind);
    }
    let Some(kind) = kind_of(table, values) else { return true };
    let only = words_before(&description.meaning, " only");
    let meaning = description.meaning.to_lowercase();
    let not = words_after(&meaning, "not used by ");
    (only.is_empty() || only.contains(&kind.as_str())) && !not.contains(&kind.as_str())
}

/// Returns the kind of a table, which determines the keys that it uses.
fn kind_of(table: &str, values: &ScenarioValues) -> Option<String> {
    KIND_KEYS.iter().find_map(|key| {
        let location = format!("{table}.{key}");
        let default = &describe(&location)?.documented.default;
        Some(values.get(&location).unwrap_or(default).to_owned())
    })
}

/// Returns the words in backticks at the beginning of a text, up to `end`; none if the text does not begin with one.
fn words_before<'a>(text: &'a str, end: &str) -> Vec<&'a str> {
    let list = text.strip_prefix('`').and_then(|rest| rest.split_once(end)).map_or("", |(list, _)| list);
    let words: Vec<&str> = list.trim_end_matches('`').split('`').step_by(2).collect();
    let is_list = list.split('`').skip(1).step_by(2).all(|between| [" and ", ", ", ""].contains(&between));
    if list.is_empty() || !is_list { Vec::new() } else { words }
}

/// Returns the words in backticks after `start`, up to the end of the clause.
fn words_after<'a>(text: &'a str, start: &str) -> Vec<&'a str> {
    let clause = text.split_once(start).map_or("", |(_, rest)| rest);
    let clause = clause.split(['.', ';']).next().unwrap_or_default();
    clause.split('`').skip(1).step_by(2).collect()
}

fn field(description: &'static KeyDescription, location: String, values: &ScenarioValues) -> Field {
    let value = values.get(&location).unwrap_or_default().to_owned();
    let control = control(description, &location, values);
    Field { location, description, control, value }
}

fn control(description: &KeyDescription, location: &str, values: &ScenarioValues) -> Control {
    let allowed = description.documented.allowed.as_str();
    let words = |list: &str, separator: &str| list.split(separator).map(str::to_owned).collect();
    if without_indices(location) == "tasks[].bridge" {
        let names = (0..values.count("bridges")).filter_map(|k| values.get(&format!("bridges[{k}].name")));
        return Control::Choice(names.map(str::to_owned).collect());
    }
    if allowed == "true or false" {
        Control::Choice(words(allowed, " or "))
    } else if allowed == "list of texts" {
        Control::Lines
    } else if allowed.starts_with("3 numbers") && location.ends_with("_m") {
        Control::Position
    } else if allowed == "text" || allowed.starts_with("list of") || allowed.contains(" numbers, each") {
        Control::Line
    } else if allowed.contains(" to ") {
        Control::Number
    } else {
        Control::Choice(words(allowed, ", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spandrel_model::scenario::edit::{Edit, apply, with_briefing_picture};
    use spandrel_model::scenario::{self, BriefingPicture};
    use spandrel_model::shipped::{PRACTICE, SCENARIOS, TWO_BRIDGES};

    fn form(text: &str) -> ScenarioForm {
        ScenarioForm::read(text).unwrap()
    }

    fn set(location: &str, text: &str) -> Edit {
        Edit::Set { location: location.into(), text: text.into() }
    }

    fn locations(form: &ScenarioForm) -> Vec<&str> {
        form.fields().map(|field| field.location.as_str()).collect()
    }

    #[test]
    fn prop_every_key_of_the_layout_is_documented_and_shown_once() {
        for layout in LAYOUT {
            assert!(layout.main.iter().all(|key| describe(key).is_some()), "{}", layout.id);
        }
        for (name, text) in SCENARIOS {
            let form = form(text);
            let mut ids: Vec<String> = form.fields().map(|field| element_id(&field.location)).collect();
            let count = ids.len();
            ids.sort();
            ids.dedup();
            assert_eq!(ids.len(), count, "{name}");
        }
    }

    #[test]
    fn exact_only_keys_that_the_kind_uses_are_shown() {
        let practice = form(PRACTICE);
        let shown = locations(&practice);
        for location in
            ["terrain.lake_width_m", "tasks[0].bridge", "tasks[0].stand_off_m", "bridges[0].arch.span_m", "wind.level", "seed"]
        {
            assert!(shown.contains(&location), "{location}");
        }
        for location in
            ["terrain.height_m", "terrain.file", "tasks[0].points_m", "tasks[2].stand_off_m", "bridges[0].suspension.sag_m"]
        {
            assert!(!shown.contains(&location), "{location}");
        }
        let free = form(&apply(PRACTICE, &[set("tasks[0].kind", "free"), Edit::Add { location: "wind.events".into() }]).unwrap());
        let shown = locations(&free);
        assert!(shown.contains(&"tasks[0].points_m") && !shown.contains(&"tasks[0].bridge"));
        assert!(shown.contains(&"wind.events[0].peak_m_s") && !shown.contains(&"wind.events[0].over_s"));
    }

    #[test]
    fn exact_problems_belong_to_their_field_group_or_section() {
        let text = TWO_BRIDGES.replace("[traffic]", "[traffic]\nbikes = 3");
        let edits = [set("wind.from_deg", "400"), set("tasks[1].stand_off_m", "1"), set("bridges[1].suspension.sag_m", "x")];
        let text = apply(&text, &edits).unwrap();
        let form = form(&text);
        let problems = scenario::read("job.toml", &text, &|_| Err(String::new())).unwrap_err().0;
        let mut elements: Vec<String> = problems.iter().filter_map(|problem| form.element_for(problem)).collect();
        elements.sort();
        elements.dedup();
        let expected =
            ["field-bridges-1-suspension-sag_m", "field-tasks-1-stand_off_m", "field-wind-from_deg", "section-traffic"];
        assert_eq!(elements, expected);
        let at = |location: &str| form.element_for(&Problem { location: location.into(), ..problems[0].clone() });
        assert_eq!(at("tasks[3]"), Some("field-tasks-3".into()));
        assert_eq!(at("tasks"), Some("section-tasks".into()));
        assert_eq!(at("lesson[0].step"), None);
    }

    #[test]
    fn exact_pictures_of_the_briefing_have_a_group_each() {
        let picture = BriefingPicture { file: "job/gate.png".into(), caption: "The gate".into() };
        let form = form(&with_briefing_picture(PRACTICE, &picture).unwrap());
        let section = form.sections.iter().find(|section| section.id == "pictures").unwrap();
        let [group] = section.groups.as_slice() else { panic!("{section:?}") };
        let values: Vec<&str> = group.main.iter().map(|field| field.value.as_str()).collect();
        assert_eq!((group.name.as_str(), values, group.more.len()), ("job/gate.png", vec!["job/gate.png", "The gate"], 0));
    }

    #[test]
    fn exact_the_number_of_groups_is_limited() {
        let form = form(&"[[tasks]]\nname = \"a\"\n".repeat(1_000));
        assert_eq!(form.sections.iter().map(|section| section.groups.len()).sum::<usize>(), MAX_GROUPS);
    }
}
