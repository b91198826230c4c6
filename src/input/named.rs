//! Which of the matrices of a file is meant: the one that is named, the only one, or the only one whose name says what it is.

use std::path::Path;

use super::MatrixRole;
use crate::error::{Error, Result};

/// The role that a name states: that of its last component which is a usual name of K or M.
pub(super) fn role_stated_by(path: &str) -> Option<MatrixRole> {
    const STIFFNESS: [&str; 16] = [
        "k",
        "ke",
        "kff",
        "kaa",
        "kgg",
        "kxx",
        "kjj",
        "kaax",
        "k2pp",
        "k2gg",
        "kmat",
        "stif",
        "stiff",
        "stiffness",
        "stiffnessmatrix",
        "stiffmat",
    ];
    const MASS: [&str; 14] =
        ["m", "me", "mff", "maa", "mgg", "mxx", "mjj", "maax", "m2pp", "m2gg", "mmat", "mass", "massmatrix", "massmat"];
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

/// The position of the only matrix whose name can mean `role`: the only one of all, unless its name says otherwise, or the only one whose
/// name says so.
///
/// # Errors
/// [`Error::MatrixAmbiguous`]; [`Error::MatrixNameTwice`] where those that could be meant have one name.
pub(super) fn of_role(path: &Path, names: &[&str], role: MatrixRole) -> Result<usize> {
    let states = |name: &str| role_stated_by(name) == Some(role);
    let chosen = match names {
        [only] if role_stated_by(only).is_none_or(|stated| stated == role) || role.takes_any() => Some(0),
        _ if names.iter().filter(|name| states(name)).count() == 1 => names.iter().position(|name| states(name)),
        _ => None,
    };
    chosen.ok_or_else(|| {
        let of_role: Vec<&str> = names.iter().copied().filter(|name| states(name)).collect();
        for among in [&of_role[..], names] {
            if let [first, others @ ..] = among
                && !others.is_empty()
                && others.iter().all(|name| name == first)
            {
                return twice(path, first, among.len());
            }
        }
        let matrices = names.iter().map(|name| (*name).to_owned()).collect();
        let role = match role {
            MatrixRole::Stiffness | MatrixRole::Mass => role.name(),
            // No name says that a matrix is one of these.
            _ => MatrixRole::Conversion.name(),
        };
        Error::MatrixAmbiguous { path: path.to_owned(), role, matrices }
    })
}

/// The position of the matrix that is wanted: by its name, where one is given, in whatever case; by its role otherwise.
///
/// # Errors
/// [`Error::MatrixName`]; [`Error::MatrixNameTwice`]; [`Error::MatrixAmbiguous`].
pub(super) fn chosen(path: &Path, names: &[&str], wanted: Option<&str>, role: MatrixRole) -> Result<usize> {
    let Some(wanted) = wanted else { return of_role(path, names, role) };
    let n_exact = names.iter().filter(|name| **name == wanted).count();
    if n_exact > 1 {
        return Err(twice(path, wanted, n_exact));
    }
    let exact = names.iter().position(|name| *name == wanted);
    let in_any_case = || {
        let mut alike = names.iter().enumerate().filter(|(_, name)| name.eq_ignore_ascii_case(wanted));
        alike.next().filter(|_| alike.next().is_none()).map(|(position, _)| position)
    };
    exact.or_else(in_any_case).ok_or_else(|| {
        let holds = names.iter().map(|name| (*name).to_owned()).collect();
        Error::MatrixName { path: path.to_owned(), name: wanted.to_owned(), holds }
    })
}

fn twice(path: &Path, name: &str, n: usize) -> Error {
    Error::MatrixNameTwice { path: path.to_owned(), name: name.to_owned(), n }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_component_that_is_a_usual_name_states_the_role() {
        assert_eq!(role_stated_by("/model/K"), Some(MatrixRole::Stiffness));
        assert_eq!(role_stated_by("/stiffnessMatrix"), Some(MatrixRole::Stiffness));
        assert_eq!(role_stated_by("/mass_matrix"), Some(MatrixRole::Mass));
        assert_eq!(role_stated_by("/mass/csr"), Some(MatrixRole::Mass));
        assert_eq!(role_stated_by("/K/M"), Some(MatrixRole::Mass));
        assert_eq!(role_stated_by("KAAX"), Some(MatrixRole::Stiffness));
        assert_eq!(role_stated_by("/kite/masses"), None);
    }

    #[test]
    fn a_name_decides_before_the_role_and_case_only_where_it_must() {
        let path = Path::new("a.op4");
        let choose = |names: &[&str], wanted, role| chosen(path, names, wanted, role).map_err(|error| error.code());
        let stiffness = MatrixRole::Stiffness;
        assert_eq!(choose(&["KAA", "MAA"], None, stiffness), Ok(0));
        assert_eq!(choose(&["KAA", "MAA"], Some("maa"), stiffness), Ok(1));
        assert_eq!(choose(&["k", "K"], Some("K"), stiffness), Ok(1));
        assert_eq!(choose(&["kk", "Kk"], Some("KK"), stiffness), Err("E-NO-SUCH-MATRIX"));
        assert_eq!(choose(&["KAA", "KAA"], Some("KAA"), stiffness), Err("E-SAME-NAME"));
        assert_eq!(choose(&["KAA", "MAA", "KAA"], None, stiffness), Err("E-SAME-NAME"));
        assert_eq!(choose(&["KAA", "MAA", "KAA"], None, MatrixRole::Mass), Ok(1));
        assert_eq!(choose(&["KAA", "KAA"], None, MatrixRole::Conversion), Err("E-SAME-NAME"));
        assert_eq!(choose(&["A"], None, stiffness), Ok(0));
        assert_eq!(choose(&["M"], None, stiffness), Err("E-MATRIX-AMBIGUOUS"));
        assert_eq!(choose(&["M"], None, MatrixRole::Conversion), Ok(0));
        assert_eq!(choose(&["A", "B"], None, stiffness), Err("E-MATRIX-AMBIGUOUS"));
        assert_eq!(choose(&["K", "KAA"], None, stiffness), Err("E-MATRIX-AMBIGUOUS"));
    }
}
