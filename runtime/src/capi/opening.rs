//! Components from files and from memory through the C interface.

use alloc::boxed::Box;
use alloc::string::{String, ToString};
use std::ffi::{CStr, c_char};
use std::path::Path;

use super::file::Said;
use super::{Outcome, SUPEL_CLASSICAL, SUPEL_MASS_WEIGHTED, SUPEL_MOTION_BASED, SUPEL_RIGID};
use super::{SupelComponent, SupelStatus, failed, guarded, null, unknown, values};
use crate::component::{FloatingFrame, Measures, ModalComponent};
use crate::superelement::Superelement;

/// Reads a superelement file and makes a component of it with motion-based measures, to be freed by
/// `supel_component_free`.
///
/// A file whose verification failed is opened, too: `supel_verdict` tells.
///
/// # Safety
///
/// `path` is a string that ends with a zero byte, `component` points to a pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_component_open(
    path: *const c_char,
    frame: u32,
    component: *mut *mut SupelComponent,
) -> SupelStatus {
    // SAFETY: the same promises.
    unsafe { supel_component_open_with(path, frame, SUPEL_MOTION_BASED, component) }
}

/// As `supel_component_open`, with a choice of measures: `SUPEL_MOTION_BASED` or `SUPEL_CLASSICAL`.
///
/// # Safety
///
/// As of `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_component_open_with(
    path: *const c_char,
    frame: u32,
    measures: u32,
    component: *mut *mut SupelComponent,
) -> SupelStatus {
    guarded(|| {
        if path.is_null() {
            return Err(null("path"));
        }
        // SAFETY: not null, and a string by the promise of the caller.
        let path = unsafe { CStr::from_ptr(path) };
        let read = || {
            let path = path.to_str().map_err(|error| format!("path is not UTF-8, as expected: {error}"))?;
            Superelement::open(Path::new(path)).map_err(|error| error.to_string())
        };
        // SAFETY: null, or a place for a pointer by the promise of the caller.
        unsafe { open(read, [frame, measures], component) }
    })
}

/// Makes a component of the `n_bytes` bytes of a superelement file in memory, which may be freed afterwards.
///
/// # Safety
///
/// `bytes` points to `n_bytes` bytes, `component` to a pointer. Each may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_component_open_bytes(
    bytes: *const u8,
    n_bytes: usize,
    frame: u32,
    measures: u32,
    component: *mut *mut SupelComponent,
) -> SupelStatus {
    guarded(|| {
        if isize::try_from(n_bytes).is_err() {
            return Err((SupelStatus::Argument, format!("n_bytes is {n_bytes}, more than memory can hold")));
        }
        // SAFETY: as many bytes as that by the promise of the caller.
        let bytes = unsafe { values(bytes, n_bytes, "bytes")? };
        let read = || Superelement::from_bytes(bytes).map_err(|error| error.to_string());
        // SAFETY: null, or a place for a pointer by the promise of the caller.
        unsafe { open(read, [frame, measures], component) }
    })
}

/// # Safety
///
/// `component` is null or points to a pointer.
unsafe fn open(
    read: impl FnOnce() -> Result<Superelement, String>,
    [frame, measures]: [u32; 2],
    component: *mut *mut SupelComponent,
) -> Outcome {
    if component.is_null() {
        return Err(null("component"));
    }
    let frame = match frame {
        SUPEL_MASS_WEIGHTED => FloatingFrame::MassWeighted,
        SUPEL_RIGID => FloatingFrame::Rigid,
        other => return Err(unknown("floating frame", other, "0 (SUPEL_MASS_WEIGHTED) or 1 (SUPEL_RIGID)")),
    };
    let measures = match measures {
        SUPEL_MOTION_BASED => Measures::MotionBased,
        SUPEL_CLASSICAL => Measures::Classical,
        other => return Err(unknown("measures", other, "0 (SUPEL_MOTION_BASED) or 1 (SUPEL_CLASSICAL)")),
    };
    let superelement = read().map_err(|reason| (SupelStatus::File, reason))?;
    let made = ModalComponent::with_measures(&superelement, frame, measures);
    let made = made.map_err(|error| failed(SupelStatus::Component)(&error))?;
    let made = SupelComponent { component: made, said: Said::by(&superelement) };
    // SAFETY: not null, and a place for a pointer by the promise of the caller.
    unsafe { component.write(Box::into_raw(Box::new(made))) };
    Ok(())
}
