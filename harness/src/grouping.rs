//! Groups in the order in which they first appear.

/// Values by key.
pub(crate) fn grouped_by<K: PartialEq, V>(
    pairs: impl IntoIterator<Item = (K, V)>,
) -> Vec<(K, Vec<V>)> {
    let mut groups: Vec<(K, Vec<V>)> = Vec::new();
    for (key, value) in pairs {
        match groups.iter_mut().find(|(known, _)| *known == key) {
            Some((_, values)) => values.push(value),
            None => groups.push((key, vec![value])),
        }
    }
    groups
}

/// Values, each once.
pub(crate) fn distinct<V: PartialEq>(values: impl IntoIterator<Item = V>) -> Vec<V> {
    let pairs = values.into_iter().map(|value| (value, ()));
    grouped_by(pairs).into_iter().map(|(value, _)| value).collect()
}
