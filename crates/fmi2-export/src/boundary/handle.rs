//! What the opaque pointers of the standard point to.

use std::cell::UnsafeCell;
use std::ffi::c_void;
use std::ops::{Deref, DerefMut};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use fmi_model::Snapshot;
use fmi2_abi::Fmi2Status;
use uuid::Uuid;

use crate::identity::{Exported, own_guid};
use crate::instance::Instance;
use crate::log::Sink;
use crate::order::Function;

/// First bytes behind every handle, by which misuse is recognised. All FMUs made with this crate share the layout.
#[repr(C)]
struct Head {
    /// Says what follows; cleared when it is freed.
    magic: AtomicU64,
    guid: [u8; 16],
}

const INSTANCE: u64 = u64::from_le_bytes(*b"FMU2inst");
const STATE: u64 = u64::from_le_bytes(*b"FMU2stat");
const FREED: u64 = u64::from_le_bytes(*b"FMU2free");

impl Head {
    fn new(magic: u64, guid: Uuid) -> Self {
        Self {
            magic: AtomicU64::new(magic),
            guid: guid.into_bytes(),
        }
    }

    /// Whether `pointer` points to a head of this kind and of the FMU `M`.
    ///
    /// # Safety
    /// `pointer` is null or points to a head.
    unsafe fn recognise<M: Exported>(pointer: *const c_void, magic: u64) -> bool {
        let pointer = pointer.cast::<Self>();
        if pointer.is_null() || !pointer.is_aligned() {
            return false;
        }
        // SAFETY: aligned, not null, and the caller vouches for what it points to.
        let head = unsafe { &*pointer };
        head.magic.load(Ordering::Acquire) == magic && own_guid::<M>().is_ok_and(|guid| head.guid == guid.into_bytes())
    }
}

/// Behind `fmi2Component`.
#[repr(C)]
pub(super) struct Handle<M> {
    head: Head,
    /// A call is under way.
    busy: AtomicBool,
    /// Can be spoken to even then.
    pub(super) sink: Sink,
    instance: UnsafeCell<Instance<M>>,
}

impl<M: Exported> Handle<M> {
    pub(super) fn new(guid: Uuid, sink: Sink, instance: Instance<M>) -> Self {
        Self {
            head: Head::new(INSTANCE, guid),
            busy: AtomicBool::new(false),
            sink,
            instance: UnsafeCell::new(instance),
        }
    }

    /// The handle behind a component of this FMU; `None` if it is null, freed, or of another FMU.
    ///
    /// # Safety
    /// `component` is null or points to a handle that lives through `'a`.
    pub(super) unsafe fn recognise<'a>(component: *mut c_void) -> Option<&'a Self> {
        // SAFETY: a handle begins with its head.
        let recognised = unsafe { Head::recognise::<M>(component, INSTANCE) };
        // SAFETY: the head says that a handle of this very FMU follows. Only shared references to it are ever made; the
        // instance inside is reached through its cell.
        recognised.then(|| unsafe { &*component.cast::<Self>() })
    }

    /// Exclusive use of the instance; `None`, with a message, if a call on it is under way: from another thread, or around this
    /// one, which then comes from inside a callback.
    pub(super) fn claim(&self, function: &Function) -> Option<Claim<'_, M>> {
        if self.busy.swap(true, Ordering::Acquire) {
            let message = format!(
                "{}: another call on this instance is under way; wait for it, and call nothing from the logger",
                function.name
            );
            self.sink.explain(Fmi2Status::Error, &message);
            return None;
        }
        Some(Claim { handle: self })
    }

    /// Marks the handle as freed, so that a later use may be recognised.
    pub(super) fn retire(&self) {
        self.head.magic.store(FREED, Ordering::Release);
    }
}

/// Exclusive use of an instance, until dropped.
pub(super) struct Claim<'a, M> {
    handle: &'a Handle<M>,
}

impl<M> Deref for Claim<'_, M> {
    type Target = Instance<M>;

    fn deref(&self) -> &Instance<M> {
        // SAFETY: `busy` was taken for this claim, so no other reference to the instance exists.
        unsafe { &*self.handle.instance.get() }
    }
}

impl<M> DerefMut for Claim<'_, M> {
    fn deref_mut(&mut self) -> &mut Instance<M> {
        // SAFETY: as in `deref`.
        unsafe { &mut *self.handle.instance.get() }
    }
}

impl<M> Drop for Claim<'_, M> {
    fn drop(&mut self) {
        self.handle.busy.store(false, Ordering::Release);
    }
}

/// Behind `fmi2FMUstate`.
#[repr(C)]
pub(super) struct SavedState<M> {
    head: Head,
    pub(super) snapshot: Snapshot<M>,
}

impl<M: Exported> SavedState<M> {
    /// A new handle, owned by the host until it frees it.
    pub(super) fn into_raw(guid: Uuid, snapshot: Snapshot<M>) -> *mut c_void {
        let state = Self {
            head: Head::new(STATE, guid),
            snapshot,
        };
        Box::into_raw(Box::new(state)).cast()
    }

    /// The state behind a handle of this FMU; `None` if it is null, freed, or of another FMU.
    ///
    /// # Safety
    /// `state` is null or points to a saved state that lives unchanged through `'a`.
    pub(super) unsafe fn recognise<'a>(state: *mut c_void) -> Option<&'a Self> {
        // SAFETY: a saved state begins with its head.
        let recognised = unsafe { Head::recognise::<M>(state, STATE) };
        // SAFETY: the head says that a state of this very FMU follows, and the caller vouches for its life.
        recognised.then(|| unsafe { &*state.cast::<Self>() })
    }

    /// Replaces what a recognised state holds.
    ///
    /// # Safety
    /// `state` came from [`into_raw`](Self::into_raw), was recognised as this FMU's, and is used by no one else.
    pub(super) unsafe fn replace(state: *mut c_void, snapshot: Snapshot<M>) {
        // SAFETY: the caller vouches for where it came from and for its sole use.
        unsafe { &mut *state.cast::<Self>() }.snapshot = snapshot;
    }

    /// Frees a recognised state.
    ///
    /// # Safety
    /// `state` came from [`into_raw`](Self::into_raw), was recognised as this FMU's, and is not used afterwards.
    pub(super) unsafe fn free(state: *mut c_void) {
        // SAFETY: the caller vouches for where it came from and that it is used no more.
        let state = unsafe { Box::from_raw(state.cast::<Self>()) };
        state.head.magic.store(FREED, Ordering::Release);
    }
}
