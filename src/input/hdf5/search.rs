//! Which sparse group of a file is the stiffness and which the mass.

use super::convention::Convention;
use super::group::{Group, Member};
use crate::error::{Error, Result};
use crate::input::MatrixRole;

/// Deeper than any real file is nested.
const MAX_DEPTH: usize = 32;
/// More objects than any real file with matrices has.
const MAX_OBJECTS: usize = 100_000;

/// The role that a path in a file states: that of its last component which is a usual name of K or M.
fn role_stated_by(path: &str) -> Option<MatrixRole> {
    const STIFFNESS: [&str; 11] =
        ["k", "ke", "kff", "kaa", "kgg", "kaax", "kmat", "stif", "stiff", "stiffness", "stiffnessmatrix"];
    const MASS: [&str; 9] = ["m", "me", "mff", "maa", "mgg", "maax", "mmat", "mass", "massmatrix"];
    path.rsplit('/').find_map(|component| {
        let name: String = component.chars().filter(char::is_ascii_alphanumeric).collect();
        let name = name.to_ascii_lowercase();
        let name = name.as_str();
        STIFFNESS
            .contains(&name)
            .then_some(MatrixRole::Stiffness)
            .or_else(|| MASS.contains(&name).then_some(MatrixRole::Mass))
    })
}

/// The one sparse group below `start` that can be meant: the only one, unless its name says otherwise, or the only one
/// whose name says `role`.
pub(super) fn find_matrix<'a>(start: Group<'a>, role: MatrixRole) -> Result<(Group<'a>, Convention)> {
    let (path, top) = (start.h5().path().to_owned(), start.name().to_owned());
    let mut search = Search { found: Vec::new(), others: Vec::new(), n_objects: 0 };
    search.visit(start, 0)?;
    if search.found.is_empty() {
        return Err(Error::Hdf5NoMatrix { path, group: top, holds: search.others });
    }
    let stated = |g: &Group<'a>| role_stated_by(g.name());
    let n_stated = search.found.iter().filter(|(g, _)| stated(g) == Some(role)).count();
    let chosen = match search.found.as_slice() {
        [(only, _)] if stated(only).is_none_or(|r| r == role) => Some(0),
        _ if n_stated == 1 => search.found.iter().position(|(g, _)| stated(g) == Some(role)),
        _ => None,
    };
    match chosen {
        Some(idx) => Ok(search.found.swap_remove(idx)),
        None => {
            let groups = search.found.iter().map(|(g, _)| g.name().to_owned()).collect();
            Err(Error::Hdf5AmbiguousMatrix { path, role: role.name(), groups })
        }
    }
}

/// A walk through all groups.
struct Search<'a> {
    found: Vec<(Group<'a>, Convention)>,
    /// Everything else that was seen, for the message when nothing is found.
    others: Vec<String>,
    n_objects: usize,
}

impl<'a> Search<'a> {
    fn visit(&mut self, group: Group<'a>, depth: usize) -> Result<()> {
        let members = group.members()?;
        if let Some(convention) = Convention::of(&group, &members)? {
            self.found.push((group, convention));
            return Ok(());
        }
        self.n_objects += members.len();
        let too_deep = |limit, counted| {
            let path = group.h5().path().to_owned();
            Err(Error::Hdf5Depth { path, object: group.name().to_owned(), limit, counted })
        };
        if depth >= MAX_DEPTH {
            return too_deep(MAX_DEPTH, "levels of groups");
        }
        if self.n_objects > MAX_OBJECTS {
            return too_deep(MAX_OBJECTS, "objects");
        }
        for (name, member) in members {
            match member {
                Member::Group => self.visit(group.child_group(&name)?, depth + 1)?,
                Member::Dataset => self.others.push(group.child_name(&name)),
                Member::Link => self.others.push(format!("{} (a link)", group.child_name(&name))),
                Member::Other => {}
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::{MatrixRole, role_stated_by};

    #[test]
    fn the_last_component_that_is_a_usual_name_states_the_role() {
        assert_eq!(role_stated_by("/model/K"), Some(MatrixRole::Stiffness));
        assert_eq!(role_stated_by("/stiffnessMatrix"), Some(MatrixRole::Stiffness));
        assert_eq!(role_stated_by("/mass_matrix"), Some(MatrixRole::Mass));
        assert_eq!(role_stated_by("/mass/csr"), Some(MatrixRole::Mass));
        assert_eq!(role_stated_by("/K/M"), Some(MatrixRole::Mass));
        assert_eq!(role_stated_by("/kite/masses"), None);
    }
}
