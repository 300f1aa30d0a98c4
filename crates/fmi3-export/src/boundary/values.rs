//! Getting and setting variables of the five types that there are. An array is read and set whole.

use std::ffi::CString;

use fmi_export::{CallError, Exported, Function, Status, call, memory};
use fmi_model::{Checked, InstanceError, Model, Scalar, Typed};
use fmi3_abi::{
    Fmi3Boolean, Fmi3Float64, Fmi3Instance, Fmi3Int32, Fmi3Int64, Fmi3String, Fmi3ValueReference, RawStatus, boolean,
    truth,
};

use crate::order;
use crate::rows::{check, entries, is_time};
use crate::version::Fmi3;

/// Reads variables whose values are `T` in Rust and `C` in C.
#[allow(clippy::too_many_arguments, reason = "the standard's five, what is called, and how")]
unsafe fn get<M: Exported<Fmi3>, T: Scalar, C>(
    instance: Fmi3Instance,
    function: &Function,
    wanted: &'static str,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *mut C,
    value_count: usize,
    to_c: impl Fn(T) -> C,
) -> RawStatus {
    // SAFETY: `references` and `values` have as many elements as is said; see the module.
    unsafe {
        call::<Fmi3, M>(instance, function, |instance| {
            let references = memory::array("valueReferences", references, count)?;
            let values = memory::room("values", values, value_count)?;
            check::<M>(references, wanted, value_count, false)?;
            instance.get(entries::<M>(references), |place, value| {
                values[place].write(to_c(value));
            })
        })
    }
}

/// Sets variables whose values are `T` in Rust and `C` in C.
#[allow(clippy::too_many_arguments, reason = "the standard's five, what is called, and how")]
unsafe fn set<M: Exported<Fmi3>, T: Checked, C: Copy>(
    instance: Fmi3Instance,
    function: &Function,
    wanted: &'static str,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *const C,
    value_count: usize,
    from_c: impl Fn(C) -> T,
) -> RawStatus {
    // SAFETY: `references` and `values` have as many elements as is said; see the module.
    unsafe {
        call::<Fmi3, M>(instance, function, |instance| {
            let references = memory::array("valueReferences", references, count)?;
            let values = memory::array("values", values, value_count)?;
            check::<M>(references, wanted, value_count, false)?;
            instance.set(entries::<M>(references), |place| from_c(values[place]))
        })
    }
}

/// Time is read here, too.
pub unsafe fn get_float64<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *mut Fmi3Float64,
    value_count: usize,
) -> RawStatus {
    // SAFETY: `references` and `values` have as many elements as is said; see the module.
    unsafe {
        call::<Fmi3, M>(instance, &order::GET_FLOAT64, |instance| {
            let references = memory::array("valueReferences", references, count)?;
            let values = memory::room("values", values, value_count)?;
            check::<M>(references, "Float64", value_count, true)?;
            let (mut status, mut first) = (Status::Ok, 0);
            // One stretch of rows after the other, with time between them.
            for stretch in references.split_inclusive(|reference| is_time::<M>(*reference)) {
                let mut read = 0;
                let answer = instance.get(entries::<M>(stretch), |place, value: f64| {
                    values[first + place].write(value);
                    read = place + 1;
                })?;
                if answer == Status::Warning {
                    status = answer;
                }
                first += read;
                if stretch.last().is_some_and(|reference| is_time::<M>(*reference)) {
                    values[first].write(instance.time());
                    first += 1;
                }
            }
            Ok(status)
        })
    }
}

pub unsafe fn get_int32<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *mut Fmi3Int32,
    value_count: usize,
) -> RawStatus {
    let function = &order::GET_INT32;
    // SAFETY: see the module.
    unsafe {
        get::<M, i32, _>(
            instance,
            function,
            "Int32",
            references,
            count,
            values,
            value_count,
            |v| v,
        )
    }
}

/// Enumerations.
pub unsafe fn get_int64<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *mut Fmi3Int64,
    value_count: usize,
) -> RawStatus {
    let (function, to_c) = (&order::GET_INT64, |value: i32| i64::from(value));
    // SAFETY: see the module.
    unsafe {
        get::<M, i32, _>(
            instance,
            function,
            "Enumeration",
            references,
            count,
            values,
            value_count,
            to_c,
        )
    }
}

pub unsafe fn get_boolean<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *mut Fmi3Boolean,
    value_count: usize,
) -> RawStatus {
    let function = &order::GET_BOOLEAN;
    // SAFETY: see the module.
    unsafe {
        get::<M, bool, _>(
            instance,
            function,
            "Boolean",
            references,
            count,
            values,
            value_count,
            boolean,
        )
    }
}

/// The strings belong to the instance and hold until the next `fmi3GetString` on it.
pub unsafe fn get_string<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *mut Fmi3String,
    value_count: usize,
) -> RawStatus {
    // SAFETY: `references` and `values` have as many elements as is said; see the module.
    unsafe {
        call::<Fmi3, M>(instance, &order::GET_STRING, |instance| {
            let references = memory::array("valueReferences", references, count)?;
            let values = memory::room("values", values, value_count)?;
            check::<M>(references, "String", value_count, false)?;
            instance.get_texts(entries::<M>(references), |place, text: &CString| {
                values[place].write(text.as_ptr());
            })
        })
    }
}

pub unsafe fn set_float64<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *const Fmi3Float64,
    value_count: usize,
) -> RawStatus {
    let function = &order::SET_FLOAT64;
    // SAFETY: see the module.
    unsafe {
        set::<M, f64, _>(
            instance,
            function,
            "Float64",
            references,
            count,
            values,
            value_count,
            |v| v,
        )
    }
}

pub unsafe fn set_int32<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *const Fmi3Int32,
    value_count: usize,
) -> RawStatus {
    let function = &order::SET_INT32;
    // SAFETY: see the module.
    unsafe {
        set::<M, i32, _>(
            instance,
            function,
            "Int32",
            references,
            count,
            values,
            value_count,
            |v| v,
        )
    }
}

/// Enumerations.
pub unsafe fn set_int64<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *const Fmi3Int64,
    value_count: usize,
) -> RawStatus {
    // SAFETY: `references` and `values` have as many elements as is said; see the module.
    unsafe {
        call::<Fmi3, M>(instance, &order::SET_INT64, |instance| {
            let references = memory::array("valueReferences", references, count)?;
            let values = memory::array("values", values, value_count)?;
            check::<M>(references, "Enumeration", value_count, false)?;
            let values = entries::<M>(references)
                .zip(values)
                .map(|(entry, value)| item::<M>(entry, *value))
                .collect::<Result<Vec<i32>, CallError>>()?;
            instance.set(entries::<M>(references), |place| values[place])
        })
    }
}

/// The item of this number, unless it is too large for any.
fn item<M: Model>(entry: u32, value: i64) -> Result<i32, CallError> {
    i32::try_from(value).map_err(|_| {
        let of = |entry: fmi_model::Entry<'static, M>| match &entry.row.typed {
            Typed::Enumeration { declared, .. } => Some(InstanceError::no_such_item(entry, declared, value)),
            _ => None,
        };
        let count = M::table().entry_count();
        let unknown = InstanceError::UnknownReference {
            reference: entry,
            count,
        };
        M::table().entry(entry).and_then(of).unwrap_or(unknown).into()
    })
}

/// Any value but 0 is true, as in C.
pub unsafe fn set_boolean<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *const Fmi3Boolean,
    value_count: usize,
) -> RawStatus {
    let function = &order::SET_BOOLEAN;
    // SAFETY: see the module.
    unsafe {
        set::<M, bool, _>(
            instance,
            function,
            "Boolean",
            references,
            count,
            values,
            value_count,
            truth,
        )
    }
}

pub unsafe fn set_string<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    references: *const Fmi3ValueReference,
    count: usize,
    values: *const Fmi3String,
    value_count: usize,
) -> RawStatus {
    // SAFETY: `references` and `values` have as many elements as is said, the latter strings; see the module.
    unsafe {
        call::<Fmi3, M>(instance, &order::SET_STRING, |instance| {
            let references = memory::array("valueReferences", references, count)?;
            let values = memory::array("values", values, value_count)?;
            check::<M>(references, "String", value_count, false)?;
            let values = values
                .iter()
                .map(|value| memory::text("values", *value).map(str::to_owned))
                .collect::<Result<Vec<String>, CallError>>()?;
            instance.set(entries::<M>(references), |place| values[place].clone())
        })
    }
}
