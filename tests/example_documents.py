"""Documents around the examples of rules: a page shows a part of an XMI or AutomationML file."""

import re

_XMI = """\
<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"
    xmlns:Activities="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Activities"
    xmlns:Allocations="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Allocations"
    xmlns:Blocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Blocks"
    xmlns:ConstraintBlocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/ConstraintBlocks"
    xmlns:PortsAndFlows="http://www.eclipse.org/papyrus/sysml/1.6/SysML/PortsAndFlows"
    xmlns:Requirements="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Requirements"
    xmlns:plant="http://example.org/plant"
    xmlns:sysmlc="urn:sysmlc:profile:1">
  <uml:Model xmi:id="model" name="Model">
{elements}
  </uml:Model>
{applications}
</xmi:XMI>
"""
_CAEX = """\
<CAEXFile xmlns="http://www.dke.de/CAEX" SchemaVersion="3.0" FileName="model.aml">
{content}
</CAEXFile>
"""
_INTERCHANGE = """\
<sysml:Namespace xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:sysml="https://www.omg.org/spec/SysML/20250201" xmi:id="root">
  <ownedRelationship xsi:type="sysml:OwningMembership">
{element}
  </ownedRelationship>
</sysml:Namespace>
"""
_MTIP = """\
<packet>
<metadata><mtipVersion>2022x v1.0.0</mtipVersion></metadata>
{records}
</packet>
"""
_APPLICATION = re.compile(
    r"^<(?:Activities|Allocations|Blocks|ConstraintBlocks|PortsAndFlows|Requirements|plant|sysmlc)"
    r":.*/>$",
    re.MULTILINE,
)
_FILE_NAMES = {
    "CAEXFile": "model.aml",
    "html": "model.xml",
    "sysml:Namespace": "model.sysmlx",
    "uml:Model": "model.uml",
    "xmi:XMI": "model.uml",
}
"""The root elements of examples that are complete documents, with names of their files."""


def complete_example(language: str, text: str) -> tuple[str, str]:
    """Return the name and the content of a file that contains the example."""
    if language != "xml":
        return f"model.{language}", text
    tag = re.findall(r"<([\w:]+)", text)[0]
    if tag in _FILE_NAMES:
        return _FILE_NAMES[tag], text
    if tag == "data":
        return "model.xml", _MTIP.format(records=text)
    if tag == "ownedRelatedElement":
        return "model.sysmlx", _INTERCHANGE.format(element=text)
    if "<packagedElement" in text:
        applications = "\n".join(_APPLICATION.findall(text))
        elements = _APPLICATION.sub("", text)
        return "model.uml", _XMI.format(elements=elements, applications=applications)
    if tag == "InternalElement":
        text = f'<InstanceHierarchy Name="Plant">\n{text}</InstanceHierarchy>'
    return "model.aml", _CAEX.format(content=text)
