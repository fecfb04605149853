//! Numbers instead of names.

use std::collections::HashMap;
use std::hash::Hash;

/// Number of each value among the different ones, in order of appearance.
pub(super) fn numbered<K: Eq + Hash>(keys: impl IntoIterator<Item = K>) -> Vec<usize> {
    let mut known: HashMap<K, usize> = HashMap::new();
    let number = |key: K| {
        let next = known.len();
        *known.entry(key).or_insert(next)
    };
    keys.into_iter().map(number).collect()
}
