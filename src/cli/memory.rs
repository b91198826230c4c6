//! How much memory is free for a run, and sizes that are typed.

use std::fs;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::memory_forecast::bytes_of_gib;

/// The share of what is free that a run may plan with; the rest is for what a forecast does not count.
const USABLE: f64 = 0.9;

/// Bytes of a size in GiB; `key` says where it was typed.
///
/// # Errors
/// [`Error::JobNumber`] where it is not more than zero, or has no end.
pub(super) fn typed_bytes(key: &str, gib: f64) -> Result<u64> {
    match gib > 0.0 && gib.is_finite() {
        true => Ok(bytes_of_gib(gib)),
        false => Err(Error::JobNumber { key: key.to_owned(), value: gib, expected: "more than zero" }),
    }
}

/// Bytes a run may plan with: what the system says is available, or less where a control group or a limit of the process allows
/// less.
pub(super) fn available_bytes() -> Option<u64> {
    available_below(Path::new("/"))
}

/// Bytes a run may plan with, by the system's files below `root`.
fn available_below(root: &Path) -> Option<u64> {
    let free =
        [system_bytes(root), control_group_bytes(root), address_space_bytes(root)].into_iter().flatten().min()?;
    Some((free as f64 * USABLE) as u64)
}

/// MemAvailable: free memory and the caches that the kernel would give up.
fn system_bytes(root: &Path) -> Option<u64> {
    let facts = fs::read_to_string(root.join("proc/meminfo")).ok()?;
    let line = facts.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.split_whitespace().next()?.parse().ok()?;
    kib.checked_mul(1024)
}

/// What the limit on addresses (`ulimit -v`) leaves beyond those in use.
fn address_space_bytes(root: &Path) -> Option<u64> {
    let limits = fs::read_to_string(root.join("proc/self/limits")).ok()?;
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let limit: u64 = line.split_whitespace().next()?.parse().ok()?;
    let status = fs::read_to_string(root.join("proc/self/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmSize:"))?;
    let kib: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(limit.saturating_sub(kib.saturating_mul(1024)))
}

/// The files of one version of control groups.
struct Version {
    mount: &'static str,
    limit: &'static str,
    usage: &'static str,
    reclaimable: &'static str,
}

const V1: Version = Version {
    mount: "sys/fs/cgroup/memory",
    limit: "memory.limit_in_bytes",
    usage: "memory.usage_in_bytes",
    reclaimable: "total_inactive_file ",
};
const V2: Version =
    Version { mount: "sys/fs/cgroup", limit: "memory.max", usage: "memory.current", reclaimable: "inactive_file " };

/// The least that the control groups of this process leave, from its own up to the outermost.
fn control_group_bytes(root: &Path) -> Option<u64> {
    let groups = fs::read_to_string(root.join("proc/self/cgroup")).ok()?;
    let of_line = |line: &str| {
        // hierarchy:controllers:path; version 2 is hierarchy 0 without controllers.
        let mut fields = line.splitn(3, ':');
        let (hierarchy, controllers, path) = (fields.next()?, fields.next()?, fields.next()?);
        let version = match (hierarchy, controllers) {
            ("0", "") => V2,
            (_, names) if names.split(',').any(|name| name == "memory") => V1,
            _ => return None,
        };
        let mount = root.join(version.mount);
        let own = mount.join(path.trim_start_matches('/'));
        own.ancestors()
            .take_while(|folder| folder.starts_with(&mount))
            .filter_map(|folder| left_in(folder, &version))
            .min()
    };
    groups.lines().filter_map(of_line).min()
}

/// Limit less use of one group; none where it has no limit (`max`) or its files are not visible.
fn left_in(folder: &Path, version: &Version) -> Option<u64> {
    let number = |path: PathBuf| fs::read_to_string(path).ok()?.trim().parse::<u64>().ok();
    let limit = number(folder.join(version.limit))?;
    let used = number(folder.join(version.usage))?;
    let facts = fs::read_to_string(folder.join("memory.stat")).unwrap_or_default();
    let reclaimable = facts.lines().find_map(|line| line.strip_prefix(version.reclaimable)?.trim().parse::<u64>().ok());
    Some(limit.saturating_sub(used.saturating_sub(reclaimable.unwrap_or(0))))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder that looks like the root of a system with these files.
    fn system(files: &[(&str, &str)]) -> tempfile::TempDir {
        let root = tempfile::tempdir().unwrap();
        for (name, content) in files {
            let path = root.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, content).unwrap();
        }
        root
    }

    const MEMINFO: (&str, &str) = ("proc/meminfo", "MemTotal: 9000 kB\nMemFree: 10 kB\nMemAvailable:    1000 kB\n");

    #[test]
    fn without_control_groups_nine_tenths_of_what_is_available() {
        assert_eq!(available_below(system(&[MEMINFO]).path()), Some(921_600));
        assert_eq!(available_below(system(&[]).path()), None);
    }

    #[test]
    fn the_tightest_control_group_decides() {
        let group = |limit: &'static str| {
            system(&[
                MEMINFO,
                ("proc/self/cgroup", "0::/outer/inner\n"),
                ("sys/fs/cgroup/outer/inner/memory.max", "max\n"),
                ("sys/fs/cgroup/outer/inner/memory.current", "100\n"),
                ("sys/fs/cgroup/outer/memory.max", limit),
                ("sys/fs/cgroup/outer/memory.current", "3000\n"),
                ("sys/fs/cgroup/outer/memory.stat", "anon 7\ninactive_file 2000\n"),
            ])
        };
        assert_eq!(available_below(group("11000\n").path()), Some(9000));
        assert_eq!(available_below(group("500\n").path()), Some(0));
        assert_eq!(available_below(group("99000000\n").path()), Some(921_600));
    }

    #[test]
    fn a_limit_on_addresses_counts() {
        let limited = |limit: &'static str| {
            let limits = ["Max cpu time unlimited unlimited seconds\n", limit].concat();
            let files = [
                MEMINFO,
                ("proc/self/limits", limits.as_str()),
                ("proc/self/status", "VmPeak: 9 kB\nVmSize: 100 kB\n"),
            ];
            available_below(system(&files).path())
        };
        assert_eq!(limited("Max address space 307200 unlimited bytes\n"), Some(184_320));
        assert_eq!(limited("Max address space 1024 unlimited bytes\n"), Some(0));
        assert_eq!(limited("Max address space unlimited unlimited bytes\n"), Some(921_600));
    }

    #[test]
    fn version_one_is_read_at_the_mount_where_the_own_group_is_hidden() {
        let root = system(&[
            MEMINFO,
            ("proc/self/cgroup", "5:cpu,memory:/docker/abc\n3:pids:/docker/abc\n"),
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", "20000\n"),
            ("sys/fs/cgroup/memory/memory.usage_in_bytes", "15000\n"),
            ("sys/fs/cgroup/memory/memory.stat", "inactive_file 1\ntotal_inactive_file 5000\n"),
        ]);
        assert_eq!(available_below(root.path()), Some(9000));
    }
}
