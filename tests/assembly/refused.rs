//! What cannot be joined, held, loaded or solved, and what is said of it.

use supel::assembly::{Assembly, Component, PointMass, Wanted, within_memory};
use supel::cli::ExitCode;
use supel::error::{Error, Result};
use supel::memory_forecast::Resources;
use supel_models::transform::translated;
use supel_models::{Material, Model, brick, spectrum};
use supel_runtime::{Matrix, Metadata, Superelement, Tensors};
use supel_testing::place::{Place, supel};

use crate::{all_modes, assert_enclosed, beams, line, reduced};

const METHOD: &str = "--method craig-bampton --modes 3";

fn left() -> Component {
    reduced("left", &beams(&line()[..7]), &format!("--interface end=1 --interface middle=7 {METHOD}"))
}

fn right() -> Component {
    reduced("right", &beams(&line()[6..]), &format!("--interface middle=1 --interface tip=7 {METHOD}"))
}

/// A component with some of its content altered.
fn altered(component: &Component, alter: impl FnOnce(&mut Tensors, &mut Metadata)) -> Result<Component> {
    let mut tensors = component.superelement.tensors().clone();
    let mut metadata = component.superelement.metadata().clone();
    alter(&mut tensors, &mut metadata);
    Component::new(component.name.clone(), Superelement::new(tensors, metadata).expect("one superelement"))
}

fn assembly(left: Component, right: Component) -> Assembly {
    Assembly::new(vec![left, right]).expect("two names")
}

#[track_caller]
fn assert_says(error: &Error, words: &[&str]) {
    let text = error.to_string();
    words.iter().for_each(|word| assert!(text.contains(word), "{word:?} is not in {text}"));
}

#[test]
fn names_that_are_not_there_are_refused_with_a_suggestion() {
    let mut assembly = assembly(left(), right());
    let words = [
        ("lft.middle", ["no component is called `lft`", "left, right – did you mean `left`?"]),
        ("left.midle", ["left has no interface `midle`", "end, middle – did you mean `middle`?"]),
        ("left.rows:0", ["left has no interface row `0`", "expected one of nothing"]),
        ("left.middle.8", ["`middle.8` selects no dof of left", "middle.7.ux"]),
        ("left", ["it names no interface of left", "end, middle"]),
        ("", ["no component is called ``", "left, right"]),
    ];
    for (text, words) in words {
        for error in [
            assembly.join(text, "right.middle").expect_err("unknown"),
            assembly.join("right.middle", text).expect_err("unknown"),
            assembly.fix(text).expect_err("unknown"),
            assembly.load(text, PointMass { mass: 1.0, inertia: [0.0; 3] }).expect_err("unknown"),
        ] {
            assert!(matches!(error, Error::AssemblyName { .. }), "{error}");
            assert_says(&error, &words);
        }
    }
    assert!(assembly.joints.is_empty() && assembly.held.is_empty() && assembly.loaded.is_empty());
}

/// Rows have no directions in which a mass could act.
#[test]
fn an_interface_may_be_called_as_rows_are() {
    let ends = format!("--interface rows:1=1 --interface rows=7 {METHOD}");
    let mut assembly = assembly(reduced("left", &beams(&line()[..7]), &ends), right());
    assembly.join("left.rows", "right.middle").expect("an interface");
    assembly.fix("left.rows:1").expect("an interface");
    let error = assembly.fix("left.rows:2").expect_err("no interface, no row");
    assert_says(&error, &["left has no interface row `2`"]);
}

#[test]
fn a_mass_on_rows_asks_for_a_dof_map() {
    let bare = Model { dofs: Vec::new(), ..beams(&line()[..7]) };
    let mut assembly = assembly(reduced("left", &bare, &format!("--interface r=rows:0,1,2,3,4,5 {METHOD}")), right());
    let error = assembly.load("left.rows:0", PointMass { mass: 1.0, inertia: [0.0; 3] }).expect_err("no direction");
    assert!(matches!(error, Error::PointMassDofs { .. }), "{error}");
    assert_says(&error, &["found rows without directions", "give the model of the component a dof map"]);
}

#[test]
fn one_name_for_two_components_is_refused() {
    let error = Assembly::new(vec![left(), left()]).expect_err("one name");
    assert!(matches!(error, Error::ComponentTwice { .. }), "{error}");
}

#[test]
fn pairs_that_are_joined_already_are_refused() {
    let mut assembly = assembly(left(), right());
    assembly.join("left.middle", "right.middle").expect("one place");
    for (a, b) in [("left.middle", "right.middle"), ("right.middle", "left.middle"), ("left.end", "left.end")] {
        let error = assembly.join(a, b).expect_err("joined already");
        assert!(matches!(error, Error::JoinedTwice { .. }), "{error}");
    }
}

#[test]
fn nodes_at_different_places_are_refused_within_a_millionth_of_the_component() {
    let error = assembly(left(), right()).join("left.middle", "right.tip").expect_err("far away");
    assert!(matches!(error, Error::JoinPosition { .. }), "{error}");
    // The smaller component is half a metre long; another unit of length is a thousand times that.
    let model = beams(&line()[6..]);
    for (distance, is_joined) in [(1e-7, true), (3e-6, false)] {
        let moved = translated(&model, [distance, 0.0, 0.0]);
        let moved = reduced("right", &moved, &format!("--interface middle=1 {METHOD}"));
        let mut assembly = assembly(left(), moved);
        assert_eq!(assembly.join("left.middle", "right.middle").is_ok(), is_joined, "{distance}");
        if is_joined {
            let modes = all_modes(&assembly);
            assert_eq!(modes.n_rigid, 6);
        }
    }
}

#[test]
fn other_axes_are_told_and_other_units_refused() {
    let (left, right) = (left(), right());
    let turned = altered(&right, |tensors, _| {
        tensors.interface_frames[0] = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    });
    let mut joined = assembly(left.clone(), turned.expect("a component"));
    joined.join("left.middle", "right.middle").expect("matrices in the axes of the model");
    assert_eq!(joined.notes, ["the axes of left.middle and right.middle are turned by 90 degrees against each other"]);
    let mut plain = assembly(left.clone(), right.clone());
    plain.join("left.middle", "right.middle").expect("one place");
    assert_eq!(all_modes(&joined), all_modes(&plain), "axes are a label");
    let with_units = |component: &Component, units: Option<&str>| {
        altered(component, |_, metadata| metadata.units = units.map(str::to_owned)).expect("a component")
    };
    for (of_left, of_right, is_joined) in
        [("mm-t-s", Some("m-kg-s"), false), ("mm-t-s", Some("mm-t-s"), true), ("mm-t-s", None, true)]
    {
        let mut assembly = assembly(with_units(&left, Some(of_left)), with_units(&right, of_right));
        let joined = assembly.join("left.middle", "right.middle");
        assert_eq!(joined.is_ok(), is_joined);
        if let Err(error) = joined {
            assert!(matches!(error, Error::JoinUnits { .. }), "{error}");
            assert_says(&error, &["mm-t-s", "m-kg-s"]);
        }
    }
}

/// A block on a beam: with three dofs a node and with six.
#[test]
fn dofs_that_both_have_are_joined_and_the_others_are_named() {
    let block = translated(&brick([1, 1, 1], [0.2, 0.1, 0.1], &Material::STEEL_SI), line()[6]);
    let block = reduced("block", &block, &format!("--interface corner=1 --interface edge=2,3 {METHOD}"));
    let mut assembly = assembly(left(), block.clone());
    assembly.join("left.middle", "block.corner").expect("three dofs in common");
    assert_eq!(assembly.joints[0].n_dofs, 3);
    assert_eq!(assembly.notes, ["left.middle: rx ry rz stay free, as block.corner does not have them"]);
    assert_eq!(all_modes(&assembly).n_rigid, 9);
    let error = assembly.join("left.middle.rx", "block.corner").expect_err("nothing in common");
    assert!(matches!(error, Error::JoinDofs { .. }), "{error}");
    let error =
        assembly.load("block.edge", PointMass { mass: 1.0, inertia: [0.0, 0.1, 0.0] }).expect_err("no rotation");
    assert!(matches!(error, Error::PointMassDofs { .. }), "{error}");
    assert_says(&error, &["block.edge", "found dofs `ux uy uz`", "expected ry"]);
}

#[test]
fn faces_whose_nodes_do_not_meet_are_refused() {
    let face = |cells: [usize; 3], x: f64| {
        let block = brick(cells, [1.0, 1.0, 1.0], &Material::UNIT);
        let at = |model: &Model| -> String {
            let nodes = model.labels.iter().zip(&model.nodes).filter(|(_, node)| node[0] == x);
            nodes.map(|(label, _)| label.to_string()).collect::<Vec<_>>().join(",")
        };
        let moved = translated(&block, [1.0 - x, 0.0, 0.0]);
        reduced("x", &moved, &format!("--interface face={} {METHOD}", at(&block)))
    };
    let named = |name: &str, mut component: Component| {
        component.name = name.to_owned();
        component
    };
    // Nine nodes to four, and nine to nine of another division.
    for other in [[1, 1, 1], [1, 8, 1]] {
        let mut assembly = assembly(named("a", face([1, 2, 2], 1.0)), named("b", face(other, 0.0)));
        let error = assembly.join("a.face", "b.face").expect_err("no partner");
        if other == [1, 8, 1] {
            assert!(error.to_string().contains("18 nodes"), "{error}");
        }
        assert!(matches!(error, Error::JoinNodes { .. }), "{error}");
    }
}

#[test]
fn rows_are_joined_in_their_order_and_positions_are_said_to_be_unknown() {
    let without = |name: &str, model: &Model, rows: &str| {
        let bare = Model { dofs: Vec::new(), ..model.clone() };
        reduced(name, &bare, &format!("--interface r=rows:{rows} {METHOD}"))
    };
    let [of_left, of_right] = [beams(&line()[..7]), beams(&line()[6..])];
    let mut by_rows =
        assembly(without("left", &of_left, "36,37,38,39,40,41"), without("right", &of_right, "0,1,2,3,4,5"));
    by_rows.join("left.rows:36,37,38,39,40,41", "right.rows:0,1,2,3,4,5").expect("six rows each");
    assert_eq!(by_rows.notes.len(), 1);
    let mut by_nodes = assembly(left(), right());
    by_nodes.join("left.middle", "right.middle").expect("one place");
    let error = by_nodes.join("left.middle", "right.rows:0").expect_err("no rows");
    assert!(matches!(error, Error::AssemblyName { .. }), "{error}");
    let [rows, nodes] = [&by_rows, &by_nodes].map(all_modes);
    assert_eq!((rows.n_rigid, nodes.n_rigid), (6, 6));
    let whole = spectrum(&beams(&line()));
    assert_enclosed(&rows, &whole);
    assert_enclosed(&nodes, &whole);
}

#[test]
fn what_has_no_modes_is_refused() {
    let beam = beams(&line());
    let whole = reduced("beam", &beam, "--interface all=1,2,3,4,5,6,7,8,9,10,11,12,13 --method guyan");
    let mut held = Assembly::new(vec![whole.clone()]).expect("one name");
    held.fix("all").expect("the interface");
    let error = held.modes(Wanted::Count(1)).expect_err("nothing moves");
    assert!(matches!(error, Error::AssemblyHeld), "{error}");

    let with_matrix = |alter: fn(f64, (usize, usize)) -> f64, which: fn(&mut Tensors) -> &mut Matrix| {
        altered(&whole, |tensors, _| {
            let matrix = which(tensors);
            let n = matrix.rows();
            let old = matrix.clone();
            *matrix = Matrix::from_fn(n, n, |i, j| alter(old[(i, j)], (i, j)));
        })
    };
    let negative = with_matrix(|value, at| if at == (4, 4) { -value } else { value }, |tensors| &mut tensors.mass);
    let error = negative.expect_err("negative mass");
    assert!(matches!(error, Error::AssemblyIndefinite { .. }), "{error}");
    assert_says(&error, &["component beam has a negative mass"]);
    let negative = with_matrix(|value, _| -value, |tensors| &mut tensors.stiffness).expect("a component");
    let error = Assembly::new(vec![negative]).expect("one name").modes(Wanted::Count(1)).expect_err("negative");
    assert!(matches!(error, Error::AssemblyIndefinite { .. } | Error::AssemblySingular { .. }), "{error}");
    let empty = |value: f64, at: (usize, usize)| if at.0 == 10 || at.1 == 10 { 0.0 } else { value };
    let empty = with_matrix(empty, |tensors| &mut tensors.stiffness).expect("a component");
    let empty = altered(&empty, |tensors, _| {
        let old = tensors.mass.clone();
        let zero = |i: usize, j: usize| if i == 10 || j == 10 { 0.0 } else { old[(i, j)] };
        tensors.mass = Matrix::from_fn(old.rows(), old.cols(), zero);
    });
    let mut assembly = Assembly::new(vec![empty.expect("a component")]).expect("one name");
    assembly.fix("beam.all.1").expect("a node");
    let error = assembly.modes(Wanted::Count(1)).expect_err("neither stiffness nor mass");
    assert!(matches!(error, Error::AssemblySingular { .. }), "{error}");
    assert_says(&error, &["largest at beam.all.ry"]);
}

/// Motions that are not those of the matrices: they would be given as rigid.
#[test]
fn rigid_body_modes_that_strain_the_component_are_refused() {
    for component in [left(), reduced("left", &beams(&line()[..7]), "--interface ends=1,7 --method guyan")] {
        let error = altered(&component, |tensors, _| {
            let motions = tensors.rigid_body_modes.clone();
            let torn = |i: usize, j: usize| if i < 6 { -motions[(i, j)] } else { motions[(i, j)] };
            tensors.rigid_body_modes = Matrix::from_fn(motions.rows(), motions.cols(), torn);
        });
        let error = error.expect_err("one end goes against the other");
        assert!(matches!(error, Error::AssemblyRigid { .. }), "{error}");
    }
}

#[test]
fn assemblies_that_do_not_fit_into_the_memory_are_refused() {
    let available = |bytes| Resources { memory_bytes: Some(bytes), cache: None };
    within_memory(1000, available(1 << 30)).expect("half a gigabyte");
    let error = within_memory(10_000, available(1 << 30)).expect_err("48 gigabytes");
    assert!(matches!(error, Error::MemoryAssembly { .. }), "{error}");
    within_memory(10_000, Resources::default()).expect("nobody knows");
}

#[test]
fn flags_that_cannot_be_read_are_refused() {
    let place = Place::with(&beams(&line()));
    place.reduce(&place.model_flags(), &format!("--interface end=1 {METHOD}")).expect(ExitCode::Done);
    let file = place.text("x.supel");
    let wrong = [
        (vec!["--join", "x.end"], "E-FLAG-TEXT"),
        (vec!["--join", "=x.end"], "E-FLAG-TEXT"),
        (vec!["--mass", "x.end"], "E-FLAG-TEXT"),
        (vec!["--mass", "x.end=two"], "E-FLAG-TEXT"),
        (vec!["--mass", "x.end=1,2"], "E-FLAG-TEXT"),
        (vec!["--mass", "x.end=-1"], "E-ARG"),
        (vec!["--mass", "x.end=nan"], "E-ARG"),
        (vec!["--mass", "x.end=1e300"], "E-ARG"),
        (vec!["--up-to-hz", "-5"], "E-ARG"),
        (vec!["--up-to-hz", "inf"], "E-ARG"),
        (vec!["--count", "0"], "E-USAGE"),
        (vec!["--count", "3", "--up-to-hz", "5"], "E-USAGE"),
        (vec![file.as_str()], "E-COMPONENT-NAME"),
        (vec!["--fix", "y.end"], "E-ASSEMBLY-NAME"),
    ];
    for (flags, code) in wrong {
        let ended = supel(&[&["modes", &file], flags.as_slice()].concat());
        assert_eq!(ended.code, ExitCode::Usage, "{flags:?}: {}{}", ended.out, ended.err);
        assert!(ended.err.contains(code) && ended.out.is_empty(), "{flags:?}: {}", ended.err);
    }
    supel(&["modes", &place.text("none.supel")]).expect(ExitCode::Io);
    supel(&["modes", &place.text("K.mtx")]).expect(ExitCode::InputData);
    supel(&["modes"]).expect(ExitCode::Usage);
}
