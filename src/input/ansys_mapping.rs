//! The mapping file that HBMAT of Ansys writes next to a matrix: a head, then lines `equation node dof` with the name of the dof.

use std::path::Path;

use super::allowance::Allowance;
use super::banner::excerpt;
use super::dof_map::named;
use super::file_start::FileStart;
use super::format::{DofMapFormat, Format, ReadDofs, Sureness};
use super::fortran::whole;
use super::lines::Lines;
use crate::dofs::Dof;
use crate::error::{Error, Result};

const FORMAT: &str = "mapping of Ansys";
/// What dofs are called that no rigid-body motion moves.
const SCALAR: [&str; 6] = ["pres", "temp", "volt", "mag", "warp", "hdsp"];

/// `HBMAT,…,YES`: which node and dof each equation is.
pub(super) struct AnsysMapping;

/// The fields of a line between blanks.
fn words(line: &[u8]) -> Vec<&[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect()
}

impl Format for AnsysMapping {
    fn sureness(&self, start: &FileStart<'_>) -> Sureness {
        let says = |line: &[u8]| {
            let text = String::from_utf8_lossy(line).to_lowercase();
            let has_columns =
                (text.contains("eqn") || text.contains("equation")) && text.contains("node") && text.contains("dof");
            has_columns && !text.contains([',', ';', '\t'])
        };
        if start.lines().any(says) { Sureness::Certain } else { Sureness::Unlikely }
    }
}

impl DofMapFormat for AnsysMapping {
    fn read(&self, path: &Path, n: usize, _: &Allowance) -> Result<ReadDofs> {
        let mut lines = Lines::open(path)?;
        let mut rows: Vec<(u64, Option<Dof>)> = Vec::new();
        while lines.advance()? {
            let words = words(lines.line());
            // The head has words in place of numbers.
            let Some(equation) = words.first().and_then(|word| whole(word)) else { continue };
            let wrong = || Error::MatrixFormat {
                path: path.to_owned(),
                format: FORMAT,
                place: format!("line {}", lines.number()),
                found: format!("`{}`", excerpt(lines.line().trim_ascii())),
                expected: "an equation, a node and the name of a dof, as in `1 4711 UX`".into(),
            };
            let [_, node, name] = words[..] else { return Err(wrong()) };
            let (node, name) = (whole(node).ok_or_else(wrong)?, String::from_utf8_lossy(name).to_lowercase());
            let dof = match named(&name) {
                Some(direction) => Some(Dof { node, direction }),
                None if SCALAR.contains(&name.as_str()) => None,
                None => return Err(wrong()),
            };
            rows.push((u64::try_from(equation).map_err(|_| wrong())?, dof));
        }
        rows.sort_by_key(|(equation, _)| *equation);
        if let Some((found, expected)) = rows.iter().map(|row| row.0).zip(1..).find(|(equation, row)| equation != row) {
            let (path, found) = (path.to_owned(), found.to_string());
            return Err(Error::DofRowOrder { path, line: expected, found, expected });
        }
        let n_rows = rows.len();
        let dofs = rows.into_iter().take(n).map(|(_, dof)| dof).collect();
        Ok(ReadDofs::new(dofs, n_rows))
    }
}
