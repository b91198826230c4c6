//! Words of messages that several errors share or that take more than a format.

use std::ffi::OsStr;
use std::fmt;
use std::path::Path;

use crate::number::{bytes, counted, quantity};

/// How to go on where a dof map cannot be used.
pub(super) const BY_ROWS: &str = "go on by rows: leave dof map and nodes out and give interfaces as rows from zero, as in reduce --interface hub=rows:0,1,2";

/// How to go on where the digits of a stiffness may be misjudged either way.
pub(super) const STATE_DIGITS: &str = "if its numbers have fewer digits than they are written with (7 in \
    single precision), or are exact (17), say so in model.stiffness_digits of the job";

/// What the scene takes from an interface that reacts too little.
pub(super) fn unloaded_reacts_nothing(unloaded: &[String]) -> String {
    match unloaded {
        [] => String::new(),
        some => {
            format!("by the scene no force acts on {}, which reacts nothing; take that out of it, or ", some.join(", "))
        }
    }
}

/// Where few digits of K hide what is softer than their rounding.
pub(super) const SOFTER_THAN_DIGITS: &str = "; what is softer than the rounding of few digits of the stiffness cannot be \
    told from free: write it with more";

/// What to do where a rigid-body motion about a known axis leaves the interface at rest.
pub(super) const OFF_THE_AXIS: &str = "add interface nodes off that axis, give the nodes rotations, or reduce by the method \
    rubin, which with a mass needs no interface that holds the component, though one that holds its mechanisms";
/// What to do where it is a motion of rows.
pub(super) const ROWS_THAT_MOVE: &str = "add rows to the interface that these motions move, or reduce by the method rubin, which \
    with a mass needs no interface that holds the component, though one that holds its mechanisms; nodes in the job would name the motions";
/// What to do where a node lacks a direction of a mass.
pub(super) const SIX_DOFS: &str = "put the mass on a node with six dofs, as rigid interfaces have";

/// `:12` after a path, where the line is known.
pub(super) struct At(pub(super) Option<usize>);

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.map_or(Ok(()), |line| write!(f, ":{line}"))
    }
}

/// The advice after an unknown key.
pub(super) struct Suggested<'a>(pub(super) &'a Option<String>);

impl fmt::Display for Suggested<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(key) => write!(f, " – did you mean `{key}`?"),
            None => write!(f, " – remove it; the keys are listed in schemas/job.schema.json"),
        }
    }
}

/// A name that looks like the one that is not known.
pub(super) struct Offered<'a>(pub(super) &'a Option<String>);

impl fmt::Display for Offered<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.as_ref().map_or(Ok(()), |name| write!(f, " – did you mean `{name}`?"))
    }
}

/// What was held while a matrix was factored; a component need not have an interface.
pub(crate) fn held_words(boundary: &str) -> &'static str {
    if boundary == "held" { "the interface held" } else { "no interface held" }
}

/// The first part of a path that is not UTF-8.
pub(super) fn not_text(path: &Path) -> &OsStr {
    path.iter().find(|part| part.to_str().is_none()).unwrap_or(path.as_os_str())
}

/// The groups of a file of nodes; a table and some meshes have none.
pub(super) fn groups(known: &[String]) -> String {
    match known {
        [] => "the file of the nodes has no groups, as a table of nodes – list node labels or give a region".to_owned(),
        _ => format!("the mesh has {} – name one of them", listed(known)),
    }
}

/// Names for a message: the first few, and how many more there are.
pub(super) fn listed(names: &[String]) -> String {
    const SHOWN: usize = 12;
    match names.len() {
        0 => "nothing".to_owned(),
        n if n > SHOWN => format!("{} and {} more", names[..SHOWN].join(", "), n - SHOWN),
        _ => names.join(", "),
    }
}

/// What can follow the colon after the name of a file.
pub(super) fn named_matrices(names: &[String]) -> String {
    if names.is_empty() {
        "the file has one matrix without a name – leave the colon and the name out".to_owned()
    } else {
        format!("expected one of {} – give one of these after the colon", listed(names))
    }
}

/// Keys in quotation marks.
pub(super) fn quoted(keys: &[&str]) -> String {
    let keys: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
    if keys.is_empty() { "nothing but a name".to_owned() } else { keys.join(" and ") }
}

/// A column of a file, from zero.
pub(super) fn column_words(column: Option<usize>) -> String {
    column.map_or_else(|| "the only column".to_owned(), |column| format!("column {column}"))
}

/// The place of a line in a file, where it has lines.
pub(super) fn at_line(line: Option<u64>) -> String {
    line.map_or_else(String::new, |line| format!(":{line}"))
}

/// A file before what is wrong with it, where there is one.
pub(super) fn of_file(path: Option<&Path>) -> String {
    path.map_or_else(String::new, |path| format!("{}: ", path.display()))
}

/// The parts of a forecast, the largest first, and what makes that one smaller.
pub(super) fn forecast(
    available: u64,
    [factors, matrices, vectors, program]: [u64; 4],
    in_single: Option<u64>,
) -> String {
    let mut parts = [
        (factors, "factors", "use a weaker run.certify (reduce --certify), which needs fewer factors"),
        (vectors, "vectors", "keep fewer modes or interface dofs"),
        (matrices, "matrices", "reduce a smaller model"),
        (program, "the program itself", "allow it more than the program itself takes"),
    ];
    parts.sort_by_key(|(size, ..)| std::cmp::Reverse(*size));
    let needed = parts.iter().fold(0, |sum: u64, (size, ..)| sum.saturating_add(*size));
    let largest_first = parts.map(|(size, name, _)| format!("{name} {}", bytes(size))).join(", ");
    let (needed, available) = (bytes(needed), bytes(available));
    let advice = match in_single {
        Some(needed) => format!("set run.precision = \"mixed\", which needs {}", bytes(needed)),
        None => parts[0].2.to_owned(),
    };
    format!(
        "the run needs {needed} – largest first: {largest_first} – {available} of memory is available – free memory, raise \
        run.memory_gib, or {advice}"
    )
}

/// A point, to six digits.
pub(super) fn place(point: [f64; 3]) -> String {
    point.map(|x| quantity(x, 6)).join(", ")
}

/// How rows of multipliers are known: by a zero on the diagonal, or as two of one constraint.
pub(super) fn multipliers(n_single: usize, n_of_pairs: usize) -> String {
    let single = (n_single > 0).then(|| format!("{n_single} with a zero diagonal and other entries"));
    let of_pairs = (n_of_pairs > 0).then(|| {
        format!("{n_of_pairs} in pairs, massless, coupled alike and with opposite numbers on and off the diagonal")
    });
    single.into_iter().chain(of_pairs).collect::<Vec<_>>().join(", ")
}

/// A relative energy below zero; one of −∞ is that of a coupling without mass.
pub(super) fn kinetic_energy(relative: f64) -> String {
    if relative.is_finite() {
        format!("a kinetic energy of {relative:.1e} relative to its diagonal")
    } else {
        "the kinetic energy of a dof that has no mass and is coupled to the mass of another one".to_owned()
    }
}

/// How many files there are besides the one that is named.
pub(super) fn and_more(n: usize) -> String {
    if n > 0 { format!(" (and {} like it)", counted(n as u64, "file", "files")) } else { String::new() }
}

/// Why the entries of a stiffness do not tell something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Uncertain {
    /// They have few digits.
    Digits,
    /// Its triangles differ, and no digits help.
    Triangles,
}

impl Uncertain {
    pub(super) fn subject(self) -> &'static str {
        match self {
            Self::Digits => "the digits of the stiffness do",
            Self::Triangles => "the triangles of the stiffness differ, and do",
        }
    }

    pub(super) fn expected(self) -> &'static str {
        match self {
            Self::Digits => "entries whose last digit does not decide that",
            Self::Triangles => "triangles whose difference does not decide that",
        }
    }

    pub(super) fn remedy(self) -> &'static str {
        match self {
            Self::Digits => {
                "write the stiffness with more digits, best in binary, or say model.stiffness_digits = 17 in the job if its numbers are exact"
            }
            Self::Triangles => {
                "correct the stiffness where its triangles differ, or say which of them holds with model.symmetric = \"lower\" or \"upper\" \
                 (reduce --symmetric)"
            }
        }
    }

    /// What may be done besides where the digits may be all that is wrong.
    pub(super) fn besides(cause: Option<Self>) -> &'static str {
        match cause {
            Some(Self::Digits) => {
                ", or say model.stiffness_digits = 17 in the job if the numbers of the stiffness are exact"
            }
            Some(Self::Triangles) => {
                ", or say which triangle of the stiffness holds with model.symmetric: they differ, and their mean may be no stiffness"
            }
            None => "",
        }
    }
}

/// What names of rows would be needed for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unnamed {
    /// To put the matrices of a model on common rows.
    Model,
    /// To put K̂ and M̂ of a superelement of another program on common rows.
    Reduced,
    /// To write what the rows of a matrix are.
    Single,
}

impl Unnamed {
    pub(super) fn in_words(self) -> &'static str {
        match self {
            Self::Model => {
                "the matrices of the model do not agree on whether rows have names – found one that names nodes and directions and one \
                 that does not – expected both to, or a dof map – give the dof map (`dofs` of a job, --dofs), or write both in one format"
            }
            Self::Reduced => {
                "K̂ and M̂ do not agree on whether rows have names – found one that names nodes and directions and one that does not – \
                 expected both to, or neither – write both in one format; a dof map is that of K and M"
            }
            Self::Single => {
                "nothing says what its rows are – found a matrix that names none, and no dof map of as many rows – expected a node and \
                 a direction for each – give its dof map with --dofs, or leave --write-dofs out"
            }
        }
    }
}
