//! The claims of the papers, each held against a study's figures.

use std::fmt::Write;

use super::super::format::escape;
use super::super::rank::listed;
use super::checks::{
    best_at_few, best_at_many, bounds, linear, models, steadiness, tests as intersection_tests,
};
use super::endless_checks::{assignment, best_cones, outer};
use super::figure::table;
use crate::study::Done;

/// What the figures say of a claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// They bear it out.
    Holds,
    /// They contradict it.
    Fails,
    /// They bear a part of it out: which.
    Differs(String),
    /// They were not measured: what lacks.
    Unknown(String),
}

impl Verdict {
    /// Holds where all of the parts do, fails where none does.
    pub(super) fn of_parts(good: usize, all: usize, what: &str) -> Self {
        match (good, all) {
            (_, 0) => Self::Unknown(format!("no {what}")),
            (good, all) if good == all => Self::Holds,
            (0, _) => Self::Fails,
            (good, all) => Self::Differs(format!("{good} of {all} {what}")),
        }
    }

    /// For the page's markup.
    fn id(&self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Fails => "fails",
            Self::Differs(_) => "differs",
            Self::Unknown(_) => "unknown",
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Holds => "holds".to_owned(),
            Self::Fails => "does not hold".to_owned(),
            Self::Differs(why) => format!("differs: {why}"),
            Self::Unknown(why) => format!("not measured: {why}"),
        }
    }
}

/// What one scene says of a claim.
#[derive(Clone, Debug)]
pub(super) struct Answer {
    /// Our figures.
    pub(super) figure: String,
    pub(super) verdict: Verdict,
}

impl Answer {
    pub(super) fn unknown(why: &str) -> Self {
        Self { figure: String::new(), verdict: Verdict::Unknown(why.to_owned()) }
    }
}

/// A claim: what the page calls it, its words, and what decides it.
type Check = (&'static str, &'static str, fn(&Done, &str) -> Answer);

/// What a paper claims, and how it came to it.
pub(super) struct Paper {
    /// What the page calls it: `the comparison paper`.
    name: &'static str,
    /// Author, year, device, and what decides its claims here.
    about: &'static str,
    checks: &'static [Check],
}

/// The paper that a study is held against, where it makes claims.
pub(super) fn paper(study: &str) -> Option<Paper> {
    match study {
        "comparison" => Some(Paper {
            name: "the comparison paper",
            about: "Enhuber 2019 timed these strategies on a GTX 780. Claims are decided by the strategies \
                    of that paper and the counts of lights this study has.",
            checks: &COMPARISON,
        }),
        "endless" => Some(Paper {
            name: "the polygon-light paper",
            about: "Swarbrick 2025 timed polygon lights with normal cones on a GTX 1060, and says that 54 \
                    cones leave out four fifths of the outer specular operations, and cost too much. Its \
                    cones lose light; here settings without a loss and with a cut are told apart.",
            checks: &ENDLESS,
        }),
        _ => None,
    }
}

const ENDLESS: [Check; 3] = [
    ("cones", "The best number of cones beats clusters by position in assign + shade.", best_cones),
    ("outer", "54 cones leave out 80 % of outer specular operations.", outer),
    (
        "assignment",
        "54 cones cost less than 1 ms of assignment, where the paper\u{2019}s cost 72 ms at 2,016 lights.",
        assignment,
    ),
];

const COMPARISON: [Check; 7] = [
    ("linear", "Time grows linearly with the number of lights.", linear),
    ("bounds", "Explicit bounds lower the slope and raise the offset.", bounds),
    ("many", "SC-E is best at 10,000 lights.", best_at_many),
    ("few", "DC-I or G is best at 100 lights.", best_at_few),
    ("tests", "HS+SAT-N is the best intersection test.", intersection_tests),
    ("steady", "SC-E depends least on the view.", steadiness),
    ("models", "M suffers from large models, and dividing them mends it.", models),
];

/// A claim with the answers of all scenes.
pub(super) struct Claim<'a> {
    id: &'static str,
    words: &'static str,
    answers: Vec<(&'a str, Answer)>,
}

/// All claims of a paper.
pub(super) fn claims<'a>(done: &'a Done, paper: &Paper) -> Vec<Claim<'a>> {
    let scenes = done.scenes();
    let claim = |&(id, words, check): &Check| {
        let answers = scenes.iter().map(|scene| (*scene, check(done, scene))).collect();
        Claim { id, words, answers }
    };
    paper.checks.iter().map(claim).collect()
}

impl Claim<'_> {
    /// What all scenes together say.
    pub(super) fn verdict(&self) -> Verdict {
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

    /// For the terminal.
    pub(super) fn text(&self) -> String {
        let mut text = format!("{} {}.", self.words, capitalised(&self.verdict().text()));
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

/// All claims as a table.
pub(super) fn claims_html(paper: &Paper, claims: &[Claim<'_>], is_software: bool) -> String {
    let Some(first) = claims.first() else { return String::new() };
    let mut heads = vec!["claim".to_owned()];
    heads.extend(first.answers.iter().map(|(scene, _)| escape(scene)));
    heads.push("verdict".to_owned());
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let rows: Vec<Vec<String>> = claims
        .iter()
        .map(|claim| {
            let verdict = claim.verdict();
            let mut row = vec![claim.words.to_owned()];
            row.extend(claim.answers.iter().map(|(scene, answer)| {
                let figure = match answer.figure.as_str() {
                    "" => answer.verdict.text(),
                    figure => figure.to_owned(),
                };
                // Where the table is too narrow for heads, the scene stands before its figure.
                let of = format!("<b class=\"of\">{}: </b>", escape(scene));
                let own = match claim.answers.len() {
                    1 => String::new(),
                    _ => format!(
                        "<span class=\"verdict {}\">{}</span><br>",
                        answer.verdict.id(),
                        escape(&answer.verdict.text())
                    ),
                };
                let figure = escape(&figure).replace("; ", ";<br>");
                if answer.figure.is_empty() && !own.is_empty() {
                    return of + &own;
                }
                of + &own + &figure
            }));
            row.push(format!(
                "<span class=\"verdict {0}\" data-claim=\"{1}\" data-verdict=\"{0}\">{2}</span>",
                verdict.id(),
                claim.id,
                escape(&verdict.text())
            ));
            row
        })
        .collect();
    let caveat = if is_software {
        " This study ran on a software adapter: the verdicts are not a GPU\u{2019}s."
    } else {
        ""
    };
    format!(
        "<section class=\"claims\" aria-labelledby=\"claims\"><h2 id=\"claims\">What {} says, and what was \
         measured</h2>\n<p class=\"note\">{}{caveat}</p>\n{}</section>\n",
        paper.name,
        paper.about,
        table(&format!("Claims of {}", paper.name), &heads, &rows)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn claim(verdicts: &[Verdict]) -> Claim<'static> {
        let answer = |verdict: &Verdict| {
            ("scene", Answer { figure: "1".to_owned(), verdict: verdict.clone() })
        };
        Claim { id: "x", words: "X.", answers: verdicts.iter().map(answer).collect() }
    }

    #[test]
    fn scenes_that_disagree_make_a_claim_differ() {
        use Verdict::{Differs, Fails, Holds, Unknown};
        let unknown = || Unknown("no path".to_owned());
        assert_eq!(claim(&[Holds, Holds]).verdict(), Holds);
        assert_eq!(claim(&[Fails, Fails]).verdict(), Fails);
        assert_eq!(claim(&[Holds, unknown()]).verdict(), Holds);
        assert_eq!(claim(&[unknown(), unknown()]).verdict(), unknown());
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
