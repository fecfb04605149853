//! A bar on stderr for what takes longer than a second, on a terminal only.

use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Counts finished tasks.
pub struct Progress(ProgressBar);

impl Progress {
    /// Of `count` tasks; nothing is seen of it in the first second, nor where stderr is no
    /// terminal.
    pub fn new(what: &'static str, count: usize) -> Self {
        let bar = ProgressBar::with_draw_target(Some(count as u64), ProgressDrawTarget::stderr_with_hz(5));
        if let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {pos}/{len}, {eta} left") {
            bar.set_style(style);
        }
        bar.set_message(what);
        Progress(bar)
    }

    /// Of tasks that nobody can count beforehand.
    pub fn open(what: &'static str) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(5));
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
