//! A file appears whole or not at all, whatever happens while it is written.

use supel_models::superelements::particle as sample;

use std::fs;
use std::path::{Path, PathBuf};

use supel_runtime::{FileError, Method, StagedFile, Superelement, abandoned_parts, writer_of_part};

fn names_in(folder: &Path) -> Vec<String> {
    let mut names = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect::<Vec<_>>();
    names.sort();
    names
}

#[test]
fn written_file_is_read_back_and_leaves_nothing_next_to_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("part ü.supel");
    let superelement = sample::complete();
    let digest = superelement.write(&path).unwrap();
    assert_eq!(Superelement::open(&path).unwrap(), superelement);
    assert_eq!(fs::read(&path).unwrap(), superelement.to_bytes().unwrap().bytes);
    assert_eq!(digest, superelement.to_bytes().unwrap().digest);
    assert_eq!(names_in(folder.path()), ["part ü.supel"]);
    sample::two_particles().write(&path).unwrap();
    assert_eq!(Superelement::open(&path).unwrap(), sample::two_particles(), "an old file is replaced");
}

#[test]
fn staged_file_has_no_name_until_it_is_committed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.supel");
    let bytes = sample::two_particles().to_bytes().unwrap().bytes;
    let staged = StagedFile::write(&path, &bytes).unwrap();
    assert_eq!(staged.path().parent(), path.parent(), "same folder, so that renaming is one step");
    assert_eq!(Superelement::open(staged.path()).unwrap(), sample::two_particles());
    assert!(!path.exists());
    drop(staged);
    assert!(names_in(folder.path()).is_empty(), "given up without a trace");
    StagedFile::write(&path, &bytes).unwrap().commit().unwrap();
    assert_eq!(names_in(folder.path()), ["a.supel"]);
}

#[test]
fn two_writers_of_one_name_do_not_meet() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.supel");
    let first = StagedFile::write(&path, b"first").unwrap();
    let second = StagedFile::write(&path, b"second").unwrap();
    assert_ne!(first.path(), second.path());
    second.commit().unwrap();
    first.commit().unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"first", "the last one to commit wins");
    assert_eq!(names_in(folder.path()), ["a.supel"]);
}

#[test]
fn folder_that_does_not_exist() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("missing").join("a.supel");
    let error = sample::two_particles().write(&path).unwrap_err();
    assert!(matches!(&error, FileError::Write { path: named, .. } if *named == path), "{error:?}");
    assert!(error.is_io());
}

#[test]
fn name_of_a_folder_or_a_device_or_no_name() {
    let folder = tempfile::tempdir().unwrap();
    for path in [folder.path(), Path::new("/dev/null"), Path::new("/"), Path::new("..")] {
        let error = sample::two_particles().write(path).unwrap_err();
        assert!(matches!(error, FileError::NotAFile { .. }), "{}: {error:?}", path.display());
    }
    assert!(names_in(folder.path()).is_empty());
}

#[test]
fn renaming_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.supel");
    let staged = StagedFile::write(&path, b"new").unwrap();
    fs::create_dir(&path).unwrap();
    assert!(matches!(staged.commit(), Err(FileError::Write { .. })));
    assert_eq!(names_in(folder.path()), ["a.supel"], "the temporary file is removed");
}

#[test]
fn reading_what_is_not_there_or_not_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let missing = Superelement::open(&folder.path().join("none.supel")).unwrap_err();
    assert!(matches!(missing, FileError::Read { .. }), "{missing:?}");
    for path in [folder.path(), Path::new("/dev/zero")] {
        let error = Superelement::open(path).unwrap_err();
        assert!(matches!(error, FileError::NotAFile { .. }), "{error:?}");
    }
}

/// A sparse file of 2^61 bytes of numbers behind this header, where a file system here holds one.
fn huge(header: &str) -> Option<(tempfile::TempDir, PathBuf)> {
    let bytes = [&(header.len() as u64).to_le_bytes(), header.as_bytes()].concat();
    let huge = ["/dev/shm", "/tmp"].into_iter().find_map(|folder| {
        let folder = tempfile::tempdir_in(folder).ok()?;
        let path = folder.path().join("huge.supel");
        fs::write(&path, &bytes).ok()?;
        let file = fs::File::options().write(true).open(&path).ok()?;
        file.set_len(bytes.len() as u64 + (1 << 61)).ok().map(|()| (folder, path))
    });
    if huge.is_none() {
        println!("skipped: no file system here holds a sparse file of 2^61 bytes");
    }
    huge
}

/// The header of a superelement with one matrix of 2^29 × 2^29.
fn header_of_a_huge_matrix() -> String {
    let sealed = sample::two_particles().to_bytes().unwrap().bytes;
    let length = u64::from_le_bytes(sealed[..8].try_into().unwrap()) as usize;
    let header: serde_json::Value = serde_json::from_slice(&sealed[8..8 + length]).unwrap();
    let metadata = &header["__metadata__"];
    let (order, end) = (1_u64 << 29, 1_u64 << 61);
    format!(
        "{{\"__metadata__\":{metadata},\"stiffness\":{{\"dtype\":\"F64\",\"shape\":[{order},{order}],\"data_offsets\":[0,{end}]}}}}"
    )
}

#[test]
fn file_larger_than_the_memory() {
    let Some((_folder, path)) = huge(&header_of_a_huge_matrix()) else { return };
    let error = Superelement::open(&path).unwrap_err();
    assert!(matches!(error, FileError::OutOfMemory { bytes } if bytes > 1 << 61), "{error:?}");
}

/// What the header shows is told before a number is read: these files would not fit into any memory.
#[test]
fn large_files_are_refused_by_their_headers() {
    let sound = header_of_a_huge_matrix();
    let refusal = |header: &str| huge(header).map(|(_folder, path)| Superelement::open(&path).unwrap_err());
    let Some(error) = refusal("") else { return };
    assert!(matches!(error, FileError::HeaderNotObject), "{error:?}");
    let error = refusal(&sound.replace("__metadata__", "metadata")).unwrap();
    assert!(matches!(error, FileError::MetadataMissing), "{error:?}");
    let error = refusal(&sound.replace("2305843009213693952", "2305843009213693944")).unwrap();
    assert!(matches!(error, FileError::TensorSize { .. }), "{error:?}");
    let error =
        refusal(&sound.replace("\\\"format_version\\\":\\\"1\\\"", "\\\"format_version\\\":\\\"0\\\"")).unwrap();
    assert!(matches!(error, FileError::UnknownVersion { .. }), "{error:?}");
}

fn staged(folder: &Path, name: &str, text: &str) -> StagedFile {
    StagedFile::write(&folder.join(name), text.as_bytes()).unwrap()
}

#[test]
fn files_get_their_names_together() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("b"), "old b").unwrap();
    let files = ["a", "b", "c"].map(|name| staged(folder.path(), name, &format!("new {name}")));
    StagedFile::commit_all(files.into()).unwrap();
    assert_eq!(names_in(folder.path()), ["a", "b", "c"]);
    assert_eq!(fs::read(folder.path().join("b")).unwrap(), b"new b");
    StagedFile::commit_all(Vec::new()).unwrap();
}

/// The last name is taken by a folder: the others are given back.
#[test]
fn files_get_their_names_together_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("b"), "old b").unwrap();
    for refused in ["a", "b", "c"] {
        let files = ["a", "b", "c"].map(|name| staged(folder.path(), name, "new"));
        let (path, kept) = (folder.path().join(refused), folder.path().join("kept"));
        let is_there = fs::rename(&path, &kept).is_ok();
        fs::create_dir(&path).unwrap();
        let error = StagedFile::commit_all(files.into()).unwrap_err();
        assert!(matches!(&error, FileError::Write { path: named, .. } if *named == path), "{error:?}");
        fs::remove_dir(&path).unwrap();
        if is_there {
            fs::rename(&kept, &path).unwrap();
        }
        assert_eq!(names_in(folder.path()), ["b"], "{refused}");
        assert_eq!(fs::read(folder.path().join("b")).unwrap(), b"old b");
    }
}

#[test]
fn reader_sees_the_old_file_or_the_new_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.supel");
    let versions = [Method::CraigBampton, Method::Herting].map(sample::component);
    versions[0].write(&path).unwrap();
    std::thread::scope(|scope| {
        let writer = scope.spawn(|| (0..100).try_for_each(|turn| versions[turn % 2].write(&path).map(drop)));
        let mut readings = 0;
        while !writer.is_finished() || readings == 0 {
            assert!(versions.contains(&Superelement::open(&path).unwrap()));
            readings += 1;
        }
        writer.join().unwrap().unwrap();
    });
}

/// Name of the environment variable that turns [`writes_when_told`] into the process that is stopped while it writes.
#[cfg(unix)]
const TARGET: &str = "SUPEL_TEST_WRITE_TARGET";

/// Body of the process that the two tests below start; in a plain test run there is nothing for it to do.
#[cfg(unix)]
#[test]
fn writes_when_told() {
    let Some(target) = std::env::var_os(TARGET).map(PathBuf::from) else {
        return;
    };
    let error = sample::complete().write(&target).unwrap_err();
    assert!(matches!(error, FileError::Write { .. }), "{error:?}");
}

/// Writes over an old file in a process whose files may hold only one block, and returns the folder afterwards.
#[cfg(unix)]
fn write_with_too_little_room(on_signal: &str) -> (tempfile::TempDir, PathBuf, std::process::ExitStatus) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.supel");
    sample::two_particles().write(&path).unwrap();
    let status = std::process::Command::new("sh")
        .args(["-c", &format!("{on_signal} ulimit -c 0; ulimit -f 1; exec \"$0\" --exact writes_when_told")])
        .arg(std::env::current_exe().unwrap())
        .env(TARGET, &path)
        .stdout(std::process::Stdio::null())
        .status()
        .unwrap();
    assert_eq!(Superelement::open(&path).unwrap(), sample::two_particles(), "the old file is intact");
    (folder, path, status)
}

/// The limit on the size of files stands for a full disk: writing fails in the middle.
#[cfg(unix)]
#[test]
fn disk_full() {
    let (folder, path, status) = write_with_too_little_room("trap '' XFSZ;");
    assert!(status.success(), "the write must fail with an error, and only that: {status}");
    assert_eq!(names_in(folder.path()), ["a.supel"], "the temporary file is removed");
    assert!(abandoned_parts(&path).is_empty());
}

/// Without the trap the same limit kills the process in the middle of writing.
#[cfg(unix)]
#[test]
fn killed_while_writing() {
    let (folder, path, status) = write_with_too_little_room("");
    assert!(!status.success());
    let parts = abandoned_parts(&path);
    assert_eq!(parts.len(), 1, "{:?}", names_in(folder.path()));
    assert!(parts[0].to_string_lossy().ends_with(".part"));
    assert!(writer_of_part(&parts[0]).is_some_and(|writer| writer != std::process::id()), "{parts:?}");
    assert_eq!(writer_of_part(&path), None);
    sample::complete().write(&path).unwrap();
    assert_eq!(Superelement::open(&path).unwrap(), sample::complete(), "what was left does not hinder the next writer");
}
