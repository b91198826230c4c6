//! What is compared: cheap defaults, and whatever the scene states.

use supel::job::{Job, Method};
use supel::modes::Retained;
use supel::verification::Evidence;
use supel::verification::preservation::Plan;
use supel::verification::preservation::ResponseExtent::{AtInterfaces, NotCompared};

use crate::chain::{direct, rigid_group};
use crate::evidence::with_model;
use crate::run::block;

/// The plan for a block with a factor of this many entries.
fn plan(factor_entries: f64, modes: &str, scene: &str) -> Plan {
    plan_with(&[45], factor_entries, modes, scene)
}

/// The plan for a block with dofs of their own at the nodes given.
fn plan_with(tip: &[i64], factor_entries: f64, modes: &str, scene: &str) -> Plan {
    let text = format!(
        "[model]\nstiffness = \"K\"\nmass = \"M\"\n[reduction]\nmethod = \"herting\"\nmodes = {{ {modes} }}\n{scene}\n\
         [write]\nsuperelement = \"x.supel\"\n"
    );
    let job = Job::parse(&text, "job.toml".as_ref()).expect("a job");
    let interfaces = [rigid_group("XMIN"), direct("tip", tip)];
    with_model(&block(), &interfaces, (Method::Herting, 6), |evidence| {
        let mut analysis = evidence.partition.analysis().expect("memory");
        analysis.nnz_factor = factor_entries;
        let mut retained: Retained = evidence.retained.clone();
        if modes == "count = 0" {
            retained.modes.lambda.clear();
        }
        Plan::new(&Evidence { retained: &retained, ..evidence }, &analysis, &job)
    })
}

#[test]
fn a_small_model_is_compared_whole() {
    let plan = plan(1e4, "up_to_hz = 3000", "");
    assert_eq!((plan.supports.len(), plan.response, plan.band_hz), (5, AtInterfaces, Some([0.0, 2000.0])));
    assert_eq!(plan.eta, 0.02);
    assert!(plan.not_compared.is_empty());
}

/// Four searches for modes take more solves than the reduction, with its one; the response takes fewer.
#[test]
fn what_is_dearer_than_the_reduction_is_left_out_with_its_estimate() {
    let plan = plan(1e9, "up_to_hz = 3000", "");
    assert!(plan.supports.is_empty() && plan.response == AtInterfaces);
    let [note] = plan.not_compared.as_slice() else { panic!("{:?}", plan.not_compared) };
    assert!(note.starts_with("frequencies under other boundaries: it would take an estimated "), "{note}");
    assert!(note.contains(" times the work of the reduction itself") && note.contains("[scene]"), "{note}");
}

/// Sixteen nodes that the end at x = 0 has no part of.
fn away_from_the_end() -> Vec<i64> {
    (26..=45).filter(|label| (label - 1) % 5 != 0).collect()
}

/// Six blocks of solves for each of 54 interface dofs are more than all others.
#[test]
fn the_response_of_a_large_interface_is_dearer_than_the_reduction() {
    let nodes = away_from_the_end();
    let plan = plan_with(&nodes, 1e9, "up_to_hz = 3000", "");
    assert_eq!(plan.response, NotCompared);
    assert!(plan.not_compared.iter().any(|note| note.starts_with("frequency response: it would take")));
    assert_eq!(plan_with(&nodes, 1e5, "up_to_hz = 3000", "").response, AtInterfaces, "half a second is never dear");
}

#[test]
fn what_the_scene_states_is_compared_at_any_cost() {
    let both = "[scene]\nboundaries = [\"fix:tip\"]\nband_hz = [10, 20]\ndamping = { ratio = 0.005 }";
    let plan = plan(1e9, "up_to_hz = 3000", both);
    assert_eq!(
        (plan.supports.len(), plan.response, plan.band_hz, plan.eta),
        (1, AtInterfaces, Some([10.0, 20.0]), 0.01)
    );
    assert!(plan.not_compared.is_empty());
}

#[test]
fn without_modes_only_the_scene_knows_a_band() {
    let none = plan(1e4, "count = 0", "");
    assert!(none.supports.is_empty() && none.response == NotCompared && none.band_hz.is_none());
    assert_eq!(none.not_compared.len(), 1);
    let stated = plan(1e4, "count = 0", "[scene]\nband_hz = [0, 50]");
    assert_eq!((stated.supports.len(), stated.response), (5, AtInterfaces));
}

/// What is accepted on has to be measured.
#[test]
fn what_the_scene_accepts_is_compared_at_any_cost() {
    let frequency = plan(1e9, "up_to_hz = 3000", "[scene]\naccept = { frequency = 0.01 }");
    assert_eq!(frequency.supports.len(), 5);
    let nodes = away_from_the_end();
    let response = plan_with(&nodes, 1e9, "up_to_hz = 3000", "[scene]\naccept = { response_db = 1.0 }");
    assert_eq!((response.supports.len(), response.response), (0, AtInterfaces));
    assert!(plan(1e4, "up_to_hz = 3000", "[scene]\naccept = { static = 1e-6 }").shown > 1000);
}
