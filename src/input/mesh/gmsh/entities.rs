//! Physical groups: their names, and in version 4 the entities that belong to them.

use std::collections::HashMap;

use crate::error::Result;
use crate::input::allowance::Claim;
use crate::input::banner::excerpt;
use crate::input::mesh::stream::{Form, Stream};

/// Bytes that a group of an entity takes.
const GROUP: u64 = 64;

/// What is known of physical groups.
#[derive(Debug, Default)]
pub(super) struct Physical {
    /// Names by dimension and number.
    names: HashMap<(u8, i64), String>,
    /// Numbers of groups by the dimension and number of an entity.
    of_entity: HashMap<(u8, i64), Vec<i64>>,
}

impl Physical {
    /// `$PhysicalNames`, which are text in binary files too.
    pub(super) fn read_names(&mut self, stream: &mut Stream, claim: &Claim<'_>) -> Result<()> {
        let form = std::mem::replace(&mut stream.form, Form::Text);
        let n = count(stream, "the number of physical names")?;
        for _ in 0..n {
            const EXPECTED: &str = "dimension, number and name in quotation marks";
            let dimension = stream.int(EXPECTED)?;
            let number = stream.int(EXPECTED)?;
            let rest = stream.next_line(EXPECTED)?;
            let text = String::from_utf8_lossy(&rest);
            let name = text.strip_prefix('"').and_then(|name| name.strip_suffix('"')).filter(|name| !name.is_empty());
            let (Some(name), Ok(dimension @ 0..=3)) = (name, u8::try_from(dimension)) else {
                return Err(stream.error(format!("`{}`", excerpt(&rest)), EXPECTED));
            };
            claim.add(GROUP + name.len() as u64)?;
            self.names.insert((dimension, number), name.to_owned());
        }
        stream.form = form;
        Ok(())
    }

    /// `$Entities` of version 4.1.
    pub(super) fn read_entities(&mut self, stream: &mut Stream, claim: &Claim<'_>) -> Result<()> {
        const EXPECTED: &str = "the entities of the geometry";
        let mut counts = [0; 4];
        for count in &mut counts {
            let number = stream.long(EXPECTED)?;
            *count = stream.count(number, EXPECTED)?;
        }
        for (dimension, n) in (0..).zip(counts) {
            for _ in 0..n {
                let tag = stream.int(EXPECTED)?;
                // A point has a place, everything else a box around it, which may be empty.
                for _ in 0..if dimension == 0 { 3 } else { 6 } {
                    stream.any_real(EXPECTED)?;
                }
                let number = stream.long(EXPECTED)?;
                for _ in 0..stream.count(number, EXPECTED)? {
                    // The sign is an orientation.
                    let group = stream.int(EXPECTED)?.saturating_abs();
                    claim.add(GROUP)?;
                    self.of_entity.entry((dimension, tag)).or_default().push(group);
                }
                if dimension > 0 {
                    let number = stream.long(EXPECTED)?;
                    for _ in 0..stream.count(number, EXPECTED)? {
                        stream.int(EXPECTED)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// The groups of an entity.
    pub(super) fn of_entity(&self, dimension: u8, tag: i64) -> &[i64] {
        self.of_entity.get(&(dimension, tag)).map_or(&[], Vec::as_slice)
    }

    /// The name of a group.
    pub(super) fn name(&self, dimension: u8, number: i64) -> String {
        let own = || format!("{} {number}", kind_of(dimension));
        self.names.get(&(dimension, number)).cloned().unwrap_or_else(own)
    }
}

/// What groups of a dimension are called.
pub(super) fn kind_of(dimension: u8) -> &'static str {
    ["point", "curve", "surface", "volume"][usize::from(dimension.min(3))]
}

/// A count that stands alone as text.
pub(super) fn count(stream: &mut Stream, expected: &str) -> Result<u64> {
    let form = std::mem::replace(&mut stream.form, Form::Text);
    let number = stream.int(expected)?;
    let count = stream.count(number, expected)?;
    stream.form = form;
    Ok(count)
}
