"""Describe coupled FMUs as an SSP archive: ssp.py OUT.ssp FMU... [MODEL.VARIABLE=VALUE...]

FMUs stand in the order in which they are given, and are called by their model names. Equal names connect: every output
to each input that has its name.
"""

import sys
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

SPACES = {
    name: f"http://ssp-standard.org/SSP1/{title}"
    for name, title in {
        "ssd": "SystemStructureDescription",
        "ssv": "SystemStructureParameterValues",
        "ssc": "SystemStructureCommon",
    }.items()
}


def tag(name):
    space, local = name.split(":")
    return f"{{{SPACES[space]}}}{local}"


class Model:
    """What the coupling needs to know of an FMU."""

    def __init__(self, path):
        self.path = Path(path)
        with zipfile.ZipFile(path) as archive:
            self.root = ET.fromstring(archive.read("modelDescription.xml"))
        self.name = self.root.get("modelName")
        self.variables = {v.get("name"): v for v in self.root.find("ModelVariables")}

    def kind(self, name):
        return self.variables[name][0].tag

    def names(self, causality):
        return [name for name, v in self.variables.items() if v.get("causality") == causality]


def wiring(models):
    """Source, name and reader of each connection."""
    outputs = [(source, name) for source in models for name in source.names("output")]
    return [(source, name, reader) for source, name in outputs for reader in models if name in reader.names("input")]


def parameter_set(parent, title, model, settings):
    values = ET.SubElement(parent, tag("ssv:ParameterSet"), version="1.0", name=title)
    parameters = ET.SubElement(values, tag("ssv:Parameters"))
    for name, text in settings.items():
        parameter = ET.SubElement(parameters, tag("ssv:Parameter"), name=name)
        ET.SubElement(parameter, tag(f"ssv:{model.kind(name)}"), value=text)


def component(elements, title, model, connectors, settings):
    own = ET.SubElement(elements, tag("ssd:Component"), name=model.name, source=f"resources/{model.path.name}")
    own.set("type", "application/x-fmu-sharedlibrary")
    listed = ET.SubElement(own, tag("ssd:Connectors"))
    for name in connectors:
        connector = ET.SubElement(listed, tag("ssd:Connector"), name=name)
        connector.set("kind", model.variables[name].get("causality"))
        ET.SubElement(connector, tag(f"ssc:{model.kind(name)}"))
    if settings:
        binding = ET.SubElement(ET.SubElement(own, tag("ssd:ParameterBindings")), tag("ssd:ParameterBinding"))
        parameter_set(ET.SubElement(binding, tag("ssd:ParameterValues")), title, model, settings)


def write(out, paths, settings, shown=()):
    """Writes the archive.

    settings: text by variable, by model. shown: outputs that get a connector though nothing reads them.
    """
    models = [Model(path) for path in paths]
    wires = wiring(models)
    for name, uri in SPACES.items():
        ET.register_namespace(name, uri)
    title = Path(out).stem
    root = ET.Element(tag("ssd:SystemStructureDescription"), name=title, version="1.0")
    system = ET.SubElement(root, tag("ssd:System"), name=title)
    elements = ET.SubElement(system, tag("ssd:Elements"))
    for model in models:
        connected = {name for source, name, reader in wires if model in (source, reader)}
        connectors = [name for name in model.variables if name in connected or name in shown]
        component(elements, title, model, connectors, settings.get(model.name, {}))
    connections = ET.SubElement(system, tag("ssd:Connections"))
    for source, name, reader in wires:
        ends = {"startElement": source.name, "startConnector": name, "endElement": reader.name, "endConnector": name}
        ET.SubElement(connections, tag("ssd:Connection"), ends)
    ET.SubElement(root, tag("ssd:DefaultExperiment"), startTime="0.0")
    ET.indent(root)
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("SystemStructure.ssd", ET.tostring(root, encoding="UTF-8", xml_declaration=True))
        for model in models:
            archive.write(model.path, f"resources/{model.path.name}")


def main(out, *arguments):
    settings = {}
    for assignment in [a for a in arguments if "=" in a]:
        target, value = assignment.split("=", 1)
        model, name = target.split(".", 1)
        settings.setdefault(model, {})[name] = value
    write(out, [a for a in arguments if "=" not in a], settings)


if __name__ == "__main__":
    main(*sys.argv[1:])
