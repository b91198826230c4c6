//! M with its rows in another order than those of K, to which map and coordinates belong: never verified where it can be seen.

use supel::cli::ExitCode;
use supel_models::model::{Assembler, Entry};
use supel_models::transform::{join, translated};
use supel_models::{Inertia, Material, Model, Section, brick, frame};
use supel_runtime::Superelement;

use crate::faults::{block, shuffled};
use crate::place::{Ended, Place, supel};
use crate::table::{listed, said};

/// The model with another mass.
pub(crate) fn with_mass(model: &Model, mass: Vec<Entry>) -> Model {
    let mut sorted = Assembler::default();
    sorted.extend(mass);
    Model { mass: sorted.finish(), ..model.clone() }
}

/// The mass with row `place(r)` where row r was.
fn moved(model: &Model, place: impl Fn(u32) -> u32) -> Model {
    with_mass(model, model.mass.iter().map(|(row, col, value)| (place(*row), place(*col), *value)).collect())
}

/// Nodes of three rows each, renumbered.
fn nodes_moved(model: &Model, node: impl Fn(u32) -> u32) -> Model {
    moved(model, |row| 3 * node(row / 3) + row % 3)
}

/// All rows along x first, then all along y, then all along z, of nodes that have the same directions.
pub(crate) fn direction_by_direction(model: &Model) -> Model {
    let n_directions = model.dofs.iter().filter(|dof| dof.0 == model.dofs[0].0).count() as u32;
    let n_nodes = model.n as u32 / n_directions;
    moved(model, |row| row % n_directions * n_nodes + row / n_directions)
}

/// The block with its mass on the diagonal, as lumping by row sums makes it.
fn lumped() -> Model {
    lumped_of(&block())
}

pub(crate) fn lumped_of(model: &Model) -> Model {
    let direction = |row: u32| model.dofs[row as usize].1;
    let along_one = model.mass.iter().filter(|(row, col, _)| direction(*row) == direction(*col));
    with_mass(model, along_one.map(|(row, _, value)| (*row, *row, *value)).collect())
}

/// Reduces a model at the ends of the block.
fn reduced(model: &Model, coupling: &str, rest: &str) -> (Place, Ended) {
    let place = Place::with(model);
    let ends = [&model.groups["XMIN"], &model.groups["XMAX"]].map(|labels| listed(labels));
    let flags = format!("--{coupling} first={} --{coupling} second={} --modes 5 {rest}", ends[0], ends[1]);
    let ended = place.reduce(&place.model_flags(), &flags);
    (place, ended)
}

#[track_caller]
fn assert_said(model: &Model, expected: &str) {
    for coupling in ["interface", "rigid-interface"] {
        for method in ["herting", "craig-bampton"] {
            let (place, ended) = reduced(model, coupling, &format!("--method {method}"));
            assert_eq!(said(&place, &ended), expected, "{coupling}, {method}: {}{}", ended.out, ended.err);
        }
    }
}

/// A direction that has no mass at any node, as where masses act across gravity alone, is told, and the mass of what something holds is not called
/// that of no body for it.
#[test]
fn a_direction_without_mass_of_a_held_component() {
    let held = block();
    let across = |row: &u32| held.dofs[*row as usize].1 != 2;
    let flat = with_mass(&held, held.mass.iter().filter(|(i, j, _)| across(i) && across(j)).copied().collect());
    let place = Place::with(&flat);
    let ends = ["XMIN", "XMAX"].map(|name| listed(&flat.groups[name]));
    let flags = format!("--fix wall={} --rigid-interface tip={} --method craig-bampton --modes 5", ends[0], ends[1]);
    let ended = place.reduce(&place.model_flags(), &flags).expect(ExitCode::Done);
    assert_eq!(said(&place, &ended), "W-MASS-DIRECTION", "{}{}", ended.out, ended.err);
    let report = place.report("x.report.json");
    let is_judged = |check: &serde_json::Value| check["name"] == "mass is that of a body";
    assert!(!report["body"]["checks"].as_array().expect("checks").iter().any(is_judged), "{}", ended.out);
}

#[test]
fn nodes_of_a_consistent_mass_in_another_order() {
    let order = shuffled(block().n / 3);
    assert_said(&nodes_moved(&block(), |node| order[node as usize] as u32), "E-MASS-ORDER");
    assert_said(&direction_by_direction(&block()), "E-MASS-ORDER");
    // Without a map the rows tell.
    let anonymous = Model { dofs: Vec::new(), ..direction_by_direction(&block()) };
    let place = Place::with(&anonymous);
    let ended =
        place.reduce(&place.matrix_flags(), "--interface ends=rows:0,1,2,3,4,5,6,7,8 --modes 5 --method herting");
    assert_eq!(said(&place, &ended), "E-MASS-ORDER", "{}", ended.err);
}

#[test]
fn two_nodes_of_a_consistent_mass_exchanged() {
    let exchanged = nodes_moved(&block(), |node| match node {
        20 => 66,
        66 => 20,
        node => node,
    });
    assert_said(&exchanged, "E-MASS-ORDER");
    // With an instrument over distant nodes the counts of neighbours differ as well, and prove nothing.
    let mut mass = exchanged.mass.clone();
    mass.extend((0..3).flat_map(|d| [(3 * 5 + d, d, 1e-3), (d, 3 * 5 + d, 1e-3)]));
    mass.extend((0..3).flat_map(|d| [(3 * 5 + d, 3 * 5 + d, 2e-3), (d, d, 2e-3)]));
    assert_said(&with_mass(&exchanged, mass), "W-MASS-ORDER");
}

/// Along a regular mesh most nodes keep most of their neighbours.
#[test]
fn nodes_of_a_consistent_mass_shifted_along_the_mesh() {
    let n_nodes = block().n as u32 / 3;
    for shift in [1, 2] {
        assert_said(&nodes_moved(&block(), |node| (node + shift) % n_nodes), "E-MASS-ORDER");
    }
}

/// A diagonal mass couples nothing; that masses differ with direction is all there is to see, and all who look see it.
#[test]
fn a_lumped_mass_direction_by_direction() {
    assert_said(&lumped(), "verified");
    // Every third node of the block has a third of its mass: its three directions still have one mass, and the file states properties of
    // it. In the other block each direction gets another mass, and there are none to state.
    let uneven = brick([4, 2, 2], [1.2, 0.55, 0.31], &Material::STEEL_SI);
    for (model, is_a_mass) in [(lumped(), true), (lumped_of(&uneven), false)] {
        let wrong = direction_by_direction(&model);
        assert_said(&wrong, "W-MASS-DIRECTION, M-16");
        let superelement = assert_failed_as_no_body(&wrong);
        assert_eq!(superelement.metadata().model.mass_properties.is_some(), is_a_mass);
    }
}

/// A reduction, and both verifications of its file, fail because the mass is not that of a body, and for nothing else; gives the file.
#[track_caller]
fn assert_failed_as_no_body(wrong: &Model) -> Superelement {
    let (place, ended) = reduced(wrong, "rigid-interface", "--method herting --allow-unverified");
    assert_eq!(ended.code, ExitCode::CheckFailed, "{}", ended.out);
    let file = place.text("x.supel");
    place.write("job.json", supel(&["inspect", &file, "--job"]).out.as_bytes());
    for rest in [&[][..], &["--job", &place.text("job.json")]] {
        let verified = supel(&[&["verify", &file, "--json"], rest].concat());
        let document: serde_json::Value = serde_json::from_str(&verified.out).expect("JSON");
        let checks = document["checks"].as_array().expect("checks").iter();
        let failed =
            checks.filter(|check| check["verdict"] == "fail").map(|check| check["name"].as_str().expect("a name"));
        assert_eq!(
            failed.collect::<Vec<_>>(),
            ["mass is that of a body", "no check failed when it was made"],
            "{rest:?}"
        );
    }
    place.superelement("x.supel")
}

/// Supports in the job hide nothing of it: the whole mass is known before they take rows out.
#[test]
fn a_lumped_mass_direction_by_direction_of_a_held_block() {
    for (model, code) in [(lumped(), ExitCode::Done), (direction_by_direction(&lumped()), ExitCode::CheckFailed)] {
        let place = Place::with(&model);
        let [wall, end] = [&model.groups["XMIN"], &model.groups["XMAX"]].map(|labels| listed(labels));
        for coupling in ["interface", "rigid-interface"] {
            let flags =
                format!("--fix wall={wall} --{coupling} end={end} --modes 5 --method herting --allow-unverified");
            let ended = place.reduce(&place.model_flags(), &flags);
            assert_eq!(ended.code, code, "{coupling}: {}{}", ended.out, ended.err);
            assert_eq!(ended.out.contains("1 of"), code == ExitCode::CheckFailed, "M-16 alone: {}", ended.out);
            place.write("job.json", supel(&["inspect", &place.text("x.supel"), "--job"]).out.as_bytes());
            let verified = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.json")]);
            assert_eq!(verified.code, code, "{coupling}: {}{}", verified.out, verified.err);
        }
    }
}

/// Neither do other bodies: what is not one body has a mass all the same.
#[test]
fn a_lumped_mass_direction_by_direction_of_two_bodies() {
    let sound = lumped_of(&join(&block(), &translated(&block(), [10.0, 2.0, 1.0]), &[]));
    for (model, code) in [(sound.clone(), ExitCode::Done), (direction_by_direction(&sound), ExitCode::CheckFailed)] {
        let place = Place::with(&model);
        for method in ["herting", "craig-bampton", "guyan"] {
            let modes = if method == "guyan" { "" } else { " --modes 5" };
            let [a, b] = ["XMIN", "B.XMAX"].map(|name| listed(&sound.groups[name]));
            let flags = format!("--rigid-interface a={a} --rigid-interface b={b}");
            let ended =
                place.reduce(&place.model_flags(), &format!("{flags} --method {method}{modes} --allow-unverified"));
            assert_eq!(ended.code, code, "{method}: {}{}", ended.out, ended.err);
            place.write("job.json", supel(&["inspect", &place.text("x.supel"), "--job"]).out.as_bytes());
            let verified = supel(&["verify", &place.text("x.supel"), "--job", &place.text("job.json")]);
            assert_eq!(verified.code, code, "{method}: {}{}", verified.out, verified.err);
        }
    }
}

/// Two blocks on springs between nodes at one place, the second so many times as light and as soft and with another mass.
fn on_springs(share: f64, mass: impl Fn(&Model) -> Model) -> Model {
    let first = block();
    let length = first.nodes.iter().fold(0.0f64, |max, x| max.max(x[0]));
    let mut second = mass(&translated(&first, [length, 0.0, 0.0]));
    second.stiffness.iter_mut().chain(&mut second.mass).for_each(|entry| entry.2 *= share);
    let mut whole = join(&first, &second, &[]);
    let row =
        |label: i64, direction: u8| whole.dofs.iter().position(|dof| *dof == (label, direction)).expect("a row") as u32;
    let mut stiffness = Assembler::default();
    stiffness.extend(whole.stiffness.iter().copied());
    let stiff = share * first.stiffness.iter().fold(0.0f64, |max, entry| max.max(entry.2));
    for (a, b) in whole.groups["XMAX"].iter().zip(&whole.groups["B.XMIN"]) {
        for direction in 0..3 {
            let [i, j] = [*a, *b].map(|label| row(label, direction));
            for (i, j, k) in [(i, i, stiff), (j, j, stiff), (i, j, -stiff), (j, i, -stiff)] {
                stiffness.add(i, j, k);
            }
        }
    }
    whole.stiffness = stiffness.finish();
    whole
}

/// A light part behind springs has a mass of its own to be that of a body.
#[test]
fn a_light_part_direction_by_direction() {
    for share in [1e-3, 1e-5, 1e-6] {
        let shuffle = |model: &Model| direction_by_direction(model);
        for (model, code) in
            [(on_springs(share, Clone::clone), ExitCode::Done), (on_springs(share, shuffle), ExitCode::CheckFailed)]
        {
            let place = Place::with(&model);
            let [a, b] = ["XMIN", "B.XMAX"].map(|name| listed(&model.groups[name]));
            let flags = format!("--rigid-interface a={a} --rigid-interface b={b} --method herting --modes 5");
            let ended = place.reduce(&place.model_flags(), &flags);
            assert_eq!(ended.code, code, "{share:e}: {}{}", ended.out, ended.err);
        }
        // A diagonal mass couples nothing: its nodes are named.
        let place = Place::with(&on_springs(share, |model| direction_by_direction(&lumped_of(model))));
        let ended = place.reduce(&place.model_flags(), "--interface a=1,2,7 --method herting --modes 5");
        assert!(ended.out.contains("W-MASS-DIRECTION") || ended.code != ExitCode::Done, "{share:e}: {}", ended.out);
    }
}

/// Nodes of a lumped mass permuted: no order contradicts K, and the page says so.
#[test]
fn nodes_of_a_lumped_mass_in_another_order_are_not_seen() {
    let order = shuffled(block().n / 3);
    assert_said(&nodes_moved(&lumped(), |node| order[node as usize] as u32), "verified");
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/what-the-report-proves.md"));
    assert!(page.expect("the page").contains("the nodes of a lumped mass are in the order of those of the stiffness"));
}

/// Tubes side by side with lumped masses and that of the fluid between neighbours: M couples across them what K couples along them.
fn tubes(n_tubes: usize, n_nodes: usize, inertia: Inertia) -> Model {
    let place =
        |k: usize| [0.1 * (k % n_nodes) as f64, 0.05 * (k / n_nodes) as f64, 0.01 * (k / n_nodes).pow(2) as f64];
    let nodes: Vec<[f64; 3]> = (0..n_tubes * n_nodes).map(place).collect();
    let along = |k: &usize| k % n_nodes + 1 < n_nodes;
    let edges: Vec<[usize; 2]> = (0..nodes.len()).filter(along).map(|k| [k, k + 1]).collect();
    frame(&nodes, &edges, &Section::round(0.006), &Material::STEEL_SI, inertia)
}

/// A bundle of as many tubes as nodes along each has as many neighbours in M as in K, and other ones. Nothing of it is proof: the mass of
/// the tubes themselves couples rotations, and in another order it is refused.
#[test]
fn added_mass_between_the_tubes_of_a_bundle_warns() {
    for (n_tubes, n_nodes) in [(2, 2), (3, 3)] {
        let bundle = tubes(n_tubes, n_nodes, Inertia::LumpedTranslations);
        for [own, between] in [[1.0, -1.0], [2.0, 1.0]] {
            let mut mass = bundle.mass.clone();
            // Else the tubes spin without inertia.
            mass.extend((0..bundle.n as u32).filter(|row| row % 6 > 2).map(|row| (row, row, 1e-5)));
            for node in 0..(n_tubes - 1) * n_nodes {
                for [i, j] in [0, 1, 2].map(|axis| [6 * node + axis, 6 * (node + n_nodes) + axis].map(|row| row as u32))
                {
                    mass.extend(
                        [(i, i, own), (j, j, own), (i, j, between), (j, i, between)].map(|(i, j, m)| (i, j, 0.02 * m)),
                    );
                }
            }
            let place = Place::with(&with_mass(&bundle, mass));
            let ends: Vec<String> = (0..n_tubes).map(|t| format!("--interface t{t}={}", t * n_nodes + 1)).collect();
            let ended =
                place.reduce(&place.model_flags(), &format!("{} --method craig-bampton --modes 3", ends.join(" ")));
            assert_eq!(ended.code, ExitCode::Done, "{n_tubes} by {n_nodes}: {}{}", ended.out, ended.err);
            assert!(ended.out.contains("W-MASS-ORDER"), "{n_tubes} by {n_nodes}: {}", ended.out);
        }
    }
    let consistent = tubes(3, 3, Inertia::Consistent);
    let across = |row: u32| 6 * (row / 6 % 3 * 3 + row / 18) + row % 6;
    let moved = moved(&consistent, across);
    let place = Place::with(&moved);
    let ended = place
        .reduce(&place.model_flags(), "--interface a=1 --interface b=4 --interface c=7 --method herting --modes 3");
    assert!(ended.err.contains("E-MASS-ORDER"), "{}{}", ended.out, ended.err);
}

/// Mass that couples nodes which no element joins: what a fluid adds at one face, and an instrument over distant nodes.
#[test]
fn mass_of_no_element_is_sound() {
    let model = block();
    let added = |nodes: &[i64]| {
        let rows: Vec<u32> =
            nodes.iter().flat_map(|node| (0..3).map(move |axis| 3 * (*node as u32 - 1) + axis)).collect();
        let of = |(row, col): (u32, u32)| (row, col, if row == col { 3.0 } else { 1.0 });
        let pairs = rows.iter().flat_map(|row| rows.iter().map(move |col| (*row, *col)));
        pairs.filter(|(row, col)| row % 3 == col % 3).map(of).collect::<Vec<Entry>>()
    };
    for nodes in [model.groups["ZMAX"].clone(), vec![3, 80]] {
        let mass = model.mass.iter().copied().chain(added(&nodes)).collect();
        assert_said(&with_mass(&model, mass), "verified");
    }
}
