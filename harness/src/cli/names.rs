//! Finds known names that are close to a misspelt one.

/// The least Jaro-Winkler similarity of a name that is offered.
const NEAR: f64 = 0.7;

/// The most names that are offered.
const OFFERED: usize = 3;

/// The known names nearest to a name, nearest first, at most three; empty where none is near.
///
/// Case is ignored. A known name that starts with the given one is always near.
pub fn nearest(name: &str, known: &[&str]) -> Vec<String> {
    let name = name.trim().to_lowercase();
    if name.is_empty() {
        return Vec::new();
    }
    let mut near: Vec<_> = known
        .iter()
        .map(|known| {
            let lower = known.to_lowercase();
            let similarity = strsim::jaro_winkler(&lower, &name);
            (if lower.starts_with(&name) { 1.0 + similarity } else { similarity }, *known)
        })
        .filter(|(similarity, _)| *similarity >= NEAR)
        .collect();
    // The sort is stable: equally near names stay in the order of the registry.
    near.sort_by(|a, b| b.0.total_cmp(&a.0));
    near.into_iter().take(OFFERED).map(|(_, known)| known.to_owned()).collect()
}

/// `: did you mean A, B or C?`, to append to a message; empty where no name is near.
pub fn did_you_mean(name: &str, known: &[&str]) -> String {
    match nearest(name, known).as_slice() {
        [] => String::new(),
        [only] => format!(": did you mean {only}?"),
        [first @ .., last] => format!(": did you mean {} or {last}?", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: [&str; 6] =
        ["None", "T-I/28x28", "DC-I/64x64x24", "DC-E/64x64x40", "SC-I/48x48x40", "M"];

    #[test]
    fn near_names_are_offered_nearest_first() {
        assert_eq!(nearest("none", &KNOWN), ["None"]);
        assert_eq!(nearest("DC-I", &KNOWN)[0], "DC-I/64x64x24");
        assert_eq!(nearest("dc-e/64x64x4", &KNOWN)[0], "DC-E/64x64x40");
        assert_eq!(nearest("atrum", &["atrium"]), ["atrium"]);
        assert!(nearest("DC", &KNOWN).len() <= 3);
    }

    #[test]
    fn far_names_are_not_offered() {
        assert!(nearest("quaternion", &KNOWN).is_empty());
        assert!(nearest("", &KNOWN).is_empty());
        assert!(nearest("None", &[]).is_empty());
        assert_eq!(did_you_mean("quaternion", &KNOWN), "");
    }

    #[test]
    fn the_hint_reads_as_a_question() {
        assert_eq!(did_you_mean("atrum", &["atrium"]), ": did you mean atrium?");
        assert_eq!(did_you_mean("ab", &["abc", "abd"]), ": did you mean abc or abd?");
    }
}
