//! The claims of the papers, one file per paper, each held against a study's figures.
//!
//! A claim is one row: where the paper makes it, its words, the paper's figures, how this study departs
//! from the paper, and the function that decides it from the figures of one scene. It is judged by the
//! paper's own statistic where the paper states one; where it does not, `departure` states ours and its
//! limits.

mod area;
mod area_cost;
mod area_ltc;
mod comparison;
mod culling;
mod endless;
mod endless_operations;
mod endless_rows;
mod endless_times;
mod indirect;
mod indirect_builds;
mod indirect_casts;
mod indirect_light;
mod markdown;
mod table;
mod verdict;

use std::fmt::Write;

use crate::report::rank::listed;
use crate::study::Done;
pub use markdown::claims_markdown;
pub(crate) use table::claims_html;
pub(crate) use verdict::{Answer, Verdict};

/// One claim of a paper.
pub(crate) struct Check {
    /// What the page's markup calls it.
    id: &'static str,
    /// Where the paper makes it: `table 4.3`.
    place: &'static str,
    /// The claim, one sentence.
    words: &'static str,
    /// The paper's figures, with units; empty where it gives none.
    paper: &'static str,
    /// How this study's measurement departs from the paper's, beyond what `Paper::about` says.
    departure: &'static str,
    /// Decides it from the figures of one scene.
    decide: fn(&Done, &str) -> Answer,
}

/// What a paper claims, and how it came to it.
pub(crate) struct Paper {
    /// What the page calls it: `the comparison paper`.
    name: &'static str,
    /// Author, year, device, and what decides its claims here.
    about: &'static str,
    checks: &'static [Check],
}

/// The paper that a study is held against.
pub(crate) fn paper(study: &str) -> Option<&'static Paper> {
    match study {
        "comparison" => Some(&comparison::PAPER),
        "culling" => Some(&culling::PAPER),
        "area" => Some(&area::PAPER),
        "endless" => Some(&endless::PAPER),
        "cdi" => Some(&indirect::PAPER),
        _ => None,
    }
}

/// A claim with the answers of all scenes.
pub(crate) struct Claim<'a> {
    check: &'static Check,
    answers: Vec<(&'a str, Answer)>,
}

/// Whether a study ran on another GPU than a paper: then absolute times decide nothing.
fn on_another_gpu(done: &Done, gpu: &str) -> Option<Verdict> {
    let is_other = done.results.values().any(|results| !results.machine.adapter.contains(gpu));
    is_other.then(|| Verdict::undecided(&format!("another GPU than the paper\u{2019}s {gpu}")))
}

/// All claims of a paper.
pub(crate) fn claims<'a>(done: &'a Done, paper: &Paper) -> Vec<Claim<'a>> {
    let scenes = done.scenes();
    let claim = |check: &'static Check| {
        let answers = scenes.iter().map(|scene| (*scene, (check.decide)(done, scene))).collect();
        Claim { check, answers }
    };
    paper.checks.iter().map(claim).collect()
}

impl Claim<'_> {
    /// What all scenes together say.
    pub(crate) fn verdict(&self) -> Verdict {
        let known: Vec<&(&str, Answer)> = self
            .answers
            .iter()
            .filter(|(_, answer)| !matches!(answer.verdict, Verdict::Unknown(_)))
            .collect();
        match known.as_slice() {
            [] => match self.answers.first() {
                Some((_, answer)) => answer.verdict.clone(),
                None => Verdict::Unknown("no scene".to_owned()),
            },
            [(_, one)] => one.verdict.clone(),
            several => {
                let all = |verdict: &Verdict| several.iter().all(|(_, a)| a.verdict == *verdict);
                // Scenes that say nothing are counted in `verdict_text`.
                if all(&Verdict::Holds) {
                    Verdict::Holds
                } else if all(&Verdict::Fails) {
                    Verdict::Fails
                } else {
                    let of = |id: &str, how: &str| {
                        let scenes: Vec<&str> = several
                            .iter()
                            .filter(|(_, answer)| answer.verdict.id() == id)
                            .map(|(scene, _)| *scene)
                            .collect();
                        (!scenes.is_empty()).then(|| format!("{how} in {}", listed(&scenes)))
                    };
                    let parts: Vec<String> =
                        [of("holds", "holds"), of("differs", "in part"), of("fails", "not")]
                            .into_iter()
                            .flatten()
                            .collect();
                    Verdict::Differs(parts.join("; "))
                }
            }
        }
    }

    /// The verdict, and how many scenes decide it where some do not: `holds (1 of 3 scenes measured)`.
    pub(crate) fn verdict_text(&self) -> String {
        let is_known = |answer: &Answer| !matches!(answer.verdict, Verdict::Unknown(_));
        let known = self.answers.iter().filter(|(_, answer)| is_known(answer)).count();
        let text = self.verdict().text();
        match self.answers.len() {
            all if known == 0 || known == all => text,
            all => format!("{text} ({known} of {all} scenes measured)"),
        }
    }

    /// For the terminal.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("{} {}.", self.check.words, capitalised(&self.verdict_text()));
        for (scene, answer) in self.answers.iter().filter(|(_, a)| !a.figure.is_empty()) {
            let _ = write!(text, " {scene}: {}.", answer.figure);
        }
        text
    }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().collect::<String>()).unwrap_or_default();
    first + letters.as_str()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(verdicts: &[Verdict]) -> Claim<'static> {
        let answer = |verdict: &Verdict| {
            ("scene", Answer { figure: "1".to_owned(), verdict: verdict.clone() })
        };
        const CHECK: Check = Check {
            id: "x",
            place: "section 1",
            words: "X.",
            paper: "",
            departure: "",
            decide: |_, _| Answer::unknown("nothing"),
        };
        Claim { check: &CHECK, answers: verdicts.iter().map(answer).collect() }
    }

    #[test]
    fn scenes_that_disagree_make_a_claim_differ() {
        use Verdict::{Differs, Fails, Holds, Unknown};
        let unknown = || Unknown("no path".to_owned());
        assert_eq!(claim(&[Holds, Holds]).verdict(), Holds);
        assert_eq!(claim(&[Fails, Fails]).verdict(), Fails);
        assert_eq!(claim(&[Holds, unknown()]).verdict(), Holds);
        assert_eq!(
            claim(&[Holds, unknown(), unknown()]).verdict_text(),
            "holds (1 of 3 scenes measured)"
        );
        assert_eq!(claim(&[Holds, Holds]).verdict_text(), "holds");
        assert_eq!(claim(&[unknown(), unknown()]).verdict(), unknown());
        assert_eq!(claim(&[unknown(), unknown()]).verdict_text(), "no path");
        let Differs(why) = claim(&[Holds, Fails]).verdict() else { panic!("it differs") };
        assert_eq!(why, "holds in scene; not in scene");
        assert!(matches!(claim(&[]).verdict(), Unknown(_)));
    }

    #[test]
    fn parts_decide() {
        assert_eq!(Verdict::of_parts(3, 3, "pairs"), Verdict::Holds);
        assert_eq!(Verdict::of_parts(0, 3, "pairs"), Verdict::Fails);
        assert_eq!(Verdict::of_parts(1, 3, "pairs"), Verdict::Differs("1 of 3 pairs".to_owned()));
        assert!(matches!(Verdict::of_parts(0, 0, "pairs"), Verdict::Unknown(_)));
    }
}
