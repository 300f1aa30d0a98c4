//! The log of one instance.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

use fmi_model::{Category, Listener, Wanted};

use crate::status::Status;
use crate::version::Sink;

/// Where messages go, and which of them the host wants: none while logging is off.
#[derive(Debug, Clone)]
pub(crate) struct Logger<S> {
    sink: S,
    /// [`Wanted`], as last set; all clones share it, so that a call can be refused while another is under way.
    wanted: Arc<AtomicU8>,
}

impl<S: Sink> Logger<S> {
    /// Every category while logging is on.
    pub(crate) fn new(sink: S, on: bool) -> Self {
        let wanted = Arc::new(AtomicU8::new(Wanted::new(on, &[]).to_bits()));
        Self { sink, wanted }
    }

    /// On or off; with categories, messages of those only.
    pub(crate) fn want(&self, on: bool, categories: &[Category]) {
        self.wanted
            .store(Wanted::new(on, categories).to_bits(), Ordering::Relaxed);
    }

    /// Sends what explains `status`, if it is to be heard.
    pub(crate) fn explain(&self, status: Status, message: &dyn fmt::Display) {
        if self.wants(status.category()) {
            self.sink.send(status, status.category(), message);
        }
    }
}

impl<S: Sink> Listener for Logger<S> {
    fn wants(&self, category: Category) -> bool {
        self.sink.has_listener() && Wanted::from_bits(self.wanted.load(Ordering::Relaxed)).wants(category)
    }

    fn hear(&self, category: Category, message: &dyn fmt::Display) {
        self.sink.send(Status::of(category), category, message);
    }
}
