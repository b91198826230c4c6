//! Coordinates and dof maps that do not belong to K: none of them may end as verified, whatever ties the interface.
//!
//! [`faults`] changes one thing of a sound model; [`table`] reduces the result with every coupling and method. What no
//! program can see from K, M, dof map and coordinates stands there too, and in `docs/what-the-report-proves.md`.

mod cells;
mod directions;
mod displaced;
mod faults;
mod frames;
mod mass;
mod patches;
mod planes;
mod soft;
mod sound;
mod table;
mod thin;
mod told;

use supel::error::Result;
use supel::model::Model;
use supel::partition::TiedNodes;
use supel_testing::{chain, place};

/// The nodes that rigid patches tie.
#[derive(Clone, Copy)]
enum Ties {
    All,
    None,
}

/// A model whose coordinates were compared with its stiffness.
fn compared(model: Model, ties: Ties) -> Result<Model> {
    let labels = || model.dofs.iter().flatten().flatten().map(|dof| dof.node);
    let tied = match ties {
        Ties::All => TiedNodes { rigid: labels().collect(), ..TiedNodes::default() },
        Ties::None => TiedNodes::default(),
    };
    supel::coordinates::compared(model, (&[], supel::job::Mechanisms::default()), &tied)
}
