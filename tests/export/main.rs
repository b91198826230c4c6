//! `supel export`: every format says what the superelement says, read by readers that stand here.

mod again;
mod as_model;
mod carried;
mod command;
mod little_stiffness;
mod matrix_market;
mod op4;
mod scalar_points;

use supel::cli::ExitCode;
use supel_runtime::{Matrix, Superelement};
use supel_testing::place::{Ended, Place, supel};

/// A brick reduced by a job to x.supel, with recovered nodes; free with loads of gravity, or held at one end.
fn reduced(method: &str, fixed: &str) -> Place {
    let place = Place::with_brick();
    let modes = if method == "guyan" { "" } else { ", modes = { count = 5 }" };
    let job = format!(
        r#"
model     = {{ stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv", units = "SI" }}
interface = [{{ name = "foot", nodes = [1, 11, 31] }}, {{ name = "hub", nodes = [5, 10, 15, 20, 25], coupling = "rigid" }}]
{fixed}
reduction = {{ method = "{method}"{modes} }}
write     = {{ superelement = "x.supel", recovery = {{ nodes = [2, 3] }} }}
"#
    );
    place.write("job.toml", job.as_bytes());
    supel(&["reduce", &place.text("job.toml")]).expect(ExitCode::Done);
    place
}

/// Three nodes are held.
const HELD: &str = "fixed = [{ name = \"wall\", nodes = [35, 41, 45] }]";
/// Three nodes of one edge are held: the component turns about it.
const HINGED: &str = "fixed = [{ name = \"edge\", nodes = [41, 42, 43] }]";

/// `supel export x.supel --to FORMAT`, with more arguments.
fn export(place: &Place, format: &str, more: &[&str]) -> Ended {
    let file = place.text("x.supel");
    supel(&[["export", file.as_str(), "--to", format].as_slice(), more].concat())
}

/// The matrices that a client gets under the names of the runtime, where the file has them.
fn tensors(superelement: &Superelement) -> [Option<&Matrix>; 4] {
    let tensors = superelement.tensors();
    let recovery = tensors.recovery.as_ref().map(|recovery| recovery.rows());
    [Some(&tensors.stiffness), Some(&tensors.mass), tensors.gravity.as_ref(), recovery]
}

#[track_caller]
fn assert_same_bits(found: &[Vec<f64>], expected: &Matrix, what: &str) {
    assert_eq!(found.len(), expected.rows(), "rows of {what}");
    for (i, row) in found.iter().enumerate() {
        let bits = |values: &[f64]| values.iter().map(|value| (value + 0.0).to_bits()).collect::<Vec<u64>>();
        assert_eq!(bits(row), bits(expected.row(i).expect("a row")), "row {i} of {what}");
    }
}
