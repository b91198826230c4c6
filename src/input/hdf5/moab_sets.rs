//! Sets of a MOAB file that carry a boundary condition number, resolved to nodes.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::group::Group;
use crate::error::{Error, Result};
use crate::number::counted;

/// Tags whose value is the number of a set that a user gave.
const TAGS: [&str; 2] = ["DIRICHLET_SET", "NEUMANN_SET"];
/// Flag of a set whose contents are pairs of first id and count.
const RANGES: i64 = 0x8;
/// Sets contain sets and polyhedra contain polygons, a few levels deep.
const MAX_DEPTH: usize = 8;

/// Node indices of the sets tagged `DIRICHLET_SET` or `NEUMANN_SET`, named by tag and number.
pub(super) fn read_sets(tstt: &Group<'_>, nodes: Range<i64>) -> Result<BTreeMap<String, Vec<usize>>> {
    let mut groups: BTreeMap<String, BTreeSet<usize>> = BTreeMap::new();
    let Some(sets) = Sets::read(tstt)? else {
        return Ok(BTreeMap::new());
    };
    let tagged = tagged_sets(tstt, sets.first)?;
    if tagged.is_empty() {
        return Ok(BTreeMap::new());
    }
    let contents = Contents { nodes, elements: read_elements(tstt)?, sets };
    let limit = contents.max_steps();
    let mut n_steps = 0;
    for (name, set) in tagged {
        let mut walk = Walk { found: groups.entry(name).or_default(), visited: BTreeSet::new(), n_steps, limit };
        contents.collect(set, &mut walk, MAX_DEPTH);
        n_steps = walk.n_steps;
    }
    if n_steps > limit {
        let (path, object) = (tstt.h5().path().to_owned(), tstt.child_name("sets"));
        return Err(Error::Hdf5Depth { path, object, limit, counted: "members of sets" });
    }
    Ok(groups
        .into_iter()
        .filter(|(_, nodes)| !nodes.is_empty())
        .map(|(name, nodes)| (name, nodes.into_iter().collect()))
        .collect())
}

/// Names and file ids of the tagged sets. A tag is stored sparse (ids and values) or dense (a value for each set).
fn tagged_sets(tstt: &Group<'_>, first: i64) -> Result<Vec<(String, i64)>> {
    let mut tagged = Vec::new();
    for tag in TAGS {
        if let (Some(ids), Some(values)) =
            (tstt.find_dataset(&format!("tags/{tag}/id_list"))?, tstt.find_dataset(&format!("tags/{tag}/values"))?)
        {
            let (numbers, n_ids) = (values.integers()?, ids.shape()?.iter().product::<usize>());
            if numbers.len() != n_ids {
                return Err(
                    values.wrong_shape(counted(numbers.len(), "value", "values"), format!("{n_ids}, one for each id"))
                );
            }
            tagged.extend(ids.integers()?.into_iter().zip(numbers).map(|(id, n)| (format!("{tag} {n}"), id)));
        } else if let Some(values) = tstt.find_dataset(&format!("sets/tags/{tag}"))? {
            // A set without the tag has a negative number.
            let numbers = values.integers()?.into_iter().zip(first..).filter(|(n, _)| *n >= 0);
            tagged.extend(numbers.map(|(n, id)| (format!("{tag} {n}"), id)));
        }
    }
    Ok(tagged)
}

/// Elements of one kind.
struct Elements {
    ids: Range<i64>,
    n_corners: usize,
    connectivity: Vec<i64>,
}

fn read_elements(tstt: &Group<'_>) -> Result<Vec<Elements>> {
    let kinds = tstt.find_group("elements")?.map(|g| g.groups()).transpose()?.unwrap_or_default();
    let mut elements = Vec::new();
    for kind in kinds {
        let Some(dataset) = kind.find_dataset("connectivity")? else {
            continue;
        };
        let &[n_elements, n_corners] = dataset.shape()?.as_slice() else {
            continue;
        };
        let first = dataset.integer_attribute("start_id")?.unwrap_or(0);
        let last = first.saturating_add_unsigned(n_elements as u64);
        elements.push(Elements { ids: first..last, n_corners, connectivity: dataset.integers()? });
    }
    Ok(elements)
}

/// All sets of a file.
struct Sets {
    first: i64,
    /// Last position in `contents` and the flags of each set.
    list: Vec<(i64, i64)>,
    contents: Vec<i64>,
}

impl Sets {
    fn read(tstt: &Group<'_>) -> Result<Option<Self>> {
        let (Some(list), Some(contents)) = (tstt.find_dataset("sets/list")?, tstt.find_dataset("sets/contents")?)
        else {
            return Ok(None);
        };
        if list.shape()?.get(1) != Some(&4) {
            return Err(list.wrong_shape(format!("shape {:?}", list.shape()?), "shape [n, 4]".to_owned()));
        }
        let first = list.integer_attribute("start_id")?.unwrap_or(0);
        let rows: Vec<(i64, i64)> = list.integers()?.chunks_exact(4).map(|row| (row[0], row[3])).collect();
        let contents = contents.integers()?;
        let mut previous = -1;
        for (set, &(last, _)) in rows.iter().enumerate() {
            if last < previous || last >= contents.len() as i64 {
                let (path, dataset) = (tstt.h5().path().to_owned(), list.name().to_owned());
                let last_allowed = contents.len() as i64 - 1;
                return Err(Error::Hdf5Index {
                    path,
                    dataset,
                    position: set * 4,
                    found: last,
                    first: previous,
                    last: last_allowed,
                });
            }
            previous = last;
        }
        Ok(Some(Self { first, list: rows, contents }))
    }

    /// File ids in the set, as ranges.
    fn ranges(&self, id: i64) -> Vec<Range<i64>> {
        let Some(set) = id.checked_sub(self.first).and_then(|i| usize::try_from(i).ok()) else {
            return Vec::new();
        };
        let Some(&(last, flags)) = self.list.get(set) else {
            return Vec::new();
        };
        let begin = if set == 0 { 0 } else { self.list[set - 1].0 + 1 };
        // Checked on reading: the positions rise and lie in the contents.
        let ids = &self.contents[begin as usize..(last + 1) as usize];
        if flags & RANGES != 0 {
            ids.chunks_exact(2).map(|pair| pair[0]..pair[0].saturating_add(pair[1])).collect()
        } else {
            ids.iter().map(|&id| id..id.saturating_add(1)).collect()
        }
    }
}

/// What a file id can stand for.
struct Contents {
    nodes: Range<i64>,
    elements: Vec<Elements>,
    sets: Sets,
}

/// The nodes found so far, and the work it took.
struct Walk<'a> {
    found: &'a mut BTreeSet<usize>,
    /// Elements and sets already expanded.
    visited: BTreeSet<i64>,
    n_steps: usize,
    limit: usize,
}

impl Contents {
    /// Adds the nodes that the file id stands for; ids of nothing are passed over as MOAB does.
    fn collect(&self, id: i64, walk: &mut Walk<'_>, depth: usize) {
        walk.n_steps = walk.n_steps.saturating_add(1);
        if walk.n_steps > walk.limit {
            return;
        }
        if self.nodes.contains(&id) {
            walk.found.insert((id - self.nodes.start) as usize);
            return;
        }
        if depth == 0 || !walk.visited.insert(id) {
            return;
        }
        if let Some(kind) = self.elements.iter().find(|e| e.ids.contains(&id)) {
            let element = (id - kind.ids.start) as usize;
            let corners = kind.connectivity.chunks_exact(kind.n_corners.max(1)).nth(element).unwrap_or_default();
            corners.iter().for_each(|&corner| self.collect(corner, walk, depth - 1));
            return;
        }
        for range in self.sets.ranges(id) {
            // A range cannot name more ids than the file has, however long it claims to be.
            for known in self.known() {
                let common = range.start.max(known.start)..range.end.min(known.end);
                for id in common {
                    self.collect(id, walk, depth - 1);
                    if walk.n_steps > walk.limit {
                        return;
                    }
                }
            }
        }
    }

    /// The ranges of ids that stand for something.
    fn known(&self) -> impl Iterator<Item = Range<i64>> {
        let n_sets = self.sets.list.len() as u64;
        let sets = self.sets.first..self.sets.first.saturating_add_unsigned(n_sets);
        self.elements.iter().map(|e| e.ids.clone()).chain([self.nodes.clone(), sets])
    }

    /// More steps than overlapping sets of a real file take: 64 times over everything.
    fn max_steps(&self) -> usize {
        let n_nodes = usize::try_from(self.nodes.end - self.nodes.start).unwrap_or(0);
        let n_corners: usize = self.elements.iter().map(|e| e.connectivity.len()).sum();
        (n_nodes + n_corners + self.sets.contents.len() + self.sets.list.len()).saturating_mul(64)
    }
}
