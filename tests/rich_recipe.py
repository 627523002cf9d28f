"""A recipe with every member of the format sysmlc-recipe that the examples do not use."""

import recipe_samples as samples

_PROFILE = 'namespace="urn:sysmlc:profile:1"'
_WAIT = """\
    Action w "wait" subkind="accept"
      Trigger w.t subkind="change" condition="n > arm.load"
      Pin w.ok "ok" direction="out"
        -> typed-by Boolean
    Action paint "paint" subkind="call-behavior"
      -> calls place
      Pin paint.ok "ok" direction="in"
        -> typed-by Boolean
    ObjectFlow mount.flow
      -> flow-source w.ok
      -> flow-target paint.ok
"""
_STEPS = (*samples.STEPS[:-1], "m w", "paint e")
_TAGS = {
    '  Class robot "Robot" level="machine"\n': f"""\
    Application robot.m stereotype="Machine" {_PROFILE} tag.plantElement="Cell/Robot 1"
      -> subject robot
    Property robot.load "load" default=3
      -> typed-by speed
""",
    '  Class plate "Plate" level="material"\n': f"""\
    Application plate.m stereotype="Material" {_PROFILE} tag.noWait="true"
      -> subject plate
    Property plate.limit "limit" default=5
      -> typed-by speed
""",
    '  Activity r "Build" level="recipe"\n': f"""\
    Application r.s stereotype="Recipe" {_PROFILE} tag.noWait="true"
      -> subject r
    Parameter r.count "count" direction="out"
      -> typed-by Integer
    Parameter r.blank "blank" direction="in"
      -> typed-by plate
    Parameter r.speed "speed" direction="in"
      -> typed-by speed
""",
    '  Activity mount "Mount" level="task"\n': f"""\
    Application mount.s stereotype="Task" {_PROFILE} tag.pre="n == 0" tag.post="ok" \
tag.interruptible="true" tag.noWait="true"
      -> subject mount
    Parameter mount.arm "arm" direction="in" multiplicity="1"
      -> typed-by robot
""",
}


def rich_recipe() -> str:
    """Return the model in IR text."""
    text = samples.task(nodes=samples.NODES + _WAIT, steps=_STEPS)
    for line, addition in _TAGS.items():
        assert line in text
        text = text.replace(line, line + addition)
    text = text.replace('tag.acquire="gripper"', 'tag.acquire="gripper" tag.interruptible="true"')
    unavailable = 'stereotype="Capability" namespace="urn:sysmlc:profile:1" tag.duration="300"'
    assert unavailable in text
    text = text.replace(unavailable, f'{unavailable} tag.available="false"')
    text += '  DataType speed "Speed"\n'
    text += '    Application speed.v stereotype="ValueType" namespace="urn:sysml" tag.unit="mm/s"\n'
    text += "      -> subject speed\n"
    return text.replace('tag.method="ns=2;s=Grip"', 'tag.method="ns=2;s=Grip" tag.doneWhen="ok"')
