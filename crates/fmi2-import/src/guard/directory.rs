//! The working directory.

#[cfg(not(unix))]
mod plain {
    use std::path::PathBuf;

    /// `None` where there is none that could be gone back to.
    #[derive(Debug, Clone, PartialEq, Eq)]
    pub(in crate::guard) struct Directory(Option<PathBuf>);

    impl Directory {
        pub(in crate::guard) fn now() -> Self {
            Self(std::env::current_dir().ok())
        }

        pub(in crate::guard) fn is_still(&self) -> bool {
            *self == Self::now()
        }

        pub(in crate::guard) fn put_back(&self) {
            if let Some(path) = &self.0
                && !self.is_still()
            {
                // A directory that was removed meanwhile is nobody's any more.
                let _ = std::env::set_current_dir(path);
            }
        }
    }
}

#[cfg(unix)]
mod plain {
    use std::ffi::{CStr, CString, c_char};

    /// Empty where there is none that could be gone back to.
    #[derive(Debug, Clone, PartialEq, Eq)]
    pub(in crate::guard) struct Directory(CString);

    /// Hands the present path to `look`, without memory of its own, since this is done in every step.
    fn present<T>(look: impl FnOnce(&CStr) -> T) -> T {
        let mut room = std::mem::MaybeUninit::<[c_char; 4096]>::uninit();
        // SAFETY: there is room for as much as is said; what comes back is NUL-terminated, or null if the path is longer.
        let path = unsafe {
            let path = libc::getcwd(room.as_mut_ptr().cast(), size_of_val(&room));
            if path.is_null() { c"" } else { CStr::from_ptr(path) }
        };
        look(path)
    }

    impl Directory {
        pub(in crate::guard) fn now() -> Self {
            Self(present(CStr::to_owned))
        }

        pub(in crate::guard) fn is_still(&self) -> bool {
            present(|now| now == &*self.0)
        }

        pub(in crate::guard) fn put_back(&self) {
            if !self.0.is_empty() && !self.is_still() {
                // A directory that was removed meanwhile is nobody's any more.
                // SAFETY: a NUL-terminated path.
                unsafe { libc::chdir(self.0.as_ptr()) };
            }
        }
    }
}

pub(super) use plain::Directory;
