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

    fn bit(self) -> u8 {
        1 << self as u8
    }

    /// The category with this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|category| category.name() == name)
    }
}

/// What a host wants to hear: nothing while logging is off.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wanted(u8);

impl Wanted {
    /// Everything if logging is on; with categories, only those named.
    pub fn new(logging_on: bool, categories: &[Category]) -> Self {
        let all = categories.is_empty() || categories.contains(&Category::All);
        let wanted = Category::ALL
            .into_iter()
            .filter(|category| logging_on && (all || categories.contains(category)));
        Self(wanted.fold(0, |bits, category| bits | category.bit()))
    }

    /// Whether messages of this category are wanted.
    pub fn wants(self, category: Category) -> bool {
        self.0 & category.bit() != 0
    }

    /// The same as a number, to be kept in an atomic.
    pub fn to_bits(self) -> u8 {
        self.0
    }

    /// What [`to_bits`](Self::to_bits) has made a number of.
    pub fn from_bits(bits: u8) -> Self {
        Self(bits)
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

    /// Something is not quite right, but the computation goes on: sent under `logStatusWarning` while logging is on, and the call ends
    /// in a warning in any case.
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
    fn categories_choose_among_messages() {
        let wanted = |on, categories: &[Category]| {
            let wanted = Wanted::new(on, categories);
            assert_eq!(Wanted::from_bits(wanted.to_bits()), wanted);
            [
                Category::StatusWarning,
                Category::StatusError,
                Category::Events,
                Category::All,
            ]
            .map(|category| wanted.wants(category))
        };
        assert_eq!(wanted(false, &[]), [false; 4]);
        assert_eq!(wanted(false, &[Category::All]), [false; 4]);
        assert_eq!(wanted(true, &[]), [true; 4]);
        assert_eq!(wanted(true, &[Category::All]), [true; 4]);
        assert_eq!(wanted(true, &[Category::Events]), [false, false, true, false]);
        assert_eq!(wanted(true, &[Category::StatusError]), [false, true, false, false]);
        assert_eq!(
            wanted(true, &[Category::StatusError, Category::StatusWarning]),
            [true, true, false, false]
        );
    }
}
