//! The verdict in one line, of a reduction and of a file alike.

use crate::eigen::NOTICED_BAR;
use crate::number::{counted, quantity};
use crate::verification::check::{Check, Verdict};

/// Whether warnings and checks past their limits are accepted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reservations {
    /// They are: what was asked for is made, and they are told.
    #[default]
    Accepted,
    /// They count as failures, as with `--strict`.
    Refused,
}

/// How far rounding in the matrices leaves a frequency open: where that is more than goes unnoticed, it may be why a check failed.
pub(crate) struct Open {
    /// The largest share of a frequency that its error bar leaves open.
    pub share: f64,
    /// What is known of the digits of the matrices.
    pub digits: MatrixDigits,
}

/// What is known of the digits of the matrices that a superelement came from.
pub(crate) enum MatrixDigits {
    /// Both have all that double precision has.
    All,
    /// One at least has fewer.
    Fewer,
    /// Nothing: a superelement does not record them.
    Unrecorded,
}

/// The line at the end of a summary: what passed, what did not, and with what reservations.
pub(crate) fn conclusion(
    checks: &[Check],
    n_warnings: usize,
    (verdict, reservations): (Verdict, Reservations),
    open: &Open,
) -> String {
    concluded("verified", checks, n_warnings, (verdict, reservations, open))
}

/// The line of [`conclusion`] with another word for a subject whose checks passed.
pub(crate) fn concluded(
    done: &str,
    checks: &[Check],
    n_warnings: usize,
    (verdict, reservations, open): (Verdict, Reservations, &Open),
) -> String {
    let n_judged = checks.iter().filter(|check| check.is_judged()).count();
    let judged = counted(n_judged, "check", "checks");
    let failed = identifiers(checks, Verdict::Fail);
    match (verdict, reservations) {
        (Verdict::Info | Verdict::Pass, _) => format!("✓ {done}: {judged} passed"),
        (Verdict::Warn, Reservations::Accepted) => format!("! {done}, with {}", reserved(checks, n_warnings)),
        (Verdict::Warn, Reservations::Refused) => {
            format!("! not accepted: {}, and --strict accepts none", reserved(checks, n_warnings))
        }
        (Verdict::Fail, _) if failed.is_empty() => format!("✗ not {done}: modes are missing"),
        (Verdict::Fail, _) => {
            let doubt = if open.share > NOTICED_BAR { doubt(open) } else { String::new() };
            format!("✗ not {done}: {} of {judged} failed: {}{doubt}", failed.len(), failed.join(", "))
        }
    }
}

/// What few digits, or stiffnesses of very different size, leave open, and what to do first.
fn doubt(open: &Open) -> String {
    let share = quantity(100.0 * open.share.min(1.0), 2);
    let first = match open.digits {
        MatrixDigits::All => {
            "double precision has no more for stiffnesses of such different size: make stiff ties and thin elements softer or \
             leave them out first"
        }
        MatrixDigits::Fewer => "write them with all their digits first",
        MatrixDigits::Unrecorded => "write them with all their digits first, if they have fewer",
    };
    format!("; rounding in the matrices leaves a frequency open by {share} %, which may be why: {first}")
}

/// What a heading says after `Verified` and after `Not accepted`.
pub(crate) fn reserved_as(checks: &[Check], n_warnings: usize) -> &'static str {
    match (identifiers(checks, Verdict::Warn).is_empty(), n_warnings) {
        (true, _) => "with warnings",
        (false, 0) => "with checks past their limits",
        (false, _) => "with checks past their limits and warnings",
    }
}

/// Checks past their limits and warnings, each said only where there is one.
fn reserved(checks: &[Check], n_warnings: usize) -> String {
    let past = identifiers(checks, Verdict::Warn);
    let whose = if past.len() == 1 { "its limit" } else { "their limits" };
    let of_checks = (!past.is_empty())
        .then(|| format!("{} past {whose} ({})", counted(past.len(), "check", "checks"), past.join(", ")));
    let of_warnings = (n_warnings > 0).then(|| counted(n_warnings, "warning", "warnings"));
    of_checks.into_iter().chain(of_warnings).collect::<Vec<_>>().join(" and ")
}

fn identifiers(checks: &[Check], verdict: Verdict) -> Vec<&'static str> {
    checks.iter().filter(|check| check.verdict() == verdict).map(|check| check.id).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verification::check::Limits;

    fn check(id: &'static str, value: f64) -> Check {
        let limits = Limits { engineering: 1.0, ..Limits::default() };
        Check { id, name: "a check", equation: "", value, limits, fail_above: 10.0, worst: None }
    }

    fn said(verdict: Verdict) -> (Verdict, Reservations) {
        (verdict, Reservations::Accepted)
    }

    fn open(share: f64) -> Open {
        Open { share, digits: MatrixDigits::Fewer }
    }

    #[test]
    fn every_reservation_is_said_and_none_that_is_not_there() {
        let (sound, past, failed) = (check("M-01", 0.5), check("M-05", 2.0), check("M-12", 20.0));
        let alone = [sound.clone()];
        assert_eq!(conclusion(&alone, 0, said(Verdict::Pass), &open(0.0)), "✓ verified: 1 check passed");
        assert_eq!(conclusion(&alone, 1, said(Verdict::Warn), &open(0.0)), "! verified, with 1 warning");
        let two = [past.clone(), sound.clone()];
        assert_eq!(
            conclusion(&two, 0, said(Verdict::Warn), &open(0.0)),
            "! verified, with 1 check past its limit (M-05)"
        );
        let three = [past.clone(), sound, check("M-23", 3.0)];
        assert_eq!(
            conclusion(&three, 2, said(Verdict::Warn), &open(0.0)),
            "! verified, with 2 checks past their limits (M-05, M-23) and 2 warnings"
        );
        let strictly = |verdict| (verdict, Reservations::Refused);
        assert_eq!(
            conclusion(&two, 1, strictly(Verdict::Warn), &open(0.0)),
            "! not accepted: 1 check past its limit (M-05) and 1 warning, and --strict accepts none"
        );
        assert_eq!(conclusion(&alone, 0, strictly(Verdict::Pass), &open(0.0)), "✓ verified: 1 check passed");
        let failed = [failed, past];
        assert_eq!(
            conclusion(&failed, 2, said(Verdict::Fail), &open(1e-5)),
            "✗ not verified: 1 of 2 checks failed: M-12"
        );
        assert_eq!(conclusion(&alone, 0, said(Verdict::Fail), &open(0.0)), "✗ not verified: modes are missing");
        assert_eq!(reserved_as(&two, 0), "with checks past their limits");
        assert_eq!(reserved_as(&two, 1), "with checks past their limits and warnings");
        assert_eq!(reserved_as(&[], 1), "with warnings");
    }

    #[test]
    fn all_digits_are_asked_for_only_where_some_are_missing() {
        let failed = [check("M-12", 20.0)];
        let with = |digits| conclusion(&failed, 0, said(Verdict::Fail), &Open { share: 0.018, digits });
        let start = "✗ not verified: 1 of 1 check failed: M-12; rounding in the matrices leaves a frequency open by 1.8 %, which may be why: ";
        assert_eq!(with(MatrixDigits::Fewer), format!("{start}write them with all their digits first"));
        assert_eq!(
            with(MatrixDigits::Unrecorded),
            format!("{start}write them with all their digits first, if they have fewer")
        );
        assert_eq!(
            with(MatrixDigits::All),
            format!(
                "{start}double precision has no more for stiffnesses of such different size: make stiff ties and thin elements \
                 softer or leave them out first"
            )
        );
    }
}
