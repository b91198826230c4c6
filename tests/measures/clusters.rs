//! Modes of one cluster are judged together, whatever basis of their space a search has found.

use faer::Mat;
use supel::job::{Coupling, InterfaceJob, Method, NodeSelection};
use supel::modes::Retained;
use supel_models::springs::springs;

use crate::evidence::with_model;

/// Two pendulums on a body that is held: they swing with one frequency. One against the other they do not pull at the body, side by side they do.
#[test]
fn a_mode_that_nothing_sees_in_a_cluster_that_is_seen_counts_as_seen() {
    let model = springs(&[5.0, 1.0, 1.0, 2.0], &[(3, 9e3)], &[(0, 1, 1e3), (0, 2, 1e3), (0, 3, 4e3)]);
    let body = InterfaceJob::new("body", NodeSelection::Rows { rows: vec![0] }, Coupling::Direct);
    with_model(&model, &[body], (Method::CraigBampton, 3), |evidence| {
        let retained = evidence.retained.clone();
        // Rows of the pendulums are the ones that the two modes move.
        let shapes = &retained.modes.shapes;
        let moved: Vec<usize> = (0..3).filter(|row| shapes[(*row, 0)].hypot(shapes[(*row, 1)]) > 1e-6).collect();
        assert_eq!(moved.len(), 2);
        let length = shapes[(moved[0], 0)].hypot(shapes[(moved[0], 1)]) * 0.5f64.sqrt();
        let against = |row: usize, mode: usize| match (moved.iter().position(|of| *of == row), mode) {
            (Some(1), 0) => -length,
            (Some(_), 0 | 1) => length,
            (_, mode) => {
                if mode == 2 {
                    shapes[(row, 2)]
                } else {
                    0.0
                }
            }
        };
        let turned = Mat::from_fn(3, 3, against);
        let modes = supel::eigen::Modes { shapes: turned, ..retained.modes };
        let ranked = Retained { modes, ..retained }.ranked(evidence.partition, None);
        let [first, second] = [ranked.couplings[0], ranked.couplings[1]];
        assert!(first.size < 1e-12 * second.size, "{first:?}, {second:?}");
        assert!(first.is_seen && second.is_seen, "{first:?}, {second:?}");
        assert_eq!(first.share, second.share);
    });
}
