//! The job that reduces an exported superelement again, as it is: its interfaces, its method, its modes.
//!
//! ```text
//! Q    r × n_r    rigid-body modes of the superelement, M̂-orthonormal combinations of Û
//! ```
//! K̂ was condensed from a stiffness that is larger by orders, and its entries carry the rounding of that one. So K̂ Q is not zero
//! to the last digit of K̂, and the job states as many digits as K̂ Q shows: taken for exact, the zero eigenvalues of K̂
//! would be negative or elastic.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use faer::Mat;
use supel_runtime::{Coordinate, Flag, InterfaceNode, Metadata, Method, Superelement};
use toml::Value;

use super::names::Names;
use crate::dense;
use crate::error::Result;

/// Digits of K̂ below which a second reduction cannot tell stiffness from rounding.
const FEWEST_DIGITS: i64 = 4;

/// The job, TOML; `labels` are those of the interface nodes. Without an interface there is nothing to reduce a superelement to, and an
/// interface that just holds its component has no stiffness but rounding. A mass that is singular by its method is that of no model, and
/// internal forces of a preloaded component are not in its file.
pub(super) fn job(superelement: &Superelement, labels: &[i64], names: &Names) -> Result<Option<String>> {
    let digits = digits(superelement)?;
    let is_rigid = superelement.n_rigid() >= superelement.n_coordinates();
    let is_marked = |flag: &Flag| matches!(flag, Flag::SingularMass | Flag::Preloaded);
    if superelement.n_interface() == 0
        || is_rigid
        || superelement.metadata().flags.iter().any(is_marked)
        || digits.is_some_and(|digits| digits < FEWEST_DIGITS)
    {
        return Ok(None);
    }
    let metadata = superelement.metadata();
    let mut text = String::from("[model]\n");
    let mut put = |key: &str, value: Value| {
        let _ = writeln!(text, "{key} = {value}");
    };
    put("stiffness", names.name("stiffness.mtx").into());
    put("mass", names.name("mass.mtx").into());
    if !labels.is_empty() {
        put("dofs", names.name("dofs.csv").into());
        put("nodes", names.name("nodes.csv").into());
    }
    metadata.units.iter().for_each(|units| put("units", units.clone().into()));
    let held = metadata.job["model"]["held_rotations"].as_array().into_iter().flatten();
    let held: Vec<&str> = held.filter_map(|direction| direction.as_str()).collect();
    if !held.is_empty() {
        put("held_rotations", held.into());
    }
    digits.into_iter().for_each(|digits| put("stiffness_digits", digits.into()));
    text += &interfaces(superelement, labels);
    text += &loads(superelement, names);
    text += &reduction(superelement);
    let _ = write!(text, "\n[write]\nsuperelement = {}\n", Value::from(names.name("again.supel")));
    Ok(Some(text))
}

/// The digits that K̂ has by its rigid-body motion; nothing where it has none or all.
///
/// Half a unit of the last of d digits, 0.5·10^(1−d), is at least [`MARGIN`] times the largest ‖K̂q‖ / ‖|K̂||q|‖.
fn digits(superelement: &Superelement) -> Result<Option<i64>> {
    /// Combinations of the columns of Q, in which more cancels, do worse than each.
    const MARGIN: f64 = 10.0;
    /// As many identify almost every double, and reading takes them for all.
    const ALL: f64 = 16.0;
    let tensors = superelement.tensors();
    let [k, m, u] = [&tensors.stiffness, &tensors.mass, &tensors.rigid_body_modes].map(dense::unpacked);
    if u.ncols() == 0 {
        return Ok(None);
    }
    let mut modal_mass = dense::gram(u.as_ref(), dense::product(m.as_ref(), u.as_ref()).as_ref());
    dense::symmetrise(&mut modal_mass);
    let (masses, directions) = dense::symmetric_eigen(modal_mass.as_ref())?;
    let massive: Vec<usize> = (0..masses.len()).filter(|j| masses[*j] > 0.0).collect();
    let unit =
        Mat::from_fn(masses.len(), massive.len(), |i, j| directions[(i, massive[j])] / masses[massive[j]].sqrt());
    let q = dense::product(u.as_ref(), unit.as_ref());
    let forces = dense::product(k.as_ref(), q.as_ref());
    let terms = dense::product(dense::absolute(k.as_ref()).as_ref(), dense::absolute(q.as_ref()).as_ref());
    let norm = |a: &Mat<f64>, j: usize| dense::norm(dense::column(a.as_ref(), j));
    let residuals = (0..q.ncols()).filter(|j| norm(&terms, *j) > 0.0).map(|j| norm(&forces, j) / norm(&terms, j));
    let digits = (1.0 - (2.0 * MARGIN * residuals.fold(0.0, f64::max)).log10()).floor();
    Ok((digits < ALL).then_some(digits.max(1.0) as i64))
}

/// One table for each interface; rows where there are no nodes.
fn interfaces(superelement: &Superelement, labels: &[i64]) -> String {
    let mut text = String::new();
    let mut put = |name: &str, nodes: String, dofs: Option<String>| {
        let _ = write!(text, "\n[[interface]]\nname = {}\nnodes = {nodes}\n", Value::from(name));
        dofs.iter().for_each(|dofs| {
            let _ = writeln!(text, "dofs = {dofs}");
        });
    };
    let nodes = &superelement.metadata().interface_nodes;
    if nodes.is_empty() && superelement.n_interface() > 0 {
        let rows: Vec<i64> = (0..superelement.n_interface() as i64).collect();
        put("interface", format!("{{ rows = {} }}", Value::from(rows)), None);
    }
    let mut first = 0;
    while first < nodes.len() {
        let n = nodes[first..].iter().take_while(|node| node.name == nodes[first].name).count();
        let of_interface = &labels[first..first + n];
        // A node of two interfaces has dofs of both.
        let is_shared = of_interface.iter().any(|label| labels.iter().filter(|other| *other == label).count() > 1);
        let dofs = is_shared.then(|| directions(&nodes[first]));
        put(&nodes[first].name, Value::from(of_interface.to_vec()).to_string(), dofs);
        first += n;
    }
    text
}

/// One table for each load; a residual vector where the superelement has one.
fn loads(superelement: &Superelement, names: &Names) -> String {
    let metadata = superelement.metadata();
    let mut text = String::new();
    for (column, name) in metadata.load_names.iter().enumerate() {
        let is_its_own =
            |coordinate: &Coordinate| matches!(coordinate, Coordinate::ResidualVector { load } if *load == column);
        let residual = metadata.named_columns().any(is_its_own);
        let (name, file) = (Value::from(name.clone()), Value::from(names.name("loads.mtx")));
        let _ = write!(text, "\n[[load]]\nname = {name}\nfile = {file}\ncolumn = {column}\nresidual = {residual}\n");
    }
    text
}

fn directions(node: &InterfaceNode) -> String {
    Value::from(node.dofs.iter().map(ToString::to_string).collect::<Vec<_>>()).to_string()
}

/// Directions of interfaces that were held while the modes were computed: of a direction all nodes of an interface are held, or none.
fn held(metadata: &Metadata) -> Vec<String> {
    let of = |held: &usize| match &metadata.coordinates[*held] {
        Coordinate::Interface { node, direction } => {
            Some(format!("{}.{direction}", metadata.interface_nodes[*node].name))
        }
        _ => None,
    };
    let names: BTreeSet<String> = metadata.modes_held.iter().filter_map(of).collect();
    names.into_iter().collect()
}

fn reduction(superelement: &Superelement) -> String {
    let metadata = superelement.metadata();
    // Modes that were left out because others span them are found again, as far as there are coordinates for them.
    let is_mode = |coordinate: &&Coordinate| {
        coordinate.mode().is_some() || matches!(coordinate, Coordinate::ExpansionMode { .. })
    };
    let n_named = metadata.named_columns().filter(is_mode).count();
    let n_still = match metadata.method {
        Method::Herting | Method::Rubin | Method::Macneal => superelement.n_rigid(),
        Method::CraigBampton | Method::ModeAcceleration | Method::MixedInterface | Method::Guyan => {
            superelement.n_interface()
        }
    };
    let n_modes = n_named.min(superelement.n_coordinates().saturating_sub(n_still));
    let has_relief =
        metadata.coordinates.iter().any(|coordinate| matches!(coordinate, Coordinate::InertiaRelief { .. }));
    let (method, is_relief_asked) = match metadata.method {
        Method::MixedInterface if n_modes > 0 && !metadata.interface_nodes.is_empty() => {
            ("mixed-interface", has_relief)
        }
        // Rows of one interface cannot be held in part.
        Method::CraigBampton | Method::ModeAcceleration | Method::MixedInterface if n_modes > 0 => {
            ("craig-bampton", has_relief)
        }
        Method::CraigBampton | Method::ModeAcceleration | Method::MixedInterface | Method::Guyan => {
            ("guyan", has_relief)
        }
        // A file of Rubin's method is in Herting's coordinates.
        Method::Herting | Method::Rubin | Method::Macneal => ("herting", false),
    };
    let mut text = format!("\n[reduction]\nmethod = \"{method}\"\n");
    if method != "guyan" {
        let _ = writeln!(text, "modes = {{ count = {} }}", n_modes);
    }
    if is_relief_asked {
        text += "inertia_relief = true\n";
    }
    if method == "mixed-interface" {
        let _ = writeln!(text, "held = {}", Value::from(held(metadata)));
    }
    text
}
