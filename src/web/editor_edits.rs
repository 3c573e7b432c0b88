//! Parses the edits that the scenario editor's script sends.

use serde_json::Value;
use spandrel_model::scenario::edit::Edit;

/// Maximum number of edits in one request. The script sends changes after each pause in typing.
const MAX_EDITS: usize = 64;

/// Parses a JSON list of edits: `{"set": LOCATION, "text": TEXT}`, `{"add": LOCATION}`, `{"remove": LOCATION}` or
/// `{"move": LOCATION, "up": BOOLEAN}`.
///
/// # Errors
/// Returns a message if the list is invalid or too long.
pub fn parse(json: &str) -> Result<Vec<Edit>, String> {
    let list: Vec<Value> = serde_json::from_str(json).map_err(|_| "edits: not a list".to_owned())?;
    if list.len() > MAX_EDITS {
        return Err(format!("edits: {} (allowed: at most {MAX_EDITS})", list.len()));
    }
    list.iter().map(|value| edit(value).ok_or_else(|| "edits: unknown edit".to_owned())).collect()
}

fn edit(value: &Value) -> Option<Edit> {
    let text = |key: &str| value.get(key).and_then(Value::as_str).map(str::to_owned);
    if let Some(location) = text("set") {
        return Some(Edit::Set { location, text: text("text")? });
    }
    if let Some(location) = text("add") {
        return Some(Edit::Add { location });
    }
    if let Some(location) = text("remove") {
        return Some(Edit::Remove { location });
    }
    Some(Edit::Move { location: text("move")?, up: value.get("up")?.as_bool()? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_edits_are_parsed() {
        let set = Edit::Set { location: "wind.from_deg".into(), text: "20".into() };
        let up = Edit::Move { location: "tasks[1]".into(), up: true };
        assert_eq!(parse(r#"[{"set":"wind.from_deg","text":"20"},{"move":"tasks[1]","up":true}]"#), Ok(vec![set, up]));
        assert_eq!(parse(r#"[{"add":"tasks"},{"remove":"tasks[0]"}]"#).map(|edits| edits.len()), Ok(2));
        for wrong in
            ["", "{}", "[1]", r#"[{"set":"a"}]"#, r#"[{"move":"a"}]"#, &format!("[{}]", ["{\"add\":\"tasks\"}"; 65].join(","))]
        {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
    }
}
