//! The modes of the full model that a reduced model has to answer under a boundary.
//!
//! Full and reduced eigenvalues are compared in their order. A mode that the superelement leaves out because nothing starts or sees it (K-20) has
//! to be in neither list: put back among the reduced eigenvalues it would stand between a mode that is seen and its answer, and halve the error
//! of both. At rest at the interface, and without reaction there, it is an eigenvector of the full model whatever the boundary holds, loads
//! or springs: its eigenvalue is among those of every boundary, as often as there are such modes. Taking it out leaves the eigenvalues of
//! all that is orthogonal to these modes, of which the superelement is a model with constraints: none of its eigenvalues lies below.

use super::super::evidence::Evidence;
use super::reference::Reference;
use crate::dense;
use crate::eigen::CLUSTER_GAP;
use crate::unseen::UnseenMode;

/// Two eigenvalues within this many error bars of one another are one.
const WITHIN_BARS: f64 = 10.0;

/// The modes that the superelement leaves out, of which it says nothing.
fn left_out<'a>(evidence: &Evidence<'a>) -> &'a [UnseenMode] {
    evidence.unseen
}

/// Whether a reduced coordinate is one that the superelement has.
pub(super) fn is_kept(evidence: &Evidence<'_>, coordinate: usize) -> bool {
    left_out(evidence).iter().all(|mode| mode.coordinate != coordinate)
}

/// How many of the leading `n` coordinates the superelement leaves out.
pub(super) fn n_left_out(evidence: &Evidence<'_>, n: usize) -> usize {
    left_out(evidence).iter().filter(|mode| mode.coordinate < n).count()
}

impl Reference {
    /// Numbers of the eigenvalues that the leading `n` coordinates have to answer: all but those of modes among them that are left out. One that
    /// is not found here stays asked for in the place of another, which makes no error smaller.
    pub(super) fn asked_of(&self, evidence: &Evidence<'_>, n: usize) -> Vec<usize> {
        let mut asked: Vec<usize> = (0..self.lambda.len()).collect();
        let own = &evidence.retained.modes;
        for mode in left_out(evidence).iter().filter(|mode| mode.coordinate < n).map(|mode| mode.mode) {
            let apart = |at: usize| (self.lambda[asked[at]] / own.lambda[mode] - 1.0).abs();
            let nearest = (0..asked.len()).reduce(|a, b| if dense::worse(apart(a), apart(b)) { b } else { a });
            let Some(nearest) = nearest else { break };
            let bars = own.errors[mode].relative_bar + self.errors[asked[nearest]].relative_bar;
            if apart(nearest) <= CLUSTER_GAP.max(WITHIN_BARS * bars) {
                asked.remove(nearest);
            }
        }
        asked
    }
}
