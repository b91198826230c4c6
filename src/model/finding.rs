//! What the checks of a model found that is not an error: remarks and warnings, one sentence each.

use crate::dofs::{AxisDigits, Direction, RoundedAxes, RowNames};
use crate::number::{counted, quantity};
use crate::sparse::Rounding;

/// Above this share of the largest entry in asymmetry a finding becomes a warning; below it the asymmetry is rounding of the producer.
pub const ASYMMETRY_WARN: f64 = 1e-12;
/// Asymmetry relative to the two rows of an entry from which it is a warning: condensed rows have the rounding of stiffer ones.
const ASYMMETRY_OF_ROWS_WARN: f64 = 1e-9;
/// Times the median diagonal entry of K above which a row is held or tied by a penalty, whatever it costs: rotations of thick parts in
/// millimetres and soft joints come to 10⁸ of each other. Smaller ones are named by the digits they take, once there are modes.
pub(super) const PENALTY: f64 = 1e10;

/// Share of their terms up to which forces may be the rounding of a matrix of six digits and more.
const LIKE_ROUNDING: f64 = 1e-5;

/// Something the checks found that is not an error.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// K or M was symmetric to rounding only and was replaced by its symmetric part.
    Symmetrised {
        /// `stiffness` or `mass`.
        matrix: &'static str,
        /// max |A − Aᵀ| / max |A|.
        of_largest: f64,
        /// The largest |A_ij − A_ji| / √(A_ii A_jj).
        of_rows: f64,
    },
    /// Rows without mass: their frequencies are infinite and are never returned.
    MasslessRows {
        /// How many.
        n_rows: usize,
    },
    /// Rows of K that have nothing but a diagonal entry, and no mass: a program has held them so, and they stay at rest.
    HeldByDiagonal {
        /// How many.
        n_rows: usize,
    },
    /// Rows without stiffness that carry mass: free particles, each a zero mode.
    FreeParticles {
        /// Their numbers, from zero.
        rows: Vec<usize>,
        /// What the first of them is called.
        first: String,
    },
    /// Nodes that M couples with other nodes than K does.
    MassCouplesOthers {
        /// How many.
        n_apart: usize,
        /// Of how many.
        n_nodes: usize,
        /// The first three of them.
        at: String,
    },
    /// Rows held by a stiffness far beyond that of the structure.
    Penalties {
        /// How many.
        n_rows: usize,
        /// The stiffest.
        first: String,
        /// Its diagonal entry, as multiple of the median.
        ratio: f64,
    },
    /// Diagonal entries of M that are negative by rounding only.
    NegativeMassByRounding {
        /// How many.
        n_rows: usize,
    },
    /// An interface node that lacks a direction which most nodes have.
    ConstrainedInterface {
        /// The interface.
        interface: String,
        /// The node.
        node: i64,
        /// The directions it lacks.
        lacks: Vec<Direction>,
    },
    /// Axes of nodes that were given to few digits, which the error bars hold.
    FrameDigits {
        /// The table.
        file: String,
        /// The node with the fewest, and its line.
        node: i64,
        /// Line, from 1.
        line: u64,
        /// Their decimals.
        decimals: i32,
    },
    /// Supports touch nearly all rows, so that the others cannot confirm the coordinates.
    CoordinatesUntested {
        /// Rows that supports touch.
        n_touched: usize,
        /// Rows of the bodies that supports touch.
        n_rows: usize,
        /// The largest of these forces, relative to the terms that it is the sum of.
        largest: f64,
    },
    /// The motions without energy of a held model cannot be counted, so that nothing confirms the coordinates at its supports.
    MotionsUncounted,
    /// Nodes of a held body that have another mass in one direction than in another.
    MassByDirection {
        /// How many.
        n_nodes: usize,
        /// Some of them.
        at: String,
    },
    /// Rotations that the job says to be held and that K lets pass.
    RotationsFree {
        /// The rotations, `rx` to `rz`.
        rotations: Vec<Direction>,
    },
    /// A rigid patch whose origin is far outside of the part.
    OriginFar {
        /// The interface.
        interface: String,
        /// Its origin.
        origin: [f64; 3],
        /// Its distance from the mean of the patch over the size of the part.
        ratio: f64,
    },
    /// A patch whose mass is far from its node.
    MassFar {
        /// The interface.
        interface: String,
        /// The centre of the mass.
        centre: [f64; 3],
        /// Its distance from the node.
        distance: f64,
        /// How many times larger the terms of the smallest inertia are than what is left of them.
        loss: f64,
    },
    /// Constraints that were eliminated.
    Constrained {
        /// How many have terms.
        n_rows: usize,
        /// How many dofs follow others.
        n_dependent: usize,
        /// The largest factor by which one does, rotations in the scale of displacements.
        largest: f64,
        /// Those that follow from others, by their rows in the file, from one.
        redundant: Vec<usize>,
        /// Rows of the file without terms.
        empty: u64,
    },
    /// Constraints that hold the component to the ground, as the job accepts.
    ConstraintGround {
        /// The one that does so most, from one.
        row: usize,
        /// Its dofs.
        dofs: String,
        /// The rigid-body motion that it resists.
        motion: &'static str,
        /// How many resist some.
        n_rows: usize,
    },
    /// Constraints of few digits that resist a rigid-body motion a little.
    ConstraintRounded {
        /// The one that does so most, from one.
        row: usize,
        /// Its dofs.
        dofs: String,
        /// The rigid-body motion that it resists.
        motion: &'static str,
        /// How many resist some.
        n_rows: usize,
        /// By how much of the displacements that it compares.
        share: f64,
    },
    /// Interface dofs with mass and no stiffness.
    HangingInterface {
        /// What the first is called.
        dof: String,
        /// How many.
        n_dofs: usize,
    },
}

impl Finding {
    /// Rows that are free particles, where there are any.
    pub fn free_particles(rows: Vec<usize>, names: RowNames<'_>) -> Option<Self> {
        let first = names.full(*rows.first()?);
        Some(Self::FreeParticles { rows, first })
    }

    /// Axes of nodes that have few digits, though enough, where there are some.
    pub(super) fn frame_digits(axes: &RoundedAxes) -> Option<Self> {
        let (node, AxisDigits { line, decimals }) = axes.coarsest_of_enough()?;
        let file = axes.path.file_name().unwrap_or(axes.path.as_os_str()).to_string_lossy().into_owned();
        Some(Self::FrameDigits { file, node, line, decimals })
    }

    /// How many rows it says to be free particles.
    pub fn n_free_particles(&self) -> usize {
        match self {
            Self::FreeParticles { rows, .. } => rows.len(),
            _ => 0,
        }
    }

    /// How well entries are known by this finding: each of two triangles that differ may be the right one.
    pub(super) fn known_by(&self, rounding: Rounding) -> Rounding {
        match self {
            Self::Symmetrised { of_rows, .. } if self.warning().is_some() => rounding.of_parts(0.5 * of_rows),
            _ => rounding,
        }
    }

    /// The code of the warning that a finding is, or nothing where it is a remark.
    pub fn warning(&self) -> Option<&'static str> {
        match self {
            Self::Symmetrised { of_largest, of_rows, .. } => {
                (*of_largest > ASYMMETRY_WARN || *of_rows > ASYMMETRY_OF_ROWS_WARN).then_some("W-UNSYMMETRIC")
            }
            Self::MasslessRows { .. } | Self::HeldByDiagonal { .. } | Self::Constrained { .. } => None,
            Self::FreeParticles { .. } => Some("W-FREE-PARTICLE"),
            Self::MassCouplesOthers { .. } => Some("W-MASS-ORDER"),
            Self::Penalties { .. } => Some("W-PENALTY"),
            Self::NegativeMassByRounding { .. } => Some("W-NEGATIVE-MASS"),
            Self::ConstrainedInterface { .. } => Some("W-CONSTRAINED-INTERFACE"),
            Self::CoordinatesUntested { .. } | Self::MotionsUncounted => Some("W-COORD-UNTESTED"),
            Self::MassByDirection { .. } => Some("W-MASS-DIRECTION"),
            Self::RotationsFree { .. } => Some("W-NOT-HELD"),
            Self::FrameDigits { .. } => Some("W-FRAME-DIGITS"),
            Self::OriginFar { .. } => Some("W-ORIGIN-FAR"),
            Self::MassFar { .. } => Some("W-MASS-FAR"),
            Self::ConstraintGround { .. } => Some("W-CONSTRAINT-GROUND"),
            Self::ConstraintRounded { .. } => Some("W-CONSTRAINT-ROUNDED"),
            Self::HangingInterface { .. } => Some("W-HANGING"),
        }
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Symmetrised { matrix, of_rows, .. } => {
                write!(
                    f,
                    "the {matrix} matrix was symmetric to {of_rows:.1e} of its rows only and was replaced by its symmetric part"
                )
            }
            Self::MasslessRows { n_rows } => write!(f, "{} no mass: their frequencies are infinite", counted(*n_rows, "row has", "rows have")),
            Self::HeldByDiagonal { n_rows } => f.write_str(&held_by_diagonal(*n_rows)),
            Self::FreeParticles { rows, first } => f.write_str(&free_particles(rows.len(), first)),
            Self::MassCouplesOthers { n_apart, n_nodes, at } => {
                f.write_str(&couples_others([*n_apart, *n_nodes], at))
            }
            Self::Penalties { n_rows, first, ratio } => f.write_str(&stiff_rows(*n_rows, first, *ratio)),
            Self::NegativeMassByRounding { n_rows } => {
                let entries = counted(*n_rows, "diagonal entry of the mass is", "diagonal entries of the mass are");
                write!(f, "{entries} negative by rounding; zero was put there")
            }
            Self::ConstrainedInterface { interface, node, lacks } => {
                let lacks: Vec<String> = lacks.iter().map(ToString::to_string).collect();
                write!(
                    f,
                    "node {node} of interface {interface:?} has no {}, as other nodes have: it is held there, and the \
                     interface does without",
                    lacks.join(", ")
                )
            }
            Self::CoordinatesUntested { n_touched, n_rows, largest } => {
                f.write_str(&coordinates_untested(*n_touched, *n_rows, *largest))
            }
            Self::FrameDigits { file, node, line, decimals } => f.write_str(&frame_digits(file, [*node, *line as i64], *decimals)),
            Self::MotionsUncounted => f.write_str(
                "K is too badly conditioned to count its motions without energy: nothing confirms the coordinates where supports are; \
                 check that rows and map are in one order",
            ),
            Self::MassByDirection { n_nodes, at } => f.write_str(&mass_by_direction(*n_nodes, at)),
            Self::RotationsFree { rotations } => {
                let rotations: Vec<String> = rotations.iter().map(ToString::to_string).collect();
                write!(
                    f,
                    "model.held_rotations lists {}, which the stiffness lets pass: nothing holds it",
                    rotations.join(", ")
                )
            }
            Self::OriginFar { interface, origin, ratio } => f.write_str(&origin_far(interface, *origin, *ratio)),
            Self::MassFar { interface, centre, distance, loss } => {
                f.write_str(&mass_far(interface, *centre, [*distance, *loss]))
            }
            Self::Constrained { n_rows, n_dependent, largest, redundant, empty } => {
                f.write_str(&constrained([*n_rows, *n_dependent], *largest, redundant, *empty))
            }
            Self::ConstraintGround { row, dofs, motion, n_rows } => {
                f.write_str(&to_ground(*row, dofs, motion, *n_rows))
            }
            Self::ConstraintRounded { row, dofs, motion, n_rows, share } => {
                let rows = counted(*n_rows, "constraint resists", "constraints resist");
                write!(
                    f,
                    "{rows} rigid-body motion, most of all row {row} ({dofs}) the {motion}, by {share:.0e} of the displacements that it \
                     compares: its factors or the coordinates have few digits, and the component is held by as much; write them with all \
                     their digits"
                )
            }
            Self::HangingInterface { dof, n_dofs } => {
                let dofs = counted(*n_dofs, "interface dof has", "interface dofs have");
                write!(f, "{dofs} mass and no stiffness, the first is {dof}: they move freely")
            }
        }
    }
}

fn constrained([n_rows, n_dependent]: [usize; 2], largest: f64, redundant: &[usize], empty: u64) -> String {
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

fn to_ground(row: usize, dofs: &str, motion: &str, n_rows: usize) -> String {
    format!(
        "{} to the ground, most of all row {row} ({dofs}), which resists the {motion} of the component: the job accepts that",
        counted(n_rows, "constraint holds the component", "constraints hold the component")
    )
}

fn stiff_rows(n_rows: usize, first: &str, ratio: f64) -> String {
    format!(
        "{} a stiffness of {PENALTY:.0e} times the median and more, at most {ratio:.0e} times at {first}: penalties that hold or tie \
         dofs; they take digits from what they touch, leave held dofs out of both matrices",
        counted(n_rows, "row has", "rows have")
    )
}

fn frame_digits(file: &str, [node, line]: [i64; 2], decimals: i32) -> String {
    format!(
        "{file}:{line}: the axes of node {node} are given to {decimals} decimals, which leave an angle of up to {:.0e} rad between the rows and \
         the axes of the model: no frequency depends on it, but what stands along axes at such nodes does; write the axes with all \
         their digits",
        10f64.powi(-decimals)
    )
}

fn coordinates_untested(n_touched: usize, n_rows: usize, largest: f64) -> String {
    let rounding = if largest <= LIKE_ROUNDING {
        format!(
            "; the forces are {largest:.0e} of their terms at most, as rounding leaves of a K that has fewer digits than its \
             numbers show: state `stiffness_digits` then"
        )
    } else {
        String::new()
    };
    format!(
        "translations make forces at {n_touched} of {}: supports that touch so many rows leave too few to compare the \
         coordinates and the dof map with; check that rows and map are in one order{rounding}",
        counted(n_rows, "row", "rows")
    )
}

fn mass_by_direction(n_nodes: usize, at: &str) -> String {
    format!(
        "{} another mass in one direction than in another, listed from the first: {at}; check that they have no local frames, which \
         in a held component look like supports, and that M has its rows in the order of K",
        counted(n_nodes, "node has", "nodes have")
    )
}

fn held_by_diagonal(n_rows: usize) -> String {
    let rows = counted(n_rows, "row is", "rows are");
    format!("{rows} held by a diagonal entry of K alone, without mass, as a program writes boundary conditions")
}

fn free_particles(n_rows: usize, first: &str) -> String {
    let rows = counted(n_rows, "row has", "rows have");
    format!("{rows} mass and no stiffness, the first is {first}: free particles")
}

fn couples_others([n_apart, n_nodes]: [usize; 2], at: &str) -> String {
    format!(
        "the mass couples {n_apart} of {n_nodes} nodes with other nodes than the stiffness does, first at {at}: check that the \
         rows of both matrices are in one order"
    )
}

fn origin_far(interface: &str, origin: [f64; 3], ratio: f64) -> String {
    format!(
        "the origin ({}) of interface {interface:?} is {} times the size of the part away from its nodes: check its unit; digits are \
         lost on so long a lever",
        origin.map(|x| quantity(x, 6)).join(", "),
        quantity(ratio, 2)
    )
}

fn mass_far(interface: &str, centre: [f64; 3], [distance, loss]: [f64; 2]) -> String {
    format!(
        "the mass at interface {interface:?} is centred {} away from its node: {} digits of its inertia are lost on that lever; set \
         origin = [{}] of the interface to keep them",
        quantity(distance, 4),
        loss.log10().round(),
        centre.map(|x| quantity(x, 8)).join(", ")
    )
}
