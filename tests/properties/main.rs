//! What must hold for every component: relations between results that need no oracle, and properties that a dense twin
//! decides, on generated components that shrink to small ones.
//!
//! A fixed number of cases from a fixed seed runs every time. More are asked for by `SUPEL_CASES=1000`, which also takes a new
//! seed; what fails is kept in `regressions/` and tried first from then on.

mod component;
mod invariance;
mod oracle;
mod projection;
mod report;
mod seeds;

use supel_testing::{chain, place};

use proptest::test_runner::{Config, FileFailurePersistence, RngSeed};

/// Cases of every property in an ordinary run: the whole crate takes seconds.
const CASES: u32 = 24;

/// The runner of a property whose failures are kept in the file `regressions`.
fn config(regressions: &'static str) -> Config {
    let asked = std::env::var("SUPEL_CASES").ok().map(|cases| cases.parse().expect("SUPEL_CASES is a number"));
    Config {
        cases: asked.unwrap_or(CASES),
        rng_seed: if asked.is_some() { RngSeed::Random } else { RngSeed::Fixed(0x5eed) },
        failure_persistence: Some(Box::new(FileFailurePersistence::Direct(regressions))),
        // A case takes milliseconds.
        max_shrink_iters: 512,
        // Relations that hold for some families only draw until one comes.
        max_global_rejects: 1 << 16,
        ..Config::default()
    }
}

/// Where a file of this folder keeps what failed.
macro_rules! kept {
    ($name:literal) => {
        crate::config(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/properties/regressions/", $name, ".txt"))
    };
}
pub(crate) use kept;
