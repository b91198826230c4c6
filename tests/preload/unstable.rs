//! States beyond buckling: counted and refused, whatever the method; what the job holds cannot buckle.

use faer::{Mat, Side};
use supel::cli::ExitCode;
use supel_models::Model;
use supel_testing::pencil::{matrices, part, unpacked};
use supel_testing::place::{Place, supel};

use crate::network::{Network, Nodes, strutted_tower, tower};
use crate::{PRELOADED, place_of, reduced};

const METHODS: [&str; 6] = [
    r#"method = "craig-bampton", modes = { count = 4 }"#,
    r#"method = "herting", modes = { count = 4 }"#,
    r#"method = "rubin", modes = { count = 4 }"#,
    r#"method = "macneal", modes = { count = 4 }"#,
    r#"method = "mixed-interface", held = ["tip.ux"], modes = { count = 4 }"#,
    r#"method = "guyan""#,
];

/// Rows of the nodes with these numbers from zero.
fn rows_of(nodes: impl IntoIterator<Item = usize>) -> Vec<usize> {
    nodes.into_iter().flat_map(|node| 3 * node..3 * node + 3).collect()
}

fn n_negative(k: &Mat<f64>) -> usize {
    let values = k.self_adjoint_eigenvalues(Side::Lower).expect("eigenvalues");
    // Rounding of 33 rows is 10⁻¹³ of the largest.
    let zero = 1e-12 * values[values.len() - 1];
    assert!(values.iter().all(|value| value.abs() > zero), "a critical load: {values:?}");
    values.iter().filter(|value| **value < 0.0).count()
}

/// The tower on its foot under the least compression, in steps of a tenth, that makes so many eigenvalues negative.
fn buckled(count: usize) -> Network {
    let strains = (0..80).map(|step| -1e-3 * 1.1f64.powi(step));
    let mut towers = strains.map(|strain| tower(Nodes::Points, strain));
    let found = towers.find(|network| {
        let [k, _] = matrices(&network.model);
        n_negative(&part(k.as_ref(), &rows_of(3..12))) >= count
    });
    found.expect("a tower that buckles")
}

/// With the foot held by the job the tower has one negative eigenvalue, then two. Every method says how many, with its interface held where
/// those of the interior are negative already.
#[test]
fn e_09_a_preloaded_component_beyond_buckling() {
    for count in [1, 2] {
        let network = buckled(count);
        let [k, _] = matrices(&network.model);
        assert_eq!(n_negative(&part(k.as_ref(), &rows_of(3..12))), count);
        for (tip, nodes) in [("[11, 12]", [10, 11]), ("[4, 5]", [3, 4])] {
            let interior: Vec<usize> = rows_of((3..12).filter(|node| !nodes.contains(node)));
            let expected = match n_negative(&part(k.as_ref(), &interior)) {
                0 => (count, "no interface held"),
                n => (n, "the interface held"),
            };
            for reduction in METHODS {
                let interface = format!("{{ name = \"tip\", nodes = {tip} }}]\nfixed = [{{ nodes = [1, 2, 3] }}");
                let ended = reduced(&place_of(&network, &network.forces, (PRELOADED, &interface), reduction));
                assert_eq!(ended.code, ExitCode::ModelPhysics, "{reduction}: {}{}", ended.out, ended.err);
                let plural = if expected.0 == 1 { "" } else { "s" };
                let said = format!("{} negative eigenvalue{plural} with {}", expected.0, expected.1);
                let is_told = ended.err.contains("E-NEGATIVE-STIFFNESS") && ended.err.contains(&said);
                assert!(is_told, "{reduction}, {tip}: {said:?} is not in {}", ended.err);
            }
        }
    }
}

/// K and M without some rows, which then have no names.
fn without(model: &Model, rows: &[usize]) -> Model {
    let kept: Vec<usize> = (0..model.n).filter(|row| !rows.contains(row)).collect();
    let place = |row: u32| kept.iter().position(|kept| *kept == row as usize).map(|at| at as u32);
    let rest = |entries: &[(u32, u32, f64)]| {
        entries.iter().filter_map(|(i, j, value)| Some((place(*i)?, place(*j)?, *value))).collect()
    };
    Model {
        n: kept.len(),
        stiffness: rest(&model.stiffness),
        mass: rest(&model.mass),
        dofs: Vec::new(),
        ..model.clone()
    }
}

/// A point in a strut under compression has a negative diagonal. Held by the job it is none of the component any more, and what is left is
/// that of matrices without its rows; not held it is refused, inside and as interface.
#[test]
fn i_13_a_negative_diagonal_of_a_preloaded_state() {
    let network = strutted_tower(0.05);
    let diagonal = |row: usize| {
        let entry = network.model.stiffness.iter().find(|entry| (entry.0, entry.1) == (row as u32, row as u32));
        entry.expect("stored").2
    };
    assert!((36..39).any(|row| diagonal(row) < 0.0) && (0..36).all(|row| diagonal(row) > 0.0));
    let held = rows_of([0, 1, 2, 12]);
    let rest = without(&network.model, &held);
    for reduction in METHODS {
        let interface = "{ name = \"tip\", nodes = [10, 11] }]\nfixed = [{ nodes = [1, 2, 3, 13] }";
        let place = place_of(&network, &network.forces, (PRELOADED, interface), reduction);
        let ended = reduced(&place);
        assert_eq!(ended.code, ExitCode::Done, "{reduction}: {}{}", ended.out, ended.err);
        let (file, job) = (place.text("x.supel"), place.text("job.toml"));
        supel(&["verify", &file]).expect(ExitCode::Done);
        supel(&["verify", &file, "--job", &job]).expect(ExitCode::Done);
        let bare = Place::with(&rest);
        // Nodes 10 and 11 are the seventh and the eighth that are left.
        let job = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\" }}\n\
             interface = [{{ name = \"tip\", nodes = {{ rows = {:?} }} }}]\n\
             reduction = {{ {} }}\nwrite = {{ superelement = \"x.supel\" }}\n",
            rows_of([6, 7]),
            reduction.replace("tip.ux", "tip")
        );
        bare.write("job.toml", job.as_bytes());
        reduced(&bare).expect(ExitCode::Done);
        let [found, expected] = [&place, &bare].map(|place| place.superelement("x.supel"));
        let [k, own_k] = [&found, &expected].map(|file| unpacked(&file.tensors().stiffness));
        let [m, own_m] = [&found, &expected].map(|file| unpacked(&file.tensors().mass));
        // The interface block of K̂ is that of statics, whatever modes are kept; rows of mixed boundaries differ where no node names them.
        for i in 0..6 {
            for j in 0..6 {
                for (a, b) in [(&k, &own_k), (&m, &own_m)] {
                    let size = (b[(i, i)] * b[(j, j)]).abs().sqrt();
                    assert!((a[(i, j)] - b[(i, j)]).abs() <= 1e-11 * size, "{reduction}: ({i}, {j})");
                }
            }
        }
        let (omega, own) = (&found.tensors().frequencies, &expected.tensors().frequencies);
        if !reduction.contains("mixed") {
            assert!(omega.len() == own.len() && omega.iter().zip(own).all(|(a, b)| (a / b - 1.0).abs() < 1e-11));
        }
    }
    for interface in ["{ name = \"tip\", nodes = [10, 11] }", "{ name = \"tip\", nodes = [10, 11, 13] }"] {
        for reduction in METHODS {
            let interface = format!("{interface}]\nfixed = [{{ nodes = [1, 2, 3] }}");
            let ended = reduced(&place_of(&network, &network.forces, (PRELOADED, &interface), reduction));
            assert_eq!(ended.code, ExitCode::ModelPhysics, "{reduction}: {}{}", ended.out, ended.err);
            let codes = ["E-NEG-DIAG", "E-NEGATIVE-STIFFNESS"];
            assert!(codes.iter().any(|code| ended.err.contains(code)), "{reduction}: {}", ended.err);
        }
    }
}

/// Far beyond buckling even the motion of all that moves as a whole has negative energy, although the foot is held: the message does not say
/// that nothing holds it.
#[test]
fn a_held_component_that_turns_as_a_whole_is_not_told_to_be_free() {
    let interface = "{ name = \"tip\", nodes = [11, 12] }]\nfixed = [{ nodes = [1, 2, 3] }";
    let said = [-0.2, -0.4, -0.8].into_iter().find_map(|strain| {
        let network = tower(Nodes::Points, strain);
        let ended = reduced(&place_of(&network, &network.forces, (PRELOADED, interface), METHODS[0]));
        assert_eq!(ended.code, ExitCode::ModelPhysics, "{strain}: {}{}", ended.out, ended.err);
        ended.err.contains("E-PRELOAD-NEGATIVE").then_some(ended.err)
    });
    let said = said.expect("a tower that turns as a whole");
    assert!(said.contains("buckles as it is held") && !said.contains("nothing holds"), "{said}");
}
