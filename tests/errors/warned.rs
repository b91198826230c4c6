//! Warnings that the stress catalogue does not reach.

use supel::cli::ExitCode;
use supel_models::transform::grounded;
use supel_models::{Ends, HexMesh, Inertia, Material, Section, frame, spring};

use crate::place::{Ended, Place, steel_brick, supel};

/// Asserts that a run warned so, and only so.
#[track_caller]
fn assert_warned(place: &Place, ended: &Ended, code: &str) {
    assert_eq!(ended.code, ExitCode::Done, "{}{}", ended.out, ended.err);
    let warnings = place.report("x.report.json")["body"]["warnings"].as_array().expect("warnings").clone();
    let codes: Vec<&str> = warnings.iter().map(|warning| warning["code"].as_str().expect("a code")).collect();
    assert_eq!(codes, [code], "{warnings:#?}");
}

/// A mass is expected of a chain whose nodes have no place.
#[test]
fn expected_mass_without_coordinates() {
    let place = Place::with(&spring(5, Ends::Free));
    let job = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx", expect = { mass = 5.0 } }
interface = [{ name = "ends", nodes = { rows = [0, 4] } }]
reduction = { method = "herting", modes = { count = 1 } }
write     = { superelement = "x.supel" }
"#;
    place.write("job.toml", job.as_bytes());
    assert_warned(&place, &supel(&["reduce", &place.text("job.toml")]), "W-EXPECT-UNCHECKED");
}

#[test]
fn more_modes_than_there_are() {
    let place = Place::with(&spring(5, Ends::Free));
    let ended = place.reduce(&place.matrix_flags(), "--interface ends=rows:0,4 --method craig-bampton --modes 9");
    assert_warned(&place, &ended, "W-FEWER-MODES");
}

/// Three nodes of a unit block whose third is off the line of the others by three thousandths.
#[test]
fn interface_that_is_nearly_in_line() {
    let graded = |[x, y, z]: [f64; 3]| [x, if y == 0.25 { 0.003 } else { y }, 0.7 * z];
    let mesh = HexMesh::structured([2, 4, 1], graded, |_| true);
    let place = Place::with(&mesh.assemble(&Material::STEEL_SI));
    let ended = place.reduce(&place.model_flags(), "--interface pins=1,3,5 --method herting --modes 2");
    assert_warned(&place, &ended, "W-INTERFACE-ILL");
}

/// A spring of 10⁻⁵ of the stiffness it hangs on.
#[test]
fn component_on_a_soft_spring() {
    let model = steel_brick();
    let largest = model.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2));
    let place = Place::with(&grounded(&model, 0, 1e-6 * largest));
    let ended = place.reduce(&place.model_flags(), "--interface foot=1,11,31,41 --method herting --modes 5");
    assert_warned(&place, &ended, "W-GROUNDED");
}

/// A node with a rotation about x that resists a millionth of what the others do, next to one that resists as a strip of 1:50 does.
#[test]
fn rotation_of_an_interface_node_that_hardly_resists() {
    let nodes = [[0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 0.6, 0.0], [1.0, 1.3, 0.0]];
    let of = |torsion: f64| {
        let section = Section { torsion, ..Section::round(0.05) };
        let edges = [[0, 1], [1, 2], [2, 3], [3, 4]];
        let place = Place::with(&frame(&nodes, &edges, &section, &Material::STEEL_SI, Inertia::Consistent));
        let ended = place.reduce(&place.model_flags(), "--interface ends=1,5 --method herting --modes 3");
        (place, ended)
    };
    let bending = Section::round(0.05).second_moment_z;
    // With all else held GJ/L against 4EI/L: 0.1 J/I.
    let (place, ended) = of(1e-5 * bending);
    assert_warned(&place, &ended, "W-SOFT-ROTATION");
    let said = place.report("x.report.json")["body"]["warnings"][0]["message"].as_str().expect("words").to_owned();
    for part in ["node 1 of interface \"ends\", and 1 node like it", "about (1, 0, 0) has 1e-6", "\"average\""] {
        assert!(said.contains(part), "{said}");
    }
    let (place, _) = of(1e-3 * bending);
    assert_eq!(place.report("x.report.json")["body"]["warnings"].as_array().expect("warnings").len(), 0);
}
