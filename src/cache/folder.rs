//! The folder of a cache: takes entries, keeps them, and removes what there is no room for.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs::File;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use serde::Serialize;

use super::entry::{Reader, Writer};
use super::key::{Digest, Key};
use super::kind::Kind;
use super::recorded::Recorded;
use crate::error::{Error, Result};
use crate::unfinished::RemovedAtEnd;

/// What a run had of its cache.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Results of earlier runs that it took, by kind.
    pub taken: BTreeMap<Kind, usize>,
    /// Results that are parts of what earlier runs have found for more than is asked now. They are right to their error bars, as those of a
    /// run without a cache are, and not those to the bit.
    pub parts: usize,
    /// Results of its own that it left there for later runs, by kind.
    pub kept: BTreeMap<Kind, usize>,
    /// Files with names of entries that were none or could not be read.
    pub damaged: BTreeSet<String>,
    /// Why a result was not kept, where one was not.
    pub not_kept: Option<String>,
}

/// Results of earlier runs in a folder; clones share its tally.
#[derive(Clone, Debug)]
pub struct Cache(Arc<Shared>);

#[derive(Debug)]
struct Shared {
    folder: PathBuf,
    max_bytes: u64,
    tally: Mutex<Tally>,
    /// Names of the entries that the run has made.
    own: Mutex<BTreeMap<String, Kind>>,
}

const ENTRY: &str = ".entry";
/// What begins and ends the name of an entry that is being written.
const PART: [&str; 2] = [".supel-cache-", ".part"];
/// Written parts older than this belong to no process any more.
const ABANDONED: Duration = Duration::from_secs(24 * 3600);
const TAG: &str = "CACHEDIR.TAG";
const TAG_TEXT: &str = "Signature: 8a477f597d28d172789f06886806bc55\n\
                        # Results of supel that it computes anew where they are missing. See https://bford.info/cachedir/\n";

impl Cache {
    /// The cache in a folder, which is made once there is something to be kept, of so many bytes at most.
    ///
    /// # Errors
    /// [`Error::Write`] where something else has that name.
    pub fn at(folder: &Path, max_bytes: u64) -> Result<Self> {
        if std::fs::metadata(folder).is_ok_and(|facts| !facts.is_dir()) {
            return Err(Error::Write { path: folder.to_owned(), source: ErrorKind::NotADirectory.into() });
        }
        let (tally, own) = (Mutex::default(), Mutex::default());
        let cache = Self(Arc::new(Shared { folder: folder.to_owned(), max_bytes, tally, own }));
        // It may have been larger before.
        let _ = cache.make_room(0);
        Ok(cache)
    }

    /// What was had of it so far.
    pub fn tally(&self) -> Tally {
        let mut tally = locked(&self.0.tally).clone();
        for kind in locked(&self.0.own).values() {
            *tally.kept.entry(*kind).or_default() += 1;
        }
        tally
    }

    /// The result that an earlier run has kept under a key, by `read`, or the one that `make` makes, which is kept by `write`.
    ///
    /// # Errors
    /// What `make` refuses; a cache that cannot be used is none.
    pub(crate) fn recall<T>(
        &self,
        (kind, key): (Kind, &Key),
        read: impl FnOnce(&mut Reader<'_>) -> Option<T>,
        make: impl FnOnce() -> Result<T>,
        write: impl FnOnce(&T, &mut Writer<'_>) -> std::io::Result<()>,
    ) -> Result<T> {
        if let Some(found) = self.take(kind, &key.digest(), read) {
            return Ok(found);
        }
        let made = make()?;
        self.keep(kind, key, |to| write(&made, to));
        Ok(made)
    }

    /// The result that an earlier run has kept under the digest of a key; none of this run.
    pub(crate) fn of_earlier_run<T: Recorded>(&self, key: &Digest) -> Option<T> {
        let is_own = locked(&self.0.own).contains_key(&name_of(T::KIND, key));
        if is_own { None } else { self.take(T::KIND, key, T::read) }
    }

    /// Whether there is an entry under the digest of a key, sound or not.
    pub(crate) fn has(&self, kind: Kind, key: &Digest) -> bool {
        self.0.folder.join(name_of(kind, key)).exists()
    }

    /// A part of what an earlier run has found for more has become a result of this run.
    pub(crate) fn part_was_taken(&self) {
        locked(&self.0.tally).parts += 1;
    }

    /// Keeps a result for later runs in the place of what is there under its key. What cannot be kept is tallied, and no error.
    pub(crate) fn replace<T: Recorded>(&self, key: &Key, result: &T) {
        self.keep(T::KIND, key, |to| result.write(to));
    }

    /// The result under the digest of a key, by `read`; none where there is none or it is damaged.
    fn take<T>(&self, kind: Kind, key: &Digest, read: impl FnOnce(&mut Reader<'_>) -> Option<T>) -> Option<T> {
        let name = name_of(kind, key);
        let path = self.0.folder.join(&name);
        let found = found(&path, key, read);
        if matches!(found, Found::Damaged) {
            let _ = std::fs::remove_file(&path);
        }
        if matches!(found, Found::Damaged | Found::Unreadable) {
            locked(&self.0.tally).damaged.insert(name.clone());
        }
        let Found::Result(found) = found else { return None };
        // The times say what was used last.
        let _ = File::options().append(true).open(&path).and_then(|file| file.set_modified(SystemTime::now()));
        if !locked(&self.0.own).contains_key(&name) {
            *locked(&self.0.tally).taken.entry(kind).or_default() += 1;
        }
        Some(found)
    }

    /// Keeps a result under a key, by `write`. What cannot be kept is tallied, and no error.
    fn keep(&self, kind: Kind, key: &Key, write: impl FnOnce(&mut Writer<'_>) -> std::io::Result<()>) {
        let name = name_of(kind, &key.digest());
        match self.written(&name, key, write) {
            Ok(()) => {
                locked(&self.0.own).insert(name, kind);
            }
            Err(error) => locked(&self.0.tally).not_kept = Some(format!("{}: {error}", kind.name())),
        }
    }

    fn written(
        &self,
        name: &str,
        key: &Key,
        write: impl FnOnce(&mut Writer<'_>) -> std::io::Result<()>,
    ) -> std::io::Result<()> {
        self.make_folder()?;
        let part = new_part(&self.0.folder)?;
        let _removed = RemovedAtEnd::of(part.path());
        let mut writer = Writer::new(part.as_file(), &key.digest(), self.0.max_bytes)?;
        write(&mut writer)?;
        let n_bytes = writer.finish()?;
        self.make_room(n_bytes)?;
        part.persist(self.0.folder.join(name)).map_err(|error| error.error)?;
        Ok(())
    }

    /// Makes the folder where it is missing. Only one that is made here is all of it a cache, and says so to backup programs.
    fn make_folder(&self) -> std::io::Result<()> {
        if self.0.folder.is_dir() {
            return Ok(());
        }
        if let Some(parent) = self.0.folder.parent() {
            std::fs::create_dir_all(parent)?;
        }
        match std::fs::create_dir(&self.0.folder) {
            Ok(()) => std::fs::write(self.0.folder.join(TAG), TAG_TEXT),
            // Another process was faster.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => Ok(()),
            Err(error) => Err(error),
        }
    }

    /// Removes what was used longest ago until so many bytes more are no more than allowed.
    fn make_room(&self, n_bytes: u64) -> std::io::Result<()> {
        let mut entries = Vec::new();
        for file in std::fs::read_dir(&self.0.folder)? {
            let Ok(file) = file else { continue };
            let (name, Ok(facts)) = (file.file_name(), file.metadata()) else { continue };
            let (Some(name), Ok(used)) = (name.to_str(), facts.modified()) else { continue };
            if kind_of(name).is_some() {
                entries.push((used, facts.len(), name.to_owned()));
            } else if is_part(name) && used.elapsed().is_ok_and(|age| age > ABANDONED) {
                let _ = std::fs::remove_file(file.path());
            }
        }
        entries.sort();
        let mut total = entries.iter().map(|(_, n_bytes, _)| n_bytes).sum::<u64>() + n_bytes;
        for (_, n_bytes, name) in entries {
            if total <= self.0.max_bytes {
                break;
            }
            match std::fs::remove_file(self.0.folder.join(&name)) {
                Ok(()) => {}
                // Another process was faster.
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                Err(_) => continue,
            }
            total -= n_bytes;
            if let Some(kind) = locked(&self.0.own).remove(&name) {
                let reason = format!("{}: the cache has no room for all results of the run", kind.name());
                locked(&self.0.tally).not_kept = Some(reason);
            }
        }
        Ok(())
    }
}

/// What is under the name of an entry.
enum Found<T> {
    Result(T),
    /// Nothing, or nothing that there is memory for.
    Nothing,
    /// Other bytes than were written, or what is no file.
    Damaged,
    /// The system does not say.
    Unreadable,
}

fn found<T>(path: &Path, key: &Digest, read: impl FnOnce(&mut Reader<'_>) -> Option<T>) -> Found<T> {
    match std::fs::symlink_metadata(path) {
        Ok(facts) if facts.is_file() => {}
        // A pipe or a device may have no end.
        Ok(_) => return Found::Damaged,
        Err(error) if error.kind() == ErrorKind::NotFound => return Found::Nothing,
        Err(_) => return Found::Unreadable,
    }
    let file = match File::open(path) {
        Ok(file) => file,
        // Another process has made room.
        Err(error) if error.kind() == ErrorKind::NotFound => return Found::Nothing,
        Err(_) => return Found::Unreadable,
    };
    let Some(mut reader) = Reader::new(&file, key) else { return Found::Damaged };
    match read(&mut reader) {
        None if reader.lacks_memory => Found::Nothing,
        Some(found) if reader.ends_whole() => Found::Result(found),
        _ => Found::Damaged,
    }
}

/// The kind of an entry that has its name; none of any other file.
fn kind_of(name: &str) -> Option<Kind> {
    let (kind, key) = name.strip_suffix(ENTRY)?.split_once('-')?;
    let is_key = key.len() == 64 && key.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'));
    Kind::ALL.into_iter().find(|known| is_key && known.name() == kind)
}

fn name_of(kind: Kind, key: &Digest) -> String {
    let mut name = format!("{}-", kind.name());
    key.iter().for_each(|byte| write!(name, "{byte:02x}").expect("a string takes all"));
    name + ENTRY
}

fn is_part(name: &str) -> bool {
    name.starts_with(PART[0]) && name.ends_with(PART[1])
}

/// A file for an entry that is being written. Who may read files of this user may read it, as the umask says.
fn new_part(folder: &Path) -> std::io::Result<tempfile::NamedTempFile> {
    let mut part = tempfile::Builder::new();
    part.prefix(PART[0]).suffix(PART[1]);
    #[cfg(unix)]
    part.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    part.tempfile_in(folder)
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
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

    fn path_of(cache: &Cache, n: u32) -> PathBuf {
        cache.0.folder.join(name_of(KIND, &key(n).digest()))
    }

    fn keep(cache: &Cache, n: u32) {
        cache.keep(KIND, &key(n), |to| to.array(&numbers(n)));
    }

    fn taken(cache: &Cache, n: u32) -> Option<Vec<u32>> {
        cache.take(KIND, &key(n).digest(), |from| from.array())
    }

    /// One entry is 14 + 32 + 9 + 400 + 32 bytes.
    const ENTRY_BYTES: u64 = 487;

    fn cache(folder: &Path, n_entries: u64) -> Cache {
        Cache::at(folder, n_entries * ENTRY_BYTES).expect("a folder")
    }

    fn used_at(cache: &Cache, n: u32, seconds: u64) {
        let file = File::options().append(true).open(path_of(cache, n)).expect("an entry");
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
        let path = path_of(&second, 1);
        assert_eq!(path.metadata().expect("an entry").len(), ENTRY_BYTES);
        assert_eq!((first.tally().kept, first.tally().taken), ([(KIND, 1)].into(), BTreeMap::new()));
        assert_eq!((second.tally().kept, second.tally().taken), (BTreeMap::new(), [(KIND, 1)].into()));
    }

    /// Every byte decides, and so does every length.
    #[test]
    fn damaged_entries_are_removed_and_not_taken() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path(), 9);
        let path = path_of(&cache, 1);
        keep(&cache, 1);
        let sound = std::fs::read(&path).expect("an entry");
        let flipped = (0..sound.len()).map(|at| {
            let mut bytes = sound.clone();
            bytes[at] ^= 1;
            bytes
        });
        let cut = (0..sound.len()).map(|length| sound[..length].to_vec());
        let longer = [[sound.clone(), vec![0]].concat(), [sound.clone(), sound.clone()].concat()];
        for bytes in flipped.chain(cut).chain(longer) {
            std::fs::write(&path, &bytes).expect("written");
            assert_eq!(taken(&cache, 1), None);
            assert!(!path.exists());
            assert_eq!(cache.tally().damaged, [name_of(KIND, &key(1).digest())].into());
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
        std::fs::rename(path_of(&cache, 1), path_of(&cache, 2)).expect("renamed");
        assert_eq!(taken(&cache, 2), None);
        keep(&cache, 3);
        type Shape<'a> = &'a dyn Fn(&mut Reader<'_>) -> Option<()>;
        let shapes: [Shape<'_>; 5] = [
            &|from| from.array::<f32>().map(|_| ()),
            &|from| from.number::<u32>().map(|_| ()),
            &|from| from.columns().map(|_| ()),
            &|from| from.array::<u32>().and_then(|_| from.array::<u32>()).map(|_| ()),
            // Something is left.
            &|_| Some(()),
        ];
        for shape in shapes {
            keep(&cache, 3);
            assert_eq!(cache.take(KIND, &key(3).digest(), shape), None);
        }
        std::fs::create_dir(path_of(&cache, 4)).expect("a folder");
        assert_eq!(taken(&cache, 4), None);
        keep(&cache, 4);
        assert!(cache.tally().not_kept.is_some(), "a folder is in its place");
    }

    #[test]
    fn what_was_used_longest_ago_goes_first_and_foreign_files_stay() {
        let folder = tempfile::tempdir().expect("a folder");
        let foreign = ["notes.entry", "factor-00.entry", "factor-zz.part", "K.mtx", "count-.entry"];
        foreign.iter().for_each(|name| std::fs::write(folder.path().join(name), "mine").expect("written"));
        let before = cache(folder.path(), 3);
        for (n, seconds) in [(1, 30), (2, 10), (3, 20)] {
            keep(&before, n);
            used_at(&before, n, seconds);
        }
        let cache = cache(folder.path(), 3);
        // It was used longest ago, and is used now.
        assert!(taken(&cache, 2).is_some());
        keep(&cache, 4);
        let left: Vec<u32> = (1..=4).filter(|n| path_of(&cache, *n).exists()).collect();
        assert_eq!(left, [1, 2, 4]);
        assert!(foreign.iter().all(|name| folder.path().join(name).exists()));
        assert_eq!(cache.tally().not_kept, None);
    }

    #[test]
    fn what_is_larger_than_the_cache_is_not_kept_and_nothing_goes_for_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path(), 2);
        keep(&cache, 1);
        cache.keep(KIND, &key(2), |to| to.array(&vec![0u32; 1000]));
        assert!(cache.tally().not_kept.is_some_and(|reason| reason.contains("larger")));
        assert_eq!(taken(&cache, 1), Some(numbers(1)));
        let files = std::fs::read_dir(folder.path()).expect("a folder").count();
        assert_eq!(files, 1, "one entry: no part is left");
    }

    #[test]
    fn parts_of_processes_that_are_gone_are_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path(), 9);
        let [old, new] = [".supel-cache-old.part", ".supel-cache-new.part"].map(|name| folder.path().join(name));
        [&old, &new].into_iter().for_each(|part| std::fs::write(part, "half").expect("written"));
        let file = File::options().append(true).open(&old).expect("a part");
        file.set_modified(SystemTime::now() - 2 * ABANDONED).expect("a time");
        keep(&cache, 1);
        assert!(!old.exists() && new.exists());
    }

    /// A folder that somebody else has made may hold more than results.
    #[test]
    fn a_folder_is_made_when_it_is_needed_and_only_one_that_is_made_gets_the_tag() {
        let place = tempfile::tempdir().expect("a folder");
        let tag = |folder: &Path| folder.join(TAG).exists();
        let made = place.path().join("a/b");
        let first = cache(&made, 9);
        assert!(!made.exists());
        keep(&first, 1);
        assert!(tag(&made) && taken(&first, 1).is_some());
        let given = cache(place.path(), 9);
        keep(&given, 1);
        assert!(!tag(place.path()) && taken(&given, 1).is_some());
        assert!(Cache::at(&path_of(&first, 1), 9).is_err(), "a file");
    }

    #[test]
    fn a_smaller_cache_is_made_smaller() {
        let folder = tempfile::tempdir().expect("a folder");
        let larger = cache(folder.path(), 3);
        for (n, seconds) in [(1, 20), (2, 30), (3, 10)] {
            keep(&larger, n);
            used_at(&larger, n, seconds);
        }
        let smaller = cache(folder.path(), 1);
        assert_eq!([1, 2, 3].map(|n| path_of(&smaller, n).exists()), [false, true, false]);
    }

    /// What a run has kept and had to give up again is not there for later ones.
    #[test]
    fn what_had_to_go_again_is_not_counted_as_kept() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path(), 2);
        for n in 1..=3 {
            keep(&cache, n);
        }
        let tally = cache.tally();
        assert_eq!(tally.kept, [(KIND, 2)].into());
        assert!(tally.not_kept.is_some_and(|reason| reason.contains("no room for all")));
    }

    /// Links, pipes and files that nobody may read are none of its entries, and no later run meets them again.
    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_named_and_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let cache = cache(folder.path(), 9);
        let other = folder.path().join("other");
        std::fs::write(&other, "mine").expect("written");
        let path = path_of(&cache, 1);
        for target in [&other, Path::new("/dev/zero"), Path::new("nowhere")] {
            std::os::unix::fs::symlink(target, &path).expect("a link");
            assert_eq!(taken(&cache, 1), None);
            assert!(path.symlink_metadata().is_err());
        }
        assert_eq!(cache.tally().damaged, [name_of(KIND, &key(1).digest())].into());
        assert_eq!(std::fs::read(&other).expect("still there"), b"mine");
    }
}
