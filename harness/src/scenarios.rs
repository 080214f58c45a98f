//! The list of stability scenarios, as `lightbench list scenarios` prints it.

use scenes::stability::{self, Group, Move, Scenario};

/// What follows the scenarios.
const NOTES: &str = "\
A number counts situations: scenarios with the same number show one situation in several ways. Those without a\n\
number show what users of engines report.\n\
--scene stability:NAME draws a scenario, and adds the options that it names. --seed draws it with other random\n\
numbers. With --path, its camera makes its first move; stability:NAME:MOVE makes another.\n";

/// Every scenario, by group: number, name, moves, and what breaks there.
pub fn list() -> String {
    let mut text = String::new();
    for group in Group::LIST {
        text += &format!("{}\n", group.name());
        for scenario in stability::list().iter().filter(|scenario| scenario.group == group) {
            text += &row(scenario);
        }
        text.push('\n');
    }
    text + NOTES
}

fn row(scenario: &Scenario) -> String {
    let number = scenario.number.map_or_else(String::new, |number| number.to_string());
    let mut text = format!("  {number:>2} {:<22} {}\n", scenario.name, scenario.breaks);
    let mut note = |words: String| text += &format!("{:27}{words}\n", "");
    if !scenario.moves.is_empty() {
        let moves: Vec<String> = scenario.moves.iter().map(|way| words(*way)).collect();
        note(format!("moves: {}", moves.join(", ")));
    }
    if !scenario.options.is_empty() {
        let options = scenario.options.join(" ");
        note(match scenario.options.contains(&"--msaa") {
            true => format!("needs {options} --mode forward --truth none"),
            false => format!("adds {options}"),
        });
    }
    text
}

fn words(way: Move) -> String {
    match way {
        Move::Lights(law) => format!("--motion {law}"),
        Move::Dolly | Move::Rotation | Move::Teleport => way.name().to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use scenes::MotionLaw;

    use super::*;

    #[test]
    fn every_scenario_is_listed_once_and_its_motions_exist() {
        let text = list();
        for scenario in stability::list() {
            let lines = text.lines().filter(|line| {
                let mut words = line.split_whitespace();
                words.by_ref().take(2).any(|word| word == scenario.name)
            });
            assert_eq!(lines.count(), 1, "{}", scenario.name);
            for way in scenario.moves {
                if let Move::Lights(law) = way {
                    assert!(law.parse::<MotionLaw>().is_ok(), "{}: {law}", scenario.name);
                }
            }
        }
    }
}
