//! Independent jobs on all processors, with results that do not depend on how many there are.

use rayon::prelude::*;

/// `job(0)`, `job(1)`, … `job(count − 1)`, in this order, worked on by all processors.
///
/// The results are the same for every number of threads if each job depends on its index alone; one
/// that needs random numbers takes the stream of its index
/// ([`Random::seeded`](crate::statistics::Random::seeded)). A job may itself call this.
pub fn in_parallel<T: Send>(count: usize, job: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    (0..count).into_par_iter().map(job).collect()
}

/// Both jobs at once. Either may call [`in_parallel`].
pub fn both<A: Send, B: Send>(first: impl FnOnce() -> A + Send, second: impl FnOnce() -> B + Send) -> (A, B) {
    rayon::join(first, second)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    fn sums(count: usize) -> Vec<f64> {
        in_parallel(count, |index| {
            let mut random = Random::seeded(11, index as u64);
            (0..=index % 7).map(|_| random.normal()).sum()
        })
    }

    #[test]
    fn results_come_in_order_whatever_the_threads() {
        assert_eq!(in_parallel(1000, |index| index), (0..1000).collect::<Vec<_>>());
        assert_eq!(in_parallel(0, |index| index), Vec::<usize>::new());
        let parallel = sums(200);
        // inside a pool of one thread everything is sequential
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(parallel, pool.install(|| sums(200)));
    }

    #[test]
    fn jobs_within_jobs_are_no_different() {
        let (nested, beside) = both(|| in_parallel(20, |count| sums(10 * count)), || sums(30));
        assert_eq!(beside, sums(30));
        assert!((0..20).all(|count| nested[count] == sums(10 * count)));
    }
}
