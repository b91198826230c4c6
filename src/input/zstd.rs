//! Zstandard: the frames of a file one after another, their checksums compared, frames to be skipped left out.

use std::io::{BufRead, Error, ErrorKind, Read, Result};

use ruzstd::decoding::errors::{FrameDecoderError, ReadFrameHeaderError};
use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};

/// Windows up to this size are always taken, those that `zstd -19` makes.
const SMALL_WINDOW: u64 = 8 << 20;
/// The largest window, that of `zstd --ultra -22`.
const MAX_WINDOW: u64 = 128 << 20;

/// The unpacked bytes of a file of frames.
pub(super) struct ZstdFrames<R> {
    source: R,
    decoder: FrameDecoder,
    is_inside: bool,
}

impl<R: BufRead> ZstdFrames<R> {
    /// At the first frame. A frame may ask for a window of so many bytes.
    pub(super) fn new(source: R, window: u64) -> Self {
        let mut decoder = FrameDecoder::new();
        decoder.set_max_window_size(window.clamp(SMALL_WINDOW, MAX_WINDOW));
        Self { source, decoder, is_inside: false }
    }

    pub(super) fn get_ref(&self) -> &R {
        &self.source
    }

    /// Goes into the next frame; false at the end of the file.
    fn enter(&mut self) -> Result<bool> {
        while !self.source.fill_buf()?.is_empty() {
            match self.decoder.init(&mut self.source) {
                Ok(()) => {
                    self.is_inside = true;
                    return Ok(true);
                }
                Err(FrameDecoderError::ReadFrameHeaderError(ReadFrameHeaderError::SkipFrame { length, .. })) => {
                    let n_skipped = std::io::copy(&mut self.source.by_ref().take(length.into()), &mut std::io::sink())?;
                    if n_skipped < u64::from(length) {
                        return Err(ErrorKind::UnexpectedEof.into());
                    }
                }
                Err(error) => return Err(damaged(error)),
            }
        }
        Ok(false)
    }

    /// Leaves a frame of which everything was read.
    fn leave(&mut self) -> Result<()> {
        self.is_inside = false;
        match self.decoder.get_checksum_from_data() {
            stated @ Some(_) if stated != self.decoder.get_calculated_checksum() => {
                Err(Error::new(ErrorKind::InvalidData, "the checksum of a frame differs"))
            }
            _ => Ok(()),
        }
    }
}

impl<R: BufRead> Read for ZstdFrames<R> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        while self.is_inside || self.enter()? {
            while self.decoder.can_collect() == 0 && !self.decoder.is_finished() {
                let one = BlockDecodingStrategy::UptoBlocks(1);
                self.decoder.decode_blocks(&mut self.source, one).map_err(damaged)?;
            }
            let n_read = self.decoder.read(buffer)?;
            if n_read > 0 || buffer.is_empty() {
                return Ok(n_read);
            }
            self.leave()?;
        }
        Ok(0)
    }
}

fn damaged(error: FrameDecoderError) -> Error {
    Error::new(ErrorKind::InvalidData, error.to_string())
}
