//! Converts between TOML values and the text that a person reads or types in a form.

use toml_edit::{Array, Formatted, Value};

/// Returns a value as text for a form: texts without quotes, lists of texts with one text per line, and everything else as in the
/// file, but on one line.
pub(super) fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => text.value().clone(),
        Value::Array(array) if !array.is_empty() && array.iter().all(Value::is_str) => {
            array.iter().filter_map(Value::as_str).collect::<Vec<_>>().join("\n")
        }
        Value::Integer(_)
        | Value::Float(_)
        | Value::Boolean(_)
        | Value::Datetime(_)
        | Value::Array(_)
        | Value::InlineTable(_) => plain(value),
    }
}

/// Returns a value as TOML on one line, without comments.
fn plain(value: &Value) -> String {
    match value {
        Value::Array(array) => format!("[{}]", array.iter().map(plain).collect::<Vec<_>>().join(", ")),
        Value::String(_)
        | Value::Integer(_)
        | Value::Float(_)
        | Value::Boolean(_)
        | Value::Datetime(_)
        | Value::InlineTable(_) => {
            let mut value = value.clone();
            value.decor_mut().clear();
            value.to_string()
        }
    }
}

/// Returns the value for a typed text. `allowed` is the description of the key's allowed values. A text that is not of the key's
/// type becomes a string, so that the reader reports it with the allowed values.
pub(super) fn typed(allowed: &str, text: &str) -> Value {
    let text = text.trim();
    let value = if allowed == "true or false" {
        text.parse().ok().map(|yes: bool| Value::Boolean(Formatted::new(yes)))
    } else if allowed == "list of texts" {
        Some(Value::Array(text.lines().map(str::trim).filter(|line| !line.is_empty()).collect()))
    } else if allowed.starts_with("list of [") {
        list(text, true)
    } else if allowed.starts_with("list of") || allowed.contains(" numbers, each") {
        list(text, false)
    } else if is_number_range(allowed) {
        number(text)
    } else {
        None
    };
    value.unwrap_or_else(|| Value::String(Formatted::new(text.to_owned())))
}

fn is_number_range(allowed: &str) -> bool {
    let range = allowed.strip_prefix("whole number ").unwrap_or(allowed);
    range.split_once(" to ").is_some_and(|(min, max)| min.parse::<f64>().is_ok() && max.parse::<f64>().is_ok())
}

/// Parses a number. Keeps its spelling if it is valid TOML.
fn number(text: &str) -> Option<Value> {
    let kept = text.parse::<Value>().ok().filter(|value| value.is_integer() || value.is_float());
    kept.or_else(|| text.parse::<f64>().ok().map(|number| Value::Float(Formatted::new(number)))).map(undecorated)
}

/// Parses a list of numbers, or of lists of numbers if `nested`, with or without the outer brackets.
fn list(text: &str, nested: bool) -> Option<Value> {
    let bare = || format!("[{text}]").parse::<Value>().ok().filter(|value| is_list(value, nested));
    text.parse::<Value>().ok().filter(|value| is_list(value, nested)).or_else(bare).map(undecorated)
}

fn is_list(value: &Value, nested: bool) -> bool {
    let is_number = |value: &Value| value.is_integer() || value.is_float();
    let is_element = |value: &Value| if nested { is_list(value, false) } else { is_number(value) };
    value.as_array().is_some_and(|array: &Array| array.iter().all(is_element))
}

fn undecorated(mut value: Value) -> Value {
    value.decor_mut().clear();
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_typed_texts_become_values_of_the_key_type() {
        let file = |allowed: &str, text: &str| typed(allowed, text).to_string();
        assert_eq!(file("0 to 30", " 4.50 "), "4.50");
        assert_eq!(file("0 to 30", ".5"), "0.5");
        assert_eq!(file("0 to inf", "inf"), "inf");
        assert_eq!(file("0 to 30", "fast"), "\"fast\"");
        assert_eq!(file("0 to 30", "{ a = 1 }"), "\"{ a = 1 }\"");
        assert_eq!(file("whole number 0 to 9", "3"), "3");
        assert_eq!(file("true or false", "true"), "true");
        assert_eq!(file("3 numbers, each -5000 to 5000", "1, -2.0, 3"), "[1, -2.0, 3]");
        assert_eq!(file("3 numbers, each -5000 to 5000", "1, , 3"), "\"1, , 3\"");
        assert_eq!(file("list of [east, north, up], each 0 to 1", "[0, 0, 1], [1, 0, 1]"), "[[0, 0, 1], [1, 0, 1]]");
        assert_eq!(file("list of [east, north, up], each 0 to 1", "[0, 0, 1]"), "[[0, 0, 1]]");
        assert_eq!(file("list of texts", "One.\n\n \"Two\".\r\n"), r#"["One.", '"Two".']"#);

        assert_eq!(file("arch, suspension", "arch"), "\"arch\"");
    }

    #[test]
    fn prop_shown_values_become_the_same_values_again() {
        for (allowed, text) in [
            ("3 numbers, each -5000 to 5000", "[-112.0, 78.0, 5.0]"),
            ("list of whole numbers among 107, 205", "[107, 205]"),
            ("0 to 30", "1e-3"),
            ("list of texts", "[\"One.\", \"Two.\"]"),
            ("text", "\"a \\\"b\\\" # c\""),
        ] {
            let value: Value = text.parse().unwrap();
            assert_eq!(shown(&typed(allowed, &shown(&value))), shown(&value), "{text}");
        }
        let commented: Value = "[ # first\n 1,\n 2, # last\n]".parse().unwrap();
        assert_eq!(shown(&commented), "[1, 2]");
    }
}
