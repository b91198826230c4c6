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

/// Does `work` to its end although an interrupt, a hang-up or a request to terminate comes in between; that ends the process after it.
#[cfg(unix)]
#[allow(unsafe_code)]
pub(super) fn deferred<T>(work: impl FnOnce() -> T) -> T {
    use std::sync::atomic::{AtomicI32, Ordering};

    const SIGNALS: [libc::c_int; 3] = [libc::SIGINT, libc::SIGTERM, libc::SIGHUP];
    static CAME: AtomicI32 = AtomicI32::new(0);

    extern "C" fn note(signal: libc::c_int) {
        CAME.store(signal, Ordering::SeqCst);
    }

    let before = SIGNALS.map(|signal| {
        // SAFETY: the handler stores a number and does nothing else.
        let before = unsafe { libc::signal(signal, note as *const () as libc::sighandler_t) };
        if before == libc::SIG_IGN {
            // SAFETY: ignored as it was, as `nohup` asks for.
            unsafe { libc::signal(signal, libc::SIG_IGN) };
        }
        before
    });
    let done = work();
    for (signal, before) in SIGNALS.into_iter().zip(before) {
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
