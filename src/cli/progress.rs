//! Progress for a person who waits: one line on stderr with the running stage, what it has done of what it has to do, and the time that is
//! left.

use std::io::Write;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::answer::Progress;
use super::remaining::Remaining;
use crate::cost_forecast::Foreseen;
use crate::error::Warning;
use crate::heap;
use crate::number::counted;
use crate::report::{Observer, printable};
use crate::tally::{self, Tally};

/// How often the line is written anew.
const EVERY: Duration = Duration::from_millis(250);
/// Cells of a bar.
const CELLS: usize = 20;
/// Less is not worth telling.
const SHORTEST_SECONDS: f64 = 2.0;

/// Shows the running stage on stderr, or nothing.
pub(super) struct StageLine {
    shown: Option<Shown>,
}

/// A line that is shown, and the thread that keeps it up to date.
struct Shown {
    line: Arc<Line>,
    writer: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Line {
    state: Mutex<State>,
    changed: Condvar,
}

/// What is known of the run.
#[derive(Default)]
struct State {
    running: Option<(&'static str, Instant)>,
    foreseen: Foreseen,
    remaining: Remaining,
    has_ended: bool,
}

impl StageLine {
    pub(super) fn new(progress: Progress) -> Self {
        let shown = (progress == Progress::Shown).then(|| {
            let line = Arc::new(Line::default());
            let own = Arc::clone(&line);
            // Without a thread the stages are named all the same, each as it begins.
            let writer = std::thread::Builder::new().name("progress".to_owned()).spawn(move || own.keep_written());
            Shown { line, writer: writer.ok() }
        });
        Self { shown }
    }

    /// Shows a line in the place of the last one.
    pub(super) fn show(&self, text: &str) {
        if self.shown.is_some() {
            write_line(text);
        }
    }

    fn change(&self, change: impl FnOnce(&mut State)) {
        if let Some(Shown { line, .. }) = &self.shown {
            let mut state = line.lock();
            change(&mut state);
            if let Some(text) = state.text() {
                write_line(&text);
            }
        }
    }
}

impl Observer for StageLine {
    fn stage(&mut self, name: &'static str) {
        heap::enter_stage(name);
        tally::begin();
        self.change(|state| {
            let before = state.running.map_or(0.0, |(_, start)| start.elapsed().as_secs_f64());
            state.remaining.begin(name, before);
            state.running = Some((name, Instant::now()));
        });
    }

    fn foreseen(&mut self, foreseen: &Foreseen) {
        self.change(|state| {
            state.remaining.foresee(foreseen.seconds.clone());
            state.foreseen = foreseen.clone();
        });
    }

    fn warned(&mut self, warning: &Warning) {
        self.show(&format!("supel: {}: {}\n", warning.code, printable(&warning.message)));
    }
}

impl Drop for StageLine {
    fn drop(&mut self) {
        if let Some(Shown { line, writer }) = &mut self.shown {
            line.lock().has_ended = true;
            line.changed.notify_all();
            writer.take().map(JoinHandle::join);
            write_line("");
        }
    }
}

impl Line {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Writes the line again and again until the run has ended.
    fn keep_written(&self) {
        let mut state = self.lock();
        while !state.has_ended {
            (state, _) = self.changed.wait_timeout(state, EVERY).unwrap_or_else(PoisonError::into_inner);
            if let Some(text) = state.text().filter(|_| !state.has_ended) {
                write_line(&text);
            }
        }
    }
}

impl State {
    fn text(&self) -> Option<String> {
        let (name, start) = self.running?;
        let (tally, seconds) = (tally::so_far(), start.elapsed().as_secs_f64());
        let share = share(&self.foreseen, name, &tally);
        let done = done(&self.foreseen, name, &tally);
        Some(line(name, share, done, self.remaining.seconds(seconds, share)))
    }
}

/// The share of a stage that is done, where its counts tell.
fn share(foreseen: &Foreseen, name: &str, tally: &Tally) -> Option<f64> {
    let share = match name {
        "factor" | "certificate" => tally.flops as f64 / foreseen.factor_flops,
        "constraint modes" => tally.solves as f64 / foreseen.n_interface as f64,
        "modes" => tally.modes as f64 / foreseen.n_modes? as f64,
        _ => return None,
    };
    (share.is_finite() && share > 0.0).then(|| share.min(1.0))
}

/// What a stage has done, in words; nothing where it counts nothing.
fn done(foreseen: &Foreseen, name: &str, tally: &Tally) -> Option<String> {
    let solves = counted(tally.solves as usize, "solve", "solves");
    match (name, foreseen.n_modes) {
        _ if tally.solves == 0 => None,
        ("constraint modes", _) => Some(format!("{} of {} solves", tally.solves, foreseen.n_interface)),
        // Those next to the wanted ones converge with them.
        ("modes", Some(n_modes)) => Some(format!("{} of {n_modes} modes · {solves}", tally.modes.min(n_modes as u64))),
        _ => Some(solves),
    }
}

fn line(name: &str, share: Option<f64>, done: Option<String>, seconds_left: Option<f64>) -> String {
    let bar = share.map(|share| {
        let full = (share * CELLS as f64) as usize;
        format!("[{}{}]", "#".repeat(full), "·".repeat(CELLS - full))
    });
    let left = seconds_left.filter(|seconds| *seconds >= SHORTEST_SECONDS).map(left_in_words);
    let parts: Vec<String> = [done, left].into_iter().flatten().collect();
    let head = [Some(format!("  {name} …")), bar].into_iter().flatten().collect::<Vec<_>>().join(" ");
    [vec![head], parts].concat().join(" · ")
}

/// With the digits that an estimate has.
fn left_in_words(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 10.0 => format!("about {seconds:.0} s left"),
        seconds if seconds < 90.0 => format!("about {:.0} s left", 5.0 * (seconds / 5.0).round()),
        seconds if seconds < 5400.0 => format!("about {:.0} min left", seconds / 60.0),
        seconds => format!("about {:.0} h left", seconds / 3600.0),
    }
}

fn write_line(text: &str) {
    // Back to the first column and clear the line: the answer that follows must not mix with it.
    let _ = write!(std::io::stderr(), "\r\x1b[2K{text}");
}

#[cfg(test)]
mod tests {
    use super::*;

    fn foreseen() -> Foreseen {
        Foreseen { seconds: Vec::new(), factor_flops: 200.0, n_interface: 12, n_modes: Some(40) }
    }

    fn shown(name: &str, tally: &Tally, left: Option<f64>) -> String {
        let foreseen = foreseen();
        line(name, share(&foreseen, name, tally), done(&foreseen, name, tally), left)
    }

    #[test]
    fn a_line_has_what_is_done_of_what_there_is_to_do() {
        let tally = Tally { solves: 6, flops: 50, modes: 10 };
        assert_eq!(shown("read", &Tally::default(), None), "  read …");
        assert_eq!(
            shown("factor", &Tally { solves: 0, ..tally }, Some(3.2)),
            "  factor … [#####···············] · about 3 s left"
        );
        assert_eq!(
            shown("constraint modes", &tally, None),
            "  constraint modes … [##########··········] · 6 of 12 solves"
        );
        assert_eq!(
            shown("modes", &tally, Some(47.0)),
            "  modes … [#####···············] · 10 of 40 modes · 6 solves · about 45 s left"
        );
        assert_eq!(shown("preservation", &tally, Some(1.0)), "  preservation … · 6 solves");
        let last = Tally { solves: 1, flops: 0, modes: 43 };
        assert_eq!(shown("modes", &last, None), "  modes … [####################] · 40 of 40 modes · 1 solve");
        assert_eq!(left_in_words(400.0), "about 7 min left");
        assert_eq!(left_in_words(10_000.0), "about 3 h left");
    }

    #[test]
    fn more_than_was_foreseen_is_a_full_bar() {
        let tally = Tally { solves: 0, flops: 900, modes: 0 };
        assert_eq!(shown("certificate", &tally, None), "  certificate … [####################]");
        assert_eq!(share(&Foreseen::default(), "factor", &Tally::default()), None);
    }
}
