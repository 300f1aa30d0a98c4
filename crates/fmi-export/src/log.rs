//! The log of one instance.

use std::fmt;

use fmi_model::{Category, Listener, Wanted};

use crate::status::Status;
use crate::version::Sink;

/// Where messages go, and which of them the host wants.
#[derive(Debug, Clone)]
pub(crate) struct Logger<S> {
    pub(crate) sink: S,
    on: bool,
    wanted: Wanted,
}

impl<S: Sink> Logger<S> {
    /// Every category while logging is on.
    pub(crate) fn new(sink: S, on: bool) -> Self {
        let wanted = Wanted::new(on, &[]);
        Self { sink, on, wanted }
    }

    /// On or off; with categories, debug messages of those only.
    pub(crate) fn want(&mut self, on: bool, categories: &[Category]) {
        self.on = on;
        self.wanted = Wanted::new(on, categories);
    }

    /// Sends what explains `status`, if it is to be heard.
    pub(crate) fn explain(&self, status: Status, message: &dyn fmt::Display) {
        if self.wants(status.category()) {
            self.sink.explain(status, message);
        }
    }
}

impl<S: Sink> Listener for Logger<S> {
    fn wants(&self, category: Category) -> bool {
        if self.on {
            self.wanted.wants(category)
        } else {
            S::always_sent(category)
        }
    }

    fn hear(&self, category: Category, message: &dyn fmt::Display) {
        self.sink.send(Status::of(category), category, message);
    }
}
