//! Which superelement a page and a JUnit file were written with: the name and the digest that they carry.

use super::html::escaped;

/// What a file that a run wrote says of the superelement of that run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WrittenWith {
    /// It was written.
    Superelement {
        /// Whether that is the one that is asked for, by the name of its file.
        is_named: bool,
        /// Its BLAKE3.
        digest: String,
    },
    /// None was written.
    None,
}

/// Digits of a BLAKE3 digest.
const DIGITS: usize = 64;

impl WrittenWith {
    /// By a report page; none where it is no page of a reduction. `name` is the superelement that is asked for.
    pub fn of_page(page: &str, name: &str) -> Option<Self> {
        let (_, behind) = page.split_once("<header id=\"of-run\">")?;
        let (header, _) = behind.split_once("</header>")?;
        Some(Self::of(header, &format!(">Superelement {}<", escaped(name)), "BLAKE3 "))
    }

    /// By a JUnit file; none where it is none of a reduction.
    pub fn of_junit(xml: &str, name: &str) -> Option<Self> {
        let (_, behind) = xml.split_once("<testsuites name=\"supel\"")?;
        let head = behind.split_once("<testcase").map_or(behind, |(head, _)| head);
        let named = format!("<property name=\"superelement\" value=\"{}\"", escaped(name));
        Some(Self::of(head, &named, "<property name=\"blake3\" value=\""))
    }

    fn of(text: &str, named: &str, mark: &str) -> Self {
        let digest = text.split_once(mark).and_then(|(_, behind)| behind.get(..DIGITS));
        match digest {
            Some(digest) => Self::Superelement { is_named: text.contains(named), digest: digest.to_owned() },
            None => Self::None,
        }
    }
}
