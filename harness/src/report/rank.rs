//! Ranks the records of a comparison by what their rounds show.
//!
//! Every round draws frames of all strategies in turn, so drift hits all of them alike, and the ratio of two
//! strategies' times *in one round* is free of it. Along a path a round is a lap, and its time is the mean
//! over the poses. Two records tie if the interval of the median ratio contains 1, or if the median ratio is
//! within half a per cent of 1. Two to five rounds always tie.

use super::format::significant;
use crate::results::{Record, median, median_interval};

/// A ratio closer to 1 than this is a tie, however sure it is.
pub(crate) const ALIKE: f64 = 0.005;

/// The least coverage of an interval that shows a difference: six rounds reach it.
pub(crate) const SURE: f64 = 0.95;

/// The times of one record over those of another, paired by round.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ratio {
    /// The median over rounds.
    pub(crate) median: f64,
    /// The lower end of the interval of the median.
    pub(crate) low: f64,
    /// The upper end of the interval of the median.
    pub(crate) high: f64,
    /// The probability that the interval contains the median.
    pub(crate) coverage: f64,
}

impl Ratio {
    /// The times of `record` over those of `other`. `None` where they have fewer than two rounds in common.
    /// Along a path a round is a lap, so both need at least two laps, with equally many poses.
    pub(crate) fn between(record: &Record, other: &Record) -> Option<Self> {
        let laps =
            |record: &Record| (record.setting.along_path, record.laps(), record.times.frames);
        let differ = if record.setting.along_path || other.setting.along_path {
            laps(record) != laps(other)
        } else {
            record.times.rounds != other.times.rounds
        };
        if differ {
            return None;
        }
        let (times, others) = (record.round_times_ms(), other.round_times_ms());
        let ratios = times.iter().zip(&others).map(|(time, other)| time / other);
        let ratios: Vec<f64> = ratios.filter(|ratio| ratio.is_finite()).collect();
        let interval = median_interval(&ratios)?;
        let (low, high, coverage) = (interval.low, interval.high, interval.coverage);
        Some(Self { median: median(&ratios), low, high, coverage })
    }

    /// Whether the record is faster than the other, beyond chance.
    pub(crate) fn is_faster(&self) -> bool {
        self.median < 1.0 && !self.is_tie()
    }

    /// Whether the two tie.
    pub(crate) fn is_tie(&self) -> bool {
        // The range of a few rounds excludes 1 by chance.
        let is_sure = self.coverage >= SURE;
        !is_sure || (self.low..=self.high).contains(&1.0) || (self.median - 1.0).abs() <= ALIKE
    }
}

/// Whether two records tie. `None` where they were not timed in the same rounds.
pub fn indistinguishable(record: &Record, other: &Record) -> Option<bool> {
    Ratio::between(record, other).map(|ratio| ratio.is_tie())
}

/// Whether a record is faster than another, beyond chance. `None` where they were not timed in the same
/// rounds.
pub fn is_surely_faster(record: &Record, other: &Record) -> Option<bool> {
    Ratio::between(record, other).map(|ratio| ratio.is_faster())
}

/// A record with its rank.
pub(crate) struct Ranked<'a> {
    /// The record.
    pub(crate) record: &'a Record,
    /// 1 for the fastest and for all records that tie with it.
    pub(crate) rank: u32,
}

/// Whether a time was recorded. A record without passes adds up to 0 ms, which no frame takes.
pub(crate) fn is_timed(record: &Record) -> bool {
    let ms = record.assign_and_shade_ms();
    ms.is_finite() && (ms > 0.0 || record.times.passes.iter().next().is_some())
}

/// Whether a record may be called the best: it culls, and it shows no loss.
pub(crate) fn competes(record: &Record) -> bool {
    record.culls() && record.is_exact()
}

/// Ranks the records that cull without a loss, by assign + shade. The fastest leads the first rank, and all
/// that tie with it share that rank. The fastest of the others leads the next. Where there are no rounds to
/// pair, only the time decides.
pub(crate) fn ranks<'a>(records: impl IntoIterator<Item = &'a Record>) -> Vec<Ranked<'a>> {
    let mut left: Vec<&Record> =
        records.into_iter().filter(|record| competes(record) && is_timed(record)).collect();
    left.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
    let mut ranked = Vec::new();
    for rank in 1.. {
        let Some(&leader) = left.first() else { break };
        let shares = |record: &Record| {
            std::ptr::eq(record, leader)
                || Ratio::between(record, leader).is_some_and(|ratio| ratio.is_tie())
        };
        let (same, others) = left.into_iter().partition::<Vec<&Record>, _>(|r| shares(r));
        ranked.extend(same.into_iter().map(|record| Ranked { record, rank }));
        left = others;
    }
    ranked
}

/// Those that share the first rank, fastest first.
pub(crate) fn first<'a>(ranked: &[Ranked<'a>]) -> Vec<&'a Record> {
    ranked.iter().filter(|ranked| ranked.rank == 1).map(|ranked| ranked.record).collect()
}

/// States a tie for the first rank, `A and B tie: ...`, or that there are too few laps to test ties. `None`
/// where neither holds.
pub(crate) fn tie(ranked: &[Ranked<'_>]) -> Option<String> {
    let first = first(ranked);
    let (leader, others) = first.split_first()?;
    if leader.setting.along_path && leader.laps() < 2 && ranked.len() > 1 {
        return Some(
            "one lap does not show the noise, so ranks use means only; use --laps 6 to test ties"
                .to_owned(),
        );
    }
    let widest = others
        .iter()
        .filter_map(|record| Ratio::between(record, leader))
        .reduce(|a, b| if b.high - b.low > a.high - a.low { b } else { a })?;
    let names = few_listed(first.iter().map(|record| record.strategy.to_string()).collect());
    if widest.coverage < SURE {
        let (rounds, option) =
            if leader.setting.along_path { ("laps", "--laps") } else { ("rounds", "--frames") };
        return Some(format!(
            "{} {rounds} are too few to test ties, so {names} share rank 1; use {option} 6",
            leader.round_times_ms().len(),
        ));
    }
    let times =
        few_listed(first.iter().map(|record| significant(record.assign_and_shade_ms())).collect());
    let interval = match others.len() {
        1 => "the interval of their ratio, round by round, is".to_owned(),
        _ => {
            format!("the widest interval of a ratio to {}, round by round, is", leader.strategy)
        }
    };
    Some(format!(
        "{names} tie: {times} ms, and {interval} {} to {} (coverage {} %)",
        significant(widest.low),
        significant(widest.high),
        significant(widest.coverage * 100.0),
    ))
}

/// The most items of a short list. Of more, [`NAMED`] are named and the others counted.
const ALL_NAMED: usize = 4;
/// The items before `and 5 others`.
const NAMED: usize = 3;

/// `A`, `A and B`, `A, B, C and 5 others`.
pub(crate) fn few_listed(mut items: Vec<String>) -> String {
    if items.len() > ALL_NAMED {
        let others = items.len() - NAMED;
        items.truncate(NAMED);
        items.push(format!("{others} others"));
    }
    listed(&items)
}

/// `a`, `a and b`, `a, b and c`.
pub fn listed<T: AsRef<str>>(words: &[T]) -> String {
    match words {
        [] => String::new(),
        [one] => one.as_ref().to_owned(),
        [first @ .., last] => {
            let first: Vec<&str> = first.iter().map(AsRef::as_ref).collect();
            format!("{} and {}", first.join(", "), last.as_ref())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{PassKind, PassTimes, Results};

    /// A record with these times to shade, one a round.
    fn record(strategy: &str, times_ms: &[f64]) -> Record {
        let example: Results =
            serde_json::from_str(include_str!("../results/example.json")).expect("the example");
        let mut record = example.records[0].clone();
        record.strategy = strategy.into();
        record.times.passes = Default::default();
        record.times.passes.insert("shade", PassTimes::new(PassKind::Shade, times_ms.to_vec()));
        record.times.frames = times_ms.len() as u32;
        record.times.rounds = record.times.frames;
        record.setting.along_path = false;
        (record.lists.missed_pairs, record.image.max_abs_diff, record.image.differing_channels) =
            (Some(0), Some(0.0), Some(0));
        record.set_times();
        record
    }

    /// Uniform from -0.5 to 0.5.
    fn noise(seed: u64) -> impl Fn(u32) -> f64 {
        move |round| {
            let mut state = seed * 1_000 + u64::from(round);
            for _ in 0..3 {
                state =
                    (state ^ (state >> 29)).wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            }
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        }
    }

    fn timed(strategy: &str, time: impl Fn(u32) -> f64) -> Record {
        record(strategy, &(0..16).map(time).collect::<Vec<_>>())
    }

    fn places(records: &[Record]) -> Vec<(String, u32)> {
        ranks(records).iter().map(|r| (r.record.strategy.to_string(), r.rank)).collect()
    }

    fn place(name: &str, rank: u32) -> (String, u32) {
        (name.to_owned(), rank)
    }

    #[test]
    fn shared_drift_cancels() {
        // 2 % apart, while the clock drifts by 50 %.
        let drift = |round: u32| 1.0 + f64::from(round) / 32.0;
        let (a, b) = (timed("A", |r| 10.0 * drift(r)), timed("B", |r| 10.2 * drift(r)));
        assert_eq!(places(&[b, a]), [place("A", 1), place("B", 2)]);
    }

    #[test]
    fn noise_hides_a_small_difference_and_not_a_large_one() {
        let (x, y) = (noise(1), noise(2));
        let a = timed("A", |r| 10.0 * (1.0 + 0.3 * x(r)));
        let b = timed("B", |r| 10.2 * (1.0 + 0.3 * y(r)));
        let c = timed("C", |r| 16.0 * (1.0 + 0.3 * y(r + 5)));
        let records = [a, b, c];
        let ranked = ranks(&records);
        let ranks: Vec<u32> = ranked.iter().map(|r| r.rank).collect();
        assert_eq!(ranks, [1, 1, 2], "{:?}", Ratio::between(&records[1], &records[0]));
        let text = tie(&ranked).expect("two share the first rank");
        assert!(text.contains(" and ") && text.contains(" tie: "), "{text}");
        assert!(!text.contains('C'), "{text}");
    }

    #[test]
    fn a_sure_difference_of_less_than_half_a_per_cent_is_a_tie() {
        assert_eq!(
            places(&[timed("A", |_| 10.0), timed("B", |_| 10.03)]),
            [place("A", 1), place("B", 1)]
        );
        assert_eq!(
            places(&[timed("A", |_| 10.0), timed("B", |_| 10.1)]),
            [place("A", 1), place("B", 2)]
        );
    }

    #[test]
    fn without_rounds_only_the_time_decides() {
        let records = [record("A", &[10.0]), record("B", &[10.0001]), record("C", &[9.0])];
        assert_eq!(places(&records), [place("C", 1), place("A", 2), place("B", 3)]);
        assert_eq!(tie(&ranks(&records)), None);
        assert_eq!(Ratio::between(&records[0], &records[1]), None);
    }

    #[test]
    fn few_rounds_make_a_tie_and_a_note() {
        let records =
            |rounds: usize| [record("A", &vec![1.0; rounds]), record("B", &vec![2.0; rounds])];
        assert_eq!(places(&records(6)), [place("A", 1), place("B", 2)]);
        let few = records(5);
        assert_eq!(places(&few), [place("A", 1), place("B", 1)]);
        assert!(
            tie(&ranks(&few))
                .is_some_and(|words| words.contains("5 rounds are too few to test ties"))
        );
    }

    /// A record of laps along a path: a time for each lap and pose.
    fn along_path(strategy: &str, laps: u32, poses: u32, time: impl Fn(u32, u32) -> f64) -> Record {
        let times: Vec<f64> = (0..laps)
            .flat_map(|lap| (0..poses).map(move |pose| (lap, pose)))
            .map(|(l, p)| time(l, p))
            .collect();
        let mut record = record(strategy, &times);
        (record.setting.along_path, record.setting.poses, record.times.rounds) =
            (true, Some(poses), laps);
        record.set_times();
        record
    }

    #[test]
    fn laps_along_a_path_separate_strategies_however_much_poses_differ() {
        // Poses differ by a factor of ten, laps drift by a fifth, the methods by 2 %.
        let (x, y) = (noise(1), noise(2));
        let time =
            |lap: u32, pose: u32| f64::from(1 + 9 * (pose % 2)) * (1.0 + f64::from(lap) / 40.0);
        let a = along_path("A", 8, 4, |l, p| time(l, p) * (1.0 + 0.004 * x(4 * l + p)));
        let b = along_path("B", 8, 4, |l, p| 1.02 * time(l, p) * (1.0 + 0.004 * y(4 * l + p)));
        let c = along_path("C", 8, 4, |l, p| 1.001 * time(l, p) * (1.0 + 0.004 * y(4 * l + p)));
        assert_eq!(places(&[b, a.clone(), c]), [place("A", 1), place("C", 1), place("B", 2)]);
        assert_eq!(a.laps(), 8);
        let interval = a.interval_ms().expect("laps");
        // Laps run from 5.5 to 6.5 ms on average; single poses from 1 to 12.
        assert!(interval.low > 5.4 && interval.high < 6.6, "{interval:?}");
        let poses = a.pose_times_ms();
        assert!(poses.len() == 4 && poses[0] < 1.2 && poses[1] > 9.0, "{poses:?}");
    }

    #[test]
    fn one_lap_makes_a_note_and_laps_of_other_poses_do_not_pair() {
        let one = along_path("A", 1, 40, |_, pose| f64::from(pose));
        let mut old = one.clone();
        old.setting.poses = None;
        old.times.rounds = 40;
        for record in [&one, &old] {
            assert_eq!((record.laps(), record.interval_ms()), (1, None));
            assert_eq!(Ratio::between(record, record), None);
        }
        let words = tie(&ranks(&[one.clone(), old])).expect("one lap");
        assert!(words.starts_with("one lap") && words.contains("--laps 6"), "{words}");
        let (a, b) = (along_path("A", 8, 4, |_, _| 1.0), along_path("B", 8, 5, |_, _| 1.0));
        assert_eq!(Ratio::between(&a, &b), None);
        let few = [along_path("A", 5, 4, |_, _| 1.0), along_path("B", 5, 4, |_, _| 2.0)];
        let words = tie(&ranks(&few)).expect("five laps");
        assert!(
            words.starts_with(
                "5 laps are too few to test ties, so A and B share rank 1; use --laps 6"
            ),
            "{words}"
        );
    }

    #[test]
    fn lossy_strategies_and_those_without_culling_have_no_rank() {
        let mut lossy = timed("A", |_| 1.0);
        lossy.lists.missed_pairs = Some(3);
        let nan = timed("E", |_| f64::NAN);
        // A knob that lost nothing in this view.
        let mut capped = timed("B/cap9", |_| 1.0);
        capped.is_lossy = true;
        let none = timed("None", |_| 1.0);
        let records = [lossy, none, timed("Clay", |_| 1.0), timed("B", |_| 5.0), nan, capped];
        assert_eq!(places(&records), [place("B", 1)]);
        assert!(ranks([]).is_empty() && tie(&[]).is_none());
    }
}
