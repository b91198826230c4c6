//! What another program computed, held against K and M: eigenpairs, and superelements with their basis.
//!
//! ```text
//! x_j, λ_j     the pairs of a result: shapes on the dofs of the partition with x_jᵀMx_j = 1, and what the result says of their frequencies
//! ρ_j          x_jᵀKx_j, the eigenvalue that belongs to the shape
//! r_j          K x_j − ρ_j M x_j
//! δ_j²         r_jᵀ(K − σM)⁻¹r_j / (ρ_j − σ), σ below the spectrum: some θ = 1/(λ − σ) lies within the share δ_j of 1/(ρ_j − σ)
//! ```
//! The bound holds for any vector (Weinstein 1934, in the norm of K − σM), so that a small δ_j says that an eigenvalue is there. How many
//! there are in the band is counted by inertia, and as many independent vectors with small δ_j as there are eigenvalues leave none
//! out. Where they are fewer, the interval is cut by further counts until it is known where they are missing, and the own eigensolver
//! finds them there. What of the result is no mode is compared with all that are.

mod angles;
mod band;
mod carrier;
mod certified;
mod checks;
mod claims;
mod independence;
mod judgement;
mod lacking;
mod listing;
mod measured;
mod orientation;
mod pair;
mod result_files;
mod rounding;
mod rows;
mod strayed;
mod superelement;
mod truth;
mod turned;
mod unit;

pub use band::Band;
pub use certified::{BandCount, Certification, certified_pairs};
pub use claims::{Claims, PairFiles};
pub use orientation::right_way_round;
pub use pair::{JudgedPair, MissingMode, Off, PairKind};
pub use result_files::ResultFiles;
pub use rows::mode_rows;
pub use superelement::{
    Foreign, ForeignSuperelement, FreeComparison, Interface, LeftOut, Own, Placed, ReducedCertification, ReducedFiles,
    ReducedMatrix, compared_free, interface, left_out, preserved,
};
