//! Control and status of the floating-point unit, which belong to the thread.

/// MXCSR and the control word of the x87 unit, which long double arithmetic uses.
#[cfg(target_arch = "x86_64")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Arithmetic {
    sse: u32,
    x87: u16,
}

#[cfg(target_arch = "x86_64")]
impl Arithmetic {
    pub(super) fn now() -> Self {
        let (mut sse, mut x87) = (0_u32, 0_u16);
        // SAFETY: both instructions write to the place given, of the size that they need, and nothing else.
        unsafe {
            std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut sse, options(nostack, preserves_flags));
            std::arch::asm!("fnstcw [{}]", in(reg) &raw mut x87, options(nostack, preserves_flags));
        }
        Self { sse, x87 }
    }

    pub(super) fn put_back(self) {
        // SAFETY: the value was read from the same register, so it is one that the register takes. Exception flags are among what is
        // put back, so nothing is said of flags that stay.
        unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const self.sse, options(nostack)) };
        if Self::now().x87 != self.x87 {
            // What is pending would be raised by the next instruction that waits, if it was unmasked.
            // SAFETY: as above; clearing exceptions touches nothing else.
            unsafe {
                std::arch::asm!("fnclex", "fldcw [{}]", in(reg) &raw const self.x87, options(nostack));
            }
        }
    }
}

/// FPCR and FPSR.
#[cfg(target_arch = "aarch64")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Arithmetic {
    control: u64,
    status: u64,
}

#[cfg(target_arch = "aarch64")]
impl Arithmetic {
    pub(super) fn now() -> Self {
        let (control, status): (u64, u64);
        // SAFETY: reads two registers.
        unsafe {
            std::arch::asm!("mrs {}, fpcr", out(reg) control, options(nostack, preserves_flags));
            std::arch::asm!("mrs {}, fpsr", out(reg) status, options(nostack, preserves_flags));
        }
        Self { control, status }
    }

    pub(super) fn put_back(self) {
        // SAFETY: the values were read from the same registers. The status is one of flags, so nothing is said of flags that stay.
        unsafe {
            std::arch::asm!("msr fpcr, {}", in(reg) self.control, options(nostack));
            std::arch::asm!("msr fpsr, {}", in(reg) self.status, options(nostack));
        }
    }
}

/// Nothing is known of other processors.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Arithmetic;

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
impl Arithmetic {
    pub(super) fn now() -> Self {
        Self
    }

    pub(super) fn put_back(self) {}
}
