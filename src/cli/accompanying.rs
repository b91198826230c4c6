//! The report in the folder of a superelement: whether it is of that file.
//!
//! All outputs of a run are renamed together. A run that is killed in between leaves a new report next to the superelement of an
//! earlier run, and so does a run that failed a check.

use std::io::Read;
use std::path::{Path, PathBuf};

use supel_runtime::Superelement;

use crate::audit::flaw;
use crate::linked;
use crate::regular_file;
use crate::report::RecordedReport;
use crate::verification::check::Check;

/// More than the report of any run takes.
const MAX_BYTES: u64 = 1 << 28;

/// M-26: the report carries the digest of the superelement; none where there is no report.
pub(super) fn check(file: &Path, superelement: &Superelement, digest: &str) -> Option<Check> {
    let (path, report) = reports(file, superelement).find_map(|path| read(&path).map(|report| (path, report)))?;
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let difference = match report.file_digest() {
        Some(recorded) if recorded == digest => None,
        Some(recorded) => Some(format!("{name} is of a file with BLAKE3 {recorded}")),
        None => Some(format!("{name} is of a run that wrote no superelement")),
    };
    let (name, equation) =
        ("report in its folder names this file", "1 where the report carries another digest, else 0");
    // The file itself is as good as it was.
    Some(Check { fail_above: Check::NEVER, ..flaw(name, equation, difference.as_slice()) })
}

/// Where the report of a run stands if it was not moved: under the name that the job kept in the file gives it, next to the file itself,
/// or next to the link through which it was reached. What else that job says of folders is not followed.
fn reports(file: &Path, superelement: &Superelement) -> impl Iterator<Item = PathBuf> {
    let asked = superelement.metadata().job["write"]["report"].as_str().map(PathBuf::from);
    let next_to = move |file: PathBuf| {
        let name = asked.clone().unwrap_or_else(|| file.with_extension("report.json"));
        Some(file.with_file_name(name.file_name()?))
    };
    linked::target(file).into_iter().chain([file.to_owned()]).filter_map(next_to)
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
