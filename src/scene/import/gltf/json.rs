//! Looking things up in the JSON of a glTF file: what has the wrong type is named with its place.

use serde_json::Value;

use super::super::lines::quote;

/// The way out for most of what is wrong in a file's JSON.
pub(super) const EXPORT_AGAIN: &str = "export the file again";

/// A list of values; empty where there is none.
pub(super) fn list<'a>(parent: &'a Value, key: &str, place: &str) -> Result<&'a [Value], String> {
    match parent.get(key) {
        None | Some(Value::Null) => Ok(&[]),
        Some(Value::Array(values)) => Ok(values),
        Some(other) => Err(wrong(place, key, "a list", other)),
    }
}

/// A whole number from 0, if it is there.
pub(super) fn whole(parent: &Value, key: &str, place: &str) -> Result<Option<u64>, String> {
    match parent.get(key) {
        None | Some(Value::Null) => Ok(None),
        Some(value) => whole_of(value).map(Some).ok_or_else(|| wrong(place, key, "a whole number from 0", value)),
    }
}

/// A whole number from 0; exporters in some languages write 3.0.
pub(super) fn whole_of(value: &Value) -> Option<u64> {
    let float = || value.as_f64().filter(|value| value.fract() == 0.0 && (0.0..9e15).contains(value));
    value.as_u64().or_else(|| float().map(|value| value as u64))
}

/// As many numbers as asked for; none where they are missing or anything else.
pub(super) fn numbers<const N: usize>(parent: &Value, key: &str) -> Option<[f64; N]> {
    let values = parent.get(key)?.as_array().filter(|values| values.len() == N)?;
    let mut numbers = [0.0; N];
    for (number, value) in numbers.iter_mut().zip(values) {
        *number = value.as_f64()?;
    }
    Some(numbers)
}

/// A text; empty where there is none.
pub(super) fn text<'a>(parent: &'a Value, key: &str) -> &'a str {
    parent.get(key).and_then(Value::as_str).unwrap_or_default()
}

/// What is said of a value of the wrong type.
fn wrong(place: &str, key: &str, expected: &str, found: &Value) -> String {
    let found = match found {
        Value::Object(_) => "an object".to_owned(),
        Value::Array(_) => "a list".to_owned(),
        Value::String(text) => quote(text.as_bytes()),
        other => other.to_string(),
    };
    let dot = if place.is_empty() { "" } else { "." };
    format!("{place}{dot}{key} is {found} and must be {expected}; {EXPORT_AGAIN}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_the_wrong_type_are_named_with_their_place() {
        let json: Value = serde_json::from_str(r#"{"count": "ten", "nodes": {}, "a": 3.0, "b": -1}"#).expect("JSON");
        assert_eq!(whole(&json, "a", ""), Ok(Some(3)));
        assert_eq!(whole(&json, "c", ""), Ok(None));
        assert!(whole(&json, "b", "").is_err());
        let message = whole(&json, "count", "accessors[3]").expect_err("a text");
        assert_eq!(message, "accessors[3].count is \"ten\" and must be a whole number from 0; export the file again");
        assert!(list(&json, "nodes", "").expect_err("an object").starts_with("nodes is an object and must be a list"));
    }
}
