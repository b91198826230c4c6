//! Modes and their space, against dense algebra and against the methods that they become in the limit.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::Model;
use supel_runtime::{Coordinate, Method, Superelement};
use supel_testing::pencil::{difference, eigen, matrices, part, spectrum};
use supel_testing::place::{Place, steel_brick, supel};

use crate::Case;

/// What two ways to one spectrum may differ by: θ = 1/(λ + α) is known to ε times the condition of the factor in unit diagonal, which is
/// below 10⁵ here, a dozen times over.
const EXACT: f64 = 1e-9;
/// Near the first elastic eigenvalue of the brick, (2π · 1 kHz)².
const ALPHA: f64 = 4e7;
const N_MODES: usize = 6;

/// What is held of the two ends, as jobs and as tests of node and direction have it, and the rigid-body motions that pass.
type Held = (&'static str, fn(i64, u8) -> bool, usize);

fn is_base(node: i64) -> bool {
    [1, 11, 41].contains(&node)
}

fn is_tip(node: i64) -> bool {
    [5, 15, 45].contains(&node)
}

const HELD: [Held; 5] = [
    (r#"method = "mixed-interface", modes = { count = 6 }, held = ["base"]"#, |node, _| is_base(node), 0),
    (
        r#"method = "mixed-interface", modes = { count = 6 }, held = ["base", "tip.ux"]"#,
        |node, direction| is_base(node) || (is_tip(node) && direction == 0),
        0,
    ),
    // Two translations in the plane and the rotation in it pass.
    (
        r#"method = "mixed-interface", modes = { count = 6 }, held = ["tip.ux"]"#,
        |node, direction| is_tip(node) && direction == 0,
        3,
    ),
    (
        r#"method = "mixed-interface", modes = { count = 6 }, held = ["tip.uy", "base.uy"]"#,
        |_, direction| direction == 1,
        3,
    ),
    (
        r#"method = "mixed-interface", modes = { count = 6 }, held = ["tip.uy", "tip.uz", "tip.ux", "base.uz"], inertia_relief = true"#,
        |node, direction| is_tip(node) || direction == 2,
        0,
    ),
];

/// Rows of the model in the order internal, interface, and the number of the internal ones.
fn order(model: &Model) -> (Vec<usize>, usize) {
    let of = |nodes: &[i64]| -> Vec<usize> {
        nodes.iter().flat_map(|node| (0..model.n).filter(move |row| model.dofs[*row].0 == *node)).collect()
    };
    let interface = of(&[1, 11, 41, 5, 15, 45]);
    let internal: Vec<usize> = (0..model.n).filter(|row| !interface.contains(row)).collect();
    let n_i = internal.len();
    (internal.into_iter().chain(interface).collect(), n_i)
}

/// Frequencies are those of K and M without the rows that are held, and the space is that of Ψ with (23) of their eigenvectors, by dense
/// algebra: with everything free, with the interface held, and as held for the modes.
#[test]
fn modes_and_space_are_those_of_dense_algebra() {
    let model = steel_brick();
    let (order, n_i) = order(&model);
    let [k, m] = matrices(&model).map(|a| part(a.as_ref(), &order));
    let (n, n_b) = (order.len(), order.len() - n_i);
    let place = Place::with(&model);
    for (reduction, is_held, n_passing) in HELD {
        let file = Case::of(reduction).made(&place);
        assert_eq!(file.metadata().method, Method::MixedInterface);
        let of_dof = |at: usize| model.dofs[order[at]];
        let held: Vec<usize> = (0..n_b).filter(|at| is_held(of_dof(n_i + at).0, of_dof(n_i + at).1)).collect();
        assert_eq!(file.metadata().modes_held, held, "{reduction}");
        let kept: Vec<usize> = (0..n).filter(|at| *at < n_i || !held.contains(&(at - n_i))).collect();
        let (lambda, shapes) = eigen(part(k.as_ref(), &kept).as_ref(), part(m.as_ref(), &kept).as_ref(), ALPHA);
        let elastic = n_passing..n_passing + N_MODES;
        assert!(lambda[..n_passing].iter().all(|lambda| lambda.abs() <= 1e-6 * ALPHA), "{reduction}: zero modes");
        let stated: Vec<f64> = file.tensors().frequencies.iter().map(|omega| omega * omega).collect();
        let error = difference(&stated, &lambda[elastic.clone()], ALPHA);
        assert!(error <= EXACT, "{reduction}, frequencies: {error:e}");
        let kind = |mode| {
            file.metadata()
                .coordinates
                .iter()
                .any(|c| matches!(c, Coordinate::MixedInterfaceMode { mode: other, .. } if *other == mode))
        };
        assert!((0..N_MODES).all(kind), "{reduction}: coordinates of the modes");
        let mut whole = Mat::zeros(n, N_MODES);
        for (row, dof) in kept.iter().enumerate() {
            elastic.clone().for_each(|mode| whole[(*dof, mode - n_passing)] = shapes[(row, mode)]);
        }
        let relief = reduction.contains("inertia_relief").then(|| rigid_modes(&model, &order));
        let [k_red, m_red] = projected([&k, &m], n_i, (relief.as_ref(), &whole));
        let n_eta = k_red.nrows() - n_b;
        for at_rest in [Vec::new(), held.clone(), (0..n_b).collect()] {
            let moving: Vec<usize> = (0..n_b + n_eta).filter(|at| !at_rest.contains(at)).collect();
            let expected =
                eigen(part(k_red.as_ref(), &moving).as_ref(), part(m_red.as_ref(), &moving).as_ref(), ALPHA).0;
            let error = difference(&spectrum(&file, &at_rest, ALPHA), &expected, ALPHA);
            assert!(error <= EXACT, "{reduction}, {} at rest: {error:e}", at_rest.len());
        }
        // (34) and (35): the modes are those of the reduced pencil without what is held.
        let reduced = spectrum(&file, &held, ALPHA);
        let error = difference(&reduced[elastic.clone()], &lambda[elastic], ALPHA);
        assert!(error <= EXACT, "{reduction}, preserved: {error:e}");
    }
}

/// K and M on the columns of Ψ by dense algebra, the interface first as in the file: constraint modes, answers to the inertia of rigid-body
/// motions where they are given, and of modes, (23) and (37).
fn projected([k, m]: [&Mat<f64>; 2], n_i: usize, (relief, modes): (Option<&Mat<f64>>, &Mat<f64>)) -> [Mat<f64>; 2] {
    let (n, n_b) = (k.nrows(), k.nrows() - n_i);
    let internal: Vec<usize> = (0..n_i).collect();
    let factor = part(k.as_ref(), &internal).llt(Side::Lower).expect("definite");
    let statics = factor.solve(k.as_ref().submatrix(0, n_i, n_i, n_b));
    // In the scale of displacements: λ of these columns is near ALPHA.
    let answers = |x: &Mat<f64>| factor.solve((m * x).as_ref().subrows(0, n_i)) * faer::Scale(ALPHA);
    let dynamic = match relief {
        Some(relief) => faer::concat![[answers(relief), answers(modes)]],
        None => answers(modes),
    };
    let psi = Mat::from_fn(n, n_b + dynamic.ncols(), |i, j| match (i < n_i, j < n_b) {
        (true, true) => -statics[(i, j)],
        (true, false) => dynamic[(i, j - n_b)],
        (false, true) => f64::from(u8::from(i - n_i == j)),
        (false, false) => 0.0,
    });
    [k, m].map(|a| psi.transpose() * a * &psi)
}

/// The six unit motions at rows of a model.
fn rigid_modes(model: &Model, order: &[usize]) -> Mat<f64> {
    let motions = model.rigid_body_modes();
    Mat::from_fn(order.len(), motions.len(), |i, j| motions[j][order[i]])
}

/// With all of it held the method is Craig-Bampton's, with nothing held and with inertia relief Herting's, to the bit.
#[test]
fn all_held_and_nothing_held_are_the_methods_of_those_boundaries() {
    let place = Place::with_brick();
    for (mixed, limit) in [
        (
            r#"method = "mixed-interface", modes = { count = 6 }, held = ["base", "tip"]"#,
            r#"method = "craig-bampton", modes = { count = 6 }"#,
        ),
        (
            r#"method = "mixed-interface", modes = { count = 6 }, held = [], inertia_relief = true"#,
            r#"method = "herting", modes = { count = 6 }"#,
        ),
    ] {
        let [found, expected] = [mixed, limit].map(|reduction| Case::of(reduction).made(&place));
        assert!(found.tensors() == expected.tensors(), "{mixed}");
        assert_eq!(found.metadata().coordinates, expected.metadata().coordinates, "{mixed}");
        assert_eq!(found.metadata().model, expected.metadata().model);
        assert_eq!(found.metadata().method, Method::MixedInterface);
    }
}

fn work(place: &Place) -> [u64; 2] {
    let report = place.report("x.report.json");
    let of = |key: &str| report["run"]["work"][key].as_u64().expect("a count");
    [of("n_factorisations"), of("n_solves")]
}

/// The factor of K_II and one count serve mixed boundaries too; the answers to the interface dofs that are free are solved once more.
#[test]
fn mixed_boundaries_take_no_factorisation_of_their_own() {
    let place = Place::with_brick();
    let of = |reduction| {
        Case::of(reduction).run(&place).expect(ExitCode::Done);
        work(&place)
    };
    let herting = of(r#"method = "herting", modes = { count = 6 }"#);
    for (reduction, ..) in HELD {
        let mixed = of(reduction);
        assert_eq!(mixed[0], herting[0], "{reduction}: factorisations");
    }
}

/// Patches, bare rows, other eigensolvers, proofs, single precision, mass without inertia: the frequencies are those of what is left.
#[test]
fn frequencies_hold_in_every_way_of_the_program() {
    const PATCHES: &str = r#"
        { name = "base", coupling = "rigid", nodes = { within = { box = { min = [0, 0, 0], max = [0.01, 1, 1] } } } },
        { name = "tip", coupling = "average", nodes = { within = { box = { min = [0.99, 0, 0], max = [1, 1, 1] } } } }"#;
    const RUN: [&str; 4] =
        ["", "run = { certify = \"full\" }", "run = { precision = \"mixed\" }", "run = { certify = \"none\" }"];
    let model = steel_brick();
    let place = Place::with(&model);
    let reference = |rest, eigensolver: &str| {
        let reduction = match eigensolver {
            "arpack" => {
                r#"method = "mixed-interface", modes = { count = 6 }, held = ["base.uy", "tip"], eigensolver = "arpack""#
            }
            _ => r#"method = "mixed-interface", modes = { count = 6 }, held = ["base.uy", "tip"]"#,
        };
        Case { rest, ..Case::of(reduction) }.made(&place).tensors().frequencies.clone()
    };
    let expected = reference("", "lanczos");
    let solvers = supel_testing::chain::certified::eigensolver_words();
    for (rest, solver) in RUN.into_iter().flat_map(|rest| solvers.iter().map(move |solver| (rest, *solver))) {
        let found = reference(rest, solver);
        let error = found.iter().zip(&expected).fold(0.0, |worst: f64, (a, b)| worst.max((a / b - 1.0).abs()));
        assert!(found.len() == 6 && error <= EXACT, "{rest}, {solver}: {error:e}");
    }
    // With a rigid base held the frequencies are those of a fixed wall: the base of a component that ends there.
    for (interfaces, held, wall) in [
        (PATCHES, r#"method = "mixed-interface", modes = { count = 6 }, held = ["base"]"#, "base"),
        (PATCHES, r#"method = "mixed-interface", modes = { count = 6 }, held = ["base", "tip.rx"]"#, ""),
        (PATCHES, r#"method = "mixed-interface", modes = { count = 6 }, held = ["tip"]"#, ""),
    ] {
        let file = Case { interfaces, ..Case::of(held) }.made(&place);
        if wall.is_empty() {
            continue;
        }
        let at_wall = |row: &usize| model.nodes[model.dofs[*row].0 as usize - 1][0] < 0.01;
        let kept: Vec<usize> = (0..model.n).filter(|row| !at_wall(row)).collect();
        let [k, m] = matrices(&model).map(|a| part(a.as_ref(), &kept));
        let lambda = eigen(k.as_ref(), m.as_ref(), ALPHA).0;
        let stated: Vec<f64> = file.tensors().frequencies.iter().map(|omega| omega * omega).collect();
        let error = difference(&stated, &lambda[..6], ALPHA);
        assert!(error <= EXACT, "{held}: {error:e}");
    }
}

/// Frequencies with any part of the interface at rest have lower bounds that hold. As held for the modes they meet the frequencies below
/// √(κ/2)/2π: what is not a mode has a/(1 + a/κ) there at least, a its eigenvalue of no less than κ, whose whole mass hangs on a spring of κ.
/// A boundary that lets rigid-body motion pass tells why there are none.
#[test]
fn bounds_of_omitted_modes_hold() {
    let model = steel_brick();
    let (order, n_i) = order(&model);
    let [k, m] = matrices(&model).map(|a| part(a.as_ref(), &order));
    let place = Place::with(&model);
    let of = |fix: &[&str]| -> Value {
        let file = place.text("x.supel");
        let args: Vec<&str> = ["modes", "--json", &file].into_iter().chain(fix.iter().copied()).collect();
        serde_json::from_str(&supel(&args).expect(ExitCode::Done).out).expect("JSON")
    };
    Case::of(r#"method = "mixed-interface", modes = { count = 12 }, held = ["base"]"#).made(&place);
    for (fix, is_held) in
        [(&[][..], (|_| false) as fn(i64) -> bool), (&["--fix", "x.tip"], is_tip), (&["--fix", "x.base"], is_base)]
    {
        let kept: Vec<usize> = (0..order.len()).filter(|at| *at < n_i || !is_held(model.dofs[order[*at]].0)).collect();
        let lambda = eigen(part(k.as_ref(), &kept).as_ref(), part(m.as_ref(), &kept).as_ref(), ALPHA).0;
        let found = of(fix);
        let modes = found["modes"].as_array().expect("a list");
        let omits_above = found["components"][0]["omits_above_hz"].as_f64().expect("a frequency");
        let elastic = modes.iter().filter(|mode| mode["kind"] == "elastic");
        let n_zero = modes.iter().filter(|mode| mode["kind"] == "rigid_body").count();
        let mut n_bounds = 0;
        for (mode, lambda) in elastic.zip(&lambda[n_zero..]) {
            let exact = lambda.sqrt() / std::f64::consts::TAU;
            let (above, below) = (mode["frequency_hz"].as_f64(), mode["at_least_hz"].as_f64().expect("a bound"));
            let above = above.expect("a frequency");
            assert!(below <= exact * (1.0 + EXACT) && exact <= above * (1.0 + EXACT), "{below} {exact} {above}");
            let meets = above - below <= 1e-6 * above;
            let is_own = fix == ["--fix", "x.base"] && above < 0.7 * omits_above;
            assert!(meets || !is_own, "{fix:?}: {below} below {above}");
            n_bounds += usize::from(below > 0.5 * exact);
        }
        assert!(n_bounds >= 2, "{fix:?}: {found}");
    }
    let (reduction, ..) = HELD[2];
    Case::of(reduction).made(&place);
    let shown = supel(&["modes", &place.text("x.supel")]).expect(ExitCode::Done).out;
    assert!(shown.contains("lets it move as a rigid body"), "{shown}");
}

/// Rows of a model without nodes.
#[test]
fn rows_of_a_model_without_nodes_are_held_by_their_interface() {
    let model = steel_brick();
    let place = Place::with(&model);
    let rows =
        |nodes: [i64; 3]| -> Vec<usize> { (0..model.n).filter(|row| nodes.contains(&model.dofs[*row].0)).collect() };
    let words = |rows: &[usize]| rows.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
    let (base, tip) = (rows([1, 11, 41]), rows([5, 15, 45]));
    let flags = format!(
        "--interface base=rows:{} --interface tip=rows:{} --method mixed-interface --modes 6 --held base",
        words(&base),
        words(&tip)
    );
    place.reduce(&place.matrix_flags(), &flags).expect(ExitCode::Done);
    supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
    let file: Superelement = place.superelement("x.supel");
    assert_eq!(file.metadata().modes_held, (0..9).collect::<Vec<usize>>());
    let kept: Vec<usize> = (0..model.n).filter(|row| !base.contains(row)).collect();
    let [k, m] = matrices(&model).map(|a| part(a.as_ref(), &kept));
    let stated: Vec<f64> = file.tensors().frequencies.iter().map(|omega| omega * omega).collect();
    let error = difference(&stated, &eigen(k.as_ref(), m.as_ref(), ALPHA).0[..6], ALPHA);
    assert!(error <= EXACT, "{error:e}");
}
