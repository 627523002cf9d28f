"""Documents around the examples of rules: a page shows a part of an XMI or AutomationML file."""

import re

_XMI = """\
<xmi:XMI xmi:version="20131001" xmlns:xmi="http://www.omg.org/spec/XMI/20131001"
    xmlns:uml="http://www.eclipse.org/uml2/5.0.0/UML"
    xmlns:Blocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/Blocks"
    xmlns:ConstraintBlocks="http://www.eclipse.org/papyrus/sysml/1.6/SysML/ConstraintBlocks"
    xmlns:PortsAndFlows="http://www.eclipse.org/papyrus/sysml/1.6/SysML/PortsAndFlows"
    xmlns:plant="http://example.org/plant">
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
_APPLICATION = re.compile(r"^<(?:Blocks|ConstraintBlocks|PortsAndFlows|plant):.*/>$", re.MULTILINE)


def complete_example(language: str, text: str) -> tuple[str, str]:
    """Return the name and the content of a file that holds the example."""
    if language != "xml":
        return f"model.{language}", text
    if "<packagedElement" in text:
        applications = "\n".join(_APPLICATION.findall(text))
        elements = _APPLICATION.sub("", text)
        return "model.uml", _XMI.format(elements=elements, applications=applications)
    if text.startswith("<InternalElement"):
        text = f'<InstanceHierarchy Name="Plant">\n{text}</InstanceHierarchy>'
    return "model.aml", _CAEX.format(content=text)
