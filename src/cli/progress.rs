//! A bar on stderr for what takes longer than a second, on a terminal only.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

/// Whether bars are to be seen at all.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// No bars from now on.
pub fn be_quiet() {
    IS_QUIET.store(true, Ordering::Relaxed);
}

/// Five times a second on stderr, where that is a terminal.
fn target() -> ProgressDrawTarget {
    match IS_QUIET.load(Ordering::Relaxed) {
        true => ProgressDrawTarget::hidden(),
        false => ProgressDrawTarget::stderr_with_hz(5),
    }
}

/// Draws a bar once a second from the second second on, also while no task gets done.
fn tick(bar: &ProgressBar) {
    if bar.is_hidden() {
        return;
    }
    let bar = bar.downgrade();
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_secs(1));
        if let Some(bar) = bar.upgrade().filter(|bar| !bar.is_finished()) {
            bar.enable_steady_tick(Duration::from_secs(1));
        }
    });
}

/// How long the rest takes, which nobody knows before a task is done; while there is a rest, it is
/// not nothing.
fn left(done: u64, estimate: Duration, elapsed: Duration) -> String {
    match done {
        0 => format!("{} so far", HumanDuration(elapsed)),
        _ => format!("about {} left", HumanDuration(estimate.max(Duration::from_secs(1)))),
    }
}

/// Counts finished tasks.
pub struct Progress(ProgressBar);

impl Progress {
    /// Of `count` tasks; nothing is seen of it in the first second, nor where stderr is no
    /// terminal.
    pub fn new(what: &'static str, count: usize) -> Self {
        let bar = ProgressBar::with_draw_target(Some(count as u64), target());
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {pos}/{len}, {left}") {
            let said = |state: &ProgressState, line: &mut dyn std::fmt::Write| {
                // a line that cannot be written is none
                let _ = line.write_str(&left(state.pos(), state.eta(), state.elapsed()));
            };
            bar.set_style(style.with_key("left", said));
        }
        bar.set_message(what);
        tick(&bar);
        Progress(bar)
    }

    /// Of tasks that nobody can count beforehand.
    pub fn open(what: &'static str) -> Self {
        let bar = ProgressBar::with_draw_target(None, target());
        if let Ok(style) = ProgressStyle::with_template("{msg}: {pos} looked at, {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(what);
        tick(&bar);
        Progress(bar)
    }

    /// One task is done.
    pub fn one_more(&self) {
        self.more(1);
    }

    /// So many tasks more are done.
    pub fn more(&self, count: u64) {
        // a bar that flashes up for work of a blink only startles
        if self.0.elapsed() > Duration::from_secs(1) {
            self.0.inc(count);
        } else {
            self.0.update(|state| state.set_pos(state.pos() + count));
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_not_said_before_a_task_is_done_and_is_never_nothing() {
        let seconds = Duration::from_secs;
        assert_eq!(left(0, seconds(0), seconds(12)), "12 seconds so far");
        assert_eq!(left(3, Duration::from_millis(20), seconds(12)), "about 1 second left");
        assert_eq!(left(3, seconds(600), seconds(12)), "about 10 minutes left");
    }
}
