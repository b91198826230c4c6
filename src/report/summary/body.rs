//! What was read, computed and checked.

use super::preserved::LINES_SHOWN;
use crate::number;
use crate::report::mode_table::{Mode, mode_table};
use crate::report::page::{Page, Tone, WIDTH, verdict_word};
use crate::report::table::{self, Align};
use crate::report::{
    Completeness, MassProperties, MatrixReport, ModelReport, ReductionReport, ReportBody, RigidBodyEvidence,
    TrustInterval, words,
};
use crate::rigid::RigidSource;
use crate::verification::check::{Check, Verdict};

/// Longest name of a check: with it a row takes 2 + 4 + 44 + 7 + 6 + 11 + 7 + 6 columns and six gaps of two, 99.
const NAME: usize = 44;

pub(super) fn write(page: &mut Page, body: &ReportBody) {
    let reduction = &body.reduction;
    let sizes = format!("{} → {}", number::count(body.model.n_dofs as u64), number::count(reduction.n_reduced as u64));
    let title = format!(
        "{} {} · {} · {sizes} degrees of freedom",
        body.generator.name,
        body.generator.version,
        reduction.method.name()
    );
    page.line(Page::toned(&title, Tone::Heading));
    page.heading("Read");
    model(page, &body.model);
    page.heading("Reduced");
    reduced(page, reduction);
    rigid_body(page, &body.rigid_body);
    let modes: Vec<Mode> = reduction
        .modes
        .iter()
        .map(|mode| Mode { number: mode.index, frequency_hz: mode.frequency_hz, error_bar_hz: Some(mode.error_bar_hz) })
        .collect();
    mode_table(page, &modes);
    super::preserved::write(page, &body.preservation);
    page.heading("Checked");
    checks(page, &body.checks);
    completeness(page, &body.completeness);
    trust_intervals(page, &body.trust_intervals);
    if !body.warnings.is_empty() {
        page.heading("Warnings");
        for warning in &body.warnings {
            page.entry(warning.code, &warning.message);
        }
    }
}

fn model(page: &mut Page, model: &ModelReport) {
    let mut parts = vec![number::counted(model.n_dofs, "dof", "dofs")];
    parts.extend(model.n_nodes.map(|n_nodes| number::counted(n_nodes, "node", "nodes")));
    parts.push(number::counted(model.n_bodies, "body", "bodies"));
    parts.extend(model.units.clone().map(|units| format!("units {units}")));
    page.entry("model", &parts.join(" · "));
    let held = words::held(model);
    if !held.is_empty() {
        page.entry("held", &held.join(" · "));
    }
    page.entry("stiffness", &matrix(&model.stiffness));
    page.entry("mass", &model.mass.as_ref().map_or_else(|| words::NO_MASS.to_owned(), matrix));
    for (role, digest) in &model.files {
        page.entry(words::file(role), &format!("blake3 {}…", short(digest)));
    }
    mass_properties(page, &model.mass_properties);
    let source = match model.rigid_body_modes.source {
        RigidSource::Geometric => "from the coordinates, verified against the stiffness",
        RigidSource::Algebraic => "from the matrices, by inverse iteration",
    };
    let rigid = match model.rigid_body_modes.count {
        0 => "no modes: the component is restrained".to_owned(),
        count => format!("{} {source}", number::counted(count, "mode", "modes")),
    };
    page.entry("rigid body", &rigid);
    listing(page, "note", &model.notes);
}

pub(crate) fn matrix(matrix: &MatrixReport) -> String {
    let nonzeros = number::counted(matrix.n_nonzeros, "nonzero", "nonzeros");
    let digits = matrix.digits.in_words();
    format!("{nonzeros} · {digits} · blake3 {}…", short(&matrix.digest))
}

/// As much of a digest as tells two files apart.
pub(crate) fn short(digest: &str) -> String {
    digest.chars().take(12).collect()
}

pub(crate) fn mass_properties(page: &mut Page, properties: &MassProperties) {
    if let Some(mass) = properties.mass {
        page.entry("total mass", &number::quantity(mass, 7));
    }
    if let Some(cg) = properties.cg {
        // A coordinate that is rounding compared with the others would only draw the eye.
        let size = cg.iter().fold(0.0_f64, |size, coordinate| size.max(coordinate.abs()));
        page.entry("centre of mass", &format!("({})", cg.map(|coordinate| rounded(coordinate, size)).join(", ")));
    }
    if let Some(inertia) = properties.inertia {
        let size = inertia.iter().flatten().fold(0.0_f64, |size, term| size.max(term.abs()));
        let term = |name: &str, row: usize, column: usize| format!("{name} {}", rounded(inertia[row][column], size));
        let diagonal = [term("xx", 0, 0), term("yy", 1, 1), term("zz", 2, 2)].join(", ");
        let products = [term("xy", 0, 1), term("xz", 0, 2), term("yz", 1, 2)].join(", ");
        page.entry("inertia", &format!("{diagonal} · {products}"));
    }
}

fn rounded(value: f64, size: f64) -> String {
    if value.abs() <= 1e-12 * size { "0".to_owned() } else { number::quantity(value, 5) }
}

fn reduced(page: &mut Page, reduction: &ReductionReport) {
    for interface in &reduction.interfaces {
        let coupling = interface.coupling.name();
        let nodes = number::counted(interface.n_nodes, "node", "nodes");
        let dofs = number::counted(interface.n_dofs, "dof", "dofs");
        page.entry("interface", &format!("{} · {coupling} · {nodes} · {dofs}", interface.name));
        words::positions(interface).iter().for_each(|places| page.entry("", places));
    }
    let parts = words::coordinates(reduction);
    page.entry("coordinates", &format!("{} = {}", number::count(reduction.n_reduced as u64), parts.join(" + ")));
    words::mass(reduction).iter().for_each(|mass| page.entry("reduced mass", mass));
    if let Some(expansion) = &reduction.expansion {
        page.entry("modes", &format!("blake3 {}…", short(&expansion.digest)));
        listing(page, "", &words::expansion(expansion));
    }
    words::loads(reduction).iter().for_each(|load| page.entry("load", load));
    let dropped: Vec<String> =
        reduction.dropped.iter().map(|dropped| format!("{}: {}", dropped.coordinate, dropped.reason)).collect();
    listing(page, "left out", &dropped);
    for skipped in &reduction.skipped {
        page.entry("skipped", &format!("{}: {}", skipped.rule, skipped.what));
    }
    let solver = words::eigensolver(reduction.eigensolver);
    let worst = reduction.modes.iter().map(|mode| mode.backward_error).fold(0.0, f64::max);
    words::unseen(reduction).iter().for_each(|unseen| page.entry("unseen", unseen));
    if let Some(mode) = reduction.modes.first() {
        let kind = words::modes_under(mode.kind, reduction.modes_held.as_deref());
        let worst = number::scientific(worst, 2);
        page.entry("modes", &format!("{kind} · {solver} · backward error at most {worst}"));
    }
}

fn rigid_body(page: &mut Page, found: &RigidBodyEvidence) {
    let highest = found.frequencies_hz.iter().copied().fold(f64::NAN, f64::max);
    let mut parts = Vec::new();
    if !highest.is_nan() {
        parts.push(format!("at most {} Hz", number::quantity(highest, 2)));
    }
    let worst = found.grounding.iter().max_by(|a, b| a.energy_ratio.total_cmp(&b.energy_ratio));
    if let Some(worst) = worst.filter(|_| !parts.is_empty()) {
        let ratio = number::scientific(worst.energy_ratio, 2);
        parts.push(format!("worst {}, {ratio} of the first elastic energy", worst.direction));
    }
    if !parts.is_empty() {
        page.entry("rigid body", &parts.join(" · "));
    }
}

pub(crate) fn checks(page: &mut Page, checks: &[Check]) {
    let heads = ["", "check", "value", "limit", "set by", "margin", "verdict"].map(str::to_owned);
    let rows: Vec<[String; 7]> = std::iter::once(heads).chain(checks.iter().map(check_row)).collect();
    let align = [Align::Left, Align::Left, Align::Right, Align::Right, Align::Left, Align::Right, Align::Left];
    let mut lines = table::columns(&rows, align).into_iter();
    if let Some(heads) = lines.next() {
        page.spans(&["  ".into(), Page::toned(&heads.join("  "), Tone::Faint)]);
    }
    for (line, check) in lines.zip(checks) {
        let [id, name, value, limit, active, margin, word] = line;
        let row = format!("  {id}  {name}  {value}  {limit}  {active}  {margin}  ");
        page.spans(&[(&row).into(), Page::toned(word.trim_end(), Tone::Of(check.verdict()))]);
        if let Some(worst) = check.worst.as_ref().filter(|_| check.verdict() > Verdict::Pass) {
            let worst = table::shorten(&format!("worst at {worst} ({})", check.equation), WIDTH - 10);
            page.spans(&["        ".into(), Page::toned(&worst, Tone::Faint)]);
        }
    }
}

fn check_row(check: &Check) -> [String; 7] {
    let [limit, active, margin] = words::limit(check);
    [
        check.id.to_owned(),
        table::shorten(check.name, NAME),
        number::scientific(check.value, 2),
        limit,
        active,
        margin,
        verdict_word(check.verdict()).to_owned(),
    ]
}

fn completeness(page: &mut Page, completeness: &Completeness) {
    let tone = match completeness {
        Completeness::NotCertified { .. } => Verdict::Warn,
        Completeness::SturmCount { .. } if completeness.is_certified() => Verdict::Pass,
        Completeness::SturmCount { .. } => Verdict::Fail,
    };
    page.line("");
    for line in table::wrap(&completeness.statement(), WIDTH - 2) {
        page.spans(&["  ".into(), Page::toned(&line, Tone::Of(tone))]);
    }
}

/// One line for each interval; many slices are cut to the first ones.
fn trust_intervals(page: &mut Page, intervals: &[TrustInterval]) {
    let line = |interval: &TrustInterval| {
        format!(
            "{} to {} Hz · {} counted, {} found · pivot growth {}",
            words::lower_end(interval.from_hz, 4),
            number::quantity(interval.to_hz, 6),
            interval.n_counted,
            interval.n_found,
            number::quantity(interval.pivot_growth, 3)
        )
    };
    listing(page, "counts", &intervals.iter().map(line).collect::<Vec<_>>());
}

fn listing(page: &mut Page, label: &str, lines: &[String]) {
    for line in lines.iter().take(LINES_SHOWN) {
        page.entry(label, line);
    }
    if lines.len() > LINES_SHOWN {
        page.entry("", &format!("… and {} more in the report", lines.len() - LINES_SHOWN));
    }
}
