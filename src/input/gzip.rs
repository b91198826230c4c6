//! Gzipped data of one or several members, behind which zeros may stand: devices that write in blocks fill the last one, and gzip(1) passes
//! over them.

use std::io::{BufRead, Read, Result};

use flate2::bufread::GzDecoder;

/// The data of all members, one behind the other.
pub(super) struct GzipMembers<R> {
    /// The member that is being read; none while it is replaced.
    member: Option<GzDecoder<R>>,
}

impl<R: BufRead> GzipMembers<R> {
    pub(super) fn new(reader: R) -> Self {
        Self { member: Some(GzDecoder::new(reader)) }
    }

    /// What the members are read from.
    pub(super) fn get_ref(&self) -> &R {
        match &self.member {
            Some(member) => member.get_ref(),
            None => unreachable!("a member is replaced at once"),
        }
    }

    /// Goes on with the next member; false where none follows.
    fn advance(&mut self) -> Result<bool> {
        let Some(member) = &mut self.member else { return Ok(false) };
        loop {
            let rest = member.get_mut().fill_buf()?;
            if rest.is_empty() {
                return Ok(false);
            }
            match rest.iter().take_while(|byte| **byte == 0).count() {
                0 => break,
                n_zeros => member.get_mut().consume(n_zeros),
            }
        }
        self.member = self.member.take().map(|member| GzDecoder::new(member.into_inner()));
        Ok(true)
    }
}

impl<R: BufRead> Read for GzipMembers<R> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        loop {
            let n_read = self.member.as_mut().map_or(Ok(0), |member| member.read(buffer))?;
            if n_read > 0 || buffer.is_empty() || !self.advance()? {
                return Ok(n_read);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    fn packed(text: &str) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(text.as_bytes()).and_then(|()| encoder.finish()).expect("memory")
    }

    fn read(bytes: &[u8]) -> Result<String> {
        let mut text = String::new();
        GzipMembers::new(bytes).read_to_string(&mut text).map(|_| text)
    }

    #[test]
    fn members_and_zeros_behind_them() {
        let (one, two, zeros) = (packed("abc"), packed("def"), vec![0; 700]);
        assert_eq!(read(&[one.clone(), two.clone()].concat()).expect("members"), "abcdef");
        assert_eq!(read(&[one.clone(), two, zeros.clone()].concat()).expect("zeros"), "abcdef");
        assert!(read(&[one.clone(), zeros, b"x".to_vec()].concat()).is_err());
        assert!(read(&one[..one.len() - 3]).is_err());
        // A wrong checksum is none the better for zeros behind it.
        let mut wrong = one;
        let at = wrong.len() - 8;
        wrong[at] ^= 1;
        wrong.extend([0; 9]);
        assert!(read(&wrong).is_err());
    }
}
