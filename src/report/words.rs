//! The words and figures that the summary and the page have in common.

use std::collections::BTreeMap;

use super::{
    ExpansionReport, FacesReport, InterfacePosition, InterfaceReport, LoadReport, ModeKind, ModelReport,
    PositionOrigin, ReductionReport, ReportBody, ResidualVector,
};
use crate::cache::{Kind, Tally};
use crate::job::Eigensolver;
pub(super) use crate::job::boundary_in_words as boundary;
use crate::number::{self, counted, scientific};
use crate::partition::{Fit, Frame, HeldSelection};
use crate::verification::check::{ActiveLimit, Check, Verdict};
use crate::verification::preservation::{Accuracy, AccuracyMeasure, FrequencyPair, LimitSource, Preservation};

pub(super) fn eigensolver(eigensolver: Eigensolver) -> &'static str {
    match eigensolver {
        Eigensolver::Lanczos => "block Lanczos",
        Eigensolver::Arpack => "ARPACK",
    }
}

/// What a file of the model is, by its role.
pub(crate) fn file(role: &str) -> &str {
    match role {
        "dofs" => "dof map",
        "dofs_data" => "nodes made of shells and beams",
        "nodes_data" => "data of nodes",
        "frames" => "axes of nodes",
        "internal_forces" => "internal forces",
        "quantity_names" => "names of quantities",
        other => other,
    }
}

/// What a run had of its cache.
pub(super) fn cache(tally: &Tally) -> String {
    let of_kind = |(kind, n): (&Kind, &usize)| match kind {
        Kind::Factor => counted(*n, "factor", "factors"),
        Kind::Count => counted(*n, "count", "counts"),
        Kind::Modes => counted(*n, "set of modes", "sets of modes"),
        Kind::Response => counted(*n, "frequency response", "frequency responses"),
        Kind::Band => counted(*n, "certified band", "certified bands"),
        Kind::Space => counted(*n, "space of a response", "spaces of responses"),
        Kind::Order => counted(*n, "order", "orders"),
        Kind::Statics => counted(*n, "statics", "statics"),
    };
    let list = |found: &BTreeMap<Kind, usize>| match found.is_empty() {
        true => "nothing".to_owned(),
        false => found.iter().map(of_kind).collect::<Vec<_>>().join(", "),
    };
    let parts = match tally.parts {
        0 => String::new(),
        n => format!(", {} of more than was asked", counted(n, "part", "parts")),
    };
    format!("{} taken from earlier runs{parts} · {} kept for later ones", list(&tally.taken), list(&tally.kept))
}

/// Modes that nothing sees; none where there are none.
pub(super) fn unseen(reduction: &ReductionReport) -> Option<String> {
    let unseen = &reduction.unseen;
    (!unseen.is_empty()).then(|| {
        let numbers: Vec<String> = unseen.iter().map(ToString::to_string).collect();
        format!(
            "{} {}: interface, outputs and loads neither excite nor observe them",
            if unseen.len() == 1 { "mode" } else { "modes" },
            numbers.join(", ")
        )
    })
}

pub(super) fn mode_kind(kind: ModeKind) -> &'static str {
    match kind {
        ModeKind::FreeInterface => "free-interface",
        ModeKind::FixedInterface => "fixed-interface",
        ModeKind::MixedInterface => "mixed-interface",
    }
}

/// How far the reduced model answers what is asked of it, a label and a line each: errors with their limits, then the frequencies that it
/// has. Nothing where nothing was compared.
pub(super) fn accuracy(body: &ReportBody) -> Vec<(&'static str, String)> {
    let preservation = &body.preservation;
    if *preservation == Preservation::default() {
        return Vec::new();
    }
    let mut lines: Vec<(&str, String)> = preservation.accuracy.iter().map(accuracy_of).collect();
    if let Some([low, high]) = preservation.band_hz.filter(|_| !lines.is_empty()) {
        lines.insert(0, ("band", format!("{} Hz to {} Hz", number::quantity(low, 4), number::quantity(high, 5))));
    }
    let mut parts = Vec::new();
    parts.extend(
        body.reduction.modes.last().map(|mode| format!("modes kept to {} Hz", number::quantity(mode.frequency_hz, 5))),
    );
    parts.push(match preservation.highest {
        Some(highest) => format!(
            "highest frequency {} Hz, explicit steps below {} s {}",
            number::quantity(highest.frequency_hz, 5),
            number::scientific(number::no_more_than(highest.explicit_step_s, 2), 2),
            if highest.is_damped { "damped" } else { "undamped" }
        ),
        None => "no largest explicit step is known: a motion has no mass, or none was found".to_owned(),
    });
    lines.push(("reduced model", parts.join(" · ")));
    lines
}

fn accuracy_of(accuracy: &Accuracy) -> (&'static str, String) {
    let label = match accuracy.measure {
        AccuracyMeasure::Frequency => "frequencies",
        AccuracyMeasure::Response => "response",
        AccuracyMeasure::InternalLoad => "internal loads",
        AccuracyMeasure::Static => "statics",
    };
    let at = accuracy.at.as_deref().unwrap_or("the comparison was not made");
    let mut line = match accuracy.error {
        None => format!("not measured: {at}"),
        Some(0.0) => at.to_owned(),
        Some(error) if error.is_finite() => {
            format!("off by at most {}: {at}", accuracy.at_least_in_words(error))
        }
        Some(_) => format!("not all there: {at}"),
    };
    if let (Some(limit), Some(_)) = (accuracy.limit, accuracy.error) {
        let whose = match accuracy.set_by {
            LimitSource::Scene => "the scene accepts",
            LimitSource::Practice => "practice asks for",
        };
        line += &format!(" · {whose} {}", accuracy.in_words(limit));
    }
    if let Some(advice) = &accuracy.advice {
        line += &format!(" – {advice}");
    }
    (label, line)
}

/// The boundary of the modes in words: `mixed-interface (base held)`.
pub(super) fn modes_under(kind: ModeKind, held: Option<&[String]>) -> String {
    match held {
        None => mode_kind(kind).to_owned(),
        Some([]) => format!("{} (nothing held)", mode_kind(kind)),
        Some(held) => format!("{} ({} held)", mode_kind(kind), held.join(", ")),
    }
}

/// What the coordinates of the reduced model are, each part with its number.
pub(super) fn coordinates(reduction: &ReductionReport) -> Vec<String> {
    let mut parts = vec![format!("{} interface", number::count(reduction.n_interface as u64))];
    for (n, what) in [(reduction.n_inertia_relief, "inertia relief"), (reduction.n_rigid_body(), "rigid-body")] {
        if n > 0 {
            parts.push(format!("{} {what}", number::count(n as u64)));
        }
    }
    parts.push(match &reduction.expansion {
        Some(expansion) => counted(expansion.n_kept(), "expansion mode", "expansion modes"),
        None => counted(reduction.n_modes, "elastic mode", "elastic modes"),
    });
    let n_residual_vectors = reduction.n_residual_vectors();
    if n_residual_vectors > 0 {
        parts.push(counted(n_residual_vectors, "residual vector", "residual vectors"));
    }
    parts
}

/// Of a mass that was not read.
pub(super) const NO_MASS: &str = "not read: the scene asks for statics alone";

/// What is special about the reduced mass, where something is.
pub(super) fn mass(reduction: &ReductionReport) -> Option<String> {
    let rank = reduction.mass_rank?;
    Some(format!("of the modes and of rigid-body motion alone · singular, of rank {rank}"))
}

/// The modes of a file: how many, what the reduced model makes of them, and what of them nothing follows.
pub(super) fn expansion(expansion: &ExpansionReport) -> Vec<String> {
    /// Less than this is rounding of coordinates and of the file.
    const SHOWN: f64 = 1e-6;
    let mut lines = vec![counted(expansion.modes.len(), "mode of a file", "modes of a file")];
    if let (Some(first), Some(last)) = (expansion.reduced_hz.first(), expansion.reduced_hz.last()) {
        lines[0] += &format!(
            " · reduced model with its interface free: {} Hz to {} Hz, upper bounds of the full one's",
            number::quantity(*first, 6),
            number::quantity(*last, 6)
        );
    }
    let lost = expansion.modes.iter().filter(|mode| mode.not_followed > SHOWN);
    lines.extend(lost.map(|mode| {
        let share = number::scientific(mode.not_followed, 2);
        format!("mode {}: held dofs and rigid patches cannot follow {share} of it", mode.index)
    }));
    lines
}

/// The loads by name: what each is, its total force, and how much of its static answer the reduced model lacks.
pub(super) fn loads(reduction: &ReductionReport) -> Vec<String> {
    let line = |load: &LoadReport| {
        let mut parts = vec![load.source.clone()];
        if let Some(resultant) = load.resultant {
            let size = resultant.iter().fold(0.0f64, |size, value| size.max(value.abs()));
            let clear = |value: f64| if value.abs() <= 1e-12 * size { 0.0 } else { value };
            parts.push(format!("total ({})", resultant.map(|value| number::quantity(clear(value), 5)).join(", ")));
        }
        parts.push(match load.residual_vector {
            ResidualVector::Kept => "residual vector".to_owned(),
            ResidualVector::LeftOut => "residual vector left out".to_owned(),
            ResidualVector::NotAsked => "no residual vector".to_owned(),
            ResidualVector::NoAnswer => {
                "no residual vector: a free component without interface has no static answer".to_owned()
            }
        });
        parts.extend(load.lacking.map(|lacking| format!("static answer lacks {}", number::scientific(lacking, 1))));
        format!("{}: {}", load.name, parts.join(", "))
    };
    reduction.loads.iter().map(line).collect()
}

/// What the job holds: how much of the model, then each selection.
pub(super) fn held(model: &ModelReport) -> Vec<String> {
    let Some(held) = &model.held else { return Vec::new() };
    let all = format!("{} of {}", number::count(held.n_dofs as u64), counted(model.n_dofs, "dof", "dofs"));
    let selection = |selection: &HeldSelection| {
        let nodes = selection.n_nodes.map(|n_nodes| counted(n_nodes, "node", "nodes") + ", ").unwrap_or_default();
        format!("{}: {nodes}{}", selection.name, counted(selection.n_dofs, "dof", "dofs"))
    };
    std::iter::once(all).chain(held.selections.iter().map(selection)).collect()
}

/// The lower end of an interval of frequencies; a shift below zero has none.
pub(super) fn lower_end(hz: f64, digits: usize) -> String {
    if hz < 0.0 { "below 0".to_owned() } else { number::quantity(hz, digits) }
}

/// Limit, its source and the margin; dashes where a check has none.
pub(super) fn limit(check: &Check) -> [String; 3] {
    if !check.is_judged() {
        return ["–", "–", "–"].map(str::to_owned);
    }
    let limit = number::scientific(check.limits.value(), 1);
    [limit, active_limit(check.limits.active()).to_owned(), margin(check.margin())]
}

pub(super) fn active_limit(limit: ActiveLimit) -> &'static str {
    match limit {
        ActiveLimit::Engineering => "engineering",
        ActiveLimit::Arithmetic => "arithmetic",
        ActiveLimit::Data => "data",
    }
}

/// Margins are looked at, not calculated with: two digits, and no more than a million.
fn margin(margin: f64) -> String {
    if margin.is_nan() {
        "–".to_owned()
    } else if margin >= 1e6 {
        "> 1e6".to_owned()
    } else if margin >= 10.0 {
        number::count(margin as u64)
    } else {
        number::quantity(margin, 2)
    }
}

/// Where the nodes of an interface are: the first ones, and where the place of a patch comes from.
pub(super) fn positions(interface: &InterfaceReport) -> Option<String> {
    const SHOWN: usize = 2;
    let place = |at: &InterfacePosition| {
        let size = at.position.iter().fold(0.0_f64, |size, coordinate| size.max(coordinate.abs()));
        let shown = |value: f64| number::quantity(if value.abs() <= 1e-12 * size { 0.0 } else { value }, 6);
        let place = format!("({})", at.position.map(shown).join(", "));
        match at.origin {
            PositionOrigin::Node => place,
            PositionOrigin::MeanOfNodes => {
                let faces = at.faces.map(|faces| from_centroid(&faces, size)).unwrap_or_default();
                let unknown = at.faces_unknown.as_ref();
                let unknown =
                    unknown.map(|why| format!("; the centroid of its faces is not known: {why}")).unwrap_or_default();
                format!("{place}, the mean of its nodes{faces}{unknown}")
            }
            PositionOrigin::CentroidOfFaces => format!("{place}, the centroid of its faces"),
            PositionOrigin::Hole => {
                format!("{place}, on the axis of a cylinder{}", at.fit.map(of_fit).unwrap_or_default())
            }
            PositionOrigin::Sphere => {
                format!("{place}, the centre of a sphere{}", at.fit.map(of_fit).unwrap_or_default())
            }
            PositionOrigin::Job => format!("{place}, as the job says"),
        }
    };
    let axes = |at: &InterfacePosition| at.axes.map(|axes| format!("; {}", turned(&axes))).unwrap_or_default();
    let place = |at: &InterfacePosition| place(at) + &axes(at);
    let mut places: Vec<String> = interface.at.iter().take(SHOWN).map(place).collect();
    if interface.at.len() > SHOWN {
        places.push(format!("… and {} more in the report", interface.at.len() - SHOWN));
    }
    (!places.is_empty()).then(|| format!("at {}", places.join(", ")))
}

/// Where the axes of a node point.
fn turned(axes: &Frame) -> String {
    let shown = |column: usize| axes.map(|row| number::quantity(row[column], 4)).join(", ");
    format!("its x along ({}), z along ({})", shown(0), shown(2))
}

/// The radius of a fitted surface, and how far nodes are from it.
fn of_fit(fit: Fit) -> String {
    let [radius, residual] = [number::quantity(fit.radius, 6), number::scientific(fit.residual, 1)];
    format!(" of radius {radius} fitted to its nodes, which are up to {residual} off")
}

/// How far the mean of nodes is from the centroid of their faces, among coordinates of a size.
fn from_centroid(faces: &FacesReport, size: f64) -> String {
    // A mean of coordinates is not known better than they are.
    let distance = if faces.distance <= 1e-12 * size { 0.0 } else { faces.distance };
    let faces = counted(faces.count, "face", "faces");
    if distance == 0.0 {
        return format!(" and the centroid of its {faces}");
    }
    format!(", {} from the centroid of its {faces}", number::quantity(distance, 3))
}

/// A check that is not met, in one line: what, where, found, expected.
pub fn unmet_check(check: &Check) -> String {
    let [limit, ..] = self::limit(check);
    let at = check.worst.as_ref().map(|worst| format!(" – {worst}")).unwrap_or_default();
    // What may not be at all is counted.
    let is_count = check.limits.value() == 0.0 && check.value >= 1.0 && check.value.fract() == 0.0;
    let found = if is_count { number::count(check.value as u64) } else { number::scientific(check.value, 2) };
    let expected = if check.verdict() == Verdict::Fail && check.fails_above() > check.limits.value() {
        format!("{limit}, failing above {}", number::scientific(check.fails_above(), 1))
    } else {
        limit
    };
    format!("{} {}{at} – found {found} – expected at most {expected}", check.id, check.name)
}

/// A frequency of the full model with so many decimals, and its error bar where the last of them is not known.
pub(super) fn full_frequency(pair: &FrequencyPair, decimals: usize) -> String {
    let FrequencyPair { full_hz, full_error_bar_hz, .. } = pair;
    let is_known = *full_error_bar_hz <= 0.5 * 0.1f64.powi(decimals as i32);
    let bar = if is_known { String::new() } else { format!(" ± {}", scientific(*full_error_bar_hz, 1)) };
    format!("{full_hz:.decimals$}{bar}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verification::check::Limits;

    #[test]
    fn what_may_not_be_at_all_is_counted() {
        let check = |value, fail_above| Check {
            id: "M-06",
            name: "modes are all there are",
            equation: "",
            value,
            limits: Limits::default(),
            fail_above,
            worst: None,
        };
        assert_eq!(unmet_check(&check(2.0, 0.0)), "M-06 modes are all there are – found 2 – expected at most 0");
        let shares = "M-06 modes are all there are – found 5.0e-01 – expected at most 0, failing above 1e-03";
        assert_eq!(unmet_check(&check(0.5, 1e-3)), shares);
    }

    #[test]
    fn a_frequency_has_its_bar_where_that_is_more_than_its_last_decimal_tells() {
        let pair = |full_error_bar_hz| FrequencyPair {
            full_hz: 1234.56789,
            full_error_bar_hz,
            reduced_hz: 1235.0,
            relative_difference: 3.5e-4,
            in_band: true,
        };
        assert_eq!(full_frequency(&pair(4e-4), 3), "1234.568");
        assert_eq!(full_frequency(&pair(0.02), 3), "1234.568 ± 2e-02");
        assert_eq!(full_frequency(&pair(f64::NAN), 3), "1234.568 ± NaN");
    }
}
