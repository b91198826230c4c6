//! What findings say, one sentence each.

use crate::dofs::Direction;
use crate::number::{counted, quantity};

/// Times the median diagonal entry of K above which a row is held or tied by a penalty, whatever it costs: rotations of thick parts in
/// millimetres and soft joints come to 10⁸ of each other. Smaller ones are named by the digits they take, once there are modes.
pub(super) const PENALTY: f64 = 1e10;

/// Share of their terms up to which forces may be the rounding of a matrix of six digits and more.
const LIKE_ROUNDING: f64 = 1e-5;

pub(super) fn constrained([n_rows, n_dependent]: [usize; 2], largest: f64, redundant: &[usize], empty: u64) -> String {
    /// Constraints that a message names.
    const SHOWN: usize = 12;
    let of_dofs = match largest {
        0.0 => counted(n_dependent, "dof is held at rest", "dofs are held at rest"),
        _ => {
            let follow = counted(n_dependent, "dof follows others", "dofs follow others");
            format!("{follow} by factors of {} at most", quantity(largest, 3))
        }
    };
    let mut text = format!("{}, {of_dofs}", counted(n_rows, "constraint", "constraints"));
    if !redundant.is_empty() {
        let rows: Vec<String> = redundant.iter().take(SHOWN).map(ToString::to_string).collect();
        let more = redundant.len().saturating_sub(SHOWN);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        text += &format!("; left out because they follow from others: rows {}{more}", rows.join(", "));
    }
    if empty > 0 {
        text += &format!("; {} no terms", counted(empty, "row has", "rows have"));
    }
    text
}

pub(super) fn to_ground(row: usize, dofs: &str, motion: &str, n_rows: usize) -> String {
    format!(
        "{} to the ground, most of all row {row} ({dofs}), which resists the {motion} of the component: the job accepts that",
        counted(n_rows, "constraint holds the component", "constraints hold the component")
    )
}

pub(super) fn stiff_rows(n_rows: usize, first: &str, ratio: f64) -> String {
    format!(
        "{} a stiffness of {PENALTY:.0e} times the median and more, at most {ratio:.0e} times at {first}: penalties that hold or tie \
         dofs; they take digits from what they touch, leave held dofs out of both matrices",
        counted(n_rows, "row has", "rows have")
    )
}

pub(super) fn frame_digits(file: &str, [node, line]: [i64; 2], decimals: i32) -> String {
    format!(
        "{file}:{line}: the axes of node {node} are given to {decimals} decimals, which leave an angle of up to {:.0e} rad between the rows and \
         the axes of the model: no frequency depends on it, but what stands along axes at such nodes does; write the axes with all \
         their digits",
        10f64.powi(-decimals)
    )
}

pub(super) fn patch_nodes_untested([n_nodes, n_tied]: [usize; 2], at: &str) -> String {
    format!(
        "supports, or axes that no frame declares, make forces around {n_nodes} of {} that patches tie, so that the stiffness does not confirm their \
         coordinates and axes: nodes {at}; check that rows, map and coordinates are in one order there, and the axes",
        counted(n_tied, "node", "nodes")
    )
}

pub(super) fn coordinates_untested(n_touched: usize, n_rows: usize, largest: f64) -> String {
    let rounding = if largest <= LIKE_ROUNDING {
        format!(
            "; the forces are {largest:.0e} of their terms at most, as rounding leaves of a K that has fewer digits than its \
             numbers show: state `stiffness_digits` then"
        )
    } else {
        String::new()
    };
    format!(
        "translations make forces at the nodes of {n_touched} of {}: supports that touch so many leave too few to compare the \
         coordinates and the dof map with; check that rows and map are in one order{rounding}",
        counted(n_rows, "row", "rows")
    )
}

pub(super) fn mass_by_direction(n_nodes: usize, at: &str) -> String {
    format!(
        "{} another mass in one direction than in another, listed from the first: {at}; check that they have no local frames, which \
         in a held component look like supports, and that M has its rows in the order of K",
        counted(n_nodes, "node has", "nodes have")
    )
}

pub(super) fn held_by_diagonal(n_rows: usize) -> String {
    let rows = counted(n_rows, "row is", "rows are");
    format!("{rows} held by a diagonal entry of K alone, without mass, as a program writes boundary conditions")
}

pub(super) fn free_particles(n_rows: usize, first: &str) -> String {
    let rows = counted(n_rows, "row has", "rows have");
    format!("{rows} mass and no stiffness, the first is {first}: free particles")
}

pub(super) fn couples_others([n_apart, n_nodes]: [usize; 2], at: &str) -> String {
    format!(
        "the mass couples {n_apart} of {n_nodes} nodes with other nodes than the stiffness does, first at {at}: check that the \
         rows of both matrices are in one order"
    )
}

pub(super) fn direction_of_others(what: &str, [n_strayed, n_nodes]: [usize; 2], at: &str) -> String {
    format!(
        "at {n_strayed} of {n_nodes} nodes the {what} couples a direction with the neighbours of another node, and all other directions with \
         its own: {at}; check the dof map, and that the rows of each direction are in the order of the nodes"
    )
}

pub(super) fn cells_of_others([n_strayed, n_nodes]: [usize; 2], at: &str) -> String {
    format!(
        "the stiffness couples {n_strayed} of {n_nodes} nodes as the cells of the mesh do others, first nodes {at}: check that dof map \
         and mesh are those of the matrices"
    )
}

pub(super) fn origin_far(interface: &str, origin: [f64; 3], ratio: f64) -> String {
    format!(
        "the origin ({}) of interface {interface:?} is {} times the size of the part away from its nodes: check its unit; digits are \
         lost on so long a lever",
        origin.map(|x| quantity(x, 6)).join(", "),
        quantity(ratio, 2)
    )
}

pub(super) fn patch_over_bodies(interface: &str, n_bodies: usize) -> String {
    format!(
        "interface {interface:?} ties {n_bodies} bodies that the stiffness does not connect: where they lie to each other is taken from the \
         coordinates, and nothing confirms it"
    )
}

pub(super) fn mass_far(interface: &str, centre: [f64; 3], [distance, loss]: [f64; 2]) -> String {
    format!(
        "the mass at interface {interface:?} is centred {} away from its node: {} digits of its inertia are lost on that lever; set \
         origin = [{}] of the interface to keep them",
        quantity(distance, 4),
        loss.log10().round(),
        centre.map(|x| quantity(x, 8)).join(", ")
    )
}

pub(super) fn little_resistance((row, dofs): (usize, &str), motion: &str, n_rows: usize, share: f64) -> String {
    format!(
        "{} rigid-body motion, most of all row {row} ({dofs}) the {motion}, by {share:.0e} of the displacements that it compares, and the \
         digits of its factors do not explain it: coordinates have few digits, or nodes are that far apart; the component is held by as much, \
         or its parts move against each other by as much in motions that cost nothing, so that rigid-body motions may be told as soft or as \
         motions inside, and checks of them may fail by it; write factors and coordinates with all their digits, and ties of nodes that are \
         apart with their levers",
        counted(n_rows, "constraint resists", "constraints resist")
    )
}

pub(super) fn set_right((row, dofs): (usize, &str), motion: &str, n_rows: usize, [share, change]: [f64; 2]) -> String {
    format!(
        "{} rigid-body motion by what their few digits leave, most of all row {row} ({dofs}) the {motion}, by {share:.0e} of the \
         displacements that it compares: factors were set right within their digits, there by up to {change:.0e} of the largest, and let it \
         pass; the error bars of frequencies do not count what the digits of constraints leave open; write them with all their digits",
        counted(n_rows, "constraint resisted", "constraints resisted")
    )
}

pub(super) fn rotations_free(rotations: &[Direction]) -> String {
    format!("model.held_rotations lists {}, which the stiffness lets pass: nothing holds it", listed(rotations))
}

pub(super) fn constrained_interface(interface: &str, node: i64, lacks: &[Direction]) -> String {
    format!(
        "node {node} of interface {interface:?} has no {}, as other nodes have: it is held there, and the interface does without",
        listed(lacks)
    )
}

fn listed(directions: &[Direction]) -> String {
    directions.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
