//! Surfaces that name elements without a face: all faces that no other of these elements has.

use std::collections::HashMap;

use super::scope::ElementList;

/// Labels of the nodes on the free faces of elements.
pub(super) fn free_faces(list: &ElementList, elements: &[u32]) -> Vec<i64> {
    let mut faces: HashMap<Vec<i64>, usize> = HashMap::new();
    for element in elements {
        let at = *element as usize;
        let nodes = list.nodes_of(at);
        for places in list.types[at].all_faces() {
            let mut face: Vec<i64> = places.iter().filter_map(|place| nodes.get(*place)).copied().collect();
            face.sort_unstable();
            *faces.entry(face).or_default() += 1;
        }
    }
    let mut labels: Vec<i64> = faces.into_iter().filter(|(_, n)| *n == 1).flat_map(|(face, _)| face).collect();
    labels.sort_unstable();
    labels.dedup();
    labels
}
