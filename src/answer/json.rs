//! The JSON of an answer as text. Lists that may be very long are never held: their items are made
//! one by one, where they are written.

use std::fmt;
use std::io::{self, Write};
use std::sync::Arc;

use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value;
use serde_json::ser::{Formatter, PrettyFormatter};

use crate::delimited::is_obeyed;

/// A list of the JSON whose items are made where somebody reads them. Its key holds `null` in the
/// JSON that is held.
#[derive(Clone)]
pub struct LongList {
    /// Where it stands in the JSON.
    pub key: &'static str,
    /// How many items it has.
    pub count: usize,
    item: Arc<dyn Fn(usize) -> Value + Send + Sync>,
}

impl LongList {
    /// A list of `count` items.
    pub fn new(
        key: &'static str,
        count: usize,
        item: impl Fn(usize) -> Value + Send + Sync + 'static,
    ) -> LongList {
        LongList { key, count, item: Arc::new(item) }
    }

    /// Its items, in their order.
    pub fn items(&self) -> impl Iterator<Item = Value> {
        (0..self.count).map(|index| (self.item)(index))
    }
}

impl fmt::Debug for LongList {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} items of {}", self.count, self.key)
    }
}

impl Serialize for LongList {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.items())
    }
}

/// JSON with its long list.
struct Whole<'a>(&'a Value, Option<&'a LongList>);

impl Serialize for Whole<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Whole(Value::Object(entries), Some(long)) = self else { return self.0.serialize(serializer) };
        let mut map = serializer.serialize_map(Some(entries.len()))?;
        for (key, value) in entries {
            match key == long.key {
                true => map.serialize_entry(key, long)?,
                false => map.serialize_entry(key, value)?,
            }
        }
        map.end()
    }
}

/// Writes `json`, in place of its `null` the `long` list, for people to read: lines and spaces.
/// Whatever a terminal would obey instead of showing it is escaped; what is read from it is the
/// same.
///
/// ```
/// use rodcal::answer::{LongList, write_json};
///
/// let list = LongList::new("poses", 2, |k| (10 * k).into());
/// let mut text = Vec::new();
/// write_json(&serde_json::json!({ "poses": null, "count": 2 }), Some(&list), &mut text)?;
/// let read: serde_json::Value = serde_json::from_slice(&text)?;
/// assert_eq!(read["poses"][1], 10);
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// What `to` says.
pub fn write_json(json: &Value, long: Option<&LongList>, mut to: impl Write) -> io::Result<()> {
    let mut serializer = serde_json::Serializer::with_formatter(&mut to, Shown(PrettyFormatter::new()));
    Whole(json, long).serialize(&mut serializer)?;
    to.write_all(b"\n")
}

/// Lines and spaces of serde_json's own, texts that a terminal shows.
struct Shown(PrettyFormatter<'static>);

impl Formatter for Shown {
    fn write_string_fragment<W: Write + ?Sized>(&mut self, to: &mut W, text: &str) -> io::Result<()> {
        let mut rest = text;
        while let Some((at, c)) = rest.char_indices().find(|(_, c)| is_obeyed(*c)) {
            to.write_all(&rest.as_bytes()[..at])?;
            for unit in c.encode_utf16(&mut [0; 2]) {
                write!(to, "\\u{unit:04x}")?;
            }
            rest = &rest[at + c.len_utf8()..];
        }
        to.write_all(rest.as_bytes())
    }

    fn begin_array<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.begin_array(to)
    }

    fn end_array<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.end_array(to)
    }

    fn begin_array_value<W: Write + ?Sized>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        self.0.begin_array_value(to, first)
    }

    fn end_array_value<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.end_array_value(to)
    }

    fn begin_object<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.begin_object(to)
    }

    fn end_object<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.end_object(to)
    }

    fn begin_object_key<W: Write + ?Sized>(&mut self, to: &mut W, first: bool) -> io::Result<()> {
        self.0.begin_object_key(to, first)
    }

    fn begin_object_value<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.begin_object_value(to)
    }

    fn end_object_value<W: Write + ?Sized>(&mut self, to: &mut W) -> io::Result<()> {
        self.0.end_object_value(to)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn text(json: &Value, long: Option<&LongList>) -> String {
        let mut bytes = Vec::new();
        write_json(json, long, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn a_long_list_is_written_as_if_it_were_held() {
        let (first, last) = (json!({ "a": [1.5, null], "e": [], "o": {} }), json!("x"));
        let item = |index: usize| json!({ "n": index, "sd": [index as f64, 0.1] });
        let held = json!({ "first": first, "rows": (0..3).map(item).collect::<Vec<_>>(), "last": last });
        let open = json!({ "first": first, "rows": null, "last": last });
        let long = LongList::new("rows", 3, item);
        assert_eq!(text(&open, Some(&long)), format!("{held:#}\n"));
        assert_eq!(text(&held, None), format!("{held:#}\n"));
    }

    #[test]
    fn what_a_terminal_would_obey_is_escaped_and_read_again() {
        let json = json!({ "a\u{9b}\u{202e}": "\u{1b}[31m\u{7f}\u{e0001}µ\n\"" });
        let text = text(&json, None);
        assert!(!text.contains(|c| is_obeyed(c) && c != '\n') && text.contains("\\u202e"), "{text:?}");
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), json);
    }
}
