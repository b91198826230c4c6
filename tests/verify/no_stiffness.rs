//! Interface dofs and dofs of patches whose stiffness is nothing but rounding, which is no size: sound files are verified against their job.

use supel_models::{Inertia, Material, Model, Section, brick, frame, transform::join, transform::translated};

use crate::degenerate::agree_by_job;

/// A straight beam of so many nodes, and behind them a node of three dofs with mass and without stiffness.
fn beam_and_mass(n: i32) -> Model {
    let nodes: Vec<[f64; 3]> = (0..n).map(|i| [0.1 * f64::from(i), 0.0, 0.0]).collect();
    let edges: Vec<[usize; 2]> = (1..n as usize).map(|i| [i - 1, i]).collect();
    let mut model = frame(&nodes, &edges, &Section::round(0.01), &Material::STEEL_SI, Inertia::Consistent);
    let label = i64::from(n) + 1;
    model.nodes.push([0.5, 0.1, 0.0]);
    model.labels.push(label);
    for direction in 0..3 {
        let row = model.n as u32;
        model.dofs.push((label, direction));
        model.mass.push((row, row, 5.0));
        model.n += 1;
    }
    model
}

/// What rounding leaves of the stiffness of a free mass at the interface, and of the work of a load on it, is compared with what the mass
/// resists in the first elastic mode, and it tells nothing of the signs of modes.
#[test]
fn a_free_mass_at_the_interface_agrees() {
    let load = "load = [{ name = \"f\", nodes = [2], force = [1, 2, 3] }]\n";
    for (method, load) in
        ["herting", "craig-bampton", "guyan"].into_iter().flat_map(|method| [(method, ""), (method, load)])
    {
        let modes = if method == "guyan" { "" } else { ", modes = { count = 3 }" };
        agree_by_job(
            &beam_and_mass(5),
            &format!(
                "interface = [{{ name = \"i\", nodes = [6, 3, 5] }}]\n{load}reduction = {{ method = \"{method}\"{modes} }}"
            ),
        );
    }
}

/// A dof of the mean of all nodes that is none of the interface: what it takes of a unit load is the rounding of the terms that cancel there.
#[test]
fn a_part_of_the_mean_of_all_nodes_agrees() {
    let block = brick([2, 1, 1], [0.2, 0.1, 0.1], &Material::STEEL_SI);
    let nodes: Vec<i64> = block.labels.clone();
    for dofs in ["[\"ux\", \"uy\", \"uz\"]", "[\"uy\", \"rx\", \"ry\", \"rz\"]"] {
        agree_by_job(
            &block,
            &format!(
                "interface = [{{ name = \"i\", nodes = {nodes:?}, coupling = \"average\", dofs = {dofs} }}]\n\
                 reduction = {{ method = \"rubin\", modes = {{ count = 3 }} }}"
            ),
        );
    }
}

/// Two bodies of one patch have more motions than coordinates tell: Rubin's modes come from the matrices there, and so does what verification
/// knows of them.
#[test]
fn two_bodies_of_one_mean_agree() {
    let block = brick([2, 1, 1], [0.2, 0.1, 0.1], &Material::STEEL_SI);
    let two = join(&block, &translated(&block, [0.4, 0.0, 0.0]), &[]);
    let n = block.labels.len() as i64;
    let nodes = [1, 2, 4, n + 1, n + 5, n + 9];
    agree_by_job(
        &two,
        &format!(
            "interface = [{{ name = \"i\", nodes = {nodes:?}, coupling = \"average\", dofs = [\"ux\", \"uy\", \"uz\"] }}]\n\
             reduction = {{ method = \"rubin\", modes = {{ count = 3 }} }}"
        ),
    );
}
