//! An opened FMU: description at once, library on demand.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use tempfile::TempDir;

use crate::archive::Archive;
use crate::description::ModelDescription;
use crate::library::Binary;
use crate::{ImportError, Instance, xml};

/// An FMI 2.0 co-simulation FMU.
///
/// Opening reads and checks the archive and its description. The library is unpacked to a temporary folder and loaded
/// by [`Fmu::load`] or with the first instance. An `Fmu` may be shared by threads; its instances keep what they need
/// alive, so it may also be dropped before them.
#[derive(Debug)]
pub struct Fmu {
    path: PathBuf,
    description: Arc<ModelDescription>,
    platforms: Vec<String>,
    loading: Mutex<Loading>,
}

#[derive(Debug)]
struct Loading {
    // Kept open, so that a file replaced in the meantime cannot mix two versions.
    archive: Archive,
    binary: Option<Arc<Binary>>,
}

impl Fmu {
    /// Opens the FMU at `path`.
    ///
    /// # Errors
    /// [`ImportError::NotFound`], [`ImportError::Read`], [`ImportError::NotAnArchive`], [`ImportError::UnsafeEntry`],
    /// [`ImportError::TooLarge`], [`ImportError::NoModelDescription`], [`ImportError::MalformedXml`],
    /// [`ImportError::InvalidDescription`], [`ImportError::FmiVersion`] or [`ImportError::NotCoSimulation`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, ImportError> {
        let path = path.as_ref();
        let mut archive = Archive::open(path)?;
        let description = xml::parse(&archive.description()?, path)?;
        Ok(Self {
            path: path.to_owned(),
            description: Arc::new(description),
            platforms: archive.platforms(),
            loading: Mutex::new(Loading { archive, binary: None }),
        })
    }

    /// The path it was opened from.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it says about itself.
    #[must_use]
    pub fn description(&self) -> &ModelDescription {
        &self.description
    }

    /// Platforms it has binaries for, sorted; [`crate::PLATFORM`] must be among them for [`Fmu::load`] to succeed.
    #[must_use]
    pub fn platforms(&self) -> &[String] {
        &self.platforms
    }

    /// Unpacks and loads the library now, so that a problem shows before any run.
    ///
    /// # Errors
    /// [`ImportError::NoBinary`], [`ImportError::Unpack`], [`ImportError::TooLarge`], [`ImportError::Load`],
    /// [`ImportError::MissingSymbol`] or [`ImportError::Incompatible`].
    pub fn load(&self) -> Result<(), ImportError> {
        self.binary().map(drop)
    }

    /// Unpacks what a running FMU may look at, without loading anything; the folder goes with what is returned.
    ///
    /// # Errors
    /// [`ImportError::Unpack`], [`ImportError::TooLarge`] or [`ImportError::NotAnArchive`].
    pub fn unpack(&self) -> Result<TempDir, ImportError> {
        let mut loading = self.loading.lock().unwrap_or_else(PoisonError::into_inner);
        loading.archive.unpack()
    }

    /// Creates an instance called `name`.
    ///
    /// With `logging_on` it logs all it has to say. Without, it is asked for warnings and the reasons of failed calls if it has
    /// the standard's categories for them, and one that refuses to be made and does not say why is asked once more with its
    /// log on.
    ///
    /// # Errors
    /// Those of [`Fmu::load`], [`ImportError::NulInText`], [`ImportError::OnlyOnce`] or [`ImportError::Instantiate`]
    /// with what the FMU logged.
    pub fn instantiate(&self, name: &str, logging_on: bool) -> Result<Instance, ImportError> {
        Instance::new(self.binary()?, Arc::clone(&self.description), name, logging_on)
    }

    fn binary(&self) -> Result<Arc<Binary>, ImportError> {
        // `binary` is set in one assignment, so a poisoned lock holds a usable value.
        let mut loading = self.loading.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(binary) = &loading.binary {
            return Ok(Arc::clone(binary));
        }
        let attributes = &self.description.co_simulation;
        let binary = Arc::new(Binary::load(
            &self.path,
            &mut loading.archive,
            &self.platforms,
            attributes,
        )?);
        loading.binary = Some(Arc::clone(&binary));
        Ok(binary)
    }
}
