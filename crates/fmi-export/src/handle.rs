//! What the opaque pointers of the standard point to.
#![allow(unsafe_code, reason = "opaque pointers come in, references go on")]

use std::cell::UnsafeCell;
use std::ffi::c_void;
use std::ops::{Deref, DerefMut};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use fmi_model::{DefinitionError, Snapshot};
use uuid::Uuid;

use crate::identity::{Exported, own_guid};
use crate::instance::Instance;
use crate::log::Logger;
use crate::order::Function;
use crate::status::Status;
use crate::version::Version;

/// First bytes behind every handle, by which misuse is recognised. All FMUs made with this crate share the layout.
#[repr(C)]
struct Head {
    /// Says what follows; cleared when it is freed.
    magic: AtomicU64,
    /// That of the library: which type follows.
    guid: [u8; 16],
}

/// What a head says before an instance.
const fn instance_of<V: Version>() -> u64 {
    u64::from_le_bytes([b'F', b'M', b'U', V::DIGIT, b'i', b'n', b's', b't'])
}

/// What a head says before a saved state.
const fn state_of<V: Version>() -> u64 {
    u64::from_le_bytes([b'F', b'M', b'U', V::DIGIT, b's', b't', b'a', b't'])
}

/// What a head says before what was freed.
const FREED: u64 = u64::from_le_bytes(*b"FMU free");

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
    unsafe fn recognise<V: Version, M: Exported<V>>(pointer: *const c_void, magic: u64) -> bool {
        let pointer = pointer.cast::<Self>();
        if pointer.is_null() || !pointer.is_aligned() {
            return false;
        }
        // SAFETY: aligned, not null, and the caller vouches for what it points to.
        let head = unsafe { &*pointer };
        head.magic.load(Ordering::Acquire) == magic
            && own_guid::<V, M>().is_ok_and(|guid| head.guid == guid.into_bytes())
    }
}

/// Behind the pointer that the host has for an instance.
#[repr(C)]
pub(crate) struct Handle<V: Version, M> {
    head: Head,
    /// A call is under way.
    busy: AtomicBool,
    /// Can be spoken to even then.
    pub(crate) logger: Logger<V::Sink>,
    instance: UnsafeCell<Instance<V, M>>,
}

impl<V: Version, M: Exported<V>> Handle<V, M> {
    pub(crate) fn new(guid: Uuid, logger: Logger<V::Sink>, instance: Instance<V, M>) -> Self {
        Self {
            head: Head::new(instance_of::<V>(), guid),
            busy: AtomicBool::new(false),
            logger,
            instance: UnsafeCell::new(instance),
        }
    }

    /// The handle behind a component of this FMU; `None` if it is null, freed, or of another FMU.
    ///
    /// # Safety
    /// `component` is null or points to a handle that lives through `'a`.
    pub(crate) unsafe fn recognise<'a>(component: *mut c_void) -> Option<&'a Self> {
        // SAFETY: a handle begins with its head.
        let recognised = unsafe { Head::recognise::<V, M>(component, instance_of::<V>()) };
        // SAFETY: the head says that a handle of this very FMU follows. Only shared references to it are ever made; the
        // instance inside is reached through its cell.
        recognised.then(|| unsafe { &*component.cast::<Self>() })
    }

    /// Exclusive use of the instance; `None`, with a message, if a call on it is under way: from another thread, or around this
    /// one, which then comes from inside a callback.
    pub(crate) fn claim(&self, function: &Function) -> Option<Claim<'_, V, M>> {
        if self.busy.swap(true, Ordering::Acquire) {
            let message = format!(
                "{}: another call on this instance is under way; wait for it, and call nothing from the logger",
                function.name
            );
            self.logger.explain(Status::Error, &message);
            return None;
        }
        Some(Claim { handle: self })
    }

    /// Marks the handle as freed, so that a later use may be recognised.
    pub(crate) fn retire(&self) {
        self.head.magic.store(FREED, Ordering::Release);
    }
}

/// Exclusive use of an instance, until dropped.
pub(crate) struct Claim<'a, V: Version, M> {
    handle: &'a Handle<V, M>,
}

impl<V: Version, M> Deref for Claim<'_, V, M> {
    type Target = Instance<V, M>;

    fn deref(&self) -> &Instance<V, M> {
        // SAFETY: `busy` was taken for this claim, so no other reference to the instance exists.
        unsafe { &*self.handle.instance.get() }
    }
}

impl<V: Version, M> DerefMut for Claim<'_, V, M> {
    fn deref_mut(&mut self) -> &mut Instance<V, M> {
        // SAFETY: as in `deref`.
        unsafe { &mut *self.handle.instance.get() }
    }
}

impl<V: Version, M> Drop for Claim<'_, V, M> {
    fn drop(&mut self) {
        self.handle.busy.store(false, Ordering::Release);
    }
}

/// Behind the pointer that the host has for a saved state.
#[repr(C)]
pub(crate) struct SavedState<M> {
    head: Head,
    /// Identifier of the FMU it is a state of: that of the library, or what it was packed with made another of it.
    identity: Uuid,
    pub(crate) snapshot: Snapshot<M>,
}

impl<M> SavedState<M> {
    /// A new handle, owned by the host until it frees it.
    pub(crate) fn into_raw<V: Version>(identity: Uuid, snapshot: Snapshot<M>) -> Result<*mut c_void, DefinitionError>
    where
        M: Exported<V>,
    {
        let state = Self {
            head: Head::new(state_of::<V>(), own_guid::<V, M>()?),
            identity,
            snapshot,
        };
        Ok(Box::into_raw(Box::new(state)).cast())
    }

    /// The state behind a handle of the FMU with this identifier; `None` if it is null, freed, or of another FMU.
    ///
    /// # Safety
    /// `state` is null or points to a saved state that lives unchanged through `'a`.
    pub(crate) unsafe fn recognise<'a, V: Version>(state: *mut c_void, identity: Uuid) -> Option<&'a Self>
    where
        M: Exported<V>,
    {
        // SAFETY: a saved state begins with its head.
        let recognised = unsafe { Head::recognise::<V, M>(state, state_of::<V>()) };
        // SAFETY: the head says that a state of this very type follows, and the caller vouches for its life.
        let state = recognised.then(|| unsafe { &*state.cast::<Self>() });
        state.filter(|state| state.identity == identity)
    }

    /// Replaces what a recognised state holds.
    ///
    /// # Safety
    /// `state` came from [`into_raw`](Self::into_raw), was recognised as this FMU's, and is used by no one else.
    pub(crate) unsafe fn replace(state: *mut c_void, snapshot: Snapshot<M>) {
        // SAFETY: the caller vouches for where it came from and for its sole use.
        unsafe { &mut *state.cast::<Self>() }.snapshot = snapshot;
    }

    /// Frees a recognised state.
    ///
    /// # Safety
    /// `state` came from [`into_raw`](Self::into_raw), was recognised as this FMU's, and is not used afterwards.
    pub(crate) unsafe fn free(state: *mut c_void) {
        // SAFETY: the caller vouches for where it came from and that it is used no more.
        let state = unsafe { Box::from_raw(state.cast::<Self>()) };
        state.head.magic.store(FREED, Ordering::Release);
    }
}
