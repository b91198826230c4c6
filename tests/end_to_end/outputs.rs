//! What modes contribute at the interface, to outputs and under loads, and the outputs that a scene names.
//!
//! A block with one end at rest, joined at the middle line of the other end in the directions of its plane of symmetry: bending out of that
//! plane and torsion do not move that line in it. Gravity in any direction starts bending, and never torsion.

use serde_json::{Value, json};
use supel::cli::ExitCode;
use supel_models::{Material, brick};

use crate::place::{Place, supel};

/// Ten modes of the block by a method under a scene, with further tables.
fn reduced(place: &Place, (method, scene, rest): (&str, &str, &str)) -> Value {
    let text = format!(
        "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
         fixed = [{{ name = \"wall\", nodes = [1, 6, 11, 16, 21, 26, 31, 36, 41] }}]\n\
         interface = [{{ name = \"tip\", nodes = [10, 25, 40], dofs = [\"ux\", \"uz\"] }}]\n\
         reduction = {{ method = \"{method}\", modes = {{ count = 10 }} }}\n\
         scene = {{ boundaries = [\"free\", \"fix:tip\"]{scene} }}\n\
         write = {{ superelement = \"x.supel\", html = \"x.html\" }}\n{rest}"
    );
    place.write("job.toml", text.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    place.report("x.report.json")["body"].take()
}

/// A number of every mode.
fn of_modes(body: &Value, key: &str) -> Vec<f64> {
    let modes = body["reduction"]["modes"].as_array().expect("modes").iter();
    modes.map(|mode| mode[key].as_f64().expect("a number")).collect()
}

/// The modes that nothing sees, from zero.
fn unseen(body: &Value) -> Vec<usize> {
    let numbers = body["reduction"]["unseen"].as_array().expect("numbers").iter();
    numbers.map(|number| number.as_u64().expect("a number") as usize - 1).collect()
}

/// Torsion is listed, of frequencies that hold whatever happens at the interface, and comes last in rank.
#[test]
fn modes_that_nothing_sees_are_listed_and_kept() {
    let place = Place::with_brick();
    for method in ["craig-bampton", "herting"] {
        let body = reduced(&place, (method, "", ""));
        let (unseen, hz) = (unseen(&body), of_modes(&body, "frequency_hz"));
        assert!(unseen.len() > 1 && hz.len() == 10, "{method}: {unseen:?}");
        let boundaries = body["preservation"]["boundaries"].as_array().expect("boundaries");
        for mode in &unseen {
            for boundary in boundaries {
                let pairs = boundary["frequencies"].as_array().expect("pairs");
                // Frequencies are compared up to the end of the band.
                let has_it = |pair: &Value| (pair["full_hz"].as_f64().expect("one") / hz[*mode] - 1.0).abs() < 1e-9;
                let is_beyond = pairs.last().is_none_or(|last| last["full_hz"].as_f64() < Some(hz[*mode]));
                assert!(
                    is_beyond || pairs.iter().any(has_it),
                    "{method}: {} under {}",
                    hz[*mode],
                    boundary["boundary"]
                );
            }
        }
        let ranks = of_modes(&body, "rank");
        let mut sorted = ranks.clone();
        sorted.sort_by(f64::total_cmp);
        assert_eq!(sorted, (1..=10).map(f64::from).collect::<Vec<f64>>());
        assert!(unseen.iter().all(|mode| ranks[*mode] > (10 - unseen.len()) as f64), "{method}: {ranks:?}");
        let couplings = of_modes(&body, "coupling");
        let by_rank = |rank: usize| couplings[ranks.iter().position(|of| *of == rank as f64).expect("a mode")];
        assert!((1..10).all(|rank| by_rank(rank) >= by_rank(rank + 1)), "{method}");
        assert!(unseen.iter().all(|mode| couplings[*mode] < 1e-9 * by_rank(1)), "{method}: {couplings:?}");
        let page = String::from_utf8(place.bytes("x.html")).expect("text");
        assert!(page.contains("contribution"), "{method}: the page has them");
    }
}

/// A corner of the end moves in torsion, and a force on it starts it; the rows of an output are recovered.
#[test]
fn outputs_and_loads_see_modes_that_the_interface_does_not() {
    let place = Place::with_brick();
    let alone = unseen(&reduced(&place, ("herting", "", "")));
    // A corner moves in every mode.
    let at_corner = reduced(&place, ("herting", ", outputs = { nodes = [5] }", ""));
    assert!(unseen(&at_corner).is_empty() && !alone.is_empty(), "{alone:?}");
    let superelement = place.superelement("x.supel");
    let recovery = superelement.tensors().recovery.as_ref().expect("rows of the output");
    assert!(recovery.dofs().iter().all(|dof| dof.node == 5) && recovery.dofs().len() == 3);
    let inspected = supel(&["inspect", &place.text("x.supel")]).expect(ExitCode::Done);
    assert!(inspected.out.contains("recovered nodes alone are looked at"), "{}", inspected.out);
    supel(&["verify", &place.text("x.supel")]).expect(ExitCode::Done);
    supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.toml")]).expect(ExitCode::Done);
    let load = "load = [{ name = \"side\", nodes = [5], force = [0, 1, 0] }]\n";
    assert!(unseen(&reduced(&place, ("herting", "", load))).len() < alone.len());
}

/// A square block bends in pairs of one frequency, of which any mixture is a mode: with gravity out of the way the interface sees one of the
/// two, and both count as seen.
#[test]
fn modes_of_a_cluster_are_seen_together() {
    let place = Place::with(&brick([4, 2, 2], [1.0, 0.2, 0.2], &Material::STEEL_SI));
    let body = reduced(&place, ("herting", "", ""));
    let (unseen, hz) = (unseen(&body), of_modes(&body, "frequency_hz"));
    let is_paired = |mode: usize| (0..10).any(|other| other != mode && (hz[other] / hz[mode] - 1.0).abs() < 1e-7);
    assert!((0..10).any(is_paired), "{hz:?}");
    assert!(unseen.iter().all(|mode| !is_paired(*mode)), "{unseen:?} of {hz:?}");
}

#[test]
fn outputs_that_do_not_exist_are_refused_by_their_key() {
    let place = Place::with_brick();
    let job = |outputs: Value| {
        let job = json!({
            "model": { "stiffness": "K.mtx", "mass": "M.mtx", "dofs": "dofs.txt", "nodes": "nodes.csv" },
            "interface": [{ "name": "root", "nodes": [1, 6, 11, 16] }],
            "reduction": { "method": "herting", "modes": { "count": 4 } },
            "scene": { "outputs": outputs },
            "write": { "superelement": "x.supel" },
        });
        place.write("job.json", job.to_string().as_bytes());
        supel(&["reduce", &place.text("job.json")])
    };
    for (outputs, words) in [
        (json!({ "nodes": [99] }), "99"),
        (json!({ "nodes": [] }), "scene.outputs.nodes"),
        (json!({ "nodes": [5, 5] }), "scene.outputs"),
        (json!({ "nodes": "group:SKIN" }), "scene.outputs"),
        (json!({ "node": [5] }), "outputs"),
        (json!("everywhere"), "scene.outputs"),
    ] {
        let ended = job(outputs.clone());
        assert_ne!(ended.code, ExitCode::Done, "{outputs}");
        assert!(ended.err.contains(words), "{outputs}: {}", ended.err);
    }
}
