//! Saved states. A state may be set on any instance of the same FMU.

use std::ptr;

use fmi_model::Snapshot;
use fmi2_abi::{Fmi2Byte, Fmi2Component, Fmi2FmuState, Fmi2Status, RawStatus};

use super::call::call;
use super::handle::SavedState;
use super::memory;
use crate::error::CallError;
use crate::identity::{Exported, own_guid, seal};
use crate::order;

/// The state behind the argument `FMUstate`.
///
/// # Safety
/// `state` is null or a state that lives through `'a`; see the module.
unsafe fn saved<'a, M: Exported>(state: Fmi2FmuState) -> Result<&'a SavedState<M>, CallError> {
    // SAFETY: the caller vouches for the same.
    unsafe { SavedState::<M>::recognise(state) }.ok_or(CallError::ForeignState { argument: "FMUstate" })
}

/// A handle that is not null is filled anew.
pub unsafe fn get_fmu_state<M: Exported>(component: Fmi2Component, state: *mut Fmi2FmuState) -> RawStatus {
    // SAFETY: `state` points to null or to a state of this FMU; see the module.
    unsafe {
        call::<M>(component, &order::GET_FMU_STATE, |instance| {
            let handle = memory::array("FMUstate", state.cast_const(), 1)?[0];
            if handle.is_null() {
                let snapshot = instance.state().clone();
                state.write(SavedState::into_raw(own_guid::<M>()?, snapshot));
            } else {
                saved::<M>(handle)?;
                SavedState::<M>::replace(handle, instance.state().clone());
            }
            Ok(Fmi2Status::Ok)
        })
    }
}

pub unsafe fn set_fmu_state<M: Exported>(component: Fmi2Component, state: Fmi2FmuState) -> RawStatus {
    // SAFETY: see the module.
    unsafe {
        call::<M>(component, &order::SET_FMU_STATE, |instance| {
            instance.set_state(&saved::<M>(state)?.snapshot)
        })
    }
}

/// Sets the handle to null. A handle that is null already is fine.
pub unsafe fn free_fmu_state<M: Exported>(component: Fmi2Component, state: *mut Fmi2FmuState) -> RawStatus {
    // SAFETY: `state` points to null or to a state of this FMU, which is not used afterwards; see the module.
    unsafe {
        call::<M>(component, &order::FREE_FMU_STATE, |_| {
            let handle = memory::array("FMUstate", state.cast_const(), 1)?[0];
            if !handle.is_null() {
                saved::<M>(handle)?;
                state.write(ptr::null_mut());
                SavedState::<M>::free(handle);
            }
            Ok(Fmi2Status::Ok)
        })
    }
}

pub unsafe fn serialized_fmu_state_size<M: Exported>(
    component: Fmi2Component,
    state: Fmi2FmuState,
    size: *mut usize,
) -> RawStatus {
    // SAFETY: `size` points to room for one value; see the module.
    unsafe {
        call::<M>(component, &order::SERIALIZED_FMU_STATE_SIZE, |_| {
            let size = memory::place("size", size)?;
            size.write(saved::<M>(state)?.snapshot.to_bytes(&seal::<M>()?)?.len());
            Ok(Fmi2Status::Ok)
        })
    }
}

/// A buffer larger than needed is fine; the rest of it is left alone.
pub unsafe fn serialize_fmu_state<M: Exported>(
    component: Fmi2Component,
    state: Fmi2FmuState,
    buffer: *mut Fmi2Byte,
    size: usize,
) -> RawStatus {
    // SAFETY: `buffer` has room for `size` bytes; see the module.
    unsafe {
        call::<M>(component, &order::SERIALIZE_FMU_STATE, |_| {
            let bytes = saved::<M>(state)?.snapshot.to_bytes(&seal::<M>()?)?;
            let buffer = memory::room("serializedState", buffer.cast::<u8>(), size)?;
            if buffer.len() < bytes.len() {
                return Err(CallError::BufferTooSmall {
                    needed: bytes.len(),
                    given: buffer.len(),
                });
            }
            for (place, byte) in buffer.iter_mut().zip(bytes) {
                place.write(byte);
            }
            Ok(Fmi2Status::Ok)
        })
    }
}

/// Always makes a new state: what `state` points to before the call is not looked at, since hosts need not initialise it.
pub unsafe fn de_serialize_fmu_state<M: Exported>(
    component: Fmi2Component,
    bytes: *const Fmi2Byte,
    size: usize,
    state: *mut Fmi2FmuState,
) -> RawStatus {
    // SAFETY: `bytes` has `size` bytes, `state` points to room for one handle; see the module.
    unsafe {
        call::<M>(component, &order::DE_SERIALIZE_FMU_STATE, |_| {
            let bytes = memory::array("serializedState", bytes.cast::<u8>(), size)?;
            let state = memory::place("FMUstate", state)?;
            let seal = seal::<M>()?;
            let snapshot = Snapshot::<M>::from_bytes(bytes, &seal)?;
            state.write(SavedState::into_raw(seal.guid, snapshot));
            Ok(Fmi2Status::Ok)
        })
    }
}
