//! Joints that lack directions, exported as one model and reduced again: what turns or slides there does so without energy.

use supel::cli::ExitCode;
use supel_models::{Inertia, Material, Model, Section, frame};
use supel_testing::place::{Place, supel};

use crate::again::{again, export};

const JOINED: &str = "--join left.middle=right.middle";

/// Eight nodes of no symmetry from a place on, tied by beams one after the other and by two more.
fn bent(phase: f64, start: Option<[f64; 3]>, more: [[usize; 2]; 2]) -> (Model, [f64; 3]) {
    let at = |i: f64| {
        let of_axis = |size: f64, step: f64, turn: f64| size * (1.0 + (step * i + turn * phase).sin());
        [of_axis(0.5, 12.9, 1.0), of_axis(0.4, 7.3, 2.0), of_axis(0.3, 5.1, 3.0)]
    };
    let first = at(1.0);
    let start = start.unwrap_or(first);
    let nodes: Vec<[f64; 3]> =
        (1..=8).map(|i| at(f64::from(i))).map(|x| std::array::from_fn(|k| x[k] - first[k] + start[k])).collect();
    let edges: Vec<[usize; 2]> = (1..8).map(|i| [i - 1, i]).chain(more).collect();
    (frame(&nodes, &edges, &Section::round(0.02), &Material::STEEL_SI, Inertia::Consistent), nodes[7])
}

/// Both parts reduced by a method to so many modes, with tables of interfaces.
fn parts((method, n_modes): (&str, usize), interfaces: [&str; 2]) -> Place {
    let (left, end) = bent(1.0, None, [[0, 3], [2, 6]]);
    let (right, _) = bent(2.0, Some(end), [[0, 4], [3, 7]]);
    let place = Place::new();
    for ((name, model), interfaces) in [("left", left), ("right", right)].into_iter().zip(interfaces) {
        let own = Place::with(&model);
        let job = format!(
            "model = {{ stiffness = \"K.mtx\", mass = \"M.mtx\", dofs = \"dofs.txt\", nodes = \"nodes.csv\" }}\n\
             interface = [{interfaces}]\nreduction = {{ method = \"{method}\", modes = {{ count = {n_modes} }} }}\n\
             write = {{ superelement = \"x.supel\" }}\n"
        );
        own.write("job.toml", job.as_bytes());
        supel(&["reduce", &own.text("job.toml")]).expect(ExitCode::Done);
        place.write(&format!("{name}.supel"), &own.bytes("x.supel"));
    }
    place
}

/// Modal amplitudes outnumber the rows of nodes, and what K̂ couples them with motions of the whole is rounding: no support touches them.
#[test]
fn amplitudes_are_touched_by_no_support() {
    let right = "{ name = \"middle\", nodes = [1] }, { name = \"end\", nodes = [8] }";
    for (dofs, n_zero) in [("\"ux\", \"uy\", \"uz\", \"ry\", \"rz\"", 7), ("\"ux\", \"uy\", \"uz\"", 9)] {
        let left = format!("{{ name = \"end\", nodes = [1] }}, {{ name = \"middle\", nodes = [8], dofs = [{dofs}] }}");
        for method in [("herting", 6), ("craig-bampton", 12)] {
            let whole = again(&parts(method, [&left, right]), JOINED);
            assert_eq!(whole.n_rigid(), n_zero, "{method:?} {dofs}");
        }
    }
}

/// What slides along the joint has no stiffness at its interface row, which another motion without energy moves by rounding alone: the
/// correction of constraint modes leaves it at rest.
#[test]
fn a_row_that_only_rounding_moves_carries_nothing() {
    let left = "{ name = \"end\", nodes = [1], dofs = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"] }, \
                { name = \"middle\", nodes = [8] }, { name = \"side\", nodes = [5] }";
    let right =
        "{ name = \"middle\", nodes = [1], dofs = [\"ux\", \"uz\", \"rx\", \"rz\"] }, { name = \"end\", nodes = [8] }";
    let place = parts(("craig-bampton", 6), [left, right]);
    let held = "--fix left.end --fix left.side.rx --fix left.side.ry --fix left.side.rz";
    assert_eq!(again(&place, &format!("{JOINED} {held}")).n_rigid(), 3);
}

/// A part slides inside, and no interface moves with it: more digits would not hold it.
#[test]
fn a_part_that_no_interface_moves_is_no_want_of_digits() {
    let left =
        "{ name = \"end\", nodes = [1], dofs = [\"ux\", \"rx\", \"ry\", \"rz\"] }, { name = \"middle\", nodes = [8] }";
    let right =
        "{ name = \"middle\", nodes = [1], dofs = [\"ux\", \"uy\", \"rx\", \"rz\"] }, { name = \"end\", nodes = [8] }";
    let place = parts(("craig-bampton", 6), [left, right]);
    export(&place, JOINED).expect(ExitCode::Done);
    let refused = supel(&["reduce", &place.text("whole.job.toml")]);
    assert_eq!(refused.code, ExitCode::ModelPhysics, "{}", refused.err);
    assert!(refused.err.contains("E-NOT-DEFINITE") && refused.err.contains("node 2 uz"), "{}", refused.err);
}
