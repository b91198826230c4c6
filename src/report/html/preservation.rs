//! Shapes, frequencies under other boundaries and static stiffness: reduced against full.

use super::front::{in_words, percent};
use super::markup::{Cell, Figure, Markup, Table};
use super::{mode_table, plot};
use crate::number::{counted, decade, scientific};
use crate::report::words;
use crate::verification::preservation::{BoundaryComparison, FrequencyPair, InterfaceStatics, Preservation};

/// How many frequencies beyond the band are listed.
const BEYOND: usize = 3;

/// Boundaries whose frequencies stand in one table.
const SIDE_BY_SIDE: usize = 4;

/// Significant digits of the highest frequency, and the most decimals.
const DIGITS: i32 = 8;
const DECIMALS: usize = 6;

/// Larger matrices are shown by their diagonal only.
const MATRIX: usize = 6;

pub(super) fn preservation(page: &mut Markup, preservation: &Preservation) {
    for what in &preservation.not_compared {
        page.absent(&format!("Not compared: {what}"));
    }
    page.heading("Shapes");
    if preservation.mac.is_empty() {
        page.absent("The shapes of the reduced model were not compared in this report; M-14 says how well its equations hold for the modes.");
    } else {
        shapes(page, &preservation.mac);
    }
    page.heading("Frequencies under other boundaries");
    if preservation.boundaries.is_empty() {
        page.absent("No other boundary was compared in this report.");
    } else {
        boundaries(page, &preservation.boundaries);
    }
    page.heading("Static stiffness of the interfaces");
    if preservation.statics.is_empty() {
        page.absent("Not compared in this report.");
    } else {
        statics(page, &preservation.statics);
    }
}

fn shapes(page: &mut Markup, mac: &[Vec<f64>]) {
    let diagonal = mac.iter().enumerate().filter_map(|(mode, row)| Some((mode + 1, *row.get(mode)?)));
    let least = diagonal.min_by(|a, b| a.1.total_cmp(&b.1));
    let others = mac.iter().enumerate().flat_map(|(row, values)| {
        values
            .iter()
            .enumerate()
            .filter(move |(column, _)| *column != row)
            .map(move |(column, value)| (row + 1, column + 1, *value))
    });
    let most = others.max_by(|a, b| a.2.total_cmp(&b.2));
    let mut description = String::new();
    if let Some((mode, value)) = least {
        description = format!("The smallest value on the diagonal is {} (mode {mode})", mode_table::mac(value));
    }
    if let Some((row, column, value)) = most {
        description += &format!("; the next largest is {} (modes {row} and {column})", in_words(value, 2));
    }
    description.push('.');
    page.figure(&Figure {
        id: "figure-mac",
        svg: plot::mac(mac),
        title: "Modal assurance criterion".to_owned(),
        caption: format!(
            "{description} Rows are modes of the full model, columns those of the reduced one, compared with the mass as \
             weight: 1 is the same shape. Modes of one repeated frequency may share their shapes in any proportion."
        ),
        description,
    });
}

fn boundaries(page: &mut Markup, boundaries: &[BoundaryComparison]) {
    let worst =
        boundaries.iter().map(|line| format!("{} {}", words::boundary(&line.boundary), percent(line.worst_in_band)));
    let description = format!("Largest differences within the band: {}.", worst.collect::<Vec<_>>().join(", "));
    page.figure(&Figure {
        id: "figure-boundaries",
        svg: plot::boundaries(boundaries),
        title: "Frequencies under other boundaries".to_owned(),
        caption: format!(
            "{description} Away from the boundary of its own modes a reduced model is an approximation, which gets worse with the frequency."
        ),
        description,
    });
    let heads =
        ["boundary", "frequencies in the band", "found of counted", "largest difference"].map(str::to_owned).into();
    let rows = boundaries.iter().map(|line| {
        let n_in_band = line.frequencies.iter().filter(|pair| pair.in_band).count();
        let counted = line.count.map(|count| format!("{} of {}", count.n_found, count.n_counted));
        vec![
            Cell::Head(format!("{}: {}", words::boundary(&line.boundary), line.description)),
            Cell::Number(n_in_band.to_string()),
            Cell::Number(counted.unwrap_or_else(|| "not counted".to_owned())),
            Cell::Number(percent(line.worst_in_band)),
        ]
    });
    let caption =
        "What was done to the component, how many modes of the full model a Sturm count knows of and how many were found, rigid-body motion included (M-06), and how far the reduced model is off within the band.".to_owned();
    page.table(&Table { id: "table-boundaries".to_owned(), caption, heads, rows: rows.collect() });
    pairs(page, boundaries);
}

/// One row for each frequency, two columns for each boundary.
fn pairs(page: &mut Markup, boundaries: &[BoundaryComparison]) {
    let listed = |line: &BoundaryComparison| {
        let n_in_band = line.frequencies.iter().rposition(|pair| pair.in_band).map_or(0, |last| last + 1);
        line.frequencies.len().min(n_in_band + BEYOND)
    };
    for (part, group) in boundaries.chunks(SIDE_BY_SIDE).enumerate() {
        let highest = group.iter().flat_map(|line| &line.frequencies).map(|pair| pair.full_hz).fold(0.0, f64::max);
        let decimals = usize::try_from(DIGITS - 1 - decade(highest)).unwrap_or(0).min(DECIMALS);
        let mut heads = vec!["number".to_owned()];
        heads.extend(
            group.iter().flat_map(|line| [format!("{}, Hz", words::boundary(&line.boundary)), "difference".to_owned()]),
        );
        let rows = (0..group.iter().map(listed).max().unwrap_or(0)).map(|number| {
            let mut row = vec![Cell::Head((number + 1).to_string())];
            for line in group {
                let shown = line.frequencies.get(number).filter(|_| number < listed(line));
                let [full, difference] = shown.map_or_else(Default::default, |pair| pair_cells(pair, decimals));
                row.extend([Cell::Number(full), Cell::Number(difference)]);
            }
            row
        });
        let is_beyond =
            |line: &BoundaryComparison| line.frequencies.iter().take(listed(line)).any(|pair| !pair.in_band);
        let beyond = if group.iter().any(is_beyond) {
            format!(" and the next {BEYOND}, whose differences stand in parentheses")
        } else {
            String::new()
        };
        let caption = format!(
            "Elastic frequencies of the full model under each boundary, with error bars where these exceed the last decimal, and the relative \
             difference of the reduced model: those of the band{beyond}. The JSON report has all that were computed."
        );
        let id = format!("table-pairs-{}", part + 1);
        page.table(&Table { id, caption, heads, rows: rows.collect() });
    }
}

fn pair_cells(pair: &FrequencyPair, decimals: usize) -> [String; 2] {
    let difference = scientific(pair.relative_difference, 2);
    let difference = if pair.in_band { difference } else { format!("({difference})") };
    [words::full_frequency(pair, decimals), difference]
}

fn statics(page: &mut Markup, statics: &[InterfaceStatics]) {
    page.paragraph(
        "Each interface is displaced while the others are held. The force it takes, in the full and in the reduced model, \
         must be the same whatever the number of modes.",
    );
    let heads = ["interface", "dof", "full", "reduced", "largest difference"].map(str::to_owned).into();
    let mut rows = Vec::new();
    for interface in statics {
        for (dof, label) in interface.dofs.iter().enumerate() {
            let entry = |matrix: &[Vec<f64>]| {
                Cell::Number(matrix.get(dof).and_then(|row| row.get(dof)).map_or("–".to_owned(), |k| scientific(*k, 8)))
            };
            let difference = if dof == 0 { scientific(interface.relative_difference, 2) } else { String::new() };
            rows.push(vec![
                Cell::Head(interface.interface.clone()),
                Cell::Text(label.clone()),
                entry(&interface.full),
                entry(&interface.reduced),
                Cell::Number(difference),
            ]);
        }
    }
    let caption = "Static stiffness along each interface coordinate. The difference is the largest over all pairs of \
                   coordinates of the interface, relative to the stiffness before condensation."
        .to_owned();
    page.table(&Table { id: "table-statics".to_owned(), caption, heads, rows });
    let is_small = |interface: &&InterfaceStatics| (2..=MATRIX).contains(&interface.dofs.len());
    let shown: Vec<&InterfaceStatics> = statics.iter().filter(is_small).collect();
    if !shown.is_empty() {
        matrices(page, &shown);
    }
    let n_hidden = statics.len() - shown.len();
    if n_hidden > 0 {
        page.paragraph(&format!(
            "The whole matrices of {} with one or with more than {MATRIX} coordinates are in the JSON report only.",
            counted(n_hidden, "interface", "interfaces")
        ));
    }
}

fn matrices(page: &mut Markup, statics: &[&InterfaceStatics]) {
    let n_columns = statics.iter().map(|interface| interface.dofs.len()).max().unwrap_or(0);
    let numbers = (1..=n_columns).map(|column| column.to_string());
    let heads = ["interface".to_owned(), "dof".to_owned()].into_iter().chain(numbers).collect();
    let mut rows = Vec::new();
    for interface in statics {
        for (label, values) in interface.dofs.iter().zip(&interface.reduced) {
            let mut cells = vec![Cell::Head(interface.interface.clone()), Cell::Text(label.clone())];
            cells.extend(values.iter().map(|value| Cell::Number(scientific(*value, 4))));
            cells.resize_with(n_columns + 2, || Cell::Number(String::new()));
            rows.push(cells);
        }
    }
    let caption =
        "Static stiffness matrix of the reduced model at each interface; columns in the order of the rows.".to_owned();
    page.table(&Table { id: "table-statics-matrix".to_owned(), caption, heads, rows });
}
