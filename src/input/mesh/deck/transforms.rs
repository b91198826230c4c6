//! `*TRANSFORM`: the axes along which displacements of the nodes of a set are.
//!
//! ```text
//! *TRANSFORM, NSET=set, TYPE=R    x towards a, y towards b as far as it is across
//!                       TYPE=C    radial, tangential, along the line from a to b
//!                       TYPE=S    radial, about the line from a to b, towards b
//! xa, ya, za, xb, yb, zb
//! ```

use std::collections::{BTreeMap, BTreeSet};

use super::keyword::Keyword;
use super::lines::{DeckLines, Place};
use super::sections::{data_line, numbers, wrong_line};
use crate::dofs::{Axes, Nodes, cross, spanned};
use crate::error::{Error, Result};
use crate::input::banner::excerpt;
use crate::input::in_line::Off;
use crate::input::local_system::{LocalSystem, SystemKind};
use crate::input::node_frames::NodeFrames;

/// One `*TRANSFORM`.
#[derive(Debug)]
pub(super) struct Transform {
    place: Place,
    /// The set, or the label of a node.
    set: String,
    kind: SystemKind,
    /// a and b.
    points: [[f64; 3]; 2],
}

impl Transform {
    /// Reads the data below the keyword.
    pub(super) fn read(lines: &mut DeckLines, keyword: &Keyword) -> Result<Self> {
        let place = lines.place();
        let kind = match keyword.value("TYPE").map(str::to_ascii_uppercase).as_deref() {
            None | Some("R") => SystemKind::Rectangular,
            Some("C") => SystemKind::Cylindrical,
            Some("S") => SystemKind::Spherical,
            Some(other) => return Err(lines.error(format!("TYPE={other} of *TRANSFORM"), "TYPE=R, C or S")),
        };
        let Some(set) = keyword.value("NSET").map(str::to_owned) else {
            return Err(lines.error(keyword.shown(), "the nodes, NSET=NAME"));
        };
        let mut points = [[0.0; 3]; 2];
        let data = data_line(lines)?.map(|line| numbers(line).filter(|numbers| numbers.len() <= 7));
        match data {
            Some(Some(numbers)) => {
                points.as_flattened_mut().iter_mut().zip(numbers).for_each(|(component, number)| *component = number);
            }
            Some(None) => return Err(wrong_line(lines, "two points, six finite numbers")),
            None => return Err(lines.error_at(place, "nothing below *TRANSFORM", "two points, six finite numbers")),
        }
        Ok(Self { place, set, kind, points })
    }

    /// The axes of a node at a point; none where the two points give none.
    fn axes_at(&self, point: [f64; 3]) -> Option<Axes> {
        let [a, b] = self.points;
        let off = Off::of_text(self.points.as_flattened());
        if self.kind == SystemKind::Rectangular {
            return off.spanned(a, b);
        }
        let line: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
        if !off.tells(line) {
            return None;
        }
        // Any direction across the line: the axis of the model that is farthest from it leaves most.
        let least = (0..3).min_by(|i, j| line[*i].abs().total_cmp(&line[*j].abs()))?;
        let x = cross(line, std::array::from_fn(|i| f64::from(u8::from(i == least))));
        let axes = LocalSystem::new(self.kind, a, spanned(x, cross(line, x))?).axes_at(point);
        Some(match self.kind {
            SystemKind::Spherical => [axes[0], axes[2], axes[1].map(|component| -component)],
            SystemKind::Rectangular | SystemKind::Cylindrical => axes,
        })
    }
}

/// The axes of the nodes of a deck that have their own; none where it gives none. Those of decks with parts, of which no nodes are given,
/// have no nodes: a set may be that of any instance.
pub(super) fn frames(lines: &DeckLines, transforms: &[Transform], nodes: Option<&Nodes>) -> Result<Option<NodeFrames>> {
    let Some(first) = transforms.first() else { return Ok(None) };
    let mut axes = BTreeMap::new();
    for (transform, nodes) in transforms.iter().zip(nodes.into_iter().cycle()) {
        let members = members(nodes, &transform.set);
        if members.is_empty() {
            let found = format!("*TRANSFORM of {}, which has no nodes", excerpt(transform.set.as_bytes()));
            return Err(lines.error_at(transform.place, found, "a set of nodes of the deck, or the label of one"));
        }
        for node in members {
            let own = transform.axes_at(nodes.coordinates[node]).ok_or_else(|| {
                let [a, b] = transform.points;
                let (path, line) = lines.at(transform.place);
                Error::FrameAxes { path, line, found: format!("*TRANSFORM by {a:?} and {b:?}, which give no axes") }
            })?;
            axes.insert(nodes.labels[node], own);
        }
    }
    Ok(Some(NodeFrames { axes, along_model: BTreeSet::new(), rounded: BTreeMap::new(), place: lines.at(first.place) }))
}

/// The nodes of a set, whatever the case of its name, or the one of this label.
fn members(nodes: &Nodes, set: &str) -> Vec<usize> {
    let named =
        nodes.groups.iter().find(|(name, _)| name.eq_ignore_ascii_case(set)).map(|(_, members)| members.clone());
    let labelled = || set.parse().ok().and_then(|label: i64| nodes.labels.iter().position(|known| *known == label));
    named.unwrap_or_else(|| labelled().into_iter().collect())
}
