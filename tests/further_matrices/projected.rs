//! Further matrices are ΨᵀAΨ of the full model, with their skew parts, and verification sees any other.

use supel::cli::ExitCode;
use supel_runtime::{Matrix, MatrixKind, Superelement, Tensors};
use supel_testing::place::{steel_brick, supel};

use super::{
    CRAIG_BAMPTON, Case, Entries, FOOT_AND_HUB, HERTING, any, assert_entries, dense, projected, skew, unpacked,
};

/// Five matrices of all kinds: two neither symmetric nor skew, one of them with entries above the diagonal alone; a skew and a symmetric
/// one by their lower triangles; and one in two parts.
const MATRICES: &str = r#"
[[matrix]]
name = "seal"
kind = "damping"
file = "C.mtx"
[[matrix]]
name = "spin"
kind = "gyroscopic"
file = "G.mtx"
[[matrix]]
name = "tension"
kind = "geometric-stiffness"
file = "S.mtx"
[[matrix]]
name = "follower"
kind = "circulatory"
file = "N.mtx"
[[matrix]]
name = "coupling"
kind = "other"
file = "U.mtx"
"#;

/// The case with the matrices in the order of the job.
fn case() -> (Case, [Entries; 5]) {
    let model = steel_brick();
    let symmetric: Entries = model.mass.iter().map(|(i, j, value)| (*i, *j, -3.0 * value)).collect();
    let upper: Entries = any(&model, 5).into_iter().filter(|(i, j, _)| i < j).collect();
    let all = [any(&model, 1), skew(&any(&model, 2), model.n), symmetric, any(&model, 4), upper];
    let case = Case::new(model);
    let words = ["general", "skew-symmetric", "symmetric", "general", "general"];
    for ((name, word), entries) in ["C.mtx", "G.mtx", "S.mtx", "N.mtx", "U.mtx"].iter().zip(words).zip(&all) {
        case.matrix(name, word, entries);
    }
    (case, all)
}

/// A rigid patch, the mean motion of one, and a dof that is held: T, the order of elimination and Ψ are applied to both sides of A.
#[test]
fn matrices_are_projected_with_their_skew_parts() {
    let (case, all) = case();
    let average = FOOT_AND_HUB.replace("\"rigid\"", "\"average\"");
    for (interfaces, reduction) in [(FOOT_AND_HUB, CRAIG_BAMPTON), (&average, HERTING), ("", HERTING)] {
        let more =
            format!("damping = {{ rigid_motion = \"resist\" }}\n{MATRICES}\n[[fixed]]\nnodes = [23]\ndofs = [\"uy\"]");
        let file = case.reduced(interfaces, reduction, &more);
        let found: Vec<_> = file.further_matrices().collect();
        let names: Vec<&str> = found.iter().map(|(named, _)| named.name.as_str()).collect();
        assert_eq!(names, ["seal", "spin", "tension", "follower", "coupling"]);
        assert!(found.iter().map(|(named, _)| named.kind).eq(MatrixKind::ALL));
        for ((_, matrix), entries) in found.iter().zip(&all) {
            // Rows of W are sums of the same columns in another order; two products of 135 terms, and those of a patch, are rounded.
            let expected = projected(&file, &dense(case.model.n, entries));
            assert_entries(&unpacked(matrix), &expected, 1e-12);
        }
        let [seal, spin] = [0, 1].map(|at| found[at].1);
        assert!((0..spin.rows()).all(|i| (0..spin.cols()).all(|j| spin[(i, j)] == -spin[(j, i)])));
        assert!(seal[(0, 1)] != seal[(1, 0)]);
        // One damping matrix and no law: the damping is that matrix.
        assert_eq!(file.tensors().damping.as_ref(), Some(seal));
        case.verify_with_job().expect(ExitCode::Done);
    }
}

/// What a job asks of `reduction`, and the interfaces it has: every method, Rubin's where the interface holds nothing.
fn by_every_method() -> [(&'static str, &'static str); 8] {
    const PIN: &str = r#"{ name = "pin", nodes = [1] }"#;
    [
        (FOOT_AND_HUB, CRAIG_BAMPTON),
        (FOOT_AND_HUB, HERTING),
        (FOOT_AND_HUB, r#"method = "rubin", modes = { count = 5 }"#),
        (FOOT_AND_HUB, r#"method = "macneal", modes = { count = 5 }"#),
        (FOOT_AND_HUB, r#"method = "guyan""#),
        (FOOT_AND_HUB, r#"method = "mixed-interface", held = ["hub"], modes = { count = 5 }"#),
        (FOOT_AND_HUB, r#"method = "mode-acceleration", modes = { file = "V.mtx" }"#),
        (PIN, r#"method = "rubin", modes = { count = 5 }"#),
    ]
}

/// Asserts that the file has WᵀAW of every matrix, and of a skew one nothing but the skew part.
#[track_caller]
fn assert_all_projected(case: &Case, all: &[Entries; 5], what: &str) {
    let file = case.place.superelement("x.supel");
    let found: Vec<_> = file.further_matrices().collect();
    assert!(found.iter().map(|(named, _)| named.kind).eq(MatrixKind::ALL), "{what}");
    for ((_, matrix), entries) in found.iter().zip(all) {
        assert_entries(&unpacked(matrix), &projected(&file, &dense(case.model.n, entries)), 1e-12);
    }
    let spin = found[1].1;
    assert!((0..spin.rows()).all(|i| (0..spin.cols()).all(|j| spin[(i, j)] == -spin[(j, i)])), "{what}");
}

/// Damping, gyroscopic and further matrices by every method, and through multipoint constraints. A gyroscopic matrix that is not skew is
/// refused.
#[test]
fn i_21_further_matrices_by_every_method() {
    let (case, all) = case();
    let n = case.model.n;
    let waves = (1..9).map(|k| (0..n).map(|row| (0.1 * f64::from(k) * (row + 1) as f64).sin()).collect());
    let columns: Vec<Vec<f64>> = waves.collect();
    let mut text = format!("%%MatrixMarket matrix array real general\n{n} {}\n", columns.len());
    columns.iter().flatten().for_each(|value| text += &format!("{value:.17e}\n"));
    case.place.write("V.mtx", text.as_bytes());
    // Node 23 stays in the middle between its neighbours along the brick, which lets rigid-body motion pass.
    let mut text = format!("%%MatrixMarket matrix coordinate real general\n3 {n} 9\n");
    for direction in 1..4 {
        for (node, factor) in [(23, 1.0), (22, -0.5), (24, -0.5)] {
            text += &format!("{direction} {} {factor}\n", 3 * (node - 1) + direction);
        }
    }
    case.place.write("G.u.mtx", text.as_bytes());
    let more = format!("damping = {{ rigid_motion = \"resist\" }}\n{MATRICES}");
    for (interfaces, reduction) in by_every_method() {
        case.reduced(interfaces, reduction, &more);
        assert_all_projected(&case, &all, reduction);
        let job = String::from_utf8(case.place.bytes("job.toml")).expect("UTF-8");
        let tied = job.replace("nodes.csv\" }", "nodes.csv\", constraints = \"G.u.mtx\" }");
        assert!(tied != job);
        case.place.write("job.toml", tied.as_bytes());
        supel(&["reduce", &case.place.text("job.toml"), "--quiet"]).expect(ExitCode::Done);
        assert_all_projected(&case, &all, &format!("{reduction}, tied"));
        case.verify_with_job().expect(ExitCode::Done);
    }
    let symmetric = more.replace("file = \"G.mtx\"", "file = \"S.mtx\"");
    let refused = case.run(FOOT_AND_HUB, CRAIG_BAMPTON, &symmetric).expect(ExitCode::InputData).err;
    assert!(refused.contains("E-MATRIX-KIND") && refused.contains("spin"), "{refused}");
}

#[test]
fn matrices_leave_by_export() {
    let (case, _) = case();
    let more = format!("damping = {{ rigid_motion = \"resist\" }}\n{MATRICES}");
    let file = case.reduced(FOOT_AND_HUB, CRAIG_BAMPTON, &more);
    for format in ["matrix-market", "op4"] {
        supel(&["export", &case.place.text("x.supel"), "--to", format]).expect(ExitCode::Done);
    }
    let r = file.n_coordinates();
    let text = String::from_utf8(case.place.bytes("x.matrices.mtx")).expect("UTF-8");
    let numbers: Vec<f64> = text.lines().skip(2).map(|line| line.parse().expect("a number")).collect();
    assert_eq!(text.lines().nth(1), Some(format!("{r} {}", 5 * r).as_str()));
    // Column by column, the matrices next to each other.
    let spin = &file.tensors().matrices[1];
    assert!((0..r).all(|j| (0..r).all(|i| numbers[(r + j) * r + i] == spin[(i, j)])));
    let names = String::from_utf8(case.place.bytes("x.matrices.csv")).expect("UTF-8");
    assert!(names.starts_with("name,kind\nseal,damping\nspin,gyroscopic\n"), "{names}");
    let op4 = String::from_utf8(case.place.bytes("x.op4")).expect("UTF-8");
    assert!(op4.contains("BAA") && op4.contains("FURTHER"), "{}", &op4[..400]);
}

/// Every matrix is recomputed entry by entry, and the damping from the matrices.
#[test]
fn matrices_that_are_not_those_of_the_model_fail() {
    let (case, _) = case();
    let more = format!("damping = {{ rigid_motion = \"resist\", modal = {{ ratio = 0.01 }} }}\n{MATRICES}");
    let whole = case.reduced(FOOT_AND_HUB, HERTING, &more);
    case.verify_with_job().expect(ExitCode::Done);
    case.verify(&[]).expect(ExitCode::Done);
    let r = whole.n_coordinates();
    let scaled = |matrix: &Matrix, at: (usize, usize)| {
        Matrix::from_fn(r, r, |i, j| matrix[(i, j)] * if (i, j) == at { 1.0 + 1e-6 } else { 1.0 })
    };
    let largest = |matrix: &Matrix, j: usize| {
        (0..r).max_by(|a, b| matrix[(*a, j)].abs().total_cmp(&matrix[(*b, j)].abs())).expect("rows")
    };
    let transposed = |matrix: &Matrix| Matrix::from_fn(r, r, |i, j| matrix[(j, i)]);
    type Change<'a> = (&'a str, &'a dyn Fn(&mut Tensors), bool);
    let changes: [Change<'_>; 6] = [
        ("an entry of damping", &|t| t.damping = t.damping.as_ref().map(|c| scaled(c, (largest(c, 7), 7))), true),
        ("damping turned over", &|t| t.damping = t.damping.as_ref().map(&transposed), true),
        ("a damping matrix", &|t| t.matrices[0] = scaled(&t.matrices[0], (largest(&t.matrices[0], 4), 4)), true),
        ("the sign of a skew matrix", &|t| t.matrices[1] = transposed(&t.matrices[1]), false),
        ("a modal entry", &|t| t.matrices[3] = scaled(&t.matrices[3], (largest(&t.matrices[3], r - 1), r - 1)), false),
        ("half of a matrix", &|t| t.matrices[4] = transposed(&t.matrices[4]), false),
    ];
    for (what, change, is_seen_alone) in changes {
        let mut tensors = whole.tensors().clone();
        change(&mut tensors);
        let altered = Superelement::new(tensors, whole.metadata().clone()).expect("a superelement");
        assert!(altered != whole, "{what} changes nothing");
        altered.write(&case.place.path("x.supel")).expect("written");
        let ended = case.verify_with_job().expect(ExitCode::CheckFailed);
        assert!(ended.out.contains("M-28"), "{what}: {}", ended.out);
        let alone = case.verify(&[]);
        assert_eq!(alone.code == ExitCode::CheckFailed, is_seen_alone, "{what}: {}", alone.out);
    }
}

/// Rows that are dropped leave a matrix as they leave K and M; an entry there is an error.
#[test]
fn rows_that_are_dropped_go() {
    let model = steel_brick();
    let n = model.n as u32;
    let entries = skew(&any(&model, 3), model.n);
    let with_row = |entries: &Entries| -> Entries {
        let moved = |at: u32| if at < 60 { at } else { at + 1 };
        entries.iter().map(|(i, j, value)| (moved(*i), moved(*j), *value)).collect()
    };
    let mut wider = model.clone();
    (wider.n, wider.stiffness, wider.mass) = (model.n + 1, with_row(&model.stiffness), with_row(&model.mass));
    // A scalar dof that nothing uses.
    let case = Case::new(model);
    let plain = |case: &Case, entries: &Entries| {
        case.matrix("G.mtx", "skew-symmetric", entries);
        let matrix = "[[matrix]]\nname = \"spin\"\nkind = \"gyroscopic\"\nfile = \"G.mtx\"\n";
        case.run(FOOT_AND_HUB, CRAIG_BAMPTON, matrix)
    };
    plain(&case, &entries).expect(ExitCode::Done);
    let expected = case.place.superelement("x.supel").tensors().matrices.clone();
    let wide = Case::new(wider);
    let mut map =
        String::from_utf8(wide.place.bytes("dofs.txt")).expect("UTF-8").lines().map(str::to_owned).collect::<Vec<_>>();
    let rows: Vec<String> = map.drain(..).map(|line| line.replace('.', ",")).collect();
    let direction = |line: &String| {
        let (node, number) = line.split_once(',').expect("two fields");
        format!("{node},{}", ["ux", "uy", "uz"][number.parse::<usize>().expect("a number") - 1])
    };
    let mut lines: Vec<String> = rows.iter().map(direction).collect();
    lines.insert(60, ",scalar".to_owned());
    wide.place.write("dofs.txt", format!("node,dof\n{}\n", lines.join("\n")).as_bytes());
    let job = |case: &Case| {
        let text = String::from_utf8(case.place.bytes("job.toml")).expect("UTF-8");
        case.place.write("job.toml", text.replace("nodes.csv\" }", "nodes.csv\", drop_empty = true }").as_bytes());
        supel(&["reduce", &case.place.text("job.toml"), "--quiet"])
    };
    let _ = plain(&wide, &with_row(&entries));
    job(&wide).expect(ExitCode::Done);
    assert_eq!(wide.place.superelement("x.supel").tensors().matrices, expected);
    let mut touching = with_row(&entries);
    touching.extend([(60, 3, 1.0), (3, 60, -1.0)]);
    let _ = plain(&wide, &touching);
    let ended = job(&wide);
    assert!(ended.err.contains("matrix \"spin\"") && ended.code != ExitCode::Done, "{}", ended.err);
    assert!(n > 0);
}
