//! Counts the parts of a claim, such as cases or renderers, and what each says.

use super::order::Order;
use super::verdict::{Answer, Verdict};

/// What one part says of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Good,
    Bad,
    /// Two times that tie.
    Tie,
    /// Too few rounds or laps for so small a difference.
    Unsure,
}

impl From<bool> for Outcome {
    fn from(is_good: bool) -> Self {
        if is_good { Self::Good } else { Self::Bad }
    }
}

/// Good where the first of two figures is less.
impl From<Order> for Outcome {
    fn from(order: Order) -> Self {
        match order {
            Order::Less => Self::Good,
            Order::More => Self::Bad,
            Order::Tie => Self::Tie,
            Order::Unsure => Self::Unsure,
        }
    }
}

/// The parts of a claim with their figures.
#[derive(Default)]
pub(crate) struct Tally {
    pub(crate) figures: Vec<String>,
    pub(crate) good: usize,
    pub(crate) all: usize,
    ties: usize,
    unsure: usize,
}

impl Tally {
    pub(crate) fn add(&mut self, outcome: impl Into<Outcome>, figure: String) {
        self.count(outcome);
        self.figures.push(figure);
    }

    /// Counts a part without a figure.
    pub(crate) fn count(&mut self, outcome: impl Into<Outcome>) {
        self.all += 1;
        match outcome.into() {
            Outcome::Good => self.good += 1,
            Outcome::Bad => {}
            Outcome::Tie => self.ties += 1,
            Outcome::Unsure => self.unsure += 1,
        }
    }

    /// Holds where all parts say so, fails where all deny it. Ties are neither, nor are times that too few
    /// rounds cannot order.
    pub(crate) fn verdict(&self, parts: &str) -> Verdict {
        if self.ties + self.unsure == 0 {
            return Verdict::of_parts(self.good, self.all, parts);
        }
        let mut text = format!("holds for {} of {} {parts}", self.good, self.all);
        text += &match self.ties {
            0 => String::new(),
            1 => ", a tie in 1".to_owned(),
            many => format!(", ties in {many}"),
        };
        if self.unsure > 0 {
            text += &format!(", too few repetitions in {}", self.unsure);
        }
        Verdict::Differs(text)
    }

    /// All figures and the verdict; `missing` says what was not measured where there is no part.
    pub(crate) fn answer(self, parts: &str, missing: &str) -> Answer {
        if self.all == 0 {
            return Answer::unknown(missing);
        }
        let verdict = self.verdict(parts);
        Answer { figure: self.figures.join("; "), verdict }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tie_is_neither_for_nor_against() {
        use Outcome::{Bad, Good, Tie, Unsure};
        let verdict = |outcomes: &[Outcome]| {
            let mut tally = Tally::default();
            outcomes.iter().for_each(|outcome| tally.count(*outcome));
            tally.verdict("cases")
        };
        let differs = |text: &str| Verdict::Differs(text.to_owned());
        assert_eq!(verdict(&[Good, Good]), Verdict::Holds);
        assert_eq!(verdict(&[Bad, Bad]), Verdict::Fails);
        assert_eq!(verdict(&[Good, Bad]), differs("holds for 1 of 2 cases"));
        let tied = differs("holds for 2 of 4 cases, a tie in 1");
        assert_eq!(verdict(&[Good, Tie, Good, Bad]), tied);
        assert_eq!(verdict(&[Tie, Tie]), differs("holds for 0 of 2 cases, ties in 2"));
        let few = differs("holds for 1 of 2 cases, too few repetitions in 1");
        assert_eq!(verdict(&[Good, Unsure]), few);
    }
}
