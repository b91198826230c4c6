//! What the file says besides the matrices, through the C interface.

use alloc::vec::Vec;
use std::ffi::{CString, c_char};

use super::{SupelComponent, SupelStatus, c_string, guarded, null, pointer};
use crate::metadata::{Flag, Verdict};
use crate::superelement::Superelement;

/// The mass matrix is semidefinite: it cannot be factored, and an explicit integrator cannot be used. An implicit one needs numerical
/// damping, because motions without mass follow at once.
pub const SUPEL_SINGULAR_MASS: u32 = 1;
/// The stiffness is the tangent of a preloaded state. No component is made of such a file.
pub const SUPEL_PRELOADED: u32 = 2;
/// A bit of `supel_flags`: the superelement was made for statics alone and has no mass; no component can be made of it.
pub const SUPEL_STIFFNESS_ONLY: u32 = 4;

/// What a check said when the file was made; the later the worse.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupelVerdict {
    /// Within its limit.
    Pass = 0,
    /// Past its limit, not past the point of failure.
    Warn = 1,
    /// Past the point of failure.
    Fail = 2,
}

/// One check of the file's verification.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SupelCheck {
    /// Its identifier, `M-05`, valid until the component is freed.
    pub id: *const c_char,
    /// The measured value; not a number where none was found.
    pub value: f64,
    /// The limit it was judged by.
    pub limit: f64,
    /// What was said.
    pub verdict: SupelVerdict,
}

/// Names, axes, verdict and validity of a superelement.
pub(super) struct Said {
    names: Vec<CString>,
    loads: Vec<CString>,
    labels: Vec<Option<i64>>,
    frames: Vec<f64>,
    units: Option<CString>,
    band: Option<[f64; 2]>,
    assumptions: Vec<CString>,
    flags: u32,
    verdict: SupelVerdict,
    /// The identifiers are owned here.
    checks: Vec<(CString, f64, f64, SupelVerdict)>,
}

impl Said {
    pub(super) fn by(superelement: &Superelement) -> Self {
        let (tensors, metadata) = (superelement.tensors(), superelement.metadata());
        let checks =
            metadata.verification.checks.iter().map(|check| {
                (c_string(&check.id), check.value.unwrap_or(f64::NAN), check.limit, verdict(check.verdict))
            });
        let flag = |flag: &Flag| match flag {
            Flag::SingularMass => SUPEL_SINGULAR_MASS,
            Flag::Preloaded => SUPEL_PRELOADED,
            Flag::StiffnessOnly => SUPEL_STIFFNESS_ONLY,
        };
        Self {
            names: metadata.interface_nodes.iter().map(|node| c_string(&node.name)).collect(),
            loads: metadata.load_names.iter().map(|name| c_string(name)).collect(),
            labels: metadata.interface_nodes.iter().map(|node| node.label).collect(),
            frames: tensors.interface_frames.as_flattened().as_flattened().to_vec(),
            units: metadata.units.as_deref().map(c_string),
            band: metadata.validity.band_hz,
            assumptions: metadata.validity.assumptions.iter().map(|text| c_string(text)).collect(),
            flags: metadata.flags.iter().map(flag).fold(0, |sum, flag| sum | flag),
            verdict: verdict(metadata.verification.verdict),
            checks: checks.collect(),
        }
    }
}

fn verdict(verdict: Verdict) -> SupelVerdict {
    match verdict {
        Verdict::Pass => SupelVerdict::Pass,
        Verdict::Warn => SupelVerdict::Warn,
        Verdict::Fail => SupelVerdict::Fail,
    }
}

/// # Safety
///
/// `component` is null or comes from this library.
unsafe fn said<'a>(component: *const SupelComponent) -> Option<&'a Said> {
    // SAFETY: null or a component by the promise of the caller.
    unsafe { component.as_ref() }.map(|component| &component.said)
}

fn text(text: Option<&CString>) -> *const c_char {
    text.map_or(std::ptr::null(), |text| text.as_ptr())
}

/// Name of an interface node, from 0; null for null and for a node that is not there.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_interface_name(component: *const SupelComponent, node: usize) -> *const c_char {
    // SAFETY: the same promise.
    text(unsafe { said(component) }.and_then(|said| said.names.get(node)))
}

/// Number of loads that the file carries; zero for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_n_load_vectors(component: *const SupelComponent) -> usize {
    // SAFETY: the same promise.
    unsafe { said(component) }.map_or(0, |said| said.loads.len())
}

/// Name of a load of the file, from 0; null for null and for a load that is not there.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_load_vector_name(component: *const SupelComponent, load: usize) -> *const c_char {
    // SAFETY: the same promise.
    text(unsafe { said(component) }.and_then(|said| said.loads.get(load)))
}

/// Label of an interface node in the model; null for null, for a node that is not there and for one that the reduction added.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_interface_label(component: *const SupelComponent, node: usize) -> *const i64 {
    // SAFETY: the same promise.
    let label = unsafe { said(component) }.and_then(|said| said.labels.get(node)?.as_ref());
    label.map_or(std::ptr::null(), std::ptr::from_ref)
}

/// Axes of the interface nodes in the reference configuration: for each node a rotation matrix, row by row, whose columns are
/// its axes; null for null. Coordinates, forces and matrices do not depend on them.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_interface_frames(component: *const SupelComponent) -> *const f64 {
    // SAFETY: the same promise.
    pointer(unsafe { said(component) }.map(|said| said.frames.as_slice()))
}

/// Label of the units of all numbers, `mm-t-s`; null for null and where the file names none.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_units(component: *const SupelComponent) -> *const c_char {
    // SAFETY: the same promise.
    text(unsafe { said(component) }.and_then(|said| said.units.as_ref()))
}

/// Lowest and highest frequency of excitation in Hz for which the file was made; null for null and where it names none.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_band_hz(component: *const SupelComponent) -> *const f64 {
    // SAFETY: the same promise.
    pointer(unsafe { said(component) }.and_then(|said| said.band.as_ref()).map(<[f64; 2]>::as_slice))
}

/// Number of sentences on what the file takes for granted about the simulation; 0 for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_n_assumptions(component: *const SupelComponent) -> usize {
    // SAFETY: the same promise.
    unsafe { said(component) }.map_or(0, |said| said.assumptions.len())
}

/// One of these sentences, from 0; null for null and for one that is not there.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_assumption(component: *const SupelComponent, index: usize) -> *const c_char {
    // SAFETY: the same promise.
    text(unsafe { said(component) }.and_then(|said| said.assumptions.get(index)))
}

/// Properties that a client must know, a sum of `SUPEL_SINGULAR_MASS` and those to come; 0 for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_flags(component: *const SupelComponent) -> u32 {
    // SAFETY: the same promise.
    unsafe { said(component) }.map_or(0, |said| said.flags)
}

/// What the verification said when the file was made, no better than the worst of its checks.
///
/// It is read from the file and not found anew; `supel verify` does that.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`; `verdict` is null or points to a verdict.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_verdict(component: *const SupelComponent, verdict: *mut SupelVerdict) -> SupelStatus {
    guarded(|| {
        // SAFETY: the same promise.
        let said = unsafe { said(component) }.ok_or_else(|| null("component"))?;
        if verdict.is_null() {
            return Err(null("verdict"));
        }
        // SAFETY: not null, and a place for a verdict by the promise of the caller.
        unsafe { verdict.write(said.verdict) };
        Ok(())
    })
}

/// Number of checks behind the verdict; 0 for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_n_checks(component: *const SupelComponent) -> usize {
    // SAFETY: the same promise.
    unsafe { said(component) }.map_or(0, |said| said.checks.len())
}

/// One of these checks, from 0.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`; `check` is null or points to a check.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_check(
    component: *const SupelComponent,
    index: usize,
    check: *mut SupelCheck,
) -> SupelStatus {
    guarded(|| {
        // SAFETY: the same promise.
        let said = unsafe { said(component) }.ok_or_else(|| null("component"))?;
        if check.is_null() {
            return Err(null("check"));
        }
        let Some((id, value, limit, verdict)) = said.checks.get(index) else {
            let reason = format!("check {index} (from 0), the file has {}", said.checks.len());
            return Err((SupelStatus::Argument, reason));
        };
        // SAFETY: not null, and a place for a check by the promise of the caller.
        unsafe { check.write(SupelCheck { id: id.as_ptr(), value: *value, limit: *limit, verdict: *verdict }) };
        Ok(())
    })
}
