//! Files that a run has not finished: removed wherever the process ends before they get their names, because memory runs out or a signal
//! comes.
//!
//! Both come at moments at which nothing can be locked or allocated. So each name stands ready as the system takes it, in a place that
//! one atomic operation fills and empties.

use std::path::Path;
use std::sync::atomic::{AtomicPtr, Ordering};

#[cfg(unix)]
type Name = std::ffi::CString;
#[cfg(not(unix))]
type Name = std::path::PathBuf;

/// The files of one run and some more.
const MAX_FILES: usize = 16;

static FILES: [AtomicPtr<Name>; MAX_FILES] = [const { AtomicPtr::new(std::ptr::null_mut()) }; MAX_FILES];

/// Has a file removed where the process ends early. Its name is never freed: whoever ends the process may be reading it.
pub(crate) fn remove_at_end(file: &Path) {
    let Some(name) = name(file) else { return };
    let name = Box::into_raw(Box::new(name));
    let is_free = |place: &AtomicPtr<Name>| {
        place.compare_exchange(std::ptr::null_mut(), name, Ordering::SeqCst, Ordering::SeqCst)
    };
    // Beyond the last place a file is left behind, and the next run names it.
    let _ = FILES.iter().any(|place| is_free(place).is_ok());
}

/// Has no file removed any more.
pub(crate) fn keep_all() {
    FILES.iter().for_each(|place| place.store(std::ptr::null_mut(), Ordering::SeqCst));
}

/// A file that is removed where the process ends while this value lives.
pub(crate) struct RemovedAtEnd(Option<Name>);

impl RemovedAtEnd {
    pub(crate) fn of(file: &Path) -> Self {
        remove_at_end(file);
        Self(name(file))
    }
}

impl Drop for RemovedAtEnd {
    #[allow(unsafe_code)]
    fn drop(&mut self) {
        for place in &FILES {
            let held = place.load(Ordering::SeqCst);
            // SAFETY: null, or a box that `remove_at_end` leaked.
            if unsafe { held.as_ref() } == self.0.as_ref() {
                let _ = place.compare_exchange(held, std::ptr::null_mut(), Ordering::SeqCst, Ordering::SeqCst);
            }
        }
    }
}

/// Removes the files. A signal handler may call it: it neither locks nor allocates.
#[allow(unsafe_code)]
pub(crate) fn remove_all() {
    for place in &FILES {
        // SAFETY: null, or a box that `remove_at_end` leaked.
        if let Some(name) = unsafe { place.swap(std::ptr::null_mut(), Ordering::SeqCst).as_ref() } {
            remove(name);
        }
    }
}

#[cfg(unix)]
fn name(file: &Path) -> Option<Name> {
    use std::os::unix::ffi::OsStrExt;

    Name::new(file.as_os_str().as_bytes()).ok()
}

#[cfg(not(unix))]
fn name(file: &Path) -> Option<Name> {
    Some(file.to_owned())
}

#[cfg(unix)]
#[allow(unsafe_code)]
fn remove(name: &Name) {
    // SAFETY: a string that ends with a zero. Where the system refuses, the next run names the file.
    unsafe { libc::unlink(name.as_ptr()) };
}

#[cfg(not(unix))]
fn remove(name: &Name) {
    let _ = std::fs::remove_file(name);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_stays_and_the_rest_goes() {
        let folder = tempfile::tempdir().expect("a folder");
        let files: Vec<_> = (0..MAX_FILES + 1).map(|k| folder.path().join(format!("{k}.part"))).collect();
        files.iter().for_each(|file| std::fs::write(file, "").expect("written"));

        remove_at_end(&files[0]);
        keep_all();
        remove_all();
        assert!(files.iter().all(|file| file.exists()));

        files.iter().for_each(|file| remove_at_end(file));
        remove_all();
        // One more than there are places.
        let left: Vec<_> = files.iter().filter(|file| file.exists()).collect();
        assert_eq!(left, [&files[MAX_FILES]]);
    }
}
