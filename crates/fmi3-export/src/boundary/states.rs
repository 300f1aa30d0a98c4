//! Saved states. A state may be set on any instance of the same FMU.

use fmi_export::{Exported, states};
use fmi3_abi::{Fmi3Byte, Fmi3FmuState, Fmi3Instance, RawStatus};

use crate::order;
use crate::version::Fmi3;

pub unsafe fn get_fmu_state<M: Exported<Fmi3>>(instance: Fmi3Instance, state: *mut Fmi3FmuState) -> RawStatus {
    // SAFETY: see the module.
    unsafe { states::get_fmu_state::<Fmi3, M>(instance, &order::GET_FMU_STATE, state) }
}

pub unsafe fn set_fmu_state<M: Exported<Fmi3>>(instance: Fmi3Instance, state: Fmi3FmuState) -> RawStatus {
    // SAFETY: see the module.
    unsafe { states::set_fmu_state::<Fmi3, M>(instance, &order::SET_FMU_STATE, state) }
}

pub unsafe fn free_fmu_state<M: Exported<Fmi3>>(instance: Fmi3Instance, state: *mut Fmi3FmuState) -> RawStatus {
    // SAFETY: see the module.
    unsafe { states::free_fmu_state::<Fmi3, M>(instance, &order::FREE_FMU_STATE, state) }
}

pub unsafe fn serialized_fmu_state_size<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    state: Fmi3FmuState,
    size: *mut usize,
) -> RawStatus {
    // SAFETY: see the module.
    unsafe { states::serialized_fmu_state_size::<Fmi3, M>(instance, &order::SERIALIZED_FMU_STATE_SIZE, state, size) }
}

pub unsafe fn serialize_fmu_state<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    state: Fmi3FmuState,
    buffer: *mut Fmi3Byte,
    size: usize,
) -> RawStatus {
    let function = &order::SERIALIZE_FMU_STATE;
    // SAFETY: see the module.
    unsafe { states::serialize_fmu_state::<Fmi3, M>(instance, function, state, buffer, size) }
}

pub unsafe fn deserialize_fmu_state<M: Exported<Fmi3>>(
    instance: Fmi3Instance,
    bytes: *const Fmi3Byte,
    size: usize,
    state: *mut Fmi3FmuState,
) -> RawStatus {
    let function = &order::DESERIALIZE_FMU_STATE;
    // SAFETY: see the module.
    unsafe { states::de_serialize_fmu_state::<Fmi3, M>(instance, function, bytes, size, state) }
}
