//! The key of an entry: a digest of all that its result depends on.

use std::fmt::{self, Write};
use std::fs::File;
use std::sync::OnceLock;
use std::time::SystemTime;

use bytemuck::NoUninit;
use faer::MatRef;

use crate::dense;
use crate::sparse::SparseMatrix;

/// A digest of numbers.
pub(crate) type Digest = [u8; 32];

/// A key while it is being made.
#[derive(Clone, Debug)]
pub(crate) struct Key(blake3::Hasher);

impl Key {
    /// The key of a function, by a name that no other one has.
    pub(crate) fn of(function: &str) -> Self {
        Self(blake3::Hasher::new()).numbers(program()).text(&instructions()).text(function)
    }

    /// Goes on with numbers.
    pub(crate) fn numbers<T: NoUninit>(mut self, numbers: &[T]) -> Self {
        self.0.update(&(numbers.len() as u64).to_le_bytes());
        self.0.update(bytemuck::cast_slice(numbers));
        self
    }

    /// Goes on with text.
    pub(crate) fn text(self, text: &str) -> Self {
        self.numbers(text.as_bytes())
    }

    /// Goes on with a value as it is shown for debugging, which for numbers is all of their digits.
    pub(crate) fn shown(mut self, value: &dyn fmt::Debug) -> Self {
        let mut shown = Shown { hasher: &mut self.0, n_bytes: 0 };
        // A hasher takes everything.
        let _ = write!(shown, "{value:?}");
        let n_bytes = shown.n_bytes;
        self.0.update(&n_bytes.to_le_bytes());
        self
    }

    /// Goes on with where a matrix has entries.
    pub(crate) fn pattern(self, matrix: &SparseMatrix) -> Self {
        self.numbers(matrix.indptr().into_raw_storage()).numbers(matrix.indices())
    }

    /// Goes on with a matrix.
    pub(crate) fn matrix(self, matrix: &SparseMatrix) -> Self {
        self.pattern(matrix).numbers(matrix.data())
    }

    /// Goes on with the columns of a matrix.
    pub(crate) fn columns(self, columns: MatRef<'_, f64>) -> Self {
        let key = self.numbers(&[columns.nrows(), columns.ncols()]);
        (0..columns.ncols()).fold(key, |key, j| key.numbers(dense::column(columns, j)))
    }

    /// The digest of everything.
    pub(crate) fn digest(&self) -> Digest {
        *self.0.finalize().as_bytes()
    }
}

/// Hashes what is written.
struct Shown<'a> {
    hasher: &'a mut blake3::Hasher,
    n_bytes: u64,
}

impl Write for Shown<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.hasher.update(text.as_bytes());
        self.n_bytes += text.len() as u64;
        Ok(())
    }
}

/// The program, by its version and its bytes: another build may round in another order.
fn program() -> &'static Digest {
    static PROGRAM: OnceLock<Digest> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        let mut hasher = blake3::Hasher::new();
        hasher.update(env!("CARGO_PKG_VERSION").as_bytes());
        if running().and_then(|bytes| hasher.update_reader(bytes).map(|_| ())).is_err() {
            // One that cannot be read finds nothing but what it has kept itself.
            hasher.update(format!("{} {:?}", std::process::id(), SystemTime::now()).as_bytes());
        }
        *hasher.finalize().as_bytes()
    })
}

/// The file of the running program. By its name another build may be found that was installed since.
fn running() -> std::io::Result<File> {
    match cfg!(target_os = "linux") {
        true => File::open("/proc/self/exe"),
        false => File::open(std::env::current_exe()?),
    }
}

/// What decides how sums are rounded: with other vectors dense kernels add in another order.
fn instructions() -> String {
    #[cfg(target_arch = "x86_64")]
    let vectors = [
        std::arch::is_x86_feature_detected!("avx512f"),
        std::arch::is_x86_feature_detected!("avx512bw"),
        std::arch::is_x86_feature_detected!("avx512cd"),
        std::arch::is_x86_feature_detected!("avx512dq"),
        std::arch::is_x86_feature_detected!("avx512vl"),
        std::arch::is_x86_feature_detected!("avx2"),
        std::arch::is_x86_feature_detected!("fma"),
    ];
    #[cfg(not(target_arch = "x86_64"))]
    let vectors = [false; 0];
    format!("{} {} {vectors:?}", std::env::consts::ARCH, cfg!(target_endian = "little"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is hashed one after the other must not be what something else is hashed to in one go.
    #[test]
    fn keys_tell_where_one_thing_ends() {
        let key = || Key::of("f");
        let digests = [
            key().digest(),
            Key::of("g").digest(),
            key().numbers(&[1.0, 2.0]).digest(),
            key().numbers(&[1.0]).numbers(&[2.0]).digest(),
            key().numbers(&[1.0, 2.0]).numbers::<f64>(&[]).digest(),
            key().numbers(&[-0.0]).digest(),
            key().numbers(&[0.0]).digest(),
            key().text("ab").text("c").digest(),
            key().text("a").text("bc").digest(),
            key().shown(&"ab").shown(&"c").digest(),
            key().shown(&"a").shown(&"bc").digest(),
            key().shown(&0.1).digest(),
            key().shown(&(0.1 + f64::EPSILON / 16.0)).digest(),
        ];
        for (i, a) in digests.iter().enumerate() {
            assert!(digests[..i].iter().all(|b| a != b), "{i}");
        }
        assert_eq!(key().shown(&0.1).digest(), key().shown(&0.1).digest());
    }
}
