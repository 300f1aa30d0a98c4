"""Describe the coupling of a truth and a navigation FMU as an SSP folder: ssp.py TRUTH NAV FOLDER [MODEL.VARIABLE=VALUE...]

Equal names connect: every output of the truth to the input of the filter that has its name. Parameters that are
enumerations cannot be set: libcosim does not know the type.
"""

import shutil
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


def component(elements, model, connectors, settings):
    own = ET.SubElement(elements, tag("ssd:Component"), name=model.name, source=f"resources/{model.path.name}")
    own.set("type", "application/x-fmu-sharedlibrary")
    listed = ET.SubElement(own, tag("ssd:Connectors"))
    for name in connectors:
        connector = ET.SubElement(listed, tag("ssd:Connector"), name=name)
        connector.set("kind", model.variables[name].get("causality"))
        ET.SubElement(connector, tag(f"ssc:{model.kind(name)}"))
    if settings:
        binding = ET.SubElement(ET.SubElement(own, tag("ssd:ParameterBindings")), tag("ssd:ParameterBinding"))
        values = ET.SubElement(binding, tag("ssd:ParameterValues"))
        group = ET.SubElement(values, tag("ssv:ParameterSet"), version="1.0", name=model.name)
        parameters = ET.SubElement(group, tag("ssv:Parameters"))
        for name, text in settings.items():
            parameter = ET.SubElement(parameters, tag("ssv:Parameter"), name=name)
            ET.SubElement(parameter, tag(f"ssv:{model.kind(name)}"), value=text)


def write(truth, nav, folder, assignments):
    truth, nav, folder = Model(truth), Model(nav), Path(folder)
    settings = {truth.name: {}, nav.name: {}}
    for assignment in assignments:
        target, value = assignment.split("=", 1)
        model, name = target.split(".", 1)
        settings[model][name] = value
    wires = [name for name in nav.names("input") if name in truth.names("output")]

    for name, uri in SPACES.items():
        ET.register_namespace(name, uri)
    root = ET.Element(tag("ssd:SystemStructureDescription"), name="relative-navigation", version="1.0")
    system = ET.SubElement(root, tag("ssd:System"), name="relative-navigation")
    elements = ET.SubElement(system, tag("ssd:Elements"))
    component(elements, truth, wires, settings[truth.name])
    component(elements, nav, wires, settings[nav.name])
    connections = ET.SubElement(system, tag("ssd:Connections"))
    for name in wires:
        wire = ET.SubElement(connections, tag("ssd:Connection"), startElement=truth.name, startConnector=name)
        wire.set("endElement", nav.name)
        wire.set("endConnector", name)
    ET.SubElement(root, tag("ssd:DefaultExperiment"), startTime="0.0")

    resources = folder / "resources"
    resources.mkdir(parents=True, exist_ok=True)
    for model in (truth, nav):
        shutil.copy(model.path, resources)
    ET.indent(root)
    ET.ElementTree(root).write(folder / "SystemStructure.ssd", encoding="UTF-8", xml_declaration=True)


if __name__ == "__main__":
    write(*sys.argv[1:4], sys.argv[4:])
