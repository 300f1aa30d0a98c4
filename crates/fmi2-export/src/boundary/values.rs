//! Getting and setting variables.

use std::ffi::CString;

use fmi_export::{CallError, Exported, Function, call, memory};
use fmi_model::{Checked, Scalar};
use fmi2_abi::{
    Fmi2Boolean, Fmi2Component, Fmi2Integer, Fmi2Real, Fmi2String, Fmi2ValueReference, RawStatus, boolean, truth,
};

use crate::order;
use crate::version::Fmi2;

/// Reads variables whose values are `T` in Rust and `C` in C.
unsafe fn get<M: Exported<Fmi2>, T: Scalar, C>(
    component: Fmi2Component,
    function: &Function,
    references: *const Fmi2ValueReference,
    count: usize,
    values: *mut C,
    to_c: impl Fn(T) -> C,
) -> RawStatus {
    // SAFETY: `references` and `values` have `count` elements each; see the module.
    unsafe {
        call::<Fmi2, M>(component, function, |instance| {
            let references = memory::array("vr", references, count)?;
            let values = memory::room("value", values, count)?;
            instance.get(references.iter().copied(), |place, value| {
                values[place].write(to_c(value));
            })
        })
    }
}

/// Sets variables whose values are `T` in Rust and `C` in C.
unsafe fn set<M: Exported<Fmi2>, T: Checked, C: Copy>(
    component: Fmi2Component,
    function: &Function,
    references: *const Fmi2ValueReference,
    count: usize,
    values: *const C,
    from_c: impl Fn(C) -> T,
) -> RawStatus {
    // SAFETY: `references` and `values` have `count` elements each; see the module.
    unsafe {
        call::<Fmi2, M>(component, function, |instance| {
            let references = memory::array("vr", references, count)?;
            let values = memory::array("value", values, count)?;
            instance.set(references.iter().copied(), |place| from_c(values[place]))
        })
    }
}

pub unsafe fn get_real<M: Exported<Fmi2>>(
    component: Fmi2Component,
    references: *const Fmi2ValueReference,
    count: usize,
    values: *mut Fmi2Real,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { get::<M, f64, _>(component, &order::GET_REAL, references, count, values, |value| value) }
}

/// Enumerations are read here, too.
pub unsafe fn get_integer<M: Exported<Fmi2>>(
    component: Fmi2Component,
    references: *const Fmi2ValueReference,
    count: usize,
    values: *mut Fmi2Integer,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { get::<M, i32, _>(component, &order::GET_INTEGER, references, count, values, |value| value) }
}

pub unsafe fn get_boolean<M: Exported<Fmi2>>(
    component: Fmi2Component,
    references: *const Fmi2ValueReference,
    count: usize,
    values: *mut Fmi2Boolean,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { get::<M, bool, _>(component, &order::GET_BOOLEAN, references, count, values, boolean) }
}

/// The strings belong to the instance and hold until the next `fmi2GetString` on it.
pub unsafe fn get_string<M: Exported<Fmi2>>(
    component: Fmi2Component,
    references: *const Fmi2ValueReference,
    count: usize,
    values: *mut Fmi2String,
) -> RawStatus {
    // SAFETY: `references` and `values` have `count` elements each; see the module.
    unsafe {
        call::<Fmi2, M>(component, &order::GET_STRING, |instance| {
            let references = memory::array("vr", references, count)?;
            let values = memory::room("value", values, count)?;
            instance.get_texts(references.iter().copied(), |place, text: &CString| {
                values[place].write(text.as_ptr());
            })
        })
    }
}

pub unsafe fn set_real<M: Exported<Fmi2>>(
    component: Fmi2Component,
    references: *const Fmi2ValueReference,
    count: usize,
    values: *const Fmi2Real,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { set::<M, f64, _>(component, &order::SET_REAL, references, count, values, |value| value) }
}

/// Enumerations are set here, too.
pub unsafe fn set_integer<M: Exported<Fmi2>>(
    component: Fmi2Component,
    references: *const Fmi2ValueReference,
    count: usize,
    values: *const Fmi2Integer,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { set::<M, i32, _>(component, &order::SET_INTEGER, references, count, values, |value| value) }
}

/// Any value but 0 is true, as in C.
pub unsafe fn set_boolean<M: Exported<Fmi2>>(
    component: Fmi2Component,
    references: *const Fmi2ValueReference,
    count: usize,
    values: *const Fmi2Boolean,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { set::<M, bool, _>(component, &order::SET_BOOLEAN, references, count, values, truth) }
}

pub unsafe fn set_string<M: Exported<Fmi2>>(
    component: Fmi2Component,
    references: *const Fmi2ValueReference,
    count: usize,
    values: *const Fmi2String,
) -> RawStatus {
    // SAFETY: `references` and `values` have `count` elements each, the latter strings; see the module.
    unsafe {
        call::<Fmi2, M>(component, &order::SET_STRING, |instance| {
            let references = memory::array("vr", references, count)?;
            let values = memory::array("value", values, count)?
                .iter()
                .map(|value| memory::text("value", *value).map(str::to_owned))
                .collect::<Result<Vec<String>, CallError>>()?;
            instance.set(references.iter().copied(), |place| values[place].clone())
        })
    }
}
