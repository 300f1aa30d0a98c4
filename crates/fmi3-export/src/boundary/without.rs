//! Getting and setting variables of types that no variable here has: none can be read or set, and any is refused by what it is.

use fmi_export::{Exported, Function, Status, call, memory};
use fmi3_abi::{
    Fmi3Binary, Fmi3Clock, Fmi3Float32, Fmi3Instance, Fmi3Int8, Fmi3Int16, Fmi3UInt8, Fmi3UInt16, Fmi3UInt32,
    Fmi3UInt64, Fmi3ValueReference, RawStatus,
};

use crate::order;
use crate::rows::check;
use crate::version::Fmi3;

unsafe fn none<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    function: &Function,
    wanted: &'static str,
    references: *const Fmi3ValueReference,
    count: usize,
    value_count: usize,
) -> RawStatus {
    // SAFETY: `references` has `count` elements; see the module.
    unsafe {
        call::<Fmi3, M>(instance, function, |_| {
            let references = memory::array("valueReferences", references, count)?;
            check::<M>(references, wanted, value_count, false)?;
            Ok(Status::Ok)
        })
    }
}

macro_rules! none {
    ($($wanted:literal: $name:ident($values:ty) as $function:ident;)*) => {
        $(
            pub unsafe fn $name<M: Exported<Fmi3>>(
                instance: Fmi3Instance,
                references: *const Fmi3ValueReference,
                count: usize,
                _values: $values,
                value_count: usize,
            ) -> RawStatus {
                // SAFETY: see the module above; the values are not looked at.
                unsafe { none::<M>(instance, &order::$function, $wanted, references, count, value_count) }
            }
        )*
    };
}

none! {
    "Float32": get_float32(*mut Fmi3Float32) as GET_FLOAT32;
    "Float32": set_float32(*const Fmi3Float32) as SET_FLOAT32;
    "Int8": get_int8(*mut Fmi3Int8) as GET_INT8;
    "Int8": set_int8(*const Fmi3Int8) as SET_INT8;
    "UInt8": get_uint8(*mut Fmi3UInt8) as GET_UINT8;
    "UInt8": set_uint8(*const Fmi3UInt8) as SET_UINT8;
    "Int16": get_int16(*mut Fmi3Int16) as GET_INT16;
    "Int16": set_int16(*const Fmi3Int16) as SET_INT16;
    "UInt16": get_uint16(*mut Fmi3UInt16) as GET_UINT16;
    "UInt16": set_uint16(*const Fmi3UInt16) as SET_UINT16;
    "UInt32": get_uint32(*mut Fmi3UInt32) as GET_UINT32;
    "UInt32": set_uint32(*const Fmi3UInt32) as SET_UINT32;
    "UInt64": get_uint64(*mut Fmi3UInt64) as GET_UINT64;
    "UInt64": set_uint64(*const Fmi3UInt64) as SET_UINT64;
}

macro_rules! no_binary {
    ($($name:ident($sizes:ty, $values:ty) as $function:ident;)*) => {
        $(
            pub unsafe fn $name<M: Exported<Fmi3>>(
                instance: Fmi3Instance,
                references: *const Fmi3ValueReference,
                count: usize,
                _sizes: $sizes,
                _values: $values,
                value_count: usize,
            ) -> RawStatus {
                // SAFETY: see the module above; sizes and values are not looked at.
                unsafe { none::<M>(instance, &order::$function, "Binary", references, count, value_count) }
            }
        )*
    };
}

no_binary! {
    get_binary(*mut usize, *mut Fmi3Binary) as GET_BINARY;
    set_binary(*const usize, *const Fmi3Binary) as SET_BINARY;
}

macro_rules! no_clock {
    ($($name:ident($values:ty) as $function:ident;)*) => {
        $(
            pub unsafe fn $name<M: Exported<Fmi3>>(
                instance: Fmi3Instance,
                references: *const Fmi3ValueReference,
                count: usize,
                _values: $values,
            ) -> RawStatus {
                // SAFETY: see the module above; the values, one for each clock, are not looked at.
                unsafe { none::<M>(instance, &order::$function, "Clock", references, count, count) }
            }
        )*
    };
}

no_clock! {
    get_clock(*mut Fmi3Clock) as GET_CLOCK;
    set_clock(*const Fmi3Clock) as SET_CLOCK;
}
