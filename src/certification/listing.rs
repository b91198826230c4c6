//! Names in a line.

/// The first names of `n_all`, at most so many, and how many more there are; nothing where there are none.
pub(super) fn first_of(names: impl Iterator<Item = String>, (at_most, n_all): (usize, usize)) -> String {
    let mut listed: Vec<String> = names.take(at_most).collect();
    if n_all > listed.len() {
        listed.push(format!("{} more", n_all - listed.len()));
    }
    listed.join(", ")
}
