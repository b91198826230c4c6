//! Displacements inside the component: the rows of the basis that the file keeps, in double and in single precision.

use faer::Mat;
use faer::linalg::solvers::Solve;
use supel::cli::ExitCode;
use supel_models::{Material, Model, brick, model};
use supel_runtime::component::{FloatingFrame, ModalComponent, RecoveredNode, State};
use supel_runtime::motion::{IDENTITY_3, Motion, Vector3, cross};
use supel_runtime::{Matrix, Precision, Superelement};

use crate::place::{Ended, Place, supel};

const CELLS: [usize; 3] = [6, 2, 2];
/// Lengths that no binary number holds, so that all coordinates are rounded.
const SIZE: [f64; 3] = [61.7, 8.3, 5.1];

const RIGID_FOOT: &str =
    r#"{ name = "foot", nodes = { within = { box = { min = [0, 0, 0], max = [0, 9, 6] } } }, coupling = "rigid" }"#;
/// The rotations of the foot are internal dofs; the other end keeps its own dofs.
const HINGED_FOOT_AND_TIP: &str = r#"
    { name = "foot", nodes = { within = { box = { min = [0, 0, 0], max = [0, 9, 6] } } }, coupling = "rigid", dofs = ["ux", "uy", "uz"] },
    { name = "tip", nodes = { within = { box = { min = [61, 0, 0], max = [62, 9, 6] } } } }"#;

const FOOT_AND_TIP: &str = r#"
    { name = "foot", nodes = { within = { box = { min = [0, 0, 0], max = [0, 9, 6] } } }, coupling = "rigid" },
    { name = "tip", nodes = { within = { box = { min = [61, 0, 0], max = [62, 9, 6] } } }, coupling = "rigid" }"#;

/// A bar of steel and how it is reduced.
struct Case {
    place: Place,
    model: Model,
    interfaces: &'static str,
}

impl Case {
    fn new() -> Self {
        let model = brick(CELLS, SIZE, &Material::STEEL_MM_T_S);
        Self { place: Place::with(&model), model, interfaces: RIGID_FOOT }
    }

    fn reduce(&self, recovery: &str) -> Ended {
        let interfaces = self.interfaces;
        let job = format!(
            r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{interfaces}]
reduction = {{ method = "herting", modes = {{ count = 5 }} }}
write     = {{ superelement = "x.supel", recovery = {recovery} }}
"#
        );
        self.place.write("job.toml", job.as_bytes());
        supel(&["reduce", &self.place.text("job.toml")])
    }

    fn reduced(&self, recovery: &str) -> Superelement {
        self.reduce(recovery).expect(ExitCode::Done);
        self.place.superelement("x.supel")
    }

    /// The whole basis.
    fn all(&self, precision: &str) -> Superelement {
        let nodes = "{ within = { box = { min = [0, 0, 0], max = [62, 9, 6] } } }";
        self.reduced(&format!("{{ nodes = {nodes}, precision = \"{precision}\" }}"))
    }

    /// Strains of the lines between all pairs of nodes, d·Δu/|d|², which no rigid-body motion causes.
    fn strains(&self, u: &[f64]) -> Vec<f64> {
        let n = self.model.nodes.len();
        let pairs = (0..n).flat_map(|a| (0..a).map(move |b| (a, b)));
        let strain = |(a, b): (usize, usize)| {
            let d: [f64; 3] = std::array::from_fn(|i| self.model.nodes[a][i] - self.model.nodes[b][i]);
            let change: [f64; 3] = std::array::from_fn(|i| u[3 * a + i] - u[3 * b + i]);
            model::dot(&d, &change) / model::dot(&d, &d)
        };
        pairs.map(strain).collect()
    }
}

fn rows(file: &Superelement) -> &Matrix {
    file.tensors().recovery.as_ref().expect("rows").rows()
}

fn column(a: &Matrix, j: usize) -> Vec<f64> {
    (0..a.rows()).map(|i| a[(i, j)]).collect()
}

fn times(a: &Matrix, q: &[f64]) -> Vec<f64> {
    (0..a.rows()).map(|i| model::dot(a.row(i).expect("a row"), q)).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max: f64, value| max.max(value.abs()))
}

/// W = TΨ of all dofs: WᵀKW = K̂, WᵀMW = M̂ and W Û = U, in the units of the files.
#[test]
fn recovered_rows_are_the_basis_of_the_reduced_matrices() {
    rows_are_the_basis(&Case::new());
    rows_are_the_basis(&Case { interfaces: HINGED_FOOT_AND_TIP, ..Case::new() });
}

fn rows_are_the_basis(case: &Case) {
    let file = case.all("double");
    let recovery = file.tensors().recovery.as_ref().expect("rows");
    assert_eq!(recovery.precision(), Precision::Double);
    let found: Vec<(i64, u8)> = recovery.dofs().iter().map(|dof| (dof.node, dof.direction as u8)).collect();
    assert_eq!(found, case.model.dofs, "all rows in the order of the model");
    let (w, r) = (recovery.rows(), file.n_coordinates());
    let reduced = [(&case.model.stiffness, &file.tensors().stiffness), (&case.model.mass, &file.tensors().mass)];
    let absolute = |x: Vec<f64>| x.into_iter().map(f64::abs).collect::<Vec<f64>>();
    for (full, reduced) in reduced {
        let terms: Vec<model::Entry> = full.iter().map(|(i, j, value)| (*i, *j, value.abs())).collect();
        for j in 0..r {
            let (image, terms) =
                (model::multiply(full, &column(w, j)), model::multiply(&terms, &absolute(column(w, j))));
            for i in 0..r {
                let error = (model::dot(&column(w, i), &image) - reduced[(i, j)]).abs();
                // Sums of at most 2n products |w|ᵀ|K||w| here and in supel, and as much again for the residual of its solves.
                let bound = 4.0 * case.model.n as f64 * f64::EPSILON * model::dot(&absolute(column(w, i)), &terms);
                assert!(error <= bound, "{i}, {j}: {error:e} above {bound:e}");
            }
        }
    }
    let u_hat = &file.tensors().rigid_body_modes;
    for (j, mode) in case.model.rigid_body_modes().iter().enumerate() {
        let recovered = times(w, &column(u_hat, j));
        let difference: Vec<f64> = recovered.iter().zip(mode).map(|(a, b)| a - b).collect();
        assert!(largest(&difference) <= 1e-11 * largest(mode), "motion {j}: {:e}", largest(&difference));
    }
}

/// Rows in single precision recover the deformation to 10⁻⁶, whatever rigid-body motion it rides on; applied to the whole
/// motion they would lose it in the rounding, a hundred times more for a motion a hundred times larger.
#[test]
fn c_12_single_precision_serves_the_deformation_alone() {
    let case = Case::new();
    let (double, single) = (case.all("double"), case.all("single"));
    assert_eq!(single.tensors().recovery.as_ref().expect("rows").precision(), Precision::Single);
    assert_eq!(double.tensors().stiffness, single.tensors().stiffness, "nothing else changes");
    let r = double.n_coordinates();
    let deformation: Vec<f64> = (0..r).map(|i| if i + 1 == r { 1.0 } else { 0.0 }).collect();
    let exact = times(rows(&double), &deformation);
    let strain = case.strains(&exact);
    let error = |u: &[f64]| {
        let difference: Vec<f64> = case.strains(u).iter().zip(&strain).map(|(a, b)| a - b).collect();
        largest(&difference) / largest(&strain)
    };
    let of_deformation = error(&times(rows(&single), &deformation));
    assert!(of_deformation > 0.0 && of_deformation <= 1e-6, "{of_deformation:e}");
    let mut turn = column(&double.tensors().rigid_body_modes, 5);
    let size = largest(&exact) / largest(&times(rows(&double), &turn));
    turn.iter_mut().for_each(|q| *q *= size);
    let of_all = [1e2, 1e4, 1e6, 1e8].map(|ratio| {
        let whole: Vec<f64> = turn.iter().zip(&deformation).map(|(rigid, elastic)| ratio * rigid + elastic).collect();
        error(&times(rows(&single), &whole))
    });
    assert!(of_all[0] > of_deformation && of_all[3] > 0.1, "{of_deformation:e} {of_all:?}");
    for pair in of_all.windows(2) {
        assert!((30.0..300.0).contains(&(pair[1] / pair[0])), "{of_all:?}");
    }
}

#[test]
fn some_nodes_in_their_own_order_and_none_that_are_not_there() {
    let case = Case::new();
    let file = case.reduced("{ nodes = [9, 4] }");
    let recovery = file.tensors().recovery.as_ref().expect("rows");
    let labels: Vec<i64> = recovery.dofs().iter().map(|dof| dof.node).collect();
    assert_eq!(labels, [9, 9, 9, 4, 4, 4]);
    let refusals = [
        ("{ nodes = [9, 4711] }", ExitCode::InputData, "node 4711"),
        ("{ nodes = { within = { sphere = { center = [99, 0, 0], radius = 1 } } } }", ExitCode::InputData, "no node"),
        ("{ nodes = \"group:SKIN\" }", ExitCode::InputData, "SKIN"),
        ("{ nodes = { rows = [1] } }", ExitCode::Usage, "write.recovery.nodes.rows"),
        ("{ nodes = [9, 9] }", ExitCode::Usage, "node 9"),
    ];
    for (recovery, code, said) in refusals {
        let ended = case.reduce(recovery).expect(code);
        assert!(ended.err.contains(said) && ended.err.contains("write.recovery"), "{}", ended.err);
    }
}

/// Rows have no labels, so that nothing inside can be named.
#[test]
fn a_model_without_nodes_recovers_nothing() {
    let case = Case::new();
    let job = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx" }
interface = [{ name = "foot", nodes = { rows = [0, 1, 2, 3, 4, 5, 6, 7, 8] } }]
reduction = { method = "craig-bampton", modes = { count = 5 } }
write     = { superelement = "x.supel", recovery = { nodes = [9] } }
"#;
    case.place.write("job.toml", job.as_bytes());
    let ended = supel(&["reduce", &case.place.text("job.toml")]).expect(ExitCode::InputData);
    assert!(ended.err.contains("write.recovery names nodes – the model has no dof map"), "{}", ended.err);
}

/// The interface's own nodes move with their coordinates alone, and the nodes of a rigid patch with its node.
#[test]
fn nodes_of_the_interface_follow_it() {
    let case = Case::new();
    let foot = "{ within = { box = { min = [0, 0, 0], max = [0, 9, 6] } } }";
    let file = case.reduced(&format!("{{ nodes = {foot} }}"));
    let recovery = file.tensors().recovery.as_ref().expect("rows");
    assert_eq!(recovery.dofs().len(), 3 * 9);
    let [cx, cy, cz] = file.tensors().interface_positions[0];
    for (dof, i) in recovery.dofs().iter().zip(0..) {
        let [x, y, z] = case.model.nodes[dof.node as usize - 1];
        let (x, y, z) = (x - cx, y - cy, z - cz);
        let motion = [[1.0, 0.0, 0.0, 0.0, z, -y], [0.0, 1.0, 0.0, -z, 0.0, x], [0.0, 0.0, 1.0, y, -x, 0.0]];
        for (j, found) in recovery.rows().row(i).expect("a row").iter().enumerate() {
            let expected = motion[dof.direction as usize].get(j).copied().unwrap_or(0.0);
            // Roundings of coordinates up to 10 in the mean of nine.
            assert!((found - expected).abs() <= 100.0 * f64::EPSILON, "{dof:?} {j}: {found} for {expected}");
        }
    }
    // Shapes that vanish at all nodes asked for are nothing that single precision could lose.
    let single = case.reduced(&format!("{{ nodes = {foot}, precision = \"single\" }}"));
    assert_eq!(single.tensors().recovery.as_ref().expect("rows").precision(), Precision::Single);
}

/// Mass-normalised shapes grow as the square root of the mass falls: in single precision they overflow or lose their digits long
/// before those of double precision do.
#[test]
fn shapes_that_single_precision_cannot_hold_are_refused() {
    for unit in [1e-80, 1e80] {
        let mut model = brick(CELLS, SIZE, &Material::STEEL_MM_T_S);
        for entries in [&mut model.stiffness, &mut model.mass] {
            entries.iter_mut().for_each(|(_, _, value)| *value *= unit);
        }
        let case = Case { place: Place::with(&model), model, interfaces: RIGID_FOOT };
        let ended = case.reduce("{ nodes = [20], precision = \"single\" }").expect(ExitCode::InputData);
        assert!(ended.err.contains("E-RECOVERY-RANGE"), "{}", ended.err);
        case.reduce("{ nodes = [20] }").expect(ExitCode::Done);
    }
}

/// Displacements of the full model with its foot held and its end face rigid, under a force and a moment on the middle of that,
/// and the angle by which the end face turns.
fn bent_by(case: &Case, load: &[f64; 6]) -> (Vec<f64>, f64) {
    let (model, length) = (&case.model, SIZE[0]);
    let middle = [length, SIZE[1] / 2.0, SIZE[2] / 2.0];
    let inside: Vec<usize> =
        (0..model.n).filter(|row| (1.0..length - 1.0).contains(&model.nodes[row / 3][0])).collect();
    // Displacements inside, then the translation and the turn of the end face.
    let mut shape = Mat::<f64>::zeros(model.n, inside.len() + 6);
    inside.iter().enumerate().for_each(|(column, row)| shape[(*row, column)] = 1.0);
    for row in (0..model.n).filter(|row| model.nodes[row / 3][0] > length - 1.0) {
        let (x, d) = (model.nodes[row / 3], row % 3);
        let arm: Vector3 = std::array::from_fn(|i| x[i] - middle[i]);
        for axis in 0..3 {
            shape[(row, inside.len() + axis)] = IDENTITY_3[axis][d];
            shape[(row, inside.len() + 3 + axis)] = cross(&IDENTITY_3[axis], &arm)[d];
        }
    }
    let mut stiffness = Mat::<f64>::zeros(model.n, model.n);
    model.stiffness.iter().for_each(|&(i, j, value)| stiffness[(i as usize, j as usize)] = value);
    let on_shape = shape.transpose() * &stiffness * &shape;
    let force = Mat::from_fn(on_shape.nrows(), 1, |i, _| i.checked_sub(inside.len()).map_or(0.0, |axis| load[axis]));
    let solution = on_shape.partial_piv_lu().solve(&force);
    let turn = (0..3).map(|axis| solution[(inside.len() + 3 + axis, 0)].powi(2)).sum::<f64>().sqrt();
    let displacements = &shape * solution;
    ((0..model.n).map(|row| displacements[(row, 0)]).collect(), turn)
}

/// The displacements of nodes under a load by the superelement's own stiffness, carried away by a motion of the foot and recovered.
fn recovered(file: &Superelement, nodes: &[Vector3], load: &[f64; 6], carried: &Motion) -> Vec<Vector3> {
    let (k, [_, tip]) = (&file.tensors().stiffness, [0, 1].map(|node| file.tensors().interface_positions[node]));
    let of_tip = Mat::from_fn(6, 6, |i, j| k[(6 + i, 6 + j)]);
    let q = of_tip.partial_piv_lu().solve(Mat::from_fn(6, 1, |i, _| load[i]));
    let turn = Motion::exp(&[0.0, 0.0, 0.0, q[(3, 0)], q[(4, 0)], q[(5, 0)]]);
    let turned = turn.apply(&tip);
    let moved = Motion { translation: std::array::from_fn(|d| tip[d] - turned[d] + q[(d, 0)]), ..turn };
    recovered_at(file, nodes, &[*carried, carried.compose(&moved)])
}

/// Recovered displacements in a static state of the nodes without amplitudes.
fn recovered_at(file: &Superelement, nodes: &[Vector3], motions: &[Motion]) -> Vec<Vector3> {
    let component = ModalComponent::new(file, FloatingFrame::MassWeighted).expect("a free body");
    let (mut workspace, rest) = (component.workspace(), vec![0.0; component.n_coordinates()]);
    let amplitudes = vec![0.0; component.n_modal()];
    let state = State { motions, amplitudes: &amplitudes, velocities: &rest, accelerations: &rest };
    component.evaluate(&state, &mut workspace).expect("it bends a little");
    let mut found = vec![RecoveredNode { displacement: [0.0; 3], rotation: IDENTITY_3 }; nodes.len()];
    component.recover(&workspace, nodes, &mut found).expect("all nodes");
    found.iter().map(|node| node.displacement).collect()
}

/// From the job to the file to the component: what a load bends is recovered wherever the component has gone, as the full model
/// has it.
#[test]
fn a_bent_bar_is_recovered_in_a_large_motion_as_in_the_full_model() {
    let case = Case { interfaces: FOOT_AND_TIP, ..Case::new() };
    let carried = Motion::exp(&[900.0, -400.0, 700.0, 1.5, -1.2, 1.6]);
    // Bending in both planes, tension and torsion.
    let load = [200.0, 1.2, -0.5, 200.0, 90.0, 150.0];
    let (bent, turn) = bent_by(&case, &load);
    // Rows in single precision are good for 10⁻⁶ of the deformation.
    for (precision, rounding) in [("double", 1e-12), ("single", 1e-6)] {
        let file = case.all(precision);
        let [whole, half] = [1.0, 0.5].map(|share| {
            let found = recovered(&file, &case.model.nodes, &load.map(|force| share * force), &carried);
            let away = |(node, x): (usize, &Vector3)| {
                let place = carried.apply(&std::array::from_fn(|d| x[d] + share * bent[3 * node + d]));
                std::array::from_fn::<f64, 3, _>(|d| place[d] - x[d] - found[node][d])
            };
            case.model.nodes.iter().enumerate().flat_map(away).collect::<Vec<f64>>()
        });
        // The full model is linear: what it takes for straight is an arc, of the second order in the turn. Without that nothing is
        // left but the third order, and rounding of what half the load leaves, four times.
        let first_order: Vec<f64> = whole.iter().zip(&half).map(|(whole, half)| 4.0 * half - whole).collect();
        let shares = [&whole, &first_order].map(|errors| largest(errors) / largest(&bent));
        println!("{precision}: {shares:?} of {} mm at a turn of {turn}", largest(&bent));
        assert!(shares[0] < turn, "{shares:?}");
        assert!(shares[1] < turn * turn + 4.0 * rounding, "{shares:?}");
    }
}

/// The stiffness of a single rigid patch is rounding alone, and nothing that would hold the component.
#[test]
fn a_bar_of_one_rigid_patch_is_a_free_body() {
    let case = Case::new();
    let carried = Motion::exp(&[900.0, -400.0, 700.0, 1.5, -1.2, 1.6]);
    let found = recovered_at(&case.all("double"), &case.model.nodes, &[carried]);
    for (x, found) in case.model.nodes.iter().zip(&found) {
        let place = carried.apply(x);
        // Roundings of places of 1000 mm.
        (0..3).for_each(|d| assert!((place[d] - x[d] - found[d]).abs() < 1e-11, "{found:?} at {x:?}"));
    }
}
