//! How a call ends, in every standard.

use std::ffi::c_int;

use fmi_model::Category;

/// How a call ended. FMI 2.0 and 3.0 give the same numbers to the same words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// All well.
    Ok = 0,
    /// Not quite right, but the computation can go on.
    Warning = 1,
    /// The request could not be answered; the instance is as before.
    Discard = 2,
    /// An error; only this instance is concerned.
    Error = 3,
    /// An error after which the instance can no longer be used.
    Fatal = 4,
}

impl Status {
    /// The number that crosses the boundary.
    pub const fn raw(self) -> c_int {
        self as c_int
    }

    /// The category of messages that explain it.
    pub const fn category(self) -> Category {
        match self {
            Self::Ok => Category::Events,
            Self::Warning => Category::StatusWarning,
            Self::Discard => Category::StatusDiscard,
            Self::Error => Category::StatusError,
            Self::Fatal => Category::StatusFatal,
        }
    }

    /// The status that messages of a category come with.
    pub const fn of(category: Category) -> Self {
        match category {
            Category::StatusWarning => Self::Warning,
            Category::StatusDiscard => Self::Discard,
            Category::StatusError => Self::Error,
            Category::StatusFatal => Self::Fatal,
            Category::Events | Category::All => Self::Ok,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_status_and_its_category_name_each_other() {
        for status in [
            Status::Ok,
            Status::Warning,
            Status::Discard,
            Status::Error,
            Status::Fatal,
        ] {
            assert_eq!(Status::of(status.category()), status);
        }
        assert_eq!(Status::of(Category::All), Status::Ok);
    }
}
