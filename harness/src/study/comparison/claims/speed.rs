//! Claims on times: which strategies are fast at which count of lights.

use crate::report::format::{mebibytes, number, significant};
use crate::results::Record;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Verdict};
use crate::study::comparison::claims::field::{Field, ordered};
use crate::study::comparison::claims::pairs::Pairs;
use crate::study::manifest::Done;

/// Up to this ratio of times a strategy is a little slower; the paper's are 1.04 to 1.10.
const LITTLE: f64 = 1.2;

/// DC-E and SC-E lead the strategies of table 4.3.
pub(crate) fn best_at_many(done: &Done, scene: &str) -> Answer {
    let others = ["SC-I", "T-E", "DC-I", "G", "T-I"];
    ordered(done, scene, 10_000, &[&["DC-E", "SC-E"], &others])
}

/// DC-E is faster than SC-E, and not by much.
pub(crate) fn dense_before_sparse(done: &Done, scene: &str) -> Answer {
    let field = match Field::at(done, scene, 10_000) {
        Ok(field) => field,
        Err(answer) => return answer,
    };
    let Some([dense, sparse]) = field.both(["DC-E", "SC-E"]) else {
        return Answer::unknown("DC-E and SC-E");
    };
    let ratio = sparse.assign_and_shade_ms() / dense.assign_and_shade_ms();
    let figure = format!(
        "{}: {}; SC-E takes {} times as long",
        field.records.basis,
        field.times(&["DC-E", "SC-E"]),
        significant(ratio)
    );
    let verdict = match Order::of_times(dense, sparse) {
        Order::Less if ratio <= LITTLE => Verdict::Holds,
        Order::Less => Verdict::Differs("by more than a little".to_owned()),
        Order::Tie => Verdict::Differs("a tie".to_owned()),
        Order::Unsure => Verdict::Differs("too few laps for so small a difference".to_owned()),
        Order::More => Verdict::Fails,
    };
    Answer { figure, verdict }
}

/// SC-E keeps far less than DC-E: half at most.
pub(crate) fn sparse_memory(done: &Done, scene: &str) -> Answer {
    let field = match Field::at(done, scene, 10_000) {
        Ok(field) => field,
        Err(answer) => return answer,
    };
    let Some([dense, sparse]) = field.both(["DC-E", "SC-E"]) else {
        return Answer::unknown("DC-E and SC-E");
    };
    let told = |what: &str, bytes: [u64; 2]| {
        let [dense, sparse] = bytes.map(|bytes| mebibytes(bytes as f64));
        let lights = number(field.lights as f64);
        format!("at {lights} lights, {what}: DC-E {dense} MiB, SC-E {sparse} MiB")
    };
    let (Some(all_dense), Some(all_sparse)) =
        (dense.lists.assignment_bytes, sparse.lists.assignment_bytes)
    else {
        // The lists are only a part of the memory: they decide nothing.
        let figure = told(
            "GPU memory of groups and lists only",
            [dense.lists.list_bytes, sparse.lists.list_bytes],
        );
        return Answer { figure, verdict: Verdict::unmeasured("all memory that assignment needs") };
    };
    let (dense, sparse) = (all_dense, all_sparse);
    let figure = told("GPU memory of all that assignment needs", [dense, sparse]);
    let verdict = match (2 * sparse <= dense, sparse < dense) {
        (true, _) => Verdict::Holds,
        (false, true) => Verdict::Differs("less, but more than half".to_owned()),
        (false, false) => Verdict::Fails,
    };
    Answer { figure, verdict }
}

/// Each explicit strategy is faster than its implicit counterpart.
pub(crate) fn explicit_at_many(done: &Done, scene: &str) -> Answer {
    let field = match Field::at(done, scene, 10_000) {
        Ok(field) => field,
        Err(answer) => return answer,
    };
    let (mut pairs, mut figure) = (Pairs::default(), field.records.basis.clone());
    for names in [["T-E", "T-I"], ["DC-E", "DC-I"], ["SC-E", "SC-I"]] {
        let order = |less: &&Record, more: &&Record| Order::of_times(less, more);
        let order = |less: &str, more: &str| field.records.order(less, more, order);
        pairs.compare(names, |name| field.records.member(name), order);
        if names.iter().any(|name| field.records.get(name).is_some()) {
            figure += &format!("; {}", field.times(&names));
        }
    }
    Answer { figure: figure + &pairs.exceptions(), verdict: pairs.verdict() }
}

/// DC-I leads the strategies of table 4.5 at 100 lights.
pub(crate) fn best_at_few(done: &Done, scene: &str) -> Answer {
    ordered(done, scene, 100, &[&["DC-I"], &["G", "T-I", "T-E", "SC-I", "SC-E", "M"]])
}

/// The groups of table 4.5 at 100 lights.
pub(crate) fn order_at_few(done: &Done, scene: &str) -> Answer {
    let chain: [&[&str]; 4] = [&["DC-I", "G", "T-I"], &["T-E"], &["SC-I", "SC-E"], &["M"]];
    ordered(done, scene, 100, &chain)
}

/// T-E leads the strategies of table 4.5 at 1,000 lights.
pub(crate) fn best_at_medium(done: &Done, scene: &str) -> Answer {
    ordered(done, scene, 1_000, &[&["T-E"], &["SC-I", "SC-E", "DC-I", "G", "T-I", "M"]])
}

/// The groups of table 4.5 at 1,000 lights.
pub(crate) fn order_at_medium(done: &Done, scene: &str) -> Answer {
    let fast = ["T-E", "SC-I", "SC-E", "DC-I", "G"];
    ordered(done, scene, 1_000, &[&fast, &["T-I"], &["M"]])
}

/// The groups of table 4.5 at 10,000 lights.
pub(crate) fn order_at_many(done: &Done, scene: &str) -> Answer {
    let chain: [&[&str]; 5] = [&["SC-E"], &["SC-I"], &["T-E"], &["DC-I", "G"], &["T-I", "M"]];
    ordered(done, scene, 10_000, &chain)
}
