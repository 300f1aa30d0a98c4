//! The locales of process and thread, by which C formats and reads numbers.

use std::ffi::{CStr, CString, c_char};

/// A locale of the process by the place of its name, which changes with it. Nothing is read there: another thread may set a
/// locale at any time, and the name goes with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place(usize);

impl Place {
    pub(super) fn now() -> Self {
        Self(current() as usize)
    }
}

fn current() -> *const c_char {
    // SAFETY: null asks for the name and changes nothing.
    unsafe { libc::setlocale(libc::LC_ALL, std::ptr::null()) }
}

/// The locale of the process.
#[derive(Debug, Clone)]
pub(super) struct Locale {
    place: Place,
    name: CString,
}

impl Locale {
    /// To be called while no library is, which could change it meanwhile.
    pub(super) fn now() -> Self {
        let name = current();
        // SAFETY: NUL-terminated if there is one, and copied before the locale is changed.
        let text = unsafe { (!name.is_null()).then(|| CStr::from_ptr(name)) };
        Self {
            place: Place(name as usize),
            name: text.map(CStr::to_owned).unwrap_or_default(),
        }
    }

    pub(super) fn place(&self) -> Place {
        self.place
    }

    pub(super) fn put_back(&self) {
        // SAFETY: a NUL-terminated name, which the function copies.
        unsafe { libc::setlocale(libc::LC_ALL, self.name.as_ptr()) };
    }

    /// The same after it was put back, which gives its name a new place.
    pub(super) fn put_back_at(&self) -> Self {
        Self {
            place: Place::now(),
            name: self.name.clone(),
        }
    }
}

/// The locale of the thread alone, if it has one.
#[derive(Debug, Clone, Copy)]
pub(super) struct ThreadLocale(libc::locale_t);

impl ThreadLocale {
    pub(super) fn now() -> Self {
        // SAFETY: null asks and changes nothing.
        Self(unsafe { libc::uselocale(std::ptr::null_mut()) })
    }

    pub(super) fn put_back(self) {
        if Self::now().0 != self.0 {
            // SAFETY: the locale was in use by this thread a moment ago, and who made it has had no reason to free it.
            unsafe { libc::uselocale(self.0) };
        }
    }
}
