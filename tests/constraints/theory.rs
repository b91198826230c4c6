//! Superelements of constrained models against dense algebra of the null space, and against the same model made otherwise.

use std::f64::consts::TAU;

use faer::Mat;
use supel::cli::ExitCode;
use supel_models::transform::join;
use supel_models::{Inertia, Material, Model, Section, brick, frame};
use supel_runtime::Superelement;
use supel_testing::place::{Place, assert_close, frequencies_hz, steel_brick, supel};

use crate::model::{SIZE, labels_at, lever, position, rigid_elements, row, tied_halves, with_hub};
use crate::{Case, Rows, assert_entries, assert_projected, eigenvalues, null_space, recovery, unpacked};

const HERTING: &str = r#"method = "herting", modes = { count = 6 }"#;
const CRAIG_BAMPTON: &str = r#"method = "craig-bampton", modes = { count = 6 }"#;

/// Nodes of the steel brick at its end.
const END: [i64; 9] = [5, 10, 15, 20, 25, 30, 35, 40, 45];
/// Three nodes at its other end.
const FOOT: &str = r#"{ name = "foot", nodes = [1, 11, 31] }"#;

/// Frequencies of the elastic modes of a free model on the null space of its constraints, `n_zero` zero ones left out.
fn elastic_hz(case: &Case, n_zero: usize, count: usize) -> Vec<f64> {
    let lambda = eigenvalues([&case.stiffness(), &case.mass()], &null_space(&case.g()));
    assert!(lambda[n_zero - 1].abs() < 1e-9 * lambda[n_zero], "{:e} of {:e}", lambda[n_zero - 1], lambda[n_zero]);
    lambda[n_zero..n_zero + count].iter().map(|lambda| lambda.sqrt() / TAU).collect()
}

/// Rounding of a dense spectrum: its largest eigenvalue is 10⁴ times the first elastic one here, and so are roundings of it.
const DENSE: f64 = 1e-9;

#[test]
fn rigid_elements_are_a_rigid_patch() {
    let centre = [1.0, 0.155, 0.115];
    let (model, hub) = with_hub(&steel_brick(), centre);
    let rows = rigid_elements(&model, hub, &END);
    let case = Case::new(model, rows);
    let reduced = case.reduced(&format!("{FOOT}, {{ name = \"hub\", nodes = [{hub}] }}"), CRAIG_BAMPTON, "");
    assert_projected(&case, &reduced);
    let patch = patched(CRAIG_BAMPTON);
    for (found, expected) in [
        (&reduced.tensors().stiffness, &patch.tensors().stiffness),
        (&reduced.tensors().mass, &patch.tensors().mass),
        (&reduced.tensors().rigid_body_modes, &patch.tensors().rigid_body_modes),
    ] {
        let (found, expected) = (unpacked(found), unpacked(expected));
        let size = |i: usize, j: usize| match found.nrows() == found.ncols() {
            true => (expected[(i, i)].abs() * expected[(j, j)].abs()).sqrt(),
            false => 1.0,
        };
        // One pencil in two orders of elimination, K_II with a condition of some 10⁴.
        assert_entries(&found, &expected, |i, j| 1e-10 * size(i, j));
    }
    assert_close(&frequencies_hz(&reduced), &frequencies_hz(&patch), 1e-11);
    assert_eq!(reduced.metadata().model.n_dofs, 135 - 27 + 6);
    let (codes, told) = case.told();
    assert_eq!(codes, [""; 0]);
    assert!(told.contains("27 constraints, 27 dofs follow others"), "{told}");
}

/// The steel brick with its end as a rigid patch.
fn patched(reduction: &str) -> Superelement {
    let place = Place::with(&steel_brick());
    let job = format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{FOOT}, {{ name = "hub", nodes = {END:?}, coupling = "rigid", origin = [1.0, 0.155, 0.115] }}]
reduction = {{ {reduction} }}
write     = {{ superelement = "x.supel" }}
"#
    );
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    place.superelement("x.supel")
}

/// Two halves with duplicate nodes tied one by one are the whole; whichever side of the tie the interface takes, the other follows.
#[test]
fn tied_halves_are_the_whole() {
    let ends = [[0.0, 0.0, 0.0], [0.0, 0.31, 0.0], [1.0, 0.31, 0.23], [1.0, 0.0, 0.115]];
    let middle = [0.5, 0.31, 0.115];
    let (halves, rows) = tied_halves([2, 2, 2], [2, 2, 2]);
    let whole = brick([4, 2, 2], SIZE, &Material::STEEL_SI);
    let case = Case::new(halves, rows);
    let whole = Case::new(whole, vec![vec![]]);
    for side in 0..2 {
        let of_middle: Vec<i64> = (0..case.model.nodes.len())
            .filter(|node| (0..3).all(|axis| (case.model.nodes[*node][axis] - middle[axis]).abs() < 1e-9))
            .map(|node| case.model.labels[node])
            .collect();
        assert_eq!(of_middle.len(), 2);
        let mut labels = labels_at(&case.model, &ends);
        labels.push(of_middle[side]);
        let found = case.reduced(&format!("{{ name = \"ends\", nodes = {labels:?} }}"), HERTING, "");
        assert_projected(&case, &found);
        let mut labels = labels_at(&whole.model, &ends);
        labels.extend(labels_at(&whole.model, &[middle]));
        let expected = whole.reduced(&format!("{{ name = \"ends\", nodes = {labels:?} }}"), HERTING, "");
        assert_close(&frequencies_hz(&found), &frequencies_hz(&expected), 1e-10);
        assert!(found.metadata().model.mass_properties.is_some());
        // Constraint modes are the same statics; modes of Herting may have either sign.
        let n_b = 15;
        let block = |file: &Superelement| Mat::from_fn(n_b, n_b, |i, j| file.tensors().stiffness[(i, j)]);
        let (found, expected) = (block(&found), block(&expected));
        assert_entries(&found, &expected, |i, j| 1e-10 * (expected[(i, i)] * expected[(j, j)]).sqrt());
        let report = case.place.report("x.report.json");
        assert_eq!(report["body"]["model"]["n_bodies"], 1);
        assert_eq!(report["body"]["model"]["rigid_body_modes"]["count"], 6);
    }
}

/// Meshes that do not match, tied by the shape functions of the coarse one; some constraints twice.
#[test]
fn meshes_that_do_not_match() {
    let (model, mut rows) = tied_halves([2, 2, 2], [3, 3, 4]);
    rows.push(rows[4].clone());
    let sum: Vec<(u32, f64)> = rows[7].iter().chain(&rows[10]).copied().collect();
    rows.push(sum);
    let n_rows = rows.len();
    let case = Case::new(model, rows);
    let interface = format!(
        "{{ name = \"ends\", nodes = {:?} }}",
        labels_at(&case.model, &[[0.0, 0.0, 0.0], [0.0, 0.31, 0.23], [1.0, 0.0, 0.23]])
    );
    let reduced = case.reduced(&interface, HERTING, "");
    assert_projected(&case, &reduced);
    assert_close(&frequencies_hz(&reduced), &elastic_hz(&case, 6, frequencies_hz(&reduced).len()), DENSE);
    let (codes, told) = case.told();
    assert_eq!(codes, [""; 0]);
    assert!(told.contains(&format!("{n_rows} constraints, {} dofs follow others", n_rows - 2)), "{told}");
    assert!(told.contains("left out because they follow from others: rows"), "{told}");
    let again = case.reduced(&interface, HERTING, "");
    assert_eq!(again.tensors(), reduced.tensors());
}

/// The mean motion of a patch given as constraints on a node without stiffness and mass (RBE3), a rigid rod from it to another node, and
/// dofs that the job holds: loads, further matrices, quantities and recovery go through all of it.
#[test]
fn everything_follows_the_constraints() {
    let (model, hub) = with_hub(&steel_brick(), [1.0, 0.155, 0.115]);
    let (model, tip) = with_hub(&model, [1.3, 0.155, 0.2]);
    let mut rows = mean_motion(&model, hub, &END);
    rows.extend(rigid_elements(&model, hub, &[tip]));
    rows.extend((3..6).map(|axis| [(tip, 1.0), (hub, -1.0)].map(|(node, g)| (row(&model, (node, axis)), g)).to_vec()));
    let case = Case::new(model, rows);
    let n = case.model.n;
    let symmetric: Vec<(u32, u32, f64)> = case.model.stiffness.iter().map(|(i, j, v)| (*i, *j, 1e-6 * v)).collect();
    let mut text = format!("%%MatrixMarket matrix coordinate real general\n{n} {n} {}\n", symmetric.len());
    symmetric.iter().for_each(|(i, j, v)| text += &format!("{} {} {v:e}\n", i + 1, j + 1));
    case.place.write("A.mtx", text.as_bytes());
    let at = row(&case.model, (tip, 4)) + 1;
    case.place.write(
        "R.mtx",
        format!("%%MatrixMarket matrix coordinate real general\n1 {n} 2\n1 {at} 3\n1 7 -2\n").as_bytes(),
    );
    case.place.write("R.csv", b"name,unit\nturn,1\n");
    let more = format!(
        "[[fixed]]\nnodes = [1, 11]\n[[load]]\nname = \"pull\"\nnodes = [{tip}, 20]\nforce = [3.0, 5.0, -7.0]\n\
         [[matrix]]\nname = \"a\"\nkind = \"other\"\nfile = \"A.mtx\"\n"
    );
    // The tip is an interface node: its own dofs stay, and others follow them.
    let interface = format!("{{ name = \"tip\", nodes = [{tip}] }}");
    case.run("", &interface, CRAIG_BAMPTON, &more).expect(ExitCode::Done);
    let mut job = String::from_utf8(case.place.bytes("job.toml")).expect("UTF-8");
    job += "quantities = { matrix = \"R.mtx\", names = \"R.csv\" }\n";
    case.place.write("job.toml", job.as_bytes());
    supel(&["reduce", &case.place.text("job.toml")]).expect(ExitCode::Done);
    let (file, path) = (case.place.text("x.supel"), case.place.text("job.toml"));
    supel(&["verify", &file, "--job", &path]).expect(ExitCode::Done);
    let reduced = case.place.superelement("x.supel");
    assert_projected(&case, &reduced);
    let (w, tensors) = (recovery(&reduced), reduced.tensors());
    for (label, axis) in [(1, 0), (11, 2)] {
        let at = row(&case.model, (label, axis)) as usize;
        assert!((0..w.ncols()).all(|j| w[(at, j)] == 0.0), "held");
    }
    let mut force = Mat::<f64>::zeros(n, 1);
    for (axis, value) in [3.0, 5.0, -7.0].into_iter().enumerate() {
        for label in [tip, 20] {
            force[(row(&case.model, (label, axis as u8)) as usize, 0)] += 0.5 * value;
        }
    }
    let vectors = unpacked(tensors.load_vectors.as_ref().expect("loads"));
    assert_entries(&vectors, &(w.transpose() * &force), |i, _| {
        1e-12 * (0..n).map(|row| w[(row, i)].abs() * 7.0).sum::<f64>()
    });
    let quantity = unpacked(tensors.quantities.as_ref().expect("quantities"));
    let expected = Mat::from_fn(1, w.ncols(), |_, j| 3.0 * w[(at as usize - 1, j)] - 2.0 * w[(6, j)]);
    assert_entries(&quantity, &expected, |_, j| 1e-13 * (3.0 * w[(at as usize - 1, j)].abs() + 2.0 * w[(6, j)].abs()));
    let carried = reduced.further_matrices().next().expect("a matrix");
    let k = unpacked(&tensors.stiffness);
    let a = unpacked(carried.1);
    assert_entries(&a, &Mat::from_fn(k.nrows(), k.ncols(), |i, j| 1e-6 * k[(i, j)]), |i, j| {
        1e-6 * 1e-10 * (k[(i, i)] * k[(j, j)]).sqrt()
    });
}

/// q_h = (LᵀL)⁻¹Lᵀ u of the translations of a patch.
fn mean_motion(model: &Model, hub: i64, nodes: &[i64]) -> Rows {
    let centre = position(model, hub);
    let l = Mat::from_fn(3 * nodes.len(), 6, |i, j| {
        let x = position(model, nodes[i / 3]);
        lever([0, 1, 2].map(|k| x[k] - centre[k]), i % 3)[j]
    });
    let inverse = (l.transpose() * &l).llt(faer::Side::Lower).expect("independent motions");
    let mean = faer::linalg::solvers::Solve::solve(&inverse, l.transpose().to_owned());
    let of_direction = |direction: usize| {
        let own = std::iter::once((row(model, (hub, direction as u8)), 1.0));
        let terms = (0..l.nrows()).map(|i| (row(model, (nodes[i / 3], (i % 3) as u8)), -mean[(direction, i)]));
        own.chain(terms.filter(|(_, value)| value.abs() > 1e-14)).collect()
    };
    (0..6).map(of_direction).collect()
}

/// Two parts that share a point: a joint that leaves three rotations, by the null space of G.
#[test]
fn spherical_joint_between_two_parts() {
    let (model, rows) = tied_halves([2, 2, 2], [2, 2, 2]);
    // The rows of one node of the tie.
    let case = Case::new(model, rows[12..15].to_vec());
    let lambda = eigenvalues([&case.stiffness(), &case.mass()], &null_space(&case.g()));
    assert!(lambda[8].abs() < 1e-9 * lambda[9]);
    let labels = labels_at(
        &case.model,
        &[[0.0, 0.0, 0.0], [0.0, 0.31, 0.0], [0.0, 0.0, 0.23], [1.0, 0.31, 0.0], [1.0, 0.0, 0.23], [1.0, 0.0, 0.0]],
    );
    let reduced = case.reduced(&format!("{{ name = \"ends\", nodes = {labels:?} }}"), HERTING, "");
    assert_projected(&case, &reduced);
    let expected: Vec<f64> =
        lambda[9..].iter().take(frequencies_hz(&reduced).len()).map(|lambda| lambda.sqrt() / TAU).collect();
    assert_close(&frequencies_hz(&reduced), &expected, DENSE);
}

/// A spherical joint between two parts, of which a few nodes on average hold the first: it can turn about the line that they and the joint
/// leave, inside K_II, where rounding of the average is all that resists it.
#[test]
fn a_turn_that_leaves_the_interface_at_rest_is_told() {
    for (cells, joint, few, held) in [
        ([2, 3, 3], 4, [11, 26, 22, 7, 17], ["uy", "rx", "ry"]),
        ([2, 3, 3], 10, [13, 5, 11, 20, 2], ["uy", "rx", "ry"]),
        ([5, 5, 5], 27, [4, 7, 17, 10, 19], ["uz", "rx", "rz"]),
    ] {
        let (model, rows) = tied_halves([2, 2, 2], cells);
        let corners = labels_at(&model, &[[1.0, 0.0, 0.0], [1.0, 0.31, 0.0], [1.0, 0.0, 0.23]]);
        let case = Case::new(model, rows[3 * joint..][..3].to_vec());
        let interface = |dofs: &[&str]| {
            let of_few = format!("nodes = {few:?}, coupling = \"average\", dofs = {dofs:?}");
            format!("{{ name = \"ends\", nodes = {corners:?} }}, {{ name = \"few\", {of_few} }}")
        };
        for reduction in [HERTING, r#"method = "craig-bampton", modes = { count = 4 }"#] {
            let ended = case.run("", &interface(&held[..2]), reduction, "");
            assert_eq!(ended.code, ExitCode::ModelPhysics, "joint {joint}: {}{}", ended.out, ended.err);
            let is_told = ended.err.contains("E-INTERFACE-RANK") && ended.err.contains("8 of the 9");
            assert!(is_told, "joint {joint}: {}", ended.err);
        }
        // What would hold it, and bears no load.
        case.run("", &interface(&held), HERTING, "").expect(ExitCode::Done);
        let ended =
            case.run("", &interface(&held), HERTING, &format!("scene = {{ unloaded = [\"few.{}\"] }}", held[2]));
        assert!(ended.err.contains(&format!("`few.{}`", held[2])), "joint {joint}: {}{}", ended.out, ended.err);
    }
}

/// Two frames bolted at three points between nodes at one place, which levers alone tell apart: nine equations, of which three follow from
/// the others. Coordinates differ by rounding, or a little; the bolts are where they are.
#[test]
fn bolts_between_nodes_at_one_place() {
    let section = Section::round(0.02);
    for apart in [0.0, 5.6e-17, 1e-12, 1e-9, 1e-6, 1e-3] {
        let first: Vec<[f64; 3]> = (0..4).map(|i| [0.1 * f64::from(i), 0.0, 0.0]).collect();
        let mut second: Vec<[f64; 3]> = (0..4).map(|i| [0.3, 0.1 * f64::from(i), 0.03 * f64::from(i * i)]).collect();
        second.iter_mut().for_each(|x| x[2] += apart);
        let edges = [[0, 1], [1, 2], [2, 3]];
        let part = |nodes: &[[f64; 3]]| frame(nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent);
        let model = join(&part(&first), &part(&second), &[]);
        let bolts = [[0.3, 0.05, 0.0], [0.3, -0.05, 0.01], [0.35, 0.0, 0.03]];
        let of_bolt = |bolt: [f64; 3], axis: usize| -> Vec<(u32, f64)> {
            let of_node = |label: i64, sign: f64| {
                let x = position(&model, label);
                let factors = lever([0, 1, 2].map(|k| bolt[k] - x[k]), axis).into_iter().enumerate();
                let terms = factors.filter(|(_, factor)| *factor != 0.0);
                terms.map(|(k, factor)| (row(&model, (label, k as u8)), sign * factor)).collect::<Vec<_>>()
            };
            [of_node(4, 1.0), of_node(5, -1.0)].concat()
        };
        let rows: Rows = bolts.iter().flat_map(|bolt| (0..3).map(|axis| of_bolt(*bolt, axis))).collect();
        let case = Case::new(model, rows);
        let reduced = case.reduced(r#"{ name = "a", nodes = [1] }, { name = "b", nodes = [8] }"#, HERTING, "");
        assert_projected(&case, &reduced);
        assert_close(&frequencies_hz(&reduced), &elastic_hz(&case, 6, frequencies_hz(&reduced).len()), DENSE);
        let (_, told) = case.told();
        assert!(told.contains("9 constraints, 6 dofs follow others"), "{apart:e}: {told}");
    }
}

/// Constraints between nodes of a patch follow from it where they are rigid motion; those of a patch with other nodes reach its node.
#[test]
fn constraints_at_a_rigid_patch() {
    let (model, hub) = with_hub(&steel_brick(), [1.2, 0.1, 0.1]);
    // Rigid elements to three nodes of the patch hold all six dofs of the hub, and three of nine equations are left over.
    let rows = rigid_elements(&model, hub, &[45, 5, 15]);
    let case = Case::new(model, rows);
    let interface = format!("{FOOT}, {{ name = \"end\", nodes = {END:?}, coupling = \"rigid\" }}");
    let reduced = case.reduced(&interface, CRAIG_BAMPTON, "");
    assert_projected(&case, &reduced);
    let (_, told) = case.told();
    assert!(told.contains("9 constraints, 6 dofs follow others"), "{told}");
    let place = Case::new(steel_brick(), vec![vec![]]);
    let without = place.reduced(&interface, CRAIG_BAMPTON, "");
    assert_close(&frequencies_hz(&reduced), &frequencies_hz(&without), 1e-11);
}

/// Modes of a file that satisfy the constraints are followed; those that do not are followed as far as they can be.
#[test]
fn modes_of_a_file_follow() {
    let (model, rows) = tied_halves([2, 2, 2], [2, 2, 2]);
    let case = Case::new(model, rows);
    let (g, n) = (case.g(), case.model.n);
    let z = null_space(&g);
    let any = Mat::from_fn(n, 1, |i, _| (1.7 * i as f64).sin());
    let inside = &z * (z.transpose() * &any);
    let mut text = format!("%%MatrixMarket matrix array real general\n{n} 2\n");
    [&inside, &any].iter().for_each(|mode| (0..n).for_each(|i| text += &format!("{:e}\n", mode[(i, 0)])));
    case.place.write("V.mtx", text.as_bytes());
    let labels = labels_at(&case.model, &[[0.0, 0.0, 0.0], [0.0, 0.31, 0.0], [1.0, 0.31, 0.23]]);
    let interface = format!("{{ name = \"ends\", nodes = {labels:?} }}");
    case.run("", &interface, r#"method = "mode-acceleration", modes = { file = "V.mtx" }"#, "").expect(ExitCode::Done);
    let report = case.place.report("x.report.json");
    let shares: Vec<f64> = report["body"]["reduction"]["expansion"]["modes"]
        .as_array()
        .unwrap_or_else(|| panic!("{}", report["body"]["reduction"]["expansion"]))
        .iter()
        .map(|mode| mode["not_followed"].as_f64().expect("a share"))
        .collect();
    // min (v − Zy)ᵀM(v − Zy) by dense algebra.
    let mass = case.mass();
    let projected = (z.transpose() * &mass * &z).llt(faer::Side::Lower).expect("definite");
    let y = faer::linalg::solvers::Solve::solve(&projected, z.transpose() * &mass * &any);
    let left = &any - &z * &y;
    let square = |x: &Mat<f64>| (x.transpose() * &mass * x)[(0, 0)];
    let expected = (square(&left) / square(&any)).sqrt();
    assert!(shares[0] == 0.0 && (shares[1] / expected - 1.0).abs() < 1e-12, "{shares:?}, {expected}");
}
