//! Compressed arrays of numbers.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use std::io::Write;

/// Uncompressed size of a block in bytes; readers decompress one block at a time.
const BLOCK: usize = 1 << 20;

/// Number types of VTK.
pub trait Number: Copy + Send + Sync {
    /// Name of the type in VTK.
    const NAME: &'static str;
    /// Appends the bytes of the number in little-endian order.
    fn append_to(self, bytes: &mut Vec<u8>);
}

macro_rules! number {
    ($number:ty, $name:literal) => {
        impl Number for $number {
            const NAME: &'static str = $name;
            fn append_to(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
        }
    };
}

number!(f32, "Float32");
number!(f64, "Float64");
number!(i64, "Int64");
number!(u8, "UInt8");

/// An array of numbers in the compressed form of VTK, including the header with the block sizes.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Number type.
    pub(super) number: &'static str,
    /// Header and compressed blocks.
    pub(super) bytes: Vec<u8>,
}

impl Column {
    /// Compresses numbers.
    pub fn new<N: Number>(numbers: impl Iterator<Item = N>) -> Self {
        let mut plain = vec![];
        for number in numbers {
            number.append_to(&mut plain);
        }
        let blocks: Vec<&[u8]> = plain.chunks(BLOCK).collect();
        let packed: Vec<Vec<u8>> = blocks.par_iter().map(|block| compress(block)).collect();
        // Number of blocks, block size, size of the last block if it is smaller, and the compressed sizes.
        let last = plain.len() % BLOCK;
        let header = [blocks.len(), BLOCK, last];
        let sizes = header.into_iter().chain(packed.iter().map(Vec::len));
        let mut bytes: Vec<u8> = sizes.flat_map(|size| (size as u64).to_le_bytes()).collect();
        packed
            .iter()
            .for_each(|block| bytes.extend_from_slice(block));
        Self {
            number: N::NAME,
            bytes,
        }
    }
}

fn compress(block: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(vec![], Compression::fast());
    // Writing to memory does not fail.
    let _ = encoder.write_all(block);
    encoder.finish().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    /// Decompresses like a reader of VTK files.
    fn decompressed(column: &Column) -> Vec<u8> {
        let word = |at: usize| {
            let bytes = column.bytes[8 * at..8 * at + 8].try_into().unwrap();
            u64::from_le_bytes(bytes) as usize
        };
        let (blocks, size, last) = (word(0), word(1), word(2));
        let mut at = 8 * (3 + blocks);
        let mut plain = vec![];
        for block in 0..blocks {
            let packed = word(3 + block);
            let before = plain.len();
            ZlibDecoder::new(&column.bytes[at..at + packed])
                .read_to_end(&mut plain)
                .unwrap();
            at += packed;
            let full = block + 1 < blocks || last == 0;
            assert_eq!(plain.len() - before, if full { size } else { last });
        }
        assert_eq!(at, column.bytes.len());
        plain
    }

    #[test]
    fn numbers_are_decompressed_unchanged() {
        for count in [0, 1, 5, BLOCK / 8, BLOCK / 8 + 1, BLOCK / 3] {
            let numbers = (0..count).map(|i| (i as f64 * 0.1).sin());
            let expected: Vec<u8> = numbers.clone().flat_map(f64::to_le_bytes).collect();
            assert_eq!(decompressed(&Column::new(numbers)), expected, "{count}");
        }
        assert_eq!(decompressed(&Column::new([7_u8, 9].into_iter())), [7, 9]);
        assert_eq!(Column::new([0_i64; 0].into_iter()).number, "Int64");
    }
}
