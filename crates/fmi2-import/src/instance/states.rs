//! Saving, setting and carrying states.

use std::ffi::c_char;
use std::sync::Arc;

use fmi2_abi::Fmi2FmuState;

use super::Instance;
use crate::ImportError;
use crate::handles::{FmuState, Handle, Phase};
use crate::library::{SerializationFunctions, StateFunctions};

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
}
