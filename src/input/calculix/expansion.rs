//! `JOB.12d`: which nodes of solids CalculiX made of each node of shells and beams.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use crate::error::{Error, Result};
use crate::input::Allowance;
use crate::input::banner::excerpt;
use crate::input::mesh::stream::Stream;

/// Bytes that a node takes.
const NODE: u64 = 128;

/// What CalculiX made of the elements of a deck.
#[derive(Debug, Default)]
pub(super) struct Expansion {
    /// The nodes that were made of each node of the deck.
    pub(super) made_of: BTreeMap<i64, BTreeSet<i64>>,
    /// Elements that became solids with incompatible modes.
    pub(super) n_incompatible: usize,
}

/// Where the nodes of a solid stand that come of each node of a shell or beam, from zero.
type Places = &'static [&'static [usize]];

const OF_3_IN_6: Places = &[&[0, 3], &[1, 4], &[2, 5]];
const OF_4_IN_8: Places = &[&[0, 4], &[1, 5], &[2, 6], &[3, 7]];
const OF_6_IN_15: Places = &[&[0, 12, 3], &[1, 13, 4], &[2, 14, 5], &[6, 9], &[7, 10], &[8, 11]];
const OF_8_IN_20: Places =
    &[&[0, 16, 4], &[1, 17, 5], &[2, 18, 6], &[3, 19, 7], &[8, 12], &[9, 13], &[10, 14], &[11, 15]];
const OF_2_IN_8: Places = &[&[0, 3, 7, 4], &[1, 2, 6, 5]];
const OF_3_IN_20: Places = &[&[0, 3, 7, 4, 11, 19, 15, 16], &[8, 10, 14, 12], &[1, 2, 6, 5, 9, 18, 13, 17]];

impl Expansion {
    /// Reads the file at `path`.
    ///
    /// # Errors
    /// [`Error::MeshText`] where an element is not what CalculiX writes; those of reading.
    pub(super) fn read(path: &Path, allowance: &Allowance) -> Result<Self> {
        const NODES: &str = "labels of nodes";
        let claim = allowance.claim(path);
        let mut stream = Stream::open(path)?;
        let mut expansion = Self::default();
        while let Some(line) = stream.rest_of_line()? {
            if !line.starts_with(b"ELEMENT") || !line.ends_with(b"with nodes:") {
                continue;
            }
            let (own, next) = labels(&mut stream, NODES)?;
            let text = String::from_utf8_lossy(&next).into_owned();
            let solid = text.split('"').nth(1).filter(|_| text.starts_with("is expanded into"));
            let Some(solid) = solid else {
                return Err(stream.error(format!("`{}`", excerpt(&next)), "is expanded into a \"TYPE\" element"));
            };
            let (made, _) = labels(&mut stream, NODES)?;
            let Some(places) = places(own.len(), made.len()) else {
                let found = format!("an element of {} nodes made of one of {}", made.len(), own.len());
                return Err(stream.error(found, "a solid as one layer of a shell, or as a beam, becomes"));
            };
            claim.add(NODE * made.len() as u64)?;
            for (label, places) in own.iter().zip(places) {
                expansion.made_of.entry(*label).or_default().extend(places.iter().map(|place| made[*place]));
            }
            expansion.n_incompatible += usize::from(solid.starts_with("C3D8I"));
        }
        Ok(expansion)
    }
}

/// Labels on the lines to come, and the first line that has something else.
fn labels(stream: &mut Stream, expected: &str) -> Result<(Vec<i64>, Vec<u8>)> {
    /// More nodes than an element has.
    const MAX_LABELS: usize = 64;
    let mut found = Vec::new();
    loop {
        let line = stream.rest_of_line()?.unwrap_or_default();
        let text = String::from_utf8_lossy(&line);
        let labels: Option<Vec<i64>> = text.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
        match labels {
            Some(labels) if !labels.is_empty() && found.len() <= MAX_LABELS => found.extend(labels),
            _ if found.is_empty() => {
                return Err(Error::MeshText {
                    path: stream.path().to_owned(),
                    line: stream.line() - 1,
                    found: format!("`{}`", excerpt(&line)),
                    expected: expected.to_owned(),
                });
            }
            _ => return Ok((found, line)),
        }
    }
}

fn places(n_own: usize, n_made: usize) -> Option<Places> {
    Some(match (n_own, n_made) {
        (3, 6) => OF_3_IN_6,
        // The last three nodes of a C3D8I are those of its incompatible modes.
        (4, 8 | 11) => OF_4_IN_8,
        (6, 15) => OF_6_IN_15,
        (8, 20) => OF_8_IN_20,
        (2, 8 | 11) => OF_2_IN_8,
        (3, 20) => OF_3_IN_20,
        _ => return None,
    })
}
