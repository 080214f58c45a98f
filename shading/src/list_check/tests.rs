//! Lists of known samples, and of pairs that are looped over.

use assign::{Counters, ENTRY_DIFFUSE, ENTRY_SPECULAR, Light, LightList};
use glam::Vec3;

use super::*;

fn lights(count: u32) -> Vec<Light> {
    (0..count).map(|i| Light::point(Vec3::new(i as f32, 0.0, 0.0), 1.5, Vec3::ONE)).collect()
}

fn samples() -> Samples {
    Samples {
        positions: vec![[0.0, 0.0, 0.0], [5.2, 0.0, 0.0], [50.0, 0.0, 0.0]],
        normals: vec![[0.0, 1.0, 0.0]; 3],
        groups: vec![1, 0, 0],
        pixels: vec![0, 1, 2],
    }
}

fn snapshot(lists: &[&[u32]]) -> ListsSnapshot {
    let mut snapshot = ListsSnapshot {
        lists: vec![LightList::default()],
        entries: Vec::new(),
        counters: Counters::default(),
    };
    for list in lists {
        snapshot
            .lists
            .push(LightList { first: snapshot.entries.len() as u32, count: list.len() as u32 });
        let both = ENTRY_DIFFUSE | ENTRY_SPECULAR;
        snapshot.entries.extend(list.iter().map(|light| light | both));
    }
    snapshot
}

#[test]
fn counts_agree_with_a_hand_count() {
    let lights = lights(10);
    let bvh = LightBvh::new(&lights);
    // Lights 0 and 1 reach sample 0; lights 4, 5 and 6 reach sample 1; none reaches sample 2.
    let truth = bvh.check(&samples(), &snapshot(&[&[3, 4, 5, 6], &[0, 1]]), false);
    let listed = 4 + 4 + 2;
    let expected = ListsTruth { samples: 3, contributing: 5, listed, ..ListsTruth::default() };
    assert_eq!(truth, expected);
}

#[test]
fn a_light_left_out_is_missed() {
    let lights = lights(10);
    let bvh = LightBvh::new(&lights);
    let truth = bvh.check(&samples(), &snapshot(&[&[4, 6], &[0, 1]]), false);
    assert_eq!(truth.missed, 1);
    assert_eq!(truth.first_missed, Some(MissedPair { pixel: 1, light: Some(5) }));
    // Of several pairs, the first by pixel and then by light.
    let truth = bvh.check(&samples(), &snapshot(&[&[4, 6], &[]]), false);
    assert_eq!(truth.missed, 3);
    assert_eq!(truth.first_missed, Some(MissedPair { pixel: 0, light: Some(0) }));
}

#[test]
fn a_light_without_the_flag_of_a_term_is_missed() {
    let lights = lights(10);
    let bvh = LightBvh::new(&lights);
    let mut lists = snapshot(&[&[4, 5, 6], &[0, 1]]);
    lists.entries[1] = 5 | ENTRY_SPECULAR;
    assert_eq!(bvh.check(&samples(), &lists, false).missed, 1);
}

#[test]
fn strategies_that_know_normals_miss_nothing_below_the_horizon() {
    let lights = lights(10);
    let bvh = LightBvh::new(&lights);
    let none = snapshot(&[&[], &[]]);
    // Seen from 5.2 along x, lights 4 and 5 lie behind and light 6 in front.
    let mut samples = samples();
    samples.normals[1] = [1.0, 0.0, 0.0];
    assert_eq!(bvh.check(&samples, &none, false).missed, 5);
    assert_eq!(bvh.check(&samples, &none, true).missed, 1);
}

#[test]
fn a_sample_without_a_position_is_missed() {
    let lights = lights(10);
    let mut samples = samples();
    samples.positions[2] = [f32::NAN, 0.0, 0.0];
    let truth = LightBvh::new(&lights).check(&samples, &snapshot(&[&[3, 4, 5, 6], &[0, 1]]), false);
    assert_eq!(truth.missed, 1);
    assert_eq!(truth.first_missed, Some(MissedPair { pixel: 2, light: None }));
}

/// What each pair of a sample and a light says, one after the other.
fn pair_by_pair(
    lights: &[Light],
    samples: &Samples,
    lists: &ListsSnapshot,
    knows_normals: bool,
) -> ListsTruth {
    let mut truth = ListsTruth::default();
    for sample in 0..samples.groups.len() {
        let entries = lists.entries_of(samples.groups[sample]).unwrap_or_default();
        truth.samples += 1;
        truth.listed += entries.len() as u64;
        let [point, normal] =
            [&samples.positions, &samples.normals].map(|of| DVec3::from(of[sample].map(f64::from)));
        for (ix, light) in (0..).zip(lights) {
            let entry = entries.iter().find(|&&entry| entry & ENTRY_LIGHT == ix);
            let terms = entry.map_or(0, |entry| entry & !ENTRY_LIGHT);
            truth.contributing += u64::from(light.reach(point) > 0.0);
            if is_missed(light, terms, point, knows_normals.then_some(normal)) {
                truth.miss(MissedPair { pixel: samples.pixels[sample], light: Some(ix) });
            }
        }
    }
    truth
}

/// 300 samples in a row in 40 groups, whose lists lack some lights and some terms.
fn many(seed: u32) -> (Samples, ListsSnapshot) {
    let random = |ix: u32| ix.wrapping_mul(2_654_435_761).wrapping_add(seed * 97) >> 16;
    let ixs = || 0..300_u32;
    let samples = Samples {
        positions: ixs().map(|ix| [ix as f32 * 0.1, 0.3, (random(ix) % 9) as f32 * 0.1]).collect(),
        normals: ixs()
            .map(|ix| if random(ix) % 3 == 0 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] })
            .collect(),
        groups: ixs().map(|ix| random(ix) % 40).collect(),
        pixels: ixs().map(|ix| 3 * ix).collect(),
    };
    let of_group = |group: u32| -> Vec<u32> {
        (0..30).filter(|light| random(light * 41 + group) % 5 != 0).collect()
    };
    let lists: Vec<Vec<u32>> = (0..40).map(of_group).collect();
    let lists: Vec<&[u32]> = lists.iter().map(Vec::as_slice).collect();
    let mut lists = snapshot(&lists);
    for (ix, entry) in (0..).zip(&mut lists.entries) {
        if random(ix) % 11 == 0 {
            *entry &= !ENTRY_DIFFUSE;
        }
    }
    (samples, lists)
}

#[test]
fn blocks_say_what_pairs_say_also_of_samples_that_were_seen_before() {
    let lights = lights(30);
    let bvh = LightBvh::new(&lights);
    let mut check = ListCheck::new(&bvh);
    for (seed, knows_normals) in [(1, false), (2, true), (3, false)] {
        let (samples, lists) = many(seed);
        let expected = pair_by_pair(&lights, &samples, &lists, knows_normals);
        assert!(expected.missed > 20, "{expected:?}");
        for _ in 0..2 {
            assert_eq!(check.check(&samples, &lists, knows_normals), expected);
        }
        // Every third of them, from the middle on.
        let some = |ix: &usize| *ix > 100 && ix.is_multiple_of(3);
        let ixs: Vec<usize> = (0..300).filter(some).collect();
        let part = Samples {
            positions: ixs.iter().map(|&ix| samples.positions[ix]).collect(),
            normals: ixs.iter().map(|&ix| samples.normals[ix]).collect(),
            groups: ixs.iter().map(|&ix| samples.groups[ix]).collect(),
            pixels: ixs.iter().map(|&ix| samples.pixels[ix]).collect(),
        };
        let sets = check.known.len();
        let expected = pair_by_pair(&lights, &part, &lists, knows_normals);
        assert_eq!(check.check(&part, &lists, knows_normals), expected);
        assert_eq!(check.known.len(), sets, "found among the known samples");
    }
}

#[test]
fn a_sample_that_moved_is_not_the_known_one() {
    let lights = lights(30);
    let bvh = LightBvh::new(&lights);
    let mut check = ListCheck::new(&bvh);
    let (mut samples, lists) = many(1);
    check.check(&samples, &lists, false);
    samples.positions[200][0] += 3.0;
    let expected = pair_by_pair(&lights, &samples, &lists, false);
    assert_eq!(check.check(&samples, &lists, false), expected);
}
