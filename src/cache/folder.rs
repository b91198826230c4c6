//! The folder of a cache: what is in it, and how much.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{DirEntry, File};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use serde::Serialize;

use super::entry::{Reader, Writer};
use super::key::Key;
use crate::error::{Error, Result};

/// What an entry holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// The factor of K_II.
    Factor,
    /// A count of eigenvalues.
    Count,
    /// Modes, certified if that was asked for.
    Modes,
}

impl Kind {
    const ALL: [Self; 3] = [Self::Factor, Self::Count, Self::Modes];

    fn name(self) -> &'static str {
        match self {
            Self::Factor => "factor",
            Self::Count => "count",
            Self::Modes => "modes",
        }
    }
}

/// What a run had of its cache.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Results of earlier runs that it took, by kind.
    pub taken: BTreeMap<Kind, usize>,
    /// Results of its own that it kept for later runs, by kind.
    pub kept: BTreeMap<Kind, usize>,
    /// Files that were no entry although they were named so.
    pub n_damaged: usize,
    /// Why a result was not kept, where one was not.
    pub not_kept: Option<String>,
}

/// Results of earlier runs in a folder; clones share its tally.
#[derive(Clone, Debug)]
pub struct Cache(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    folder: PathBuf,
    most_bytes: u64,
    tally: Mutex<Tally>,
}

const ENTRY: &str = "entry";
const PART: &str = "part";
/// Written parts older than this belong to no process any more.
const ABANDONED: Duration = Duration::from_secs(24 * 3600);
const TAG: &str = "CACHEDIR.TAG";
const TAG_TEXT: &str = "Signature: 8a477f597d28d172789f06886806bc55\n\
                        # Results of supel that it computes anew where they are missing. See https://bford.info/cachedir/\n";

impl Cache {
    /// The cache in a folder, which is made where it is missing, of so many bytes at most.
    ///
    /// # Errors
    /// [`Error::Write`] where there can be no such folder.
    pub fn at(folder: &Path, most_bytes: u64) -> Result<Self> {
        let refused = |source| Error::Write { path: folder.to_owned(), source };
        std::fs::create_dir_all(folder).map_err(refused)?;
        let tag = folder.join(TAG);
        if !tag.exists() {
            std::fs::write(&tag, TAG_TEXT).map_err(refused)?;
        }
        Ok(Self(Arc::new(Shared { folder: folder.to_owned(), most_bytes, tally: Mutex::default() })))
    }

    /// What was had of it so far.
    pub fn tally(&self) -> Tally {
        self.tallied().clone()
    }

    fn tallied(&self) -> MutexGuard<'_, Tally> {
        self.0.tally.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The result under a key, by `read`; none where there is none or it is damaged.
    pub(crate) fn take<T>(&self, kind: Kind, key: &Key, read: impl FnOnce(&mut Reader<'_>) -> Option<T>) -> Option<T> {
        let path = self.path_of(kind, key);
        // What is no regular file may have no end.
        if !std::fs::symlink_metadata(&path).ok()?.is_file() {
            return None;
        }
        let file = File::open(&path).ok()?;
        let mut reader = Reader::new(&file, &key.digest());
        let found = reader.as_mut().and_then(read);
        if !reader.is_some_and(Reader::is_whole) || found.is_none() {
            self.tallied().n_damaged += 1;
            let _ = std::fs::remove_file(&path);
            return None;
        }
        // The times say what was used last.
        let _ = File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now()));
        *self.tallied().taken.entry(kind).or_default() += 1;
        found
    }

    /// Keeps a result under a key, by `write`. What cannot be kept is tallied, and no error.
    pub(crate) fn keep(&self, kind: Kind, key: &Key, write: impl FnOnce(&mut Writer<'_>) -> std::io::Result<()>) {
        match self.written(kind, key, write) {
            Ok(()) => *self.tallied().kept.entry(kind).or_default() += 1,
            Err(error) => self.tallied().not_kept = Some(format!("{}: {error}", kind.name())),
        }
    }

    fn written(
        &self,
        kind: Kind,
        key: &Key,
        write: impl FnOnce(&mut Writer<'_>) -> std::io::Result<()>,
    ) -> std::io::Result<()> {
        let part = tempfile::Builder::new().suffix(&format!(".{PART}")).tempfile_in(&self.0.folder)?;
        let mut writer = Writer::new(part.as_file(), &key.digest())?;
        write(&mut writer)?;
        let n_bytes = writer.finish()?;
        if n_bytes > self.0.most_bytes {
            return Err(std::io::Error::other("it is larger than the cache may be"));
        }
        self.make_room(n_bytes)?;
        part.persist(self.path_of(kind, key)).map_err(|error| error.error)?;
        Ok(())
    }

    /// Removes what was used longest ago until so many bytes more are no more than allowed.
    fn make_room(&self, n_bytes: u64) -> std::io::Result<()> {
        let mut entries = Vec::new();
        for file in std::fs::read_dir(&self.0.folder)? {
            let Ok(file) = file else { continue };
            let Ok(facts) = file.metadata() else { continue };
            let Ok(used) = facts.modified() else { continue };
            match belonging(&file) {
                Some(ENTRY) => entries.push((used, facts.len(), file.path())),
                Some(PART) if used.elapsed().is_ok_and(|age| age > ABANDONED) => {
                    let _ = std::fs::remove_file(file.path());
                }
                _ => {}
            }
        }
        entries.sort();
        let mut total = entries.iter().map(|(_, n_bytes, _)| n_bytes).sum::<u64>() + n_bytes;
        for (_, n_bytes, path) in entries {
            if total <= self.0.most_bytes {
                break;
            }
            // Another process may have been faster.
            let _ = std::fs::remove_file(path);
            total -= n_bytes;
        }
        Ok(())
    }

    fn path_of(&self, kind: Kind, key: &Key) -> PathBuf {
        let mut name = format!("{}-", kind.name());
        key.digest().iter().for_each(|byte| write!(name, "{byte:02x}").expect("a string takes all"));
        self.0.folder.join(format!("{name}.{ENTRY}"))
    }
}

/// What a file of the folder is to a cache, by its name: an entry, a part of one, or nothing.
fn belonging(file: &DirEntry) -> Option<&'static str> {
    let name = file.file_name();
    let (stem, ending) = name.to_str()?.rsplit_once('.')?;
    let is_entry = || {
        let (kind, key) = stem.split_once('-')?;
        let is_key = key.len() == 64 && key.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'));
        (is_key && Kind::ALL.iter().any(|known| known.name() == kind)).then_some(ENTRY)
    };
    match ending {
        ENTRY => is_entry(),
        PART => stem.starts_with(".tmp").then_some(PART),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KIND: Kind = Kind::Count;

    fn numbers(n: u32) -> Vec<u32> {
        (0..100).map(|i| i * n).collect()
    }

    fn key(n: u32) -> Key {
        Key::of("test").numbers(&[n])
    }

    fn keep(cache: &Cache, n: u32) {
        cache.keep(KIND, &key(n), |to| to.array(&numbers(n)));
    }

    fn taken(cache: &Cache, n: u32) -> Option<Vec<u32>> {
        cache.take(KIND, &key(n), |from| from.array())
    }

    /// One entry is 14 + 32 + 9 + 400 + 32 bytes.
    const ENTRY_BYTES: u64 = 487;

    fn cache(folder: &Path, n_entries: u64) -> Cache {
        Cache::at(folder, n_entries * ENTRY_BYTES).expect("a folder")
    }

    fn used_at(cache: &Cache, n: u32, seconds: u64) {
        let file = File::options().append(true).open(cache.path_of(KIND, &key(n))).expect("an entry");
        file.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(seconds)).expect("a time");
    }

    #[test]
    fn what_is_kept_is_taken_and_counted() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = cache(folder.path(), 9);
        assert_eq!(taken(&first, 1), None);
        keep(&first, 1);
        let second = cache(folder.path(), 9);
        assert_eq!(taken(&second, 1), Some(numbers(1)));
        assert_eq!(taken(&second, 2), None);
        let path = second.path_of(KIND, &key(1));
        assert_eq!(path.metadata().expect("an entry").len(), ENTRY_BYTES);
        assert_eq!((first.tally().kept, first.tally().taken), ([(KIND, 1)].into(), BTreeMap::new()));
        assert_eq!((second.tally().kept, second.tally().taken), (BTreeMap::new(), [(KIND, 1)].into()));
    }

    /// Every byte decides, and so does every length.
    #[test]
    fn damaged_entries_are_removed_and_not_taken() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path(), 9);
        let path = cache.path_of(KIND, &key(1));
        keep(&cache, 1);
        let sound = std::fs::read(&path).expect("an entry");
        let flipped = (0..sound.len()).map(|at| {
            let mut bytes = sound.clone();
            bytes[at] ^= 1;
            bytes
        });
        let cut = (0..sound.len()).map(|length| sound[..length].to_vec());
        let longer = [[sound.clone(), vec![0]].concat(), [sound.clone(), sound.clone()].concat()];
        let mut n_damaged = 0;
        for bytes in flipped.chain(cut).chain(longer) {
            std::fs::write(&path, &bytes).expect("written");
            assert_eq!(taken(&cache, 1), None);
            assert!(!path.exists());
            n_damaged += 1;
            assert_eq!(cache.tally().n_damaged, n_damaged);
        }
        std::fs::write(&path, &sound).expect("written");
        assert_eq!(taken(&cache, 1), Some(numbers(1)));
    }

    /// A sound entry under the name of another one, and one of another shape.
    #[test]
    fn foreign_entries_are_not_taken() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path(), 9);
        keep(&cache, 1);
        std::fs::rename(cache.path_of(KIND, &key(1)), cache.path_of(KIND, &key(2))).expect("renamed");
        assert_eq!(taken(&cache, 2), None);
        keep(&cache, 3);
        let shapes: [&dyn Fn(&mut Reader<'_>) -> Option<()>; 5] = [
            &|from| from.array::<f32>().map(|_| ()),
            &|from| from.number::<u32>().map(|_| ()),
            &|from| from.columns().map(|_| ()),
            &|from| from.array::<u32>().and_then(|_| from.array::<u32>()).map(|_| ()),
            // Something is left.
            &|_| Some(()),
        ];
        for shape in shapes {
            keep(&cache, 3);
            assert_eq!(cache.take(KIND, &key(3), shape), None);
        }
        std::fs::create_dir(cache.path_of(KIND, &key(4))).expect("a folder");
        assert_eq!(taken(&cache, 4), None);
        keep(&cache, 4);
        assert!(cache.tally().not_kept.is_some(), "a folder is in its place");
    }

    #[test]
    fn what_was_used_longest_ago_goes_first_and_foreign_files_stay() {
        let folder = tempfile::tempdir().expect("a folder");
        let foreign = ["notes.entry", "factor-00.entry", "factor-zz.part", "K.mtx", "count-.entry"];
        foreign.iter().for_each(|name| std::fs::write(folder.path().join(name), "mine").expect("written"));
        let cache = cache(folder.path(), 3);
        for (n, seconds) in [(1, 30), (2, 10), (3, 20)] {
            keep(&cache, n);
            used_at(&cache, n, seconds);
        }
        // It was used longest ago, and is used now.
        assert!(taken(&cache, 2).is_some());
        keep(&cache, 4);
        let left: Vec<u32> = (1..=4).filter(|n| cache.path_of(KIND, &key(*n)).exists()).collect();
        assert_eq!(left, [1, 2, 4]);
        assert!(foreign.iter().all(|name| folder.path().join(name).exists()));
        assert_eq!(cache.tally().not_kept, None);
    }

    #[test]
    fn what_is_larger_than_the_cache_is_not_kept_and_nothing_goes_for_it() {
        let folder = tempfile::tempdir().expect("a folder");
        keep(&cache(folder.path(), 1), 1);
        let smaller = Cache::at(folder.path(), ENTRY_BYTES - 1).expect("a folder");
        keep(&smaller, 2);
        assert!(smaller.tally().not_kept.is_some_and(|reason| reason.contains("larger")));
        assert_eq!(taken(&smaller, 1), Some(numbers(1)));
        let files = std::fs::read_dir(folder.path()).expect("a folder").count();
        assert_eq!(files, 2, "the tag and one entry: no part is left");
    }

    #[test]
    fn parts_of_processes_that_are_gone_are_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path(), 9);
        let [old, new] = [".tmpOld.part", ".tmpNew.part"].map(|name| folder.path().join(name));
        [&old, &new].into_iter().for_each(|part| std::fs::write(part, "half").expect("written"));
        let file = File::options().append(true).open(&old).expect("a part");
        file.set_modified(SystemTime::now() - 2 * ABANDONED).expect("a time");
        keep(&cache, 1);
        assert!(!old.exists() && new.exists());
    }
}
