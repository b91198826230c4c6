//! Keyword lines: `*ELEMENT, TYPE=C3D10, ELSET=part`.

use crate::input::banner::excerpt;

/// A keyword with its parameters. Blanks and case count neither in the keyword nor in names of parameters.
#[derive(Debug, Default)]
pub(super) struct Keyword {
    /// In capitals, without blanks and asterisk: `ENDPART`.
    pub(super) name: String,
    parameters: Vec<(String, String)>,
}

impl Keyword {
    /// Of a whole line, with the lines that continue it.
    pub(super) fn of(line: &[u8]) -> Self {
        let text = String::from_utf8_lossy(line);
        let mut parts = split_outside_quotes(&text);
        let name = squeezed(parts.next().unwrap_or_default().trim_start_matches('*'));
        let parameter = |part: &str| {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            (squeezed(name), unquoted(value).to_owned())
        };
        let parameters = parts.filter(|part| !part.trim().is_empty()).map(parameter).collect();
        Self { name, parameters }
    }

    /// The value of a parameter; empty where it has none.
    pub(super) fn parameter(&self, name: &str) -> Option<&str> {
        self.parameters.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// The value of a parameter that has one.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        self.parameter(name).filter(|value| !value.is_empty())
    }

    /// For a message: the keyword as it is read.
    pub(super) fn shown(&self) -> String {
        excerpt(format!("*{}", self.name).as_bytes())
    }
}

/// In capitals and without blanks.
fn squeezed(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace()).map(|c| c.to_ascii_uppercase()).collect()
}

/// Without blanks and quotation marks around it.
pub(super) fn unquoted(text: &str) -> &str {
    let text = text.trim();
    text.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(text)
}

/// Parts between commas that stand in no quotation.
pub(super) fn split_outside_quotes(text: &str) -> impl Iterator<Item = &str> {
    let mut is_quoted = false;
    text.split(move |c: char| {
        is_quoted ^= c == '"';
        c == ',' && !is_quoted
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keywords_and_parameters() {
        let keyword = Keyword::of(b"*Shell Section, elset = \"my, set\" ,OFFSET=0., Nodal Thickness,");
        assert_eq!(keyword.name, "SHELLSECTION");
        assert_eq!((keyword.value("ELSET"), keyword.value("OFFSET")), (Some("my, set"), Some("0.")));
        assert_eq!((keyword.parameter("NODALTHICKNESS"), keyword.value("NODALTHICKNESS")), (Some(""), None));
        assert_eq!((keyword.parameter("MATERIAL"), keyword.shown().as_str()), (None, "*SHELLSECTION"));
    }
}
