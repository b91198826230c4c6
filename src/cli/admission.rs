//! Jobs side by side, as many as one budget of memory holds.

use std::collections::BTreeMap;
use std::sync::mpsc;

/// What limits how many jobs run at the same time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Jobs.
    pub(super) at_once: usize,
    /// The sum of their forecasts, in bytes; none where nothing limits it.
    pub(super) budget: Option<u64>,
}

impl Limits {
    /// Whether one more job starts while others with these forecasts run. One always runs: whether it fits is for itself to judge.
    fn admit(self, running: &BTreeMap<usize, u64>, need: u64) -> bool {
        let sum = running.values().fold(need, |sum, other| sum.saturating_add(*other));
        running.is_empty() || running.len() < self.at_once && self.budget.is_none_or(|budget| sum <= budget)
    }
}

/// Runs one job for each forecast, in bytes, in their order: the next starts as soon as it fits. Gives what each has come to in the
/// same order; `observe` hears which run, and how many have ended, whenever that changes.
pub(super) fn run_admitted<T: Send>(
    forecasts: &[u64],
    limits: Limits,
    run: impl Fn(usize) -> T + Sync,
    mut observe: impl FnMut(&[usize], usize),
) -> Vec<T> {
    let mut results: Vec<Option<T>> = forecasts.iter().map(|_| None).collect();
    let (ended, endings) = mpsc::channel();
    let run = &run;
    std::thread::scope(|scope| {
        let mut running: BTreeMap<usize, u64> = BTreeMap::new();
        let mut waiting = forecasts.iter().copied().enumerate().peekable();
        loop {
            while let Some((job, need)) = waiting.next_if(|(_, need)| limits.admit(&running, *need)) {
                running.insert(job, need);
                let ended = ended.clone();
                scope.spawn(move || ended.send((job, run(job))));
            }
            if running.is_empty() {
                break;
            }
            let n_ended = results.iter().flatten().count();
            observe(&running.keys().copied().collect::<Vec<_>>(), n_ended);
            let Ok((job, result)) = endings.recv() else { break };
            running.remove(&job);
            results[job] = Some(result);
        }
    });
    results.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    /// The largest sum of forecasts, and the most jobs, that ran at the same time.
    fn peaks(forecasts: &[u64], limits: Limits) -> (u64, usize) {
        let now = Mutex::new((0u64, 0usize));
        let peak = Mutex::new((0u64, 0usize));
        let order = run_admitted(
            forecasts,
            limits,
            |job| {
                {
                    let (mut now, mut peak) = (now.lock().expect("held"), peak.lock().expect("held"));
                    (now.0, now.1) = (now.0 + forecasts[job], now.1 + 1);
                    *peak = (peak.0.max(now.0), peak.1.max(now.1));
                }
                std::thread::sleep(std::time::Duration::from_millis(5));
                let mut now = now.lock().expect("held");
                (now.0, now.1) = (now.0 - forecasts[job], now.1 - 1);
                job
            },
            |_, _| {},
        );
        assert_eq!(order, (0..forecasts.len()).collect::<Vec<_>>());
        peak.into_inner().expect("held")
    }

    #[test]
    fn forecasts_that_run_together_fit_into_the_budget() {
        let forecasts = [3, 4, 2, 5, 1, 1, 7, 2, 2, 2];
        for budget in 7..=20 {
            let (sum, most) = peaks(&forecasts, Limits { at_once: 3, budget: Some(budget) });
            assert!(sum <= budget && most <= 3, "{sum} of {budget}, {most} at once");
        }
        let (_, most) = peaks(&[1; 8], Limits { at_once: 4, budget: None });
        assert!((2..=4).contains(&most), "{most}");
    }

    #[test]
    fn what_is_larger_than_the_budget_runs_alone() {
        let (sum, most) = peaks(&[9, 9, 9], Limits { at_once: 3, budget: Some(5) });
        assert_eq!((sum, most), (9, 1));
    }
}
