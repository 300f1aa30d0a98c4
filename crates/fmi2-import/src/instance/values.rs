//! Getting and setting variables.

use std::ffi::c_char;

use fmi2_abi::{FMI2_FALSE, Fmi2Component, Fmi2String, RawStatus, boolean, truth};

use super::Instance;
use crate::ImportError;
use crate::logger::text;

impl Instance {
    /// `fmi2GetReal` into `values`, in the order of the value references.
    ///
    /// # Errors
    /// [`ImportError::Call`], [`ImportError::Unusable`] or [`ImportError::LengthMismatch`].
    pub fn get_real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), ImportError> {
        let call = self.binary.functions.get_real;
        self.exchange("fmi2GetReal", references, values.len(), |component| {
            // SAFETY: both arrays have the length that is passed.
            unsafe { call(component, references.as_ptr(), references.len(), values.as_mut_ptr()) }
        })
    }

    /// `fmi2SetReal`.
    ///
    /// # Errors
    /// As [`Instance::get_real`].
    pub fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), ImportError> {
        let call = self.binary.functions.set_real;
        self.exchange("fmi2SetReal", references, values.len(), |component| {
            // SAFETY: both arrays have the length that is passed.
            unsafe { call(component, references.as_ptr(), references.len(), values.as_ptr()) }
        })
    }

    /// `fmi2GetInteger`, for Integers and Enumerations.
    ///
    /// # Errors
    /// As [`Instance::get_real`].
    pub fn get_integer(&mut self, references: &[u32], values: &mut [i32]) -> Result<(), ImportError> {
        let call = self.binary.functions.get_integer;
        self.exchange("fmi2GetInteger", references, values.len(), |component| {
            // SAFETY: both arrays have the length that is passed.
            unsafe { call(component, references.as_ptr(), references.len(), values.as_mut_ptr()) }
        })
    }

    /// `fmi2SetInteger`, for Integers and Enumerations.
    ///
    /// # Errors
    /// As [`Instance::get_real`].
    pub fn set_integer(&mut self, references: &[u32], values: &[i32]) -> Result<(), ImportError> {
        let call = self.binary.functions.set_integer;
        self.exchange("fmi2SetInteger", references, values.len(), |component| {
            // SAFETY: both arrays have the length that is passed.
            unsafe { call(component, references.as_ptr(), references.len(), values.as_ptr()) }
        })
    }

    /// `fmi2GetBoolean`.
    ///
    /// # Errors
    /// As [`Instance::get_real`].
    pub fn get_boolean(&mut self, references: &[u32], values: &mut [bool]) -> Result<(), ImportError> {
        let call = self.binary.functions.get_boolean;
        let mut raw = std::mem::take(&mut self.booleans);
        raw.clear();
        raw.resize(references.len(), FMI2_FALSE);
        let result = self.exchange("fmi2GetBoolean", references, values.len(), |component| {
            // SAFETY: `raw` was given the length of `references`.
            unsafe { call(component, references.as_ptr(), references.len(), raw.as_mut_ptr()) }
        });
        if result.is_ok() {
            for (value, raw) in values.iter_mut().zip(&raw) {
                *value = truth(*raw);
            }
        }
        self.booleans = raw;
        result
    }

    /// `fmi2SetBoolean`.
    ///
    /// # Errors
    /// As [`Instance::get_real`].
    pub fn set_boolean(&mut self, references: &[u32], values: &[bool]) -> Result<(), ImportError> {
        let call = self.binary.functions.set_boolean;
        let mut raw = std::mem::take(&mut self.booleans);
        raw.clear();
        raw.extend(values.iter().map(|&v| boolean(v)));
        let result = self.exchange("fmi2SetBoolean", references, raw.len(), |component| {
            // SAFETY: both arrays have the length that is passed.
            unsafe { call(component, references.as_ptr(), references.len(), raw.as_ptr()) }
        });
        self.booleans = raw;
        result
    }

    /// `fmi2GetString`, copied out of the FMU.
    ///
    /// # Errors
    /// [`ImportError::Call`] or [`ImportError::Unusable`].
    pub fn get_string(&mut self, references: &[u32]) -> Result<Vec<String>, ImportError> {
        let call = self.binary.functions.get_string;
        let mut raw: Vec<*const c_char> = vec![std::ptr::null(); references.len()];
        self.exchange("fmi2GetString", references, raw.len(), |component| {
            // SAFETY: both arrays have the length that is passed.
            unsafe { call(component, references.as_ptr(), references.len(), raw.as_mut_ptr()) }
        })?;
        // SAFETY: the strings hold until the next call on this instance; null, as we left it, reads as empty.
        Ok(raw.into_iter().map(|s| unsafe { text(s) }).collect())
    }

    /// `fmi2SetString`.
    ///
    /// # Errors
    /// As [`Instance::get_real`], or [`ImportError::NulInText`].
    pub fn set_string<S: AsRef<str>>(&mut self, references: &[u32], values: &[S]) -> Result<(), ImportError> {
        const FUNCTION: &str = "fmi2SetString";
        let call = self.binary.functions.set_string;
        let owned = self.c_strings(FUNCTION, values)?;
        let pointers: Vec<Fmi2String> = owned.iter().map(|s| s.as_ptr()).collect();
        self.exchange(FUNCTION, references, pointers.len(), |component| {
            // SAFETY: both arrays have the length that is passed, and the strings live during the call.
            unsafe { call(component, references.as_ptr(), references.len(), pointers.as_ptr()) }
        })
    }

    /// A call that passes one value for each reference; none at all is no call.
    fn exchange(
        &mut self,
        function: &'static str,
        references: &[u32],
        values: usize,
        call: impl FnOnce(Fmi2Component) -> RawStatus,
    ) -> Result<(), ImportError> {
        if references.len() != values {
            return Err(ImportError::LengthMismatch {
                instance: self.name.clone(),
                function,
                references: references.len(),
                values,
            });
        }
        if references.is_empty() {
            return Ok(());
        }
        self.call(function, call)
    }
}
