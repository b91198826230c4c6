//! From finite element files to the superelement of a variant.

use supel_models::{spectrum, transform};
use supel_runtime::{Direction, Matrix, Superelement};
use validation::examples::spherical;
use validation::part::reduced;
use validation::selection::{Modes, selected};

fn rich(folder: &std::path::Path) -> Superelement {
    reduced(&spherical::parts()[0].write(folder).expect("written")).expect("verified")
}

#[test]
fn clamped_modes_of_the_superelement_are_those_of_the_beam() {
    let folder = tempfile::tempdir().expect("folder");
    let rich = rich(folder.path());
    let clamped = selected(&rich, Modes::Held { node: 0, count: 12 }).expect("12 modes");
    let model = transform::supported(&spherical::parts()[0].model, |(label, _)| label == 1);
    let exact = spectrum(&model);
    let last = rich.tensors().frequencies.last().expect("80 modes");
    for (found, lambda) in clamped.tensors().frequencies.iter().zip(&exact) {
        // Free modes up to ω_last with exact static modes leave (ω/ω_last)⁴, from above. Both dense decompositions round in
        // proportion to their largest eigenvalue, some 1e8 times the lowest here.
        let (error, rounding) = (found / lambda.sqrt() - 1.0, 1e-8);
        assert!(error.abs() < (found / last).powi(4) + rounding, "{found} for {}", lambda.sqrt());
        assert!(error > -rounding, "{found} below {}", lambda.sqrt());
    }
}

#[test]
fn without_modes_it_is_the_superelement_of_static_modes() {
    let folder = tempfile::tempdir().expect("folder");
    let guyan = selected(&rich(folder.path()), Modes::Free(0)).expect("no modes");
    let job = folder.path().join("job.toml");
    let text = std::fs::read_to_string(&job).expect("job");
    let text = text.replace("herting", "craig-bampton").replace("count = 80", "count = 0");
    std::fs::write(&job, text).expect("written");
    let direct = reduced(&job).expect("verified");
    assert_eq!(direct.n_coordinates(), guyan.n_coordinates());
    for (found, expected) in
        [(&guyan.tensors().stiffness, &direct.tensors().stiffness), (&guyan.tensors().mass, &direct.tensors().mass)]
    {
        // The same static modes, multiplied in another order: rounding of sums of 300 terms, on the diagonal's scale.
        let scale = |m: &Matrix, i: usize, j: usize| (m[(i, i)] * m[(j, j)]).sqrt();
        for (i, j) in (0..12).flat_map(|i| (0..12).map(move |j| (i, j))) {
            let difference = (found[(i, j)] - expected[(i, j)]).abs();
            assert!(difference <= 1e-12 * scale(expected, i, j), "({i}, {j}): {difference:e}");
        }
    }
    assert!(guyan.metadata().interface_nodes.iter().all(|node| node.dofs == Direction::ALL));
}
