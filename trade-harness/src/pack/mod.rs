//! Builds our two FMU crates and puts each into a `.fmu` file of FMI 2.0 and one of FMI 3.0.

mod date;
mod documentation;
pub mod fmi3;
mod linked;
pub mod platforms;
mod reference;
mod terminals;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{BufRead, BufReader, Cursor, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use fmi2_import::{Fmu, PLATFORM};
use interface::mission::{Document, EMBEDDED, PACKED, SHIPPED, guid_with};
use study::{NAV, StudyError, TRUTH, World, filters_of};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

pub(crate) use documentation::GROUPS;
use platforms::{Call, Platform, joined, recipes};
use reference::{Reference, Table};

use crate::HarnessError;
use crate::digest::of_bytes;
use crate::output::write_whole;
use crate::structure;

/// The description, first in an archive, so that whoever reads one as a stream has it at once.
const DESCRIPTION: &str = "modelDescription.xml";

/// What a tool of FMI 2.0 shows in place of an FMU.
const ICON: &str = "model.png";

/// Folder of the reference result in an FMU.
const REFERENCE: &str = "documentation/reference";

/// Our FMUs: crate and model name, and the identifier that library and C functions go by.
pub const FMUS: [(&str, &str); 2] = [(TRUTH, "fmu_truth"), (NAV, "fmu_nav")];

/// A `.fmu` file that is up to date.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Packed {
    /// The file.
    pub path: PathBuf,
    /// Whether it had to be written.
    pub written: bool,
}

/// The workspace this harness was compiled in.
pub fn home_workspace() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().unwrap_or(own).to_owned()
}

/// Where `.fmu` files go unless said otherwise.
pub fn default_folder(workspace: &Path) -> PathBuf {
    workspace.join("target/fmu")
}

/// Path of one of our FMUs in a folder.
pub fn fmu_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.fmu"))
}

/// Builds what has changed and packs both FMUs into a folder, with the system of them, their FMI 3.0 twins into [`fmi3::folder`] of it
/// and reference results as the FMI cross-check rules name them into `cross-check`; a file whose contents would be the same stays.
///
/// * `mission`: a mission file that both run unless told otherwise; it makes them FMUs with identifiers of their own.
///
/// Cargo shows its own progress on stderr, unless `quiet`.
///
/// # Errors
/// [`HarnessError::NoWorkspace`], [`HarnessError::NoCargo`], [`HarnessError::Build`], [`HarnessError::NoLibrary`],
/// reading, writing and zip errors, and [`HarnessError::DoesNotStart`] for a library and description that do not belong together.
pub fn pack(workspace: &Path, folder: &Path, mission: Option<&Path>, quiet: bool) -> Result<Vec<Packed>, HarnessError> {
    pack_for(&BTreeSet::new(), workspace, folder, mission, quiet)
}

/// [`pack`] for these platforms; for none, for the one that this program runs on.
///
/// # Errors
/// Those of [`pack`], [`HarnessError::Platforms`] and [`HarnessError::Universal`].
pub fn pack_for(
    platforms: &BTreeSet<Platform>,
    workspace: &Path,
    folder: &Path,
    mission: Option<&Path>,
    quiet: bool,
) -> Result<Vec<Packed>, HarnessError> {
    let (world, resources) = resources(mission)?;
    let built = build_all(platforms, workspace, quiet)?;
    let date = date::of(workspace)?;
    let dated = |xml| date::dated(xml, date.as_deref());
    let mut said = Table::default();
    let mut packed = Vec::new();
    for (name, identifier) in FMUS {
        let no_library = || HarnessError::NoLibrary {
            target: identifier.to_owned(),
        };
        let libraries = built.libraries.get(identifier).ok_or_else(no_library)?;
        let guid = built.guids.get(name).ok_or(HarnessError::NoIdentifier { name })?;
        let committed = workspace.join("modelDescription").join(name);
        let description = committed.join("modelDescription.xml");
        let inside = world.as_ref().zip(resources.get(&packed_mission()));
        let mut files = BTreeMap::from([(
            DESCRIPTION.to_owned(),
            dated(described(read(&description)?, "guid", guid, inside)),
        )]);
        files.extend(libraries.clone());
        files.extend(resources.clone());
        let path = fmu_path(folder, name);
        let fmu = trial(name, &path, &files)?;
        let reference = if runs_here(&files) {
            Reference::of(&fmu, &mut said)?.files()
        } else {
            [Files::new(), Files::new()]
        };
        let picture = read(&committed.join("icon.svg"))?;
        let page = read(&committed.join("documentation.html"))?;
        let told = filters_of(fmu.description())?;
        let page = |of| {
            let page = String::from_utf8_lossy(&page);
            documentation::html(fmu.description(), &told, runs_here(&files), &page, of).into_bytes()
        };
        let pages = [page("FMI 2.0"), page("FMI 3.0, elements of arrays listed one by one")];
        let [page, page_of_twin] = pages;
        files.insert(documentation::PAGE.to_owned(), page);
        files.insert("documentation/picture.svg".to_owned(), picture.clone());
        files.extend(linked::files(workspace, name, &built.platforms, &built.sources)?);
        let shared = files.clone();
        files.insert(ICON.to_owned(), read(&committed.join("icon.png"))?);
        files.extend(beside(&reference[0], REFERENCE));
        let twin = read(&fmi3::description(workspace, name))?;
        let described = dated(described(twin, fmi3::IDENTIFIER, guid, inside));
        let mut twin = fmi3::files(&shared, &built.platforms, described);
        twin.insert(documentation::PAGE.to_owned(), page_of_twin);
        twin.extend(beside(&reference[1], REFERENCE));
        twin.extend(fmi3::drawn(
            terminals::xml(fmu.description()),
            picture,
            files[ICON].clone(),
        ));
        packed.push(write(path, &files)?);
        packed.push(write(fmu_path(&fmi3::folder(folder), name), &twin)?);
        for (file, contents) in &reference[0] {
            keep(&folder.join("cross-check").join(name).join(file), contents)?;
        }
    }
    let written = structure::write(folder, world.as_ref())?;
    packed.push(Packed {
        path: folder.join(structure::SSP),
        written,
    });
    Ok(packed)
}

/// Puts files into an archive, unless it is there as it would be.
fn write(path: PathBuf, files: &Files) -> Result<Packed, HarnessError> {
    let written = keep(&path, &archive(&path, files)?)?;
    Ok(Packed { path, written })
}

/// Writes a file, unless it is there as it would be; returns whether it had to.
fn keep(path: &Path, contents: &[u8]) -> Result<bool, HarnessError> {
    let stands = fs::read(path).is_ok_and(|there| there == contents);
    if !stands {
        write_whole(path, contents)?;
    }
    Ok(!stands)
}

/// Files as they stand in a folder of the archive.
fn beside(files: &Files, folder: &str) -> Files {
    let placed = |(file, contents): (&String, &Vec<u8>)| (format!("{folder}/{file}"), contents.clone());
    files.iter().map(placed).collect()
}

/// Whether there is a library for this platform.
fn runs_here(files: &Files) -> bool {
    let folder = format!("binaries/{PLATFORM}/");
    files.keys().any(|file| file.starts_with(&folder))
}

/// Contents by name in the archive.
type Files = BTreeMap<String, Vec<u8>>;

/// Place, in an FMU, of the mission that it is packed with.
fn packed_mission() -> String {
    format!("resources/{PACKED}")
}

/// The missions that come with an FMU, and the one it is packed with, with the files that it names.
fn resources(mission: Option<&Path>) -> Result<(Option<World>, Files), HarnessError> {
    let mut files: Files = EMBEDDED
        .iter()
        .map(|entry| {
            let name = format!("resources/{SHIPPED}/{}.toml", entry.name);
            (name, entry.text.as_bytes().to_vec())
        })
        .collect();
    let Some(path) = mission else {
        return Ok((None, files));
    };
    let told = |source| HarnessError::from(StudyError::from(source));
    let mut document = Document::read(path).map_err(told)?;
    // What is wrong with it is told here rather than by the FMU.
    let world = World::of(document.mission().map_err(told)?)?;
    for (key, field) in document.files().map_err(told)? {
        let name = field.file_name().map(|n| n.to_string_lossy().into_owned());
        let contents = read(&field)?;
        // The digest tells two files of one name apart, and takes their contents into the identifier, which is made of this text.
        let name = format!("fields/{}/{}", of_bytes(&contents), name.unwrap_or_default());
        files.insert(format!("resources/{name}"), contents);
        document.set(key, &format!("{name:?}")).map_err(told)?;
    }
    files.insert(packed_mission(), document.text().as_bytes().to_vec());
    Ok((Some(world), files))
}

/// A model description with the identifier that follows from its text and the one that the build gave its library, so that a library
/// refuses a description of other variables than its own, and with a mission inside, the identifier, the length of a run and the step
/// that belong to it.
///
/// * `identifier`: the attribute it stands in.
fn described(xml: Vec<u8>, identifier: &str, guid: &str, mission: Option<(&World, &Vec<u8>)>) -> Vec<u8> {
    let own = guid_with(&format!("{{{guid}}}"), &xml);
    let text = String::from_utf8_lossy(&xml).into_owned();
    let with = |text: String, name: &str, value: String| {
        let old = format!("{name}=\"{}\"", attribute(&text, name));
        text.replacen(&old, &format!("{name}=\"{value}\""), 1)
    };
    let Some((world, mission)) = mission else {
        return with(text, identifier, own).into_bytes();
    };
    let text = with(text, identifier, guid_with(&own, mission));
    let text = with(text, "stopTime", world.duration_s.to_string());
    with(text, "stepSize", world.sample_period_s.to_string()).into_bytes()
}

/// Value of the first attribute of this name.
fn attribute<'a>(xml: &'a str, name: &str) -> &'a str {
    let rest = xml.split_once(&format!("{name}=\"")).map_or("", |(_, rest)| rest);
    rest.split('"').next().unwrap_or_default()
}

/// What cargo made: `Library` of each identifier.
#[derive(Debug)]
struct Built<Library> {
    /// What it runs on.
    platforms: Vec<platforms::RunsOn>,
    libraries: BTreeMap<String, Library>,
    /// GUID of each crate's build, without braces.
    guids: BTreeMap<&'static str, String>,
    /// Where the packages of others are.
    sources: linked::Sources,
}

/// The libraries of every platform by their names in the archive.
fn build_all(platforms: &BTreeSet<Platform>, workspace: &Path, quiet: bool) -> Result<Built<Files>, HarnessError> {
    let mut all = Built {
        platforms: Vec::new(),
        libraries: BTreeMap::<String, Files>::new(),
        guids: BTreeMap::new(),
        sources: linked::Sources::new(),
    };
    for recipe in recipes(platforms, workspace)? {
        all.platforms.extend(recipe.built());
        let mut parts: BTreeMap<String, Vec<Vec<u8>>> = BTreeMap::new();
        for call in &recipe.calls {
            let built = build(workspace, quiet, call, recipe.suffix)?;
            for (identifier, library) in built.libraries {
                parts.entry(identifier).or_default().push(read(&library)?);
            }
            all.guids.extend(built.guids);
            all.sources.extend(built.sources);
        }
        for (identifier, parts) in parts {
            let name = format!("binaries/{}/{identifier}.{}", recipe.folder, recipe.suffix);
            all.libraries
                .entry(identifier)
                .or_default()
                .insert(name, joined(parts)?);
        }
    }
    Ok(all)
}

/// Runs cargo once, for libraries of this suffix.
fn build(workspace: &Path, quiet: bool, call: &Call, suffix: &str) -> Result<Built<PathBuf>, HarnessError> {
    let manifest = workspace.join("Cargo.toml");
    if !FMUS
        .iter()
        .all(|(name, _)| workspace.join(name).join("Cargo.toml").is_file())
    {
        return Err(HarnessError::NoWorkspace {
            path: workspace.to_owned(),
        });
    }
    let mut command = Command::new(&call.program);
    command.args(&call.arguments);
    command.args(["--message-format", "json-render-diagnostics", "--manifest-path"]);
    command.arg(&manifest);
    command.envs(call.environment.iter().map(|(name, value)| (name, value)));
    for (name, _) in FMUS {
        command.args(["--package", name]);
    }
    if quiet {
        command.arg("--quiet");
    }
    let no_cargo = |source| HarnessError::NoCargo {
        program: call.program.clone(),
        source,
    };
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(no_cargo)?;
    let mut built = Built {
        platforms: Vec::new(),
        libraries: BTreeMap::new(),
        guids: BTreeMap::new(),
        sources: linked::Sources::new(),
    };
    if let Some(messages) = child.stdout.take() {
        for line in BufReader::new(messages).lines().map_while(Result::ok) {
            built.libraries.extend(library_of(&line, suffix));
            built.guids.extend(guid_of(&line));
            built.sources.extend(linked::source_of(&line));
        }
    }
    let status = child.wait().map_err(no_cargo)?;
    if status.success() {
        Ok(built)
    } else {
        Err(HarnessError::Build { status })
    }
}

/// Target and file of a shared library, if this line of cargo's JSON messages tells of one.
fn library_of(line: &str, suffix: &str) -> Option<(String, PathBuf)> {
    let message: serde_json::Value = serde_json::from_str(line).ok()?;
    if message["reason"] != "compiler-artifact" {
        return None;
    }
    let files = message["filenames"].as_array()?;
    let library = files
        .iter()
        .filter_map(|f| f.as_str())
        .map(Path::new)
        .find(|f| f.extension().is_some_and(|extension| extension == suffix))?;
    Some((message["target"]["name"].as_str()?.to_owned(), library.to_owned()))
}

/// One of our FMU crates and the GUID that its build script gave it, if this line of cargo's JSON messages tells of one.
fn guid_of(line: &str) -> Option<(&'static str, String)> {
    let message: serde_json::Value = serde_json::from_str(line).ok()?;
    if message["reason"] != "build-script-executed" {
        return None;
    }
    let package = message["package_id"].as_str()?;
    // The folder of each crate has its name.
    let (name, _) = FMUS
        .into_iter()
        .find(|(name, _)| package.contains(&format!("/{name}#")))?;
    let variables = message["env"].as_array()?;
    let guid = variables.iter().find(|pair| pair[0] == "FMU_GUID")?;
    Some((name, guid[1].as_str()?.to_owned()))
}

/// A zip archive that depends on names and contents alone, the description first.
fn archive(path: &Path, files: &BTreeMap<String, Vec<u8>>) -> Result<Vec<u8>, HarnessError> {
    let failed = |source| HarnessError::Zip {
        path: path.to_owned(),
        source,
    };
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(zip::DateTime::default())
        .unix_permissions(0o644);
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    let first = files.get_key_value(DESCRIPTION);
    for (name, contents) in first
        .into_iter()
        .chain(files.iter().filter(|(name, _)| *name != DESCRIPTION))
    {
        writer.start_file(name, options).map_err(failed)?;
        writer.write_all(contents).map_err(|e| failed(e.into()))?;
    }
    Ok(writer.finish().map_err(failed)?.into_inner())
}

fn read(path: &Path) -> Result<Vec<u8>, HarnessError> {
    fs::read(path).map_err(|source| HarnessError::Read {
        path: path.to_owned(),
        source,
    })
}

/// Opens the FMU as far as it is, and starts it where it has a library for this platform, so that a description that does not belong
/// to the library is found here.
fn trial(name: &'static str, path: &Path, files: &Files) -> Result<Fmu, HarnessError> {
    let unwritable = |source| HarnessError::Write {
        path: path.to_owned(),
        source,
    };
    let mut trial = tempfile::Builder::new().suffix(".fmu").tempfile().map_err(unwritable)?;
    trial.write_all(&archive(path, files)?).map_err(unwritable)?;
    let fmu = Fmu::open(trial.path())?;
    if runs_here(files) {
        fmu.instantiate("pack", false)
            .map_err(|source| HarnessError::DoesNotStart {
                name,
                source: Box::new(source),
            })?;
    }
    Ok(fmu)
}

#[cfg(test)]
mod tests {
    use super::*;
    use fmi2_import::LIBRARY_SUFFIX;
    use std::io::Read;

    #[test]
    fn archives_of_equal_files_are_equal_bytes() {
        let files = BTreeMap::from([
            ("modelDescription.xml".to_owned(), b"<x/>".to_vec()),
            ("binaries/linux64/m.so".to_owned(), vec![7; 5000]),
        ]);
        let path = Path::new("m.fmu");
        let bytes = archive(path, &files).unwrap();
        assert_eq!(bytes, archive(path, &files).unwrap());
        let mut zip = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        let names: Vec<String> = zip.file_names().map(|n| n.unwrap().into_owned()).collect();
        assert_eq!(names, ["modelDescription.xml", "binaries/linux64/m.so"]);
        let mut text = String::new();
        zip.by_name("modelDescription.xml")
            .unwrap()
            .read_to_string(&mut text)
            .unwrap();
        assert_eq!(text, "<x/>");
    }

    #[test]
    fn another_text_of_the_description_or_another_build_makes_another_guid() {
        let one = "7f1f3d1c-0d7e-5f6a-9b1e-1c2d3e4f5a6b";
        let other = one.replace('7', "8");
        let guid = |text: &str, build: &str| {
            let xml = format!("<m guid=\"{{made-by-the-build}}\"><v name=\"{text}\"/></m>");
            let packed = String::from_utf8(described(xml.clone().into_bytes(), "guid", build, None)).unwrap();
            let guid = attribute(&packed, "guid").to_owned();
            assert_eq!(packed, xml.replace("{made-by-the-build}", &guid));
            guid
        };
        let first = guid("x", one);
        assert_eq!(first, guid("x", one));
        assert_ne!(first, guid("y", one));
        assert_ne!(first, guid("x", &other));
    }

    #[test]
    fn guids_are_found_in_cargos_messages() {
        let line = |name: &str| {
            format!(
                r#"{{"reason":"build-script-executed","package_id":"path+file:///w/{name}#0.1.0","env":[["FMU_GUID","7f1f3d1c-0d7e-5f6a-9b1e-1c2d3e4f5a6b"]]}}"#
            )
        };
        let guid = "7f1f3d1c-0d7e-5f6a-9b1e-1c2d3e4f5a6b".to_owned();
        assert_eq!(guid_of(&line("fmu-nav")), Some(("fmu-nav", guid)));
        assert_eq!(guid_of(&line("other")), None);
    }

    #[test]
    fn libraries_are_found_in_cargos_messages() {
        let line = format!(
            r#"{{"reason":"compiler-artifact","target":{{"name":"fmu_nav","kind":["cdylib"]}},"filenames":["/t/libfmu_nav.{LIBRARY_SUFFIX}","/t/libfmu_nav.d"]}}"#
        );
        let found = library_of(&line, LIBRARY_SUFFIX).unwrap();
        assert_eq!(
            found,
            (
                "fmu_nav".to_owned(),
                PathBuf::from(format!("/t/libfmu_nav.{LIBRARY_SUFFIX}"))
            )
        );
        assert!(library_of(r#"{"reason":"build-finished","success":true}"#, LIBRARY_SUFFIX).is_none());
        assert!(library_of("no json", LIBRARY_SUFFIX).is_none());
    }

    #[test]
    fn a_folder_that_is_no_workspace_is_told() {
        let dir = tempfile::tempdir().unwrap();
        let error = pack(dir.path(), dir.path(), None, true).unwrap_err();
        assert!(matches!(error, HarnessError::NoWorkspace { .. }), "{error}");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
