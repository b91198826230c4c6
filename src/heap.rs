//! The heap of the program: large blocks are kept, and memory that runs out ends the run with one line and exit code 6.
//!
//! **Large blocks.** A reduction allocates and frees blocks of vectors, fronts and panels of many megabytes all the time. By default the
//! GNU allocator maps such a block when it is asked for and gives it back when it is freed, so that the kernel clears the same pages again
//! and again. That took a sixth of the time of a reduction of 91,000 dofs. Kept in one heap the pages are used again at once, and the peak
//! of memory stays what it was. Other allocators are left alone.
//!
//! **No memory.** Most allocations of this crate and of those it builds on cannot fail for their callers: the standard library prints a
//! line and aborts, and the linear algebra crate panics. With `RUST_BACKTRACE=1` a backtrace comes first, for which there is no memory
//! either. No stable hook lets a program decide. So [`Heap`], the allocator of the program, decides: where the system has no memory it writes
//! the line of [`Error::OutOfMemory`] with the running stage, removes what was being written, and ends
//! the process. Code that handles a failed allocation itself allocates within [`fallibly`].

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::io::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::Error;
use crate::unfinished;

/// Keeps freed memory in one heap for the next block, large ones too. To be called before any other thread exists: a heap of a
/// thread cannot hold a large block, so that each thread would ask the kernel again.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[allow(unsafe_code)]
pub fn keep_large_blocks() {
    /// "Never" for a threshold.
    const NEVER: libc::c_int = -1;
    let settings = [(libc::M_MMAP_MAX, 0), (libc::M_TRIM_THRESHOLD, NEVER), (libc::M_ARENA_MAX, 1)];
    for (setting, value) in settings {
        // SAFETY: `mallopt` takes two integers and changes nothing but the allocator's settings. One that it does not know stays
        // what it was, which is slower and nothing else.
        unsafe { libc::mallopt(setting, value) };
    }
}

/// Nothing to be done.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub fn keep_large_blocks() {}

thread_local! {
    /// Whether this thread handles the failure of its allocations.
    static IS_HANDLED: Cell<bool> = const { Cell::new(false) };
}

/// Runs `ask`, whose only allocations are such that their failure comes back to the caller.
pub fn fallibly<T>(ask: impl FnOnce() -> T) -> T {
    /// Puts the old state back on every way out.
    struct Restored(bool);
    impl Drop for Restored {
        fn drop(&mut self) {
            IS_HANDLED.set(self.0);
        }
    }
    let _restored = Restored(IS_HANDLED.replace(true));
    ask()
}

/// What is said and done where memory runs out.
struct LastWords {
    /// The running stage.
    stage: &'static str,
    /// Whether stdout was promised a JSON document whatever happens.
    document: Document,
}

/// Whether stdout carries a JSON document.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Document {
    /// One, also where the command ends in an error.
    Json,
    /// None.
    None,
}

static LAST_WORDS: Mutex<LastWords> = Mutex::new(LastWords { stage: "start", document: Document::None });

/// Changes what is said and done where memory runs out; `change` asks for no memory.
fn arrange(change: impl FnOnce(&mut LastWords)) {
    change(&mut LAST_WORDS.lock().unwrap_or_else(std::sync::PoisonError::into_inner))
}

/// Notes which stage runs from now on.
pub fn enter_stage(stage: &'static str) {
    arrange(|words| words.stage = stage);
}

/// Notes whether stdout was promised a JSON document.
pub fn promise(document: Document) {
    arrange(|words| words.document = document);
}

/// The system's allocator, which ends the process where it has no memory for a caller that cannot handle that.
pub struct Heap;

// SAFETY: every call is the system allocator's own, with the same arguments; what is added runs only where it returned null, and
// then either returns that null or does not return.
#[allow(unsafe_code)]
unsafe impl GlobalAlloc for Heap {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promised.
        given(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promised.
        given(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller promised.
        given(unsafe { System.realloc(block, layout, size) }, size)
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: as the caller promised.
        unsafe { System.dealloc(block, layout) };
    }
}

fn given(block: *mut u8, size: usize) -> *mut u8 {
    if block.is_null() && !IS_HANDLED.try_with(Cell::get).unwrap_or(false) {
        end(Missing::Bytes(size));
    }
    block
}

/// Whether a thread has found that there is no memory and is ending the process.
static IS_ENDING: AtomicBool = AtomicBool::new(false);

/// Has the C library, which aborts where a thread that starts finds no memory, leave the end of the process to the thread that found out
/// first. Other aborts stay what they are.
#[cfg(unix)]
#[allow(unsafe_code)]
pub fn end_once() {
    extern "C" fn aborted(signal: libc::c_int) {
        if IS_ENDING.load(Ordering::SeqCst) {
            std::thread::sleep(std::time::Duration::from_millis(200));
            exit_now();
        }
        // SAFETY: what the signal does without a handler.
        unsafe {
            libc::signal(signal, libc::SIG_DFL);
            libc::raise(signal);
        }
    }
    // SAFETY: the handler reads an atomic, sleeps and calls functions that a handler may call.
    unsafe { libc::signal(libc::SIGABRT, aborted as *const () as libc::sighandler_t) };
}

#[cfg(not(unix))]
pub fn end_once() {}

/// What could not be allocated.
#[derive(Clone, Copy)]
enum Missing {
    /// So many bytes for this program.
    Bytes(usize),
    /// Bytes that a library asked for.
    OfLibrary,
}

impl std::fmt::Display for Missing {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Bytes(size) => write!(f, "{size} bytes"),
            Self::OfLibrary => f.write_str("what a library needs"),
        }
    }
}

/// Ends a process that a library ends because it has no memory as this program does.
pub(crate) fn end_of_library() -> ! {
    end(Missing::OfLibrary)
}

/// Says that there is no memory, removes what was being written, and ends the process.
#[cold]
fn end(missing: Missing) -> ! {
    if IS_ENDING.swap(true, Ordering::SeqCst) {
        // Another thread without memory gives the first one time to end the process.
        std::thread::sleep(std::time::Duration::from_millis(200));
        exit_now();
    }
    match LAST_WORDS.try_lock() {
        Ok(words) => say(missing, words.stage, words.document),
        // Only another thread that notes something at this moment can hold it.
        Err(_) => say(missing, "unknown", Document::None),
    }
    unfinished::remove_all();
    exit_now()
}

/// The error of memory that ran out; it needs none itself.
const NO_MEMORY: Error = Error::OutOfMemory { what: "" };

/// The line on stderr and, where it was promised, the document on stdout.
fn say(missing: Missing, stage: &str, document: Document) {
    let (code, exit) = (NO_MEMORY.code(), NO_MEMORY.class() as u8);
    let mut text = Text { bytes: [0; 512], length: 0 };
    let message = format_args!(
        "out of memory – {missing} could not be allocated in the stage `{stage}` – free memory, use fewer threads or reduce a smaller model"
    );
    let _ = writeln!(text, "supel: error[{code}]: {message}");
    write_now(2, text.written());
    if document == Document::Json {
        text.length = 0;
        let (open, close) = ("{\n  \"error\": {\n    \"causes\": [],\n", "  }\n}");
        let fields =
            format_args!("    \"code\": \"{code}\",\n    \"exit_code\": {exit},\n    \"message\": \"{message}\"\n");
        let _ = writeln!(text, "{open}{fields}{close}");
        write_now(1, text.written());
    }
}

/// Text in memory that is there.
struct Text {
    bytes: [u8; 512],
    length: usize,
}

impl Text {
    fn written(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}

impl Write for Text {
    fn write(&mut self, more: &[u8]) -> std::io::Result<usize> {
        let taken = more.len().min(self.bytes.len() - self.length);
        self.bytes[self.length..self.length + taken].copy_from_slice(&more[..taken]);
        self.length += taken;
        Ok(taken)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Past the locks of the standard streams, which another thread may hold.
#[cfg(unix)]
#[allow(unsafe_code)]
fn write_now(stream: libc::c_int, mut text: &[u8]) {
    while !text.is_empty() {
        // SAFETY: the pointer and the length are those of a live slice.
        match usize::try_from(unsafe { libc::write(stream, text.as_ptr().cast(), text.len()) }) {
            Ok(written @ 1..) => text = &text[written.min(text.len())..],
            _ => return,
        }
    }
}

#[cfg(not(unix))]
fn write_now(stream: i32, text: &[u8]) {
    let _ = if stream == 1 { std::io::stdout().write_all(text) } else { std::io::stderr().write_all(text) };
}

/// Without what libraries want to do at the end of a process, for which there may be no memory.
#[cfg(unix)]
#[allow(unsafe_code)]
pub(crate) fn exit_now() -> ! {
    // SAFETY: ends the process.
    unsafe { libc::_exit(NO_MEMORY.class() as libc::c_int) }
}

#[cfg(not(unix))]
pub(crate) fn exit_now() -> ! {
    std::process::exit(NO_MEMORY.class() as i32)
}
