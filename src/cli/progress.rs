//! A bar on stderr for what takes longer than a second, on a terminal only.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

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

/// Counts finished tasks.
pub struct Progress(ProgressBar);

impl Progress {
    /// Of `count` tasks; nothing is seen of it in the first second, nor where stderr is no
    /// terminal.
    pub fn new(what: &'static str, count: usize) -> Self {
        let bar = ProgressBar::with_draw_target(Some(count as u64), target());
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {pos}/{len}, {eta} left") {
            bar.set_style(style);
        }
        bar.set_message(what);
        Progress(bar)
    }

    /// Of tasks that nobody can count beforehand.
    pub fn open(what: &'static str) -> Self {
        let bar = ProgressBar::with_draw_target(None, target());
        if let Ok(style) = ProgressStyle::with_template("{msg}: {pos} looked at, {elapsed}") {
            bar.set_style(style);
        }
        bar.set_message(what);
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
