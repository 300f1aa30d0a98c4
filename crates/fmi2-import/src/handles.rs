//! Saved states, which free themselves through the list of the instance that made them.
#![allow(unsafe_code, reason = "pointers of a C library go to other threads")]

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use fmi2_abi::Fmi2FmuState;

/// Where an instance is in its life cycle, as far as its end is concerned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Phase {
    /// Not yet stepping.
    Starting,
    /// Initialized, to be terminated before it is freed.
    Stepping,
    /// Terminated.
    Terminated,
    /// A call ended in an error; to be freed without further ado.
    Failed,
}

/// A saved state of the instance that made it. Its memory in the FMU is released after it is dropped.
#[derive(Debug)]
pub struct FmuState {
    pub(crate) handle: Handle,
    /// Where in its life cycle the instance was.
    pub(crate) phase: Phase,
    pub(crate) owner: Arc<Handles>,
}

impl Drop for FmuState {
    fn drop(&mut self) {
        self.owner.release(self.handle);
    }
}

/// The FMU's pointer to a saved state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Handle(pub(crate) Fmi2FmuState);

// SAFETY: the pointer is opaque here; it is only handed back to the FMU, by the one thread that holds the instance.
unsafe impl Send for Handle {}
// SAFETY: as above; a shared `Handle` gives no access to what it points to.
unsafe impl Sync for Handle {}

/// Every state that the FMU still holds memory for. Only the instance can free them, so dropped ones wait here.
#[derive(Debug, Default)]
pub(crate) struct Handles {
    list: Mutex<Vec<(Handle, InUse)>>,
}

type InUse = bool;

impl Handles {
    fn lock(&self) -> MutexGuard<'_, Vec<(Handle, InUse)>> {
        // Each change is one operation on the list, so a poisoned lock holds a usable value.
        self.list.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn add(&self, handle: Handle) {
        self.lock().push((handle, true));
    }

    fn release(&self, handle: Handle) {
        for (known, in_use) in self.lock().iter_mut() {
            if *known == handle {
                *in_use = false;
            }
        }
    }

    /// Removes and returns the handles that nobody uses any more.
    pub(crate) fn take_released(&self) -> Vec<Handle> {
        self.lock()
            .extract_if(.., |(_, in_use)| !*in_use)
            .map(|(handle, _)| handle)
            .collect()
    }

    /// Removes and returns all handles, for an instance that is about to be freed.
    pub(crate) fn take_all(&self) -> Vec<Handle> {
        self.lock().drain(..).map(|(handle, _)| handle).collect()
    }
}
