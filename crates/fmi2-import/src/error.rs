//! The one error type of this crate.

use std::path::PathBuf;

use crate::status::Status;
use crate::value::BaseType;

/// Why an FMU could not be opened, loaded or driven; one variant per cause.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ImportError {
    /// There is no file at the path.
    #[error("no FMU at {}: check the path", path.display())]
    NotFound {
        /// The path as given.
        path: PathBuf,
    },

    /// The file exists but cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The path as given.
        path: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },

    /// The file is no zip archive, or a damaged one.
    #[error("{} is not a readable zip archive ({reason}): build or download the FMU again", path.display())]
    NotAnArchive {
        /// The FMU.
        path: PathBuf,
        /// What the zip reader said.
        reason: String,
    },

    /// An archive entry would be written outside its folder.
    #[error("{}: entry {entry:?} {reason}; the FMU is refused", path.display())]
    UnsafeEntry {
        /// The FMU.
        path: PathBuf,
        /// Name of the entry.
        entry: String,
        /// What is wrong with it.
        reason: &'static str,
    },

    /// Unpacking would exceed the size limit.
    #[error("{}: {what} exceeds the limit of {limit_bytes} bytes; the FMU is refused", path.display())]
    TooLarge {
        /// The FMU.
        path: PathBuf,
        /// Which part of the archive.
        what: String,
        /// The limit, bytes.
        limit_bytes: u64,
    },

    /// The archive holds no `modelDescription.xml`.
    #[error("{} holds no modelDescription.xml at its top level: not an FMU", path.display())]
    NoModelDescription {
        /// The FMU.
        path: PathBuf,
    },

    /// `modelDescription.xml` is not well-formed, or lacks something the standard requires.
    #[error("{}: modelDescription.xml, line {line}, column {column}: {reason}", path.display())]
    MalformedXml {
        /// The FMU.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column in bytes, from 1.
        column: usize,
        /// What the XML reader said.
        reason: String,
    },

    /// `modelDescription.xml` is well-formed but contradicts itself.
    #[error("{}: modelDescription.xml: {reason}", path.display())]
    InvalidDescription {
        /// The FMU.
        path: PathBuf,
        /// What contradicts what.
        reason: String,
    },

    /// The FMU follows another version of the standard.
    #[error("{} declares fmiVersion {found:?}: only \"2.0\" can be imported", path.display())]
    FmiVersion {
        /// The FMU.
        path: PathBuf,
        /// Version it declares.
        found: String,
    },

    /// The FMU offers model exchange only.
    #[error("{} has no CoSimulation element: export it for co-simulation", path.display())]
    NotCoSimulation {
        /// The FMU.
        path: PathBuf,
    },

    /// The archive has no library for the platform of this process.
    #[error(
        "{} has no {wanted}; it holds binaries for {}",
        path.display(),
        if present.is_empty() { "no platform".to_owned() } else { present.join(", ") }
    )]
    NoBinary {
        /// The FMU.
        path: PathBuf,
        /// The entry that was looked for.
        wanted: String,
        /// Platform folders the archive does have.
        present: Vec<String>,
    },

    /// The archive could not be unpacked to a temporary folder.
    #[error("cannot unpack {} to {}: {source}", path.display(), target.display())]
    Unpack {
        /// The FMU.
        path: PathBuf,
        /// Folder or file being written.
        target: PathBuf,
        /// What the operating system said.
        source: std::io::Error,
    },

    /// The operating system refused to load the library.
    #[error("cannot load {library} of {}: {reason}", path.display())]
    Load {
        /// The FMU.
        path: PathBuf,
        /// Entry of the library in the archive.
        library: String,
        /// Text of the dynamic loader.
        reason: String,
    },

    /// The library lacks a function of the standard.
    #[error("{library} of {} does not export {symbol}", path.display())]
    MissingSymbol {
        /// The FMU.
        path: PathBuf,
        /// Entry of the library in the archive.
        library: String,
        /// Name of the function.
        symbol: String,
    },

    /// The library speaks another version or other base types than its description says.
    #[error("{library} of {}: {function} answers {found:?}, expected {expected:?}", path.display())]
    Incompatible {
        /// The FMU.
        path: PathBuf,
        /// Entry of the library in the archive.
        library: String,
        /// `fmi2GetVersion` or `fmi2GetTypesPlatform`.
        function: &'static str,
        /// Its answer.
        found: String,
        /// The only answer that can be worked with.
        expected: &'static str,
    },

    /// The FMU can live once per process and already does.
    #[error("cannot create {instance:?}: {model} can be instantiated only once per process and is in use")]
    OnlyOnce {
        /// Name of the refused instance.
        instance: String,
        /// The model.
        model: String,
    },

    /// `fmi2Instantiate` returned NULL.
    #[error("fmi2Instantiate of {model} as {instance:?} failed{}", said(messages))]
    Instantiate {
        /// Name of the instance.
        instance: String,
        /// The model.
        model: String,
        /// What the FMU logged, oldest first.
        messages: Vec<String>,
    },

    /// A function returned something other than OK or Warning.
    #[error("{instance}: {function} returned {status}{}", said(messages))]
    Call {
        /// Name of the instance.
        instance: String,
        /// FMI function.
        function: &'static str,
        /// What it returned.
        status: Status,
        /// What the FMU logged last, oldest first.
        messages: Vec<String>,
    },

    /// The instance returned Fatal (or Pending, which this master does not support) before.
    #[error("{instance}: {function} not called, since the instance returned {status} earlier; create a new one")]
    Unusable {
        /// Name of the instance.
        instance: String,
        /// FMI function that was asked for.
        function: &'static str,
        /// The status that ended the instance.
        status: Status,
    },

    /// The FMU does not offer an optional capability.
    #[error("{instance}: {function} is not offered by this FMU ({flag} is false)")]
    NotOffered {
        /// Name of the instance.
        instance: String,
        /// FMI function.
        function: &'static str,
        /// Capability flag in modelDescription.xml.
        flag: &'static str,
    },

    /// A state was handed to an instance that did not create it.
    #[error(
        "{instance}: this FMU state belongs to another instance; carry it over with serialize_state and deserialize_state"
    )]
    ForeignState {
        /// Name of the instance.
        instance: String,
    },

    /// Value references and values differ in number.
    #[error("{instance}: {function} got {references} value references and room for {values} values")]
    LengthMismatch {
        /// Name of the instance.
        instance: String,
        /// FMI function.
        function: &'static str,
        /// Number of references.
        references: usize,
        /// Number of values.
        values: usize,
    },

    /// A text holds a NUL byte, which C strings cannot.
    #[error("{instance}: {function} cannot pass {text:?}, which holds a NUL character")]
    NulInText {
        /// Name of the instance.
        instance: String,
        /// FMI function.
        function: &'static str,
        /// The text.
        text: String,
    },

    /// The model has no variable of this name.
    #[error(
        "{model} has no variable {name:?}{}",
        suggestion.as_ref().map_or(String::new(), |s| format!("; did you mean {s:?}?"))
    )]
    UnknownVariable {
        /// The model.
        model: String,
        /// Name that was asked for.
        name: String,
        /// Nearest name the model does have.
        suggestion: Option<String>,
    },

    /// A variable has another type than the use needs.
    #[error("{model}: variable {variable:?} is of type {found}, but {expected} is needed")]
    WrongType {
        /// The model.
        model: String,
        /// The variable.
        variable: String,
        /// Its type.
        found: BaseType,
        /// The type needed.
        expected: BaseType,
    },

    /// A text is no value of the variable's type, or lies outside its bounds.
    #[error("variable {variable:?} ({kind}) cannot be {text:?}: {reason}")]
    BadValue {
        /// The variable.
        variable: String,
        /// Its type.
        kind: BaseType,
        /// The text as given.
        text: String,
        /// What would be allowed.
        reason: String,
    },
}

/// The tail of a message: what the FMU itself had to say.
fn said(messages: &[String]) -> String {
    if messages.is_empty() {
        " without logging a reason".to_owned()
    } else {
        format!(": {}", messages.join("; "))
    }
}
