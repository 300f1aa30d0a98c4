//! The clock that times slaves.

use std::time::Duration;

/// CPU time of this thread since some moment.
#[cfg(unix)]
pub(crate) fn now() -> Duration {
    use rustix::time::{ClockId, clock_gettime};

    let time = clock_gettime(ClockId::ThreadCPUTime);
    // Both parts are positive, the latter below a second.
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}

/// Time on the wall since the first call: what Windows knows of a thread's CPU time moves on by 15 ms.
#[cfg(not(unix))]
pub(crate) fn now() -> Duration {
    use std::sync::LazyLock;
    use std::time::Instant;

    static FIRST: LazyLock<Instant> = LazyLock::new(Instant::now);
    FIRST.elapsed()
}
