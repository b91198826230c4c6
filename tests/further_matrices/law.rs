//! Rayleigh and modal damping: each mode of the reduced component has the share that was asked for.

use faer::Mat;
use faer::linalg::solvers::Solve;
use supel::cli::ExitCode;
use supel_models::{Inertia, Material, Section, SplitMix64, frame};
use supel_runtime::component::{FloatingFrame, ModalComponent, State};
use supel_runtime::motion::Motion;
use supel_runtime::{Matrix, Superelement, Tensors};
use supel_testing::place::steel_brick;

use super::{CRAIG_BAMPTON, Case, FOOT_AND_HUB, HERTING, damped_eigenvalues, free_modes, unpacked};

const INTERFACE: &str =
    r#"{ name = "foot", nodes = [1, 11, 31] }, { name = "head", nodes = [5, 15, 35], coupling = "rigid" }"#;

/// ω and ζ of the elastic modes by the eigenvalues of the damped pencil, −ζω ± iω√(1 − ζ²).
fn shares(file: &Superelement) -> Vec<[f64; 2]> {
    let tensors = file.tensors();
    let damping = unpacked(tensors.damping.as_ref().expect("damping"));
    let values = damped_eigenvalues([&unpacked(&tensors.stiffness), &damping, &unpacked(&tensors.mass)]);
    // Rigid-body motion has eigenvalues of rounding, with an imaginary part or without.
    let (lambda, _) = free_modes(file);
    let elastic = values.into_iter().filter(|[_, im]| *im > 0.1 * lambda[file.n_rigid()].sqrt());
    elastic.map(|[re, im]| [re.hypot(im), -re / re.hypot(im)]).collect()
}

/// Asserts that the damped pencil has as many elastic modes as the undamped one, with its ω, and ζ as `expected` of number and ω.
#[track_caller]
fn assert_shares(file: &Superelement, expected: impl Fn(usize, f64) -> f64) {
    let (lambda, _) = free_modes(file);
    let found = shares(file);
    let omega: Vec<f64> = lambda[file.n_rigid()..].iter().map(|lambda| lambda.sqrt()).collect();
    assert_eq!(found.len(), omega.len());
    for (mode, ([omega_found, share], omega)) in found.iter().zip(&omega).enumerate() {
        let asked = expected(mode, *omega);
        // By the root of M̂ a low λ is known to ε λ_max, which is 1e-9 of it here; neighbours couple by as much.
        assert!((omega_found / omega - 1.0).abs() < 1e-8, "mode {mode}: {omega_found} for {omega}");
        assert!((share - asked).abs() < 1e-8, "mode {mode}: {share} for {asked}");
    }
}

/// Ĉ Û = 0 to the last digits of the terms.
#[track_caller]
fn assert_free(file: &Superelement) {
    let tensors = file.tensors();
    let (c, u) = (unpacked(tensors.damping.as_ref().expect("damping")), unpacked(&tensors.rigid_body_modes));
    let (force, size) = ((&c * &u).norm_max(), c.norm_max() * u.norm_max());
    assert!(size > 0.0 && force <= 1e-12 * size, "{force:e} of {size:e}");
}

#[test]
fn every_mode_has_the_share_that_was_asked_for() {
    let case = Case::new(steel_brick());
    for (interfaces, reduction) in [(INTERFACE, HERTING), (INTERFACE, CRAIG_BAMPTON), ("", HERTING)] {
        let file = case.reduced(interfaces, reduction, "damping = { modal = { ratio = 0.02 } }");
        assert_free(&file);
        assert_shares(&file, |_, _| 0.02);
        case.verify(&[]).expect(ExitCode::Done);
        let file = case.reduced(interfaces, reduction, "damping = { modal = { ratios = [0.01, 0, 0.03] } }");
        assert_shares(&file, |mode, _| [0.01, 0.0, 0.03][mode.min(2)]);
        let table = "damping = { modal = { table = [[1000, 0.01], [3000, 0.05], [20000, 0.02]] } }";
        let file = case.reduced(interfaces, reduction, table);
        assert_free(&file);
        assert_shares(&file, |_, omega| match omega / std::f64::consts::TAU {
            hz if hz <= 1000.0 => 0.01,
            hz if hz <= 3000.0 => 0.01 + 0.04 * (hz - 1000.0) / 2000.0,
            hz if hz <= 20000.0 => 0.05 - 0.03 * (hz - 3000.0) / 17000.0,
            _ => 0.02,
        });
        case.verify_with_job().expect(ExitCode::Done);
    }
}

/// ζ = α/2ω + βω/2. On the deformation alone the share of the mass leaves rigid-body motion alone, and is the same for every mode.
#[test]
fn rayleigh_damping_is_that_of_mass_and_stiffness() {
    let case = Case::new(steel_brick());
    let [alpha, beta] = [150.0, 2e-7];
    let share = |_: usize, omega: f64| 0.5 * (alpha / omega + beta * omega);
    let rayleigh = |more: &str| format!("damping = {{ rayleigh = {{ mass = {alpha}, stiffness = {beta}{more} }} }}");
    for (interfaces, reduction) in [(INTERFACE, HERTING), (FOOT_AND_HUB, CRAIG_BAMPTON), ("", HERTING)] {
        let file = case.reduced(interfaces, reduction, &rayleigh(", mass_acts_on = \"deformation\""));
        assert_free(&file);
        assert_shares(&file, share);
        case.verify(&[]).expect(ExitCode::Done);
        let ended = case.run(interfaces, reduction, &rayleigh("")).expect(ExitCode::ModelPhysics);
        assert!(ended.err.contains("E-DAMPING-RIGID") && ended.err.contains("mass_acts_on"), "{}", ended.err);
        let resisting = rayleigh("").replace("} }", "}, rigid_motion = \"resist\" }");
        let file = case.reduced(interfaces, reduction, &resisting);
        let tensors = file.tensors();
        let [c, k, m] = [tensors.damping.as_ref().expect("damping"), &tensors.stiffness, &tensors.mass];
        let sum = Mat::from_fn(c.rows(), c.cols(), |i, j| alpha * m[(i, j)] + beta * k[(i, j)]);
        let size = sum.norm_max();
        let difference = unpacked(c) - sum;
        assert!(difference.norm_max() <= 4.0 * f64::EPSILON * size);
        assert!(file.metadata().validity.assumptions.iter().any(|assumption| assumption.contains("resist")));
        case.verify_with_job().expect(ExitCode::Done);
    }
    // A held component has no rigid-body motion that anything could resist.
    let held = rayleigh("") + "\n[[fixed]]\nnodes = [1, 11, 31]";
    let file = case.reduced("{ name = \"head\", nodes = [5, 15, 35] }", CRAIG_BAMPTON, &held);
    assert_shares(&file, share);
}

/// Damping of the file in a simulation: a mode loses 2ζω of its energy per unit of time, a body that turns as a whole loses none.
#[test]
fn a_component_in_motion_loses_what_its_modes_lose() {
    let case = Case::new(steel_brick());
    let interfaces = INTERFACE.replace("31] }", "31], coupling = \"rigid\" }");
    let file = case.reduced(&interfaces, HERTING, "damping = { modal = { ratio = 0.03 } }");
    let component = ModalComponent::new(&file, FloatingFrame::MassWeighted).expect("a component");
    let mut workspace = component.workspace();
    let motions = vec![Motion::exp(&[0.3, -0.2, 0.1, 0.0, 0.4, 1.0]); component.n_nodes()];
    let (amplitudes, rest) = (vec![0.0; component.n_modal()], vec![0.0; component.n_coordinates()]);
    let mut dissipated = |velocities: &[f64], motions: &[Motion]| {
        let state = State { motions, amplitudes: &amplitudes, velocities, accelerations: &rest };
        component.evaluate(&state, &mut workspace).expect("a state");
        (
            workspace.dissipated_power(),
            workspace.damping_forces().iter().fold(0.0f64, |max, force| max.max(force.abs())),
        )
    };
    // Material velocities of the nodes at the origin of the component: u̇ = v + ω × x.
    let material = |velocities: &[f64]| -> Vec<f64> {
        let mut material = velocities.to_vec();
        for (node, [x, y, z]) in file.tensors().interface_positions.iter().enumerate() {
            let [a, b, c] = [3, 4, 5].map(|axis| velocities[6 * node + axis]);
            let carried = [b * z - c * y, c * x - a * z, a * y - b * x];
            (0..3).for_each(|axis| material[6 * node + axis] -= carried[axis]);
        }
        material
    };
    let still = vec![Motion::exp(&[0.0; 6]); component.n_nodes()];
    let (lambda, shapes) = free_modes(&file);
    let n_r = file.n_rigid();
    let mut of_mode = 0.0;
    for (mode, lambda) in lambda.iter().enumerate().skip(n_r).take(3) {
        let velocity: Vec<f64> = (0..shapes.nrows()).map(|i| shapes[(i, mode)]).collect();
        let (power, force) = dissipated(&material(&velocity), &still);
        // Twice the share times ω of the energy of a mode of unit mass, ẋᵀM̂ẋ = 1.
        let expected = 2.0 * 0.03 * lambda.sqrt();
        assert!((power / expected - 1.0).abs() < 1e-8, "mode {mode}: {power} for {expected}");
        of_mode = force;
    }
    // All nodes turn with the body, wherever it is: one material velocity for all.
    let turning: Vec<f64> = (0..file.n_coordinates())
        .map(|i| if i < 6 * component.n_nodes() { [0.3, -0.1, 0.2, 2.0, -0.7, 3.0][i % 6] } else { 0.0 })
        .collect();
    for motions in [&still, &motions] {
        let (power, force) = dissipated(&turning, motions);
        assert!(force <= 1e-9 * of_mode && power.abs() <= 1e-9, "{force:e} of {of_mode:e}, {power:e}");
    }
    let (power, force) = dissipated(&rest, &motions);
    assert!(power == 0.0 && force == 0.0);
}

/// The damping of a law is known from the file alone.
#[test]
fn other_damping_than_that_of_the_law_is_seen_alone() {
    let case = Case::new(steel_brick());
    let law = "damping = { modal = { ratios = [0.01, 0.02] }, rayleigh = { mass = 0, stiffness = 1e-7 } }";
    let whole = case.reduced(INTERFACE, HERTING, law);
    case.verify(&[]).expect(ExitCode::Done);
    let c = whole.tensors().damping.clone().expect("damping");
    let r = c.rows();
    let symmetric = |at: (usize, usize), factor: f64| {
        Matrix::from_fn(r, r, |i, j| c[(i, j)] * if (i, j) == at || (j, i) == at { factor } else { 1.0 })
    };
    let changes = [
        ("an entry", Some(symmetric((0, 4), 1.0 + 1e-6))),
        ("all of it", Some(Matrix::from_fn(r, r, |i, j| 1.01 * c[(i, j)]))),
        ("none", None),
    ];
    for (what, damping) in changes {
        let tensors = Tensors { damping, ..whole.tensors().clone() };
        Superelement::new(tensors, whole.metadata().clone())
            .expect("fits")
            .write(&case.place.path("x.supel"))
            .expect("written");
        case.verify(&[]).expect(ExitCode::CheckFailed);
        assert_eq!(case.verify_with_job().code, ExitCode::CheckFailed, "{what}");
    }
}

/// A slender frame that one node holds: of K̂ at that node rounding is left, and without a load there is nothing to deform.
#[test]
fn one_node_holds_a_frame_that_is_damped() {
    let laws = [
        "modal = { ratio = 0.02 }",
        "rayleigh = { mass = 0, stiffness = 1e-6 }",
        r#"rayleigh = { mass = 2, stiffness = 0, mass_acts_on = "deformation" }"#,
    ];
    for seed in 0..8 {
        let mut random = SplitMix64::new(seed);
        let mut at = [0.0; 3];
        let nodes: Vec<[f64; 3]> = (0..10)
            .map(|_| {
                at = [0, 1, 2].map(|axis| at[axis] + [1.0, 0.3, 0.3][axis] * random.normal());
                at
            })
            .collect();
        let edges: Vec<[usize; 2]> = (1..10).map(|node| [node - 1, node]).collect();
        let section = Section::round(10f64.powf(-1.3 * random.uniform() - 1.5));
        let case = Case::new(frame(&nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent));
        for (at, law) in laws.iter().enumerate() {
            for load in ["", "load = [{ name = \"tip\", nodes = [9], force = [1, 2, 3] }]\n"] {
                let more = format!("{load}damping = {{ {law} }}");
                let node = r#"{ name = "a", nodes = [5] }"#;
                let file = case.reduced(node, r#"method = "guyan""#, &more);
                case.verify(&[]).expect(ExitCode::Done);
                case.verify_with_job().expect(ExitCode::Done);
                if at == 0 && !load.is_empty() {
                    let tensors = file.tensors();
                    let [k, m, c] =
                        [&tensors.stiffness, &tensors.mass, tensors.damping.as_ref().expect("damping")].map(unpacked);
                    // The one shape that deforms is what rigid-body motion leaves of the residual vector.
                    let u = unpacked(&tensors.rigid_body_modes);
                    let momenta = &m * &u;
                    let inertia = u.transpose() * &momenta;
                    let last = Mat::from_fn(k.nrows(), 1, |i, _| f64::from(u8::from(i + 1 == k.nrows())));
                    let x = &last - &u * inertia.partial_piv_lu().solve(momenta.transpose() * &last);
                    let of = |a: &Mat<f64>| (x.transpose() * a * &x)[(0, 0)];
                    let share = of(&c) / (2.0 * (of(&k) * of(&m)).sqrt());
                    // Of the energy of the shape as much is known as of K̂ next to its terms, which are 1e9 times larger at most.
                    assert!((share - 0.02).abs() < 1e-6, "seed {seed}: {share}");
                }
            }
        }
    }
}

/// Damping of the stiffness, of a frame that one node holds: nothing deforms, and what is projected is the rounding of its terms.
#[test]
fn damping_of_a_frame_that_one_node_holds() {
    let nodes: Vec<[f64; 3]> =
        (0..8).map(|k| [0.2 * f64::from(k), 0.07 * f64::from(k % 3), 0.03 * f64::from(k)]).collect();
    let edges: Vec<[usize; 2]> = (1..8).map(|node| [node - 1, node]).collect();
    let model = frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
    for digits in [17, 9, 6] {
        let case = Case::new(model.clone());
        let printed = |value: f64| format!("{:.*e}", digits - 1, 1e-5 * value).parse().expect("a number");
        let entries = model.stiffness.iter().map(|(i, j, value)| (*i, *j, printed(*value))).collect();
        case.matrix("C.mtx", "symmetric", &entries);
        let more = "[[matrix]]\nname = \"c\"\nkind = \"damping\"\nfile = \"C.mtx\"\n";
        let file = case.reduced(r#"{ name = "a", nodes = [3] }"#, r#"method = "guyan""#, more);
        assert_eq!(unpacked(file.tensors().damping.as_ref().expect("damping")).norm_max(), 0.0, "{digits} digits");
        case.verify(&[]).expect(ExitCode::Done);
        case.verify_with_job().expect(ExitCode::Done);
    }
}
