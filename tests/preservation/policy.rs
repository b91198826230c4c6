//! What is compared: cheap defaults, and whatever the scene states.

use supel::job::{Job, Method};
use supel::modes::Retained;
use supel::verification::Evidence;
use supel::verification::preservation::Plan;

use crate::chain::{direct, rigid_group};
use crate::evidence::with_model;
use crate::run::block;

/// The plan for a block with a factor of this many entries.
fn plan(factor_entries: f64, modes: &str, scene: &str) -> Plan {
    let text = format!(
        "[model]\nstiffness = \"K\"\nmass = \"M\"\n[reduction]\nmethod = \"herting\"\nmodes = {{ {modes} }}\n{scene}\n\
         [write]\nsuperelement = \"x.supel\"\n"
    );
    let job = Job::parse(&text, "job.toml".as_ref()).expect("a job");
    let interfaces = [rigid_group("XMIN"), direct("tip", &[45])];
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
    assert_eq!((plan.supports.len(), plan.response, plan.band_hz), (5, true, Some([0.0, 2000.0])));
    assert_eq!(plan.eta, 0.02);
    assert!(plan.not_compared.is_empty());
}

#[test]
fn what_is_dear_is_left_out_and_named() {
    let plan = plan(1e9, "up_to_hz = 3000", "");
    assert!(plan.supports.is_empty() && !plan.response);
    assert_eq!(plan.not_compared.len(), 2);
    assert!(plan.not_compared.iter().all(|note| note.contains("[scene]")), "{:?}", plan.not_compared);
}

#[test]
fn what_the_scene_states_is_compared_at_any_cost() {
    let both = "[scene]\nboundaries = [\"fix:tip\"]\nband_hz = [10, 20]\ndamping = { ratio = 0.005 }";
    let plan = plan(1e9, "up_to_hz = 3000", both);
    assert_eq!((plan.supports.len(), plan.response, plan.band_hz, plan.eta), (1, true, Some([10.0, 20.0]), 0.01));
    assert!(plan.not_compared.is_empty());
}

#[test]
fn without_modes_only_the_scene_knows_a_band() {
    let none = plan(1e4, "count = 0", "");
    assert!(none.supports.is_empty() && !none.response && none.band_hz.is_none());
    assert_eq!(none.not_compared.len(), 1);
    let stated = plan(1e4, "count = 0", "[scene]\nband_hz = [0, 50]");
    assert_eq!((stated.supports.len(), stated.response), (5, true));
}

/// What is accepted on has to be measured.
#[test]
fn what_the_scene_accepts_is_compared_at_any_cost() {
    let frequency = plan(1e9, "up_to_hz = 3000", "[scene]\naccept = { frequency = 0.01 }");
    assert_eq!((frequency.supports.len(), frequency.response), (5, false));
    let response = plan(1e9, "up_to_hz = 3000", "[scene]\naccept = { response_db = 1.0 }");
    assert_eq!((response.supports.len(), response.response), (0, true));
    assert!(plan(1e4, "up_to_hz = 3000", "[scene]\naccept = { static = 1e-6 }").shown > 1000);
}
