//! The comparison has the same bits for any number of threads.

use rayon::ThreadPoolBuilder;

use crate::chain::{direct, rigid_group};
use crate::run::Files;

#[test]
fn preservation_does_not_depend_on_threads() {
    // More rows than a tile of the dense and of the sparse products.
    let model = supel_models::brick([40, 5, 5], [8.0, 1.0, 0.9], &supel_models::Material::STEEL_SI);
    let last = model.labels[model.labels.len() - 1];
    let files = Files::new(model, vec![rigid_group("XMIN"), direct("tip", &[last])]);
    let body = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let outcome = pool.install(|| files.reduce("herting", "count = 8", "damping = { ratio = 0.01 }"));
        serde_json::to_string(&outcome.report.body).expect("JSON")
    };
    let first = body(1);
    assert!(first.contains("\"worst_pair\""));
    for threads in [2, 3, 8] {
        assert!(body(threads) == first, "{threads} threads");
    }
}
