//! Progress for a person who waits: one line on stderr that names the running stage.

use std::io::Write;

use super::answer::Progress;
use crate::error::Warning;
use crate::heap;
use crate::report::{Observer, printable};

/// Shows the running stage on stderr, or nothing.
pub(super) struct StageLine {
    progress: Progress,
}

impl StageLine {
    pub(super) fn new(progress: Progress) -> Self {
        Self { progress }
    }

    /// Shows a line in the place of the last one.
    pub(super) fn show(&self, text: &str) {
        if self.progress == Progress::Shown {
            // Back to the first column and clear the line: the answer that follows must not mix with it.
            let _ = write!(std::io::stderr(), "\r\x1b[2K{text}");
        }
    }
}

impl Observer for StageLine {
    fn stage(&mut self, name: &'static str) {
        heap::enter_stage(name);
        self.show(&format!("  {name} …"));
    }

    fn warned(&mut self, warning: &Warning) {
        self.show(&format!("supel: {}: {}\n", warning.code, printable(&warning.message)));
    }
}

impl Drop for StageLine {
    fn drop(&mut self) {
        self.show("");
    }
}
