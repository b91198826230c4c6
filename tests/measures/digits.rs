//! Matrices written with few digits: the limits follow the data and say so, and nothing warns but what is true.

use supel::input::{Digits, Input, MatrixInput};
use supel::job::Method;
use supel::verification::check::{ActiveLimit, Verdict};
use supel_models::transform::rounded;
use supel_models::{Material, Model, brick};

use crate::chain::{direct, input};
use crate::evidence::{checks, complaints, line, with_evidence};

fn with_digits(model: &Model, digits: u32) -> Input {
    let input = input(&rounded(model, digits as usize));
    let known = Digits { significant: digits, ..Digits::DOUBLE };
    let of = |matrix: MatrixInput| MatrixInput { digits: known, ..matrix };
    Input { stiffness: of(input.stiffness), mass: of(input.mass), ..input }
}

fn beam() -> Model {
    brick([10, 2, 2], [10.0, 1.1, 0.9], &Material::UNIT)
}

/// Fact 8: the same model with fewer digits passes by limits of the data, until M-09 says that a frequency is no longer
/// known to a tenth of a per mille.
#[test]
fn limits_follow_the_digits_of_the_data() {
    for method in [Method::CraigBampton, Method::Herting] {
        let mut bars = Vec::new();
        for digits in [14, 12, 9, 7, 6] {
            let interfaces = [direct("ends", &[1, 12, 34, 99])];
            with_evidence(with_digits(&beam(), digits), &interfaces, (method, 6), |evidence| {
                let checks = checks(&evidence);
                if std::env::var_os("SHOW").is_some() {
                    checks.iter().for_each(|c| println!("{digits} digits {method:?} | {}", line(c)));
                }
                let lines: Vec<String> = checks.iter().map(line).collect();
                let bar = checks.iter().find(|check| check.id == "M-09").expect("a bar");
                bars.push(bar.value);
                for (id, verdict) in complaints(&checks) {
                    // Where frequencies are not known to a tenth of a per mille, those of the reduced model are not either.
                    let is_true = ["M-04", "M-09", "M-14"].contains(&id) && bar.value > 1e-4;
                    assert!(is_true && verdict == Verdict::Warn, "{digits} digits: {id}\n{}", lines.join("\n"));
                }
                let by_data = checks.iter().filter(|check| check.limits.active() == ActiveLimit::Data).count();
                assert!(by_data >= if digits <= 9 { 4 } else { 0 }, "{digits} digits: {}", lines.join("\n"));
            });
        }
        // Two digits less make the bar a hundred times wider.
        assert!(bars.windows(2).all(|pair| pair[1] > 5.0 * pair[0]), "{bars:?}");
    }
}
