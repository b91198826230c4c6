//! The program under a fault.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

/// A run that takes longer has not ended.
const LONGEST: Duration = Duration::from_secs(120);

/// The shared object, made once.
static SHIM: LazyLock<(tempfile::TempDir, PathBuf)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder");
    let (source, object) = (folder.path().join("shim.c"), folder.path().join("shim.so"));
    std::fs::write(&source, include_str!("shim.c")).expect("written");
    let compiler = std::env::var_os("CC").unwrap_or_else(|| "cc".into());
    let made =
        Command::new(compiler).args(["-O1", "-shared", "-fPIC", "-o"]).arg(&object).arg(&source).arg("-ldl").status();
    assert!(made.expect("a C compiler").success());
    (folder, object)
});

/// Which calls fail.
#[derive(Clone, Debug)]
pub(crate) enum Calls {
    /// Those that change files in a folder, with an error.
    Files(PathBuf, i32),
    /// Allocations of so many bytes and more.
    Heap(usize),
}

/// What happens at a call.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Mode {
    /// It fails.
    Once,
    /// It fails, and all later ones do.
    From,
    /// It is made, and a request to terminate comes after it: unlike an interrupt, no shell has its background jobs ignore that.
    Terminate,
    /// It calls `exit(-1)`, as a library does that has no memory.
    Exit,
}

impl Mode {
    fn name(self) -> &'static str {
        match self {
            Self::Once => "once",
            Self::From => "from",
            Self::Terminate => "terminate",
            Self::Exit => "exit",
        }
    }
}

/// How a run ended.
pub(crate) struct Ended {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

fn command(args: &[&str], calls: &Calls, at: usize, mode: Mode) -> Command {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("supel"));
    command.args(args).env("LD_PRELOAD", &SHIM.1).env("RUST_BACKTRACE", "1");
    command.env("FAULT_AT", at.to_string()).env("FAULT_MODE", mode.name());
    match calls {
        Calls::Files(folder, error) => {
            command.env("FAULT_KIND", "files").env("FAULT_FOLDER", folder).env("FAULT_ERRNO", error.to_string())
        }
        Calls::Heap(least) => command.env("FAULT_KIND", "heap").env("FAULT_LEAST", least.to_string()),
    };
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Runs the program with the fault, and fails where it does not end.
#[track_caller]
pub(crate) fn run(args: &[&str], calls: &Calls, at: usize, mode: Mode) -> Ended {
    let mut child = command(args, calls, at, mode).spawn().expect("started");
    let (out, err) = (child.stdout.take().expect("a pipe"), child.stderr.take().expect("a pipe"));
    let (out, err) = (reading(out), reading(err));
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("asked") {
            break status;
        }
        if start.elapsed() > LONGEST {
            child.kill().expect("killed");
            panic!("{args:?} with {calls:?} failing at {at} ({mode:?}) does not end");
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    Ended { code: status.code(), out: out.join().expect("read"), err: err.join().expect("read") }
}

/// All that comes, read by a thread so that nobody waits.
fn reading(mut from: impl std::io::Read + Send + 'static) -> std::thread::JoinHandle<String> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        from.read_to_end(&mut bytes).expect("read");
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

/// How many such calls a run makes.
pub(crate) fn count(args: &[&str], calls: &Calls, folder: &Path) -> usize {
    let counted = folder.join("count.txt");
    let status = command(args, calls, 0, Mode::Once).env("FAULT_COUNT", &counted).status().expect("started");
    assert!(status.code().is_some());
    let text = std::fs::read_to_string(&counted).expect("a count");
    std::fs::remove_file(counted).expect("removed");
    text.trim().parse().expect("a number")
}
