//! What the signals of the system do to the program.

/// Has a write beyond the limit on the size of files fail with an error instead of ending the process.
#[cfg(unix)]
#[allow(unsafe_code)]
pub(super) fn ignore_file_size_limit() {
    // SAFETY: the signal is ignored; no handler runs.
    unsafe { libc::signal(libc::SIGXFSZ, libc::SIG_IGN) };
}

#[cfg(not(unix))]
pub(super) fn ignore_file_size_limit() {}

#[cfg(unix)]
const ENDING: [libc::c_int; 3] = [libc::SIGINT, libc::SIGTERM, libc::SIGHUP];

/// Has an interrupt, a hang-up or a request to terminate remove what is being written before it ends the process. One that is
/// ignored, as `nohup` asks for, stays so.
#[cfg(unix)]
#[allow(unsafe_code)]
pub(super) fn leave_nothing_unfinished() {
    extern "C" fn end(signal: libc::c_int) {
        crate::unfinished::remove_all();
        // SAFETY: what the signal does without a handler.
        unsafe {
            libc::signal(signal, libc::SIG_DFL);
            libc::raise(signal);
        }
    }
    ENDING.into_iter().for_each(|signal| {
        handle(signal, end);
    });
}

#[cfg(not(unix))]
pub(super) fn leave_nothing_unfinished() {}

/// Has a signal handled unless it is ignored; what it did before.
#[cfg(unix)]
#[allow(unsafe_code)]
fn handle(signal: libc::c_int, handler: extern "C" fn(libc::c_int)) -> libc::sighandler_t {
    // SAFETY: both handlers of this module call only what a handler may call.
    let before = unsafe { libc::signal(signal, handler as *const () as libc::sighandler_t) };
    if before == libc::SIG_IGN {
        // SAFETY: ignored as it was.
        unsafe { libc::signal(signal, libc::SIG_IGN) };
    }
    before
}

/// Does `work` to its end although an interrupt, a hang-up or a request to terminate comes in between; that ends the process after it.
#[cfg(unix)]
#[allow(unsafe_code)]
pub(super) fn deferred<T>(work: impl FnOnce() -> T) -> T {
    use std::sync::atomic::{AtomicI32, Ordering};

    static CAME: AtomicI32 = AtomicI32::new(0);

    extern "C" fn note(signal: libc::c_int) {
        CAME.store(signal, Ordering::SeqCst);
    }

    let before = ENDING.map(|signal| handle(signal, note));
    let done = work();
    for (signal, before) in ENDING.into_iter().zip(before) {
        // SAFETY: what the system gave back above.
        unsafe { libc::signal(signal, before) };
    }
    let came = CAME.swap(0, Ordering::SeqCst);
    if came != 0 {
        // SAFETY: does what the signal would have done.
        unsafe { libc::raise(came) };
    }
    done
}

#[cfg(not(unix))]
pub(super) fn deferred<T>(work: impl FnOnce() -> T) -> T {
    work()
}
