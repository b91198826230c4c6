//! Text in large blocks cut at line ends. One thread reads and inflates while the pool works on earlier blocks.

use std::io::Read;
use std::path::Path;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};

use super::source::{Source, read_error};
use crate::error::{Error, Result};

/// Bytes of a block: large enough to hide the hand-over, small enough that a dozen of them take little memory.
pub(super) const BLOCK_BYTES: usize = 1 << 21;
/// The longest line. Entries and comments are far shorter; a longer one is not text.
const MAX_LINE_BYTES: usize = 1 << 16;
/// Blocks that may wait for the pool.
const N_WAITING: usize = 4;

/// What is known of a file once all of it was read.
pub(super) struct Ending {
    /// BLAKE3 of the file's bytes, lower-case hexadecimal.
    pub(super) digest: String,
    /// Whether the last line has a line end.
    pub(super) last_line: LastLine,
}

/// Whether the last line of a file is complete.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LastLine {
    /// It has a line end, or the file is empty.
    Terminated,
    /// It has none: the usual sign of a file cut short.
    Open,
}

/// Hands the text of a file to `consume` in batches of blocks, in order. Each block ends at a line end, except the
/// last. At most a few blocks per thread are in memory.
pub(super) fn for_each_batch(
    path: &Path,
    block_bytes: usize,
    mut consume: impl FnMut(&[Vec<u8>]) -> Result<()>,
) -> Result<Ending> {
    let source = Source::open(path)?;
    std::thread::scope(|scope| {
        let (sender, receiver) = sync_channel(N_WAITING);
        let (used_sender, used) = channel();
        let producer = std::thread::Builder::new()
            .spawn_scoped(scope, move || produce((path, source), block_bytes, &sender, &used))
            .map_err(|_| Error::OutOfMemory { what: "the thread that reads a matrix" })?;
        let outcome = consume_all(receiver, &used_sender, &mut consume);
        let ending = producer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        // What the consumer found comes earlier in the file than where the producer has got to.
        outcome?;
        ending
    })
}

fn consume_all(
    receiver: Receiver<Vec<u8>>,
    used: &Sender<Vec<u8>>,
    consume: &mut impl FnMut(&[Vec<u8>]) -> Result<()>,
) -> Result<()> {
    let max_batch = rayon::current_num_threads() + 1;
    while let Ok(block) = receiver.recv() {
        let mut batch = vec![block];
        batch.extend(receiver.try_iter().take(max_batch - 1));
        consume(&batch)?;
        // A producer that has read everything takes none back.
        batch.into_iter().for_each(|block| drop(used.send(block)));
    }
    Ok(())
}

/// Reads blocks and sends them, to the end of the file or until the receiver is gone. Blocks that were used are filled again: the system
/// takes longer to hand out fresh memory than it takes to fill it.
fn produce(
    (path, mut source): (&Path, Source),
    block_bytes: usize,
    sender: &SyncSender<Vec<u8>>,
    used: &Receiver<Vec<u8>>,
) -> Result<Ending> {
    let empty = || {
        let mut block = used.try_recv().unwrap_or_else(|_| Vec::with_capacity(block_bytes + READ_BYTES));
        block.clear();
        block
    };
    let mut block = empty();
    let mut n_lines = 0;
    loop {
        let n_read = fill(&mut source, &mut block, block_bytes).map_err(|error| read_error(path, error))?;
        if n_read == 0 {
            let last_line = if block.is_empty() { LastLine::Terminated } else { LastLine::Open };
            // A receiver that is gone has reported its own error.
            let _ = sender.send(block);
            return Ok(Ending { digest: source.digest(), last_line });
        }
        let end = block.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
        if block.len() - end > MAX_LINE_BYTES {
            let line = n_lines + count_lines(&block[..end]) + 1;
            return Err(Error::LineTooLong { path: path.to_owned(), line, limit: MAX_LINE_BYTES });
        }
        if end == 0 {
            continue;
        }
        let mut next = empty();
        next.extend_from_slice(&block[end..]);
        block.truncate(end);
        n_lines += count_lines(&block);
        if sender.send(block).is_err() {
            return Ok(Ending { digest: source.digest(), last_line: LastLine::Terminated });
        }
        block = next;
    }
}

/// Bytes read at once into a block.
const READ_BYTES: usize = 1 << 16;

/// Reads until the block holds `block_bytes` or one step more than it had; returns the bytes added, zero at the end.
fn fill(source: &mut Source, block: &mut Vec<u8>, block_bytes: usize) -> std::io::Result<usize> {
    let before = block.len();
    let step = READ_BYTES.min(block_bytes);
    while block.len() < block_bytes || block.len() == before {
        let filled = block.len();
        block.resize(filled + step, 0);
        let n_read = source.read(&mut block[filled..]);
        block.truncate(filled + *n_read.as_ref().unwrap_or(&0));
        match n_read {
            Ok(0) => break,
            Ok(_) => {}
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(block.len() - before)
}

/// Line ends in a text.
pub(super) fn count_lines(text: &[u8]) -> u64 {
    // Sums of a byte each are what the vector units count in.
    text.chunks(255).map(|part| u64::from(part.iter().map(|&byte| u8::from(byte == b'\n')).sum::<u8>())).sum()
}
