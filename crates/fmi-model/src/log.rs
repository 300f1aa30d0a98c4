//! Messages of a model: their categories, who listens, and the [`Log`] that a model writes to.

use std::fmt;

/// The categories of messages that FMUs made with this crate declare, after the standard's names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Category {
    /// Explains a call that ended in a warning.
    StatusWarning,
    /// Explains a call that was discarded.
    StatusDiscard,
    /// Explains a call that ended in an error.
    StatusError,
    /// Explains a call that ended the instance.
    StatusFatal,
    /// Something noteworthy in the life of the model.
    Events,
    /// Every message there is.
    All,
}

impl Category {
    /// Every category, in the order of the description.
    pub const ALL: [Self; 6] = [
        Self::StatusWarning,
        Self::StatusDiscard,
        Self::StatusError,
        Self::StatusFatal,
        Self::Events,
        Self::All,
    ];

    /// The name under which hosts know it.
    pub fn name(self) -> &'static str {
        match self {
            Self::StatusWarning => "logStatusWarning",
            Self::StatusDiscard => "logStatusDiscard",
            Self::StatusError => "logStatusError",
            Self::StatusFatal => "logStatusFatal",
            Self::Events => "logEvents",
            Self::All => "logAll",
        }
    }

    /// The category with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|category| category.name() == name)
    }
}

/// What a host wants to hear.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted {
    events: bool,
    details: bool,
}

impl Wanted {
    /// Debug messages on or off; with categories, only those named. Status messages are wanted in any case.
    pub fn new(logging_on: bool, categories: &[Category]) -> Self {
        let wants = |category| {
            logging_on
                && (categories.is_empty() || categories.contains(&category) || categories.contains(&Category::All))
        };
        Self {
            events: wants(Category::Events),
            details: wants(Category::All),
        }
    }

    /// Whether messages of this category are wanted.
    pub fn wants(self, category: Category) -> bool {
        match category {
            Category::Events => self.events,
            Category::All => self.details,
            _ => true,
        }
    }
}

/// Who hears what a model says.
pub trait Listener: fmt::Debug {
    /// Whether messages of this category are wanted; those that are not are not even put together.
    fn wants(&self, category: Category) -> bool;

    /// Takes a message.
    fn hear(&self, category: Category, message: &dyn fmt::Display);
}

/// What a model says while it works. Errors are not logged here but returned.
///
/// Messages are built only if the host listens; pass `format_args!(...)`.
#[derive(Debug)]
pub struct Log<'a> {
    listener: Option<&'a dyn Listener>,
    warned: bool,
}

impl Log<'static> {
    /// A log that nobody listens to, for tests of a model without a host.
    pub fn silent() -> Self {
        Self {
            listener: None,
            warned: false,
        }
    }
}

impl<'a> Log<'a> {
    /// The log of one call.
    pub fn new(listener: &'a dyn Listener) -> Self {
        Self {
            listener: Some(listener),
            warned: false,
        }
    }

    /// Something is not quite right, but the computation goes on: always sent, and the call ends in a warning.
    pub fn warning(&mut self, message: impl fmt::Display) {
        self.warned = true;
        self.tell(Category::StatusWarning, message);
    }

    /// Something noteworthy: sent under `logEvents` while logging is on.
    pub fn event(&mut self, message: impl fmt::Display) {
        self.tell(Category::Events, message);
    }

    /// Something for whoever searches a mistake: sent under `logAll` while logging is on.
    pub fn detail(&mut self, message: impl fmt::Display) {
        self.tell(Category::All, message);
    }

    /// Whether there was a warning.
    pub fn warned(&self) -> bool {
        self.warned
    }

    fn tell(&self, category: Category, message: impl fmt::Display) {
        if let Some(listener) = self.listener.filter(|listener| listener.wants(category)) {
            listener.hear(category, &message);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn categories_choose_among_debug_messages_only() {
        let wanted = |on, categories: &[Category]| {
            let wanted = Wanted::new(on, categories);
            [Category::StatusWarning, Category::Events, Category::All].map(|category| wanted.wants(category))
        };
        assert_eq!(wanted(false, &[Category::All]), [true, false, false]);
        assert_eq!(wanted(true, &[]), [true, true, true]);
        assert_eq!(wanted(true, &[Category::Events]), [true, true, false]);
        assert_eq!(wanted(true, &[Category::StatusError]), [true, false, false]);
        assert_eq!(wanted(true, &[Category::All]), [true, true, true]);
    }
}
