//! What was typed after `supel reduce --all`, checked: the jobs of a folder or of an assembly, each with the command line that runs it alone.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::Parser;

use super::assembly_command::joined;
use super::assembly_file::AssemblyFile;
use super::cache_choice::CacheChoice;
use super::flags::{CommandLine, OutputFlags, RunFlags, Typed};
use super::job_folder;
use super::judging::Answer;
use super::memory::typed_bytes;
use super::reduce_command::ReduceCommand;
use super::threads::Threads;
use crate::error::{Error, Result};

/// Reduce many jobs.
#[derive(Debug)]
pub(super) struct AllCommand {
    /// Each job once, in the order in which they are admitted.
    pub(super) members: Vec<Member>,
    /// The components in the order in which they are shown: their names, and which of the jobs makes each.
    pub(super) components: Vec<(String, usize)>,
    /// Pairs of selections.
    pub(super) joins: Vec<(String, String)>,
    /// TOML documents of the folder that are no jobs.
    pub(super) passed_over: Vec<PathBuf>,
    pub(super) threads: Threads,
    /// Memory for all that run at the same time, in bytes, where the command line says it.
    pub(super) budget_bytes: Option<u64>,
    pub(super) answer: Answer,
}

/// One of the jobs.
#[derive(Debug)]
pub(super) struct Member {
    pub(super) name: String,
    pub(super) document: PathBuf,
    /// The command line that reduces it, without the program's name, threads and memory.
    pub(super) words: Vec<OsString>,
    /// The checked command; where there is none, its run says why.
    pub(super) command: Option<Box<ReduceCommand>>,
}

impl AllCommand {
    /// # Errors
    /// [`Error::NoJobs`]; a folder or a file that cannot be read; those of [`AssemblyFile::read`]; [`Error::ComponentTwice`].
    pub(super) fn build(path: &Path, output: &OutputFlags, run: &RunFlags) -> Result<Self> {
        let is_folder =
            std::fs::metadata(path).map_err(|source| Error::Read { path: path.to_owned(), source })?.is_dir();
        let (jobs, joins, passed_over) = if is_folder {
            let found = job_folder::jobs_below(path)?;
            (found.jobs, Vec::new(), found.passed_over)
        } else {
            let assembly = AssemblyFile::read(path)?;
            let joins = assembly.joins.iter().map(|text| joined(text)).collect::<Result<_>>()?;
            (assembly.jobs, joins, Vec::new())
        };
        if jobs.is_empty() {
            return Err(Error::NoJobs { path: path.to_owned() });
        }
        let mut names = BTreeSet::new();
        if let Some((twice, _)) = jobs.iter().find(|(name, _)| !names.insert(name.as_str())) {
            return Err(Error::ComponentTwice { name: twice.clone() });
        }
        let budget_bytes = run.memory_gib.map(|gib| typed_bytes("--memory-gib", gib)).transpose()?;
        // Each run chooses its cache by itself; a size that is none is said once.
        CacheChoice::of(run)?;
        let (mut members, mut places, mut components) = (Vec::new(), Vec::new(), Vec::new());
        for (name, document) in jobs {
            let place = place(&document);
            let at = places.iter().position(|earlier| *earlier == place).unwrap_or(places.len());
            if at == places.len() {
                places.push(place);
                members.push(Member::of(name.clone(), document, (output, run)));
            }
            components.push((name, at));
        }
        Ok(Self {
            members,
            components,
            joins,
            passed_over,
            threads: Threads::of(run.threads),
            budget_bytes,
            answer: Answer::from((output.json, output.quiet)),
        })
    }
}

/// Where a document is: its name in its folder, whichever way leads there. A link is a document of its own, from whose folder paths count.
fn place(document: &Path) -> PathBuf {
    let folder = document.parent().and_then(|folder| folder.canonicalize().ok());
    folder.zip(document.file_name()).map_or_else(|| document.to_owned(), |(folder, name)| folder.join(name))
}

impl Member {
    fn of(name: String, document: PathBuf, (output, run): (&OutputFlags, &RunFlags)) -> Self {
        let passed_on =
            [("--allow-unverified", output.allow_unverified), ("--strict", output.strict), ("--force", run.force)];
        let passed_on = passed_on.into_iter().filter(|(_, is_given)| *is_given).map(|(flag, _)| flag);
        let mut words: Vec<OsString> = vec!["reduce".into(), document.clone().into(), "--json".into()];
        words.extend(passed_on.map(OsString::from));
        words.extend(CacheChoice::words(run));
        let command = checked(&words);
        Self { name, document, words, command }
    }
}

/// The command that words are, where they can be read and their job is one.
fn checked(words: &[OsString]) -> Option<Box<ReduceCommand>> {
    let words = std::iter::once(OsString::from("supel")).chain(words.iter().cloned());
    match CommandLine::try_parse_from(words).ok()?.command {
        Typed::Reduce(flags) => ReduceCommand::build(*flags).ok().map(Box::new),
        _ => None,
    }
}
