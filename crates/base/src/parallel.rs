//! Independent jobs on all processors, with results that do not depend on how many there are; and
//! work that somebody may stop.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

/// `job(0)`, `job(1)`, … `job(count − 1)`, in this order, worked on by all processors.
///
/// The results are the same for every number of threads if each job depends on its index alone; one
/// that needs random numbers takes the stream of its index
/// ([`Random::seeded`](crate::statistics::Random::seeded)). A job may itself call this.
pub fn in_parallel<T: Send>(count: usize, job: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    let stop = current();
    (0..count).into_par_iter().map(|index| under(&stop, || job(index))).collect()
}

/// The same for jobs that are too small for others to be taken up in between: where processors are
/// at work already, inside a job of [`in_parallel`], they are done one after another.
pub fn in_parallel_outside_of_jobs<T: Send>(count: usize, job: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    match rayon::current_thread_index() {
        Some(_) => (0..count).map(job).collect(),
        None => in_parallel(count, job),
    }
}

/// Both jobs at once. Either may call [`in_parallel`].
pub fn both<A: Send, B: Send>(first: impl FnOnce() -> A + Send, second: impl FnOnce() -> B + Send) -> (A, B) {
    let stop = current();
    rayon::join(|| under(&stop, first), || under(&stop, second))
}

/// By which somebody outside stops work ([`stoppable`]).
#[derive(Debug, Clone, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Work under it ends at its next job or [`checkpoint`].
    pub fn now(&self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// What work that is stopped unwinds with. No panic: no hook runs and nothing is printed.
struct Stopped;

thread_local! {
    /// What stops the job that this thread works at.
    static CURRENT: RefCell<Option<Stop>> = const { RefCell::new(None) };
}

/// What `work` returns, or nothing where `stop` was asked for before it was done. It ends where its
/// next job begins, however deep inside, and leaves nothing behind.
///
/// ```
/// use rodcal_base::parallel::{Stop, in_parallel, stoppable};
///
/// let stop = Stop::default();
/// assert_eq!(stoppable(&stop, || in_parallel(3, |k| k)), Some(vec![0, 1, 2]));
/// stop.now();
/// assert_eq!(stoppable(&stop, || in_parallel(3, |k| k)), None);
/// ```
pub fn stoppable<T>(stop: &Stop, work: impl FnOnce() -> T) -> Option<T> {
    let own = Some(stop.clone());
    match catch_unwind(AssertUnwindSafe(|| under(&own, work))) {
        Ok(result) => Some(result),
        Err(why) if why.is::<Stopped>() => None,
        Err(why) => resume_unwind(why),
    }
}

/// Ends the work here where it is to be stopped: for long loops without jobs.
pub fn checkpoint() {
    let is_asked =
        CURRENT.with_borrow(|stop| stop.as_ref().is_some_and(|stop| stop.0.load(Ordering::Relaxed)));
    if is_asked {
        resume_unwind(Box::new(Stopped));
    }
}

fn current() -> Option<Stop> {
    CURRENT.with_borrow(Clone::clone)
}

/// A job under what stops it. A thread that waits for its jobs may take up one of other work.
fn under<T>(stop: &Option<Stop>, job: impl FnOnce() -> T) -> T {
    struct Before(Option<Stop>);
    impl Drop for Before {
        fn drop(&mut self) {
            CURRENT.set(self.0.take());
        }
    }
    let _before = Before(CURRENT.replace(stop.clone()));
    checkpoint();
    job()
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
    fn what_is_stopped_ends_within_its_jobs_and_stops_nothing_else() {
        let stop = Stop::default();
        let rows = |count: usize| in_parallel(count, |row| (row, in_parallel(4, |column| column).len()));
        let stopped = stoppable(&stop, || {
            in_parallel(1000, |index| {
                if index == 500 {
                    stop.now();
                }
                rows(3).len()
            })
        });
        assert!(stopped.is_none());
        // nothing is left of it on any thread
        assert_eq!(rows(100).len(), 100);
        assert_eq!(stoppable(&Stop::default(), || both(|| rows(2).len(), || 7)), Some((2, 7)));
        // a loop without jobs asks itself
        assert!(
            stoppable(&stop, || loop {
                checkpoint()
            })
            .is_none()
        );
    }

    #[test]
    fn jobs_within_jobs_are_no_different() {
        let (nested, beside) = both(|| in_parallel(20, |count| sums(10 * count)), || sums(30));
        assert_eq!(beside, sums(30));
        assert!((0..20).all(|count| nested[count] == sums(10 * count)));
    }
}
