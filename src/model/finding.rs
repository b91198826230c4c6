//! What the checks of a model found that is not an error: remarks and warnings, one sentence each.

use super::finding_words as words;
use crate::dofs::{AxisDigits, Direction, RoundedAxes, RowNames};
use crate::number::counted;
use crate::sparse::{Differing, Rounding};

/// Above this share of the largest entry in asymmetry a finding becomes a warning; below it the asymmetry is rounding of the producer.
pub const ASYMMETRY_WARN: f64 = 1e-12;
/// Asymmetry relative to the two rows of an entry from which it is a warning: condensed rows have the rounding of stiffer ones.
const ASYMMETRY_OF_ROWS_WARN: f64 = 1e-9;
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
        /// |A_ij − A_ji| of this one.
        difference: f64,
        /// Its row and column in the file, from one.
        at: [usize; 2],
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
    /// Nodes of patches around which supports, or axes that nobody declared, leave nothing that confirms where they are.
    PatchNodesUntested {
        /// How many.
        n_nodes: usize,
        /// Nodes of patches altogether.
        n_tied: usize,
        /// Some of them.
        at: String,
    },
    /// A patch ties bodies that the stiffness does not connect.
    PatchOverBodies {
        /// Its interface.
        interface: String,
        /// How many bodies it ties.
        n_bodies: usize,
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
    /// Rows of one direction, or of all rotations, that are coupled as those of other nodes are.
    DirectionOfOthers {
        /// The matrix.
        what: &'static str,
        /// At how many nodes.
        n_strayed: usize,
        /// Nodes of the model.
        n_nodes: usize,
        /// Some of these rows.
        at: String,
    },
    /// Nodes that K couples with the neighbours that another node has by the cells of the mesh.
    CellsOfOthers {
        /// How many.
        n_strayed: usize,
        /// Nodes of cells.
        n_nodes: usize,
        /// The labels of some of them.
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
    /// Constraints of few digits that were set right within these.
    ConstraintMended {
        /// The one that resisted a motion most, from one.
        row: usize,
        /// Its dofs.
        dofs: String,
        /// The rigid-body motion that it resisted.
        motion: &'static str,
        /// How many were set right.
        n_rows: usize,
        /// By how much of the displacements that it compares it resisted.
        share: f64,
        /// By how much of its largest factor another was changed at most.
        change: f64,
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
            Self::Symmetrised { of_rows, difference, at, .. } if self.warning().is_some() => {
                // Two roundings of one number are no more than a unit of its last digit apart.
                let is_of_digits = *of_rows <= 2.0 * rounding.relative || *difference <= 2.0 * rounding.absolute;
                let differing = Differing { of_rows: *of_rows, at: *at };
                if is_of_digits { rounding.of_parts(0.5 * of_rows) } else { rounding.of_differing(differing) }
            }
            _ => rounding,
        }
    }

    /// At how many nodes of patches, or rows, coordinates are not confirmed; one where that is said of the model as a whole.
    pub fn n_untested(&self) -> usize {
        match self {
            Self::CoordinatesUntested { n_touched, .. } => *n_touched,
            Self::PatchNodesUntested { n_nodes, .. } => *n_nodes,
            Self::MotionsUncounted => 1,
            _ => 0,
        }
    }

    /// The code of the warning that a finding is, or nothing where it is a remark.
    pub fn warning(&self) -> Option<&'static str> {
        match self {
            Self::Symmetrised { of_largest, of_rows, .. } => {
                (*of_largest > ASYMMETRY_WARN || *of_rows > ASYMMETRY_OF_ROWS_WARN).then_some("W-UNSYMMETRIC")
            }
            Self::MasslessRows { .. }
            | Self::HeldByDiagonal { .. }
            | Self::Constrained { .. }
            | Self::PatchOverBodies { .. } => None,
            Self::FreeParticles { .. } => Some("W-FREE-PARTICLE"),
            Self::MassCouplesOthers { .. } => Some("W-MASS-ORDER"),
            Self::Penalties { .. } => Some("W-PENALTY"),
            Self::NegativeMassByRounding { .. } => Some("W-NEGATIVE-MASS"),
            Self::ConstrainedInterface { .. } => Some("W-CONSTRAINED-INTERFACE"),
            Self::CoordinatesUntested { .. } | Self::PatchNodesUntested { .. } | Self::MotionsUncounted => {
                Some("W-COORD-UNTESTED")
            }
            Self::MassByDirection { .. } => Some("W-MASS-DIRECTION"),
            Self::DirectionOfOthers { .. } => Some("W-DIRECTION-ORDER"),
            Self::CellsOfOthers { .. } => Some("W-CELL-ORDER"),
            Self::RotationsFree { .. } => Some("W-NOT-HELD"),
            Self::FrameDigits { .. } => Some("W-FRAME-DIGITS"),
            Self::OriginFar { .. } => Some("W-ORIGIN-FAR"),
            Self::MassFar { .. } => Some("W-MASS-FAR"),
            Self::ConstraintGround { .. } => Some("W-CONSTRAINT-GROUND"),
            Self::ConstraintRounded { .. } | Self::ConstraintMended { .. } => Some("W-CONSTRAINT-ROUNDED"),
            Self::HangingInterface { .. } => Some("W-HANGING"),
        }
    }
}

impl std::fmt::Display for Finding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Symmetrised { matrix, of_rows, at: [row, col], .. } => {
                write!(
                    f,
                    "the {matrix} matrix was symmetric to {of_rows:.1e} of its rows only, at row {row}, column {col}, and was replaced by its \
                     symmetric part"
                )
            }
            Self::MasslessRows { n_rows } => write!(f, "{} no mass: their frequencies are infinite", counted(*n_rows, "row has", "rows have")),
            Self::HeldByDiagonal { n_rows } => f.write_str(&words::held_by_diagonal(*n_rows)),
            Self::FreeParticles { rows, first } => f.write_str(&words::free_particles(rows.len(), first)),
            Self::MassCouplesOthers { n_apart, n_nodes, at } => {
                f.write_str(&words::couples_others([*n_apart, *n_nodes], at))
            }
            Self::Penalties { n_rows, first, ratio } => f.write_str(&words::stiff_rows(*n_rows, first, *ratio)),
            Self::NegativeMassByRounding { n_rows } => {
                let entries = counted(*n_rows, "diagonal entry of the mass is", "diagonal entries of the mass are");
                write!(f, "{entries} negative by rounding; zero was put there")
            }
            Self::ConstrainedInterface { interface, node, lacks } => {
                f.write_str(&words::constrained_interface(interface, *node, lacks))
            }
            Self::CoordinatesUntested { n_touched, n_rows, largest } => {
                f.write_str(&words::coordinates_untested(*n_touched, *n_rows, *largest))
            }
            Self::PatchNodesUntested { n_nodes, n_tied, at } => f.write_str(&words::patch_nodes_untested([*n_nodes, *n_tied], at)),
            Self::PatchOverBodies { interface, n_bodies } => f.write_str(&words::patch_over_bodies(interface, *n_bodies)),
            Self::FrameDigits { file, node, line, decimals } => f.write_str(&words::frame_digits(file, [*node, *line as i64], *decimals)),
            Self::MotionsUncounted => f.write_str(
                "the motions without energy of K cannot be counted, for it is badly conditioned or has mechanisms of its own: nothing \
                 confirms the coordinates where supports are; check that rows and map are in one order",
            ),
            Self::DirectionOfOthers { what, n_strayed, n_nodes, at } => {
                f.write_str(&words::direction_of_others(what, [*n_strayed, *n_nodes], at))
            }
            Self::CellsOfOthers { n_strayed: n, n_nodes, at } => f.write_str(&words::cells_of_others([*n, *n_nodes], at)),
            Self::MassByDirection { n_nodes, at } => f.write_str(&words::mass_by_direction(*n_nodes, at)),
            Self::RotationsFree { rotations } => f.write_str(&words::rotations_free(rotations)),
            Self::OriginFar { interface, origin, ratio } => f.write_str(&words::origin_far(interface, *origin, *ratio)),
            Self::MassFar { interface, centre, distance, loss } => {
                f.write_str(&words::mass_far(interface, *centre, [*distance, *loss]))
            }
            Self::Constrained { n_rows, n_dependent, largest, redundant, empty } => {
                f.write_str(&words::constrained([*n_rows, *n_dependent], *largest, redundant, *empty))
            }
            Self::ConstraintGround { row, dofs, motion, n_rows } => {
                f.write_str(&words::to_ground(*row, dofs, motion, *n_rows))
            }
            Self::ConstraintRounded { row, dofs, motion, n_rows, share } => {
                f.write_str(&words::little_resistance((*row, dofs), motion, *n_rows, *share))
            }
            Self::ConstraintMended { row, dofs, motion, n_rows, share, change } => {
                f.write_str(&words::set_right((*row, dofs), motion, *n_rows, [*share, *change]))
            }
            Self::HangingInterface { dof, n_dofs } => {
                let dofs = counted(*n_dofs, "interface dof has", "interface dofs have");
                write!(f, "{dofs} mass and no stiffness, the first is {dof}: they move freely")
            }
        }
    }
}
