//! A library that ends the process ends it as this program does.
//!
//! Where a few of its allocations fail, the HDF5 library calls `exit(-1)`: its caller never gets an error, and the shell would see the code
//! 255 without a line. What runs at `exit` can still speak. So a handler is registered there. As long as the program has not
//! come to its own end, whoever called `exit` was a library without memory, and [`heap`] writes the line of memory that ran out, removes what was
//! being written and ends the process with its code.

use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::heap;

/// Whether an end of the process is nobody's but a library's.
static IS_WATCHED: AtomicBool = AtomicBool::new(false);

/// As long as it lives, `exit` is an error; dropped where the program ends by itself, also by a panic.
#[must_use]
#[derive(Debug)]
pub struct Watch(());

impl Drop for Watch {
    fn drop(&mut self) {
        IS_WATCHED.store(false, Ordering::SeqCst);
    }
}

/// Watches for a library that ends the process.
pub fn watch() -> Watch {
    static REGISTERED: Once = Once::new();
    REGISTERED.call_once(register);
    IS_WATCHED.store(true, Ordering::SeqCst);
    Watch(())
}

#[cfg(unix)]
#[allow(unsafe_code)]
fn register() {
    extern "C" fn at_exit() {
        if IS_WATCHED.load(Ordering::SeqCst) {
            heap::end_of_library();
        }
    }
    // SAFETY: the handler lives as long as the program and unwinds into nothing: it returns or ends the process. Where the system has
    // no room for it, the end stays silent.
    unsafe { libc::atexit(at_exit) };
}

/// Other systems keep what their libraries do.
#[cfg(not(unix))]
fn register() {}
