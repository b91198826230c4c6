//! What is said of a result besides the checks.

use crate::certification::claims::Claims;
use crate::certification::judgement::Judged;
use crate::certification::pair::{JudgedPair, PairKind};
use crate::eigen::NOTICED_BAR;
use crate::modes::Component;
use crate::number::{counted, quantity, scientific};
use crate::verification::check::{ActiveLimit, Check, Verdict};

/// What is said besides the checks, one sentence each.
pub(in crate::certification) fn notes(
    component: Component<'_>,
    claims: &Claims,
    judged: &Judged,
    checks: &[Check],
) -> Vec<String> {
    let mut notes = Vec::from_iter(few_digits(claims, checks));
    if judged.lacking.n_cut > 0 {
        notes.push(format!(
            "the result ends inside a group of modes of one frequency: {} of it more in the model; ask for {} more",
            counted(judged.lacking.n_cut, "mode is", "modes are"),
            counted(judged.lacking.n_cut, "mode", "modes"),
        ));
    }
    if component.rigid.n_massless > 0 {
        notes.push(format!(
            "{} of the model without mass: no program can find them",
            counted(component.rigid.n_massless, "rigid-body motion is", "rigid-body motions are")
        ));
    }
    if claims.lambda.is_none() {
        notes.push("the result has no frequencies: those that belong to its shapes are shown".to_owned());
    }
    notes.extend(order(judged));
    notes.extend(unjudged(judged));
    notes
}

/// Shapes whose digits are what some checks warn of.
fn few_digits(claims: &Claims, checks: &[Check]) -> Option<String> {
    /// The checks that shapes alone decide.
    const OF_SHAPES: [&str; 4] = ["M-01", "M-03", "M-04", "M-08"];
    let rounding = claims.shape_rounding.iter().copied().fold(0.0, f64::max);
    let is_open = |check: &&Check| {
        OF_SHAPES.contains(&check.id) && check.verdict() == Verdict::Warn && check.limits.active() == ActiveLimit::Data
    };
    let open: Vec<&str> = checks.iter().filter(is_open).map(|check| check.id).collect();
    let length = claims.rounded.iter().copied().fold(0.0, f64::max);
    // Half a unit of the last of d digits is 0.5 · 10^(1 − d).
    let digits = 1.0 - (2.0 * rounding).log10();
    (rounding > f64::EPSILON && !open.is_empty()).then(|| {
        format!(
            "the shapes have {digits:.0} digits: numbers may be off by {} of themselves, and shapes by up to {} of their length in the mass, which \
             is more than the limits of {} let pass, so that no more is proved of the shapes than their digits say; write more of them",
            scientific(rounding, 1),
            scientific(length, 1),
            open.join(", ")
        )
    })
}

/// A result of which no elastic pair lies in the band: what else was checked says nothing of its modes.
fn unjudged(judged: &Judged) -> Option<String> {
    let elastic = || judged.pairs.iter().filter(|pair| pair.mode_hz != Some(0.0));
    let stated = elastic().map(|pair| pair.stated_hz.unwrap_or(pair.shape_hz));
    let (low, high) = stated.fold((f64::INFINITY, 0.0f64), |(low, high), hertz| (low.min(hertz), high.max(hertz)));
    let is_outside = |pair: &JudgedPair| pair.kind == PairKind::OutsideBand;
    (elastic().next().is_some() && elastic().all(is_outside)).then(|| {
        format!(
            "no elastic pair of the result lies in the band: none was judged, neither its frequency nor its shape; they lie from {} Hz \
             to {} Hz",
            quantity(low, 6),
            quantity(high, 6)
        )
    })
}

/// Frequencies that are all there and belong to other shapes.
fn order(judged: &Judged) -> Option<String> {
    let is_same = |a: f64, b: f64| (a / b - 1.0).abs() <= NOTICED_BAR;
    let inexact = judged.pairs.iter().filter(|pair| pair.kind == PairKind::Inexact);
    // A shape that has its own frequency is inexact for another reason.
    let elsewhere = inexact.filter_map(|pair| Some([pair.stated_hz?, pair.shape_hz]));
    let mut pairs: Vec<[f64; 2]> = elsewhere.filter(|[stated, own]| !is_same(*stated, *own)).collect();
    let mut of_shapes: Vec<f64> = pairs.iter().map(|[_, own]| *own).collect();
    pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
    of_shapes.sort_by(f64::total_cmp);
    let are_all = pairs.iter().zip(&of_shapes).all(|([stated, _], own)| is_same(*stated, *own));
    (pairs.len() > 1 && are_all).then(|| {
        format!(
            "the frequencies of {} are those of other shapes among them: shapes and frequencies are in different orders",
            counted(pairs.len(), "pair", "pairs")
        )
    })
}
