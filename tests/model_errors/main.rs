//! What the numerical stages refuse, one test for each error variant, and what they must not depend on.
//!
//! A message has to name the place and the remedy: the tests read it as a user would.

mod interfaces;
mod invariance;
mod matrices;
mod numerics;
mod regions;
mod rigid_body;

use supel_testing::{cases, chain};

use supel::error::{Error, ErrorClass};

/// The error of a call that must fail.
fn refusal<T>(result: Result<T, Error>) -> Error {
    match result {
        Ok(_) => panic!("accepted"),
        Err(error) => error,
    }
}

/// Checks the class and that the message holds every one of these.
fn assert_says(error: &Error, class: ErrorClass, parts: &[&str]) {
    let message = error.to_string();
    assert_eq!(error.class(), class, "{message}");
    for part in parts {
        assert!(message.contains(part), "{part:?} is not in {message:?}");
    }
    let first = message.chars().next().expect("a message");
    assert!(!first.is_uppercase() && !message.ends_with('.'), "{message}");
}
