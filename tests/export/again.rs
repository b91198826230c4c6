//! An exported superelement is a model that is reduced again, to itself.

use serde_json::Value;
use supel::cli::ExitCode;
use supel_models::transform::{carrying, join, translated};
use supel_models::{Material, brick};
use supel_runtime::{Coordinate, Superelement};
use supel_testing::cases::hinged;
use supel_testing::place::{Place, assert_close, frequencies_hz, steel_brick, supel};

use super::little_stiffness::rows_with_stiffness;
use super::{HELD, HINGED, export, reduced};

const METHODS: [&str; 2] = ["craig-bampton", "herting"];

/// Reduces x.supel again by the job that was exported with it, and by itself, which is the same.
fn again(place: &Place) -> (Superelement, Value) {
    export(place, "matrix-market", &[]).expect(ExitCode::Done);
    let ended = supel(&["reduce", &place.text("x.job.toml")]);
    let job = String::from_utf8(place.bytes("x.job.toml")).expect("text");
    assert_eq!(ended.code, ExitCode::Done, "{}{}\n{job}", ended.out, ended.err);
    supel(&["reduce", &place.text("x.supel"), "--output", &place.text("direct.supel")]).expect(ExitCode::Done);
    assert!(place.superelement("direct.supel").tensors() == place.superelement("x.again.supel").tensors(), "{job}");
    (place.superelement("x.again.supel"), place.report("x.again.report.json"))
}

fn bars_hz(superelement: &Superelement) -> Vec<f64> {
    let bar = |coordinate: &Coordinate| match coordinate {
        Coordinate::ElasticMode { error_bar_hz, .. } | Coordinate::FixedInterfaceMode { error_bar_hz, .. } => {
            Some(error_bar_hz.expect("a bar"))
        }
        _ => None,
    };
    superelement.metadata().coordinates.iter().filter_map(bar).collect()
}

/// Retained eigenpairs are those of the reduced pencil (34), so that reducing it again finds them: as far off as the bars of both
/// runs say, of which each holds for its own matrices.
#[track_caller]
fn assert_same_spectrum(first: &Superelement, second: &Superelement) {
    let (found, expected) = (frequencies_hz(second), frequencies_hz(first));
    let (bars, again) = (bars_hz(first), bars_hz(second));
    assert_eq!((found.len(), bars.len(), again.len()), (expected.len(), expected.len(), expected.len()));
    for k in 0..found.len() {
        let (difference, bar) = ((found[k] - expected[k]).abs(), bars[k] + again[k]);
        assert!(difference <= bar, "mode {k}: {} and {} Hz differ by {difference:e}, {bar:e}", found[k], expected[k]);
        // Bars that say nothing would let anything pass.
        assert!(bar < 1e-6 * expected[k], "mode {k} of {} Hz: {bar:e}", expected[k]);
    }
}

#[test]
fn a_superelement_is_reduced_to_itself() {
    let supports = [("", 6), (HELD, 0), (HINGED, 1)];
    for (method, (fixed, n_rigid)) in METHODS.into_iter().flat_map(|method| supports.map(|support| (method, support))) {
        let place = reduced(method, fixed);
        let first = place.superelement("x.supel");
        let (second, report) = again(&place);
        assert_same_spectrum(&first, &second);
        let names = |s: &Superelement| {
            let nodes = s.metadata().interface_nodes.iter();
            nodes.map(|node| (node.name.clone(), node.dofs.clone(), node.position)).collect::<Vec<_>>()
        };
        assert_eq!(names(&second), names(&first), "{method} {fixed}");
        assert_eq!(second.n_coordinates(), first.n_coordinates(), "{method} {fixed}");
        assert_eq!((first.n_rigid(), second.n_rigid()), (n_rigid, n_rigid), "{method} {fixed}");
        // One body, whatever its modal amplitudes are coupled with.
        assert_eq!(report["body"]["model"]["n_bodies"], 1);
        assert_eq!(report["body"]["model"]["n_nodes"], 4);
    }
}

/// Rigid-body motion leaves modal amplitudes at rest: mass, centre and inertia are those of the component.
#[test]
fn mass_properties_survive() {
    for method in ["craig-bampton", "herting", "guyan"] {
        let place = reduced(method, "");
        let properties = |s: &Superelement| s.metadata().model.mass_properties.expect("of a free component");
        let first = properties(&place.superelement("x.supel"));
        let (second, _) = again(&place);
        let second = properties(&second);
        // Sums of n entries of M, and of the condensed one, round by n ε relative to their terms, with a margin of ten.
        let bound = 10.0 * 135.0 * f64::EPSILON;
        assert!((second.mass / first.mass - 1.0).abs() <= bound, "{method}: {} and {}", second.mass, first.mass);
        for axis in 0..3 {
            let distance = (second.center_of_mass[axis] - first.center_of_mass[axis]).abs();
            assert!(distance <= 10.0 * bound, "{method}: {distance:e}");
        }
    }
}

/// The stiffness of a slender part is condensed to one that is softer by orders, and keeps the rounding of the larger numbers: the
/// digits that the job states are those that rigid-body motion leaves. Taken for exact its motions cost energy of either sign, which shows the
/// same roundings.
#[test]
fn a_slender_superelement_states_its_digits() {
    let place = Place::with(&brick([24, 1, 1], [3.0, 0.05, 0.04], &Material::STEEL_SI));
    let flags =
        "--rigid-interface left=1,26,51,76 --rigid-interface right=25,50,75,100 --method craig-bampton --modes 4";
    place.reduce(&place.model_flags(), flags).expect(ExitCode::Done);
    let (second, _) = again(&place);
    assert_same_spectrum(&place.superelement("x.supel"), &second);
    let job = String::from_utf8(place.bytes("x.job.toml")).expect("text");
    let without: Vec<&str> = job.lines().filter(|line| !line.starts_with("stiffness_digits")).collect();
    assert_eq!(without.len() + 1, job.lines().count(), "{job}");
    place.write("x.job.toml", without.join("\n").as_bytes());
    supel(&["reduce", &place.text("x.job.toml")]).expect(ExitCode::Done);
    assert_same_spectrum(&place.superelement("x.supel"), &place.superelement("x.again.supel"));
}

/// Methods whose file is in coordinates of another one, and inertia relief that was asked for.
#[test]
fn other_methods_are_reduced_again() {
    let place = reduced("rubin", "");
    let (second, _) = again(&place);
    assert_same_spectrum(&place.superelement("x.supel"), &second);
    let place = Place::with_brick();
    let flags = "--interface foot=1,11,31,41 --method craig-bampton --modes 4 --inertia-relief";
    place.reduce(&place.model_flags(), flags).expect(ExitCode::Done);
    let (second, _) = again(&place);
    let is_relief = |c: &&Coordinate| matches!(c, Coordinate::InertiaRelief { .. });
    assert_eq!(second.metadata().coordinates.iter().filter(is_relief).count(), 6);
    assert_same_spectrum(&place.superelement("x.supel"), &second);
}

/// Statics alone, the mean motion of a patch, and a model of multipoint constraints: what was condensed, averaged or tied is none of that any
/// more, and the matrices of the interface stay what they are.
#[test]
fn condensed_averaged_and_tied_models_are_reduced_again() {
    let herting = "method = \"herting\", modes = { count = 4 }";
    for (what, constraints, coupling, reduction) in [
        ("statics", "", "rigid", "method = \"guyan\""),
        ("a mean motion", "", "average", herting),
        ("constraints", ", constraints = \"G.mtx\"", "rigid", herting),
        ("constraints in statics", ", constraints = \"G.mtx\"", "average", "method = \"guyan\""),
    ] {
        let place = Place::with_brick();
        // Node 23 stays in the middle between its neighbours along the brick.
        let terms = (1..4).flat_map(|direction| {
            [(23, 1.0), (22, -0.5), (24, -0.5)].map(|(node, factor)| (direction, 3 * (node - 1) + direction, factor))
        });
        let terms: Vec<String> = terms.map(|(row, column, factor)| format!("{row} {column} {factor}\n")).collect();
        let head = "%%MatrixMarket matrix coordinate real general\n3 135 9\n";
        place.write("G.mtx", (head.to_owned() + &terms.concat()).as_bytes());
        let job = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\"{constraints} }}\n\
             interface = [{{ name = \"foot\", nodes = [1, 11, 31] }}, {{ name = \"hub\", nodes = [5, 10, 15, 20, 25], \
             coupling = \"{coupling}\" }}]\nreduction = {{ {reduction} }}\nwrite = {{ superelement = \"x.supel\" }}\n"
        );
        place.write("job.toml", job.as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
        let first = place.superelement("x.supel");
        let (second, report) = again(&place);
        assert_same_spectrum(&first, &second);
        assert_eq!(second.n_coordinates(), first.n_coordinates(), "{what}");
        assert_eq!((first.n_rigid(), second.n_rigid()), (6, 6), "{what}");
        assert_eq!(report["body"]["model"]["n_bodies"], 1, "{what}");
        let (found, expected) = (second.tensors(), first.tensors());
        let n_b = first.n_interface();
        for (i, j) in (0..n_b).flat_map(|i| (0..n_b).map(move |j| (i, j))) {
            for (found, expected) in [(&found.stiffness, &expected.stiffness), (&found.mass, &expected.mass)] {
                let size = (expected[(i, i)] * expected[(j, j)]).sqrt();
                // K̂ has no coupling of interface and amplitudes; what it lacks of K̂Û = 0 is 10⁻¹² of its terms.
                assert!((found[(i, j)] - expected[(i, j)]).abs() <= 1e-11 * size, "{what}: ({i}, {j})");
            }
        }
    }
}

/// Without nodes the motions without energy come from the matrices. Without an interface there is nothing to reduce to.
#[test]
fn interfaces_of_rows_are_reduced_again() {
    let reduced = |interface: &str| {
        let place = Place::with_brick();
        let flags = format!("{interface} --method herting --modes 4");
        place.reduce(&place.matrix_flags(), &flags).expect(ExitCode::Done);
        place
    };
    let place = reduced("--interface ends=rows:0,1,2,30,31,32,120,121,122,132,133,134");
    let (second, _) = again(&place);
    assert_same_spectrum(&place.superelement("x.supel"), &second);
    let modal = reduced("");
    export(&modal, "matrix-market", &[]).expect(ExitCode::Done);
    assert!(modal.path("x.mass.mtx").exists() && !modal.path("x.job.toml").exists());
}

/// Modes may be kept: that reduces the model further.
#[test]
fn fewer_modes_are_the_first_ones() {
    let place = reduced("herting", "");
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    supel(&["reduce", &place.text("x.job.toml"), "--modes", "2"]).expect(ExitCode::Done);
    let (found, expected) = (place.superelement("x.again.supel"), place.superelement("x.supel"));
    assert_eq!(found.n_coordinates(), expected.n_coordinates() - 3);
    let bars = bars_hz(&expected);
    for (k, frequency) in frequencies_hz(&found).into_iter().enumerate() {
        assert!((frequency - frequencies_hz(&expected)[k]).abs() <= bars[k] + bars_hz(&found)[k]);
    }
}

/// Loads and their residual vectors come back, whatever their names hold.
#[test]
fn loads_are_those_of_the_superelement() {
    let load = r#"[[load]]
name  = "push\nhard"
nodes = [3]
force = [0, 1, 0]
"#;
    let place = Place::with_brick();
    let job = format!(
        "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n\
         [[interface]]\nname = \"foot\"\nnodes = [1, 11, 31]\n[[interface]]\nname = \"tip\"\nnodes = [5, 15]\n{load}\
         [reduction]\nmethod = \"herting\"\nmodes = {{ count = 3 }}\n[write]\nsuperelement = \"x.supel\"\n"
    );
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    supel(&["reduce", &place.text("x.job.toml")]).expect(ExitCode::Done);
    let (found, expected) = (place.superelement("x.again.supel"), place.superelement("x.supel"));
    assert_eq!(found.metadata().load_names, ["push\nhard"]);
    assert_eq!(found.n_coordinates(), expected.n_coordinates());
    let is_residual = |coordinate: &Coordinate| matches!(coordinate, Coordinate::ResidualVector { load: 0 });
    assert!(found.metadata().coordinates.iter().any(is_residual));
}

/// A load on nothing but what is held loads the model no longer.
#[test]
fn loads_on_what_is_held_are_left_out() {
    let place = Place::with_brick();
    let load = |name: &str, node: usize| format!("[[load]]\nname = \"{name}\"\nnodes = [{node}]\nforce = [0, 1, 0]\n");
    let job = format!(
        "[model]\nstiffness = \"K.mtx\"\nmass = \"M.mtx\"\ndofs = \"dofs.txt\"\nnodes = \"nodes.csv\"\n\
         [[interface]]\nname = \"foot\"\nnodes = [1, 11, 31]\n[[interface]]\nname = \"tip\"\nnodes = [5, 15]\n{}{}\
         [reduction]\nmethod = \"craig-bampton\"\nmodes = {{ count = 3 }}\n[write]\nsuperelement = \"x.supel\"\n",
        load("held", 11),
        load("free", 15)
    );
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    export(&place, "matrix-market", &["--fix", "foot", "--output", &place.text("w")]).expect(ExitCode::Done);
    let text = String::from_utf8(place.bytes("w.job.toml")).expect("UTF-8");
    assert!(text.contains("The load x.held is left out: all of it is on held dofs."), "{text}");
    supel(&["reduce", &place.text("w.job.toml")]).expect(ExitCode::Done);
    assert_eq!(place.superelement("w.again.supel").metadata().load_names, ["x.free"]);
}

/// What condensation leaves of the mass is another one in each direction, and no wrong order of its rows.
#[test]
fn the_mass_of_a_reduced_model_is_no_wrong_one() {
    for method in ["craig-bampton", "herting"] {
        let place = Place::with_brick();
        let rest = format!("--interface foot=1,11,31,41 --interface tip=5,15,35,45 --method {method} --modes 8");
        place.reduce(&place.model_flags(), &rest).expect(ExitCode::Done);
        let again = ["reduce", &place.text("x.supel"), "--modes", "3", "--output", &place.text("y.supel")];
        let ended = supel(&again).expect(ExitCode::Done);
        assert!(!ended.out.contains("W-MASS-DIRECTION"), "{method}: {}", ended.out);
        export(&place, "matrix-market", &[]).expect(ExitCode::Done);
        let ended = supel(&["reduce", &place.text("x.job.toml")]).expect(ExitCode::Done);
        assert!(!ended.out.contains("W-MASS-DIRECTION"), "{method}: {}", ended.out);
    }
}

/// An interface that just holds its component has no stiffness but rounding, which is left out: by modes it is a model, and without them
/// there is nothing to reduce.
#[test]
fn an_interface_that_just_holds_has_no_stiffness() {
    let place = Place::with_brick();
    let reduced = |rest: &str| {
        let _ = std::fs::remove_file(place.path("x.job.toml"));
        place.reduce(&place.model_flags(), rest).expect(ExitCode::Done);
        export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    };
    for (interface, method, n_alone) in [
        ("--rigid-interface foot=1,11,31", "herting", 6),
        ("--rigid-interface foot=1,11,31", "craig-bampton", 6),
        // Three nodes in a plane give way across it.
        ("--interface foot=1,11,31", "herting", 3),
    ] {
        reduced(&format!("{interface} --method {method} --modes 5"));
        let expected = place.superelement("x.supel");
        assert_eq!(rows_with_stiffness(&place), expected.n_coordinates() - n_alone, "{interface} {method}");
        let body = |job: &str| {
            supel(&["reduce", &place.text(job)]).expect(ExitCode::Done);
            place.superelement("x.again.supel")
        };
        let (exported, found) = (body("x.job.toml"), body("x.supel"));
        assert_eq!(exported.tensors().stiffness, found.tensors().stiffness, "{interface} {method}");
        // The rounding of K̂ is in the error bars of both; a decomposition of a few coordinates adds some 10⁻¹³.
        assert_close(&frequencies_hz(&found), &frequencies_hz(&expected), 1e-9);
        supel(&["verify", &place.text("x.again.supel"), "--job", &place.text("x.supel")]).expect(ExitCode::Done);
    }
    reduced("--rigid-interface foot=1,11,31 --method guyan");
    assert!(!place.path("x.job.toml").exists());
}

/// The patch of a free body next to another one has no stiffness but rounding, which is small next to nothing of its own.
#[test]
fn a_body_that_its_interface_just_holds_is_told_from_others() {
    let body = steel_brick();
    let place = Place::with(&join(&body, &translated(&body, [1e3, 0.0, 0.0]), &[]));
    // The second body has the labels from 46 on.
    let interfaces = "--rigid-interface foot=1,11,31 --rigid-interface tip=5,15,35 --rigid-interface other=46,56,76";
    place.reduce(&place.model_flags(), &format!("{interfaces} --method guyan")).expect(ExitCode::Done);
    supel(&["reduce", &place.text("x.supel")]).expect(ExitCode::Done);
    let (found, expected) = (place.superelement("x.again.supel"), place.superelement("x.supel"));
    assert_eq!([found.n_rigid(), expected.n_rigid()], [12, 12]);
}

/// A mass of ten million times the component makes roundings of rigid-body motion larger than a shift by the diagonals that carry it.
#[test]
fn digits_next_to_a_heavy_mass_agree_with_reduce() {
    let beam = brick([6, 2, 2], [3.0, 0.05, 0.05], &Material::STEEL_SI);
    let place = Place::with(&carrying(&beam, &[32], 1e7 * 3.0 * 0.05 * 0.05 * 7850.0));
    let ends = "--rigid-interface left=1,8,15,22 --rigid-interface right=7,14,21,28";
    for method in METHODS {
        place.reduce(&place.model_flags(), &format!("{ends} --method {method} --modes 3")).expect(ExitCode::Done);
        supel(&["reduce", &place.text("x.supel")]).expect(ExitCode::Done);
        supel(&["verify", &place.text("x.again.supel"), "--job", &place.text("x.supel")]).expect(ExitCode::Done);
    }
}

/// A hinge on a support: what moves without strain is not what the nodes say, so that rows are to be taken in their place.
#[test]
fn a_held_mechanism_is_a_model_by_its_rows() {
    let place = Place::with(&hinged());
    let job = "model = { stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }\n\
         interface = [{ name = \"here\", nodes = [1, 2, 4, 7] }, { name = \"there\", nodes = [15, 18, 21] }]\n\
         fixed = [{ name = \"wall\", nodes = [10] }]\n\
         reduction = { method = \"herting\", modes = { count = 3 } }\nwrite = { superelement = \"x.supel\" }\n";
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    let text = String::from_utf8(place.bytes("x.job.toml")).expect("text");
    assert!(text.contains("it moves otherwise") && !text.contains("x.dofs.csv"), "{text}");
    supel(&["reduce", &place.text("x.supel")]).expect(ExitCode::Done);
    let (found, expected) = (place.superelement("x.again.supel"), place.superelement("x.supel"));
    // Three rotations about the node that is held, and the hinge.
    assert_eq!([found.n_rigid(), expected.n_rigid()], [4, 4]);
    assert_close(&frequencies_hz(&found), &frequencies_hz(&expected), 1e-9);
    // What was held as a whole is held again, and a part of it no more.
    for (held, method) in [("[\"there\"]", "mixed-interface"), ("[\"there.ux\"]", "craig-bampton")] {
        let mixed = job.replace("\"herting\"", &format!("\"mixed-interface\", held = {held}"));
        place.write("job.toml", mixed.as_bytes());
        supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
        std::fs::remove_file(place.path("x.job.toml")).expect("a job");
        export(&place, "matrix-market", &[]).expect(ExitCode::Done);
        let text = String::from_utf8(place.bytes("x.job.toml")).expect("text");
        assert!(text.contains(&format!("method = \"{method}\"")), "{held}: {text}");
        assert_eq!(text.contains("cannot be held in part"), method == "craig-bampton", "{held}: {text}");
        supel(&["reduce", &place.text("x.supel")]).expect(ExitCode::Done);
        if method == "mixed-interface" {
            assert_close(
                &frequencies_hz(&place.superelement("x.again.supel")),
                &frequencies_hz(&place.superelement("x.supel")),
                1e-9,
            );
        }
    }
}

/// Amplitudes are in the units of their shapes, in which a stiffness may have any size.
#[test]
fn a_stiff_amplitude_is_no_penalty() {
    let place = Place::new();
    let banner = "%%MatrixMarket matrix coordinate real symmetric\n";
    place.write("K.mtx", format!("{banner}3 3 4\n1 1 1\n2 1 -1\n2 2 1\n3 3 1e15\n").as_bytes());
    place.write("M.mtx", format!("{banner}3 3 3\n1 1 1\n2 2 1\n3 3 1\n").as_bytes());
    place.write("nodes.csv", b"node,x,y,z\n1,0,0,0\n2,1,0,0\n");
    let warnings = |last: &str| {
        place.write("dofs.txt", format!("node,dof\n1,ux\n2,ux\n{last}\n").as_bytes());
        place.reduce(&place.model_flags(), "--interface ends=1,2 --method craig-bampton --modes 1");
        place.report("x.report.json")["body"]["warnings"].to_string()
    };
    assert!(warnings("2,uy").contains("W-PENALTY"), "{}", warnings("2,uy"));
    assert!(!warnings(",scalar").contains("W-PENALTY"), "{}", warnings(",scalar"));
}

/// A row that no node has is no interface, but it may be held.
#[test]
fn scalar_dofs_as_selections_of_rows() {
    let place = reduced("craig-bampton", "");
    export(&place, "matrix-market", &[]).expect(ExitCode::Done);
    let job = place.text("x.job.toml");
    let ended = supel(&["reduce", &job, "--interface", "amplitude=rows:15"]).expect(ExitCode::InputData);
    assert!(ended.err.contains("error[E-INTERFACE-ROW]"), "{}", ended.err);
    assert!(ended.err.contains("row 15 is a scalar dof, which no node has"), "{}", ended.err);
    supel(&["reduce", &job, "--fix", "first=rows:15", "--modes", "4"]).expect(ExitCode::Done);
    let (found, expected) = (place.superelement("x.again.supel"), place.superelement("x.supel"));
    // Fixed-interface modes are uncoupled: without the first amplitude the others are what they were.
    let bars = bars_hz(&expected);
    for (k, frequency) in frequencies_hz(&found).into_iter().enumerate() {
        let difference = (frequency - frequencies_hz(&expected)[k + 1]).abs();
        assert!(difference <= bars[k + 1] + bars_hz(&found)[k], "{difference:e}");
    }
}

/// What is left of a component that its own supports hold has the mass of no body, whatever else the job of the exported model holds.
#[test]
fn a_held_superelement_is_reduced_again_with_more_held() {
    for method in METHODS {
        let place = reduced(method, HELD);
        export(&place, "matrix-market", &["--fix", "hub", "--output", &place.text("w")]).expect(ExitCode::Done);
        let ended = supel(&["reduce", &place.text("w.job.toml")]);
        assert_eq!(ended.code, ExitCode::Done, "{method}: {}{}", ended.out, ended.err);
        let frequencies = |args: &[&str]| -> Vec<f64> {
            let ended = supel(&[&["modes"], args, &["--count", "3", "--json"]].concat()).expect(ExitCode::Done);
            let document: Value = serde_json::from_str(&ended.out).expect("JSON");
            let modes = document["modes"].as_array().expect("modes");
            modes.iter().map(|mode| mode["frequency_hz"].as_f64().expect("a number")).collect()
        };
        let first = frequencies(&[&place.text("x.supel"), "--fix", "hub"]);
        let second = frequencies(&[&place.text("w.again.supel")]);
        for (k, (found, expected)) in second.iter().zip(&first).enumerate() {
            // The second reduction keeps the modes of the first with free interface, and with it held those above them by far.
            let share = if method == "herting" { 1e-9 } else { 1e-2 };
            assert!((found / expected - 1.0).abs() <= share, "{method}, mode {k}: {found} and {expected} Hz");
        }
    }
}

/// With one node as its interface K̂ of a free component has no stiffness there: inertia couples the node with what is inside, and nothing is loose.
#[test]
fn a_superelement_that_one_node_holds_has_no_loose_rows() {
    for method in METHODS {
        for interface in
            ["nodes = [1, 2, 3, 6, 7, 8], coupling = \"rigid\"", "nodes = [1, 2, 3, 6, 7, 8], coupling = \"average\""]
        {
            let place = Place::with_brick();
            let job = format!(
                "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
                 interface = [{{ name = \"foot\", {interface} }}]\n\
                 reduction = {{ method = \"{method}\", modes = {{ count = 6 }} }}\n\
                 write = {{ superelement = \"x.supel\" }}\n"
            );
            place.write("job.toml", job.as_bytes());
            supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
            let again = ["reduce", &place.text("x.supel"), "--output", &place.text("again.supel")];
            supel(&again).expect(ExitCode::Done);
            let report = place.report("again.report.json");
            let codes = report["body"]["warnings"].to_string();
            assert!(
                !codes.contains("W-FREE-PARTICLE") && !codes.contains("W-HANGING"),
                "{method}, {interface}: {codes}"
            );
        }
    }
}

/// Statics of a superelement without mass: its interface condensed once more is that of the model.
#[test]
fn a_superelement_without_mass_is_a_model_of_statics() {
    let place = Place::with_brick();
    let job = |model: &str, rest: &str, output: &str| {
        format!(
            "model = {{ {model} }}\ninterface = [{{ name = \"hub\", nodes = [5, 15, 45], coupling = \"rigid\" }}{rest}]\n\
             reduction = {{ method = \"guyan\" }}\nscene = {{ analysis = \"static\", gravity = false }}\n\
             write = {{ superelement = \"{output}\" }}\n"
        )
    };
    let model = "stiffness = \"K.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\"";
    let foot = ", { name = \"foot\", nodes = [1, 11, 31, 41] }";
    for (name, rest, output) in
        [("job.toml", foot, "x.supel"), ("end.toml", ", { name = \"foot\", nodes = [1, 11, 31] }", "y.supel")]
    {
        place.write(name, job(model, rest, output).as_bytes());
        supel(&["reduce", &place.text(name)]).expect(ExitCode::Done);
    }
    let first = place.superelement("x.supel");
    let (second, _) = again(&place);
    let rounding =
        1e-10 * (0..first.n_coordinates()).fold(0.0, |max: f64, i| max.max(first.tensors().stiffness[(i, i)]));
    let difference = |a: &Superelement, b: &Superelement| {
        let (a, b) = (&a.tensors().stiffness, &b.tensors().stiffness);
        assert_eq!(a.rows(), b.rows());
        let pairs = (0..a.rows()).flat_map(|i| (0..a.rows()).map(move |j| (i, j)));
        pairs.fold(0.0, |max: f64, at| max.max((a[at] - b[at]).abs()))
    };
    assert!(difference(&first, &second) <= rounding);
    assert_eq!(second.metadata().validity.assumptions, first.metadata().validity.assumptions);
    // One node of the foot condensed.
    let text = String::from_utf8(place.bytes("x.job.toml")).expect("text");
    assert!(text.contains("[1, 11, 31, 41]"), "{text}");
    let fewer = text.replace("[1, 11, 31, 41]", "[1, 11, 31]").replace("x.again.supel", "fewer.supel");
    place.write("fewer.toml", fewer.as_bytes());
    supel(&["reduce", &place.text("fewer.toml")]).expect(ExitCode::Done);
    assert!(difference(&place.superelement("fewer.supel"), &place.superelement("y.supel")) <= rounding);
}
