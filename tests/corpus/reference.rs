//! Reference eigenvalues and their own error.

use std::path::Path;

use serde_json::Value;

/// The eigenvalues of a `ref.json`.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    /// Zero eigenvalues.
    pub(crate) n_zero: usize,
    /// The lowest eigenvalues above them, ascending.
    pub(crate) elastic: Vec<f64>,
    first: f64,
    /// √n, which the rounding errors of n steps of a dense solver add up to.
    accumulation: f64,
    method: Method,
}

/// How the reference was computed, and what its error depends on.
#[derive(Clone, Copy, Debug)]
enum Method {
    /// LAPACK on L⁻¹KL⁻ᵀ, M = L Lᵀ; the norm of that matrix is at most ‖K‖/λ_min(M).
    Dense { largest: f64 },
    /// LAPACK on M θ with K + sM = L Lᵀ, λ = 1/θ − s.
    DenseInverted { shift: f64 },
    /// ARPACK on (K − σM)⁻¹M to a relative residual of 10⁻¹².
    ShiftInvert { shift: f64 },
}

impl Reference {
    pub(crate) fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).expect("a reference");
        let json: Value = serde_json::from_str(&text).expect("JSON");
        let number = |key: &str| json[key].as_f64();
        let all: Vec<f64> =
            json["eigenvalues_lowest"].as_array().expect("eigenvalues").iter().filter_map(Value::as_f64).collect();
        let n_zero = json["rigid_or_zero_modes"].as_u64().expect("a count") as usize;
        let method = json["method"].as_str().expect("a method");
        let method = if method.starts_with("dense scipy.linalg.eigh(K,M)") {
            let norms = number("K_eig_max").zip(number("M_eig_min"));
            Method::Dense { largest: norms.map(|(k, m)| k / m).expect("extreme eigenvalues") }
        } else if method.starts_with("dense eigh(M,K+sM)") {
            Method::DenseInverted { shift: value_after(method, "s=") }
        } else if method.starts_with("scipy eigsh") {
            Method::ShiftInvert { shift: value_after(method, "sigma=") }
        } else {
            panic!("{}: unknown method {method:?}", path.display());
        };
        let accumulation = number("n").expect("an order").sqrt();
        Self {
            n_zero,
            accumulation,
            first: all.first().copied().unwrap_or_default(),
            elastic: all[n_zero..].to_vec(),
            method,
        }
    }

    /// Relative error of an eigenvalue of the reference.
    pub(crate) fn own_error(&self, lambda: f64) -> f64 {
        let absolute = match self.method {
            // A backward stable solver errs by √n ε‖A‖ in every eigenvalue of A.
            Method::Dense { largest } => self.accumulation * f64::EPSILON * largest,
            // The same for θ, whose largest is 1/(λ₁ + s); |dλ| = (λ + s)² |dθ|.
            Method::DenseInverted { shift } => {
                self.accumulation * f64::EPSILON * (lambda + shift).powi(2) / (self.first + shift)
            }
            // A residual of 10⁻¹² θ bounds the error of θ; |dλ| = (λ − σ) |dθ| / θ.
            Method::ShiftInvert { shift } => 1e-12 * (lambda - shift),
        };
        absolute / lambda
    }
}

fn value_after(text: &str, mark: &str) -> f64 {
    let (_, rest) = text.split_once(mark).expect("a shift");
    let end = rest.find(',').unwrap_or(rest.len());
    rest[..end].trim().parse().expect("a number")
}
