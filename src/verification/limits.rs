//! Limits for a reduction and for its file, from the error bars of the frequencies that are known.
//!
//! The bar of a frequency says how far rounding of the arithmetic and of the data can change an energy xᵀKx of unit modal mass. The
//! energies of rigid-body motions and of the reduced matrices are sums of the same entries of K.

use super::check::Limits;
use crate::dense::NOISE_FACTOR;
use crate::eigen::Modes;
use crate::partition::Partition;
use crate::rigid::{RigidBodyModes, noise_of_digits};

/// Energy of a rigid-body motion relative to that of the first elastic mode that practice accepts: a rigid-body frequency of 10⁻⁴
/// of the first elastic one.
const RIGID_ENERGY: f64 = 1e-8;
/// Relative difference of one frequency that is computed twice.
const SAME_FREQUENCY: f64 = 1e-9;
/// Noise of energies and of frequencies at which their limits are still those of practice.
pub(crate) const ENERGY_ASKED: f64 = RIGID_ENERGY / NOISE_FACTOR;
pub(crate) const FREQUENCY_ASKED: f64 = SAME_FREQUENCY / NOISE_FACTOR;
/// Energy of a motion relative to that of the first elastic mode up to which it is free all the same: a frequency of a thousandth of the
/// first elastic one.
pub(crate) const NEARLY_FREE: f64 = 1e-6;
/// Motions of a body as a whole.
const MOTIONS: usize = 6;
/// Energy at which the component is held: a rigid-body frequency of a hundredth of the first elastic one.
pub(crate) const GROUNDED: f64 = 1e-4;
/// What rounding may excuse of an energy without a warning: at a tenth of the first elastic frequency a rigid-body motion
/// cannot be told from an elastic one.
const LARGEST_ENERGY: f64 = 1e-2;
/// What rounding that the digits of K explain may excuse at all: a quarter of the first elastic frequency.
pub(crate) const LARGEST_EXPLAINED_ENERGY: f64 = 1.0 / 16.0;
/// Relative force of a rigid-body motion at which the component is held.
const HELD: f64 = 1e-6;
/// Defect of a rigid-body motion that the interface carries, relative to its largest displacement, at which it is not carried: of the basis
/// and of recovered rows, which are rows of it.
pub(crate) const NOT_CARRIED: f64 = 1e-9;
/// Relative error bar of a frequency that is unknown: half of it is open.
pub(crate) const UNKNOWN: f64 = 0.5;
/// Relative difference of a frequency that reduced models are accepted with; one that is off by more is not preserved, whatever the
/// reason.
const NOT_PRESERVED: f64 = 1e-3;
/// The most that rounding may excuse of numbers that should be equal: no file can declare itself beyond judgement.
pub(crate) const LARGEST_EXCUSE: f64 = 1e-3;
/// Relative difference of a frequency that no digits of the data excuse.
const OPEN: f64 = 0.1;
/// A coupling of two modes of this size moves their frequencies by its square: no more rounding than this is excused.
pub(crate) const HARMLESS_COUPLING: f64 = 1e-6;

/// A known eigenvalue with its relative error bar.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    pub(crate) lambda: f64,
    pub(crate) relative_bar: f64,
}

/// The limits of a check, and the value above which it fails.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Judged {
    pub(crate) limits: Limits,
    pub(crate) fail_above: f64,
}

impl Judged {
    /// How bad a value is: above two where it fails, above one where it warns.
    pub(crate) fn severity(self, value: f64) -> f64 {
        let limit = self.limits.value();
        if value <= limit { value / limit } else { 1.0 + value / self.fail_above }
    }
}

/// The noise of energies relative to the first elastic one, by the bars of the frequencies known.
pub(crate) fn noise(known: impl IntoIterator<Item = Known>, first: f64) -> f64 {
    known.into_iter().map(|known| known.lambda * known.relative_bar / first).fold(0.0, f64::max)
}

/// What rounding and the digits of the data make of an energy that should be zero, relative to the first elastic eigenvalue: by the bars
/// of the modes known and by what rounding and few digits make of rigid-body motion itself, which the bars of modes with the interface held
/// do not show: a stiff part far from it strains in none of them. Without modes it comes from the moduli of its terms.
pub(crate) fn energy_noise(
    (partition, rigid): (&Partition, &RigidBodyModes),
    known: impl IntoIterator<Item = Known>,
    first: f64,
) -> f64 {
    let mut known = known.into_iter().peekable();
    match known.peek() {
        None => partition.cancellation * rigid.energy.noise / first,
        Some(_) => {
            let share_of_rounding = f64::EPSILON / (partition.precision.stiffness.share + f64::EPSILON);
            let of_rigid = noise_of_digits(partition, rigid).max(share_of_rounding * rigid.energy.noise);
            noise(known, first).max(of_rigid / first)
        }
    }
}

/// How many of the lowest eigenvalues are those of rigid-body motion, or of motions of a body as a whole that cost energy and are free in
/// practice all the same: springs so soft hold some of the six. Energies are compared with the next one, compared with which roundings
/// are nothing.
pub(crate) fn n_nearly_free(ascending: &[f64], n_rigid: usize) -> usize {
    let is_step = |k: &usize| match ascending.get(k - 1..=*k) {
        Some([soft, next]) => *soft <= NEARLY_FREE * next,
        _ => false,
    };
    (n_rigid + 1..=MOTIONS).find(is_step).unwrap_or(n_rigid)
}

/// The share that the digits of K have in an error bar, the rest being that of the arithmetic.
pub(super) fn share_of_data(partition: &Partition) -> f64 {
    let precision = partition.precision.stiffness.share;
    precision / (f64::EPSILON + precision)
}

/// Limits of an energy that should be zero, relative to that of the first elastic mode, at a noise of which the digits of the
/// data have a share.
pub(crate) fn of_energy(noise: f64, share_of_data: f64) -> Judged {
    of_nothing(noise, share_of_data, GROUNDED)
}

/// Limits of such an energy in a file alone. The file does not say how many digits its matrices had: a warning where
/// digits could explain the energy.
pub(crate) fn of_unexplained_energy(noise: f64) -> Judged {
    let Judged { limits, fail_above } = of_energy(noise, 1.0);
    Judged { limits, fail_above: fail_above.max(LARGEST_EXPLAINED_ENERGY) }
}

/// Limits of a force of rigid-body motion, relative to that of an elastic one of the same size: roundings make as much of it as of the
/// energy.
pub(crate) fn of_force(noise: f64, share_of_data: f64) -> Judged {
    of_nothing(noise, share_of_data, HELD)
}

/// Limits of such a force in a file alone, whose digits could explain more than its error bars tell.
pub(crate) fn of_unexplained_force(noise: f64) -> Judged {
    let Judged { limits, fail_above } = of_force(noise, 1.0);
    Judged { limits, fail_above: fail_above.max(LARGEST_EXPLAINED_ENERGY) }
}

fn of_nothing(noise: f64, share_of_data: f64, fails_at: f64) -> Judged {
    let noise = NOISE_FACTOR * noise;
    let (arithmetic, data) = (noise * (1.0 - share_of_data), noise * share_of_data);
    let limits = Limits { engineering: RIGID_ENERGY, arithmetic, data }.capped(LARGEST_ENERGY, LARGEST_ENERGY);
    let explained = data.min(LARGEST_EXPLAINED_ENERGY);
    Judged { limits, fail_above: limits.value().max(fails_at).max(explained) }
}

/// Limits of the relative difference of a frequency of the full model and that of the same mode in the reduced one, for a reduction and for
/// a comparison of its file with the model. Both values carry the rounding of their quadratic forms, for which the error bars stand; not
/// that of the residual, which belongs to the mode.
pub(crate) fn of_frequencies(modes: &Modes, partition: &Partition) -> Judged {
    let bars = modes.errors.iter().map(|error| error.data_bar).fold(0.0, f64::max);
    of_frequency(bars, share_of_data(partition))
}

/// Limits of the relative difference of two frequencies of one mode whose eigenvalue has this relative bar.
pub(crate) fn of_frequency(relative_bar: f64, share_of_data: f64) -> Judged {
    let noise = NOISE_FACTOR * relative_bar;
    let limits =
        Limits { engineering: SAME_FREQUENCY, arithmetic: noise * (1.0 - share_of_data), data: noise * share_of_data };
    let limits = limits.capped(NOT_PRESERVED, NOT_PRESERVED);
    // What the digits leave open is not a failure of the reduction: up to the error bar itself it is a warning, with M-09.
    let within_bar = (0.5 * relative_bar * share_of_data).min(OPEN);
    Judged { limits, fail_above: limits.value().max(1e-6).max(within_bar) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verification::check::ActiveLimit;

    #[test]
    fn practice_is_asked_of_many_digits_and_a_tenth_of_a_frequency_is_the_most_that_few_excuse() {
        let known = [Known { lambda: 2.0, relative_bar: 1e-12 }, Known { lambda: 8.0, relative_bar: 1e-12 }];
        assert_eq!(noise(known, 2.0), 4e-12);
        let of_many = of_energy(noise(known, 2.0), 0.0);
        assert_eq!((of_many.limits.value(), of_many.limits.active()), (RIGID_ENERGY, ActiveLimit::Engineering));
        assert_eq!(of_many.fail_above, GROUNDED);
        assert_eq!(of_force(noise(known, 2.0), 0.0).fail_above, HELD);
        let of_few = of_energy(0.5, 1.0);
        assert_eq!((of_few.limits.value(), of_few.limits.active()), (LARGEST_ENERGY, ActiveLimit::Data));
        assert_eq!(of_few.fail_above, LARGEST_EXPLAINED_ENERGY);
        // The arithmetic explains no more than its limit.
        assert_eq!(of_energy(0.5, 0.0).fail_above, LARGEST_ENERGY);
    }

    #[test]
    fn frequencies_differ_by_their_bars_and_no_more_than_a_thousandth_without_a_word() {
        assert_eq!(of_frequency(1e-14, 0.0).limits.value(), 1e-9);
        assert_eq!(of_frequency(1e-5, 0.0).limits.value(), 1e-4);
        assert_eq!(of_frequency(1.0, 1.0).limits.value(), NOT_PRESERVED);
        assert_eq!((of_frequency(1.0, 1.0).fail_above, of_frequency(1.0, 0.0).fail_above), (OPEN, NOT_PRESERVED));
    }
}
