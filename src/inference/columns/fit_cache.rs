//! Answers of a search by the terms that they are of: it comes to the same hypothesis by several
//! ways.

use std::collections::{BTreeMap, VecDeque};
use std::sync::{Mutex, PoisonError};

use crate::inference::Term;

/// Numbers that the answers of a cache hold together at most: 16 MB.
const MOST: usize = 1 << 21;

/// Terms, values to the last bit.
type Key = Vec<(usize, Vec<u64>)>;

/// What was asked before. What is forgotten, the oldest first, is found out again.
pub struct FitCache<T> {
    /// How many numbers an answer holds.
    size: fn(&T) -> usize,
    known: Mutex<Known<T>>,
}

struct Known<T> {
    answers: BTreeMap<Key, T>,
    /// The oldest first.
    order: VecDeque<Key>,
    size: usize,
}

impl<T: Clone> FitCache<T> {
    /// Of answers that hold so many numbers.
    pub fn new(size: fn(&T) -> usize) -> FitCache<T> {
        let known = Known { answers: BTreeMap::new(), order: VecDeque::new(), size: 0 };
        FitCache { size, known: Mutex::new(known) }
    }

    /// What is known of these terms, or else is found out.
    pub fn answer(&self, terms: &[Term], find: impl FnOnce() -> T) -> T {
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let bits = |term: &Term| (term.candidate, term.values.iter().map(|value| value.to_bits()).collect());
        let key: Key = terms.iter().map(bits).collect();
        if let Some(answer) = known().answers.get(&key) {
            return answer.clone();
        }
        // not while others wait
        let found = find();
        let mut known = known();
        if known.answers.insert(key.clone(), found.clone()).is_none() {
            known.size += (self.size)(&found);
            known.order.push_back(key);
        }
        while known.size > MOST && known.order.len() > 1 {
            let oldest = known.order.pop_front().and_then(|oldest| known.answers.remove(&oldest));
            known.size -= oldest.map_or(0, |answer| (self.size)(&answer));
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn an_answer_is_found_once_until_it_is_forgotten() {
        let memory = FitCache::new(|_: &usize| MOST / 2);
        let found = Cell::new(0);
        let ask = |value: f64| {
            let find = || {
                found.set(found.get() + 1);
                found.get()
            };
            memory.answer(&[Term { candidate: 3, values: vec![value] }], find)
        };
        assert_eq!([ask(1.0), ask(2.0), ask(1.0), ask(2.0)], [1, 2, 1, 2]);
        // a third one takes the place of the first
        assert_eq!([ask(3.0), ask(2.0), ask(1.0)], [3, 2, 4]);
    }
}
