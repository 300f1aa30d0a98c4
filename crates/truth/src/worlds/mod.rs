//! One file per world.

pub(crate) mod leo_venting;
