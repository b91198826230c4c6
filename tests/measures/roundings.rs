//! The bound on what roundings of K make of an energy, against roundings.

use supel::input::{Digits, Input, MatrixInput};
use supel::job::InterfaceJob;
use supel::model::Model;
use supel::partition::Partition;
use supel::sparse::product;
use supel::{dense, sparse::SparseMatrix};
use supel_models::transform::{rounded, scaled};
use supel_models::{Family, Material, Part, brick};

use crate::chain::{Method, direct, input, reduce, rigid_group};

const DIGITS: u32 = 8;
/// Factors on K, each of which rounds all its entries anew.
const SAMPLES: usize = 40;

fn partition(model: &supel_models::Model, interfaces: &[InterfaceJob], digits: u32) -> Partition {
    let input = input(model);
    let known = Digits { significant: digits, ..Digits::DOUBLE };
    let of = |matrix: MatrixInput| MatrixInput { digits: known, ..matrix };
    let input = Input { stiffness: of(input.stiffness), mass: of(input.mass), ..input };
    Partition::new(Model::new(input).expect("sound"), interfaces).expect("interfaces")
}

/// xᵀKx of each column in user units.
fn energies(k: &SparseMatrix, unit: f64, x: faer::MatRef<'_, f64>) -> Vec<f64> {
    dense::dots(x, product(k, x).as_ref()).iter().map(|energy| energy * unit).collect()
}

/// Roundings of the entries are independent, but for entries that are alike: a regular mesh has each number at many places, a
/// block of tetrahedra at few. The bound of a chance of 10⁻¹² is 7.5 standard deviations, and the largest of 40 samples is
/// between two and three of them.
#[test]
fn noise_of_energies_is_a_bound_and_no_more_than_ten_times_what_roundings_make() {
    let beam = brick([10, 2, 2], [10.0, 1.1, 0.9], &Material::UNIT);
    let block = Part::new(Family::Bulky, 700).model;
    for (name, model, interfaces) in [
        ("beam held by nodes", &beam, vec![direct("ends", &[1, 12, 34, 99])]),
        ("beam between rigid faces", &beam, vec![rigid_group("XMIN"), rigid_group("XMAX")]),
        ("block between rigid faces", &block, vec![rigid_group("BASE"), rigid_group("TIP")]),
    ] {
        let modes = reduce(model, &interfaces, Method::Herting, 6).expect("modes").modes;
        let x = modes.shapes.as_ref();
        let (mut largest, mut bounds) = (vec![0.0f64; x.ncols()], vec![0.0f64; x.ncols()]);
        for sample in 0..SAMPLES {
            let factor = 1.0 + 9.0 * (0.618_033_988_749_895 * (sample as f64 + 0.5)).fract();
            let exact = scaled(model, factor, 1.0);
            let few = partition(&rounded(&exact, DIGITS as usize), &interfaces, DIGITS);
            let exact = partition(&exact, &interfaces, 17);
            let [exact, found] = [&exact, &few].map(|p| energies(&p.stiffness, p.scaling.stiffness_unit(), x));
            let noise = few.energy_noise(x);
            for j in 0..x.ncols() {
                let off = (found[j] - exact[j]).abs() / factor;
                let bound = noise[j] * few.scaling.stiffness_unit() / factor;
                assert!(off <= bound, "{name}, mode {j}, factor {factor}: {off:e} of {bound:e}");
                (largest[j], bounds[j]) = (largest[j].max(off), bounds[j].max(bound));
            }
        }
        for (j, (largest, bound)) in largest.iter().zip(bounds).enumerate() {
            assert!(bound <= 10.0 * largest, "{name}, mode {j}: {bound:e} for {largest:e}");
        }
    }
}

/// The bound of an energy is that of the motion of every row: a rigid face moves as the interface node says.
#[test]
fn noise_of_a_rigid_face_is_that_of_its_rows() {
    let model = rounded(&brick([6, 2, 2], [6.0, 1.1, 0.9], &Material::UNIT), DIGITS as usize);
    let faces = partition(&model, &[rigid_group("XMIN")], DIGITS);
    let nodes = partition(&model, &[direct("face", &[1])], DIGITS);
    let motion = |p: &Partition| {
        faer::Mat::from_fn(p.n_dofs(), 6, |dof, j| p.dofs[dof].site.expect("a position").rigid_motion()[j])
    };
    let of = |p: &Partition| -> Vec<f64> {
        let unit = p.scaling.stiffness_unit();
        p.energy_noise(motion(p).as_ref()).iter().map(|noise| noise * unit).collect()
    };
    for (of_faces, of_nodes) in of(&faces).into_iter().zip(of(&nodes)) {
        // Levers of the face are rounded once, and sums of a few thousand squares.
        assert!((of_faces / of_nodes - 1.0).abs() < 1e-12, "{of_faces:e} {of_nodes:e}");
    }
}
