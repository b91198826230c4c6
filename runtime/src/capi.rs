//! The component for programs in C and in every language that can call C; feature `capi`, header `capi/supel.h`.
//!
//! Objects are opaque. Every function that can fail returns a status and leaves the reason with `supel_last_error`; no
//! panic crosses the border. Vectors have as many doubles as the component has coordinates, matrices are square, row by
//! row. A component may be used by several threads at once, a workspace by one at a time.
//!
//! A pointer that a component gives is valid until the component is freed, one that a workspace gives until the workspace
//! is freed; its values change with the next evaluation. No array of the caller may overlap with one of these.
//!
//! This is the only module of the crate with unsafe code. What it must trust is named under *Safety*: that pointers come
//! from this library or point to as many values as the header says. Pointers are never null where they are used.

#![allow(unsafe_code)]

mod at_nodes;
mod evaluation;
mod file;
mod loads;
mod opening;
mod recovery;
mod results;

pub use at_nodes::*;
pub use evaluation::*;
pub use file::*;
pub use loads::*;
pub use opening::*;
pub use recovery::*;
pub use results::*;

use alloc::boxed::Box;
use alloc::string::{String, ToString};
use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::component::{ModalComponent, Workspace};
use crate::motion::Motion;

/// What a call says.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupelStatus {
    /// Done.
    Ok = 0,
    /// A pointer is null, a value is none of those that have a name, or a workspace belongs to another component.
    Argument = 1,
    /// The file cannot be read or is no superelement.
    File = 2,
    /// The superelement cannot undergo large motion.
    Component = 3,
    /// The component cannot be evaluated in this state, loaded there, or recovered from this file.
    State = 4,
    /// An error of the library.
    Internal = 5,
}

/// Floating frame in which the deformation has no momentum.
pub const SUPEL_MASS_WEIGHTED: u32 = 0;

/// Floating frame in which the deformation measures of the nodes have no mean.
pub const SUPEL_RIGID: u32 = 1;

/// Deformation measured by the motion of the nodes relative to the floating frame.
pub const SUPEL_MOTION_BASED: u32 = 0;

/// Deformation measured by displacements and skew parts of rotations, for comparison.
pub const SUPEL_CLASSICAL: u32 = 1;

/// A rigid-body motion x -> R x + u.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupelMotion {
    /// R, row by row.
    pub rotation: [[f64; 3]; 3],
    /// u.
    pub translation: [f64; 3],
}

/// State of a component; the arrays remain the caller's.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SupelState {
    /// Changes of configuration of the interface nodes.
    pub motions: *const SupelMotion,
    /// Modal amplitudes; may be null if there are none.
    pub amplitudes: *const f64,
    /// Material velocities: six for each node, then the rates of the amplitudes.
    pub velocities: *const f64,
    /// Material accelerations.
    pub accelerations: *const f64,
}

/// A force and a moment on an interface node, constant in inertial axes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupelDeadLoad {
    /// Number of the interface node, from 0.
    pub node: usize,
    /// Force.
    pub force: [f64; 3],
    /// Moment.
    pub moment: [f64; 3],
}

/// A superelement in large motion.
///
/// Its deformation is linear in its floating frame: inside a component there is no stress stiffening, whatever the tangent. A
/// slender part that turns fast or carries a large load is divided into several components.
pub struct SupelComponent {
    component: ModalComponent,
    /// What the file says besides the matrices.
    said: Said,
}

/// Scratch and results of one thread's evaluations of one component.
///
/// Pointers to its results are valid until it is freed, and their values change with the next evaluation; pointers that a
/// component gives are valid until that is freed. No array that the caller passes to a function may overlap with these.
pub struct SupelWorkspace {
    workspace: Workspace,
}

std::thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

type Outcome = Result<(), (SupelStatus, String)>;

/// Runs `body`, keeps its reason for failing, and lets no panic out.
fn guarded(body: impl FnOnce() -> Outcome) -> SupelStatus {
    let outcome = catch_unwind(AssertUnwindSafe(body));
    let (status, reason) = match outcome {
        Ok(Ok(())) => return SupelStatus::Ok,
        Ok(Err(failure)) => failure,
        Err(panic) => (SupelStatus::Internal, internal(panic.as_ref())),
    };
    LAST_ERROR.with(|last| *last.borrow_mut() = c_string(&reason));
    status
}

/// The text for C; a zero byte inside, of a file's making, would end it there.
fn c_string(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

fn internal(panic: &(dyn Any + Send)) -> String {
    let said = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
    let said = said.unwrap_or("no reason");
    format!("the library failed where it never should: {said}; free the workspace, and report this with the file")
}

fn null(what: &str) -> (SupelStatus, String) {
    (SupelStatus::Argument, format!("{what} is null"))
}

fn unknown(what: &str, found: u32, expected: &str) -> (SupelStatus, String) {
    (SupelStatus::Argument, format!("{what} {found}, expected {expected}"))
}

fn failed(status: SupelStatus) -> impl Fn(&dyn std::error::Error) -> (SupelStatus, String) {
    move |error| (status, error.to_string())
}

// The two are one type in memory: the same fields, in the order of C.
const _: () = assert!(size_of::<SupelMotion>() == size_of::<Motion>() && size_of::<Motion>() == 96);

/// `n` values at `pointer`, which may be null if there are none.
///
/// # Safety
///
/// `pointer` points to `n` values that nobody changes as long as the slice is used.
unsafe fn values<'a, T>(pointer: *const T, n: usize, what: &str) -> Result<&'a [T], (SupelStatus, String)> {
    match (n, pointer.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(null(what)),
        // SAFETY: not null, and `n` values long by the promise of the caller.
        (_, false) => Ok(unsafe { std::slice::from_raw_parts(pointer, n) }),
    }
}

/// `n` values at `pointer` to write to.
///
/// # Safety
///
/// `pointer` is null or points to `n` values that nobody else uses as long as the slice is.
unsafe fn values_mut<'a, T>(pointer: *mut T, n: usize, what: &str) -> Result<&'a mut [T], (SupelStatus, String)> {
    if pointer.is_null() {
        return Err(null(what));
    }
    // SAFETY: not null, and `n` values long by the promise of the caller.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer, n) })
}

/// Version of the library, `1.2.3`.
#[unsafe(no_mangle)]
pub extern "C" fn supel_version() -> *const c_char {
    const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
        Ok(version) => version,
        Err(_) => c"",
    };
    VERSION.as_ptr()
}

/// Reason of the last failure on this thread; valid until the next one.
#[unsafe(no_mangle)]
pub extern "C" fn supel_last_error() -> *const c_char {
    LAST_ERROR.with(|last| last.borrow().as_ptr())
}

/// Frees a component; null is allowed.
///
/// # Safety
///
/// `component` comes from `supel_component_open` and is not used afterwards.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_component_free(component: *mut SupelComponent) {
    if !component.is_null() {
        // SAFETY: made by `Box::into_raw`, and given up by the caller.
        drop(unsafe { Box::from_raw(component) });
    }
}

/// Number of interface nodes; 0 for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_n_nodes(component: *const SupelComponent) -> usize {
    // SAFETY: null or a component by the promise of the caller.
    unsafe { component.as_ref() }.map_or(0, |component| component.component.n_nodes())
}

/// Number of modal amplitudes; 0 for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_n_modal(component: *const SupelComponent) -> usize {
    // SAFETY: null or a component by the promise of the caller.
    unsafe { component.as_ref() }.map_or(0, |component| component.component.n_modal())
}

/// Number of coordinates: six for each node and one for each amplitude; 0 for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_n_coordinates(component: *const SupelComponent) -> usize {
    // SAFETY: null or a component by the promise of the caller.
    unsafe { component.as_ref() }.map_or(0, |component| component.component.n_coordinates())
}

/// Positions of the interface nodes in the reference configuration, three for each; null for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_positions(component: *const SupelComponent) -> *const f64 {
    // SAFETY: null or a component by the promise of the caller.
    pointer(unsafe { component.as_ref() }.map(|component| component.component.positions().as_flattened()))
}

/// Rigid-body mass about the inertial origin, 6 x 6, row by row; null for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_rigid_mass(component: *const SupelComponent) -> *const f64 {
    // SAFETY: null or a component by the promise of the caller.
    pointer(unsafe { component.as_ref() }.map(|component| component.component.rigid_mass().as_flattened()))
}

/// Stiffness without deformation; null for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_reference_stiffness(component: *const SupelComponent) -> *const f64 {
    // SAFETY: null or a component by the promise of the caller.
    pointer(unsafe { component.as_ref() }.map(|component| component.component.reference_stiffness()))
}

/// Damping without deformation; null for null and where the file has no damping.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_reference_damping(component: *const SupelComponent) -> *const f64 {
    // SAFETY: null or a component by the promise of the caller.
    pointer(unsafe { component.as_ref() }.and_then(|component| component.component.reference_damping()))
}

/// Mass without deformation; null for null.
///
/// # Safety
///
/// `component` is null or comes from `supel_component_open`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn supel_reference_mass(component: *const SupelComponent) -> *const f64 {
    // SAFETY: null or a component by the promise of the caller.
    pointer(unsafe { component.as_ref() }.map(|component| component.component.reference_mass()))
}

fn pointer(values: Option<&[f64]>) -> *const f64 {
    values.map_or(std::ptr::null(), <[f64]>::as_ptr)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_do_not_cross_the_border() {
        let status = guarded(|| panic!("a bug of the library"));
        assert_eq!(status, SupelStatus::Internal);
        // SAFETY: the library's own string, which no other call of this thread replaces.
        let reason = unsafe { CStr::from_ptr(supel_last_error()) }.to_str().expect("a text");
        assert!(reason.contains("a bug of the library"), "{reason}");
    }
}
