//! Asking a process to end its studies early, from a signal handler for one.

use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);

/// Lets every study of the process end at its next step; what is finished stays finished.
pub fn stop() {
    ASKED.store(true, Ordering::Relaxed);
}

/// Whether somebody has asked.
pub fn stop_asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
