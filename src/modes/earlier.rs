//! Modes that an earlier run has certified further than they are asked for now.
//!
//! An entry of modes serves the search that made it. Where a certificate says that they are all there are below a shift, they contain what
//! any search for fewer would find, so that a second entry, which every search under this boundary looks at, names them with their count.

use crate::cache::{Cache, Digest, Key, Kind, Reader, Recorded, Writer};
use crate::eigen::{CLUSTER_GAP, ElasticCount, Modes, Wanted};
use crate::factor::InertiaCount;

/// Gaps of a cluster that the end of a band keeps from the shift of the count: a mode at the end may belong to the band.
const ROOM: f64 = 4.0;

/// The entry of the modes that are certified furthest, and the count that they agree with.
#[derive(Clone, Copy, Debug)]
pub(super) struct CertifiedBand {
    pub(super) entry: Digest,
    pub(super) count: ElasticCount,
}

impl Recorded for CertifiedBand {
    const KIND: Kind = Kind::Band;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { entry, count } = self;
        to.array(entry)?;
        to.counts(&[count.n_elastic])?;
        count.inertia.write(to)
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let entry = from.digest()?;
        let [n_elastic] = from.counts()?[..] else { return None };
        Some(Self { entry, count: ElasticCount { inertia: InertiaCount::read(from)?, n_elastic } })
    }
}

/// Modes that are all there are below the shift of a count.
#[derive(Clone, Debug)]
pub(super) struct CertifiedModes {
    pub(super) modes: Modes,
    pub(super) count: ElasticCount,
}

impl CertifiedModes {
    /// The modes of a certified band, n rows; none where they do not contain what is wanted, or are not those that were counted.
    pub(super) fn containing(wanted: Wanted, cache: &Cache, band: &CertifiedBand, n: usize) -> Option<Self> {
        let CertifiedBand { entry, count } = *band;
        let sigma = count.inertia.sigma;
        let may_contain = match wanted {
            Wanted::Count(wanted) => wanted <= count.n_elastic,
            Wanted::UpTo(limit) => limit * (1.0 + ROOM * CLUSTER_GAP) < sigma,
        };
        if !may_contain {
            return None;
        }
        let modes: Modes = cache.of_earlier_run(&entry)?;
        let is_counted = modes.shapes.nrows() == n
            && modes.lambda.is_sorted()
            && modes.lambda.iter().all(|lambda| *lambda < sigma)
            && modes.count() == count.n_elastic;
        is_counted.then_some(Self { modes, count })
    }

    /// Names the entry of modes under the key of their boundary, where they reach further than what is there.
    pub(super) fn keep(cache: &Cache, key: &Key, band: &CertifiedBand, reach: Option<f64>) {
        if reach.is_none_or(|reach| reach < band.count.inertia.sigma) {
            cache.replace(key, band);
        }
    }
}
