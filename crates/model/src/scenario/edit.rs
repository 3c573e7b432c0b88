//! Edits the text of a scenario and keeps its comments, its order and the spelling of all other values.

use super::briefing_pictures::{self, BriefingPicture};
use super::job::PlacedDefect;
use super::resolve::{MAX_DEFECT_ID, NONE_PLACED, PLACED, defect_entries};
use super::toml_text::{shown, typed};
use super::values::{KIND_KEYS, ScenarioValues, describe};
use std::collections::BTreeSet;
use toml_edit::{Array, ArrayOfTables, DocumentMut, InlineTable, Item, Table, TableLike, Value, value};

/// Table of the defects.
const DEFECTS: &str = "defects";
/// Key of a bridge's type, which determines which table with dimensions the bridge has.
const BRIDGE_TYPE_KEY: &str = "type";
/// Height of a new drone above the landing pad, m.
const NEW_DRONE_HEIGHT_M: f64 = 60.0;
/// Length of the path of a new drone, m to the east.
const NEW_DRONE_PATH_M: f64 = 40.0;
/// Height of a new rope above the landing pad, its distance to the east and that of its ends, and its length, m.
const NEW_ROPE_HEIGHT_M: f64 = 60.0;
const NEW_ROPE_SPAN_M: f64 = 20.0;
const NEW_ROPE_LENGTH_M: f64 = 21.0;
/// Distance between a new bridge and the one before it, m to the north.
const NEW_BRIDGE_DISTANCE_M: f64 = 100.0;

/// A change to the text of a scenario. Locations contain the indices of repeated tables, as in `tasks[2].name`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Edit {
    /// Sets the value at a location. An empty text removes it.
    Set {
        /// Location of the value.
        location: String,
        /// Text as typed in a form.
        text: String,
    },
    /// Adds a table to a repeated table.
    Add {
        /// Location of the repeated table: `tasks`, `bridges`, `drones`, `ropes` or `wind.events`.
        location: String,
    },
    /// Removes one table of a repeated table.
    Remove {
        /// Location of the table, such as `tasks[2]`.
        location: String,
    },
    /// Swaps one table of a repeated table with the one before it or after it.
    Move {
        /// Location of the table, such as `tasks[2]`.
        location: String,
        /// Whether the table moves toward the beginning.
        up: bool,
    },
}

/// Returns the text after these edits.
///
/// # Errors
/// Returns a message if the text is not valid TOML, or a location does not exist.
pub fn apply(text: &str, edits: &[Edit]) -> Result<String, String> {
    edits.iter().try_fold(text.to_owned(), |text, edit| apply_one(&text, edit))
}

/// Returns whether a key determines which other keys its table has.
fn is_kind_key(key: &str) -> bool {
    key == BRIDGE_TYPE_KEY || KIND_KEYS.contains(&key)
}

fn parse(text: &str) -> Result<DocumentMut, String> {
    text.parse().map_err(|_| "the text is not valid TOML".to_owned())
}

fn apply_one(text: &str, edit: &Edit) -> Result<String, String> {
    let mut document = parse(text)?;
    match edit {
        Edit::Set { location, text: typed } => {
            set(document.as_table_mut(), location, typed)?;
            let changed = document.to_string();
            let key = location.rsplit('.').next().unwrap_or_default();
            return Ok(if is_kind_key(key) { without_unused_keys(text, changed, location) } else { changed });
        }
        Edit::Add { location } => add(&mut document, location)?,
        Edit::Remove { location } => remove(document.as_table_mut(), location)?,
        Edit::Move { location, up } => swap(document.as_table_mut(), location, *up)?,
    }
    Ok(document.to_string())
}

/// One part of a location: a key, and the index if its table is repeated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Step<'a> {
    key: &'a str,
    index: Option<usize>,
}

fn steps(location: &str) -> Result<Vec<Step<'_>>, String> {
    let step = |part: &'_ str| -> Option<(usize, usize)> {
        let open = part.find('[')?;
        let index = part.get(open + 1..)?.strip_suffix(']')?.parse().ok()?;
        Some((open, index))
    };
    let steps: Vec<Step> = location
        .split('.')
        .map(|part| match step(part) {
            Some((open, index)) => Step { key: &part[..open], index: Some(index) },
            None => Step { key: part, index: None },
        })
        .collect();
    let legal = |key: &str| !key.is_empty() && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
    if steps.iter().all(|step| legal(step.key)) { Ok(steps) } else { Err(unknown(location)) }
}

fn unknown(location: &str) -> String {
    format!("there is no key or table '{location}'")
}

/// Returns the table at the end of the steps. Creates missing tables if `create` is set, but none of a repeated table.
fn table_at<'t>(root: &'t mut Table, steps: &[Step], create: bool) -> Option<&'t mut dyn TableLike> {
    steps.iter().try_fold(root as &mut dyn TableLike, |table, step| {
        if create && step.index.is_none() && !table.contains_key(step.key) {
            table.insert(step.key, Item::Table(Table::new()));
        }
        let item = table.get_mut(step.key)?;
        match step.index {
            None => item.as_table_like_mut(),
            Some(k) => repeated_table(item, k),
        }
    })
}

fn repeated_table(item: &mut Item, k: usize) -> Option<&mut dyn TableLike> {
    match item {
        Item::ArrayOfTables(tables) => tables.get_mut(k).map(|table| table as &mut dyn TableLike),
        Item::Value(Value::Array(array)) => array.get_mut(k)?.as_inline_table_mut().map(|table| table as &mut dyn TableLike),
        Item::None | Item::Value(_) | Item::Table(_) => None,
    }
}

fn set(root: &mut Table, location: &str, text: &str) -> Result<(), String> {
    let described = describe(location).ok_or_else(|| unknown(location))?;
    let steps = steps(location)?;
    let (last, path) = steps.split_last().ok_or_else(|| unknown(location))?;
    if text.trim().is_empty() {
        if let Some(table) = table_at(root, path, false) {
            table.remove(last.key);
        }
        return Ok(());
    }
    let table = table_at(root, path, true).ok_or_else(|| unknown(location))?;
    let mut new = typed(&described.documented.allowed, text);
    match table.get_mut(last.key) {
        Some(Item::Value(old)) if shown(old) == shown(&new) && old.type_name() == new.type_name() => {}
        Some(Item::Value(old)) => {
            *new.decor_mut() = old.decor().clone();
            *old = new;
        }
        Some(Item::None | Item::Table(_) | Item::ArrayOfTables(_)) | None => {
            table.insert(last.key, Item::Value(new));
        }
    }
    Ok(())
}

/// Removes the keys that a new kind of table no longer uses, which would be errors.
fn without_unused_keys(before: &str, after: String, location: &str) -> String {
    let table = location.rsplit_once('.').map_or("", |(table, _)| table);
    let known_before = unknown_locations(before, table);
    let unused: Vec<String> = unknown_locations(&after, table).into_iter().filter(|key| !known_before.contains(key)).collect();
    let Ok(mut document) = after.parse::<DocumentMut>() else { return after };
    for location in &unused {
        let Ok(steps) = steps(location) else { continue };
        if let Some((last, path)) = steps.split_last()
            && let Some(table) = table_at(document.as_table_mut(), path, false)
        {
            table.remove(last.key);
        }
    }
    if unused.is_empty() { after } else { document.to_string() }
}

/// Returns the locations of the unknown keys in a table.
fn unknown_locations(text: &str, table: &str) -> BTreeSet<String> {
    let problems = super::read::read("", text, &|_| Err(String::new())).err().map_or_else(Vec::new, |problems| problems.0);
    let inside = |location: &str| location.strip_prefix(table).is_some_and(|rest| rest.starts_with('.'));
    let unknown = problems.into_iter().filter(|problem| problem.message.starts_with("unknown key") && inside(&problem.location));
    unknown.map(|problem| problem.location).collect()
}

fn add(document: &mut DocumentMut, location: &str) -> Result<(), String> {
    let values = ScenarioValues::read(&document.to_string()).unwrap_or_default();
    let entries = new_table(location, &values).ok_or_else(|| unknown(location))?;
    push(document, location, entries)
}

/// Adds a table with these entries to a repeated table.
fn push(document: &mut DocumentMut, location: &str, entries: Entries) -> Result<(), String> {
    let steps = steps(location)?;
    let (last, path) = steps.split_last().ok_or_else(|| unknown(location))?;
    let parent = table_at(document.as_table_mut(), path, true).ok_or_else(|| unknown(location))?;
    let is_empty_list = parent.get(last.key).and_then(Item::as_array).is_some_and(Array::is_empty);
    if is_empty_list || !parent.contains_key(last.key) {
        parent.insert(last.key, Item::ArrayOfTables(ArrayOfTables::new()));
    }
    match parent.get_mut(last.key) {
        Some(Item::ArrayOfTables(tables)) => {
            tables.push(entries.into_iter().map(|(key, entry)| (key, Item::Value(entry))).collect())
        }
        Some(Item::Value(Value::Array(array))) => array.push(entries.into_iter().collect::<InlineTable>()),
        Some(Item::None | Item::Value(_) | Item::Table(_)) | None => return Err(unknown(location)),
    }
    Ok(())
}

type Entries = Vec<(&'static str, Value)>;

/// Returns the entries of a new table.
fn new_table(location: &str, values: &ScenarioValues) -> Option<Entries> {
    match location {
        "tasks" => Some(new_task(values)),
        "bridges" => Some(new_bridge(values)),
        "drones" => Some(new_drone(values)),
        "ropes" => Some(new_rope(values)),
        "wind.events" => Some(new_gust()),
        _ => None,
    }
}

fn new_task(values: &ScenarioValues) -> Entries {
    let name = format!("Task {}", values.count("tasks") + 1);
    let bridge = values.get("bridges[0].name");
    let kind = match (bridge, values.get("bridges[0].type")) {
        (None, _) | (Some(_), Some("model")) => "free",
        (Some(_), Some("suspension")) => "pier_circle",
        (Some(_), _) => "slab_side",
    };
    let mut entries = vec![("name", Value::from(name)), ("kind", Value::from(kind))];
    match bridge {
        Some(bridge) if kind != "free" => entries.push(("bridge", Value::from(bridge))),
        Some(_) | None => {
            let corner = |east: f64, north: f64| -> Value { [east, north, 10.0].into_iter().collect::<Array>().into() };
            entries.push(("points_m", Value::Array([corner(0.0, 0.0), corner(20.0, 0.0)].into_iter().collect())));
        }
    }
    entries
}

fn new_bridge(values: &ScenarioValues) -> Entries {
    let free = free_name(values, "bridges", "bridge");
    let last = values.count("bridges").checked_sub(1).and_then(|k| values.get(&format!("bridges[{k}].centre_m")));
    let beside_last = position(last).map(|[east, north, up]| [east, north + NEW_BRIDGE_DISTANCE_M, up]);
    let [east, north, up] = beside_last.unwrap_or([0.0, 0.0, 34.0]);
    vec![
        ("name", Value::from(free)),
        ("type", Value::from("arch")),
        ("centre_m", Value::Array([east, north, up].into_iter().collect())),
        ("heading_deg", Value::from(90.0)),
    ]
}

/// Returns a name such as `drone-2` that no table at a location has.
fn free_name(values: &ScenarioValues, location: &str, kind: &str) -> String {
    let count = values.count(location);
    let names: Vec<&str> = (0..count).filter_map(|k| values.get(&format!("{location}[{k}].name"))).collect();
    (count + 1..).map(|k| format!("{kind}-{k}")).find(|name| !names.contains(&name.as_str())).unwrap_or_default()
}

/// Returns a drone that hovers high above the landing pad, where no bridge is in its way.
fn new_drone(values: &ScenarioValues) -> Entries {
    let free = free_name(values, "drones", "drone");
    let [east, north, up] = position(values.get("ground_team.pad_m")).unwrap_or([0.0; 3]);
    let point = |east: f64| -> Value { [east, north, up + NEW_DRONE_HEIGHT_M].into_iter().collect::<Array>().into() };
    vec![
        ("name", Value::from(free)),
        ("points_m", Value::Array([point(east), point(east + NEW_DRONE_PATH_M)].into_iter().collect())),
        ("repeat", Value::from(true)),
    ]
}

/// Returns a rope that hangs high above the landing pad, where no bridge is in its way.
fn new_rope(values: &ScenarioValues) -> Entries {
    let free = free_name(values, "ropes", "rope");
    let [east, north, up] = position(values.get("ground_team.pad_m")).unwrap_or([0.0; 3]);
    let point = |east: f64| -> Value { [east, north, up + NEW_ROPE_HEIGHT_M].into_iter().collect::<Array>().into() };
    vec![
        ("name", Value::from(free)),
        ("points_m", Value::Array([point(east + NEW_ROPE_SPAN_M), point(east + 2.0 * NEW_ROPE_SPAN_M)].into_iter().collect())),
        ("length_m", Value::from(NEW_ROPE_LENGTH_M)),
    ]
}

/// Returns the coordinates in a value such as `[1, 2, 3]`.
fn position(value: Option<&str>) -> Option<[f64; 3]> {
    let inside = value?.trim_matches(['[', ']']);
    let coordinates: Vec<f64> = inside.split(',').filter_map(|part| part.trim().parse().ok()).collect();
    coordinates.try_into().ok()
}

fn new_gust() -> Entries {
    let numbers = [("at_s", 60.0), ("from_deg", 0.0), ("duration_s", 5.0), ("peak_m_s", 5.0)];
    let numbers = numbers.into_iter().map(|(key, number)| (key, Value::from(number)));
    [("kind", Value::from("gust"))].into_iter().chain(numbers).collect()
}

/// Returns the repeated table at a location, and the index in it.
fn repeated<'t>(root: &'t mut Table, location: &str) -> Result<(&'t mut Item, usize), String> {
    let steps = steps(location)?;
    let (last, path) = steps.split_last().ok_or_else(|| unknown(location))?;
    let index = last.index.ok_or_else(|| unknown(location))?;
    let item = table_at(root, path, false).and_then(|parent| parent.get_mut(last.key)).ok_or_else(|| unknown(location))?;
    Ok((item, index))
}

fn remove(root: &mut Table, location: &str) -> Result<(), String> {
    match repeated(root, location)? {
        (Item::ArrayOfTables(tables), k) if k < tables.len() => {
            tables.remove(k);
            Ok(())
        }
        (Item::Value(Value::Array(array)), k) if k < array.len() => {
            array.remove(k);
            Ok(())
        }
        _ => Err(unknown(location)),
    }
}

fn swap(root: &mut Table, location: &str, up: bool) -> Result<(), String> {
    let (item, k) = repeated(root, location)?;
    let other = if up { k.checked_sub(1) } else { k.checked_add(1) }.ok_or_else(|| unknown(location))?;
    match item {
        Item::ArrayOfTables(tables) => {
            let (Some(mut a), Some(mut b)) = (tables.get(k).cloned(), tables.get(other).cloned()) else {
                return Err(unknown(location));
            };
            let (place_a, place_b) = (a.position(), b.position());
            a.set_position(place_b);
            b.set_position(place_a);
            tables.replace(other, a);
            tables.replace(k, b);
        }
        Item::Value(Value::Array(array)) => {
            let (Some(a), Some(b)) = (array.get(k).cloned(), array.get(other).cloned()) else { return Err(unknown(location)) };
            array.replace_formatted(other, a);
            array.replace_formatted(k, b);
        }
        Item::None | Item::Value(_) | Item::Table(_) => return Err(unknown(location)),
    }
    Ok(())
}

/// Returns the text with one more picture of the briefing.
///
/// # Errors
/// Returns a message if the text is not valid TOML, or `briefing_pictures` is not a repeated table.
pub fn with_briefing_picture(text: &str, picture: &BriefingPicture) -> Result<String, String> {
    let mut document = parse(text)?;
    let entries = vec![("file", Value::from(&picture.file)), ("caption", Value::from(&picture.caption))];
    push(&mut document, briefing_pictures::TABLE, entries)?;
    Ok(document.to_string())
}

/// Returns the text with one more placed defect, and its ID: the number after the largest one in the text, or else the smallest one
/// that is free. The ID of `defect` has no effect.
///
/// # Errors
/// Returns a message if the text is not valid TOML, or `defects.placed` is not a repeated table.
pub fn with_placed_defect(text: &str, defect: &PlacedDefect) -> Result<(String, u32), String> {
    let mut document = parse(text)?;
    let values = ScenarioValues::read(text).unwrap_or_default();
    let location = format!("{DEFECTS}.{PLACED}");
    let ids = (0..values.count(&location)).filter_map(|k| values.get(&format!("{location}[{k}].id"))?.parse::<u32>().ok());
    let used: BTreeSet<u32> = ids.collect();
    let next = used.last().map_or(1, |largest| largest.saturating_add(1));
    let id = if next <= MAX_DEFECT_ID { next } else { (1..next).find(|id| !used.contains(id)).unwrap_or(next) };
    if let Some(defects) = document.get_mut(DEFECTS).and_then(Item::as_table_like_mut) {
        defects.remove(NONE_PLACED);
    }
    push(&mut document, &location, defect_entries(&PlacedDefect { id, ..defect.clone() }))?;
    Ok((document.to_string(), id))
}

/// Returns the text with another name. Invalid TOML is returned unchanged.
#[must_use]
pub fn with_name(text: &str, name: &str) -> String {
    changed(text, |document| document["name"] = value(name))
}

/// Returns the text of a copy with another name, which its title shows, too. Invalid TOML is returned unchanged.
#[must_use]
pub fn copy(text: &str, name: &str) -> String {
    changed(text, |document| {
        document["name"] = value(name);
        if let Some(title) = document.get("title").and_then(|title| title.as_str()).map(|title| format!("{title} ({name})")) {
            document["title"] = value(title);
        }
    })
}

/// Returns the text after a change. Invalid TOML is returned unchanged.
fn changed(text: &str, change: impl FnOnce(&mut DocumentMut)) -> String {
    let Ok(mut document) = text.parse::<DocumentMut>() else { return text.to_owned() };
    change(&mut document);
    document.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::defect_codes::CRACK;
    use crate::elements::Element;
    use crate::frames::Vec3;
    use crate::shipped::{PRACTICE, TWO_BRIDGES};

    fn set(location: &str, text: &str) -> Edit {
        Edit::Set { location: location.into(), text: text.into() }
    }

    fn problems(text: &str) -> Vec<(String, String)> {
        let read = super::super::read("job.toml", text, &|_| Err(String::new()));
        let problems = read.err().map_or_else(Vec::new, |problems| problems.0);
        problems.into_iter().map(|problem| (problem.location, problem.message)).collect()
    }

    #[test]
    fn exact_an_edit_changes_one_line_and_keeps_comments() {
        let text = PRACTICE.replace("from_deg = 200.0", "from_deg  =  200.0   # from the lake");
        let edited = apply(&text, &[set("wind.from_deg", "215")]).unwrap();
        assert_eq!(edited, text.replace("200.0   # from", "215   # from"));
        assert_eq!(apply(&text, &[set("wind.from_deg", "200.0")]).unwrap(), text, "the same value");
        let removed = apply(&text, &[set("wind.turbulence", " ")]).unwrap();
        assert_eq!(removed, text.replace("turbulence = 0.5\n", ""));
        let added = apply(&text, &[set("scoring.clearance_m", "1.5"), set("seed", "7")]).unwrap();
        assert!(added.ends_with("battery = \"paper\"\n\n[scoring]\nclearance_m = 1.5\n"), "{added}");
        assert!(added.contains("title = \"Practice at two bridges\"\nseed = 7\n"), "{added}");
        assert_eq!(problems(&added), []);
        let dimensions = apply(&text, &[set("bridges[0].arch.span_m", "90"), set("wind.level", "calm")]).unwrap();
        assert!(dimensions.contains("heading_deg = 90.0\n\n[bridges.arch]\nspan_m = 90\n\n[[bridges]]"), "{dimensions}");
    }

    #[test]
    fn exact_wrong_values_are_reported_at_their_location() {
        let wrong = [set("tasks[2].too_close_m", "90"), set("wind.from_deg", "north"), set("tasks[3].bridge", "none")];
        let found = problems(&apply(PRACTICE, &wrong).unwrap());
        assert_eq!(found[0], ("tasks[2].too_close_m".into(), "out of range".into()));
        assert_eq!(found[1], ("tasks[3].bridge".into(), "unknown bridge".into()));
        assert!(found.contains(&("wind.from_deg".into(), "not a number".into())), "{found:?}");
    }

    #[test]
    fn exact_tasks_are_added_moved_and_removed() {
        let names = |text: &str| {
            let values = ScenarioValues::read(text).unwrap();
            (0..values.count("tasks"))
                .map(|k| values.get(&format!("tasks[{k}].name")).unwrap().chars().take(6).collect())
                .collect()
        };
        let text = PRACTICE.replace("[[tasks]]\nname = \"Arch", "# About the bottom.\n[[tasks]]\nname = \"Arch");
        let edited: Vec<String> = names(&apply(&text, &[Edit::Add { location: "tasks".into() }]).unwrap());
        assert_eq!(edited, ["Slab o", "Arch-s", "Interl", "Pier o", "Task 5"]);
        let moves = [
            Edit::Add { location: "tasks".into() },
            Edit::Move { location: "tasks[4]".into(), up: true },
            Edit::Move { location: "tasks[1]".into(), up: false },
            Edit::Remove { location: "tasks[0]".into() },
        ];
        let edited = apply(&text, &moves).unwrap();
        let order: Vec<String> = names(&edited);
        assert_eq!(order, ["Interl", "Arch-s", "Task 5", "Pier o"]);
        assert!(edited.contains("# About the bottom.\n[[tasks]]\nname = \"Arch"), "{edited}");
        assert_eq!(problems(&edited), []);
        for location in ["tasks", "tasks[9]", "wind[0]", "tasks[x]", "tasks[0].name", "", "a b"] {
            assert!(apply(&text, &[Edit::Remove { location: location.into() }]).is_err(), "{location}");
        }
        assert!(apply(&text, &[Edit::Move { location: "tasks[0]".into(), up: true }]).is_err());
        assert!(apply(&text, &[Edit::Move { location: "tasks[3]".into(), up: false }]).is_err());
    }

    #[test]
    fn exact_new_tables_are_valid() {
        for text in [PRACTICE, TWO_BRIDGES, include_str!("../../../../scenarios/drill-hover.toml")] {
            let add = |location: &str| Edit::Add { location: location.into() };
            let tables = ["tasks", "bridges", "bridges", "wind.events", "drones", "drones", "ropes", "ropes"];
            let edited = apply(text, &tables.map(add)).unwrap();
            assert_eq!(problems(&edited), [], "{edited}");
        }
        let inline = "tasks = [{ name = \"a\", kind = \"free\", points_m = [[0, 0, 5]] }]\n";
        let edited = apply(inline, &[Edit::Add { location: "tasks".into() }]).unwrap();
        assert_eq!(ScenarioValues::read(&edited).unwrap().count("tasks"), 2, "{edited}");
    }

    #[test]
    fn exact_pictures_are_added_and_removed_and_everything_else_remains() {
        let picture = |file: &str| BriefingPicture { file: file.into(), caption: "The \"gate\"".into() };
        let one = with_briefing_picture(PRACTICE, &picture("job/gate.png")).unwrap();
        let two = with_briefing_picture(&one, &picture("job/site.jpg")).unwrap();
        assert_eq!(problems(&two), []);
        let table = |file: &str| format!("\n[[briefing_pictures]]\nfile = \"job/{file}\"\ncaption = 'The \"gate\"'\n");
        assert_eq!(two, format!("{PRACTICE}{}{}", table("gate.png"), table("site.jpg")));
        let remove = |k: usize| Edit::Remove { location: format!("briefing_pictures[{k}]") };
        assert_eq!(apply(&two, &[remove(1)]).unwrap(), one);
        assert_eq!(apply(&two, &[remove(1), remove(0)]).unwrap(), PRACTICE);
        assert!(apply(&two, &[remove(2)]).is_err());
        let inline = "briefing_pictures = [{ file = \"a.png\", caption = \"a\" }]\n";
        let edited = with_briefing_picture(inline, &picture("b.png")).unwrap();
        assert_eq!(ScenarioValues::read(&edited).unwrap().count("briefing_pictures"), 2, "{edited}");
        assert!(with_briefing_picture("a = ", &picture("b.png")).is_err());
        assert!(with_briefing_picture("briefing_pictures = 3\n", &picture("b.png")).is_err());
    }

    #[test]
    fn exact_placed_defects_are_added_and_removed_and_everything_else_remains() {
        let defect = PlacedDefect {
            id: 77,
            element: Element::RcArch,
            member: "arch/rib-left/07".into(),
            kind: CRACK,
            condition_state: 3,
            position_m: Vec3::new(1.5, -2.0, 30.25),
            normal: Vec3::new(0.0, 0.0, -1.0),
            along: Vec3::new(1.0, 0.0, 0.0),
            length_m: 0.8,
            width_m: 0.002,
            line: true,
            cause: None,
            stain: None,
        };
        let (one, first) = with_placed_defect(PRACTICE, &defect).unwrap();
        let (two, second) = with_placed_defect(&one, &defect).unwrap();
        assert_eq!((first, second, problems(&two)), (1, 2, vec![]));
        let read = super::super::read("job.toml", &two, &|_| Err(String::new())).unwrap();
        let expected = [1, 2].map(|id| PlacedDefect { id, ..defect.clone() });
        assert_eq!((read.defects.placed.as_deref(), read.defects.number()), (Some(&expected[..]), 2));
        let kept = |text: &str| text.lines().filter(|line| !one.contains(line)).count();
        assert_eq!((kept(PRACTICE), one.matches("[[defects.placed]]").count()), (0, 1), "{one}");
        let remove = |k: usize| Edit::Remove { location: format!("defects.placed[{k}]") };
        let (again, third) = with_placed_defect(&apply(&two, &[remove(0)]).unwrap(), &defect).unwrap();
        assert_eq!((third, problems(&again)), (3, vec![]), "numbers are not used twice");
        assert_eq!(apply(&two, &[remove(1), remove(0)]).unwrap(), PRACTICE);
        assert!(apply(&two, &[remove(2)]).is_err() && with_placed_defect("a = ", &defect).is_err());
        let none = PRACTICE.replace("[defects]\n", "[defects]\nnone_placed = true\n");
        assert!(!with_placed_defect(&none, &defect).unwrap().0.contains("none_placed"));
        let twice = two.replace("id = 2\n", "id = 1\n");
        assert_eq!(problems(&twice), [("defects.placed[1].id".into(), "duplicate number".into())]);
        let last = one.replace("id = 1\n", "id = 10000\n");
        assert_eq!(with_placed_defect(&last, &defect).unwrap().1, 1, "the largest number is in use");
        let full =
            (0..=super::super::MAX_DEFECTS).fold(PRACTICE.to_owned(), |text, _| with_placed_defect(&text, &defect).unwrap().0);
        assert_eq!(problems(&full), [("defects.placed".into(), "too many".into())]);
    }

    #[test]
    fn exact_another_kind_removes_the_keys_that_it_does_not_use() {
        let sized = apply(PRACTICE, &[set("bridges[1].suspension.sag_m", "15")]).unwrap();
        let arch = apply(&sized, &[set("bridges[1].type", "arch")]).unwrap();
        assert!(!arch.contains("sag_m") && arch.contains("name = \"suspension\"\ntype = \"arch\""), "{arch}");
        let flat = apply(PRACTICE, &[set("terrain.source", "flat")]).unwrap();
        assert!(!flat.contains("lake_width_m") && flat.contains("size_m = 800.0"), "{flat}");
        assert_eq!(problems(&flat), []);
        let free = apply(PRACTICE, &[set("tasks[0].kind", "free")]).unwrap();
        assert_eq!(problems(&free), [("tasks[0].points_m".into(), "a free path without points".into())]);
        let typo = PRACTICE.replace("[terrain]\n", "[terrain]\nsizze_m = 3\n");
        assert!(apply(&typo, &[set("terrain.source", "flat")]).unwrap().contains("sizze_m"), "mistakes of before remain");
    }

    #[test]
    fn exact_unknown_keys_and_broken_texts_are_rejected() {
        for location in ["wind.x", "tasks[9].name", "x.y", "wind.speed_m_s.a", "tasks.name", "", "wind[0].speed_m_s"] {
            assert!(apply(PRACTICE, &[set(location, "1")]).is_err(), "{location}");
        }
        assert_eq!(apply("name = ", &[set("name", "a")]), Err("the text is not valid TOML".into()));
        assert!(with_name(PRACTICE, "my-job").contains("\nname = \"my-job\"\n"));
        let copied = copy(PRACTICE, "my-job");
        assert!(copied.contains("\nname = \"my-job\"\ntitle = \"Practice at two bridges (my-job)\"\n"), "{copied}");
        assert_eq!(copy("name = ", "my-job"), "name = ");
    }
}
