//! Compares sorts and prefix sums with those of the standard library.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{EncoderPasses, Gpu, conformance};
use assign_cdi::{ListSort, PrefixSum, SortInput, SortWork};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

fn upload(gpu: &Gpu, words: &[u32]) -> wgpu::Buffer {
    conformance::upload(gpu, "words", words).unwrap()
}

fn download(gpu: &Gpu, buffer: &wgpu::Buffer, count: usize) -> Vec<u32> {
    conformance::download(gpu, buffer, count).unwrap()
}

/// Lists of keys, one after the other.
struct Lists {
    offsets: Vec<u32>,
    keys: Vec<u32>,
}

impl Lists {
    fn random(rng: &mut Pcg64Mcg, lengths: &[u32], below: u32) -> Self {
        let mut offsets = vec![0];
        for length in lengths {
            offsets.push(offsets.last().unwrap() + length);
        }
        let keys = (0..*offsets.last().unwrap()).map(|_| rng.random_range(0..below)).collect();
        Self { offsets, keys }
    }

    fn sorted(&self) -> Vec<u32> {
        let mut keys = self.keys.clone();
        for ends in self.offsets.windows(2) {
            keys[ends[0] as usize..ends[1] as usize].sort_unstable();
        }
        keys
    }

    fn on_gpu(&self, gpu: &Gpu) -> Vec<u32> {
        let offsets = upload(gpu, &self.offsets);
        let entries = upload(gpu, &self.keys);
        let longest = self.offsets.windows(2).map(|ends| ends[1] - ends[0]).max().unwrap_or(0);
        let mut sort = ListSort::new(gpu).unwrap();
        let input = SortInput {
            offsets: &offsets,
            entries: &entries,
            list_count: self.offsets.len() as u32 - 1,
            entry_count: self.keys.len() as u32,
            longest,
        };
        sort.prepare(gpu, &input).unwrap();
        // The second run sorts sorted lists, and must clear the work list of the first.
        for _ in 0..2 {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            sort.record(&mut EncoderPasses { encoder: &mut encoder }, "sort");
            gpu.queue.submit([encoder.finish()]);
        }
        let work = gpu.read(sort.work(), size_of::<SortWork>() as u64).unwrap();
        let work: SortWork = bytemuck::pod_read_unaligned(&work);
        assert_eq!(work.longest, longest);
        download(gpu, &entries, self.keys.len())
    }
}

const LENGTHS: [u32; 22] = [
    0, 1, 2, 7, 8, 9, 15, 16, 17, 31, 32, 33, 64, 65, 0, 1000, 2047, 2048, 2049, 4097, 6144, 70_000,
];

#[test]
fn lists_of_all_lengths_are_sorted() {
    let gpu = Gpu::open(None).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(1);
    // Keys of all sizes, then keys with many repeats.
    for below in [u32::MAX, 50] {
        let lists = Lists::random(&mut rng, &LENGTHS, below);
        assert!(lists.on_gpu(&gpu) == lists.sorted(), "keys below {below}");
    }
}

#[test]
fn many_short_lists_are_sorted() {
    let gpu = Gpu::open(None).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(2);
    let lengths: Vec<u32> = (0..3000).map(|_| rng.random_range(0..60)).collect();
    let lists = Lists::random(&mut rng, &lengths, 1 << 20);
    assert!(lists.on_gpu(&gpu) == lists.sorted());
}

#[test]
fn lists_outside_the_entries_stay_unsorted() {
    let gpu = Gpu::open(None).unwrap();
    let keys: Vec<u32> = (0..100).rev().collect();
    let entries = upload(&gpu, &keys);
    // Inside; decreasing; beyond the last entry; decreasing; to the end of 32 bits; decreasing; empty.
    let offsets = upload(&gpu, &[20, 70, 65, 101, 0, u32::MAX, 100, 100]);
    let mut sort = ListSort::new(&gpu).unwrap();
    let input = SortInput {
        offsets: &offsets,
        entries: &entries,
        list_count: 7,
        entry_count: 100,
        longest: 100,
    };
    sort.prepare(&gpu, &input).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    sort.record(&mut EncoderPasses { encoder: &mut encoder }, "sort");
    gpu.queue.submit([encoder.finish()]);
    let mut sorted = keys;
    sorted[20..70].sort_unstable();
    assert_eq!(download(&gpu, &entries, 100), sorted);
}

#[test]
fn prefix_sums_are_exact_up_to_32_bits() {
    let gpu = Gpu::open(None).unwrap();
    let mut rng = Pcg64Mcg::seed_from_u64(5);
    let mut sum = PrefixSum::new(&gpu).unwrap();
    for (count, below) in [(0, 2), (1, 9), (2047, 9), (2048, 9), (100_000, 9), (5_000_000, 5000)] {
        let counts: Vec<u32> = (0..count).map(|_| rng.random_range(0..below)).collect();
        let (from, to) = (upload(&gpu, &counts), upload(&gpu, &vec![7; count + 1]));
        sum.prepare(&gpu, &from, count as u32, &to).unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        sum.record(&mut EncoderPasses { encoder: &mut encoder }, "scan");
        gpu.queue.submit([encoder.finish()]);
        let mut expected = vec![0_u32];
        for count in counts {
            // The sums of the last case exceed 32 bits.
            expected.push(expected.last().unwrap().saturating_add(count));
        }
        assert!(download(&gpu, &to, count + 1) == expected, "{count} values");
    }
}

#[test]
fn small_buffers_are_refused() {
    let gpu = Gpu::noop().unwrap();
    let mut sort = ListSort::new(&gpu).unwrap();
    let (offsets, entries) = (gpu.storage("o", 80).unwrap(), gpu.storage("e", 80).unwrap());
    let input = SortInput {
        offsets: &offsets,
        entries: &entries,
        list_count: 19,
        entry_count: 20,
        longest: 20,
    };
    sort.prepare(&gpu, &input).unwrap();
    let mut refused = |input| sort.prepare(&gpu, &input).unwrap_err().to_string();
    let message = refused(SortInput { list_count: 20, ..input });
    assert_eq!(message, "buffer of offsets of a sort is 80 bytes: it must be at least 84 bytes");
    let message = refused(SortInput { entry_count: 21, ..input });
    assert_eq!(message, "buffer of entries of a sort is 80 bytes: it must be at least 84 bytes");
    assert!(refused(SortInput { list_count: u32::MAX, ..input }).starts_with("a sort of 20"));
    assert!(refused(SortInput { entry_count: u32::MAX, ..input }).starts_with("a sort of 4294"));
    let mut sum = PrefixSum::new(&gpu).unwrap();
    let message = sum.prepare(&gpu, &entries, u32::MAX, &entries).unwrap_err().to_string();
    assert!(message.starts_with("number of values of a prefix sum is 4294967295"), "{message}");
}
