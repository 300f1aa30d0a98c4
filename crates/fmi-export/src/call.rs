//! From an opaque pointer to a call on the instance behind it.
#![allow(unsafe_code, reason = "an opaque pointer comes in, a reference goes on")]

use std::ffi::{c_int, c_void};

use fmi_model::guarded;

use crate::handle::Handle;
use crate::identity::Exported;
use crate::instance::{Answer, Instance};
use crate::order::Function;
use crate::status::Status;
use crate::version::Version;

/// Runs `body` on the instance behind `component`. Without a recognisable instance there is no logger to tell, and the answer is an
/// error.
///
/// # Safety
/// `component` is null or came from [`create`](crate::lifecycle::create) with the same `V` and `M` and has not been freed.
pub unsafe fn call<V: Version, M: Exported<V>>(
    component: *mut c_void,
    function: &Function,
    body: impl FnOnce(&mut Instance<V, M>) -> Answer,
) -> c_int {
    // SAFETY: `component` is null or an instance, as the caller vouches.
    let Ok(Some(handle)) = guarded(|| unsafe { Handle::<V, M>::recognise(component) }) else {
        return Status::Error.raw();
    };
    match handle.claim(function) {
        Some(mut instance) => instance.run(function, body).raw(),
        None => Status::Error.raw(),
    }
}
