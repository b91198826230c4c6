//! Free components whose K and M were printed with few digits: K U ≠ 0, and Lanczos converges as if it were zero.

use faer::Mat;
use supel::constraint::FreeAtZero;
use supel::constraint::constraint_modes;
use supel::dense;
use supel::eigen::{EigenWork, ModeRequest, ShiftInvert, Wanted, elastic_modes};
use supel::factor::Cholesky;
use supel::input::{Digits, Input, MatrixInput};
use supel::job::{Eigensolver, InterfaceJob};
use supel::model::Model;
use supel::partition::Partition;
use supel::random::SEED;
use supel::rigid::{self, RigidBodyModes};
use supel::sparse::product;
use supel_models::transform::rounded;
use supel_models::{Family, Material, Part, brick};

use crate::chain;

/// What a test looks at of a component at some number of digits.
struct Found {
    /// |fᵀAg − gᵀAf| / √(fᵀAf gᵀAg) of the operator A at zero, for self-equilibrated loads.
    asymmetry: f64,
    work: EigenWork,
}

fn look(model: &supel_models::Model, interfaces: &[InterfaceJob], digits: u32) -> Found {
    let input = chain::input(&if digits < 17 { rounded(model, digits as usize) } else { model.clone() });
    let known = Digits { significant: digits, ..Digits::DOUBLE };
    let of = |matrix: MatrixInput| MatrixInput { digits: known, ..matrix };
    let input = Input { stiffness: of(input.stiffness), mass: of(input.mass), ..input };
    let partition = Partition::new(Model::new(input).expect("sound"), interfaces).expect("interfaces");
    let rigid = rigid::rigid_body_modes(&partition).expect("free").0;
    assert_eq!(rigid.count(), 6, "{digits} digits");
    let analysis = partition.analysis().expect("memory");
    let factor = Cholesky::new(&analysis, partition.pencil(), 0.0, &|dof| partition.name_of(dof)).expect("definite");
    let constraint = constraint_modes(&partition, &factor, &rigid);
    let operator = FreeAtZero::new(&factor, &partition.stiffness, &constraint, &rigid).expect("no hinge");
    let request = ModeRequest { wanted: Wanted::Count(8), eigensolver: Eigensolver::Lanczos, seed: SEED };
    let modes = elastic_modes(partition.free_problem().deflating(rigid.deflated()), &operator, request);
    let work = modes.unwrap_or_else(|error| panic!("{digits} digits: {error}")).work;
    Found { asymmetry: asymmetry(&partition, &rigid, &operator), work }
}

/// |xᵀA⁻¹y − yᵀA⁻¹x| over the root of both energies, root mean square over the pairs of six loads: that of one pair is chance.
fn asymmetry(partition: &Partition, rigid: &RigidBodyModes, operator: &dyn ShiftInvert) -> f64 {
    const N_LOADS: usize = 6;
    let any = Mat::from_fn(partition.n_dofs(), N_LOADS, |i, j| ((3 * i + 7 * i * j + 1) as f64).sin());
    let mut loads = product(&partition.mass, any.as_ref());
    let resultant = dense::gram(rigid.orthonormal.as_ref(), loads.as_ref());
    dense::add_product(loads.as_mut(), -1.0, rigid.mass_orthonormal.as_ref(), resultant.as_ref());
    let mut answers = loads.clone();
    operator.solve_in_place(answers.as_mut());
    let work = dense::gram(loads.as_ref(), answers.as_ref());
    let of_pair = |(i, j): (usize, usize)| (work[(i, j)] - work[(j, i)]).powi(2) / (work[(i, i)] * work[(j, j)]);
    let pairs: Vec<(usize, usize)> = (1..N_LOADS).flat_map(|j| (0..j).map(move |i| (i, j))).collect();
    let squares: f64 = pairs.iter().copied().map(of_pair).sum();
    (squares / pairs.len() as f64).sqrt()
}

fn parts() -> Vec<(&'static str, supel_models::Model, Vec<InterfaceJob>)> {
    let beam = brick([10, 2, 2], [10.0, 1.1, 0.9], &Material::UNIT);
    let bulky = Part::new(Family::Bulky, 1000).model;
    let rigid = |names: [&str; 2]| names.map(chain::rigid_group).to_vec();
    vec![
        ("beam between rigid faces", beam.clone(), rigid(["XMIN", "XMAX"])),
        ("block between rigid faces", bulky, rigid(["BASE", "TIP"])),
        ("beam held by nodes", beam, vec![chain::direct("ends", &[1, 12, 34, 99])]),
    ]
}

/// The correction that makes Ψ_S carry rigid-body motion is of the size of K U. On one side of the operator alone it makes it as
/// unsymmetric as that, 10⁻⁸ with eight digits, and a Lanczos iteration never converges to its tolerance of 10⁻¹³.
#[test]
fn operator_at_zero_is_symmetric_and_lanczos_takes_no_more_steps_whatever_the_digits() {
    for (name, model, interfaces) in parts() {
        let all = look(&model, &interfaces, 17);
        for digits in [6, 7, 8, 10, 12] {
            let few = look(&model, &interfaces, digits);
            // Two solves of loads that are a sum of as many terms as there are rows; their rounding is random.
            let bar = 4.0 * f64::EPSILON * (model.n as f64).sqrt() * all.asymmetry.max(1.0);
            let bar = bar.max(16.0 * all.asymmetry);
            assert!(few.asymmetry <= bar, "{name}, {digits} digits: {:e}, {:e} with all", few.asymmetry, all.asymmetry);
            assert_eq!(few.work.restarts, all.work.restarts, "{name}, {digits} digits");
            // Another rounding may take a block more or less.
            assert!(few.work.solves <= all.work.solves + 16, "{name}, {digits} digits: {:?}, {:?}", few.work, all.work);
        }
    }
}
