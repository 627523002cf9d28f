"""Random activities, drawn as nodes and flows and printed as IR text."""

import random
from dataclasses import dataclass, field

WORKERS = ("opaque", "send", "accept")
"""Kinds of actions that take time."""

PROPERTIES = [
    '    Property x "x" default=0',
    "      -> typed-by int",
    '    Property y "y" default=false',
    "      -> typed-by bool",
    '    Constraint r body="0 <= x <= 2"',
]
TYPES = ['  DataType int "Integer"', '  DataType bool "Boolean"']
BODIES = {
    "x := x + 1": ("x", lambda values: min(values["x"] + 1, 2)),
    "x := 0": ("x", lambda values: 0),
    "x := if y ? 2 else x": ("x", lambda values: 2 if values["y"] else values["x"]),
    "y := not y": ("y", lambda values: not values["y"]),
    "y := x > 0": ("y", lambda values: values["x"] > 0),
}
"""Assignments of actions, each with the assigned property and the function that computes it."""
GUARDS = {"x < 2": lambda values: values["x"] < 2, "y": lambda values: values["y"]}
"""Guards over the properties, each with the function that evaluates it."""


@dataclass
class Drawing:
    """An activity: the kinds of nodes by id; source, target and guard of flows by id."""

    nodes: dict[str, str] = field(default_factory=dict)
    flows: dict[str, tuple[str, str, str]] = field(default_factory=dict)
    objects: set[str] = field(default_factory=set)
    """Flows that carry objects, from pin to pin."""
    bodies: dict[str, str] = field(default_factory=dict)
    """The assignments that actions execute when they end."""
    regions: dict[str, set[str]] = field(default_factory=dict)
    """Interruptible regions with their nodes."""
    interrupts: dict[str, str] = field(default_factory=dict)
    """Flows that interrupt a region."""
    implied: set[str] = field(default_factory=set)
    """Flows from accept actions to themselves. They are not drawn: the action waits again."""

    def incoming(self, node):
        return [id for id, (_, target, _) in self.flows.items() if target == node]

    def outgoing(self, node):
        return [id for id, (source, _, _) in self.flows.items() if source == node]

    def print_text(self):
        """Return the activity in IR text."""
        lines = ['Package p "P"', '  Activity a "a"', *(PROPERTIES if self.bodies else [])]
        lines += [f'    Structured {id} "{id}" subkind="interruptible"' for id in self.regions]
        for id, kind in self.nodes.items():
            lines += self._iter_node_lines(id, kind)
        for id in [id for id in self.flows if id not in self.implied]:
            source, target, guard = self.flows[id]
            kind = "ObjectFlow" if id in self.objects else "ControlFlow"
            attributes = f' guard="{guard}"' if guard else ""
            attributes += f' interrupts="{self.interrupts[id]}"' if id in self.interrupts else ""
            lines += [f"    {kind} {id}{attributes}"]
            lines += [f"      -> flow-source {self._name_end(source, id, 'o')}"]
            lines += [f"      -> flow-target {self._name_end(target, id, 'i')}"]
        return "\n".join([*lines, *(TYPES if self.bodies else [])]) + "\n"

    def _iter_node_lines(self, id, kind):
        if kind in (*WORKERS, "value"):
            body = f' body="{self.bodies[id]}"' if id in self.bodies else ""
            yield f'    Action {id} "{id}"{body} subkind="{kind}"'
            yield from self._iter_region_lines(id)
            for flow in sorted(self.objects):
                source, target, _ = self.flows[flow]
                for end, side, direction in ((source, "o", "out"), (target, "i", "in")):
                    if end == id:
                        yield f'      Pin {id}{side}{flow} "{side}{flow}" direction="{direction}"'
        elif kind == "object":
            yield f'    ObjectNode {id} "{id}" subkind="central-buffer"'
        else:
            yield f'    Control {id} "" subkind="{kind}"'
            yield from self._iter_region_lines(id)

    def _iter_region_lines(self, id):
        regions = [region for region, nodes in self.regions.items() if id in nodes]
        if regions:
            yield f"      -> in-partition {' '.join(regions)}"

    def _name_end(self, node, flow, side):
        """Return the id of the pin at which an object flow ends, or of the node."""
        has_pin = flow in self.objects and self.nodes[node] != "object"
        return f"{node}{side}{flow}" if has_pin else node


class ActivityGenerator:
    """Draws a random activity.

    Each method that draws a part of the activity returns the first and the last node of the part.
    """

    def __init__(self, seed):
        self.dice = random.Random(seed)
        self.drawing = Drawing()
        self.remaining_parts = self.dice.randint(2, 7)
        self.guard_count = 0

    def draw(self):
        first, last = self.draw_part(0)
        self.add_flow(self.add_node("initial"), first)
        if self.dice.random() < 0.7:
            self.add_flow(last, self.add_node("final"))
        return self.drawing

    def add_node(self, kind):
        id = f"n{len(self.drawing.nodes)}"
        self.drawing.nodes[id] = kind
        return id

    def add_flow(self, source, target, guard="", is_object=False):
        id = f"f{len(self.drawing.flows)}"
        self.drawing.flows[id] = (source, target, guard)
        if is_object:
            self.drawing.objects.add(id)
        return id

    def choose_guard(self):
        self.guard_count += 1
        return f"g{self.guard_count}"

    def draw_part(self, depth):
        self.remaining_parts -= 1
        shapes = [self.draw_action] * 3
        if self.remaining_parts > 0 and depth < 4:
            shapes += [self._draw_row] * 2
            shapes += [self._draw_parallel, self._draw_implicit_fork, self._draw_branch]
            shapes += [self._draw_choice, self._draw_loop, self._draw_object_flow]
            shapes += [self._draw_dropped_branch, self._draw_ending_branch]
        return self.dice.choice(shapes)(depth + 1)

    def draw_action(self, depth):
        action = self.add_node(self.dice.choice(["opaque", "opaque", "send", "accept", "value"]))
        return action, action

    def _draw_row(self, depth):
        (first, end), (start, last) = self.draw_part(depth), self.draw_part(depth)
        self.add_flow(end, start)
        return first, last

    def _draw_parallel(self, depth):
        return self._draw_two_branches(depth, self.add_node("fork"), self.add_node("join"))

    def _draw_implicit_fork(self, depth):
        """Draw two actions with several flows, which fork and join without control nodes."""
        return self._draw_two_branches(depth, self.add_node("opaque"), self.add_node("opaque"))

    def _draw_two_branches(self, depth, fork, join):
        for _ in range(2):
            first, last = self.draw_part(depth)
            self.add_flow(fork, first)
            self.add_flow(last, join)
        return fork, join

    def _draw_branch(self, depth):
        return self._draw_alternatives(depth, (self.choose_guard(), "else"))

    def _draw_choice(self, depth):
        """Draw a decision of which several guards may hold, or none."""
        return self._draw_alternatives(depth, (self.choose_guard(), self.choose_guard()))

    def _draw_alternatives(self, depth, guards):
        decision, merge = self.add_node("decision"), self.add_node("merge")
        for guard in guards:
            first, last = self.draw_part(depth)
            self.add_flow(decision, first, guard)
            self.add_flow(last, merge)
        return decision, merge

    def _draw_loop(self, depth):
        merge, decision = self.add_node("merge"), self.add_node("decision")
        first, last = self.draw_part(depth)
        self.add_flow(merge, first)
        self.add_flow(last, decision)
        self.add_flow(decision, merge, "else")
        after = self.add_node("opaque")
        self.add_flow(decision, after, self.choose_guard())
        return merge, after

    def _draw_object_flow(self, depth):
        """Draw an action that passes an object to another action, perhaps through a buffer."""
        producer, consumer = self.add_node("opaque"), self.add_node("opaque")
        if self.dice.random() < 0.5:
            buffer = self.add_node("object")
            self.add_flow(producer, buffer, is_object=True)
            self.add_flow(buffer, consumer, is_object=True)
        else:
            self.add_flow(producer, consumer, is_object=True)
        if self.dice.random() < 0.5:
            self.add_flow(producer, consumer)
        return producer, consumer

    def _draw_dropped_branch(self, depth):
        """Draw a fork of which one branch ends at a flow final."""
        return self._draw_side_branch(depth, "flow-final")

    def _draw_ending_branch(self, depth):
        """Draw a fork of which one branch ends the whole activity."""
        return self._draw_side_branch(depth, "final")

    def _draw_side_branch(self, depth, kind):
        fork = self.add_node("fork")
        (first, last), (side_first, side_last) = self.draw_part(depth), self.draw_part(depth)
        self.add_flow(fork, first)
        self.add_flow(fork, side_first)
        self.add_flow(side_last, self.add_node(kind))
        return fork, last


class AssignmentGenerator(ActivityGenerator):
    """Draws a random activity in which actions assign the properties that guards read."""

    def draw_action(self, depth):
        action, _ = super().draw_action(depth)
        if self.drawing.nodes[action] == "opaque":
            self.drawing.bodies[action] = self.dice.choice([*BODIES])
        return action, action

    def choose_guard(self):
        return self.dice.choice([super().choose_guard(), *GUARDS])

    def draw(self):
        """Draw an activity in which at least one action assigns something."""
        drawing = super().draw()
        while not drawing.bodies:
            self.remaining_parts = self.dice.randint(2, 7)
            self.drawing, self.guard_count = Drawing(), 0
            drawing = super().draw()
        return drawing


class RegionGenerator(ActivityGenerator):
    """Draws a random activity with interruptible regions that contain an accept action."""

    def draw_part(self, depth):
        if self.remaining_parts > 1 and depth < 3 and self.dice.random() < 0.35:
            self.remaining_parts -= 1
            return self._draw_region(depth + 1)
        return super().draw_part(depth)

    def _draw_region(self, depth):
        """Draw a part that an accept action without incoming flows interrupts."""
        region = f"r{len(self.drawing.regions)}"
        self.drawing.regions[region] = set()
        before, merge = self.add_node("opaque"), self.add_node("merge")
        outer_nodes = set(self.drawing.nodes)
        first, last = self.draw_part(depth)
        accept = self.add_node("accept")
        self.drawing.regions[region] |= {
            node
            for node, kind in self.drawing.nodes.items()
            if node not in outer_nodes and kind != "object"
        }
        self.add_flow(before, first)
        self.drawing.implied.add(self.add_flow(accept, accept))
        for source in (last, accept):
            self.drawing.interrupts[self.add_flow(source, merge)] = region
        return before, merge
