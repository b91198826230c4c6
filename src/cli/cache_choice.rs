//! Which cache a run has: by the command line, or by the environment.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use super::flags::RunFlags;
use super::memory::typed_bytes;
use crate::cache::{Cache, Tally};
use crate::error::Result;
use crate::memory_forecast::bytes_of_gib;
use crate::number::counted;

const FOLDER: &str = "SUPEL_CACHE";
const SIZE: &str = "SUPEL_CACHE_GIB";
/// Factors of models of 100,000 dofs take half of one each.
const DEFAULT_GIB: f64 = 10.0;

/// A folder, and how large it may become.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CacheChoice {
    /// The flag or the variable that names the folder.
    pub(super) key: &'static str,
    pub(super) folder: PathBuf,
    max_bytes: u64,
}

impl CacheChoice {
    /// What flags say, and of what they do not say the environment; none where both name no folder.
    ///
    /// # Errors
    /// [`Error::JobNumber`] where a size is none.
    pub(super) fn of(run: &RunFlags) -> Result<Option<Self>> {
        Self::chosen((run.cache.as_deref(), run.cache_gib), |name| std::env::var_os(name))
    }

    fn chosen(
        (folder, gib): (Option<&Path>, Option<f64>),
        environment: impl Fn(&str) -> Option<OsString>,
    ) -> Result<Option<Self>> {
        let typed_folder = folder.map(|folder| ("--cache", folder.to_owned()));
        let named = || Some((FOLDER, environment(FOLDER).filter(|name| !name.is_empty())?.into()));
        let typed = gib.map(|gib| typed_bytes("--cache-gib", gib)).transpose()?;
        let Some((key, folder)) = typed_folder.or_else(named) else { return Ok(None) };
        let max_bytes = match (typed, environment(SIZE).filter(|size| !size.is_empty())) {
            (Some(typed), _) => typed,
            (None, Some(size)) => {
                let size = size.to_string_lossy();
                typed_bytes(&format!("{SIZE}={size}"), size.trim().parse().unwrap_or(f64::NAN))?
            }
            (None, None) => bytes_of_gib(DEFAULT_GIB),
        };
        Ok(Some(Self { key, folder, max_bytes }))
    }

    /// The words of a command line that chooses the same.
    pub(super) fn words(run: &RunFlags) -> Vec<OsString> {
        let folder = run.cache.iter().flat_map(|folder| [OsString::from("--cache"), folder.clone().into()]);
        let gib = run.cache_gib.iter().flat_map(|gib| [OsString::from("--cache-gib"), gib.to_string().into()]);
        folder.chain(gib).collect()
    }

    /// The cache.
    ///
    /// # Errors
    /// What [`Cache::at`] refuses.
    pub(super) fn open(&self) -> Result<Cache> {
        Cache::at(&self.folder, self.max_bytes)
    }

    /// What went wrong with it, one line each.
    pub(super) fn complaints(&self, tally: &Tally) -> Vec<String> {
        let folder = self.folder.display();
        let damaged = tally.damaged.first().map(|first| {
            let entries = counted(tally.damaged.len(), "entry is", "entries are");
            format!("supel: cache {folder}: {entries} damaged or unreadable, computed anew: {first}")
        });
        let not_kept = tally
            .not_kept
            .as_ref()
            .map(|reason| format!("supel: cache {folder}: not everything is kept for later runs: {reason}"));
        damaged.into_iter().chain(not_kept).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::Error;

    const HALF: f64 = 0.5;

    fn chosen(flags: (Option<&str>, Option<f64>), environment: [Option<&str>; 2]) -> Result<Option<CacheChoice>> {
        CacheChoice::chosen((flags.0.map(Path::new), flags.1), |name| {
            environment[usize::from(name == SIZE)].map(OsString::from)
        })
    }

    #[test]
    fn flags_go_before_the_environment() {
        let choice =
            |key, folder: &str, gib| Some(CacheChoice { key, folder: folder.into(), max_bytes: bytes_of_gib(gib) });
        for (flags, environment, expected) in [
            ((None, None), [None, None], None),
            ((None, None), [Some(""), Some("")], None),
            ((None, Some(HALF)), [None, None], None),
            ((Some("a"), None), [None, None], choice("--cache", "a", DEFAULT_GIB)),
            ((Some("a"), None), [Some("b"), Some("2")], choice("--cache", "a", 2.0)),
            ((None, None), [Some("b"), Some("2")], choice(FOLDER, "b", 2.0)),
            ((None, Some(HALF)), [Some("b"), Some("2")], choice(FOLDER, "b", HALF)),
        ] {
            assert_eq!(chosen(flags, environment).expect("sizes"), expected, "{flags:?} {environment:?}");
        }
    }

    #[test]
    fn a_size_that_is_none_is_refused_by_its_name() {
        for (gib, size, key) in [
            (Some(0.0), None, "--cache-gib"),
            (Some(-1.0), Some("2"), "--cache-gib"),
            (Some(f64::NAN), None, "--cache-gib"),
            (None, Some("much"), "SUPEL_CACHE_GIB=much"),
            (None, Some("-2"), "SUPEL_CACHE_GIB=-2"),
        ] {
            match chosen((Some("a"), gib), [None, size]) {
                Err(Error::JobNumber { key: found, .. }) => assert_eq!(found, key),
                other => panic!("{gib:?} {size:?}: {other:?}"),
            }
        }
    }
}
