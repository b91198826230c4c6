//! What a job cannot hold while modes are computed.

use supel::cli::ExitCode;
use supel_testing::place::{Ended, Place};

use crate::Case;

#[track_caller]
fn refused(place: &Place, reduction: &'static str, words: &[&str]) {
    let Ended { err, .. } = Case::of(reduction).run(place).expect(ExitCode::Usage);
    assert!(words.iter().all(|word| err.contains(word)), "{words:?} are not in {err}");
    assert!(!place.path("x.supel").exists());
}

#[test]
fn held_belongs_to_its_method_and_names_interfaces() {
    let place = Place::with_brick();
    let held = "error[E-JOB-HELD]";
    refused(&place, r#"method = "mixed-interface", modes = { count = 2 }"#, &[held, "missing", "base"]);
    refused(&place, r#"method = "herting", modes = { count = 2 }, held = ["base"]"#, &[held, "given with herting"]);
    let unknown = "error[E-HELD-INTERFACE]";
    refused(
        &place,
        r#"method = "mixed-interface", modes = { count = 2 }, held = ["bas"]"#,
        &[unknown, "`bas`", "base, tip"],
    );
    refused(&place, r#"method = "mixed-interface", modes = { count = 2 }, held = ["tip.up"]"#, &[unknown, "`tip.up`"]);
    // Solids have no rotations.
    refused(&place, r#"method = "mixed-interface", modes = { count = 2 }, held = ["tip.rx"]"#, &[unknown, "`tip.rx`"]);
}

/// A flag takes the place of what the job holds, and another method drops it.
#[test]
fn flags_change_what_is_held() {
    let place = Place::with_brick();
    Case::of(r#"method = "mixed-interface", modes = { count = 2 }, held = ["base"]"#)
        .run(&place)
        .expect(ExitCode::Done);
    let job = place.text("job.toml");
    let made = |flags: &[&str]| {
        supel_testing::place::supel(&[&["reduce", &job][..], flags].concat()).expect(ExitCode::Done);
        place.superelement("x.supel").metadata().modes_held.clone()
    };
    assert_eq!(made(&[]), (0..9).collect::<Vec<usize>>());
    assert_eq!(made(&["--held", "tip,base.ux"]), [0, 3, 6, 9, 10, 11, 12, 13, 14, 15, 16, 17]);
    assert_eq!(made(&["--held", ""]), Vec::<usize>::new());
    assert_eq!(made(&["--method", "herting"]), Vec::<usize>::new());
}
