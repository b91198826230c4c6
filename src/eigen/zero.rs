//! When a motion costs no energy: the one criterion of rigid-body modes from the matrices, of mechanisms and of M-12.
//!
//! ```text
//! λ = xᵀKx / xᵀMx          Rayleigh quotient of the motion
//! N_d                      what rounding of the digits of K can make of it
//! N_a = ε |x|ᵀ|K||x|       what rounding of one ulp in every entry can make of it, all with one sign
//! N_f = ε ‖DKD‖ ‖D⁻¹x‖²    that rounding from the norm of K instead of its entries, D = diag(1/√K_ii)
//! zero:  |λ| ≤ ¾ N_d + 10 (N_a + N_f)         all over xᵀMx
//! ```
//! A motion is zero where its energy cannot be told from none, and only there. Its own error bar decides, never a share of the
//! largest eigenvalue, which a thin plate has 10⁹ times above its softest mode.
//!
//! N_d is the bound of M-09, which refuses a mode that is known to half of its frequency: λ ≤ N_d. So nothing that has a known
//! frequency is zero, and what lies between ¾ N_d and N_d, where neither is certain, is kept as a mode and refused for its digits. A
//! motion without energy comes to ¾ N_d with a chance below 3·10⁻⁷, by the tail that N_d is taken from.
//!
//! The program that made K in double precision left some roundings in each entry. Where entries are differences of larger numbers, as
//! in a matrix that was itself projected, the roundings are relative to the norm of K and not to the entries: that is N_f.
//!
//! Where it left more than that, a motion below zero shows how much, and the levels of all are [`raised`] by it.

/// Share of N_d up to which a motion is zero.
const SHARE_OF_BOUND: f64 = 0.75;
/// Roundings in an entry of K by the program that wrote it: element integration and assembly.
const ROUNDINGS_OF_THE_PRODUCER: f64 = 10.0;
/// Share of the first elastic eigenvalue that a negative one may have: by practice a component is free whose rigid-body frequencies
/// stay below a ten-thousandth of the first elastic one, and what is below zero by no more is rounding of the program that wrote K.
const NEGLIGIBLE: f64 = 1e-8;

/// Energies below zero up to this many ε times their terms are roundings of the program that wrote K in double precision: a projection
/// leaves thousands of roundings that its own terms do not show, and so does a text of three or four digits less than doubles have. Rounding to
/// fewer digits afterwards adds its bar to that and no more.
pub(crate) const LEFT_BY_THE_PRODUCER: f64 = 1e4;

/// Eigenvalues up to this multiple of one that is rounding are rounding of the same size, and what their modes are is left to
/// it: each may carry as much as any other.
const ALIKE: f64 = 10.0;

/// λ up to which a motion is zero, from N_d, N_a and N_f over its modal mass.
pub(crate) fn level(digits: f64, arithmetic: f64, floor: f64) -> f64 {
    SHARE_OF_BOUND * digits + ROUNDINGS_OF_THE_PRODUCER * (arithmetic + floor)
}

/// Of each of some motions the largest of what rounding leaves of those with eigenvalues up to [`ALIKE`] times its own.
pub(crate) fn of_alike(lambda: &[f64], rounding: &[f64]) -> Vec<f64> {
    let pairs = || lambda.iter().zip(rounding);
    let largest = |(lambda, own): (&f64, &f64)| {
        let alike = pairs().filter(|(other, _)| other.abs() <= ALIKE * lambda.abs());
        alike.fold(*own, |max, (_, rounding)| max.max(*rounding))
    };
    pairs().map(largest).collect()
}

/// Whether an energy below zero, with `terms` |x|ᵀ|K||x|, is no more than the program that wrote K may have left of none.
pub(crate) fn is_left_by_the_producer(energy: f64, terms: f64) -> bool {
    energy < 0.0 && -energy <= LEFT_BY_THE_PRODUCER * f64::EPSILON * terms
}

/// The largest share of its terms that an energy has which is below zero by more than its own level, and by no more than the program that
/// wrote K may have left: what its roundings are shown to be. Zero where nothing is below zero but by rounding of its own terms.
pub(crate) fn shown_below_zero(energies: &[f64], levels: &[f64], terms: &[f64]) -> f64 {
    let all = energies.iter().zip(levels).zip(terms);
    let shown =
        all.filter(|((energy, level), terms)| **energy < -**level && is_left_by_the_producer(**energy, **terms));
    shown.map(|((energy, _), terms)| -energy / terms).fold(0.0, f64::max)
}

/// Levels of some motions, raised by what energies below zero show of the roundings in K: no elastic structure has such an energy, and what
/// rounding puts so far below zero it may put as far above it, give or take [`ALIKE`].
pub(crate) fn raised(energies: &[f64], levels: &[f64], terms: &[f64]) -> Vec<f64> {
    let share = ALIKE * shown_below_zero(energies, levels, terms);
    // Nothing is raised where nothing is shown, whatever the terms are.
    let raise = |(level, terms): (&f64, &f64)| if share > 0.0 { level.max(share * terms) } else { *level };
    levels.iter().zip(terms).map(raise).collect()
}

/// Whether a Rayleigh quotient is zero at a level; a motion without energy and mass, 0/0, is.
pub(crate) fn is_zero(lambda: f64, level: f64) -> bool {
    lambda.is_nan() || level.is_nan() || lambda.abs() <= level
}

/// Whether a negative Rayleigh quotient is not an instability, being negligible compared with the first elastic one.
pub(crate) fn is_negligible(lambda: f64, first_elastic: Option<f64>) -> bool {
    -lambda <= NEGLIGIBLE * first_elastic.unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_to_half_its_frequency_is_never_zero() {
        // λ = N_d is where M-09 fails; a known mode lies above.
        assert!(!is_zero(1.0, level(1.0, 1e-16, 1e-16)));
        assert!(is_zero(0.7, level(1.0, 0.0, 0.0)) && is_zero(-0.7, level(1.0, 0.0, 0.0)));
        // A motion without energy and mass.
        assert!(is_zero(f64::NAN, f64::NAN));
    }

    #[test]
    fn energies_below_zero_show_what_those_above_may_be() {
        let (levels, terms) = ([1e-16; 3], [1.0; 3]);
        // Below zero by 10⁻¹³ of the terms: what is above by less than ten times that is rounding too.
        assert_eq!(raised(&[-1e-13, 5e-13, 1.0], &levels, &terms), [1e-12; 3]);
        // Springs alone show nothing, nor does what rounding of the terms explains, nor what no program leaves.
        for energies in [[1e-13, 5e-13, 1.0], [-1e-17, 5e-13, 1.0], [-1e-10, 5e-13, 1.0]] {
            assert_eq!(raised(&energies, &levels, &terms), levels);
        }
    }

    #[test]
    fn negative_energy_is_negligible_against_an_elastic_mode_only() {
        assert!(is_negligible(-1e-9, Some(1.0)) && !is_negligible(-1e-7, Some(1.0)));
        assert!(!is_negligible(-1e-30, None) && is_negligible(0.0, None));
    }
}
