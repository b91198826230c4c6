//! Sound models, however thin, slender, held or movable, are not suspected.

use supel::error::Error;
use supel::model::{CoordinateFit, Model as Checked};
use supel_models::transform::{grounded, join, supported, translated};
use supel_models::{Ends, Inertia, Material, Model, Section, brick, frame, membrane, spring};

use crate::chain::input;
use crate::{Ties, compared};

fn fit(model: &Model) -> Result<CoordinateFit, Error> {
    Ok(compared(Checked::new(input(model))?, Ties::All)?.fit)
}

/// A block whose last layer turns about an edge of the rest.
fn hinged(block: &Model) -> Model {
    let size = block.nodes.last().expect("a node");
    let edge: Vec<(i64, i64)> = block.groups["XMAX"]
        .iter()
        .filter(|label| block.nodes[**label as usize - 1][1] == size[1])
        .map(|label| {
            let [_, _, z] = block.nodes[*label as usize - 1];
            let partner = block.labels.iter().find(|other| block.nodes[**other as usize - 1] == [0.0, 0.0, z]);
            (*label, *partner.expect("the edge of the other"))
        })
        .collect();
    join(block, &translated(block, [size[0], size[1], 0.0]), &edge)
}

#[test]
fn sound_models_are_not_suspected() {
    let block = brick([4, 3, 2], [1.2, 0.55, 0.31], &Material::STEEL_SI);
    let plate = brick([24, 24, 1], [1.0, 1.0, 1e-3], &Material::STEEL_SI);
    let bar = brick([100, 1, 1], [100.0, 0.1, 0.1], &Material::UNIT);
    let nodes: Vec<[f64; 3]> = (0..40).map(|k| [25.0 * f64::from(k), 0.0, 3e5]).collect();
    let edges: Vec<[usize; 2]> = (0..39).map(|k| [k, k + 1]).collect();
    let beam = frame(&nodes, &edges, &Section::round(1.0), &Material::UNIT, Inertia::Consistent);
    let first = |(label, _): (i64, u8)| label == 1;
    let on_edge = |model: &Model| {
        let edge = model.groups["XMIN"].clone();
        supported(model, move |(label, _)| edge.contains(&label))
    };
    let largest = block.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2));
    for (name, model) in [
        ("block", block.clone()),
        ("plate 1:1000", plate.clone()),
        ("clamped plate 1:1000", on_edge(&plate)),
        ("bar 1:1000", bar.clone()),
        ("clamped bar 1:1000", on_edge(&bar)),
        ("beam 1:1000, far from the origin", beam.clone()),
        ("clamped beam 1:1000", supported(&beam, first)),
        ("beam held in its bending rotations and one direction", supported(&beam, |(l, d)| l == 1 && d != 0 && d != 3)),
        ("block on a spherical joint", supported(&block, first)),
        ("block on a symmetry plane", supported(&block, |(label, d)| d == 0 && label % 5 == 1)),
        ("block on one spring", grounded(&block, 0, largest)),
        ("block on one weak spring", grounded(&block, 0, 1e-6 * largest)),
        ("hinged blocks", hinged(&block)),
        ("hinged blocks on a spherical joint", supported(&hinged(&block), first)),
        ("two blocks, one of them clamped", join(&block, &on_edge(&block), &[])),
        ("membrane", membrane([6, 4], [3.0, 2.0], &Material::UNIT)),
        ("chain", spring(9, Ends::Free)),
        ("held chain", spring(9, Ends::Fixed)),
    ] {
        let fit = fit(&model).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(matches!(fit, CoordinateFit::Exact), "{name}: {fit:?}");
    }
}

/// Motions by coordinates of few digits, mended with what K knows, cost no more than those by all digits. On a hinge those of four digits
/// are refused where patches need them.
#[test]
fn rounded_coordinates_are_mended() {
    let size = [8.0 / 7.0, 3.0 / 7.0, 2.0 / 7.0];
    let exact = brick([4, 3, 2], size, &Material::STEEL_SI);
    let hinge = |model: &Model| supported(model, |(label, _)| label == 1 || label == 6);
    for (name, sound, n_free) in [("free", exact.clone(), 6), ("on a hinge", hinge(&exact), 1)] {
        for digits in [12, 8, 5, 4] {
            let mut model = sound.clone();
            let round = |value: &mut f64| *value = format!("{value:.*e}", digits - 1).parse().expect("a number");
            model.nodes.iter_mut().flatten().for_each(round);
            let checked =
                compared(Checked::new(input(&model)).expect("a model"), Ties::None).expect("rounded coordinates");
            let CoordinateFit::Rounded(rounded) = &checked.fit else { panic!("{name}, {digits} digits") };
            let (forces, terms) = supel::sparse::product_and_terms(&checked.stiffness, rounded.motions.as_ref());
            // The combinations of the six motions of least force: as many as K lets pass.
            let energy = supel::dense::gram(rounded.motions.as_ref(), forces.as_ref());
            let n = rounded.motions.nrows();
            let size = |j: usize| (0..n).map(|i| rounded.motions[(i, j)].abs() * terms[(i, j)]).sum::<f64>();
            let d: Vec<f64> = (0..6).map(|j| 1.0 / size(j).sqrt()).collect();
            let scaled = faer::Mat::from_fn(6, 6, |i, j| 0.5 * (energy[(i, j)] + energy[(j, i)]) * d[i] * d[j]);
            let (values, _) = supel::dense::symmetric_eigen(scaled.as_ref()).expect("values");
            // Zero modes of inverse iteration are right to rounding of their terms, some tens of them in a row.
            let zero = values.iter().filter(|value| value.abs() < 100.0 * f64::EPSILON).count();
            assert_eq!(zero, n_free, "{name}, {digits} digits: {values:?}");
        }
    }
}
