//! The keys under which a cache has what was made of a partition in earlier runs.

use std::sync::OnceLock;

use super::Partition;
use super::earlier::Earlier;
use crate::cache::{Cache, Digest, Key};

impl Partition {
    /// The cache of the run.
    pub(crate) fn cache(&self) -> Option<&Cache> {
        self.earlier.as_ref().map(|earlier| &earlier.cache)
    }

    /// The key of what a function makes of K in its order and of where M has entries, which decides with K how factors are laid out.
    pub(crate) fn key_of_stiffness(&self, function: &str) -> Key {
        let digest = || {
            let key = Key::of("stiffness").matrix(&self.stiffness).pattern(&self.mass);
            key.numbers(&[self.n_internal]).numbers(&self.part_ends).digest()
        };
        self.begun(function, |earlier| &earlier.stiffness, digest)
    }

    /// The key of what a function makes of K and M in their order.
    pub(crate) fn key_of_matrices(&self, function: &str) -> Key {
        let digest = || self.key_of_stiffness("matrices").numbers(self.mass.data()).digest();
        self.begun(function, |earlier| &earlier.matrices, digest)
    }

    /// The key of what a function makes of K, M and all that is known of their roundings, of a partition to which nothing is added any more.
    pub(crate) fn key(&self, function: &str) -> Key {
        self.begun(function, |earlier| &earlier.whole, || self.whole())
    }

    fn begun(
        &self,
        function: &str,
        place: impl Fn(&Earlier) -> &OnceLock<Digest>,
        digest: impl FnOnce() -> Digest,
    ) -> Key {
        let digest = match &self.earlier {
            Some(earlier) => *place(earlier).get_or_init(digest),
            None => digest(),
        };
        Key::of(function).numbers(&digest)
    }

    /// Whatever a field is new, it has to be said here whether modes depend on it.
    fn whole(&self) -> Digest {
        let Self {
            // In the key of the matrices.
            stiffness: _,
            mass: _,
            n_internal: _,
            part_ends: _,
            dofs: _,
            transformation,
            mixed,
            scaling,
            precision,
            fit,
            cancellation,
            patches,
            mass_patches,
            // Names, outputs and facts, and what is made of the fields above. Who asks the facts of the model adds them to the key.
            interface: _,
            left_out: _,
            unloaded: _,
            followers: _,
            held: _,
            gravity: _,
            loads: _,
            expansion: _,
            recovered: _,
            outputs: _,
            quantities: _,
            matrices: _,
            model: _,
            findings: _,
            roundings: _,
            mass_roundings: _,
            earlier: _,
        } = self;
        let key = self.key_of_matrices("whole").shown(scaling).shown(precision).numbers(&[*cancellation]);
        let key = key.shown(&fit.is_preloaded()).shown(&mixed.as_ref().map(|mixed| &mixed.held));
        let key = transformation.dofs.iter().fold(key, |key, dof| key.shown(&dof.origin));
        let key = transformation.rows.iter().fold(key, |key, row| key.shown(row));
        mass_patches.key(patches.key(key)).digest()
    }
}
