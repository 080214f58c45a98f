//! Checks the promises on the CPU: pairs in f64, lists and counters exactly.

use std::collections::HashSet;

use glam::DVec3;

use super::{
    reaching::{LightBits, Reaching},
    rig::Probe,
    seen::{Seen, UNWRITTEN},
    violation::{Breach, Findings, Place, SamplePlace},
};
use crate::{ALL_LIGHTS, ENTRY_DIFFUSE, ENTRY_LIGHT, ENTRY_SPECULAR, Light, LightList};

/// Counts of (light, sample) pairs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pairs {
    /// Pairs that had to be listed.
    pub(super) reaching: u64,
    /// Pairs that were listed.
    pub(super) listed: u64,
}

/// Checks the lists that samples look up. With `complete` it checks every record and the exact
/// counters; set it only if no earlier frame left records behind.
pub(super) fn lists(seen: &Seen, complete: bool, findings: &mut Findings) {
    if let Some(read) = &seen.per_sample {
        lists(read, complete, findings);
    }
    record_0(seen, findings);
    let mut looked_up: Vec<u32> = seen.probes.iter().map(|p| p.group).collect();
    looked_up.sort_unstable();
    looked_up.dedup();
    for probe in &seen.probes {
        look_up(seen, probe, findings);
    }
    if complete {
        // A sparse strategy may skip groups that no sample looks up.
        let written = |g: &u32| seen.list(*g) != Some(UNWRITTEN);
        let all: Vec<u32> = (0..seen.group_count).filter(written).collect();
        all.iter().for_each(|&g| list(seen, g, findings));
        counters(seen, &all, true, findings);
    } else {
        looked_up.iter().for_each(|&g| list(seen, g, findings));
        looked_up.retain(|&g| g != ALL_LIGHTS);
        counters(seen, &looked_up, false, findings);
    }
    list(seen, ALL_LIGHTS, findings);
}

fn record_0(seen: &Seen, findings: &mut Findings) {
    let wanted = LightList { first: 0, count: seen.light_count };
    let found = seen.list(ALL_LIGHTS);
    if found != Some(wanted) {
        let detail = format!("it is {found:?}: it must be {wanted:?}");
        findings.add(Breach::Record0, Place::default(), detail);
        return;
    }
    let both = ENTRY_DIFFUSE | ENTRY_SPECULAR;
    let wrong = |(ix, entry): &(usize, &u32)| **entry != *ix as u32 | both;
    if let Some((ix, entry)) = seen.entries(ALL_LIGHTS).iter().enumerate().find(wrong) {
        let detail = format!("entry {ix} is {entry:#010x}");
        findings.add(Breach::Record0, Place::default(), detail);
    }
}

fn look_up(seen: &Seen, probe: &Probe, findings: &mut Findings) {
    let place = Place { group: Some(probe.group), light: None, sample: Some(sample_place(probe)) };
    match seen.list(probe.group) {
        None => {
            let detail = format!("there are {} groups", seen.group_count);
            findings.add(Breach::NoSuchGroup, place, detail);
        }
        Some(UNWRITTEN) => {
            let detail = "the sample's group has no list".into();
            findings.add(Breach::Unwritten, place, detail);
        }
        Some(list) if list.count != probe.count => {
            let detail = format!(
                "the look-up's list has {} entries, but the record says {}",
                probe.count, list.count
            );
            findings.add(Breach::Lookup, place, detail);
        }
        // Only the look-up knows what the sample reads.
        Some(_) if seen.per_sample.is_some() => {}
        Some(_) => {
            let entries = seen.entries(probe.group);
            let held = &entries[..entries.len().min(MOST_READ)];
            if (probe.read as usize, probe.hash) != (held.len(), hash_of(held)) {
                let detail = format!(
                    "the look-up returned {} entries, and these are not the first {} of the list",
                    probe.read,
                    held.len()
                );
                findings.add(Breach::Lookup, place, detail);
            }
        }
    }
}

/// The most entries that the probe reads: `MOST_READ` of `probe.wesl`.
const MOST_READ: usize = 16_384;

/// A number that tells which entries there are, and in which order.
fn hash_of(entries: &[u32]) -> u32 {
    entries.iter().fold(0, |hash: u32, entry| hash.wrapping_mul(31).wrapping_add(*entry))
}

/// Checks one list's entries.
fn list(seen: &Seen, group: u32, findings: &mut Findings) {
    let Some(list) = seen.list(group).filter(|l| *l != UNWRITTEN) else {
        return;
    };
    let mut place = Place { group: Some(group), ..Place::default() };
    let Some(entries) = seen.snapshot.entries_of(group) else {
        let held = seen.snapshot.entries.len();
        let detail =
            format!("the list is ({}, {}), but there are {held} entries", list.first, list.count);
        findings.add(Breach::OutsideBuffer, place, detail);
        return;
    };
    if Seen::fell_back(list) && group != ALL_LIGHTS && list.count >= seen.light_count {
        // The list shares the entries of record 0, which are checked once.
        return;
    }
    let mut before: Option<u32> = None;
    for (ix, entry) in entries.iter().enumerate() {
        let light = entry & ENTRY_LIGHT;
        place.light = Some(light);
        if light >= seen.light_count {
            let detail = format!("at entry {ix}: there are {} lights", seen.light_count);
            findings.add(Breach::ForeignLight, place, detail);
        }
        if entry & (ENTRY_DIFFUSE | ENTRY_SPECULAR) == 0 {
            findings.add(Breach::NoTerm, place, format!("at entry {ix}"));
        }
        match before {
            Some(before) if before == light => {
                findings.add(Breach::Repeated, place, format!("at entry {ix}"));
            }
            Some(before) if before > light => {
                let detail = format!("at entry {ix}, after light {before}");
                findings.add(Breach::NotAscending, place, detail);
            }
            _ => {}
        }
        before = Some(light);
    }
}

/// Checks the counters against the lists of `groups`, which are all groups if `complete`.
fn counters(seen: &Seen, groups: &[u32], complete: bool, findings: &mut Findings) {
    let counters = seen.snapshot.counters;
    let lists = || groups.iter().filter_map(|&g| seen.list(g));
    let all = lists().filter(|l| Seen::fell_back(*l)).count() as u64;
    // Groups without samples have all lights too, and only the counters tell which of them overflowed. What a sample
    // of the depth buffer reads did overflow.
    let mut read: Vec<u32> =
        seen.probes.iter().filter(|p| p.is_on_surface()).map(|p| p.group).collect();
    read.sort_unstable();
    read.dedup();
    let is_read = |group: &&u32| read.binary_search(group).is_ok();
    let read = groups.iter().filter(is_read).filter_map(|&g| seen.list(g));
    let least = read.filter(|l| Seen::fell_back(*l)).count() as u64;
    let overflowed = u64::from(counters.overflowed_groups).clamp(least, all);
    let fitting = || lists().filter(|l| !Seen::fell_back(*l) && *l != UNWRITTEN);
    let listed: u64 = fitting().map(|l| u64::from(l.count)).sum();
    let longest = fitting().map(|l| l.count).max().unwrap_or(0);
    let occupied = overflowed + fitting().filter(|l| l.count > 0).count() as u64;
    // If a group fell back, only the counters know how long its list would be.
    let whole = complete && overflowed == 0;
    let mut expect = |name, counted: u64, found: u64, exact| {
        if counted < found || (exact && counted != found) {
            let detail = format!("{name} is {counted}, but the lists hold {found}");
            findings.add(Breach::Counters, Place::default(), detail);
        }
    };
    expect("requested", counters.requested(), listed, whole);
    expect("longest", counters.longest.into(), longest.into(), whole);
    expect("occupied_groups", counters.occupied_groups.into(), occupied, complete);
    expect("overflowed_groups", counters.overflowed_groups.into(), overflowed, complete);
}

/// Checks that each sample's list holds every light that reaches the sample.
pub(super) fn pairs(seen: &Seen, lights: &[Light], findings: &mut Findings) -> Pairs {
    let seen = seen.read();
    let reaching = Reaching::find(findings.case, &seen.probes, lights, seen.knows_normals);
    let mut order: Vec<(&Probe, &LightBits)> =
        seen.probes.iter().zip(&reaching.by_sample).collect();
    // Sorted by group, so that neighbours share a list.
    order.sort_by_key(|(probe, _)| probe.group);
    let mut pairs = Pairs::default();
    let mut listed = LightBits::none(lights.len());
    for of_group in order.chunk_by(|(a, _), (b, _)| a.group == b.group) {
        let entries = seen.entries(of_group[0].0.group);
        listed.clear();
        for entry in entries {
            let (specular, diffuse) = (entry & ENTRY_SPECULAR > 0, entry & ENTRY_DIFFUSE > 0);
            listed.set(entry & ENTRY_LIGHT, specular, diffuse);
        }
        pairs.listed += (entries.len() * of_group.len()) as u64;
        for (probe, reaching) in of_group {
            pairs.reaching += reaching.count();
            missed(probe, reaching, &listed, lights, entries.len(), findings);
        }
    }
    pairs
}

/// Reports lights that reach a sample but are missing from its list, or lack a term's flag there.
fn missed(
    probe: &Probe,
    reaching: &LightBits,
    listed: &LightBits,
    lights: &[Light],
    entries: usize,
    findings: &mut Findings,
) {
    let missing = |needed: &[u32], listed: &[u32], word: usize| needed[word] & !listed[word];
    for word in 0..reaching.specular.len() {
        let specular = missing(&reaching.specular, &listed.specular, word);
        let diffuse = missing(&reaching.diffuse, &listed.diffuse, word);
        let mut left = specular | diffuse;
        while left > 0 {
            let bit = left & left.wrapping_neg();
            left ^= bit;
            let light_ix = 32 * word as u32 + bit.trailing_zeros();
            let place = Place {
                group: Some(probe.group),
                light: Some(light_ix),
                sample: Some(sample_place(probe)),
            };
            findings.add_with(Breach::MissedPair, place, || {
                let terms = match (specular & bit > 0, diffuse & bit > 0) {
                    (true, true) => "light",
                    (true, false) => "specular term",
                    _ => "diffuse term",
                };
                describe(&lights[light_ix as usize], probe, terms, entries)
            });
        }
    }
}

fn describe(light: &Light, probe: &Probe, terms: &str, listed: usize) -> String {
    let Light { position, range_m, .. } = light;
    let kind = light.kind();
    let reach = light.reach(DVec3::from_array(probe.position_world.map(f64::from)));
    format!(
        "{kind:?} light at {position} of range {range_m} m reaches the sample by {reach:.2e} of its support: the list of {listed} entries lacks the {terms}"
    )
}

/// Checks that two frames gave every sample the same entries. A difference is reported as `breach`.
pub(super) fn same(a: &Seen, b: &Seen, breach: Breach, findings: &mut Findings) {
    let (a, b) = (a.read(), b.read());
    let mut compared = HashSet::new();
    for (old, new) in a.probes.iter().zip(&b.probes) {
        if !compared.insert((old.group, new.group)) {
            continue;
        }
        let (before, now) = (a.entries(old.group), b.entries(new.group));
        if before == now {
            continue;
        }
        let differs = |(x, y): (&u32, &u32)| x != y;
        let first = before.iter().zip(now).position(differs);
        let place = Place { group: Some(new.group), light: None, sample: Some(sample_place(new)) };
        let detail = format!(
            "{} entries in the first frame, {} in the second, first difference at {}",
            before.len(),
            now.len(),
            first.unwrap_or(before.len().min(now.len()))
        );
        findings.add(breach, place, detail);
    }
    if a.probes.len() != b.probes.len() {
        let detail = format!(
            "{} samples in the first frame, {} in the second",
            a.probes.len(),
            b.probes.len()
        );
        findings.add(breach, Place::default(), detail);
    }
}

fn sample_place(probe: &Probe) -> SamplePlace {
    SamplePlace { pixel: probe.pixel, depth_m: probe.depth_view }
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use glam::Vec3;

    use super::*;
    use crate::{Counters, Emitter, LightShape, ListsSnapshot};

    /// One sample at `point`, with an empty list.
    fn empty_list_at(point: Vec3) -> Seen {
        let mut probe = Probe::zeroed();
        probe.position_world = point.to_array();
        Seen {
            snapshot: ListsSnapshot {
                lists: vec![LightList { first: 0, count: 1 }, LightList { first: 1, count: 0 }],
                entries: vec![ENTRY_DIFFUSE | ENTRY_SPECULAR],
                counters: Counters::default(),
            },
            probes: vec![probe],
            group_count: 1,
            light_count: 1,
            knows_normals: false,
            per_sample: None,
        }
    }

    /// Pairs that had to be listed, and pairs that were missed.
    fn asked(light: Light, point: Vec3) -> (u64, usize) {
        let mut findings = Findings::new("made up");
        let pairs = pairs(&empty_list_at(point), &[light], &mut findings);
        (pairs.reaching, findings.violations.len())
    }

    #[test]
    fn a_pair_counts_up_to_the_edge_of_every_kind_of_light() {
        let point = Light::point(Vec3::ZERO, 0.5, Vec3::ONE);
        let spot = LightShape::Spot { direction: Vec3::Z, inner_angle: 0.1, outer_angle: 0.5 };
        let vpl = Light::vpl(Vec3::ZERO, Vec3::Z, 0.5, Vec3::ONE);
        // The emitters are 4 m large and their range is half a metre, so most lit points are
        // farther than the range from the centre.
        let rectangle = Emitter::rectangle(2.0 * Vec3::X, 2.0 * Vec3::Y);
        let rectangle = Light::area(rectangle, Vec3::ZERO, 0.5, Vec3::ONE);
        let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (0.0, 2.5), (-2.0, 2.0)];
        let (polygon, middle) =
            Emitter::polygon(&corners.map(|(x, y)| Vec3::new(x, y, 0.0))).unwrap();
        let polygon = Light::area(polygon, middle, 0.5, Vec3::ONE);
        let (cone_in, cone_out) = (0.4 * Vec3::new(0.47, 0.0, 0.87), Vec3::new(0.21, 0.0, 0.34));
        for (light, inside, outside) in [
            (point, 0.49 * Vec3::X, 0.51 * Vec3::X),
            (Light { shape: spot, ..point }, cone_in, cone_out),
            (vpl, Vec3::new(0.48, 0.0, 0.01), Vec3::new(0.48, 0.0, -0.01)),
            (rectangle, Vec3::new(2.3, 2.3, 0.2), Vec3::new(2.4, 2.4, 0.2)),
            (polygon, Vec3::new(2.3, -2.3, 0.2), Vec3::new(2.4, -2.4, 0.2)),
        ] {
            assert_eq!(asked(light, inside), (1, 1), "{light:?}");
            assert_eq!(asked(light, outside), (0, 0), "{light:?}");
        }
    }
}
