//! The text of a job that reduces a model made of superelements, exported or as it is.

use std::fmt::Write as _;

use toml::Value;

use super::names::Names;
use crate::job::{AssumesJob, Mechanisms};
use crate::report::printable;

/// What a job says of the files of a model that stand next to it.
#[derive(Clone, Debug)]
pub(super) struct JobText {
    /// Comments at its head, a line each.
    pub(super) remarks: Vec<String>,
    pub(super) map: Map,
    pub(super) mass: Mass,
    pub(super) units: Option<String>,
    /// Directions of rotations that supports hold alone.
    pub(super) held_rotations: Vec<String>,
    pub(super) mechanisms: Mechanisms,
    pub(super) digits: Option<i64>,
    /// What the superelements take for granted.
    pub(super) assumes: AssumesJob,
    pub(super) interfaces: Vec<Selection>,
    pub(super) fixed: Vec<Selection>,
    pub(super) loads: Vec<LoadColumn>,
    pub(super) method: &'static str,
    /// None where the method has no modes.
    pub(super) modes: Option<Modes>,
    pub(super) relief: Relief,
    /// What is held while the modes of mixed boundaries are computed.
    pub(super) held: Option<Vec<String>>,
}

/// Names of the files of a model next to its job, and of the superelement that the job makes of it.
#[derive(Clone, Debug)]
pub(super) struct ModelFiles {
    stiffness: String,
    mass: String,
    dofs: String,
    nodes: String,
    loads: String,
    superelement: String,
}

impl ModelFiles {
    /// The files that an export writes.
    pub(super) fn exported(names: &Names) -> Self {
        Self {
            stiffness: names.name("stiffness.mtx"),
            mass: names.name("mass.mtx"),
            dofs: names.name("dofs.csv"),
            nodes: names.name("nodes.csv"),
            loads: names.name("loads.mtx"),
            superelement: names.name("again.supel"),
        }
    }

    /// One superelement in the place of all of them.
    pub(super) fn of_superelement(file: &str, names: &Names) -> Self {
        let [stiffness, mass, dofs, nodes, loads] = std::array::from_fn(|_| file.to_owned());
        Self { stiffness, mass, dofs, nodes, loads, superelement: names.name("again.supel") }
    }
}

/// Whether the model has a dof map and nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Map {
    Nodes,
    Rows,
}

/// Whether the model has a mass; statics are all that is asked of one that has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mass {
    InFile,
    None,
}

/// Whether the job asks for inertia relief.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Relief {
    Asked,
    NotAsked,
}

/// An interface, or dofs that are held.
#[derive(Clone, Debug)]
pub(super) struct Selection {
    pub(super) name: String,
    /// Labels of nodes, or a table of rows.
    pub(super) nodes: Value,
    /// Directions; none for all that the nodes have.
    pub(super) dofs: Option<Vec<String>>,
}

/// A column of the file of load vectors.
#[derive(Clone, Debug)]
pub(super) struct LoadColumn {
    pub(super) name: String,
    /// Whether it is to have a residual vector.
    pub(super) residual: bool,
}

/// How many modes a job keeps.
#[derive(Clone, Copy, Debug)]
pub(super) enum Modes {
    Count(usize),
    UpTo(f64),
}

/// The rows of a model as a selection of nodes.
pub(super) fn rows(rows: impl IntoIterator<Item = usize>) -> Value {
    let rows: Vec<Value> = rows.into_iter().map(|row| Value::from(row as i64)).collect();
    Value::Table([("rows".to_owned(), Value::Array(rows))].into_iter().collect())
}

impl JobText {
    /// The job, TOML.
    pub(super) fn render(&self, files: &ModelFiles) -> String {
        let mut text: String = self.remarks.iter().map(|remark| format!("# {}\n", printable(remark))).collect();
        text += "[model]\n";
        let mut put = |key: &str, value: Value| {
            let _ = writeln!(text, "{key} = {value}");
        };
        put("stiffness", files.stiffness.clone().into());
        if self.mass == Mass::InFile {
            put("mass", files.mass.clone().into());
        }
        if self.map == Map::Nodes {
            put("dofs", files.dofs.clone().into());
            put("nodes", files.nodes.clone().into());
        }
        self.units.iter().for_each(|units| put("units", units.clone().into()));
        if !self.held_rotations.is_empty() {
            put("held_rotations", self.held_rotations.clone().into());
        }
        if self.mechanisms == Mechanisms::Accept {
            put("mechanisms", "accept".into());
        }
        self.digits.into_iter().for_each(|digits| put("stiffness_digits", digits.into()));
        // Strings and numbers are always TOML.
        let assumes = Some(&self.assumes).filter(|assumes| **assumes != AssumesJob::default());
        assumes
            .and_then(|assumes| Value::try_from(assumes).ok())
            .into_iter()
            .for_each(|assumes| put("assumes", assumes));
        self.interfaces.iter().for_each(|selection| text += &selection.render("interface"));
        self.fixed.iter().for_each(|selection| text += &selection.render("fixed"));
        for (column, LoadColumn { name, residual }) in self.loads.iter().enumerate() {
            let (name, file) = (Value::from(name.clone()), Value::from(files.loads.clone()));
            let _ =
                write!(text, "\n[[load]]\nname = {name}\nfile = {file}\ncolumn = {column}\nresidual = {residual}\n");
        }
        text += &self.reduction();
        if self.mass == Mass::None {
            text += "\n[scene]\nanalysis = \"static\"\ngravity = false\n";
        }
        let _ = write!(text, "\n[write]\nsuperelement = {}\n", Value::from(files.superelement.clone()));
        text
    }

    fn reduction(&self) -> String {
        let mut text = format!("\n[reduction]\nmethod = \"{}\"\n", self.method);
        let _ = match self.modes {
            Some(Modes::Count(count)) => writeln!(text, "modes = {{ count = {count} }}"),
            Some(Modes::UpTo(hz)) => writeln!(text, "modes = {{ up_to_hz = {} }}", Value::from(hz)),
            None => Ok(()),
        };
        if self.relief == Relief::Asked {
            text += "inertia_relief = true\n";
        }
        if let Some(held) = &self.held {
            let _ = writeln!(text, "held = {}", Value::from(held.clone()));
        }
        text
    }
}

impl Selection {
    fn render(&self, kind: &str) -> String {
        let mut text = format!("\n[[{kind}]]\nname = {}\nnodes = {}\n", Value::from(self.name.clone()), self.nodes);
        self.dofs.iter().for_each(|dofs| {
            let _ = writeln!(text, "dofs = {}", Value::from(dofs.clone()));
        });
        text
    }
}
