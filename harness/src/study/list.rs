//! The list of all studies: the one place that names them.

use super::{
    area, cdi, comparison, culling, endless, engines, gloss, living, shadows, slice::Study,
    stability,
};
use crate::cli::CliError;

/// All studies, in the order in which the command line lists them.
pub(crate) const STUDIES: &[Study] = &[
    comparison::STUDY,
    culling::STUDY,
    living::STUDY,
    area::STUDY,
    endless::STUDY,
    cdi::STUDY,
    engines::STUDY,
    stability::STUDY,
    gloss::STUDY,
    shadows::STUDY,
];

/// Name of each study, and what it answers.
pub fn studies() -> impl Iterator<Item = (&'static str, &'static str)> {
    STUDIES.iter().map(|study| (study.name, study.answers))
}

/// The study of a name.
///
/// # Errors
///
/// Names the studies that there are.
pub(crate) fn named(name: &str) -> Result<&'static Study, CliError> {
    let known: Vec<&str> = studies().map(|(name, _)| name).collect();
    let study = STUDIES.iter().find(|study| study.name == name);
    study.ok_or_else(|| CliError::unknown("study", name, &known))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_study_has_a_name_of_its_own_and_says_what_it_answers() {
        let mut names: Vec<&str> = studies().map(|(name, _)| name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), STUDIES.len());
        for (name, answers) in studies() {
            assert!(!answers.is_empty() && !answers.ends_with('.'), "{name}: {answers}");
        }
    }

    #[test]
    fn an_unknown_study_is_refused_and_the_nearest_is_named() {
        let Err(error) = named("cullin") else { panic!("there is no such study") };
        let error = error.to_string();
        assert!(error.contains("cullin") && error.contains("culling"), "{error}");
        assert!(named("cdi").is_ok());
    }
}
