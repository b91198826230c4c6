//! What the run cost and where its files are; the only part that differs from run to run.

use super::front::in_words;
use super::markup::{Figure, Markup};
use super::plot;
use crate::number;
use crate::number::{counted, duration};
use crate::report::{RunFacts, StageTime, words};

pub(super) fn run(page: &mut Markup, run: &RunFacts) {
    let total: f64 = run.stages.iter().map(|stage| stage.seconds).sum();
    if run.stages.is_empty() {
        page.absent("No stage was timed.");
    } else {
        let each = run.stages.iter().map(|StageTime { name, seconds }| format!("{name} {}", duration(*seconds)));
        page.figure(&Figure {
            id: "figure-stages",
            svg: plot::stage_times(&run.stages),
            title: "Time of each stage".to_owned(),
            description: each.collect::<Vec<_>>().join(", ") + ".",
            caption: format!("{} in all.", duration(total)),
        });
    }
    let work = run.work;
    let counts = [
        counted(work.n_factorisations, "factorisation", "factorisations"),
        counted(work.n_solves, "solve", "solves"),
        counted(work.n_restarts, "restart", "restarts"),
        counted(run.n_threads, "thread", "threads"),
    ];
    let mut facts = vec![("Work", vec![counts.join(", ")])];
    if work.factor_nonzeros > 0 {
        facts.push((
            "Largest factor",
            vec![format!(
                "{} nonzeros, {} floating-point operations",
                number::count(work.factor_nonzeros),
                in_words(work.factor_flops, 2)
            )],
        ));
    }
    facts.extend(run.cache.as_ref().map(|tally| ("Cache", vec![words::cache(tally)])));
    facts.push(("Peak memory", run.peak_memory_bytes.map(number::bytes).into_iter().collect()));
    let path = |path: &Option<std::path::PathBuf>| path.as_ref().map(|path| path.display().to_string());
    let size = run.file_bytes.map(number::bytes);
    facts.push(("Superelement", path(&run.superelement).into_iter().chain(size).collect()));
    facts.push(("JSON report", path(&run.report).into_iter().collect()));
    page.facts(&facts);
}
