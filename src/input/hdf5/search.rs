//! Which sparse group of a file is the stiffness and which the mass.

use super::convention::Convention;
use super::group::{Group, Member};
use crate::error::{Error, Result};
use crate::input::{MatrixRole, named};

/// Deeper than any real file is nested.
const MAX_DEPTH: usize = 32;
/// More objects than any real file with matrices has.
const MAX_OBJECTS: usize = 100_000;

/// The one sparse group below `start` that can be meant: the only one, unless its name says otherwise, or the only one
/// whose name says `role`.
pub(super) fn find_matrix<'a>(start: Group<'a>, role: MatrixRole) -> Result<(Group<'a>, Convention)> {
    let (path, top) = (start.h5().path().to_owned(), start.name().to_owned());
    let mut search = Search { found: Vec::new(), others: Vec::new(), n_objects: 0 };
    search.visit(start, 0)?;
    if search.found.is_empty() {
        return Err(Error::Hdf5NoMatrix { path, group: top, holds: search.others });
    }
    let names: Vec<&str> = search.found.iter().map(|(group, _)| group.name()).collect();
    let chosen = named::of_role(&path, &names, role)?;
    Ok(search.found.swap_remove(chosen))
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
