//! What an earlier run has computed. K-23, K-24.

use crate::plan::facts::Facts;
use crate::plan::rule::Decision;
use crate::plan::scene::Scene;

pub(in crate::plan) fn k23(_: &Scene<'_>, _: Option<&Facts>) -> Decision {
    Decision::kept("nothing that a scene decides: a run with `--cache` takes what is there, and its report counts it")
}

pub(in crate::plan) fn k24(scene: &Scene<'_>, facts: Option<&Facts>) -> Decision {
    k23(scene, facts)
}
