//! Wall time of each stage of a reduction, on the three families of parts.
//!
//! `cargo bench --bench stages` takes the sizes in `SUPEL_BENCH_DOFS` (default `10000`; the series of the documents is
//! `10000,100000,300000`) and the threads in `SUPEL_BENCH_THREADS` (default: all). A word after `--` filters: `-- factor`.
//!
//! Every stage is measured on what the stages before it made once. The reading is of text written for this; the order
//! of elimination is found within the partition.

use std::path::{Path, PathBuf};
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, SamplingMode, criterion_group, criterion_main};
use faer::Mat;
use supel::basis::{Basis, retained_columns};
use supel::constraint::{ConstraintModes, constraint_modes};
use supel::factor::{Analysis, Cholesky, SolveOperator};
use supel::job::Job;
use supel::model::Model;
use supel::modes::{Component, ModeSource, Retained, Search};
use supel::partition::Partition;
use supel::plan::Relief;
use supel::random::SEED;
use supel::reduction::Reduction;
use supel::rigid::{RigidBodyModes, interface_rank, rigid_body_modes, shift_of_factor};
use supel_models::{Family, Part};

/// Right-hand sides of one solve: a block of the Lanczos iteration.
const BLOCK: usize = 8;

/// What the stages before the factor made of the files of a part.
struct Prepared {
    job: Job,
    partition: Partition,
    rigid: RigidBodyModes,
    sigma: f64,
}

impl Prepared {
    fn new(folder: &Path) -> Self {
        let path = folder.join("job.toml");
        // Without comparisons with the full model, which are no stage of their own here.
        let lean = "[scene]\nboundaries = []\n[run]\ncertify = \"none\"\n";
        let text = std::fs::read_to_string(&path).expect("a job") + lean;
        let job = Job::parse(&text, &path).and_then(|job| job.resolve(folder)).expect("a job");
        let model = Model::new(supel::input::read(&job.model).expect("files")).expect("a sound model");
        let partition = Partition::new(model, &job.interfaces).expect("two faces");
        let (rigid, _) = rigid_body_modes(&partition).expect("six of them");
        let sigma = shift_of_factor(&partition, &rigid, interface_rank(&partition, &rigid).ok());
        Self { job, partition, rigid, sigma }
    }

    fn factor<'a>(&'a self, analysis: &'a Analysis) -> Cholesky<'a> {
        Cholesky::new(analysis, self.partition.pencil(), self.sigma, &|dof| self.partition.name_of(dof))
            .expect("definite")
    }

    fn component<'a>(
        &'a self,
        analysis: &'a Analysis,
        factor: &'a Cholesky<'a>,
        constraint: &'a ConstraintModes<'a>,
    ) -> Component<'a> {
        Component::new(&self.partition, analysis, factor, &self.rigid, Some(constraint))
    }

    fn lowest_modes(&self, component: Component<'_>) -> Retained {
        let search = Search::new(component, &self.job.reduction).expect("a search");
        let modes = search.lowest(SEED).expect("it converges");
        Retained::of(modes, search.problem.boundary)
    }
}

/// Writes the files of a part as `make-solid` does.
fn written(family: Family, dofs: usize) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("part-{}-{dofs}", family.name()));
    Part::new(family, dofs).write(&folder, 50).expect("a folder to write to");
    folder
}

fn stages(criterion: &mut Criterion) {
    let sizes = std::env::var("SUPEL_BENCH_DOFS").unwrap_or_else(|_| "10000".to_owned());
    for dofs in sizes.split(',').map(|word| word.trim().parse().expect("SUPEL_BENCH_DOFS: numbers with commas")) {
        for family in Family::ALL {
            measure(criterion, family, &written(family, dofs));
        }
    }
}

fn measure(criterion: &mut Criterion, family: Family, folder: &Path) {
    let prepared = Prepared::new(folder);
    let Prepared { job, partition, rigid, .. } = &prepared;
    let mut group = criterion.benchmark_group(family.name());
    group.sample_size(10).sampling_mode(SamplingMode::Flat).measurement_time(Duration::from_secs(3));
    let id = |stage: &str| BenchmarkId::new(stage, partition.n_dofs());

    let read = || supel::input::read(&job.model).expect("files");
    group.bench_function(id("read"), |b| b.iter(read));
    group.bench_function(id("order"), |b| {
        let order = |model| Partition::new(model, &job.interfaces).expect("two faces");
        b.iter_batched(|| Model::new(read()).expect("a sound model"), order, criterion::BatchSize::PerIteration);
    });
    group.bench_function(id("analyse"), |b| b.iter(|| prepared.partition.analysis().expect("memory")));
    let analysis = prepared.partition.analysis().expect("memory");
    group.bench_function(id("factor"), |b| b.iter(|| prepared.factor(&analysis)));
    let factor = prepared.factor(&analysis);
    let loads = Mat::from_fn(factor.n(), BLOCK, |i, j| f64::from(u8::from(i % BLOCK == j)));
    group.bench_function(id("solve"), |b| {
        b.iter_batched_ref(|| loads.clone(), |x| factor.solve_in_place(x.as_mut()), criterion::BatchSize::LargeInput);
    });
    group.bench_function(id("constraint modes"), |b| b.iter(|| constraint_modes(partition, &factor, rigid)));
    let constraint = constraint_modes(partition, &factor, rigid);
    let component = prepared.component(&analysis, &factor, &constraint);
    group.bench_function(id("Lanczos"), |b| b.iter(|| prepared.lowest_modes(component)));
    let retained = prepared.lowest_modes(component);
    let columns = retained_columns(component, &constraint, Relief::of_reduction(&job.reduction), &retained);
    let basis = Basis::new(&constraint, &columns, partition.internal().mass);
    group.bench_function(id("project"), |b| b.iter(|| Reduction::new(partition, &basis, rigid)));

    let outcome = supel::reduce(job, supel::memory_forecast::Resources::default(), &mut ()).expect("reduced");
    group.bench_function(id("write"), |b| b.iter(|| outcome.superelement.to_bytes().expect("bytes")));
    group.finish();
}

/// All stages on as many threads as were asked for, as the program runs them.
fn on_threads(criterion: &mut Criterion) {
    let n_threads = std::env::var("SUPEL_BENCH_THREADS").map_or(0, |word| word.parse().expect("a number of threads"));
    rayon::ThreadPoolBuilder::new().num_threads(n_threads).build_global().expect("threads");
    faer::set_global_parallelism(faer::Par::Seq);
    stages(criterion);
}

criterion_group!(benches, on_threads);
criterion_main!(benches);
