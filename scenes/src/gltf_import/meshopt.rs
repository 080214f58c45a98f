//! Decodes buffer views of EXT_meshopt_compression as its specification describes.
//!
//! - `ATTRIBUTES`: elements of a fixed stride. Each byte of an element is coded against the same
//!   byte of the element before it, sixteen elements at a time, in 0, 2, 4 or 8 bits each.
//! - `TRIANGLES`: indices, three at a time, from a queue of recent edges and a queue of recent
//!   vertices.
//! - `INDICES`: indices as differences to one of two earlier ones.
//!
//! A filter then turns integers of attributes into unit vectors, quaternions or floats. The decoder
//! is our own, because the Rust crate for this takes strides as types and asserts on bad input.

use gltf::json::Buffer;
use serde::Deserialize;

/// The two names of the extension. What only the second can describe is refused by its header.
pub(super) const NAMES: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Whether the bytes of a buffer are compressed in another one, so that it has none itself.
pub(super) fn is_fallback(buffer: &Buffer) -> bool {
    let extensions = buffer.extensions.as_ref().map(|e| &e.others);
    NAMES.iter().any(|name| {
        let fallback = extensions.and_then(|all| all.get(*name)?.get("fallback")?.as_bool());
        fallback == Some(true)
    })
}

/// The compressed form of one buffer view.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Compressed {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    byte_stride: usize,
    count: usize,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
}

/// The most bytes that one compressed byte can expand to: a byte of header describes four groups of
/// sixteen equal elements.
const MAX_RATIO: usize = 64;

/// What would be accepted instead of the compressed bytes: a phrase for errors.
type Fault = &'static str;

const CUT_SHORT: Fault = "compressed bytes that hold all elements";

impl Compressed {
    /// The number of bytes after decoding.
    pub(super) fn size(&self) -> u64 {
        (self.count as u64).saturating_mul(self.byte_stride as u64)
    }

    /// The bytes of the buffer view. If they cannot be decoded, what would be accepted.
    pub(super) fn decode(&self, source: &[u8]) -> Result<Vec<u8>, Fault> {
        let stride = self.byte_stride;
        let size = self.count.checked_mul(stride).ok_or("a count that memory can hold")?;
        if size > source.len().saturating_mul(MAX_RATIO) {
            return Err(CUT_SHORT);
        }
        let is_index = matches!(stride, 2 | 4);
        match self.mode {
            Mode::Attributes if stride == 0 || stride > 256 || !stride.is_multiple_of(4) => {
                Err("a byteStride that is a multiple of 4, at most 256")
            }
            Mode::Attributes => {
                let mut bytes = attributes(source, self.count, stride)?;
                self.filter.apply(&mut bytes, stride)?;
                Ok(bytes)
            }
            _ if !is_index => Err("a byteStride of 2 or 4, as indices have"),
            Mode::Triangles if !self.count.is_multiple_of(3) => Err("a count of whole triangles"),
            Mode::Triangles => Ok(index_bytes(triangles(source, self.count)?, stride)),
            Mode::Indices => Ok(index_bytes(indices(source, self.count)?, stride)),
        }
    }
}

fn index_bytes(indices: Vec<u32>, stride: usize) -> Vec<u8> {
    indices.into_iter().flat_map(|ix| ix.to_le_bytes().into_iter().take(stride)).collect()
}

/// Reads a source from its start. Reading past its end is a fault.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let (head, rest) = self.0.split_at_checked(count).ok_or(CUT_SHORT)?;
        self.0 = rest;
        Ok(head)
    }

    fn byte(&mut self) -> Result<u8, Fault> {
        Ok(self.take(1)?[0])
    }

    /// The first byte, which holds the format and its version.
    fn header(&mut self, wanted: u8) -> Result<(), Fault> {
        if self.byte()? == wanted {
            return Ok(());
        }
        Err("of the version that EXT_meshopt_compression has")
    }

    /// A little-endian base-128 number.
    fn number(&mut self) -> Result<u32, Fault> {
        let mut value = 0_u32;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7f).wrapping_shl(shift);
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err("numbers of at most five bytes")
    }

    /// Decodes the difference of an index.
    fn difference(&mut self) -> Result<u32, Fault> {
        self.number().map(unfold)
    }
}

/// Maps 0, 1, 2, 3, ... to 0, -1, 1, -2, ... in two's complement.
fn unfold(value: u32) -> u32 {
    (value >> 1) ^ (value & 1).wrapping_neg()
}

fn attributes(source: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, Fault> {
    let mut reader = Reader(source);
    reader.header(0xa0)?;
    // The end holds the element against which the first one is coded.
    let mut last = source[source.len().saturating_sub(stride)..].to_vec();
    if last.len() < stride || source.len() < stride + 1 {
        return Err(CUT_SHORT);
    }
    let mut bytes = vec![0; count * stride];
    // Blocks fill 8 KiB, in whole groups of 16.
    let per_block = ((0x2000 / stride) & !15).min(256);
    for first in (0..count).step_by(per_block) {
        let elements = per_block.min(count - first);
        let groups = elements.div_ceil(16);
        for (byte, last) in last.iter_mut().enumerate() {
            let modes = reader.take(groups.div_ceil(4))?;
            for group in 0..groups {
                let mode = (modes[group / 4] >> (2 * (group % 4))) & 3;
                let deltas = deltas(&mut reader, mode)?;
                let start = first + 16 * group;
                for (element, delta) in (start..first + elements).zip(deltas) {
                    let delta = (delta >> 1) ^ (delta & 1).wrapping_neg();
                    *last = last.wrapping_add(delta);
                    bytes[element * stride + byte] = *last;
                }
            }
        }
    }
    Ok(bytes)
}

/// The differences of one byte of sixteen elements. In 2 and 4 bits, a value of all ones means that
/// a whole byte follows.
fn deltas(reader: &mut Reader<'_>, mode: u8) -> Result<[u8; 16], Fault> {
    let mut deltas = [0; 16];
    match mode {
        0 => {}
        1 | 2 => {
            let bits = 2 * usize::from(mode);
            let per_byte = 8 / bits;
            let packed = reader.take(16 / per_byte)?;
            let ones = (1 << bits) - 1;
            for (ix, delta) in deltas.iter_mut().enumerate() {
                let shift = 8 - bits - bits * (ix % per_byte);
                let value = (packed[ix / per_byte] >> shift) & ones;
                *delta = if value == ones { reader.byte()? } else { value };
            }
        }
        _ => deltas.copy_from_slice(reader.take(16)?),
    }
    Ok(deltas)
}

/// The last sixteen values pushed. Index 0 is the latest.
struct Queue<T> {
    items: [T; 16],
    next: usize,
}

impl<T: Copy> Queue<T> {
    fn new(item: T) -> Self {
        Self { items: [item; 16], next: 0 }
    }

    fn push(&mut self, item: T) {
        self.items[self.next % 16] = item;
        self.next += 1;
    }

    fn get(&self, age: u8) -> T {
        self.items[(self.next + 31 - usize::from(age)) % 16]
    }
}

fn triangles(source: &[u8], count: usize) -> Result<Vec<u32>, Fault> {
    let mut reader = Reader(source);
    reader.header(0xe1)?;
    let codes = reader.take(count / 3)?;
    let table_at = reader.0.len().checked_sub(16).ok_or(CUT_SHORT)?;
    let table = &reader.0[table_at..];
    let mut edges = Queue::new([0_u32; 2]);
    let mut vertices = Queue::new(0_u32);
    let (mut next, mut last) = (0_u32, 0_u32);
    let mut found = Vec::with_capacity(count);
    // Returns the next new vertex.
    let new = |next: &mut u32| {
        let vertex = *next;
        *next = next.wrapping_add(1);
        vertex
    };
    for code in codes {
        let (high, low) = (code >> 4, code & 15);
        if high < 15 {
            let [a, b] = edges.get(high);
            let c = match low {
                0 => new(&mut next),
                13 => last.wrapping_sub(1),
                14 => last.wrapping_add(1),
                15 => last.wrapping_add(reader.difference()?),
                _ => vertices.get(low),
            };
            if low >= 13 {
                last = c;
            }
            if low == 0 || low >= 13 {
                vertices.push(c);
            }
            edges.push([c, b]);
            edges.push([a, c]);
            found.extend([a, b, c]);
            continue;
        }
        let (ways, is_explicit) =
            if low < 14 { (table[usize::from(low)], false) } else { (reader.byte()?, true) };
        if is_explicit && ways == 0 {
            next = 0;
        }
        let mut corners = [0; 3];
        let mut is_new = [true; 3];
        let kinds = [if low == 15 { 15 } else { 0 }, ways >> 4, ways & 15];
        for corner in 0..3 {
            let kind = kinds[corner];
            (corners[corner], is_new[corner]) = match kind {
                0 => (new(&mut next), true),
                15 if is_explicit => (0, true),
                _ => (vertices.get(kind - 1), false),
            };
        }
        for corner in (0..3).filter(|corner| is_explicit && kinds[*corner] == 15) {
            last = last.wrapping_add(reader.difference()?);
            corners[corner] = last;
        }
        for corner in (0..3).filter(|corner| is_new[*corner]) {
            vertices.push(corners[corner]);
        }
        let [a, b, c] = corners;
        edges.push([b, a]);
        edges.push([c, b]);
        edges.push([a, c]);
        found.extend(corners);
    }
    Ok(found)
}

fn indices(source: &[u8], count: usize) -> Result<Vec<u32>, Fault> {
    let mut reader = Reader(source);
    reader.header(0xd1)?;
    let mut last = [0_u32; 2];
    let mut next = || {
        let number = reader.number()?;
        let last = &mut last[(number & 1) as usize];
        *last = last.wrapping_add(unfold(number >> 1));
        Ok(*last)
    };
    (0..count).map(|_| next()).collect()
}

impl Filter {
    fn apply(self, bytes: &mut [u8], stride: usize) -> Result<(), Fault> {
        match (self, stride) {
            (Self::None, _) => {}
            (Self::Octahedral, 4) => bytes.as_chunks_mut::<4>().0.iter_mut().for_each(|v| {
                *v = octahedral(v.map(|b| f32::from(b as i8)), 127.0).map(|x| x as i8 as u8);
            }),
            (Self::Octahedral, 8) => shorts(bytes, |v| octahedral(v, 32767.0)),
            (Self::Octahedral, _) => return Err("a byteStride of 4 or 8 under OCTAHEDRAL"),
            (Self::Quaternion, 8) => shorts(bytes, quaternion),
            (Self::Quaternion, _) => return Err("a byteStride of 8 under QUATERNION"),
            (Self::Exponential, _) => bytes.as_chunks_mut::<4>().0.iter_mut().for_each(|bytes| {
                let value = i32::from_le_bytes(*bytes);
                let mantissa = f64::from(value << 8 >> 8);
                let float = (mantissa * f64::from(value >> 24).exp2()) as f32;
                *bytes = float.to_le_bytes();
            }),
        }
        Ok(())
    }
}

/// Maps each four signed 16-bit numbers.
fn shorts(bytes: &mut [u8], map: impl Fn([f32; 4]) -> [f32; 4]) {
    for chunk in bytes.as_chunks_mut::<8>().0 {
        let read = |ix: usize| f32::from(i16::from_le_bytes([chunk[2 * ix], chunk[2 * ix + 1]]));
        let mapped = map([read(0), read(1), read(2), read(3)]);
        for (pair, value) in chunk.as_chunks_mut::<2>().0.iter_mut().zip(mapped) {
            *pair = (value as i16).to_le_bytes();
        }
    }
}

/// A unit vector from a point of an octahedron. The third number is 1 in the scale of the input;
/// the fourth number is kept.
fn octahedral([x, y, one, w]: [f32; 4], max: f32) -> [f32; 4] {
    let one = if one == 0.0 { 1.0 } else { one };
    let (x, y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    let (x, y) = (x - fold.copysign(x), y - fold.copysign(y));
    let scale = max / (x * x + y * y + z * z).sqrt();
    [(x * scale).round(), (y * scale).round(), (z * scale).round(), w]
}

/// A quaternion from three components, without the largest. The fourth number says which one is
/// missing, and the scale of the others.
fn quaternion([x, y, z, w]: [f32; 4]) -> [f32; 4] {
    let code = w as i16;
    let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(code | 3);
    let [x, y, z] = [x, y, z].map(|v| v * scale);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let largest = usize::from(code as u16 & 3);
    let mut turned = [0.0; 4];
    for (step, value) in [w, x, y, z].into_iter().enumerate() {
        turned[(largest + step) % 4] = (value * 32767.0).round();
    }
    turned
}
