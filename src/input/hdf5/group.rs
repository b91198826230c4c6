//! A walk through the groups of a file that never leaves it.

use std::rc::Rc;

use hdf5_metno::{IndexType, IterationOrder, LinkType, LocationType};

use super::dataset::Dataset;
use super::file::{H5, Links};
use crate::error::{Error, Result};

/// More links than any group of a real file has; the library itself would follow a damaged index for ever.
const MAX_LINKS: usize = 1_000_000;

/// A group of an open file, with its path in it.
pub(super) struct Group<'a> {
    h5: &'a H5<'a>,
    group: hdf5_metno::Group,
    name: String,
}

/// What a name in a group leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Member {
    Group,
    Dataset,
    /// A soft, external or user-defined link.
    Link,
    /// A committed datatype.
    Other,
}

impl<'a> Group<'a> {
    /// The group that holds all others.
    pub(super) fn root(h5: &'a H5<'a>) -> Result<Self> {
        let group = h5.file.group("/").map_err(|e| h5.read_error("/", &e))?;
        Ok(Self { h5, group, name: String::from("/") })
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn h5(&self) -> &'a H5<'a> {
        self.h5
    }

    pub(super) fn location(&self) -> &hdf5_metno::Location {
        &self.group
    }

    /// Path in the file of a member of this group.
    pub(super) fn child_name(&self, member: &str) -> String {
        format!("{}/{member}", self.name.trim_end_matches('/'))
    }

    /// Names and kinds of all members, sorted by name.
    pub(super) fn members(&self) -> Result<Vec<(String, Member)>> {
        let links = self.links()?;
        links.iter().map(|(name, link)| Ok((name.clone(), self.classify(name, *link)?))).collect()
    }

    /// What `member` is; `None` if there is nothing of that name.
    pub(super) fn member(&self, member: &str) -> Result<Option<Member>> {
        self.links()?.get(member).map(|link| self.classify(member, *link)).transpose()
    }

    /// All links, listed once.
    fn links(&self) -> Result<Rc<Links>> {
        if let Some(links) = self.h5.links.borrow().get(&self.name) {
            return Ok(Rc::clone(links));
        }
        let mut links = Links::new();
        let mut too_many = false;
        let visited = self.group.iter_visit(IndexType::Name, IterationOrder::Native, |name, info| {
            too_many = links.len() >= MAX_LINKS;
            if too_many {
                return Err("too many links".into());
            }
            links.insert(name.to_owned(), info.link_type);
            Ok(())
        });
        if too_many {
            let path = self.h5.path.clone();
            return Err(Error::Hdf5Depth { path, object: self.name.clone(), limit: MAX_LINKS, counted: "members" });
        }
        visited.map_err(|e| self.h5.read_error(&self.name, &e))?;
        let links = Rc::new(links);
        self.h5.links.borrow_mut().insert(self.name.clone(), Rc::clone(&links));
        Ok(links)
    }

    /// The group at `path` below this one, which may have several components.
    pub(super) fn group(&self, path: &str) -> Result<Group<'a>> {
        self.find_group(path)?.ok_or_else(|| self.missing(path, "group"))
    }

    /// The group at `path` below this one, `None` where a component of the path does not exist.
    pub(super) fn find_group(&self, path: &str) -> Result<Option<Group<'a>>> {
        let mut here = Group { h5: self.h5, group: self.group.clone(), name: self.name.clone() };
        for component in path.split('/').filter(|c| !c.is_empty() && *c != ".") {
            match here.member(component)? {
                None => return Ok(None),
                Some(Member::Group) => here = here.child_group(component)?,
                Some(Member::Link) => return Err(here.link(component)),
                Some(other) => return Err(here.wrong_kind(component, other, "a group")),
            }
        }
        Ok(Some(here))
    }

    /// The groups among the members, sorted by name.
    pub(super) fn groups(&self) -> Result<Vec<Group<'a>>> {
        let members = self.members()?;
        members.iter().filter(|(_, member)| *member == Member::Group).map(|(name, _)| self.child_group(name)).collect()
    }

    /// The dataset at `path` below this group.
    pub(super) fn dataset(&self, path: &str) -> Result<Dataset<'a>> {
        self.find_dataset(path)?.ok_or_else(|| self.missing(path, "dataset"))
    }

    /// The dataset at `path` below this group, `None` where it does not exist.
    pub(super) fn find_dataset(&self, path: &str) -> Result<Option<Dataset<'a>>> {
        let (folder, member) = path.rsplit_once('/').unwrap_or(("", path));
        let Some(group) = self.find_group(folder)? else {
            return Ok(None);
        };
        match group.member(member)? {
            None => Ok(None),
            Some(Member::Dataset) => {
                let name = group.child_name(member);
                let dataset = group.group.dataset(member).map_err(|e| self.h5.read_error(&name, &e))?;
                Ok(Some(Dataset::new(self.h5, dataset, name)))
            }
            Some(Member::Link) => Err(group.link(member)),
            Some(other) => Err(group.wrong_kind(member, other, "a dataset")),
        }
    }

    /// The dataset at `path` below this group where it has two extents, so that it may be a dense matrix.
    pub(super) fn find_dense(&self, path: &str) -> Result<Option<Dataset<'a>>> {
        let (folder, member) = path.rsplit_once('/').unwrap_or(("", path));
        let is_dataset = match self.find_group(folder)? {
            Some(group) => group.member(member)? == Some(Member::Dataset),
            None => false,
        };
        let dataset = if is_dataset { self.find_dataset(path)? } else { None };
        match dataset {
            Some(dataset) if dataset.shape()?.len() == 2 => Ok(Some(dataset)),
            _ => Ok(None),
        }
    }

    /// The group of that name among the members.
    pub(super) fn child_group(&self, member: &str) -> Result<Group<'a>> {
        let name = self.child_name(member);
        let group = self.group.group(member).map_err(|e| self.h5.read_error(&name, &e))?;
        Ok(Group { h5: self.h5, group, name })
    }

    fn classify(&self, member: &str, link: LinkType) -> Result<Member> {
        if link != LinkType::Hard {
            return Ok(Member::Link);
        }
        match self.group.loc_type_by_name(member) {
            Ok(LocationType::Group) => Ok(Member::Group),
            Ok(LocationType::Dataset) => Ok(Member::Dataset),
            Ok(_) => Ok(Member::Other),
            Err(e) => Err(self.h5.read_error(&self.child_name(member), &e)),
        }
    }

    fn missing(&self, path: &str, kind: &'static str) -> Error {
        Error::Hdf5Missing { path: self.h5.path.clone(), object: self.child_name(path.trim_start_matches('/')), kind }
    }

    fn link(&self, member: &str) -> Error {
        Error::Hdf5Link { path: self.h5.path.clone(), object: self.child_name(member) }
    }

    fn wrong_kind(&self, member: &str, found: Member, expected: &'static str) -> Error {
        let found = match found {
            Member::Group => "a group",
            Member::Dataset => "a dataset",
            Member::Link => "a link",
            Member::Other => "neither group nor dataset",
        };
        let path = self.h5.path.clone();
        Error::Hdf5Type { path, object: self.child_name(member), found: found.to_owned(), expected }
    }
}
