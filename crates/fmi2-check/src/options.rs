//! What a caller can choose.

use std::fmt;
use std::process::Command;
use std::time::Duration;

/// How libraries are run.
pub struct Running {
    /// Makes a process that calls [`crate::serve`] with the last two words of its command line, which are added to these.
    pub program: Box<dyn Fn() -> Command>,
    /// The longest that one trial may take; wrong calls are waited for a few seconds only.
    pub limit: Duration,
    /// Whether FMUs are run that need a tool (`needsExecutionTool`), which has to be installed.
    pub with_tool: bool,
}

impl Running {
    /// The usual limit.
    pub const LIMIT: Duration = Duration::from_secs(60);
}

impl fmt::Debug for Running {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Running")
            .field("limit", &self.limit)
            .field("with_tool", &self.with_tool)
            .finish_non_exhaustive()
    }
}
