//! A strategy in a file of results: its id alone in schema 1, since then with its family and parameters.

use std::{borrow::Cow, collections::BTreeMap, fmt};

use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{Error, MapAccess, Visitor},
};
use serde_json::{Map, Value};

use super::StrategyId;
use crate::visible::visible;

/// Parameters by name.
type Parameters = BTreeMap<String, Value>;

/// What a file holds. The id says everything; the other fields save readers a parser.
#[derive(Serialize)]
struct Parts<'a> {
    id: &'a str,
    family: &'a str,
    parameters: Parameters,
}

impl Serialize for StrategyId {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let (id, family, parameters) = (self.as_str(), self.family(), self.parameters());
        Parts { id, family, parameters }.serialize(to)
    }
}

impl<'de> Deserialize<'de> for StrategyId {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(Reader)
    }
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = StrategyId;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(
            "as strategy an id such as \"SC-E/48x48x40\", or an object of id, family and parameters",
        )
    }

    fn visit_str<E: Error>(self, id: &str) -> Result<StrategyId, E> {
        Ok(StrategyId::read(id))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<StrategyId, A::Error> {
        let mut fields = Map::new();
        while let Some((name, value)) = map.next_entry::<String, Value>()? {
            fields.insert(name, value);
        }
        read_fields(fields).map_err(A::Error::custom)
    }
}

/// Reads an id with its parts. Parts that contradict the id are errors.
fn read_fields(mut fields: Map<String, Value>) -> Result<StrategyId, String> {
    let mut id = match fields.remove("id") {
        Some(Value::String(id)) => StrategyId::read(&id),
        Some(other) => {
            return Err(format!(
                "strategy.id is {other}: it must be a text, such as \"SC-E/48x48x40\""
            ));
        }
        None => return Err("strategy.id is missing: it must be the id of a strategy".to_owned()),
    };
    match fields.remove("family") {
        None => {}
        Some(Value::String(family)) if family.eq_ignore_ascii_case(id.family()) => {}
        Some(other) => {
            return Err(format!(
                "strategy.family is {other}: it must be {:?}, the family of strategy.id {:?}",
                id.family(),
                id.as_str()
            ));
        }
    }
    let stored = match fields.remove("parameters") {
        None => Map::new(),
        Some(Value::Object(stored)) => stored,
        Some(other) => {
            return Err(format!(
                "strategy.parameters is {other}: it must be an object of names and values"
            ));
        }
    };
    let stated = id.parameters();
    for (name, value) in stored {
        match stated.get(&name) {
            Some(known) if is_same(known, &value) => {}
            Some(known) if id.is_runnable() => {
                return Err(format!(
                    "strategy.parameters.{name} is {value}: it must be {known}, as strategy.id {:?} says",
                    id.as_str()
                ));
            }
            _ => drop(id.unread.insert(name, value)),
        }
    }
    Ok(id)
}

/// Whether two values are equal, where numbers may have been rounded to 32 bits.
fn is_same(a: &Value, b: &Value) -> bool {
    const ROUNDING: f64 = 1e-6;
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => (a - b).abs() <= ROUNDING * a.abs().max(b.abs()),
        _ => a == b,
    }
}

impl StrategyId {
    /// Escapes control characters of an id from a file. Its stored parameters stay.
    pub(crate) fn show_hidden(&mut self) {
        if let Cow::Owned(text) = visible(&self.text) {
            let unread = std::mem::take(&mut self.unread);
            *self = Self { unread, ..Self::read(&text) };
        }
    }
}
