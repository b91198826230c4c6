//! What a superelement file says of itself, as text for people.

use std::collections::BTreeSet;

use supel_runtime::{CheckSummary, Coordinate, Direction, FORMAT_VERSION, Flag, InterfaceNode, Metadata, Superelement};

use super::mode_table::{Mode, mode_table};
use super::page::{Page, Paint, Tone, verdict_word};
use super::summary::body;
use super::table::{self, Align};
use super::words;
use crate::job::unseen_hz;
use crate::number;
use crate::report::MassProperties;
use crate::verification::check::Verdict;

/// Text about `superelement`, whose file has `file_bytes` bytes.
pub fn inspection(superelement: &Superelement, file_bytes: u64, paint: Paint) -> String {
    let mut page = Page::new(paint);
    head(&mut page, superelement, file_bytes);
    model(&mut page, superelement);
    page.heading("Interface");
    interface(&mut page, &superelement.metadata().interface_nodes);
    page.heading("Modes");
    modes(&mut page, superelement);
    page.heading("Checks");
    checks(&mut page, superelement);
    page.into_text()
}

fn head(page: &mut Page, superelement: &Superelement, file_bytes: u64) {
    let metadata = superelement.metadata();
    let title = format!("superelement · {} · {} coordinates", metadata.method.name(), superelement.n_coordinates());
    page.line(Page::toned(&title, Tone::Heading));
    let generator = &metadata.generator;
    let made_by = format!("{} {} · format version {FORMAT_VERSION}", generator.name, generator.version);
    page.entry("made by", &made_by);
    page.entry("size", &number::bytes(file_bytes));
    let sizes = format!("{} interface + {} modal", superelement.n_interface(), superelement.n_modal());
    page.entry("coordinates", &format!("{} = {sizes}", superelement.n_coordinates()));
    page.entry("rigid body", &number::counted(superelement.n_rigid(), "mode", "modes"));
    let tensors = superelement.tensors();
    let optional = [
        ("damping", tensors.damping.is_some()),
        ("mixing", tensors.mixing.is_some()),
        ("gravity", tensors.gravity.is_some()),
        ("load vectors", tensors.load_vectors.is_some()),
        ("recovery", tensors.recovery.is_some()),
        ("quantities", tensors.quantities.is_some()),
    ];
    let present: Vec<&str> = optional.into_iter().filter(|(_, is_present)| *is_present).map(|(name, _)| name).collect();
    if !present.is_empty() {
        page.entry("also holds", &present.join(", "));
    }
    for matrix in &metadata.matrices {
        page.entry("matrix", &format!("{}, {}", matrix.name, matrix.kind));
    }
    for (at, name) in metadata.load_names.iter().enumerate() {
        let is_its = |coordinate: &Coordinate| *coordinate == Coordinate::ResidualVector { load: at };
        let has_residual_vector = metadata.coordinates.iter().any(is_its);
        page.entry("load", &format!("{name}{}", if has_residual_vector { ", with its residual vector" } else { "" }));
    }
    for assumption in &metadata.validity.assumptions {
        page.entry("assumes", assumption);
    }
    for flag in &metadata.flags {
        let text = match flag {
            Flag::SingularMass => "the mass matrix is semidefinite and cannot be factored",
            Flag::StiffnessOnly => "for statics alone: no mass, no modes",
            Flag::Preloaded => "preloaded: translations alone are free, for small rotations in linear analyses",
        };
        page.entry("note", text);
    }
}

fn model(page: &mut Page, superelement: &Superelement) {
    let metadata = superelement.metadata();
    page.heading("Model");
    let units = metadata.units.as_ref().map(|units| format!(" · units {units}")).unwrap_or_default();
    page.entry("model", &(number::counted(metadata.model.n_dofs, "dof", "dofs") + &units));
    if let Some(properties) = &metadata.model.mass_properties {
        let properties = MassProperties {
            mass: Some(properties.mass),
            cg: Some(properties.center_of_mass),
            inertia: Some(properties.inertia),
        };
        body::mass_properties(page, &properties);
    }
    for (role, digest) in &metadata.inputs {
        page.entry(words::file(role), &format!("blake3 {digest}"));
    }
}

fn interface(page: &mut Page, nodes: &[InterfaceNode]) {
    let rows: Vec<[String; 4]> = nodes
        .iter()
        .map(|node| {
            let label = node.label.map(|label| format!("node {label}")).unwrap_or_default();
            let dofs: Vec<String> = node.dofs.iter().map(|dof| format!("{dof:?}").to_lowercase()).collect();
            let position = node.position.map(|coordinate| number::quantity(coordinate, 5)).join(", ");
            [node.name.clone(), label, dofs.join(" "), format!("({position})")]
        })
        .collect();
    for row in table::columns(&rows, [Align::Left; 4]) {
        page.line(&format!("  {}", row.join("  ")));
    }
}

fn modes(page: &mut Page, superelement: &Superelement) {
    let metadata = superelement.metadata();
    let bar = |mode_idx: usize| {
        let named =
            metadata.coordinates.iter().find(|coordinate| coordinate.mode().is_some_and(|(mode, _)| mode == mode_idx));
        named.and_then(Coordinate::error_bar_hz)
    };
    let frequencies = &superelement.tensors().frequencies;
    page.entry("frequencies", &frequencies.len().to_string());
    if !metadata.modes_held.is_empty() {
        page.entry("held", &format!("{} while modes were computed", held(metadata)));
    }
    for dropped in &metadata.dropped {
        page.entry("left out", &format!("{}: {}", column(&dropped.column, &metadata.load_names), dropped.reason));
    }
    // What its own reduction left out stands above.
    let all = unseen_hz(superelement);
    let of_model = &all[..all.len() - metadata.unseen_modes().count()];
    if let Some(lowest) = of_model.iter().copied().reduce(f64::min) {
        let n = number::counted(of_model.len(), "mode", "modes");
        let text = format!("{n} that nothing starts or sees, the lowest at {} Hz", number::quantity(lowest, 7));
        page.entry("model lacks", &text);
    }
    let rows: Vec<Mode> = frequencies
        .iter()
        .enumerate()
        .map(|(mode_idx, omega)| Mode {
            number: mode_idx + 1,
            frequency_hz: omega / std::f64::consts::TAU,
            error_bar_hz: bar(mode_idx),
        })
        .collect();
    mode_table(page, &rows);
}

/// What was held while modes were computed, interface by interface: `base ux uy uz, tip uz`; of bare rows their number.
fn held(metadata: &Metadata) -> String {
    let mut of_interfaces: Vec<(&str, BTreeSet<Direction>)> = Vec::new();
    for at in &metadata.modes_held {
        let Coordinate::Interface { node, direction } = metadata.coordinates[*at] else {
            return number::counted(metadata.modes_held.len() as u64, "row", "rows");
        };
        let name = metadata.interface_nodes[node].name.as_str();
        match of_interfaces.last_mut() {
            Some((last, directions)) if *last == name => {
                directions.insert(direction);
            }
            _ => of_interfaces.push((name, BTreeSet::from([direction]))),
        }
    }
    let words = |(name, directions): &(&str, BTreeSet<Direction>)| {
        let directions: Vec<String> = directions.iter().map(ToString::to_string).collect();
        format!("{name} {}", directions.join(" "))
    };
    of_interfaces.iter().map(words).collect::<Vec<_>>().join(", ")
}

fn column(column: &Coordinate, load_names: &[String]) -> String {
    match column {
        Coordinate::Interface { node, .. } => format!("interface node {node}"),
        Coordinate::InterfaceRow { row } => format!("row {row}"),
        mode => mode.mode_name(load_names).unwrap_or_default(),
    }
}

fn checks(page: &mut Page, superelement: &Superelement) {
    let verification = &superelement.metadata().verification;
    let row = |check: &CheckSummary| {
        let value = check.value.map_or_else(|| "NaN".to_owned(), |value| number::scientific(value, 2));
        [check.id.clone(), value, "limit".to_owned(), number::scientific(check.limit, 1)]
    };
    let rows: Vec<[String; 4]> = verification.checks.iter().map(row).collect();
    let align = [Align::Left, Align::Right, Align::Left, Align::Right];
    for (row, check) in table::columns(&rows, align).iter().zip(&verification.checks) {
        let verdict = own(check.verdict);
        let word = Page::toned(verdict_word(verdict), Tone::Of(verdict));
        page.spans(&["  ".into(), (&row.join("  ")).into(), "  ".into(), word]);
    }
    let verdict = own(verification.verdict);
    let word = Page::toned(verdict_word(verdict), Tone::Of(verdict));
    page.line("");
    page.spans(&[word, " – as recorded when the file was made".into()]);
}

fn own(verdict: supel_runtime::Verdict) -> Verdict {
    match verdict {
        supel_runtime::Verdict::Pass => Verdict::Pass,
        supel_runtime::Verdict::Warn => Verdict::Warn,
        supel_runtime::Verdict::Fail => Verdict::Fail,
    }
}
