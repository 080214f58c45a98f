//! A claim of a paper, and what the scenes of a study say of it.

use std::fmt::Write;

use super::verdict::{Answer, Verdict};
use crate::report::rank::listed;
use crate::study::manifest::Done;

/// One claim of a paper.
pub(crate) struct Check {
    /// What the page's markup calls it.
    pub(crate) id: &'static str,
    /// Where the paper makes it: `table 4.3`.
    pub(crate) place: &'static str,
    /// The claim, one sentence.
    pub(crate) words: &'static str,
    /// The paper's figures, with units; empty where it gives none.
    pub(crate) paper: &'static str,
    /// How this study's measurement departs from the paper's, beyond what `Paper::about` says.
    pub(crate) departure: &'static str,
    /// Decides it from the figures of one scene.
    pub(crate) decide: fn(&Done, &str) -> Answer,
}

/// A paper's claims, and how it measured.
pub(crate) struct Paper {
    /// What the page calls it: `the comparison paper`.
    pub(crate) name: &'static str,
    /// Author, year, device, and what decides its claims here.
    pub(crate) about: &'static str,
    pub(crate) checks: &'static [Check],
}

/// A claim with the answers of all scenes.
pub(crate) struct Claim<'a> {
    pub(crate) check: &'static Check,
    pub(crate) answers: Vec<(&'a str, Answer)>,
}

/// Undecided if the study ran on another GPU than the paper, because then absolute times decide nothing.
pub(crate) fn on_another_gpu(done: &Done, gpu: &str) -> Option<Verdict> {
    let is_other = done.results.values().any(|results| !results.machine.adapter.contains(gpu));
    is_other.then(|| Verdict::undecided(&format!("the paper used another GPU, {gpu}")))
}

/// All claims of a paper.
pub(crate) fn judge<'a>(done: &'a Done, paper: &Paper) -> Vec<Claim<'a>> {
    let scenes = done.scenes();
    let claim = |check: &'static Check| {
        let answers = scenes.iter().map(|scene| (*scene, (check.decide)(done, scene))).collect();
        Claim { check, answers }
    };
    paper.checks.iter().map(claim).collect()
}

impl Claim<'_> {
    /// The verdict of all scenes together.
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
                // `verdict_text` counts the scenes that decide nothing.
                if all(&Verdict::Holds) {
                    Verdict::Holds
                } else if all(&Verdict::Fails) {
                    Verdict::Fails
                } else {
                    let scenes_where = |id: &str, how: &str| {
                        let scenes: Vec<&str> = several
                            .iter()
                            .filter(|(_, answer)| answer.verdict.id() == id)
                            .map(|(scene, _)| *scene)
                            .collect();
                        (!scenes.is_empty()).then(|| format!("{how} in {}", listed(&scenes)))
                    };
                    let parts: Vec<String> = [
                        scenes_where("holds", "holds"),
                        scenes_where("differs", "holds in part"),
                        scenes_where("fails", "fails"),
                    ]
                    .into_iter()
                    .flatten()
                    .collect();
                    Verdict::Differs(parts.join("; "))
                }
            }
        }
    }

    /// The verdict, and how many scenes decide it if not all do: `holds (1 of 3 scenes measured)`.
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

/// A text that starts with a capital letter.
pub(crate) fn capitalised(text: &str) -> String {
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
        assert_eq!(why, "holds in scene; fails in scene");
        assert!(matches!(claim(&[]).verdict(), Unknown(_)));
    }

    #[test]
    fn parts_decide() {
        assert_eq!(Verdict::of_parts(3, 3, "pairs"), Verdict::Holds);
        assert_eq!(Verdict::of_parts(0, 3, "pairs"), Verdict::Fails);
        assert_eq!(
            Verdict::of_parts(1, 3, "pairs"),
            Verdict::Differs("holds for 1 of 3 pairs".to_owned())
        );
        assert!(matches!(Verdict::of_parts(0, 0, "pairs"), Verdict::Unknown(_)));
    }
}
