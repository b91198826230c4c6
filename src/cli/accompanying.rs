//! The report, the page and the JUnit file in the folder of a superelement: whether they are of that file.
//!
//! All outputs of a run are renamed together. A run that is killed in between leaves a new report next to the superelement of an
//! earlier run, and so does a run that failed a check.

use std::io::Read;
use std::path::{Path, PathBuf};

use supel_runtime::Superelement;

use crate::audit::flaw;
use crate::linked;
use crate::regular_file;
use crate::report::{RecordedReport, WrittenWith};
use crate::verification::check::Check;

/// More than the report of any run takes.
const MAX_BYTES: u64 = 1 << 28;
/// More than what a page has before it says what it is of: its style.
const HEAD_BYTES: u64 = 1 << 18;
/// Files of a folder that are looked at.
const MAX_ENTRIES: usize = 10_000;

/// M-26: report, pages and JUnit files carry the digest of the superelement; none where there is none of them.
pub(super) fn check(file: &Path, superelement: &Superelement, digest: &str) -> Option<Check> {
    let report = reports(file, superelement).find_map(|path| of_report(&path).map(|found| (path, found)));
    let mut found: Vec<(PathBuf, Option<String>)> = report.into_iter().collect();
    let mut others: Vec<(PathBuf, Option<String>)> = places(file).iter().flat_map(|file| pages(file)).collect();
    others.sort();
    others.dedup();
    found.extend(others);
    if found.is_empty() {
        return None;
    }
    let difference = |(path, written): &(PathBuf, Option<String>)| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        match written {
            Some(recorded) if recorded == digest => None,
            Some(recorded) => Some(format!("{name} is of a file with BLAKE3 {recorded}")),
            None => Some(format!("{name} is of a run that wrote no superelement")),
        }
    };
    let differences: Vec<String> = found.iter().filter_map(difference).collect();
    let (name, equation) =
        ("report in its folder names this file", "1 where report, page or JUnit file carries another digest, else 0");
    // The file itself is as good as it was.
    Some(Check { fail_above: Check::NEVER, ..flaw(name, equation, &differences) })
}

/// Where a superelement is, and the link through which it was reached.
fn places(file: &Path) -> Vec<PathBuf> {
    linked::target(file).into_iter().chain([file.to_owned()]).collect()
}

/// Where the report of a run stands if it was not moved: under the name that the job kept in the file gives it, next to the file itself,
/// or next to the link through which it was reached. What else that job says of folders is not followed.
fn reports(file: &Path, superelement: &Superelement) -> impl Iterator<Item = PathBuf> {
    let asked = superelement.metadata().job["write"]["report"].as_str().map(PathBuf::from);
    let next_to = move |file: PathBuf| {
        let name = asked.clone().unwrap_or_else(|| file.with_extension("report.json"));
        Some(file.with_file_name(name.file_name()?))
    };
    places(file).into_iter().filter_map(next_to)
}

fn of_report(path: &Path) -> Option<Option<String>> {
    Some(read(path)?.file_digest().map(str::to_owned))
}

/// Pages and JUnit files next to a superelement that name it, whatever their own names, with the digest that they carry. One of a run that
/// wrote none names none: it belongs to the superelement that shares its name.
fn pages(file: &Path) -> Vec<(PathBuf, Option<String>)> {
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let of = |path: PathBuf| {
        let written = match path.extension()?.to_str()? {
            "html" => WrittenWith::of_page(&head(&path)?, &name)?,
            "xml" => WrittenWith::of_junit(&head(&path)?, &name)?,
            _ => return None,
        };
        match written {
            WrittenWith::Superelement { is_named: true, digest } => Some((path, Some(digest))),
            WrittenWith::None if path.file_stem() == file.file_stem() => Some((path, None)),
            WrittenWith::Superelement { .. } | WrittenWith::None => None,
        }
    };
    entries.flatten().take(MAX_ENTRIES).filter_map(|entry| of(entry.path())).collect()
}

/// The beginning of a text, where pages and JUnit files say what they are of.
fn head(path: &Path) -> Option<String> {
    let mut bytes = Vec::new();
    regular_file::open(path).ok()?.take(HEAD_BYTES).read_to_end(&mut bytes).ok()?;
    Some(String::from_utf8_lossy(&bytes).into_owned())
}

/// The document, if it is a report.
pub(super) fn read(path: &Path) -> Option<RecordedReport> {
    RecordedReport::parse(&bytes(path)?)
}

/// What a file that was written with a superelement holds; none where it cannot be read.
pub(super) fn bytes(path: &Path) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    regular_file::open(path).ok()?.take(MAX_BYTES).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}
