//! How much memory the process uses.

/// Bytes.
#[derive(Debug, Clone, Copy)]
pub struct Memory {
    /// Handed out by the allocator of the C library, which the FMUs use, too.
    pub heap: i64,
    /// Pages in memory.
    pub resident: i64,
}

impl Memory {
    pub fn now() -> Self {
        let pages = std::fs::read_to_string("/proc/self/statm").unwrap();
        let resident: i64 = pages.split(' ').nth(1).unwrap().parse().unwrap();
        Self {
            heap: heap(),
            resident: resident * 4096,
        }
    }

    pub fn since(self, before: &Self) -> Self {
        Self {
            heap: self.heap - before.heap,
            resident: self.resident - before.resident,
        }
    }
}

#[cfg(target_env = "gnu")]
fn heap() -> i64 {
    // SAFETY: takes nothing and returns numbers.
    let info = unsafe { libc::mallinfo2() };
    i64::try_from(info.uordblks + info.hblkhd).unwrap()
}

/// Where the allocator tells nothing, pages have to do.
#[cfg(not(target_env = "gnu"))]
fn heap() -> i64 {
    0
}
