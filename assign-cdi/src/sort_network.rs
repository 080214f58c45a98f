//! Sorting networks as WESL. Every exchange is written out, so keys stay in registers.

use std::fmt::Write;

/// A module with a function `sort_N(list: Range)` for each width N, a power of two. It is Batcher's odd-even merge sort,
/// which takes 19, 63 and 191 exchanges for 8, 16 and 32 keys.
pub(crate) fn module(widths: &[u32]) -> String {
    let mut wesl = "// Sorts a list of up to N keys in registers.\n\
                    import package::sort_keys::{Range, load, store};\n"
        .to_owned();
    // Writing to a string does not fail.
    let mut line = |text: std::fmt::Arguments<'_>| wesl.write_fmt(text).unwrap_or(());
    for &width in widths {
        line(format_args!("\nfn sort_{width}(list: Range) {{\n"));
        for key in 0..width {
            line(format_args!("  var k{key} = load(list, {key}u);\n"));
        }
        for (low, high) in exchanges(width) {
            line(format_args!(
                "  {{ let k = min(k{low}, k{high}); k{high} = max(k{low}, k{high}); k{low} = k; }}\n"
            ));
        }
        for key in 0..width {
            line(format_args!("  store(list, {key}u, k{key});\n"));
        }
        line(format_args!("}}\n"));
    }
    wesl
}

/// Pairs of places in the order in which their keys are compared and exchanged (Batcher 1968).
fn exchanges(width: u32) -> Vec<(u32, u32)> {
    let mut pairs = Vec::new();
    let powers = |end: u32| (0..end.ilog2()).map(|log2| 1 << log2);
    for run in powers(width) {
        for span in powers(2 * run).rev() {
            for start in (span % run..width.saturating_sub(span)).step_by(2 * span as usize) {
                let places = start..(start + span).min(width - span);
                let in_one_merge = |low: &u32| low / (2 * run) == (low + span) / (2 * run);
                pairs.extend(places.filter(in_one_merge).map(|low| (low, low + span)));
            }
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn networks_sort() {
        for (width, count) in [(2, 1), (8, 19), (16, 63), (32, 191)] {
            let pairs = exchanges(width);
            assert_eq!(pairs.len(), count, "exchanges of width {width}");
            // A network that sorts every sequence of zeros and ones sorts every sequence. A width of 32 has too
            // many of those, so pseudo-random ones stand for them.
            let sequences = (0..1_u64 << width.min(16)).map(|bits| {
                if width <= 16 { bits } else { bits.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32 }
            });
            for bits in sequences {
                let mut keys: Vec<u64> = (0..width).map(|i| bits >> i & 1).collect();
                for &(low, high) in &pairs {
                    if keys[low as usize] > keys[high as usize] {
                        keys.swap(low as usize, high as usize);
                    }
                }
                assert!(keys.is_sorted(), "width {width}, keys {bits:b}");
            }
        }
    }
}
