//! Groups from whole numbers at nodes or cells, as formats without sets of their own have them.
//!
//! meshio joins the names of all sets by hyphens and numbers them from zero, `HUB-FOOT` with 0, 1, and −1 for what belongs to none. An array of
//! another kind, `gmsh:physical` for instance, gives a group `gmsh:physical 7` for each of its numbers. A node or cell has one number, so
//! that sets that overlap are not whole in such a file.
//!
//! Names with hyphens of their own make more pieces than there are numbers. Of the sets `HUB` and `FOOT` meshio makes `HUBHUB-FOOTFOOT` where
//! it joins them unasked. Neither tells which piece is the name of which number, so that the groups are named by the number.

use std::collections::BTreeMap;

/// Different numbers of an array that still are marks of groups; more are labels.
const MAX_TAGS: usize = 1 << 10;

/// The groups of an array: their names with the items that belong to them.
pub(super) fn tag_groups(name: &str, tags: &[i64]) -> BTreeMap<String, Vec<usize>> {
    let mut items: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (item, tag) in tags.iter().enumerate() {
        items.entry(*tag).or_default().push(item);
        if items.len() > MAX_TAGS {
            return BTreeMap::new();
        }
    }
    let joined: Vec<&str> = name.split('-').collect();
    let last = items.keys().next_back().copied().unwrap_or(-1);
    let is_joined = items.keys().next().is_some_and(|first| *first >= -1)
        && usize::try_from(last).is_ok_and(|last| last + 1 == joined.len())
        && joined.iter().all(|name| !name.is_empty())
        && !(joined.len() == 2 && joined.iter().all(|name| is_doubled(name)))
        // One number for everything is as likely a mark of something else.
        && (joined.len() > 1 || items.contains_key(&-1));
    let name_of = |tag: i64| match usize::try_from(tag) {
        Ok(at) if is_joined => Some(joined[at].to_owned()),
        Err(_) if is_joined => None,
        _ => Some(format!("{name} {tag}")),
    };
    let mut groups: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (tag, items) in items {
        if let Some(name) = name_of(tag) {
            groups.entry(name).or_default().extend(items);
        }
    }
    groups
}

/// Whether a name is one word twice.
fn is_doubled(name: &str) -> bool {
    let (first, second) = name.as_bytes().split_at(name.len() / 2);
    first == second
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str, tags: &[i64]) -> Vec<(String, Vec<usize>)> {
        tag_groups(name, tags).into_iter().collect()
    }

    #[test]
    fn names_joined_by_meshio_and_numbers_of_other_programs() {
        assert_eq!(of("HUB-FOOT", &[-1, 1, 0, 1]), [("FOOT".to_owned(), vec![1, 3]), ("HUB".to_owned(), vec![2])]);
        assert_eq!(of("HUB", &[-1, 0]), [("HUB".to_owned(), vec![1])]);
        assert_eq!(
            of("BOLT-HOLE-HUB", &[1, 0]),
            [("BOLT-HOLE-HUB 0".to_owned(), vec![1]), ("BOLT-HOLE-HUB 1".to_owned(), vec![0])]
        );
        assert_eq!(of("AA-AAAA", &[1, 0]), [("AA-AAAA 0".to_owned(), vec![1]), ("AA-AAAA 1".to_owned(), vec![0])]);
        assert_eq!(of("AA-B", &[1, 0]), [("AA".to_owned(), vec![1]), ("B".to_owned(), vec![0])]);
        assert_eq!(of("a-b", &[2, 0]), [("a-b 0".to_owned(), vec![1]), ("a-b 2".to_owned(), vec![0])]);
        assert_eq!(of("part", &[0, 0]), [("part 0".to_owned(), vec![0, 1])]);
        assert_eq!(of("id", &(0..2000).collect::<Vec<_>>()), []);
        assert_eq!(of("x", &[]), []);
    }
}
