//! Sets of nodes or elements that are being filled, each under its name.

use std::collections::{BTreeMap, HashMap};
use std::path::Path;

use crate::error::{Error, Result};

/// More sets than the nodes and elements of a real mesh belong to, on average.
const MAX_SETS_EACH: usize = 64;

/// Sets of indices by name, in the order in which they came.
#[derive(Debug, Default)]
pub(in crate::input) struct Sets {
    sets: Vec<Set>,
    /// By the name in capitals.
    by_name: HashMap<String, usize>,
    n_members: usize,
}

#[derive(Debug)]
struct Set {
    name: String,
    members: Vec<u32>,
    /// So many members at the front are sorted and different.
    n_sorted: usize,
}

impl Set {
    fn sort(&mut self) {
        if self.n_sorted < self.members.len() {
            self.members.sort_unstable();
            self.members.dedup();
            self.n_sorted = self.members.len();
        }
    }
}

impl Sets {
    /// The set of a name, in whatever case, which is made where there is none.
    pub(in crate::input) fn named(&mut self, name: &str) -> usize {
        let new = self.sets.len();
        let at = *self.by_name.entry(name.to_ascii_uppercase()).or_insert(new);
        if at == new {
            self.sets.push(Set { name: name.to_owned(), members: Vec::new(), n_sorted: 0 });
        }
        at
    }

    /// The set of a name, where there is one.
    pub(in crate::input) fn find(&self, name: &str) -> Option<usize> {
        self.by_name.get(&name.to_ascii_uppercase()).copied()
    }

    /// Adds members to a set of a mesh with so many nodes and corners of elements.
    ///
    /// # Errors
    /// [`Error::MeshGroups`].
    pub(in crate::input) fn extend(
        &mut self,
        set: usize,
        members: impl IntoIterator<Item = u32>,
        (path, n_items): (&Path, usize),
    ) -> Result<()> {
        let Set { members: known, n_sorted, .. } = &mut self.sets[set];
        let before = known.len();
        known.extend(members);
        self.n_members += known.len() - before;
        if known.len() > 2 * *n_sorted + 1024 {
            let repeated = known.len();
            self.sets[set].sort();
            self.n_members -= repeated - self.sets[set].members.len();
        }
        let limit = n_items.saturating_mul(MAX_SETS_EACH).max(1 << 16);
        if self.n_members > limit {
            return Err(Error::MeshGroups { path: path.to_owned(), limit });
        }
        Ok(())
    }

    /// The members of a set, ascending and different.
    pub(in crate::input) fn members(&mut self, set: usize) -> &[u32] {
        self.sets[set].sort();
        &self.sets[set].members
    }

    /// The members of a set, some perhaps several times.
    pub(in crate::input) fn unsorted(&self, set: usize) -> &[u32] {
        &self.sets[set].members
    }

    /// The members of every set by its name as it was written first; empty sets are left out.
    pub(in crate::input) fn into_groups(self) -> BTreeMap<String, Vec<usize>> {
        let group = |mut set: Set| {
            set.sort();
            (set.name, set.members.into_iter().map(|member| member as usize).collect::<Vec<_>>())
        };
        self.sets.into_iter().map(group).filter(|(_, members)| !members.is_empty()).collect()
    }

    /// The sets with their members.
    pub(in crate::input) fn iter(&self) -> impl Iterator<Item = (&str, &[u32])> {
        self.sets.iter().map(|set| (set.name.as_str(), set.members.as_slice()))
    }
}
