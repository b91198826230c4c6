//! How long a run will still take, from what its stages were foreseen to cost and have cost so far.

/// Foreseen seconds of the stages of a run in their order, on a machine that is not this one: only their ratios count.
#[derive(Clone, Debug, Default)]
pub(super) struct Remaining {
    foreseen: Vec<(&'static str, f64)>,
    /// Seconds of the stages that have ended, foreseen and taken.
    ended: [f64; 2],
    /// The stage that runs.
    running: Option<&'static str>,
}

/// Foreseen seconds of ended stages from which on they say how fast this machine is.
const TELLING: f64 = 0.05;
/// Share of the running stage from which on it says so itself.
const BEGUN: f64 = 0.02;

impl Remaining {
    /// Takes what is foreseen from now on; what the stages that have ended were foreseen to cost does not change.
    pub(super) fn foresee(&mut self, stages: Vec<(&'static str, f64)>) {
        self.foreseen = stages;
    }

    /// A stage begins; the one before has taken so long.
    pub(super) fn begin(&mut self, name: &'static str, seconds_before: f64) {
        if let Some(at) = self.place() {
            self.ended = [self.ended[0] + self.foreseen[at].1, self.ended[1] + seconds_before];
        }
        self.running = Some(name);
    }

    /// Where the running stage is among those foreseen.
    fn place(&self) -> Option<usize> {
        self.foreseen.iter().position(|(stage, _)| Some(*stage) == self.running)
    }

    /// Seconds that are left, where the running stage has taken so long and done this share of its work, if that is known; none while
    /// nothing tells how fast the machine is.
    pub(super) fn seconds(&self, seconds: f64, share: Option<f64>) -> Option<f64> {
        let running = self.place()?;
        let own = self.foreseen[running].1;
        let later: f64 = self.foreseen[running + 1..].iter().map(|(_, foreseen)| foreseen).sum();
        let [mut foreseen, mut taken] = self.ended;
        let share = share.filter(|share| *share >= BEGUN);
        if let Some(share) = share {
            (foreseen, taken) = (foreseen + share * own, taken + seconds);
        }
        if foreseen < TELLING {
            return None;
        }
        let slowness = taken / foreseen;
        // Without a share a stage that takes longer than foreseen has nothing left but what comes after it.
        let left = share.map_or_else(|| (own * slowness - seconds).max(0.0), |share| (1.0 - share) * own * slowness);
        Some(left + later * slowness)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn foreseen() -> Remaining {
        let mut remaining = Remaining::default();
        remaining.foresee(vec![("factor", 2.0), ("modes", 6.0), ("verification", 2.0)]);
        remaining
    }

    #[test]
    fn a_machine_that_takes_twice_as_long_takes_twice_as_long_for_the_rest() {
        let mut remaining = foreseen();
        remaining.begin("factor", 0.0);
        assert_eq!(remaining.seconds(0.1, None), None, "nothing tells yet");
        assert_eq!(
            remaining.seconds(1.0, Some(0.25)),
            Some(19.0),
            "a quarter of 2 s took 1 s: 3 s, and 8 s at half the speed"
        );
        remaining.begin("modes", 4.0);
        assert_eq!(remaining.seconds(0.0, None), Some(16.0));
        assert_eq!(remaining.seconds(6.0, Some(0.5)), Some(10.0));
        assert_eq!(remaining.seconds(100.0, None), Some(4.0), "longer than foreseen");
    }

    #[test]
    fn what_is_foreseen_anew_counts_from_then_on() {
        let mut remaining = foreseen();
        remaining.begin("factor", 0.0);
        remaining.begin("modes", 2.0);
        remaining.foresee(vec![("modes", 60.0), ("verification", 2.0)]);
        assert_eq!(remaining.seconds(0.0, None), Some(62.0));
        remaining.begin("something else", 60.0);
        assert_eq!(remaining.seconds(1.0, None), None);
    }
}
