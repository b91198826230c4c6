//! Mass properties by several routes, rigid-body frequencies, grounding, effective mass.

use super::front::in_words;
use super::markup::{Cell, Figure, Markup, Table};
use super::plot;
use crate::number::{counted, quantity, scientific};
use crate::report::{EffectiveMass, Grounding, MassProperties, MassRoute, ReportBody};

/// Digits that show where two routes part.
const DIGITS: usize = 8;

/// A mode that carries less than this of every direction is not listed.
const LISTED_FROM: f64 = 0.01;

/// So many modes are listed, those that carry most of some direction.
const LISTED: usize = 16;

pub(super) fn rigid_body(page: &mut Markup, body: &ReportBody) {
    let evidence = &body.rigid_body;
    page.heading("Mass, centre and inertia");
    let known = &body.model.mass_properties;
    if !evidence.mass_routes.is_empty() {
        mass(page, &evidence.mass_routes);
    } else if *known != MassProperties::default() {
        mass(page, &[MassRoute { route: "full model", properties: known.clone() }]);
    } else {
        page.absent("Not known: mass properties need one body with coordinates, free to move in all six directions but for supports of the job.");
    }
    page.heading("Frequencies of rigid-body motion");
    frequencies(page, body);
    page.heading("Grounding");
    if evidence.grounding.is_empty() {
        page.absent("Not listed by direction in this report; M-05 holds the worst value where the component is free.");
    } else {
        grounding(page, &evidence.grounding);
    }
    page.heading("Effective mass");
    if evidence.effective_mass.is_empty() {
        page.absent("Not in this report: it needs retained modes and known rigid directions.");
    } else {
        effective_mass(page, &evidence.effective_mass, &evidence.grounding);
    }
}

fn mass(page: &mut Markup, routes: &[MassRoute]) {
    let name = |route: &MassRoute| match route.route {
        "geometry" => "from the coordinates".to_owned(),
        "stiffness" => "through the reduced stiffness".to_owned(),
        "eigenvectors" => "from the zero modes".to_owned(),
        "expected" => "expected by the job".to_owned(),
        other => other.to_owned(),
    };
    let heads = ["quantity".to_owned()].into_iter().chain(routes.iter().map(name)).collect();
    let rows = quantities().into_iter().filter_map(|(label, group, of)| {
        let values: Vec<Option<f64>> = routes.iter().map(|route| of(&route.properties)).collect();
        values.iter().any(Option::is_some).then(|| {
            let cells = values.iter().zip(routes).map(|(value, route)| {
                Cell::Number(value.map_or("–".to_owned(), |value| rounded(value, group(&route.properties))))
            });
            std::iter::once(Cell::Head(label.to_owned())).chain(cells).collect()
        })
    });
    let caption =
        "Mass properties by independent routes, in the units of the model; inertia about the centre of mass. \
                   A value that is only rounding compared with its neighbours is shown as 0."
            .to_owned();
    page.table(&Table { id: "table-mass".to_owned(), caption, heads, rows: rows.collect() });
}

type Value = Box<dyn Fn(&MassProperties) -> Option<f64>>;
type Size = fn(&MassProperties) -> f64;

/// Label, largest value of the group, and the value itself.
fn quantities() -> Vec<(&'static str, Size, Value)> {
    let largest_cg: Size = |known| known.cg.iter().flatten().fold(0.0, |size, value| size.max(value.abs()));
    let largest_inertia: Size =
        |known| known.inertia.iter().flatten().flatten().fold(0.0, |size, value| size.max(value.abs()));
    let mut rows: Vec<(&'static str, Size, Value)> = vec![("mass", |_| 0.0, Box::new(|known| known.mass))];
    for (axis, label) in ["centre x", "centre y", "centre z"].into_iter().enumerate() {
        rows.push((label, largest_cg, Box::new(move |known| Some(known.cg?[axis]))));
    }
    let terms = [("xx", 0, 0), ("yy", 1, 1), ("zz", 2, 2), ("xy", 0, 1), ("xz", 0, 2), ("yz", 1, 2)];
    let labels = ["inertia xx", "inertia yy", "inertia zz", "inertia xy", "inertia xz", "inertia yz"];
    for (label, (_, row, column)) in labels.into_iter().zip(terms) {
        rows.push((label, largest_inertia, Box::new(move |known| Some(known.inertia?[row][column]))));
    }
    rows
}

fn rounded(value: f64, size: f64) -> String {
    if value.abs() <= 1e-12 * size { "0".to_owned() } else { quantity(value, DIGITS) }
}

fn frequencies(page: &mut Markup, body: &ReportBody) {
    let rigid = &body.rigid_body.frequencies_hz;
    if rigid.is_empty() {
        page.absent(match body.model.rigid_body_modes.count {
            0 => "None: the component is restrained.",
            _ => "Not in this report; M-12 says how exactly the reduced stiffness lets rigid-body motion pass.",
        });
        return;
    }
    let highest = rigid.iter().copied().fold(0.0, f64::max);
    let mut caption = "Frequencies of the rigid-body modes of the reduced model: zero but for rounding".to_owned();
    match body.reduction.modes.first() {
        Some(first) => caption.push_str(&format!(
            "; the largest is {} of the first elastic frequency, {} Hz.",
            in_words(highest / first.frequency_hz, 2),
            quantity(first.frequency_hz, 6)
        )),
        None => caption.push('.'),
    }
    let heads = std::iter::once("mode".to_owned()).chain((1..=rigid.len()).map(|mode| mode.to_string()));
    let cells = rigid.iter().map(|frequency| Cell::Number(scientific(*frequency, 2)));
    let row = std::iter::once(Cell::Head("frequency, Hz".to_owned())).chain(cells);
    page.table(&Table { id: "table-rigid".to_owned(), caption, heads: heads.collect(), rows: vec![row.collect()] });
}

fn grounding(page: &mut Markup, grounding: &[Grounding]) {
    let heads = ["direction", "energy ratio", "force ratio", "largest force at"].map(str::to_owned).into();
    let rows = grounding.iter().map(|line| {
        vec![
            Cell::Head(line.direction.clone()),
            Cell::Number(scientific(line.energy_ratio, 2)),
            Cell::Number(scientific(line.force_ratio, 2)),
            Cell::Text(line.worst.clone().unwrap_or_else(|| "–".to_owned())),
        ]
    });
    let caption = "Strain energy of each rigid-body motion of the full model, relative to that of the first elastic mode, \
                   and its largest force, relative to the forces that cancel there. Both are rounding where nothing ties \
                   the component to the ground."
        .to_owned();
    page.table(&Table { id: "table-grounding".to_owned(), caption, heads, rows: rows.collect() });
}

fn effective_mass(page: &mut Markup, modes: &[EffectiveMass], grounding: &[Grounding]) {
    let n_directions = modes.iter().map(|mode| mode.cumulated.len()).max().unwrap_or(0);
    let directions: Vec<String> = (0..n_directions)
        .map(|direction| match grounding.get(direction) {
            Some(line) if grounding.len() == n_directions => line.direction.clone(),
            _ => format!("direction {}", direction + 1),
        })
        .collect();
    let Some(last) = modes.last() else { return };
    let totals: Vec<String> = directions
        .iter()
        .zip(&last.cumulated)
        .map(|(direction, sum)| format!("{direction} {}", quantity(sum * 100.0, 3) + " %"))
        .collect();
    page.figure(&Figure {
        id: "figure-effective-mass",
        svg: plot::effective_mass(modes, &directions),
        title: "Effective mass, summed over the modes".to_owned(),
        description: format!("The sums over all {} are: {}.", counted(modes.len(), "mode", "modes"), totals.join(", ")),
        caption: "Modes of the reduced model with its interface held, ascending in frequency. What is missing to 1 is set in \
                  motion by modes that were not kept."
            .to_owned(),
    });
    let heads = ["mode".to_owned()].into_iter().chain(directions.iter().cloned()).collect();
    let line = |label: String, values: &[f64]| -> Vec<Cell> {
        let cells = values.iter().map(|share| Cell::Number(format!("{:.2}", share * 100.0)));
        std::iter::once(Cell::Head(label)).chain(cells).collect()
    };
    let largest = |mode: &EffectiveMass| mode.share.iter().copied().fold(0.0, f64::max);
    let mut listed: Vec<&EffectiveMass> = modes.iter().filter(|mode| largest(mode) >= LISTED_FROM).collect();
    listed.sort_by(|a, b| largest(b).total_cmp(&largest(a)));
    listed.truncate(LISTED);
    listed.sort_by_key(|mode| mode.mode);
    let mut rows: Vec<Vec<Cell>> = listed.iter().map(|mode| line(mode.mode.to_string(), &mode.share)).collect();
    rows.push(line("all".to_owned(), &last.cumulated));
    let caption = format!(
        "Effective mass in percent of the total: the modes that carry most, up to {LISTED} with one percent or more in some \
         direction, and the sum over all modes."
    );
    page.table(&Table { id: "table-effective-mass".to_owned(), caption, heads, rows });
}
