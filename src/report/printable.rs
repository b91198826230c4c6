//! Text from elsewhere, made safe to show: names and paths from jobs, meshes and superelements may hold characters that move the
//! cursor, colour, hide or rearrange the words around them, or begin a line of their own.
//!
//! Every output passes through here once, where it is put together: lines of [`Page`](super::page::Page), elements of the page for
//! people, cases of JUnit, lines on stderr, and all JSON documents.

use std::borrow::Cow;
use std::fmt::Write;

use serde::Serialize;
use serde_json::Value;

use crate::error::{Error, Result};

/// The text with every character that is not shown as itself written as `\u{1b}`, `\n` and the like.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(acts_on_its_surroundings) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for character in text.chars() {
        match character {
            _ if !acts_on_its_surroundings(character) => shown.push(character),
            '\n' | '\r' | '\t' => shown.extend(character.escape_default()),
            _ => shown.extend(character.escape_unicode()),
        }
    }
    Cow::Owned(shown)
}

/// A name as a field of a table, printable: in quotation marks where a table would take it for something else.
pub(crate) fn field(name: &str) -> Cow<'_, str> {
    let name = printable(name);
    if is_plain_field(&name) { name } else { Cow::Owned(format!("\"{}\"", name.replace('"', "\"\""))) }
}

/// Whether a table takes a printable name for what it is: not for several columns, a comment or a text in quotation marks.
pub(crate) fn is_plain_field(name: &str) -> bool {
    !name.contains([',', ';', '\t', '"', '#', '%']) && name.trim() == name
}

/// A JSON document, indented and with a line end; what JSON leaves as it is but [`printable`] does not is escaped the way of JSON, which
/// changes no value. `what` is what an error calls it.
///
/// # Errors
/// [`Error::NotJson`] where a path in it is not UTF-8.
pub(crate) fn json_text(what: &'static str, document: &impl Serialize) -> Result<String> {
    let text = serde_json::to_string_pretty(document).map_err(|source| Error::NotJson { what, source })?;
    Ok(escaped(text + "\n"))
}

/// A JSON value as [`json_text`] writes documents. A value has no part that JSON cannot hold.
pub(crate) fn value_text(value: &Value) -> String {
    escaped(format!("{value:#}\n"))
}

fn escaped(text: String) -> String {
    if !text.contains(acts_in_json) {
        return text;
    }
    let mut safe = String::with_capacity(text.len() + 64);
    for character in text.chars() {
        if acts_in_json(character) {
            let mut units = [0; 2];
            character.encode_utf16(&mut units).iter().for_each(|unit| {
                let _ = write!(safe, "\\u{unit:04x}");
            });
        } else {
            safe.push(character);
        }
    }
    safe
}

/// What JSON has not escaped itself; its own line ends stay.
fn acts_in_json(character: char) -> bool {
    character != '\n' && acts_on_its_surroundings(character)
}

/// Control characters of both sets, line separators, characters that turn the direction of writing, join or are not shown at all,
/// tags, those for private use, and what
/// XML does not allow.
fn acts_on_its_surroundings(character: char) -> bool {
    character.is_control()
        || matches!(character,
            '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}' | '\u{180b}'..='\u{180f}'
            | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{2800}' | '\u{3164}'
            | '\u{e000}'..='\u{f8ff}' | '\u{fe00}'..='\u{fe0f}' | '\u{ffa0}'
            | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{fffe}' | '\u{ffff}' | '\u{e0000}'..='\u{10ffff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_acts_is_written_out_and_the_rest_stays() {
        assert_eq!(printable("Δx – 12 µm, naïve, 軸, 🔩"), "Δx – 12 µm, naïve, 軸, 🔩");
        assert_eq!(printable("hu\u{ad}b\u{3164}\u{e000}"), "hu\\u{ad}b\\u{3164}\\u{e000}");
        assert_eq!(printable("\x1b[2J\x1b[H✓\u{9b}8m\u{202e}\0\n"), "\\u{1b}[2J\\u{1b}[H✓\\u{9b}8m\\u{202e}\\u{0}\\n");
    }

    #[test]
    fn a_json_document_keeps_its_values() {
        let text = "a\u{7f}\u{9b}\u{202e}\u{e0041}\u{1b}\n";
        let document = value_text(&serde_json::json!({ "name": text }));
        assert!(!document.trim_end().contains(|c: char| c != '\n' && acts_on_its_surroundings(c)), "{document:?}");
        let read: Value = serde_json::from_str(&document).expect("JSON");
        assert_eq!(read["name"], text);
    }
}
