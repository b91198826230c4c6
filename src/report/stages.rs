//! Stages of a run: who listens to them and how long they took.

use std::time::Instant;

use serde::Serialize;

use crate::cost_forecast::Foreseen;
use crate::error::Warning;

/// Hears of each stage of the pipeline as it begins.
///
/// The pipeline knows neither the clock nor the terminal; what a stage took and what is shown is the listener's.
pub trait Observer {
    /// A stage begins, and with it the one before has ended.
    fn stage(&mut self, name: &'static str);

    /// What is foreseen of the stages still to come; it may come again when more is known.
    fn foreseen(&mut self, _foreseen: &Foreseen) {}

    /// What is known before the long work begins, and will stand in the report.
    fn warned(&mut self, _warning: &Warning) {}
}

/// An observer that ignores the stages.
impl Observer for () {
    fn stage(&mut self, _name: &'static str) {}
}

/// Wall time of one stage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StageTime {
    /// The stage, in one or two words.
    pub name: &'static str,
    /// Wall time.
    pub seconds: f64,
}

/// Measures the stages and passes them on.
#[derive(Debug)]
pub struct StageClock<'a, O: Observer + ?Sized> {
    listener: &'a mut O,
    running: Option<(&'static str, Instant)>,
    times: Vec<StageTime>,
}

impl<'a, O: Observer + ?Sized> StageClock<'a, O> {
    /// A clock that tells `listener` of each stage.
    pub fn new(listener: &'a mut O) -> Self {
        Self { listener, running: None, times: Vec::new() }
    }

    /// Ends the running stage and hands out the times; a name that came more than once has one row.
    pub fn finish(mut self) -> Vec<StageTime> {
        self.stop();
        self.times
    }

    fn stop(&mut self) {
        if let Some((name, start)) = self.running.take() {
            let seconds = start.elapsed().as_secs_f64();
            match self.times.iter_mut().find(|time| time.name == name) {
                Some(time) => time.seconds += seconds,
                None => self.times.push(StageTime { name, seconds }),
            }
        }
    }
}

impl<O: Observer + ?Sized> Observer for StageClock<'_, O> {
    fn stage(&mut self, name: &'static str) {
        self.stop();
        self.listener.stage(name);
        self.running = Some((name, Instant::now()));
    }

    fn foreseen(&mut self, foreseen: &Foreseen) {
        self.listener.foreseen(foreseen);
    }

    fn warned(&mut self, warning: &Warning) {
        self.listener.warned(warning);
    }
}
