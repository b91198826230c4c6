//! `supel init`: a job that `supel reduce` accepts, proposed of a pair of matrices.

use std::path::Path;

use supel::cli::ExitCode;
use supel::job::{Coupling, Job, Method, ModeSelection, NodeSelection, Region};
use supel_models::transform::{in_local_frames, rounded, supported};
use supel_models::{Material, brick};
use supel_testing::place::{Ended, Place, steel_brick, supel};

fn init(place: &Place, rest: &str) -> Ended {
    let word = |word: &str| if word.contains('.') { place.text(word) } else { word.to_owned() };
    let rest: Vec<String> = rest.split_whitespace().map(word).collect();
    let mut args = vec!["init"];
    args.extend(rest.iter().map(String::as_str));
    supel(&args)
}

/// The proposed job, which is one, and its text.
#[track_caller]
fn proposed(place: &Place, rest: &str) -> (Job, String) {
    let text = init(place, rest).expect(ExitCode::Done).out;
    assert!(text.lines().all(|line| line.chars().count() <= 170), "{text}");
    let job = Job::parse(&text, Path::new("job.toml")).unwrap_or_else(|error| panic!("{error}\n{text}"));
    job.validate().expect("valid");
    (job, text)
}

/// `supel init … --output proposed.toml`, then `supel reduce proposed.toml`.
#[track_caller]
fn reduced(place: &Place, rest: &str) -> serde_json::Value {
    init(place, &format!("{rest} --output proposed.toml")).expect(ExitCode::Done);
    supel(&["reduce", &place.text("proposed.toml"), "--quiet"]).expect(ExitCode::Done);
    place.report("proposed.report.json")
}

const ALL: &str = "K.mtx M.mtx --dofs dofs.txt --nodes nodes.csv";

/// Without groups the flat faces at the ends are proposed, and the job is reduced as it is.
#[test]
fn ends_of_a_mesh_without_groups() {
    let place = Place::with(&steel_brick());
    let (job, text) = proposed(&place, ALL);
    let names: Vec<&str> = job.interfaces.iter().map(|interface| interface.name.as_str()).collect();
    assert_eq!(names, ["minus-x", "plus-x"], "{text}");
    assert!(job.interfaces.iter().all(|interface| interface.coupling == Coupling::Rigid));
    let NodeSelection::Region { within: Region::Plane { point, normal, .. } } = &job.interfaces[1].nodes else {
        panic!("{text}")
    };
    assert_eq!((point, normal), (&[1.0, 0.0, 0.0], &[1.0, 0.0, 0.0]));
    assert_eq!((job.reduction.method, job.model.units.as_deref()), (Method::Herting, Some("m-kg-s")));
    assert!(text.contains("lowest elastic frequencies") && text.contains("# [scene]"), "{text}");
    let report = reduced(&place, ALL);
    let interfaces = report["body"]["reduction"]["interfaces"].as_array().expect("interfaces");
    assert_eq!(
        interfaces.iter().map(|interface| interface["n_nodes"].as_u64()).collect::<Vec<_>>(),
        [Some(9), Some(9)]
    );
}

/// Paths are relative to the job where the files stand next to it or below, and absolute otherwise.
#[test]
fn paths_are_those_that_the_job_needs() {
    let place = Place::with(&steel_brick());
    init(&place, &format!("{ALL} --output job.toml")).expect(ExitCode::Done);
    let text = String::from_utf8(place.bytes("job.toml")).expect("UTF-8");
    assert!(text.contains("stiffness = \"K.mtx\"") && text.contains("superelement = \"job.supel\""), "{text}");
    std::fs::create_dir(place.path("jobs")).expect("a folder");
    let output = place.text("jobs/job.toml");
    let [k, m] = ["K.mtx", "M.mtx"].map(|name| place.text(name));
    supel(&["init", &k, &m, "--output", &output]).expect(ExitCode::Done);
    let job = Job::read(Path::new(&output)).expect("a job");
    assert!(job.model.stiffness.is_absolute(), "{:?}", job.model.stiffness);
    // What is there is not replaced.
    let ended = supel(&["init", &k, &m, "--output", &output]).expect(ExitCode::Usage);
    assert!(ended.err.contains("E-OUTPUT-EXISTS"), "{}", ended.err);
    let ended = supel(&["init", &k, &m, "--output", &place.text("job.txt")]).expect(ExitCode::Usage);
    assert!(ended.err.contains(".toml"), "{}", ended.err);
}

/// Matrices alone make a job without an interface, which reduces all the same.
#[test]
fn matrices_alone() {
    let place = Place::with(&steel_brick());
    let (job, text) = proposed(&place, "K.mtx M.mtx");
    assert_eq!((job.interfaces.len(), job.reduction.method), (0, Method::CraigBampton), "{text}");
    assert!(text.contains("# No interface") && matches!(job.reduction.wanted(), ModeSelection::UpTo { .. }), "{text}");
    reduced(&place, "K.mtx M.mtx");
}

/// What a stage refused is mended in the job, and said at its head.
#[test]
fn a_refused_pair_is_proposed_as_it_can_be_reduced() {
    let place = Place::with(&steel_brick());
    let (job, text) = proposed(&place, "M.mtx K.mtx --dofs dofs.txt --nodes nodes.csv");
    assert!(
        job.model.stiffness.ends_with("K.mtx") && job.model.mass.is_some_and(|mass| mass.ends_with("M.mtx")),
        "{text}"
    );
    assert!(
        text.contains("stiffness and mass are exchanged") && text.contains("goes on with the two files exchanged"),
        "{text}"
    );
    // One that is not a pair at all has no modes.
    let ended = init(&place, "K.mtx K.mtx").expect(ExitCode::CheckFailed);
    assert!(ended.out.contains("check: ") && Job::parse(&ended.out, Path::new("job.toml")).is_ok(), "{}", ended.out);
}

/// Held dofs of the command line are held by the job.
#[test]
fn what_is_held_stays_held() {
    let place = Place::with(&steel_brick());
    let (job, _) = proposed(&place, &format!("{ALL} --fix foot=1,2,3:ux,uy --fix toe=7"));
    assert_eq!(job.fixed.len(), 2);
    assert_eq!(
        (job.fixed[0].name.as_deref(), &job.fixed[0].nodes),
        (Some("foot"), &NodeSelection::Labels(vec![1, 2, 3]))
    );
    assert_eq!((job.fixed[0].dofs.as_ref().map(Vec::len), &job.fixed[1].dofs), (Some(2), &None));
    let held = supported(&steel_brick(), |(label, _)| label <= 9);
    reduced(&Place::with(&held), ALL);
}

/// Faces and groups with held nodes are no interfaces, be it one node, one direction or all of them.
#[test]
fn faces_and_groups_with_held_nodes() {
    let mut model = steel_brick();
    model.add_group("ROOT", |[x, _, _]| x == 0.0);
    model.add_group("TIP", |[x, _, _]| x == 1.0);
    let place = Place::with(&model);
    let root: Vec<String> = model.groups["ROOT"].iter().map(ToString::to_string).collect();
    let root = root.join(",");
    for fix in [format!("a={}", model.groups["ROOT"][0]), format!("w={root}:ux"), format!("w={root}")] {
        let (job, text) = proposed(&place, &format!("{ALL} --fix {fix}"));
        let names: Vec<&str> = job.interfaces.iter().map(|interface| interface.name.as_str()).collect();
        assert_eq!(names, ["plus-x"], "{fix}: {text}");
        let _ = std::fs::remove_file(place.path("proposed.toml"));
        reduced(&place, &format!("{ALL} --fix {fix}"));
    }
    // Held at both ends: the next axis has free faces, or all of them are held.
    let tip = model.groups["TIP"][4];
    let (job, text) = proposed(&place, &format!("{ALL} --fix a={}:ux --fix b={tip}", model.groups["ROOT"][4]));
    assert!(job.interfaces.iter().all(|interface| !interface.name.ends_with("-x")), "{text}");
    let _ = std::fs::remove_file(place.path("proposed.toml"));
    reduced(&place, &format!("{ALL} --fix a={}:ux --fix b={tip}", model.groups["ROOT"][4]));
    // As groups of a deck.
    place.write("mesh.inp", deck(&model).as_bytes());
    let files = "K.mtx M.mtx --dofs dofs.txt --nodes mesh.inp --fix a=1:uy";
    let (job, text) = proposed(&place, files);
    let names: Vec<&str> = job.interfaces.iter().map(|interface| interface.name.as_str()).collect();
    assert_eq!(names, ["TIP"], "{text}");
    assert!(text.contains("group ROOT: 9 nodes") && text.contains("1 node of it is held"), "{text}");
    let _ = std::fs::remove_file(place.path("proposed.toml"));
    reduced(&place, files);
}

/// Nodes in line carry no patch: a prism that ends in edges along its longest axes has faces at the others.
#[test]
fn ends_that_are_edges_are_no_faces() {
    let lozenge = |[x, y, z]: [f64; 3]| [x - y, x + y, 0.3 * z];
    let mesh = supel_models::HexMesh::structured([4, 4, 2], lozenge, |_| true);
    let place = Place::with(&mesh.assemble(&supel_models::Material::STEEL_SI));
    let (job, text) = proposed(&place, ALL);
    let names: Vec<&str> = job.interfaces.iter().map(|interface| interface.name.as_str()).collect();
    assert_eq!(names, ["minus-z", "plus-z"], "{text}");
    reduced(&place, ALL);
}

/// A mesh of cells without groups has its holes proposed, each with its axis, and the faces that share no node with them.
#[test]
fn holes_and_faces_of_a_mesh_without_groups() {
    let mesh = supel_models::bracket_mesh();
    let place = Place::with(&mesh.assemble(&Material::STEEL_MM_T_S));
    place.write("mesh.inp", cells(&mesh).as_bytes());
    let files = "K.mtx M.mtx --dofs dofs.txt --nodes mesh.inp";
    let (job, text) = proposed(&place, files);
    let holes: Vec<_> = job.interfaces.iter().filter(|interface| interface.name.starts_with("hole-")).collect();
    assert_eq!(holes.len(), 5, "{text}");
    assert!(job.interfaces.len() <= 8 && text.contains("check: a hole of radius 18 about"), "{text}");
    assert!(holes.iter().all(|hole| hole.origin == supel::job::Origin::Hole && hole.coupling == Coupling::Rigid));
    let report = reduced(&place, files);
    let interfaces = report["body"]["reduction"]["interfaces"].as_array().expect("interfaces");
    let count = |name: &str| {
        let found = interfaces.iter().find(|interface| interface["name"] == name).expect(name);
        found["n_nodes"].as_u64().expect("a count") as usize
    };
    // The nodes of the bore, and of no more.
    let eye = mesh.groups["EYE"].len();
    assert_eq!(count("hole-1"), eye, "{text}");
    // A held node takes its hole out.
    let held = mesh.groups["EYE"][0] + 1;
    let (job, text) = proposed(&place, &format!("{files} --fix a={held}"));
    let holes = job.interfaces.iter().filter(|interface| interface.name.starts_with("hole-"));
    assert_eq!(holes.count(), 4, "{text}");
}

/// A mesh of hexahedra as a deck without sets.
fn cells(mesh: &supel_models::HexMesh) -> String {
    let mut text = "*NODE\n".to_owned();
    for (node, [x, y, z]) in mesh.nodes.iter().enumerate() {
        text += &format!("{}, {x:?}, {y:?}, {z:?}\n", node + 1);
    }
    text += "*ELEMENT, TYPE=C3D8\n";
    for (element, nodes) in mesh.elements.iter().enumerate() {
        let nodes: Vec<String> = nodes.iter().map(|node| (node + 1).to_string()).collect();
        text += &format!("{}, {}\n", element + 1, nodes.join(", "));
    }
    text
}

/// A node that is held in some directions has rows in the others.
#[test]
fn groups_that_are_partly_held_have_the_other_dofs() {
    let mut model = steel_brick();
    model.add_group("ROOT", |[x, _, _]| x == 0.0);
    let root = model.groups["ROOT"].iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
    let place = Place::with(&model);
    place.write("mesh.inp", deck(&model).as_bytes());
    for (directions, said) in
        [(":ux", "group ROOT: 9 nodes, 18 dofs; dofs of it are held"), ("", "group ROOT: 9 nodes, 0 dofs; it is held")]
    {
        let files = format!("K.mtx M.mtx --dofs dofs.txt --nodes mesh.inp --fix w={root}{directions}");
        let text = init(&place, &files).expect(ExitCode::Done).out;
        assert!(text.contains(said), "{text}");
    }
}

/// What the flags say of the rows is in the job: axes of nodes, the memory.
#[test]
fn axes_of_nodes_and_memory_are_in_the_job() {
    const TURNED: [[f64; 3]; 3] = [[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 1.0]];
    let place = Place::with(&in_local_frames(&steel_brick(), &TURNED, |node| node == 7));
    place.write("frames.csv", b"node,x1,x2,x3,y1,y2,y3\n7,3,4,0,-4,3,0\n");
    let flags = format!("{ALL} --frames frames.csv --memory-gib 3");
    let (job, text) = proposed(&place, &flags);
    assert!(job.model.frames.is_some() && job.run.memory_gib == Some(3.0), "{text}");
    reduced(&place, &flags);
}

/// A node that a constraint holds is held: no face with it is an interface.
#[test]
fn faces_with_a_node_that_a_constraint_holds() {
    let model = steel_brick();
    let place = Place::with(&model);
    let row = model.dofs.iter().position(|dof| *dof == (model.labels[model.labels.len() - 1], 0)).expect("a row");
    let entry = format!("%%MatrixMarket matrix coordinate real general\n1 {} 1\n1 {} 1\n", model.n, row + 1);
    place.write("G.mtx", entry.as_bytes());
    let flags = format!("{ALL} --constraints G.mtx --constraints-to-ground accept");
    let (job, text) = proposed(&place, &flags);
    let names: Vec<&str> = job.interfaces.iter().map(|interface| interface.name.as_str()).collect();
    assert_eq!(names, ["minus-x"], "{text}");
    assert!(text.contains("of the held component"), "{text}");
    reduced(&place, &flags);
}

/// Nodes and sets of a model as a deck.
fn deck(model: &supel_models::Model) -> String {
    let mut text = "*NODE\n".to_owned();
    for (label, [x, y, z]) in model.labels.iter().zip(&model.nodes) {
        text += &format!("{label}, {x:?}, {y:?}, {z:?}\n");
    }
    for (name, members) in &model.groups {
        let members: Vec<String> = members.iter().map(ToString::to_string).collect();
        text += &format!("*NSET, NSET={name}\n{}\n", members.join(",\n"));
    }
    text
}

/// Where digits are few, the page and the job say that a reduction may fail for them.
#[test]
fn few_digits_may_not_suffice() {
    let slender = brick([5, 1, 1], [1.0, 0.1, 0.1], &Material::STEEL_SI);
    let place = Place::with(&rounded(&slender, 5));
    let (_, text) = proposed(&place, ALL);
    let said = text.replace("\n# ", " ");
    assert!(
        said.contains("5 digits of the stiffness") && said.contains("until then checks of a reduction may fail"),
        "{text}"
    );
}

/// Units are written where one system alone fits, and left to the user where several do.
#[test]
fn units_are_written_where_nothing_else_fits() {
    let sound = brick([4, 2, 2], [100.0, 31.0, 23.0], &Material { young: 210_000.0, poisson: 0.3, density: 7.85e-9 });
    assert_eq!(proposed(&Place::with(&sound), ALL).0.model.units.as_deref(), Some("mm-t-s"));
    let mixed = supel_models::transform::scaled(&sound, 1.0, 1e3);
    let (job, text) = proposed(&Place::with(&mixed), ALL);
    assert_eq!(job.model.units, None, "{text}");
    assert!(text.contains("# units = the label of your system"), "{text}");
}

/// Two flat ends have a sphere near them, four edges a cylinder through them, and a band around a circle has one within it.
#[test]
fn flat_faces_and_wide_bands_lie_on_nothing_round() {
    let mut block = brick([3, 2, 6], [0.08, 0.05, 0.4], &Material::STEEL_SI);
    block.add_group("ENDS", |x| x[2] == 0.0 || x[2] == 0.4);
    let mut bar = brick([8, 2, 2], [0.4, 0.1, 0.1], &Material::STEEL_SI);
    bar.add_group("EDGES", |x| [0.0, 0.1].contains(&x[1]) && [0.0, 0.1].contains(&x[2]));
    let mut plate = brick([20, 20, 1], [1.0, 1.0, 0.1], &Material::STEEL_SI);
    plate.add_group("BAND", |x| ((x[0] - 0.5).hypot(x[1] - 0.5) - 0.5).abs() < 0.02);
    // So coarse that straight edges would be as far inside of that sphere.
    let mut coarse = brick([2, 1, 6], [0.08, 0.05, 0.4], &Material::STEEL_SI);
    coarse.add_group("ENDS", |x| x[2] == 0.0 || x[2] == 0.4);
    for model in [block, coarse, bar, plate] {
        let place = Place::with(&model);
        place.write("mesh.inp", deck(&model).as_bytes());
        let (job, text) = proposed(&place, "K.mtx M.mtx --dofs dofs.txt --nodes mesh.inp");
        let group = model.groups.keys().next().expect("a group");
        let interface = job.interfaces.iter().find(|interface| interface.name == *group).expect(group);
        assert_eq!(interface.origin, supel::job::Origin::Centroid, "{text}");
    }
}

/// Groups become interfaces: a bore with its axis; a group of the whole model does not.
#[cfg(feature = "hdf5")]
#[test]
fn groups_with_what_they_are() {
    let place = Place::with_example();
    let files = "stiffness.mtx.gz mass.mtx.gz --nodes bracket.med";
    let (job, text) = proposed(&place, files);
    let of = |name: &str| job.interfaces.iter().find(|interface| interface.name == name).expect(name);
    assert_eq!((&of("EYE").origin, of("EYE").coupling), (&supel::job::Origin::Hole, Coupling::Rigid), "{text}");
    assert!(text.contains("its nodes lie on a cylinder of radius"), "{text}");
    assert_eq!(of("BASE").origin, supel::job::Origin::Centroid, "{text}");
    reduced(&place, files);
}
