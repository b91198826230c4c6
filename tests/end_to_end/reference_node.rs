//! A patch whose nodes a rigid element of the model joins to a node of their own: the report names that node.

use supel::cli::ExitCode;
use supel_models::Model;
use supel_models::model::Assembler;

use crate::place::{Place, steel_brick, supel};

/// The patch, and the node of the rigid element.
const PATCH: [i64; 5] = [5, 10, 15, 20, 25];
const NODE: i64 = 900;

/// The brick with a node of six dofs that springs of 10¹³ N/m hold to these nodes as a rigid body: u_i − t − θ × r_i costs their energy.
fn with_rigid_element(to: &[i64]) -> Model {
    let mut model = steel_brick();
    let at = |label: i64| model.nodes[label as usize - 1];
    let centre: [f64; 3] =
        std::array::from_fn(|axis| to.iter().map(|label| at(*label)[axis]).sum::<f64>() / to.len() as f64);
    let first = model.n as u32;
    let mut stiffness = Assembler::default();
    stiffness.extend(model.stiffness.iter().copied());
    for label in to {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| at(*label)[axis] - centre[axis]);
        let turned = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]];
        for (axis, of_axis) in turned.iter().enumerate() {
            let row = model.dofs.iter().position(|dof| *dof == (*label, axis as u8)).expect("a dof") as u32;
            let mut factors = vec![(row, 1.0), (first + axis as u32, -1.0)];
            factors.extend((0..3).map(|about| (first + 3 + about as u32, -of_axis[about])));
            for (i, a) in &factors {
                factors.iter().filter(|(_, b)| a * b != 0.0).for_each(|(j, b)| stiffness.add(*i, *j, 1e13 * a * b));
            }
        }
    }
    let mut mass = Assembler::default();
    mass.extend(model.mass.iter().copied());
    (0..6).for_each(|dof| mass.add(first + dof, first + dof, if dof < 3 { 1e-3 } else { 1e-6 }));
    (model.stiffness, model.mass) = (stiffness.finish(), mass.finish());
    model.nodes.push(centre);
    model.labels.push(NODE);
    model.dofs.extend((0..6).map(|direction| (NODE, direction)));
    model.n += 6;
    model
}

fn report(model: &Model, coupling: &str) -> String {
    let place = Place::with(model);
    let job = format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }}
interface = [{{ name = "foot", nodes = [1, 11, 31] }}, {{ name = "hub", nodes = {PATCH:?}, coupling = "{coupling}" }}]
reduction = {{ method = "craig-bampton", modes = {{ count = 4 }} }}
write     = {{ superelement = "x.supel" }}
"#
    );
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml"), "--quiet"]).expect(ExitCode::Done);
    place.report_body("x.report.json")
}

#[test]
fn the_node_of_a_rigid_element_is_named() {
    let joined = with_rigid_element(&PATCH);
    for coupling in ["rigid", "average"] {
        let found = report(&joined, coupling);
        assert!(found.contains("node 900 has rotations and is joined to all 5 nodes of the patch"), "{found}");
    }
    // Joined to some of the patch alone; without such a node nothing is said.
    for model in [with_rigid_element(&PATCH[1..]), steel_brick()] {
        let found = report(&model, "rigid");
        assert!(!found.contains("has rotations"), "{found}");
    }
}
