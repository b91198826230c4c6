//! Warnings: what the user should know although no check failed.

use super::results::Results;
use crate::constraint::Loose;
use crate::error::{Selector, Warning};
use crate::factor::Refinement;
use crate::input::{Faces, PatchFaces};
use crate::job::{Boundary, Coupling, Mechanisms, Precision};
use crate::model::Finding;
use crate::number::counted;
use crate::verification::check::Verdict;
use crate::verification::{LARGEST_OF_MESHES, Penalties, penalties as penalties_of};

/// Relative error bar of a frequency above which a warning names the digits of the data: what a modal test resolves, the
/// limit of M-09.
const WANTED: f64 = 1e-4;

/// Mechanisms, motions that cannot be told from mechanisms, rigid-body motions without mass.
pub(super) fn of_motions(results: &Results<'_>) -> Vec<Warning> {
    let rigid = results.evidence.rigid;
    let loose = results.loose;
    let mut warnings = Vec::new();
    let n_mechanisms = rigid.n_inside(results.evidence.partition.model.n_bodies);
    if n_mechanisms > 0 && results.job().model.mechanisms == Mechanisms::Warn {
        let nodes: Vec<String> = loose.mechanisms.iter().map(|motion| motion.nodes.join(", ")).collect();
        let largest = if nodes.is_empty() { String::new() } else { format!(", largest at {}", nodes.join("; at ")) };
        warnings.push(Warning {
            code: "W-MECHANISM",
            message: format!(
                "{} no energy{}, {n_mechanisms} of them inside the component{largest}{}: they are kept as zero modes \
                 like rigid-body motions; close hinges and sliding joints if none were meant, or say \
                 model.mechanisms = \"accept\"",
                counted(rigid.count(), "motion costs", "motions cost"),
                as_far_as_digits_tell(results),
                by_constraints(results)
            ),
        });
    }
    if !loose.grey.is_empty() {
        warnings.push(Warning { code: "W-GREY", message: grey(results, &loose.grey) });
    }
    if rigid.n_massless > 0 {
        warnings.push(Warning {
            code: "W-RIGID-MASS",
            message: format!(
                "the mass of the rigid-body motions has rank {} of {}: {} no part in \
                 inertia relief and cannot be integrated in time unless held",
                rigid.count() - rigid.n_massless,
                rigid.count(),
                counted(rigid.n_massless, "motion without inertia takes", "motions without inertia take")
            ),
        });
    }
    warnings
}

/// What else a motion inside may be, where constraints resist rigid-body motion a little.
fn by_constraints(results: &Results<'_>) -> &'static str {
    let findings = &results.evidence.partition.model.findings;
    match findings.iter().any(|finding| matches!(finding, Finding::ConstraintRounded { .. })) {
        true => ", unless they are rigid-body motions that constraints resist, as W-CONSTRAINT-ROUNDED says",
        false => "",
    }
}

/// What a motion that is kept as free may be slower than, where K has few digits.
fn as_far_as_digits_tell(results: &Results<'_>) -> String {
    if !results.evidence.partition.has_few_digits() {
        return String::new();
    }
    let hertz = results.evidence.partition.scaling.hertz(results.loose.level_of_digits(results.evidence.rigid));
    format!(" that the digits of the stiffness tell from none, which elastic ones up to {hertz:.1e} Hz do not either")
}

fn grey(results: &Results<'_>, motions: &[Loose]) -> String {
    let scaling = results.evidence.partition.scaling;
    let each = motions.iter().map(|motion| {
        format!(
            "{:.3e} Hz known to {:.1e} of itself, largest at {}",
            scaling.hertz(motion.lambda),
            0.5 * motion.bar / motion.lambda,
            motion.nodes.join(", ")
        )
    });
    format!(
        "{} so little energy that double precision hardly tells them from mechanisms: {}; they are kept as elastic",
        counted(motions.len(), "motion costs", "motions cost"),
        each.collect::<Vec<_>>().join("; ")
    )
}

/// What it took to solve with a factor in single precision; none where it is in double.
pub(super) fn refinement(results: &Results<'_>) -> Option<String> {
    let Refinement { n_solves, n_steps, most_steps } = results.evidence.factor.refinement().ok()??;
    let mean = n_steps as f64 / n_solves.max(1) as f64;
    Some(format!(
        "the factor was kept in single precision: conjugate gradients brought {} to rounding of double precision, in {mean:.1} \
         steps on average and {most_steps} at most",
        counted(n_solves, "solve", "solves")
    ))
}

/// A factor in single precision that the job did not ask for.
pub(super) fn mixed_precision(results: &Results<'_>) -> Option<Warning> {
    let was_chosen = results.job().run.precision == Precision::Auto;
    let refinement = refinement(results).filter(|_| was_chosen)?;
    Some(Warning {
        code: "W-MIXED-PRECISION",
        message: format!("in double precision the run would not have fitted into memory; {refinement}"),
    })
}

/// Averages with equal weights on faces that have nodes in the middles of their edges, which the job has not asked for by name.
///
/// A uniform traction acts on the middles of the edges of such a face, and hardly or the other way at its corners. Equal forces bend the
/// face around its corners, so that the joint comes out too soft.
pub(super) fn equal_weights(results: &Results<'_>) -> Option<Warning> {
    let is_quadratic = |name: &str| {
        let of = |patch: &&PatchFaces| patch.of == Selector::Interface(name.to_owned());
        match results.input.faces.iter().find(of).map(|patch| &patch.faces) {
            Some(Faces::Known { faces, .. }) => faces.iter().any(|face| !face.middles.is_empty()),
            Some(Faces::Unknown { .. }) | None => false,
        }
    };
    let averages =
        results.job().interfaces.iter().filter(|job| job.coupling == Coupling::Average && job.weights.is_none());
    let names: Vec<String> =
        averages.filter(|job| is_quadratic(&job.name)).map(|job| format!("{:?}", job.name)).collect();
    let interfaces = if names.len() == 1 { "interface" } else { "interfaces" };
    (!names.is_empty()).then(|| Warning {
        code: "W-WEIGHTS",
        message: format!(
            "{interfaces} {}: the faces have nodes in the middles of their edges, and the mean counts these as much as corners, which \
             makes the joint too soft; say weights = \"area\", or weights = \"uniform\" if equal ones are meant",
            names.join(", ")
        ),
    })
}

/// Stiff rows that take the digits, where a check is not passed and the model has not named them for their size alone: what costs digits
/// that nothing misses needs no word.
pub(super) fn penalties(results: &Results<'_>) -> Option<Warning> {
    // The search reads K once for every few modes.
    let is_unexplained = is_missed(results) && !is_named(results, "W-PENALTY");
    let found = is_unexplained.then(|| penalties_of(&results.evidence, results.findings.first_elastic));
    let Penalties { n_rows, stiffest, ratio, noise, asked, noise_without } = found.flatten()?;
    Some(Warning {
        code: "W-PENALTY",
        message: format!(
            "{} more than {LARGEST_OF_MESHES} times stiffer than rows they are coupled with, up to {ratio:.0e} times at \
             {stiffest}: ties, or elements much thinner than the rest; their terms cancel and leave energies known to {noise:.0e}, where \
             {asked:.0e} is asked for and {noise_without:.0e} is had without them; tie dofs by elimination, or by a smaller penalty",
            counted(n_rows, "row is", "rows are")
        ),
    })
}

/// Rows with next to all of the mass, where a check is not passed and no patch has been named for the place of its mass.
pub(super) fn heavy_rows(results: &Results<'_>) -> Option<Warning> {
    let is_unexplained = is_missed(results) && !is_named(results, "W-MASS-FAR");
    let heavy = results.evidence.partition.model.heavy.as_ref().filter(|_| is_unexplained)?;
    Some(Warning { code: "W-MASS-HEAVY", message: heavy.to_string() })
}

/// Whether some check is not passed.
fn is_missed(results: &Results<'_>) -> bool {
    results.checks().iter().any(|check| matches!(check.verdict(), Verdict::Warn | Verdict::Fail))
}

/// Whether a finding of the model has this code.
fn is_named(results: &Results<'_>, code: &str) -> bool {
    results.evidence.partition.model.findings.iter().any(|finding| finding.warning() == Some(code))
}

/// Modes whose frequency the digits of the data leave less certain than a modal test; where the modes are those of the held
/// interface, the soft motions of the free one too.
pub(super) fn data_precision(results: &Results<'_>) -> Option<Warning> {
    let retained = results.evidence.retained;
    let modes = &retained.modes;
    let scaling = results.evidence.partition.scaling;
    let shown = |what: String, lambda: f64, bar: f64| {
        let hertz = scaling.hertz(lambda);
        (0.5 * bar > WANTED).then(|| format!("{what} at {hertz:.4e} Hz to {:.1e} of itself", 0.5 * bar))
    };
    let soft: &[Loose] = match retained.boundary {
        Boundary::FixedInterface => &results.loose.uncertain,
        Boundary::FreeInterface | Boundary::MixedInterface => &[],
    };
    let of_free = soft.iter().map(|motion| {
        let what = format!("motion of the free interface, largest at {},", motion.nodes.join(", "));
        shown(what, motion.lambda, motion.bar / motion.lambda)
    });
    let of_modes = modes.errors.iter().zip(&modes.lambda).enumerate();
    let of_modes =
        of_modes.map(|(mode, (error, lambda))| shown(format!("mode {}", mode + 1), *lambda, error.relative_bar));
    let uncertain: Vec<String> = of_free.chain(of_modes).flatten().collect();
    let first = uncertain.first()?;
    let [stiffness, mass] = &results.input.matrices;
    if is_named(results, "W-FRAME-DIGITS") {
        return None;
    }
    let precision = results.evidence.partition.precision;
    let differing = [("stiffness", precision.stiffness), ("mass", precision.mass)];
    let mut differing = differing.into_iter().filter_map(|(name, rounding)| Some((name, rounding.differing?)));
    if let Some((name, differing)) = differing.next() {
        return Some(Warning {
            code: "W-DATA-PRECISION",
            message: format!(
                "the triangles of the {name} differ by {differing} (W-UNSYMMETRIC), and which of them is right leaves {} less certain than \
                 {WANTED:.0e}, {first}; correct the matrix, or say which triangle holds with model.symmetric",
                counted(uncertain.len(), "frequency", "frequencies")
            ),
        });
    }
    let keys = [("model.stiffness_digits", stiffness), ("model.mass_digits", mass)];
    let short = keys.into_iter().filter(|(_, matrix)| !matrix.digits.are_all());
    let stated: Vec<String> = short.map(|(key, _)| format!("{key} = 17")).collect();
    let advice = match stated.as_slice() {
        [] => "double precision has no more for stiffnesses of such different size: make stiff ties and thin elements softer or leave them \
               out"
            .to_owned(),
        stated => format!(
            "write the matrices with all their digits, and stiffnesses of like size, or say {} in the job if their numbers are exact",
            stated.join(" and ")
        ),
    };
    Some(Warning {
        code: "W-DATA-PRECISION",
        message: format!(
            "{} of the stiffness and {} of the mass leave {} less certain than {WANTED:.0e}, {first}; \
             {advice}",
            stiffness.digits.in_words(),
            mass.digits.in_words(),
            counted(uncertain.len(), "frequency", "frequencies")
        ),
    })
}
