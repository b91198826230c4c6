//! What the signals of the system do to the program.
//!
//! An interrupt, a hang-up and a request to terminate are blocked in all threads, and one thread waits for them. No handler runs: METIS takes
//! that of SIGTERM for itself while it works and jumps out of it, whichever thread it is called on.

#[cfg(unix)]
use std::sync::Mutex;
#[cfg(unix)]
use std::sync::atomic::{AtomicBool, Ordering};

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

/// Held while something is done to its end.
#[cfg(unix)]
static UNDIVIDED: Mutex<()> = Mutex::new(());
/// Whether a signal came that ends the process.
#[cfg(unix)]
static CAME: AtomicBool = AtomicBool::new(false);

/// Has an interrupt, a hang-up or a request to terminate remove what is being written before it ends the process. One that is
/// ignored, as `nohup` asks for, stays so. To be called before other threads start.
#[cfg(unix)]
pub(super) fn leave_nothing_unfinished() {
    /// Bytes of a stack for a few calls of the system.
    const STACK: usize = 64 << 10;
    let awaited = set_of(ENDING.into_iter().filter(|signal| !is_ignored(*signal)));
    mask(libc::SIG_BLOCK, &awaited);
    let waiting = std::thread::Builder::new().stack_size(STACK).spawn(move || end_at_one_of(&awaited));
    if waiting.is_err() {
        // Without memory for a thread the system ends the process, and the next run names what is left.
        mask(libc::SIG_UNBLOCK, &awaited);
    }
}

#[cfg(not(unix))]
pub(super) fn leave_nothing_unfinished() {}

#[cfg(unix)]
#[allow(unsafe_code)]
fn set_of(signals: impl Iterator<Item = libc::c_int>) -> libc::sigset_t {
    let mut set = std::mem::MaybeUninit::uninit();
    // SAFETY: the set is made empty first, and signals are added to it that the system knows.
    unsafe {
        libc::sigemptyset(set.as_mut_ptr());
        for signal in signals {
            libc::sigaddset(set.as_mut_ptr(), signal);
        }
        set.assume_init()
    }
}

#[cfg(unix)]
#[allow(unsafe_code)]
fn is_ignored(signal: libc::c_int) -> bool {
    let mut action = std::mem::MaybeUninit::<libc::sigaction>::zeroed();
    // SAFETY: zeros are a value of the structure, and nothing is set.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), action.as_mut_ptr());
        action.assume_init().sa_sigaction == libc::SIG_IGN
    }
}

/// Blocks signals in this thread, and in those that it starts, or lets them come.
#[cfg(unix)]
#[allow(unsafe_code)]
fn mask(how: libc::c_int, set: &libc::sigset_t) {
    // SAFETY: the set is one; the former one is not asked for.
    unsafe { libc::pthread_sigmask(how, set, std::ptr::null_mut()) };
}

/// Waits for one of the signals and does what it does without a handler, once nothing is undivided.
#[cfg(unix)]
#[allow(unsafe_code)]
fn end_at_one_of(awaited: &libc::sigset_t) {
    let mut signal = 0;
    // SAFETY: both are there.
    while unsafe { libc::sigwait(awaited, &mut signal) } != 0 {}
    CAME.store(true, Ordering::SeqCst);
    let _held = UNDIVIDED.lock();
    crate::unfinished::remove_all();
    // SAFETY: the signal is one of the system's; where it does not end the process, its number as shells have it does.
    unsafe {
        libc::signal(signal, libc::SIG_DFL);
        mask(libc::SIG_UNBLOCK, awaited);
        libc::raise(signal);
        libc::_exit(128 + signal);
    }
}

/// Does `work` to its end although an interrupt, a hang-up or a request to terminate comes in between; that ends the process after it.
#[cfg(unix)]
pub(super) fn deferred<T>(work: impl FnOnce() -> T) -> T {
    let held = UNDIVIDED.lock();
    let done = work();
    drop(held);
    while CAME.load(Ordering::SeqCst) {
        std::thread::park();
    }
    done
}

#[cfg(not(unix))]
pub(super) fn deferred<T>(work: impl FnOnce() -> T) -> T {
    work()
}
