//! An array of numbers as it stands in a file.

use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;
use std::io::Write;

/// Bytes of a block before it is compressed: readers unpack one at a time.
const BLOCK: usize = 1 << 20;

/// A number as VTK stores it.
pub trait Number: Copy + Send + Sync {
    /// What VTK calls it.
    const NAME: &'static str;
    /// Its bytes, the lowest first, behind others.
    fn store(self, bytes: &mut Vec<u8>);
}

macro_rules! number {
    ($number:ty, $name:literal) => {
        impl Number for $number {
            const NAME: &'static str = $name;
            fn store(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
        }
    };
}

number!(f32, "Float32");
number!(f64, "Float64");
number!(i64, "Int64");
number!(u8, "UInt8");

/// Numbers, compressed, with what a reader must know to unpack them.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What VTK calls the numbers.
    pub number: &'static str,
    /// The bytes that stand in the file.
    pub bytes: Vec<u8>,
}

impl Column {
    /// Packs numbers.
    pub fn of<N: Number>(numbers: impl Iterator<Item = N>) -> Self {
        let mut plain = vec![];
        for number in numbers {
            number.store(&mut plain);
        }
        let blocks: Vec<&[u8]> = plain.chunks(BLOCK).collect();
        let packed: Vec<Vec<u8>> = blocks.par_iter().map(|block| pack(block)).collect();
        // How many blocks, how large, how large the last is if it is smaller, and how large each is packed.
        let last = plain.len() % BLOCK;
        let head = [blocks.len(), BLOCK, last];
        let sizes = head.into_iter().chain(packed.iter().map(Vec::len));
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

fn pack(block: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(vec![], Compression::fast());
    // What is written to grows in memory, which does not fail.
    let _ = encoder.write_all(block);
    encoder.finish().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use flate2::read::ZlibDecoder;
    use std::io::Read;

    /// Unpacks as a reader would.
    fn unpacked(column: &Column) -> Vec<u8> {
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
    fn numbers_come_back() {
        for count in [0, 1, 5, BLOCK / 8, BLOCK / 8 + 1, BLOCK / 3] {
            let numbers = (0..count).map(|i| (i as f64 * 0.1).sin());
            let expected: Vec<u8> = numbers.clone().flat_map(f64::to_le_bytes).collect();
            assert_eq!(unpacked(&Column::of(numbers)), expected, "{count}");
        }
        assert_eq!(unpacked(&Column::of([7_u8, 9].into_iter())), [7, 9]);
        assert_eq!(Column::of([0_i64; 0].into_iter()).number, "Int64");
    }
}
