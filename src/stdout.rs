//! Whether the process was given an stdout.
//!
//! Before `main` runs, the standard library opens the null device in the place of a standard stream that is closed. What is written
//! there is lost without an error. So a function that the system runs at the start asks for the descriptor before that.

use supel::cli::Stdout;

/// Whether stdout was open when the process started.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
pub(crate) fn state() -> Stdout {
    if at_start::was_closed() { Stdout::Closed } else { Stdout::Open }
}

/// Other systems do not tell.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub(crate) fn state() -> Stdout {
    Stdout::Open
}

#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[allow(unsafe_code)]
mod at_start {
    use std::sync::atomic::{AtomicBool, Ordering};

    static WAS_CLOSED: AtomicBool = AtomicBool::new(false);

    /// Run by the dynamic linker before the runtime of Rust.
    // SAFETY: the section holds pointers to functions of this kind, and this one uses nothing of the runtime.
    #[used]
    #[unsafe(link_section = ".init_array")]
    static ASK: extern "C" fn() = {
        extern "C" fn ask() {
            // SAFETY: asks for the flags of a descriptor, which changes nothing.
            let is_open = unsafe { libc::fcntl(libc::STDOUT_FILENO, libc::F_GETFD) } != -1;
            WAS_CLOSED.store(!is_open, Ordering::Relaxed);
        }
        ask
    };

    pub(super) fn was_closed() -> bool {
        WAS_CLOSED.load(Ordering::Relaxed)
    }
}
