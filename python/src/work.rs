//! Work that takes time: without Python's lock, with progress, and stopped by Ctrl-C.
//!
//! The work runs on a thread of its own (and on the library's). The thread that Python called waits
//! for it, and looks ten times a second whether the user wants to stop and how far it is. What is
//! stopped ends where its next job begins (`rodcal::parallel`), and leaves nothing behind.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::{Builder, scope};
use std::time::Duration;

use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use rodcal::parallel::{Stop, checkpoint, stoppable};

use crate::errors::IntoPython;

/// So often somebody looks.
const TICK: Duration = Duration::from_millis(100);
/// Of the thread that works: what a program's first thread usually has.
const STACK: usize = 8 << 20;

/// The process whose threads work; 0 before the first work.
static PROCESS: AtomicU32 = AtomicU32::new(0);

/// Refuses work in a process that was forked from one that had worked: a fork takes none of the
/// threads with it, and what waits for them waits for ever.
fn check_process() -> PyResult<()> {
    let own = std::process::id();
    match PROCESS.compare_exchange(0, own, Ordering::Relaxed, Ordering::Relaxed) {
        Err(first) if first != own => Err(PyRuntimeError::new_err(
            "this process was forked from one that had used rodcal, whose threads are not here; start it by \
             multiprocessing.get_context(\"spawn\") (or \"forkserver\"), or use rodcal in neither before the fork",
        )),
        _ => Ok(()),
    }
}

/// How far the work is: what it counts itself, else the library's jobs.
#[derive(Default)]
pub struct Progress {
    done: AtomicU64,
    total: AtomicU64,
    is_of_jobs: bool,
}

impl Progress {
    /// Of so many tasks.
    pub fn of(total: u64) -> Progress {
        Progress { total: AtomicU64::new(total), ..Progress::default() }
    }

    /// Of work that counts nothing: the jobs that are done say that it goes on.
    pub fn of_jobs() -> Progress {
        Progress { is_of_jobs: true, ..Progress::default() }
    }

    /// So many more are done. Loops without jobs of their own count too, and can be stopped here.
    pub fn more(&self, count: u64) {
        checkpoint();
        self.done.fetch_add(count, Ordering::Relaxed);
    }
}

/// What `work` returns. `progress` is called with the number of tasks that are done and the number
/// of all, `None` where nobody can count them.
pub fn run<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    counted: Progress,
    work: impl FnOnce(&Progress) -> rodcal::Result<T> + Send,
) -> PyResult<T> {
    check_process()?;
    let (stop, counted) = (Stop::default(), &counted);
    let tell = |py: Python<'_>| -> PyResult<()> {
        let Some(progress) = &progress else { return Ok(()) };
        let [done, total] = [&counted.done, &counted.total].map(|count| count.load(Ordering::Relaxed));
        let done = if counted.is_of_jobs { stop.jobs() } else { done };
        progress.call1(py, (done, (total > 0).then_some(total))).map(drop)
    };
    let done = py.detach(|| {
        scope(|scope| {
            let (sender, receiver) = channel();
            let stopped = &stop;
            let job = move || {
                let result = stoppable(stopped, || work(counted));
                // nobody listens any more where the user has stopped it
                let _ = sender.send(());
                result
            };
            let worker = Builder::new().stack_size(STACK).spawn_scoped(scope, job)?;
            let mut interrupted = None;
            while let Err(RecvTimeoutError::Timeout) = receiver.recv_timeout(TICK) {
                let heard = Python::attach(|py| py.check_signals().and_then(|()| tell(py)));
                if let Err(why) = heard {
                    stop.now();
                    interrupted = Some(why);
                    break;
                }
            }
            let result = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
            Ok::<_, std::io::Error>((result, interrupted))
        })
    });
    match done {
        Err(error) => Err(PyRuntimeError::new_err(format!("no thread could be started: {error}"))),
        Ok((_, Some(why))) => Err(why),
        Ok((None, None)) => Err(PyKeyboardInterrupt::new_err(())),
        Ok((Some(result), None)) => {
            let result = result.or_raise(py)?;
            tell(py)?;
            Ok(result)
        }
    }
}
