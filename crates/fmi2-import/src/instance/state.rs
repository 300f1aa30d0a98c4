//! Saved states of an instance, which free themselves.

use std::ffi::c_char;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use fmi2_abi::Fmi2FmuState;

use super::{Instance, Phase};
use crate::ImportError;
use crate::library::{SerializationFunctions, StateFunctions};

/// A saved state of the instance that made it. Its memory in the FMU is released after it is dropped.
#[derive(Debug)]
pub struct FmuState {
    handle: Handle,
    /// Where in its life cycle the instance was.
    phase: Phase,
    owner: Arc<Handles>,
}

impl Drop for FmuState {
    fn drop(&mut self) {
        self.owner.release(self.handle);
    }
}

/// The FMU's pointer to a saved state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Handle(Fmi2FmuState);

// SAFETY: the pointer is opaque here; it is only handed back to the FMU, by the one thread that holds the instance.
unsafe impl Send for Handle {}
// SAFETY: as above; a shared `Handle` gives no access to what it points to.
unsafe impl Sync for Handle {}

/// Every state that the FMU still holds memory for. Only the instance can free them, so dropped ones wait here.
#[derive(Debug, Default)]
pub(super) struct Handles {
    list: Mutex<Vec<(Handle, InUse)>>,
}

type InUse = bool;

impl Handles {
    fn lock(&self) -> MutexGuard<'_, Vec<(Handle, InUse)>> {
        // Each change is one operation on the list, so a poisoned lock holds a usable value.
        self.list.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn add(&self, handle: Handle) {
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
    fn take_released(&self) -> Vec<Handle> {
        self.lock()
            .extract_if(.., |(_, in_use)| !*in_use)
            .map(|(handle, _)| handle)
            .collect()
    }

    /// Removes and returns all handles, for an instance that is about to be freed.
    pub(super) fn take_all(&self) -> Vec<Handle> {
        self.lock().drain(..).map(|(handle, _)| handle).collect()
    }
}

impl Instance {
    /// `fmi2GetFMUstate`: everything the instance needs to go on from here.
    ///
    /// # Errors
    /// [`ImportError::Call`], [`ImportError::Unusable`] or [`ImportError::NotOffered`].
    pub fn get_state(&mut self) -> Result<FmuState, ImportError> {
        const FUNCTION: &str = "fmi2GetFMUstate";
        let functions = self.state_functions(FUNCTION)?;
        self.free_released_states();
        let mut handle: Fmi2FmuState = std::ptr::null_mut();
        // SAFETY: a null handle asks the FMU to create a state.
        self.call(FUNCTION, |component| unsafe {
            (functions.get)(component, &raw mut handle)
        })?;
        Ok(self.keep(handle, self.phase))
    }

    /// `fmi2SetFMUstate`: back to a state that this instance saved.
    ///
    /// # Errors
    /// [`ImportError::Call`], [`ImportError::Unusable`], [`ImportError::NotOffered`] or [`ImportError::ForeignState`].
    pub fn set_state(&mut self, state: &FmuState) -> Result<(), ImportError> {
        const FUNCTION: &str = "fmi2SetFMUstate";
        let functions = self.state_functions(FUNCTION)?;
        self.check_owner(state)?;
        // SAFETY: the handle was made by this instance and is not freed before `state` is dropped.
        self.call(FUNCTION, |component| unsafe {
            (functions.set)(component, state.handle.0)
        })?;
        self.phase = state.phase;
        Ok(())
    }

    /// `fmi2SerializeFMUstate`: a saved state as bytes, to be kept or handed to another instance of the same FMU.
    ///
    /// # Errors
    /// As [`Instance::set_state`].
    pub fn serialize_state(&mut self, state: &FmuState) -> Result<Vec<u8>, ImportError> {
        let functions = self.serialization_functions("fmi2SerializeFMUstate")?;
        self.check_owner(state)?;
        let handle = state.handle.0;
        let mut size = 0;
        self.call("fmi2SerializedFMUstateSize", |component| {
            // SAFETY: the handle was made by this instance and is not freed before `state` is dropped.
            unsafe { (functions.size)(component, handle, &raw mut size) }
        })?;
        let mut bytes = vec![0_u8; size];
        self.call("fmi2SerializeFMUstate", |component| {
            // SAFETY: as above; the buffer has the size that is passed.
            unsafe { (functions.serialize)(component, handle, bytes.as_mut_ptr().cast::<c_char>(), size) }
        })?;
        Ok(bytes)
    }

    /// `fmi2DeSerializeFMUstate`: a state from the bytes of [`Instance::serialize_state`]; follow with
    /// [`Instance::set_state`].
    ///
    /// # Errors
    /// [`ImportError::Call`], [`ImportError::Unusable`] or [`ImportError::NotOffered`].
    pub fn deserialize_state(&mut self, bytes: &[u8]) -> Result<FmuState, ImportError> {
        const FUNCTION: &str = "fmi2DeSerializeFMUstate";
        let functions = self.serialization_functions(FUNCTION)?;
        self.free_released_states();
        let mut handle: Fmi2FmuState = std::ptr::null_mut();
        self.call(FUNCTION, |component| {
            // SAFETY: the bytes have the length that is passed; a null handle asks the FMU to create a state.
            unsafe { (functions.deserialize)(component, bytes.as_ptr().cast::<c_char>(), bytes.len(), &raw mut handle) }
        })?;
        // The bytes do not tell us the phase. If the guess is wrong, the terminate that precedes freeing is refused.
        Ok(self.keep(handle, Phase::Stepping))
    }

    fn keep(&mut self, handle: Fmi2FmuState, phase: Phase) -> FmuState {
        self.saved = true;
        let handle = Handle(handle);
        self.handles.add(handle);
        FmuState {
            handle,
            phase,
            owner: Arc::clone(&self.handles),
        }
    }

    fn check_owner(&self, state: &FmuState) -> Result<(), ImportError> {
        if Arc::ptr_eq(&state.owner, &self.handles) {
            Ok(())
        } else {
            Err(ImportError::ForeignState {
                instance: self.name.clone(),
            })
        }
    }

    fn state_functions(&self, function: &'static str) -> Result<StateFunctions, ImportError> {
        self.binary.functions.states.ok_or_else(|| ImportError::NotOffered {
            instance: self.name.clone(),
            function,
            flag: "canGetAndSetFMUstate",
        })
    }

    fn serialization_functions(&self, function: &'static str) -> Result<SerializationFunctions, ImportError> {
        // A deserialized state is freed by one of the state functions.
        self.state_functions(function)?;
        self.binary
            .functions
            .serialization
            .ok_or_else(|| ImportError::NotOffered {
                instance: self.name.clone(),
                function,
                flag: "canSerializeFMUstate",
            })
    }

    /// Frees the memory of states that were dropped. A failure is of no interest to the call that follows.
    fn free_released_states(&mut self) {
        for handle in self.handles.take_released() {
            self.free_state(handle);
        }
    }

    pub(super) fn free_state(&mut self, handle: Handle) {
        if let Some(functions) = self.binary.functions.states {
            let mut raw = handle.0;
            // SAFETY: the handle was made by this instance, and nobody else holds it any more.
            let _ = self.call("fmi2FreeFMUstate", |component| unsafe {
                (functions.free)(component, &raw mut raw)
            });
        }
    }
}
