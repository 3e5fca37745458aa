//! What a JSON schema has against a value: the keywords that `schemars` writes, and no others.

#![allow(dead_code, unreachable_pub, clippy::unwrap_used)] // Every test file uses some of it.

use serde_json::Value;

/// Every place where the value is not what the schema demands.
///
/// # Panics
/// For a keyword that is not known here: it would go unchecked.
pub fn problems(schema: &Value, value: &Value) -> Vec<String> {
    let mut problems = Vec::new();
    check(schema, schema, value, "$", &mut problems);
    problems
}

fn check(root: &Value, schema: &Value, value: &Value, place: &str, problems: &mut Vec<String>) {
    let Some(schema) = schema.as_object() else {
        assert_eq!(schema, &Value::Bool(true), "{place}");
        return;
    };
    for (keyword, demand) in schema {
        let fails = match keyword.as_str() {
            "$schema" | "title" | "description" | "format" | "$defs" | "default" => false,
            "$ref" => {
                let pointer = demand.as_str().unwrap().strip_prefix('#').unwrap();
                check(root, root.pointer(pointer).unwrap(), value, place, problems);
                false
            }
            "type" => match demand {
                Value::Array(types) => !types.iter().any(|kind| is(value, kind)),
                kind => !is(value, kind),
            },
            "const" => value != demand,
            "enum" => !demand.as_array().unwrap().contains(value),
            "minimum" => value.as_f64().is_some_and(|n| n < demand.as_f64().unwrap()),
            "minItems" => items(value).len() < demand.as_u64().unwrap() as usize,
            "maxItems" => items(value).len() > demand.as_u64().unwrap() as usize,
            "anyOf" | "oneOf" => {
                let meets = |schema: &Value| {
                    let mut problems = Vec::new();
                    check(root, schema, value, place, &mut problems);
                    problems.is_empty()
                };
                let met = demand
                    .as_array()
                    .unwrap()
                    .iter()
                    .filter(|s| meets(s))
                    .count();
                met == 0 || (keyword == "oneOf" && met > 1)
            }
            "items" => {
                for (index, item) in items(value).iter().enumerate() {
                    check(root, demand, item, &format!("{place}[{index}]"), problems);
                }
                false
            }
            "required" => {
                let names = demand
                    .as_array()
                    .unwrap()
                    .iter()
                    .map(|n| n.as_str().unwrap());
                let missing = |name: &str| value.is_object() && value.get(name).is_none();
                names.into_iter().any(missing)
            }
            "properties" => {
                for (name, inner) in value.as_object().into_iter().flatten() {
                    let inner_place = format!("{place}.{name}");
                    match demand.get(name) {
                        Some(demand) => check(root, demand, inner, &inner_place, problems),
                        // Stricter than the standard: what is written is described.
                        None => problems.push(format!("{inner_place} is not described")),
                    }
                }
                false
            }
            "additionalProperties" => {
                for (name, inner) in value.as_object().into_iter().flatten() {
                    check(root, demand, inner, &format!("{place}.{name}"), problems);
                }
                false
            }
            other => panic!("{place}: unknown keyword {other}"),
        };
        if fails {
            problems.push(format!("{place}: {keyword} {demand}, found {value:.80}"));
        }
    }
}

fn items(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], |items| items)
}

fn is(value: &Value, kind: &Value) -> bool {
    match kind.as_str().unwrap() {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "object" => value.is_object(),
        "array" => value.is_array(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "string" => value.is_string(),
        other => panic!("unknown type {other}"),
    }
}
