//! Saved states. A state may be set on any instance of the same FMU.

use fmi_export::{Exported, states};
use fmi2_abi::{Fmi2Byte, Fmi2Component, Fmi2FmuState, RawStatus};

use crate::order;
use crate::version::Fmi2;

pub unsafe fn get_fmu_state<M: Exported<Fmi2>>(component: Fmi2Component, state: *mut Fmi2FmuState) -> RawStatus {
    // SAFETY: see the module.
    unsafe { states::get_fmu_state::<Fmi2, M>(component, &order::GET_FMU_STATE, state) }
}

pub unsafe fn set_fmu_state<M: Exported<Fmi2>>(component: Fmi2Component, state: Fmi2FmuState) -> RawStatus {
    // SAFETY: see the module.
    unsafe { states::set_fmu_state::<Fmi2, M>(component, &order::SET_FMU_STATE, state) }
}

pub unsafe fn free_fmu_state<M: Exported<Fmi2>>(component: Fmi2Component, state: *mut Fmi2FmuState) -> RawStatus {
    // SAFETY: see the module.
    unsafe { states::free_fmu_state::<Fmi2, M>(component, &order::FREE_FMU_STATE, state) }
}

pub unsafe fn serialized_fmu_state_size<M: Exported<Fmi2>>(
    component: Fmi2Component,
    state: Fmi2FmuState,
    size: *mut usize,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { states::serialized_fmu_state_size::<Fmi2, M>(component, &order::SERIALIZED_FMU_STATE_SIZE, state, size) }
}

pub unsafe fn serialize_fmu_state<M: Exported<Fmi2>>(
    component: Fmi2Component,
    state: Fmi2FmuState,
    buffer: *mut Fmi2Byte,
    size: usize,
) -> RawStatus {
    let (function, buffer) = (&order::SERIALIZE_FMU_STATE, buffer.cast::<u8>());
    // SAFETY: see the module.
    unsafe { states::serialize_fmu_state::<Fmi2, M>(component, function, state, buffer, size) }
}

pub unsafe fn de_serialize_fmu_state<M: Exported<Fmi2>>(
    component: Fmi2Component,
    bytes: *const Fmi2Byte,
    size: usize,
    state: *mut Fmi2FmuState,
) -> RawStatus {
    let (function, bytes) = (&order::DE_SERIALIZE_FMU_STATE, bytes.cast::<u8>());
    // SAFETY: see the module.
    unsafe { states::de_serialize_fmu_state::<Fmi2, M>(component, function, bytes, size, state) }
}
