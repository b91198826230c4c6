//! Memory and threads that are not there.

use std::process::Command;

use supel::cost_forecast::Comparisons;
use supel::dofs::{Direction, Dof};
use supel::error::Error;
use supel::factor::{Analysis, Cholesky, Storage};
use supel::job::{Job, Precision};
use supel::memory_forecast::Resources;
use supel::memory_forecast::{Compared, slices_within_memory};
use supel::model::Model;
use supel::partition::Partition;
use supel::plan::Plan;
use supel::sparse::Pencil;
use supel::sparse::SparseMatrix;
use supel_models::{Ends, Material, brick, spring};

use crate::place::Place;

/// A star whose centre is eliminated first, so that its factor is full: n(n + 1)/2 entries from 3n − 2.
fn star(n: usize) -> SparseMatrix {
    let (mut pointers, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for row in 0..n {
        if row == 0 {
            columns.extend(0..n as u32);
            values.extend((0..n).map(|col| if col == 0 { n as f64 } else { -1.0 }));
        } else {
            columns.extend([0, row as u32]);
            values.extend([-1.0, 2.0]);
        }
        pointers.push(columns.len());
    }
    SparseMatrix::new((n, n), pointers, columns, values)
}

/// 70,000 dofs whose factor has more entries than 32 bits with a sign can count, 18.3 GiB and more: known to the last one
/// before a number is computed, and refused by the forecast (catalogue I-26).
#[test]
fn i_26_a_factor_beyond_32_bits_is_counted_and_refused() {
    let n = 70_000;
    let star = star(n);
    let analysis = Analysis::new(Pencil::new(&star, &star)).expect("an analysis");
    let exact = n * (n + 1) / 2;
    assert!(exact > 1 << 31);
    assert_eq!(analysis.nnz_factor, exact as f64);
    assert!(analysis.factor_bytes(Storage::Double) >= 8 * exact as u64);
    let text = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx" }
reduction = { method = "craig-bampton", modes = { count = 1 } }
write     = { superelement = "x.supel" }
"#;
    let job = Job::parse(text, "job.toml".as_ref()).expect("a job");
    let partition = crate::chain::partition(&spring(5, Ends::Fixed), &[]).expect("a chain");
    let resources = Resources { memory_bytes: Some(16 << 30), cache: None };
    let in_double = (Storage::Double, None);
    let error =
        slices_within_memory(&analysis, &partition, (&Plan::of(&job), Compared::default()), resources, in_double)
            .expect_err("more than 16 GiB");
    assert!(matches!(error, Error::MemoryForecast { factors, .. } if factors >= 8 * exact as u64), "{error}");
    let said = error.to_string();
    assert!(said.contains("– largest first: factors ") && said.ends_with("which needs fewer factors"), "{said}");
    assert_eq!(error.code(), "E-MEM");
}

/// A factor for which the system gives no memory is an error, not an abort. The limit holds for a process of its own.
#[cfg(target_os = "linux")]
#[test]
fn a_factor_that_cannot_be_allocated() {
    const LIMITED: &str = "SUPEL_TEST_WITHIN_LIMIT";
    if std::env::var_os(LIMITED).is_some() {
        let star = star(70_000);
        let pencil = Pencil::new(&star, &star);
        let analysis = Analysis::new(pencil).expect("an analysis");
        let error = Cholesky::new(&analysis, pencil, 0.0, &|dof| dof.to_string()).expect_err("no memory");
        assert!(matches!(error, Error::OutOfMemory { .. }), "{error}");
        assert_eq!(error.code(), "E-OUT-OF-MEMORY");
        return;
    }
    let own = std::env::current_exe().expect("this test");
    let name = "resources::a_factor_that_cannot_be_allocated";
    // Kibibytes of address space: a tenth of the factor, a hundred times what the analysis needs.
    let ended = Command::new("sh")
        .args(["-c", "ulimit -v 2000000 && exec \"$0\" --exact \"$1\" --test-threads=1"])
        .arg(own)
        .arg(name)
        .env(LIMITED, "yes")
        .output()
        .expect("ended");
    let said = String::from_utf8_lossy(&ended.stdout);
    assert!(ended.status.success() && said.contains("1 passed"), "{said}{}", String::from_utf8_lossy(&ended.stderr));
}

/// Stacks larger than the address space of any machine: not one thread can be started.
#[cfg(target_os = "linux")]
#[test]
fn threads_that_cannot_be_started() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = folder.path().join("x.supel");
    let ended = Command::new(assert_cmd::cargo::cargo_bin!("supel"))
        .args(["reduce", "--stiffness", "K.mtx", "--mass", "M.mtx", "--interface", "end=rows:0", "--method", "herting"])
        .args(["--modes", "1", "--threads", "2", "--output"])
        .arg(&output)
        .env("RUST_MIN_STACK", (1_u64 << 60).to_string())
        .output()
        .expect("ended");
    let said = String::from_utf8_lossy(&ended.stderr);
    assert_eq!(ended.status.code(), Some(6), "{said}");
    assert!(said.starts_with("supel: error[E-THREADS]: 2 threads"), "{said}");
}

/// The jobs of the test below, their memory what lies between the forecasts for both precisions.
fn limited_job(place: &Place) -> Job {
    let path = place.path("job.toml");
    let text = r#"
model     = { stiffness = "K.mtx", mass = "M.mtx", dofs = "dofs.txt", nodes = "nodes.csv" }
interface = [{ name = "foot", nodes = { within = { box = { min = [0, 0, 0], max = [0, 1, 1] } } }, coupling = "rigid" }]
reduction = { method = "herting", modes = { count = 6 } }
write     = { superelement = "x.supel" }
"#;
    place.write("job.toml", text.as_bytes());
    let mut job = Job::read(&path).expect("a job");
    let model = Model::new(supel::input::read(&job.model).expect("files")).expect("a sound model");
    let partition = Partition::new(model, &job.interfaces).expect("a foot");
    let analysis = partition.analysis().expect("an analysis");
    let needed = |partition: &Partition, storage| {
        let resources = Resources { memory_bytes: Some(1), cache: None };
        let plan = Plan::of(&job);
        let compared = Comparisons::in_memory(&plan, (partition, &analysis), None);
        match slices_within_memory(&analysis, partition, (&plan, compared), resources, (storage, None)) {
            Err(Error::MemoryForecast { factors, matrices, vectors, program, in_single: None, .. }) => {
                factors + matrices + vectors + program
            }
            other => panic!("a byte is enough: {other:?}"),
        }
    };
    let (double, single) = (needed(&partition, Storage::Double), needed(&partition, Storage::Single));
    assert!(single < double);
    let dof = Dof { node: 1, direction: Direction::Ux };
    let mut recovering = partition;
    recovering.recovered.rows = vec![(0, dof); 100];
    // Six interface dofs and six modes, in three copies of eight bytes.
    assert_eq!(needed(&recovering, Storage::Double), double + 100 * 12 * 24);
    job.run.memory_gib = Some((single + double) as f64 / 2.0 / f64::from(1 << 30));
    job
}

/// As many slices at the same time as there are threads, fewer where memory holds fewer, and an error where it holds none.
#[test]
fn slices_at_the_same_time_are_those_that_memory_holds() {
    let place = Place::with(&brick([10, 9, 8], [1.0, 0.9, 0.8], &Material::STEEL_SI));
    let job = Job { run: Default::default(), ..limited_job(&place) };
    let model = Model::new(supel::input::read(&job.model).expect("files")).expect("a sound model");
    let partition = Partition::new(model, &job.interfaces).expect("a foot");
    let analysis = partition.analysis().expect("an analysis");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().expect("threads");
    let at_once = |memory_bytes| {
        let resources = Resources { memory_bytes, cache: None };
        pool.install(|| {
            slices_within_memory(
                &analysis,
                &partition,
                (&Plan::of(&job), Compared::default()),
                resources,
                (Storage::Double, Some(800)),
            )
        })
    };
    let Err(Error::MemoryForecast { factors, matrices, vectors, program, .. }) = at_once(Some(1)) else {
        panic!("a byte")
    };
    let one = factors + matrices + vectors + program;
    assert!(at_once(Some(one - 1)).is_err());
    let held: Vec<usize> = (0..=200).map(|part| at_once(Some(one + one * part / 100)).expect("enough")).collect();
    assert!(held.is_sorted() && held[0] == 1 && held[200] == 4, "{held:?}");
    assert!(held.contains(&2) && held.contains(&3), "{held:?}");
    assert_eq!(at_once(None).expect("no limit"), 4);
}

/// Mixed precision gives the same frequencies within their bars and the same verdicts, or a refusal that says what to do.
#[test]
fn a_job_that_fits_in_mixed_precision_alone() {
    let place = Place::with(&brick([10, 9, 8], [1.0, 0.9, 0.8], &Material::STEEL_SI));
    let limited = limited_job(&place);
    let run = |precision, memory_gib| {
        let mut job = limited.clone();
        (job.run.precision, job.run.memory_gib) = (precision, memory_gib);
        supel::reduce(&job, Resources::default(), &mut ()).map(|outcome| outcome.report.body)
    };
    let error = run(Precision::Double, limited.run.memory_gib).expect_err("too large");
    assert!(matches!(error, Error::MemoryForecast { in_single: Some(_), .. }), "{error}");
    assert!(error.to_string().contains("set run.precision = \"mixed\", which needs "), "{error}");

    let double = run(Precision::Double, None).expect("unlimited");
    let mixed = run(Precision::Mixed, limited.run.memory_gib).expect("small enough");
    let auto = run(Precision::Auto, limited.run.memory_gib).expect("small enough");
    assert_eq!(run(Precision::Auto, None).expect("unlimited"), double, "double precision where there is memory");
    assert!(mixed.warnings.is_empty(), "{:?}", mixed.warnings);
    let codes: Vec<&str> = auto.warnings.iter().map(|warning| warning.code).collect();
    assert_eq!(codes, ["W-MIXED-PRECISION"]);
    for body in [&mixed, &auto] {
        assert!(
            body.model.notes.iter().any(|note| note.contains("kept in single precision")),
            "{:?}",
            body.model.notes
        );
        for (check, expected) in body.checks.iter().zip(&double.checks) {
            assert_eq!((check.id, check.verdict()), (expected.id, expected.verdict()));
        }
        for (mode, expected) in body.reduction.modes.iter().zip(&double.reduction.modes) {
            let difference = (mode.frequency_hz - expected.frequency_hz).abs();
            assert!(difference <= mode.error_bar_hz + expected.error_bar_hz, "{mode:?} {expected:?}");
        }
    }
    assert_eq!(mixed.reduction.modes, auto.reduction.modes, "whoever chose it");
}

/// A comparison with the full matrices is refused before anything is factored, where the memory of the job or of the machine does not
/// hold it.
#[test]
fn a_comparison_that_does_not_fit() {
    let place = Place::with(&brick([10, 9, 8], [1.0, 0.9, 0.8], &Material::STEEL_SI));
    let job = Job { run: Default::default(), ..limited_job(&place) };
    let superelement = supel::reduce(&job, Resources::default(), &mut ()).expect("unlimited").superelement;
    let verify =
        |memory_bytes| supel::verify(&superelement, Some(&job), Resources { memory_bytes, cache: None }, &mut ());
    let refused =
        (10..40).map(|bits| verify(Some(1 << bits))).find(|found| !matches!(found, Err(Error::MemoryRead { .. })));
    let Some(Err(Error::MemoryComparison { needed, available })) = refused else { panic!("{refused:?}") };
    assert!(needed > available);
    let Err(error) = verify(Some(needed - 1)) else { panic!("a byte too little") };
    assert_eq!((error.code(), error.class() as u8), ("E-MEM-VERIFY", 6));
    assert!(error.to_string().contains("raise run.memory_gib of the job"), "{error}");
    assert!(verify(Some(needed)).is_ok());
    let limited = Job {
        run: supel::job::RunJob { memory_gib: Some((needed - 1) as f64 / f64::from(1 << 30)), ..job.run },
        ..job.clone()
    };
    let found = supel::verify(&superelement, Some(&limited), Resources::default(), &mut ());
    assert!(matches!(found, Err(Error::MemoryComparison { .. })), "the job's own limit");
}
