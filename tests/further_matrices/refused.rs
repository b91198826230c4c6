//! Matrices and damping that are refused.

use supel::cli::ExitCode;
use supel_models::transform::rounded;
use supel_models::{Inertia, Material, Section, brick, frame};
use supel_runtime::Verdict;
use supel_testing::place::{Place, steel_brick, supel};

use super::{CRAIG_BAMPTON, Case, Entries, FOOT_AND_HUB, HERTING, any, dense, modes, skew};

const SPIN: &str = "[[matrix]]\nname = \"spin\"\nkind = \"gyroscopic\"\nfile = \"G.mtx\"\n";

#[test]
fn files_of_matrices_that_cannot_be_taken() {
    let case = Case::new(steel_brick());
    let n = case.model.n;
    let banner = |symmetry: &str, n: usize, lines: &str| {
        format!("%%MatrixMarket matrix coordinate real {symmetry}\n{n} {n} {}\n{lines}", lines.lines().count())
    };
    let wrong = [
        (banner("general", n, "2 1 1\n1 2 1\n"), "E-MATRIX-KIND"),
        (banner("general", n, "2 1 1\n"), "E-MATRIX-KIND"),
        (banner("general", n, "2 1 1\n1 2 -1.0000000000000002\n"), "E-MATRIX-KIND"),
        (banner("skew-symmetric", n, "2 1 1\n3 3 1\n"), "E-SKEW-DIAGONAL"),
        (banner("skew-symmetric", n, "2 1 1\n1 2 -1\n"), "E-DOUBLE-TRIANGLE"),
        (banner("skew-symmetric", n - 1, "2 1 1\n"), "E-MATRIX-ROWS"),
        (banner("skew-symmetric", n, "2 1 0\n"), "E-MATRIX-NOTHING"),
        (banner("hermitian", n, "2 1 1\n"), "E-FLAVOUR"),
        (banner("skew-symmetric", n, "2 1 nan\n"), "E-"),
        (banner("skew-symmetric", n, "2 1 1e200\n"), "E-RANGE"),
        (format!("2 1 1\n1 2 -1\n{n} {n} 0\n"), "E-BANNER"),
    ];
    for (text, code) in wrong {
        case.place.write("G.mtx", text.as_bytes());
        let ended = case.run(FOOT_AND_HUB, CRAIG_BAMPTON, SPIN);
        assert!(ended.err.contains(code) && ended.code == ExitCode::InputData, "{code}: {}", ended.err);
        assert!(!case.place.path("x.supel").exists());
    }
    let line = banner("skew-symmetric", n, "2 1 1\n2 1 1\n");
    case.place.write("G.mtx", line.as_bytes());
    case.run(FOOT_AND_HUB, CRAIG_BAMPTON, SPIN).expect(ExitCode::Done);
    let job = String::from_utf8(case.place.bytes("job.toml")).expect("UTF-8");
    let changed = |job: &str| {
        case.place.write("job.toml", job.as_bytes());
        supel(&["reduce", &case.place.text("job.toml"), "--quiet"])
    };
    let ended = changed(&job.replace("nodes.csv\" }", "nodes.csv\", duplicates = \"refuse\" }"));
    assert!(ended.err.contains("E-DUPLICATES"), "{}", ended.err);
    let ended = changed(&job.replace(SPIN, &format!("{SPIN}{SPIN}"))).expect(ExitCode::Usage);
    assert!(ended.err.contains("E-MATRIX-NAME"), "{}", ended.err);
    let held = format!("{SPIN}[[fixed]]\nnodes = [1]\n");
    let ended = changed(&job.replace(SPIN, &held).replace("[1, 11, 31]", "[2, 11, 31]")).expect(ExitCode::InputData);
    assert!(ended.err.contains("E-MATRIX-NOTHING") && ended.err.contains("held"), "{}", ended.err);
    case.place.write("job.toml", job.as_bytes());
    let output = case.place.text("G.mtx");
    assert_ne!(supel(&["reduce", &case.place.text("job.toml"), "--report", &output]).code, ExitCode::Done);
}

/// A damper between two nodes of a rigid patch does nothing: rounding is left of it, and nothing is held.
#[test]
fn a_damper_within_a_rigid_patch_does_nothing() {
    let case = Case::new(steel_brick());
    let at = |label: i64| case.model.nodes[case.model.labels.iter().position(|own| *own == label).expect("a node")];
    let row = |dof: (i64, u8)| case.model.dofs.iter().position(|own| *own == dof).expect("a dof") as u32;
    let damper = |[from, to]: [i64; 2]| -> Entries {
        let along: [f64; 3] = std::array::from_fn(|axis| at(to)[axis] - at(from)[axis]);
        let of = |label: i64, sign: f64| (0..3u8).map(move |axis| (row((label, axis)), sign * along[axis as usize]));
        let terms: Vec<(u32, f64)> = of(from, -1.0).chain(of(to, 1.0)).collect();
        terms.iter().flat_map(|(i, a)| terms.iter().map(move |(j, b)| (*i, *j, a * b))).collect()
    };
    let table = "[[matrix]]\nname = \"damper\"\nkind = \"damping\"\nfile = \"C.mtx\"\n";
    case.matrix("C.mtx", "symmetric", &damper([5, 25]));
    let ended = case.run(FOOT_AND_HUB, CRAIG_BAMPTON, table);
    assert!(ended.err.contains("E-MATRIX-NOTHING") && ended.err.contains("patches and constraints"), "{}", ended.err);
    case.matrix("C.mtx", "symmetric", &damper([5, 41]));
    case.run(FOOT_AND_HUB, CRAIG_BAMPTON, table).expect(ExitCode::Done);
}

/// Damping of the stiffness is free of rigid-body motion, however few digits it is written with; a damper to the ground is not.
#[test]
fn dampers_to_the_ground_are_told_from_rounding() {
    let case = Case::new(steel_brick());
    let seal = |more: &str| format!("{more}\n[[matrix]]\nname = \"seal\"\nkind = \"damping\"\nfile = \"C.mtx\"\n");
    let scaled: Entries = case.model.stiffness.iter().map(|(i, j, value)| (*i, *j, 1e-6 * value)).collect();
    case.matrix("C.mtx", "symmetric", &scaled);
    case.run(FOOT_AND_HUB, CRAIG_BAMPTON, &seal("")).expect(ExitCode::Done);
    case.verify(&[]).expect(ExitCode::Done);
    let digits: Entries =
        scaled.iter().map(|(i, j, value)| (*i, *j, format!("{value:.5e}").parse().expect("a number"))).collect();
    case.matrix("C.mtx", "symmetric", &digits);
    case.run(FOOT_AND_HUB, CRAIG_BAMPTON, &seal("")).expect(ExitCode::Done);
    let mut grounded = scaled.clone();
    let at = grounded.iter().position(|(i, j, _)| (*i, *j) == (67, 67)).expect("the diagonal");
    grounded[at].2 *= 1.0 + 1e-6;
    case.matrix("C.mtx", "symmetric", &grounded);
    let ended = case.run(FOOT_AND_HUB, CRAIG_BAMPTON, &seal("")).expect(ExitCode::ModelPhysics);
    assert!(ended.err.contains("E-DAMPING-RIGID") && ended.err.contains("node 23 uy"), "{}", ended.err);
    case.run(FOOT_AND_HUB, CRAIG_BAMPTON, &seal("damping = { rigid_motion = \"resist\" }")).expect(ExitCode::Done);
    case.verify_with_job().expect(ExitCode::Done);
    // A force of deformation that pushes the body as a whole: C U vanishes, CᵀU does not.
    let mut pushing = scaled;
    pushing.extend([(0, 3, 0.01), (0, 6, -0.01)]);
    case.matrix("C.mtx", "general", &pushing);
    let ended = case.run(FOOT_AND_HUB, CRAIG_BAMPTON, &seal("")).expect(ExitCode::ModelPhysics);
    assert!(ended.err.contains("E-DAMPING-RIGID"), "{}", ended.err);
}

/// The rows of a straight beam that lie on its axis but for the rounding of a table take no part in the rotation about it: what damping
/// forces they have there is that rounding. A damper to the ground shows in the motions in which they take part.
#[test]
fn a_rounded_axis_of_a_straight_beam_is_no_damper_to_the_ground() {
    let line: Vec<[f64; 3]> = (0..4).map(|node| [0.05 * f64::from(node), 0.0, 0.0]).collect();
    let edges = [[0, 1], [1, 2], [2, 3]];
    let beam = frame(&line, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
    let scaled: Entries = beam.stiffness.iter().map(|(i, j, value)| (*i, *j, 1e-6 * value)).collect();
    let ends = r#"{ name = "a", nodes = [1] }, { name = "b", nodes = [4] }"#;
    let damping = "[[matrix]]\nname = \"c\"\nkind = \"damping\"\nfile = \"C.mtx\"\n";
    for (off, others) in [(1e-17, "E-DAMPING-RIGID"), (1e-15, "E-DAMPING-RIGID"), (1e-9, "M-28")] {
        let mut model = beam.clone();
        model.nodes[1][1] = off;
        let case = Case::new(model);
        case.matrix("C.mtx", "symmetric", &scaled);
        let ended = case.run(ends, HERTING, damping);
        assert_eq!(ended.code, ExitCode::Done, "{off}: {}", ended.err);
        for row in 6..12 {
            let grounded: Entries = scaled
                .iter()
                .map(|(i, j, value)| (*i, *j, if (*i, *j) == (row, row) { value * 1.001 } else { *value }))
                .collect();
            case.matrix("C.mtx", "symmetric", &grounded);
            let ended = case.run(ends, HERTING, damping);
            let is_told = ["E-DAMPING-RIGID", others].iter().any(|code| ended.err.contains(code));
            assert!(is_told, "{off} {row}: {}", ended.err);
        }
    }
}

/// M Φ diag(2ζω) Φᵀ M of the elastic modes of the full model, in double precision: its rows of rigid-body motion hold the errors of the modes.
#[test]
fn modal_damping_of_the_full_model_is_no_damper_to_the_ground() {
    let nodes: Vec<[f64; 3]> = (0..12).map(|k| [0.1, 0.07, 0.05].map(|x| (x * f64::from(k * k)).sin())).collect();
    let edges: Vec<[usize; 2]> = (1..12).map(|node| [node - 1, node]).chain([[0, 11], [3, 10]]).collect();
    let beams = frame(&nodes, &edges, &Section::round(0.015), &Material::STEEL_SI, Inertia::Consistent);
    let solid = brick([4, 2, 1], [0.31, 0.13, 0.05], &Material::STEEL_SI);
    // The terms of its entries cancel by symmetry, and some modes leave rows that hardly take part.
    let plate = brick([6, 6, 1], [0.6, 0.6, 0.006], &Material::STEEL_SI);
    let on_nodes = r#"{ name = "a", nodes = [1, 5, 11] }"#;
    let damping = "[[matrix]]\nname = \"modal\"\nkind = \"damping\"\nfile = \"C.mtx\"\n";
    for (what, model, n_damped) in [("beams", beams, usize::MAX), ("solid", solid, usize::MAX), ("plate", plate, 20)] {
        let case = Case::new(model);
        let n = case.model.n;
        let mass = dense(n, &case.model.mass);
        let (lambda, shapes) = modes([&dense(n, &case.model.stiffness), &mass]);
        let momenta = &mass * shapes;
        let made = |i: usize, j: usize| -> f64 {
            (6..n).take(n_damped).map(|k| momenta[(i, k)] * 0.04 * lambda[k].max(0.0).sqrt() * momenta[(j, k)]).sum()
        };
        let all = || (0..n).flat_map(|i| (0..=i).map(move |j| (i, j)));
        let entries: Entries = all().map(|(i, j)| (i as u32, j as u32, made(i, j))).collect();
        case.matrix("C.mtx", "symmetric", &entries);
        for method in [CRAIG_BAMPTON, HERTING] {
            let ended = case.run(on_nodes, method, damping);
            assert_eq!(ended.code, ExitCode::Done, "{what}: {}", ended.err);
            case.verify(&[]).expect(ExitCode::Done);
            case.verify_with_job().expect(ExitCode::Done);
        }
        // A millionth of its own damping, from one dof to the ground.
        let largest = entries.iter().fold(0.0f64, |max, entry| max.max(entry.2));
        let grounded: Entries = entries
            .iter()
            .map(|(i, j, value)| (*i, *j, if i == j && *value == largest { value * (1.0 + 1e-6) } else { *value }))
            .collect();
        case.matrix("C.mtx", "symmetric", &grounded);
        let ended = case.run(on_nodes, HERTING, damping);
        assert!(ended.err.contains("E-DAMPING-RIGID"), "{what}: {}", ended.err);
    }
}

/// The damper of 2 between nodes 5 and 25, along the line between them, and one of 10⁵ between two nodes of the patch, in nine digits: those
/// of a patch cancel when it is tied, and what is left of theirs is not what a rounding of the other is compared with.
#[test]
fn dampers_inside_a_patch_are_none_to_the_ground() {
    let case = Case::new(steel_brick());
    let mut entries = std::collections::BTreeMap::new();
    let mut damper = |[a, b]: [usize; 2], size: f64| {
        let [from, to] = [a, b].map(|label| case.model.nodes[label - 1]);
        let way: [f64; 3] = std::array::from_fn(|axis| to[axis] - from[axis]);
        let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        let row = |k: usize| (3 * ([a, b][k / 3] - 1) + k % 3, if k < 3 { way[k] } else { -way[k - 3] } / length);
        for ((i, x), (j, y)) in (0..6).flat_map(|i| (0..6).map(move |j| (row(i), row(j)))) {
            *entries.entry((i as u32, j as u32)).or_insert(0.0) += size * x * y;
        }
    };
    damper([5, 10], 1e5);
    damper([20, 15], 7e4);
    damper([1, 25], 2.0);
    let ten: Entries =
        entries.iter().map(|((i, j), value)| (*i, *j, format!("{value:.8e}").parse().expect("a number"))).collect();
    let seal = "\n[[matrix]]\nname = \"seal\"\nkind = \"damping\"\nfile = \"C.mtx\"\n";
    for coupling in ["rigid", "average"] {
        let interface = FOOT_AND_HUB.replace("rigid", coupling);
        case.matrix("C.mtx", "general", &ten);
        case.run(&interface, CRAIG_BAMPTON, seal).expect(ExitCode::Done);
        case.verify(&[]).expect(ExitCode::Done);
        case.verify_with_job().expect(ExitCode::Done);
        // A hundredth of the damper between the patches, from a node of the patch to the ground.
        let mut grounded = ten.clone();
        let at = grounded.iter().position(|(i, j, _)| (*i, *j) == (12, 12)).expect("a diagonal entry");
        grounded[at].2 += 0.02 * 1e5;
        case.matrix("C.mtx", "general", &grounded);
        let ended = case.run(&interface, CRAIG_BAMPTON, seal).expect(ExitCode::ModelPhysics);
        assert!(ended.err.contains("E-DAMPING-RIGID"), "{}", ended.err);
    }
}

/// Damping that drives a motion is possible and warned of.
#[test]
fn damping_that_drives_a_motion_warns() {
    let case = Case::new(steel_brick());
    let driving: Entries = case.model.stiffness.iter().map(|(i, j, value)| (*i, *j, -1e-7 * value)).collect();
    case.matrix("C.mtx", "symmetric", &driving);
    let seal = "[[matrix]]\nname = \"seal\"\nkind = \"damping\"\nfile = \"C.mtx\"\n";
    case.run(FOOT_AND_HUB, CRAIG_BAMPTON, seal).expect(ExitCode::Done);
    let ended = case.verify(&[]);
    assert!(ended.out.contains("damping takes energy from every motion"), "{}", ended.out);
    // The skew part of a damping takes nothing and gives nothing.
    case.matrix("C.mtx", "general", &skew(&any(&case.model, 9), case.model.n));
    case.run(FOOT_AND_HUB, CRAIG_BAMPTON, &format!("damping = {{ rigid_motion = \"resist\" }}\n{seal}"))
        .expect(ExitCode::Done);
    let checks = case.place.superelement("x.supel").metadata().verification.checks.clone();
    let energy = checks.iter().rev().find(|check| check.id == "M-28").expect("a record");
    assert!(energy.value.is_some_and(|value| value < 1e-6), "{energy:?}");
}

/// Where a thin plate moves as a whole, digits of K leave a force, and of damping in proportion to K a force and an energy of either sign.
#[test]
fn rayleigh_damping_of_few_digits_drives_no_motion() {
    let case = Case::new(rounded(&brick([4, 2, 1], [0.3, 0.1, 0.02], &Material::STEEL_SI), 7));
    let ends = r#"{ name = "a", nodes = [1, 6, 11, 16, 21, 26], coupling = "rigid" },
        { name = "b", nodes = [5, 10, 15, 20, 25, 30], coupling = "rigid" }"#;
    let law = r#"damping = { rayleigh = { mass = 1.0, stiffness = 1e-6, mass_acts_on = "deformation" } }"#;
    case.run(ends, HERTING, law).expect(ExitCode::Done);
    let checks = case.place.superelement("x.supel").metadata().verification.checks.clone();
    let energy = checks.iter().rev().find(|check| check.id == "M-28").expect("a record");
    assert_eq!(energy.verdict, Verdict::Pass, "{energy:?}");
    assert!(energy.value.is_some_and(|value| value > 1e-6), "{energy:?}");
    // It excuses no more than a few times what it is.
    assert!(energy.value.is_some_and(|value| energy.limit < 100.0 * value), "{energy:?}");
    for ended in [case.verify(&[]), case.verify_with_job()] {
        let line = ended.out.lines().find(|line| line.contains("damping takes energy from every motion"));
        assert!(line.is_some_and(|line| line.contains("pass")), "{}", ended.out);
    }
}

#[test]
fn more_shares_than_modes() {
    let case = Case::new(steel_brick());
    let ratios = vec!["0.01"; 30].join(", ");
    let law = format!("damping = {{ modal = {{ ratios = [{ratios}] }} }}");
    let ended = case.run(FOOT_AND_HUB, CRAIG_BAMPTON, &law).expect(ExitCode::Usage);
    assert!(ended.err.contains("E-DAMPING-MODES") && ended.err.contains("found 14"), "{}", ended.err);
    let place: &Place = &case.place;
    assert!(!place.path("x.supel").exists());
}
