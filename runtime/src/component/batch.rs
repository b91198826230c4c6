//! Evaluations of many components at once, by several threads.

use alloc::vec::Vec;
use std::num::NonZero;
use std::sync::{Mutex, PoisonError};

use super::error::EvaluationError;
use super::modal_component::ModalComponent;
use super::state::State;
use super::workspace::Workspace;

/// One component in one state, and where its results go.
#[derive(Debug)]
pub struct Evaluation<'a> {
    /// The component; several evaluations may share it.
    pub component: &'a ModalComponent,
    /// Its state.
    pub state: State<'a>,
    /// Its workspace.
    pub workspace: &'a mut Workspace,
}

/// Why one of several evaluations failed. All others were made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("component {index} (from 0) of the batch: {source}")]
pub struct BatchError {
    /// Number of the first evaluation that failed.
    pub index: usize,
    /// Why.
    pub source: EvaluationError,
}

/// [`ModalComponent::evaluate`] of all `evaluations`, by at most `threads` threads, of which the caller's is one.
///
/// Each evaluation is made by one thread, so that the results have the same bits for any number of them. Threads are
/// started and ended within the call, tens of microseconds for each: more than one pays where the evaluations take some
/// hundreds of them.
///
/// # Errors
///
/// [`BatchError`] with the first evaluation that failed.
pub fn evaluate_all(evaluations: &mut [Evaluation<'_>], threads: NonZero<usize>) -> Result<(), BatchError> {
    shared(evaluations, threads, ModalComponent::evaluate)
}

/// [`ModalComponent::tangents`] of all `evaluations`, as in [`evaluate_all`].
///
/// # Errors
///
/// The errors of [`evaluate_all`].
pub fn tangents_all(evaluations: &mut [Evaluation<'_>], threads: NonZero<usize>) -> Result<(), BatchError> {
    shared(evaluations, threads, ModalComponent::tangents)
}

/// [`ModalComponent::exact_tangents`] of all `evaluations`, as in [`evaluate_all`].
///
/// # Errors
///
/// The errors of [`evaluate_all`].
pub fn exact_tangents_all(evaluations: &mut [Evaluation<'_>], threads: NonZero<usize>) -> Result<(), BatchError> {
    shared(evaluations, threads, ModalComponent::exact_tangents)
}

type Evaluate = fn(&ModalComponent, &State<'_>, &mut Workspace) -> Result<(), EvaluationError>;

/// Parts per thread: components of different size spread evenly, and threads seldom meet at the queue.
const PARTS: usize = 8;

/// Every thread takes the next part that no other thread has taken.
fn shared(evaluations: &mut [Evaluation<'_>], threads: NonZero<usize>, evaluate: Evaluate) -> Result<(), BatchError> {
    let helpers = threads.get().min(evaluations.len()).saturating_sub(1);
    let size = evaluations.len().div_ceil(PARTS * (helpers + 1)).max(1);
    let queue = Mutex::new(evaluations.chunks_mut(size).enumerate());
    let work = || {
        let mut first: Option<BatchError> = None;
        loop {
            let next = queue.lock().unwrap_or_else(PoisonError::into_inner).next();
            let Some((part, evaluations)) = next else {
                return first;
            };
            for (i, Evaluation { component, state, workspace }) in evaluations.iter_mut().enumerate() {
                if let Err(source) = evaluate(component, state, workspace) {
                    first.get_or_insert(BatchError { index: part * size + i, source });
                }
            }
        }
    };
    let failures = std::thread::scope(|scope| {
        let started: Vec<_> = (0..helpers).map(|_| scope.spawn(work)).collect();
        let own = work();
        let joined = started.into_iter().map(|thread| thread.join());
        let others = joined.map(|outcome| outcome.unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        own.into_iter().chain(others.flatten()).min_by_key(|failure| failure.index)
    });
    failures.map_or(Ok(()), Err)
}
