//! Saved states. A state may be set on any instance of the same FMU; the same library packed with something else is another one.
#![allow(unsafe_code, reason = "opaque pointers come in, references go on")]

use std::ffi::{c_int, c_void};
use std::ptr;

use fmi_model::Snapshot;

use crate::call::call;
use crate::error::CallError;
use crate::handle::SavedState;
use crate::identity::{Exported, seal};
use crate::instance::Instance;
use crate::memory;
use crate::order::Function;
use crate::status::Status;
use crate::version::Version;

/// The state behind an argument, of the same FMU as `instance`.
///
/// # Safety
/// `state` is null or a state that lives through `'a`.
unsafe fn saved<'a, V: Version, M: Exported<V>>(
    instance: &Instance<V, M>,
    state: *mut c_void,
) -> Result<&'a SavedState<M>, CallError> {
    // SAFETY: the caller vouches for the same.
    unsafe { SavedState::<M>::recognise::<V>(state, instance.identity()) }
        .ok_or(CallError::ForeignState { argument: V::STATE })
}

/// Saves the state. A handle that is not null is filled anew.
///
/// # Safety
/// As for [`call`]; `state` points to null or to a state of this FMU.
pub unsafe fn get_fmu_state<V: Version, M: Exported<V>>(
    component: *mut c_void,
    function: &Function,
    state: *mut *mut c_void,
) -> c_int {
    // SAFETY: `state` points to null or to a state of this FMU.
    unsafe {
        call::<V, M>(component, function, |instance| {
            let handle = memory::array(V::STATE, state.cast_const(), 1)?[0];
            if handle.is_null() {
                let snapshot = instance.state().clone();
                state.write(SavedState::into_raw::<V>(instance.identity(), snapshot)?);
            } else {
                saved::<V, M>(instance, handle)?;
                SavedState::<M>::replace(handle, instance.state().clone());
            }
            Ok(Status::Ok)
        })
    }
}

/// Goes to a saved state.
///
/// # Safety
/// As for [`call`]; `state` is null or a state.
pub unsafe fn set_fmu_state<V: Version, M: Exported<V>>(
    component: *mut c_void,
    function: &Function,
    state: *mut c_void,
) -> c_int {
    // SAFETY: the caller vouches for the same.
    unsafe {
        call::<V, M>(component, function, |instance| {
            instance.set_state(&saved::<V, M>(instance, state)?.snapshot)
        })
    }
}

/// Frees a state and sets the handle to null. A handle that is null already is fine.
///
/// # Safety
/// As for [`call`]; `state` points to null or to a state of this FMU, which is not used afterwards.
pub unsafe fn free_fmu_state<V: Version, M: Exported<V>>(
    component: *mut c_void,
    function: &Function,
    state: *mut *mut c_void,
) -> c_int {
    // SAFETY: `state` points to null or to a state of this FMU, which is not used afterwards.
    unsafe {
        call::<V, M>(component, function, |instance| {
            let handle = memory::array(V::STATE, state.cast_const(), 1)?[0];
            if !handle.is_null() {
                saved::<V, M>(instance, handle)?;
                state.write(ptr::null_mut());
                SavedState::<M>::free(handle);
            }
            Ok(Status::Ok)
        })
    }
}

/// How many bytes a state makes.
///
/// # Safety
/// As for [`call`]; `state` is null or a state, `size` points to room for one value.
pub unsafe fn serialized_fmu_state_size<V: Version, M: Exported<V>>(
    component: *mut c_void,
    function: &Function,
    state: *mut c_void,
    size: *mut usize,
) -> c_int {
    // SAFETY: `size` points to room for one value.
    unsafe {
        call::<V, M>(component, function, |instance| {
            let size = memory::place("size", size)?;
            size.write(
                saved::<V, M>(instance, state)?
                    .snapshot
                    .to_bytes(&seal::<V>(instance.identity()))?
                    .len(),
            );
            Ok(Status::Ok)
        })
    }
}

/// Writes a state as bytes. A buffer larger than needed is fine; the rest of it is left alone.
///
/// # Safety
/// As for [`call`]; `state` is null or a state, `buffer` has room for `size` bytes.
pub unsafe fn serialize_fmu_state<V: Version, M: Exported<V>>(
    component: *mut c_void,
    function: &Function,
    state: *mut c_void,
    buffer: *mut u8,
    size: usize,
) -> c_int {
    // SAFETY: `buffer` has room for `size` bytes.
    unsafe {
        call::<V, M>(component, function, |instance| {
            let bytes = saved::<V, M>(instance, state)?
                .snapshot
                .to_bytes(&seal::<V>(instance.identity()))?;
            let buffer = memory::room("serializedState", buffer, size)?;
            if buffer.len() < bytes.len() {
                return Err(CallError::BufferTooSmall {
                    needed: bytes.len(),
                    given: buffer.len(),
                });
            }
            for (place, byte) in buffer.iter_mut().zip(bytes) {
                place.write(byte);
            }
            Ok(Status::Ok)
        })
    }
}

/// Reads a state from bytes. Always makes a new one: what `state` points to before the call is not looked at, since hosts need not
/// initialise it.
///
/// # Safety
/// As for [`call`]; `bytes` has `size` bytes, `state` points to room for one handle.
pub unsafe fn de_serialize_fmu_state<V: Version, M: Exported<V>>(
    component: *mut c_void,
    function: &Function,
    bytes: *const u8,
    size: usize,
    state: *mut *mut c_void,
) -> c_int {
    // SAFETY: `bytes` has `size` bytes, `state` points to room for one handle.
    unsafe {
        call::<V, M>(component, function, |instance| {
            let bytes = memory::array("serializedState", bytes, size)?;
            let state = memory::place(V::STATE, state)?;
            let seal = seal::<V>(instance.identity());
            let snapshot = Snapshot::<M>::from_bytes(bytes, &seal)?;
            state.write(SavedState::into_raw::<V>(seal.guid, snapshot)?);
            Ok(Status::Ok)
        })
    }
}
