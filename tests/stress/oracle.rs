//! Eigenvalues of tridiagonal pencils in double-double arithmetic: thirty digits where a double has sixteen.
//!
//! The number of negative pivots of T − σW = L D Lᵀ is the number of eigenvalues below σ; bisection does the rest.

/// A sum hi + lo of two doubles that do not overlap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Two(pub(crate) f64, pub(crate) f64);

impl Two {
    /// a + b without error (Knuth).
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let s = a + b;
        let t = s - a;
        Self(s, (a - (s - t)) + (b - t))
    }

    /// a b without error, by a fused multiplication.
    pub(crate) fn product(a: f64, b: f64) -> Self {
        let p = a * b;
        Self(p, a.mul_add(b, -p))
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        let Self(s, e) = Self::sum(self.0, other.0);
        Self::sum(s, e + self.1 + other.1)
    }

    fn negative(self) -> Self {
        Self(-self.0, -self.1)
    }

    pub(crate) fn times(self, other: Self) -> Self {
        let Self(p, e) = Self::product(self.0, other.0);
        Self::sum(p, e + self.0 * other.1 + self.1 * other.0)
    }

    fn over(self, other: Self) -> Self {
        let q = self.0 / other.0;
        let rest = self.plus(other.times(Self(q, 0.0)).negative());
        Self::sum(q, rest.0 / other.0)
    }
}

/// A symmetric tridiagonal matrix: its diagonal and the entries next to it.
pub(crate) struct Tridiagonal {
    pub(crate) diagonal: Vec<Two>,
    pub(crate) off_diagonal: Vec<Two>,
}

/// The lowest `count` eigenvalues of T x = λ W x, W positive definite, T not negative, to thirty bits beyond a double.
pub(crate) fn eigenvalues(t: &Tridiagonal, w: &Tridiagonal, count: usize, above: f64) -> Vec<f64> {
    let below = |sigma: f64| {
        let shifted = |t: Two, w: Two| t.plus(w.times(Two(-sigma, 0.0)));
        let mut pivot = Two(1.0, 0.0);
        let mut negative = 0;
        for i in 0..t.diagonal.len() {
            let mut next = shifted(t.diagonal[i], w.diagonal[i]);
            if i > 0 {
                let b = shifted(t.off_diagonal[i - 1], w.off_diagonal[i - 1]);
                next = next.plus(b.times(b).over(pivot).negative());
            }
            negative += usize::from(next.0 < 0.0);
            pivot = next;
        }
        negative
    };
    let find = |index: usize| {
        let (mut low, mut high) = (0.0, above);
        // Down to neighbouring doubles.
        while (high - low) > f64::EPSILON * high {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if below(middle) > index { high = middle } else { low = middle }
        }
        0.5 * (low + high)
    };
    (0..count).map(find).collect()
}

#[test]
fn chain_of_springs_is_exact() {
    let n = 40;
    let of = |diagonal: f64, off_diagonal: f64| Tridiagonal {
        diagonal: vec![Two(diagonal, 0.0); n],
        off_diagonal: vec![Two(off_diagonal, 0.0); n - 1],
    };
    let found = eigenvalues(&of(2.0, -1.0), &of(1.0, 0.0), 10, 5.0);
    let exact = supel_models::spring_spectrum(n, supel_models::Ends::Fixed);
    for (found, exact) in found.iter().zip(exact) {
        // The formula itself errs by a few ε.
        assert!((found / exact - 1.0).abs() <= 8.0 * f64::EPSILON, "{found} for {exact}");
    }
}
