//! K-8 to K-10: interface dofs that nothing acts on, that are at rest, or that a rigid body moves.

use faer::Mat;
use faer::linalg::solvers::Solve;
use supel::cli::ExitCode;
use supel_testing::place::supel;

use crate::{CONDENSED, CRAIG_BAMPTON, Case, HERTING, PATCH_AND_NODES, PATCHES, difference, part};

/// Rotations of the tip are as internal as if the job had not listed them.
#[test]
fn unloaded_dofs_are_internal() {
    for method in [CRAIG_BAMPTON, HERTING] {
        let unloaded = Case::new(PATCHES, method, "unloaded = [\"tip.rx\", \"tip.ry\", \"tip.rz\"]").made();
        let listed = Box::leak(
            PATCHES.replacen("name = \"tip\"", "name = \"tip\"\ndofs = [\"ux\", \"uy\", \"uz\"]", 1).into_boxed_str(),
        );
        let by_hand = Case::new(listed, method, "").made();
        assert_eq!(unloaded.file.tensors(), by_hand.file.tensors(), "{method}");
        assert_eq!(unloaded.n_b(), 9);
        assert!(unloaded.assumptions()[0].contains("tip.rx, tip.ry, tip.rz"), "{:?}", unloaded.assumptions());
        let connected = "connected = [\"root\", \"tip.ux\", \"tip.uy\", \"tip.uz\"]";
        let other_words = Case::new(PATCHES, method, connected).made();
        assert_eq!(other_words.file.tensors(), unloaded.file.tensors(), "{method}");
    }
}

/// Statics of what is left is K̂ of everything with the unloaded dofs condensed: K_cc − K_cu K_uu⁻¹ K_uc.
#[test]
fn statics_of_the_rest_is_unchanged_by_unloaded_dofs() {
    for (scene, left_out) in
        [("unloaded = [\"tip.rx\", \"tip.ry\", \"tip.rz\"]", 9..12), ("unloaded = [\"tip\"]", 6..12)]
    {
        let skipped = Case::new(PATCHES, CRAIG_BAMPTON, scene).made();
        let whole = Case::new(PATCHES, CRAIG_BAMPTON, scene).made_with(&["--no-skip"]);
        assert_eq!(whole.n_b(), 12);
        let u: Vec<usize> = left_out.clone().collect();
        let c: Vec<usize> = (0..12).filter(|i| !left_out.contains(i)).collect();
        let k = whole.stiffness();
        let answer = part(&k, &u, &u).partial_piv_lu().solve(part(&k, &u, &c));
        let condensed = part(&k, &c, &c) - part(&k, &c, &u) * answer;
        let size = part(&k, &c, &c);
        let found = part(&skipped.stiffness(), &(0..c.len()).collect::<Vec<_>>(), &(0..c.len()).collect::<Vec<_>>());
        let relative =
            |i: usize, j: usize| (found[(i, j)] - condensed[(i, j)]).abs() / (size[(i, i)] * size[(j, j)]).sqrt();
        let error = (0..c.len())
            .flat_map(|i| (0..c.len()).map(move |j| (i, j)))
            .map(|(i, j)| relative(i, j))
            .fold(0.0, f64::max);
        assert!(error <= CONDENSED, "{scene}: {error:e}");
    }
}

/// A patch that nothing is connected to stays rigid: its six dofs are internal.
#[test]
fn a_patch_without_connections_stays_rigid() {
    let made = Case::new(PATCHES, HERTING, "unloaded = [\"tip\"]").made();
    assert_eq!((made.n_b(), made.names()), (6, vec!["root"]));
    let recovery = ", recovery = { nodes = [7, 14, 28] }";
    let made = Case { write: recovery, ..Case::new(PATCHES, HERTING, "unloaded = [\"tip\"]") }.made();
    let rows = made.file.tensors().recovery.as_ref().expect("rows").rows().clone();
    // Nodes 7 and 14 are two of the patch, one above the other: nothing stretches the line between them (along y).
    let largest = (0..rows.cols()).map(|j| (rows[(1, j)] - rows[(4, j)]).abs()).fold(0.0, f64::max);
    let size = (0..rows.cols()).map(|j| rows[(1, j)].abs()).fold(0.0, f64::max);
    assert!(largest <= 1e-12 * size, "{largest:e} of {size:e}");
}

/// Grounded nodes are held dofs: the superelement is that of `[[fixed]]`, bit by bit.
#[test]
fn grounded_nodes_are_held() {
    for method in [CRAIG_BAMPTON, HERTING] {
        let grounded = Case::new(PATCH_AND_NODES, method, "grounded = [\"tip\"]").made();
        let (root, _) = PATCH_AND_NODES.split_once("[[interface]]\nname = \"tip\"").expect("two interfaces");
        let fixed = Case {
            rest: "[[fixed]]\nname = \"tip\"\nnodes = [7, 28, 63]\n",
            ..Case::new(Box::leak(root.to_owned().into_boxed_str()), method, "")
        };
        let fixed = fixed.made();
        assert_eq!(grounded.file.tensors(), fixed.file.tensors(), "{method}");
        assert_eq!(grounded.file.n_rigid(), 0);
        assert!(grounded.assumptions()[0].contains("at rest: tip"), "{:?}", grounded.assumptions());
        assert_eq!(grounded.report["body"]["model"]["held"]["n_dofs"], 9);
    }
}

/// What is at rest or part of a rigid body is no omission: without it another component would be reduced, and found right.
#[test]
fn what_is_at_rest_or_carried_stays_so_where_nothing_is_left_out() {
    let of_scene = [
        ("grounded = [\"tip\"]", (6, 0), "at rest: tip"),
        ("grounded = [\"root.ux\", \"tip\"]\nunloaded = [\"root.rx\"]", (5, 0), "at rest: root.ux, tip"),
        ("grounded = [\"root\"]\nconnected = [\"tip\"]", (9, 0), "at rest: root"),
        ("prescribed = [{ name = \"table\", interfaces = [\"tip\", \"root\"] }]", (6, 6), "rigid body table"),
    ];
    for (scene, sizes, assumed) in of_scene {
        let all = Case::new(PATCH_AND_NODES, HERTING, scene).made_with(&["--no-skip"]);
        assert_eq!((all.n_b(), all.file.n_rigid()), sizes, "{scene}");
        assert_eq!(all.assumptions().len(), 1, "{:?}", all.assumptions());
        assert!(all.assumptions()[0].contains(assumed), "{:?}", all.assumptions());
    }
}

/// Directions of a patch at rest: their rows and columns leave K̂, and nothing else changes.
#[test]
fn grounded_directions_of_a_patch_leave_the_stiffness() {
    let scene = "grounded = [\"root.ux\", \"root.uy\", \"root.uz\"]";
    let skipped = Case::new(PATCHES, CRAIG_BAMPTON, scene).made();
    let whole = Case::new(PATCHES, CRAIG_BAMPTON, "").made();
    assert_eq!((skipped.n_b(), whole.n_b(), skipped.file.n_rigid()), (9, 12, 3));
    let left: Vec<usize> = (3..12).collect();
    let own: Vec<usize> = (0..9).collect();
    let error = difference(&part(&skipped.stiffness(), &own, &own), &part(&whole.stiffness(), &left, &left));
    assert!(error <= CONDENSED, "{error:e}");
    let error = difference(&part(&skipped.mass(), &own, &own), &part(&whole.mass(), &left, &left));
    assert!(error <= CONDENSED, "mass: {error:e}");
}

/// An average whose directions are at rest in part, or as a whole, deforms as before: what is left of K̂, M̂ and the modes of the held interface are
/// those with all of it. Three of them are all that a row along one axis follows of the mean motion, and the row is not at rest for it.
#[test]
fn grounded_directions_of_an_average_leave_its_patch_free_to_deform() {
    let average = PATCHES.replacen("name = \"tip\"\ncoupling = \"rigid\"", "name = \"tip\"\ncoupling = \"average\"", 1);
    let average: &'static str = Box::leak(average.into_boxed_str());
    let whole = Case::new(average, CRAIG_BAMPTON, "").made();
    for (scene, grounded) in [
        ("grounded = [\"tip.ux\", \"tip.ry\", \"tip.rz\"]", &[6, 10, 11][..]),
        ("grounded = [\"tip.uy\", \"tip.rx\", \"tip.rz\"]", &[7, 9, 11]),
        ("grounded = [\"tip\"]", &[6, 7, 8, 9, 10, 11]),
    ] {
        let held = Case::new(average, CRAIG_BAMPTON, scene).made();
        let left: Vec<usize> = (0..12).filter(|at| !grounded.contains(at)).collect();
        let own: Vec<usize> = (0..left.len()).collect();
        for (part_of_held, part_of_whole) in [(held.stiffness(), whole.stiffness()), (held.mass(), whole.mass())] {
            let error = difference(&part(&part_of_held, &own, &own), &part(&part_of_whole, &left, &left));
            assert!(error <= CONDENSED, "{scene}: {error:e}");
        }
        // Rounding of the eigensolver is far below this, a patch that cannot deform far above.
        let pairs = held.file.tensors().frequencies.iter().zip(&whole.file.tensors().frequencies);
        assert!(pairs.clone().all(|(a, b)| (a / b - 1.0).abs() <= 1e-9), "{scene}: {:?}", pairs.collect::<Vec<_>>());
    }
}

/// Three nodes on one rigid body: K̂ = DᵀK̂D with the levers D, without a solve where nothing else is interface.
#[test]
fn prescribed_interfaces_move_as_one_body() {
    let scene = "prescribed = [{ name = \"table\", interfaces = [\"tip\", \"root\"] }]";
    for method in [CRAIG_BAMPTON, HERTING] {
        let skipped = Case::new(PATCH_AND_NODES, method, scene).made();
        let whole = Case::new(PATCH_AND_NODES, method, "").made();
        assert_eq!((skipped.names(), skipped.n_b(), whole.n_b()), (vec!["table"], 6, 15));
        let at = skipped.file.tensors().interface_positions[0];
        let levers = levers(&whole.file.tensors().interface_positions, at);
        let own: Vec<usize> = (0..15).collect();
        let mass = levers.transpose() * part(&whole.mass(), &own, &own) * &levers;
        let six: Vec<usize> = (0..6).collect();
        let error = difference(&part(&skipped.mass(), &six, &six), &mass);
        assert!(error <= CONDENSED, "{method}: {error:e}");
        // All motions are those of the body.
        let k = skipped.stiffness();
        let largest = part(&whole.stiffness(), &own, &own).norm_max();
        assert!(part(&k, &six, &six).norm_max() <= CONDENSED * largest, "{method}");
        assert!(skipped.checks().contains(&"M-32") && skipped.checks().contains(&"M-11"));
        assert!(skipped.assumptions()[0].contains("parts of the rigid body table"), "{:?}", skipped.assumptions());
        let held = supel(&["modes", &skipped.place.text("x.supel"), "--fix", "table"]);
        assert_eq!(held.code, ExitCode::Done, "{}", held.err);
    }
}

/// One of two interfaces on a carrier: the other one keeps its dofs, and K̂ is DᵀK̂D.
#[test]
fn a_carrier_next_to_another_interface() {
    let scene = "prescribed = [{ name = \"table\", interfaces = [\"tip\"] }]";
    let skipped = Case::new(PATCH_AND_NODES, CRAIG_BAMPTON, scene).made();
    let whole = Case::new(PATCH_AND_NODES, CRAIG_BAMPTON, "").made();
    assert_eq!((skipped.names(), skipped.n_b()), (vec!["root", "table"], 12));
    let at = skipped.file.tensors().interface_positions[1];
    let positions = &whole.file.tensors().interface_positions[1..];
    let of_nodes = nodes_about(positions, at);
    let levers = Mat::from_fn(15, 12, |i, j| match (i < 6, j < 6) {
        (true, true) => f64::from(u8::from(i == j)),
        (false, false) => of_nodes[(i - 6, j - 6)],
        _ => 0.0,
    });
    let (all, own): (Vec<usize>, Vec<usize>) = ((0..15).collect(), (0..12).collect());
    for (found, expected) in [(skipped.stiffness(), whole.stiffness()), (skipped.mass(), whole.mass())] {
        let expected = levers.transpose() * part(&expected, &all, &all) * &levers;
        let error = difference(&part(&found, &own, &own), &expected);
        assert!(error <= CONDENSED, "{error:e}");
    }
}

/// Levers of a patch node of six dofs and of nodes of three about a point, 15 × 6.
fn levers(positions: &[[f64; 3]], at: [f64; 3]) -> Mat<f64> {
    let nodes = nodes_about(&positions[1..], at);
    let of_patch = nodes_about(&positions[..1], at);
    Mat::from_fn(15, 6, |i, j| match i {
        0..3 => of_patch[(i, j)],
        3..6 => f64::from(u8::from(i == j)),
        _ => nodes[(i - 6, j)],
    })
}

/// u = t + θ × (x − at) of nodes of three dofs.
fn nodes_about(positions: &[[f64; 3]], at: [f64; 3]) -> Mat<f64> {
    Mat::from_fn(3 * positions.len(), 6, |i, j| {
        let [x, y, z] = [0, 1, 2].map(|axis| positions[i / 3][axis] - at[axis]);
        [[1.0, 0.0, 0.0, 0.0, z, -y], [0.0, 1.0, 0.0, -z, 0.0, x], [0.0, 0.0, 1.0, y, -x, 0.0]][i % 3][j]
    })
}
