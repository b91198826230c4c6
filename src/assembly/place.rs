//! Where components are joined, held and loaded.

use supel_runtime::Direction;

/// A node of an interface, or a row of an interface that has no nodes; or some directions of a node.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// Number of the component.
    pub(super) component: usize,
    /// What messages call it: `a.hub`, or `a.hub.17` where the interface has several nodes.
    pub(super) name: String,
    /// Where it is; rows are nowhere.
    pub(super) position: Option<[f64; 3]>,
    /// Its axes.
    pub(super) frame: Option<[[f64; 3]; 3]>,
    /// Its number among the interface nodes of the component, where all of its directions are meant; none for a row.
    pub(super) whole: Option<usize>,
    /// Its directions with the numbers of their coordinates in the assembly before anything is joined; a row has none.
    pub(super) dofs: Vec<(Option<Direction>, usize)>,
}

impl Place {
    /// Its directions in words.
    pub(super) fn directions(&self) -> String {
        let words: Vec<String> =
            self.dofs.iter().filter_map(|(direction, _)| direction.map(|d| d.to_string())).collect();
        words.join(" ")
    }

    /// The coordinate of a direction.
    pub(super) fn coordinate(&self, direction: Option<Direction>) -> Option<usize> {
        self.dofs.iter().find(|(own, _)| *own == direction).map(|(_, coordinate)| *coordinate)
    }
}
