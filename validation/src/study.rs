//! All variants of one example, with what the paper says about them.

use std::path::Path;

use supel_runtime::Superelement;
use supel_runtime::component::Measures;

use crate::Result;
use crate::curve::{Curves, Misfit};
use crate::examples::{Example, Run, Variant, motion_based, reduced_parts};
use crate::integrator::{Effort, IterationMatrix, Scheme};
use crate::part::reduced_by_command;

/// What was computed for one example.
#[derive(Clone, Debug)]
pub struct Study {
    /// The example.
    pub example: Example,
    /// Its reference.
    pub reference: Curves,
    /// Every variant of the paper.
    pub runs: Vec<(Variant, Run)>,
    /// Effort of the motion-based variants at other tolerances; none where a run stopped.
    pub efforts: Vec<(Variant, f64, Option<Effort>)>,
    /// Effort of the motion-based variants with an iteration matrix that never changes, at the tolerance at which iterations
    /// are judged; none where a run stopped.
    pub constant: Vec<(Variant, Option<Effort>)>,
    /// Whether `supel reduce` gave the same superelements as the library, to the last bit; none where it was not tried.
    pub same_by_command: Option<bool>,
}

impl Study {
    /// Reduces the parts and runs all variants; files of the parts are left in `folder`.
    ///
    /// # Errors
    /// The errors of the reduction and of the reference.
    pub fn new(example: Example, folder: &Path, program: Option<&Path>) -> Result<Self> {
        let mut study = Self {
            example,
            reference: example.reference()?,
            runs: Vec::new(),
            efforts: Vec::new(),
            constant: Vec::new(),
            same_by_command: program.map(|_| true),
        };
        let mut layouts: Vec<usize> = example.models().iter().map(|model| model.0).collect();
        layouts.sort_unstable();
        layouts.dedup();
        for layout in layouts {
            let (parts, folder) = (example.parts(layout), folder.join(format!("layout-{layout}")));
            let superelements = reduced_parts(&parts, &folder)?;
            if let Some(program) = program {
                for (part, own) in parts.iter().zip(&superelements) {
                    let other = reduced_by_command(program, &folder.join(&part.name).join("job.toml"))?;
                    study.same_by_command = study.same_by_command.map(|same| same && other == *own);
                }
            }
            study.run(layout, &superelements)?;
        }
        Ok(study)
    }

    fn run(&mut self, layout: usize, parts: &[Superelement]) -> Result<()> {
        for &(_, n_modes) in self.example.models().iter().filter(|model| model.0 == layout) {
            for measures in [Measures::MotionBased, Measures::Classical] {
                let variant = Variant { layout, n_modes, measures };
                self.runs.push((variant, self.example.run(parts, &variant, None)?));
            }
            let Some(own) = self.example.scheme() else { continue };
            let variant = motion_based(layout, n_modes);
            for &tolerance in self.example.tolerances() {
                let run = self.example.run(parts, &variant, Some(Scheme { tolerance, ..own }))?;
                self.efforts.push((variant, tolerance, run.stopped.is_none().then_some(run.effort)));
            }
            let constant = Scheme { matrix: IterationMatrix::Constant, tolerance: self.example.counted_at(), ..own };
            let run = self.example.run(parts, &variant, Some(constant))?;
            self.constant.push((variant, run.stopped.is_none().then_some(run.effort)));
        }
        Ok(())
    }

    /// The run of a variant.
    ///
    /// # Panics
    /// If the example has no such variant.
    pub fn of(&self, variant: Variant) -> &Run {
        let found = self.runs.iter().find(|(other, _)| *other == variant);
        &found.unwrap_or_else(|| panic!("{} has no {}", self.example.name(), variant.slug())).1
    }

    /// Misfit of a column against the same column of the reference within a window; none where the run stopped.
    pub fn misfit(&self, variant: Variant, column: usize, window: [f64; 2]) -> Option<Misfit> {
        let run = self.of(variant);
        run.stopped.is_none().then(|| run.curves.misfit(column, (&self.reference, column), window))
    }
}

/// Mean iterations per step of each variant at a tolerance, with the matrices beyond the first; how many variants stop.
pub fn taken(study: &Study, tolerance: f64) -> String {
    let entry = |model: &(usize, usize)| {
        let variant = motion_based(model.0, model.1);
        study.efforts.iter().find(|entry| entry.0 == variant && entry.1 == tolerance).and_then(|entry| entry.2)
    };
    let own: Vec<Option<Effort>> = study.example.models().iter().map(entry).collect();
    let one = |effort: &Effort| match effort.renewals {
        0 => format!("{:.1}", effort.mean()),
        n => format!("{:.1} (matrix renewed {n} times)", effort.mean()),
    };
    let counts: Vec<String> =
        own.iter().map(|effort| effort.as_ref().map_or_else(|| "stops".to_owned(), one)).collect();
    let stopped = own.iter().filter(|effort| effort.is_none()).count();
    let note = if stopped > 0 { format!(" ({stopped} of {} stop)", own.len()) } else { String::new() };
    counts.join(", ") + &note
}
