//! The Sturm count against dense spectra, with the interface held and free, at shifts all over the spectrum.

use supel::factor::count_below;
use supel::job::{Coupling, InterfaceJob, NodeSelection};
use supel::partition::Partition;
use supel_models::*;

use crate::component::partition;

fn interface(nodes: NodeSelection) -> InterfaceJob {
    InterfaceJob::new("held", nodes, Coupling::Direct)
}

/// Counts at shifts midway between neighbouring eigenvalues, where both spectra leave a gap.
fn counts_agree(model: &Model, held: NodeSelection, is_held: impl Fn((i64, u8)) -> bool) {
    let partition = partition(model, &[interface(held)]);
    let (free, clamped) = (spectrum(model), spectrum(&transform::supported(model, is_held)));
    let mut all: Vec<f64> = free.iter().chain(&clamped).copied().collect();
    all.sort_by(f64::total_cmp);
    let largest = all[all.len() - 1];
    let mut n_checked = 0;
    // Neighbours nearer than rounding of the dense solution have no middle.
    for pair in all.windows(2).filter(|pair| pair[1] - pair[0] > 1e-10 * largest) {
        let shift = 0.5 * (pair[0] + pair[1]);
        check(&partition, shift, [&free, &clamped]);
        n_checked += 1;
    }
    check(&partition, 2.0 * largest, [&free, &clamped]);
    check(&partition, -1e-3 * largest, [&free, &clamped]);
    assert!(n_checked >= free.len() / 3, "{n_checked} shifts");
}

fn check(partition: &Partition, shift: f64, [free, clamped]: [&[f64]; 2]) {
    let analysis = partition.analysis().expect("an analysis");
    let sigma = shift / partition.scaling.eigenvalue_unit();
    let found = count_below(&analysis, partition.pencil(), sigma).expect("a count");
    let below = |spectrum: &[f64]| spectrum.iter().filter(|lambda| **lambda < shift).count();
    assert_eq!((found.clamped, found.free), (below(clamped), below(free)), "below {shift}");
}

#[test]
fn counts_of_a_brick_with_a_face_as_interface() {
    let model = brick([3, 2, 1], [3.0, 2.0, 1.0], &Material::UNIT);
    let face = model.groups["XMIN"].clone();
    counts_agree(&model, NodeSelection::Group("group:XMIN".to_owned()), |(node, _)| face.contains(&node));
}

#[test]
fn counts_of_a_membrane_with_two_edges_as_interface() {
    let model = membrane([6, 4], [6.0, 4.0], &Material::UNIT);
    let edges: Vec<i64> = model.groups["XMIN"].iter().chain(&model.groups["XMAX"]).copied().collect();
    counts_agree(&model, NodeSelection::Labels(edges.clone()), |(node, _)| edges.contains(&node));
}

#[test]
fn counts_of_chains_with_an_inner_node_as_interface() {
    for model in [bar(40), spring(40, Ends::Free), ring(40, 0.01)] {
        counts_agree(&model, NodeSelection::Rows { rows: vec![17] }, |(node, _)| node == 18);
    }
}

#[test]
fn counts_of_a_frame_with_rotations() {
    let nodes: Vec<[f64; 3]> =
        (0..7).map(|i| [0.3 * f64::from(i), 0.05 * f64::from(i * i), 0.1 * f64::from(i)]).collect();
    let edges: Vec<[usize; 2]> = (0..6).map(|i| [i, i + 1]).collect();
    // A stout section keeps the spectrum within six decades, where the dense solution still resolves it.
    let model = frame(&nodes, &edges, &Section::round(0.1), &Material::STEEL_SI, Inertia::Consistent);
    counts_agree(&model, NodeSelection::Labels(vec![1, 7]), |(node, _)| node == 1 || node == 7);
}
