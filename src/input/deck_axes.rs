//! The axes of nodes as the decks of a model state them: the deck of the dof map, and those of its matrices.
//!
//! A GRID entry says along which axes the rows of its node are, and those of a model are along one set of axes, in whichever of its decks the
//! entries stand. Nodes that a deck does not list, as a punch file of matrices alone, are as the others say.

use std::collections::BTreeMap;
use std::path::Path;

use super::node_frames::NodeFrames;
use crate::dofs::{Axes, DofMap};
use crate::error::{Error, Result};
use crate::sparse::Turning;

/// Components by which two decks may state the same direction: five decimals, the fewest that axes may have, leave half a unit of the last
/// one open in either, and making them orthogonal doubles that at most.
const SAME: f64 = 2e-5;

const ALONG_THE_MODEL: Axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

impl NodeFrames {
    /// What is stated of a node.
    fn stated(&self, node: i64) -> Option<&Axes> {
        self.axes.get(&node).or_else(|| self.along_model.contains(&node).then_some(&ALONG_THE_MODEL))
    }

    /// The first node of which others state other axes.
    pub(super) fn differing(&self, others: &Self) -> Option<i64> {
        let differs = |(node, axes): (i64, &Axes)| {
            let pairs = others.stated(node)?.as_flattened().iter().zip(axes.as_flattened());
            pairs.map(|(a, b)| (a - b).abs()).any(|off| off > SAME).then_some(node)
        };
        let along_model = self.along_model.iter().map(|node| (*node, &ALONG_THE_MODEL));
        self.axes.iter().map(|(node, axes)| (*node, axes)).chain(along_model).filter_map(differs).min()
    }

    /// Refuses others that state other axes of a node.
    ///
    /// # Errors
    /// [`Error::FrameDiffer`].
    pub(super) fn check_agree(&self, others: &Self) -> Result<()> {
        let Some(node) = self.differing(others) else { return Ok(()) };
        let along = |frames: &Self| frames.stated(node).map_or_else(String::new, words);
        Err(Error::FrameDiffer {
            paths: [self.place.0.clone(), others.place.0.clone()],
            node,
            along: [along(self), along(others)],
        })
    }
}

fn words(axes: &Axes) -> String {
    match *axes == ALONG_THE_MODEL {
        true => "along the axes of the model".to_owned(),
        false => {
            let [x, y, _] = axes.map(|axis| axis.map(|value| format!("{value:.4}")).join(","));
            format!("along x = {x} and y = {y}")
        }
    }
}

/// What decks state together, none where none lists nodes. The file of the first that has nodes with axes of their own stands for all.
///
/// # Errors
/// [`Error::FrameDiffer`].
pub(super) fn together(decks: Vec<NodeFrames>) -> Result<Option<NodeFrames>> {
    for (at, deck) in decks.iter().enumerate() {
        decks[..at].iter().try_for_each(|earlier| earlier.check_agree(deck))?;
    }
    let first = decks.iter().position(|deck| !deck.axes.is_empty()).unwrap_or(0);
    let mut decks = decks;
    if decks.is_empty() {
        return Ok(None);
    }
    let mut all = decks.swap_remove(first);
    for deck in decks {
        for (node, axes) in deck.axes {
            all.axes.entry(node).or_insert(axes);
        }
        all.along_model.extend(deck.along_model);
    }
    Ok(Some(all))
}

/// The axes of the nodes of a model as its rows were turned; the file of its stiffness stands for it.
pub(super) fn of_model(stiffness: &Path, dofs: &DofMap, turning: Option<&Turning>) -> NodeFrames {
    let node = |row: u32| dofs[row as usize].map(|dof| dof.node);
    let blocks = turning.iter().flat_map(|turning| turning.blocks());
    let axes: BTreeMap<i64, Axes> = blocks.filter_map(|(rows, axes)| Some((node(rows[0])?, *axes))).collect();
    let along_model = dofs.iter().flatten().map(|dof| dof.node).filter(|node| !axes.contains_key(node)).collect();
    NodeFrames { axes, along_model, rounded: BTreeMap::new(), place: (stiffness.to_owned(), 1) }
}
