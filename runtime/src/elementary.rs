//! Square root and sine: those of the standard library, or of `libm` without it. Roots are correctly rounded in both.

#[cfg(not(feature = "std"))]
pub(crate) use libm::{sin, sqrt};

#[cfg(feature = "std")]
#[inline]
pub(crate) fn sqrt(x: f64) -> f64 {
    x.sqrt()
}

#[cfg(feature = "std")]
#[inline]
pub(crate) fn sin(x: f64) -> f64 {
    x.sin()
}
