//! The zip archive and the files in it.

use crate::rule::rules;

rules! {
    DESCRIPTION = "archive.description", Error, "2.3", "modelDescription.xml stands at the root of the archive", "pack the contents of the folder, not the folder";
    FIRST = "archive.first", Note, "2.3", "modelDescription.xml is the first entry", "write it first: tools that list FMUs then read only the beginning";
    ENTRY = "archive.entry", Error, "2.3", "every entry can be unpacked", "pack the file again";
    PATH = "archive.path", Error, "2.3", "every entry stays inside the archive: no absolute path, no `..`, no drive", "name entries relative to the root";
    BACKSLASH = "archive.backslash", Error, "2.3", "folders are separated by slashes", "write `/` instead of `\\`";
    DUPLICATE = "archive.duplicate", Error, "2.3", "no two entries have one name, on systems either that ignore case", "keep one of them";
    LINK = "archive.link", Warning, "2.3", "no entry is a symbolic link", "pack the file that it points at";
    COMPRESSION = "archive.compression", Warning, "2.3", "entries are stored or deflated", "pack with the method deflate";
    NAME = "archive.name", Warning, "2.3", "names of entries are ASCII", "rename the file: not every tool reads other names";
    UNKNOWN = "archive.unknown", Note, "2.3", "the root holds nothing but what the standard names", "move it to resources/ or extra/";
    IMPLEMENTATION = "archive.implementation", Error, "2.3", "there are binaries or sources", "add a library under binaries/ or the sources";
    PLATFORM = "archive.platform", Warning, "2.3", "folders under binaries/ have names of the standard (win32, win64, linux32, linux64, darwin32, darwin64)", "rename the folder, or expect only some tools to look there";
    LIBRARY = "archive.binary", Error, "2.3", "each platform has a library MODELIDENTIFIER with the suffix of its system", "name the file after modelIdentifier";
    MACHINE = "archive.machine", Error, "2.3", "a library is of the format and machine that its folder says", "move it to its own folder, or build it for this one";
    EXPORT = "archive.export", Error, "2.1.1", "a library exports every function of its interface and of its capabilities", "export the function under its name of the standard";
    EXPORT_OPTIONAL = "archive.export-optional", Warning, "2.1.1", "a library exports functions of capabilities that it does not offer, too", "export a function that returns fmi2Error: some masters look up every name";
    SOURCE = "archive.source", Error, "2.3", "files listed in SourceFiles are under sources/", "add the file or take it off the list";
    SOURCE_UNLISTED = "archive.source-unlisted", Note, "2.3", "sources/ is described by SourceFiles", "list what has to be compiled";
    ICON = "archive.icon", Warning, "2.3", "model.png is a PNG", "convert the picture";
    DOCUMENTATION = "archive.documentation", Warning, "2.3", "documentation/ has the page index.html to begin with", "add documentation/index.html";
    LICENCE = "archive.licence", Warning, "2.3", "documentation/licenses/ has license.txt or license.html to begin with", "add documentation/licenses/license.txt";
    TERMINALS = "archive.terminals", Warning, "2.3", "terminalsAndIcons/ has a well-formed terminalsAndIcons.xml", "add or mend terminalsAndIcons/terminalsAndIcons.xml";
}
