//! Pointers of the host become references and slices, checked as far as pointers can be checked.
#![allow(unsafe_code, reason = "raw pointers come in, slices and references go on")]

use std::ffi::{CStr, c_char};
use std::mem::MaybeUninit;
use std::slice;

use crate::error::CallError;

/// An array that the host gives. A null pointer is fine for no elements.
///
/// # Errors
/// A null or misaligned pointer, or a length beyond memory.
///
/// # Safety
/// Unless null or misaligned, `pointer` points to `length` values that nobody writes to during `'a`.
pub unsafe fn array<'a, T>(argument: &'static str, pointer: *const T, length: usize) -> Result<&'a [T], CallError> {
    if length == 0 {
        return Ok(&[]);
    }
    check::<T>(argument, pointer, length)?;
    // SAFETY: not null, aligned, of a length that fits into memory, and the caller vouches for the rest.
    Ok(unsafe { slice::from_raw_parts(pointer, length) })
}

/// An array that the host wants filled. A null pointer is fine for no elements.
///
/// # Errors
/// As for [`array()`].
///
/// # Safety
/// Unless null or misaligned, `pointer` points to room for `length` values that nobody else uses during `'a`.
pub unsafe fn room<'a, T>(
    argument: &'static str,
    pointer: *mut T,
    length: usize,
) -> Result<&'a mut [MaybeUninit<T>], CallError> {
    if length == 0 {
        return Ok(&mut []);
    }
    check::<T>(argument, pointer, length)?;
    // SAFETY: as in `array`; that the memory may not be initialised is what `MaybeUninit` says.
    Ok(unsafe { slice::from_raw_parts_mut(pointer.cast::<MaybeUninit<T>>(), length) })
}

/// Room for one value.
///
/// # Errors
/// A null or misaligned pointer.
///
/// # Safety
/// As for [`room`], with a length of 1.
pub unsafe fn place<'a, T>(argument: &'static str, pointer: *mut T) -> Result<&'a mut MaybeUninit<T>, CallError> {
    check::<T>(argument, pointer, 1)?;
    // SAFETY: as in `room`.
    Ok(unsafe { &mut *pointer.cast::<MaybeUninit<T>>() })
}

/// A text that the host gives.
///
/// # Errors
/// A null pointer, or a text that is not UTF-8.
///
/// # Safety
/// Unless null, `pointer` points to a NUL-terminated text that nobody writes to during `'a`.
pub unsafe fn text<'a>(argument: &'static str, pointer: *const c_char) -> Result<&'a str, CallError> {
    check::<c_char>(argument, pointer, 1)?;
    // SAFETY: not null, and the caller vouches for the terminating NUL.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| CallError::NotUtf8 { argument })
}

fn check<T>(argument: &'static str, pointer: *const T, length: usize) -> Result<(), CallError> {
    if pointer.is_null() || !pointer.is_aligned() {
        return Err(CallError::BadPointer { argument });
    }
    let bytes = length.checked_mul(size_of::<T>());
    if bytes.is_none_or(|bytes| isize::try_from(bytes).is_err()) {
        return Err(CallError::TooLong { argument, length });
    }
    Ok(())
}
