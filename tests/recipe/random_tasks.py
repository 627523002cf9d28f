"""Random task graphs as IR text, and their executions by the reference interpreter with a clock.

The interpreter of activities moves the tokens. The clock lets a service last as long as one of its
machines needs for it; a machine does one service at a time and is never idle while one waits.
"""

from collections.abc import Iterator
from random import Random

from msgspec.structs import replace

from refinement import run_steps
from sysmlc.diagnostics import Sink
from sysmlc.ir import parse_text
from sysmlc.logic import evaluate
from sysmlc.logic.activities import interpreter
from sysmlc.logic.activities.token_graph import TokenGraph
from sysmlc.logic.activities.token_nodes import Handshake
from sysmlc.recipe.model import Model, Task

_PROFILE = 'namespace="urn:sysmlc:profile:1"'
_HEAD = """\
Package p "Plant"
  Class left "Left" level="machine"
  Class right "Right" level="machine"
  DataType Boolean "Boolean"
  DataType Integer "Integer"
  Activity r "Build" level="recipe"
    Action r.a "work" subkind="call-behavior"
      -> calls t
  Activity t "Work" level="task"
"""
_ON = """\
  Dependency {client}.{machine} {attrs}
    Application {client}.{machine}.c stereotype="Capability" {profile}{time}
      -> subject {client}.{machine}
    -> client {client}
    -> supplier {machine}
"""


class TaskGraph:
    """A random task graph of nested blocks: sequences, forks, decisions and loops."""

    def __init__(self, dice: Random) -> None:
        self._dice = dice
        self._nodes: list[str] = []
        self._flows: list[str] = []
        self._services: list[str] = []
        self._count = 0
        self.offers: dict[str, dict[str, int]] = {}
        """The time of each service by machine; the empty machine is none."""
        self.start: dict[str, object] = {}
        self.assignments: dict[str, tuple[str, int | None]] = {}
        """The variable and the value that an assignment sets; None adds one."""
        self.outputs: dict[str, tuple[str, int]] = {}
        """The Boolean that a service sets, and after how many attempts it is true at the latest."""
        start = self._add_control("initial")
        last = self._draw_block(start, "", 3)
        self._connect(*last, self._add_control("final"))

    def _add_control(self, subkind: str) -> str:
        self._count += 1
        id = f"{subkind[0]}{self._count}"
        self._nodes.append(f'    Control {id} "{id}" subkind="{subkind}"')
        return id

    def _connect(self, source: str, guard: str, target: str) -> None:
        words = f' guard="{guard}"' if guard else ""
        self._flows.append(
            f"    ControlFlow w{len(self._flows)}{words}\n"
            f"      -> flow-source {source}\n      -> flow-target {target}"
        )

    def _draw_block(self, source: str, guard: str, depth: int) -> tuple[str, str]:
        """Add a random block behind an edge; return the source and guard of the edge after it."""
        kinds = [self._draw_service, self._draw_sequence, self._draw_fork, self._draw_decision]
        kinds += [self._draw_counted_loop, self._draw_attempts]
        draw = self._draw_service if depth == 0 else self._dice.choice(kinds)
        return draw(source, guard, depth - 1)

    def _draw_service(
        self, source: str, guard: str, depth: int, output: str = ""
    ) -> tuple[str, str]:
        self._count += 1
        id = f"s{self._count}"
        machines = self._dice.choice([[""], ["left"], ["right"], ["left", "right"]])
        self.offers[id] = {machine: self._dice.randint(1, 9) * 100 for machine in machines}
        self._nodes.append(f'    Action {id} "{id}" subkind="call-behavior"\n      -> calls d{id}')
        level = "machine service" if machines[0] else "infrastructure service"
        self._services.append(f'  Activity d{id} "D{id}" level="{level}"\n')
        if output:
            pin = f'"{output}" direction="out"\n        -> typed-by Boolean'
            self._nodes.append(f"      Pin {id}.o {pin}")
            self._services[-1] += f"    Parameter d{id}.o {pin}\n"
        for machine, time in self.offers[id].items():
            tag = f' tag.duration="{time}"'
            if machine:
                facts = {"client": f"d{id}", "machine": machine, "attrs": "", "time": tag}
                self._services[-1] += _ON.format(profile=_PROFILE, **facts)
            else:
                self._services[-1] += (
                    f'    Application d{id}.c stereotype="InfrastructureService" {_PROFILE}{tag}\n'
                    f"      -> subject d{id}\n"
                )
        self._connect(source, guard, id)
        return id, ""

    def _draw_sequence(self, source: str, guard: str, depth: int) -> tuple[str, str]:
        return self._draw_block(*self._draw_block(source, guard, depth), depth)

    def _draw_fork(self, source: str, guard: str, depth: int) -> tuple[str, str]:
        fork, join = self._add_control("fork"), self._add_control("join")
        self._connect(source, guard, fork)
        for _ in range(self._dice.randint(2, 3)):
            self._connect(*self._draw_block(fork, "", depth), join)
        return join, ""

    def _draw_decision(self, source: str, guard: str, depth: int) -> tuple[str, str]:
        decision, merge = self._add_control("decision"), self._add_control("merge")
        name = f"q{self._dice.randint(1, 3)}"
        self.start[name] = None
        self._connect(source, guard, decision)
        self._connect(*self._draw_block(decision, name, depth), merge)
        if self._dice.random() < 0.5:
            self._connect(decision, "else", merge)
        else:
            self._connect(*self._draw_block(decision, "else", depth), merge)
        return merge, ""

    def _draw_counted_loop(self, source: str, guard: str, depth: int) -> tuple[str, str]:
        merge, decision = self._add_control("merge"), self._add_control("decision")
        name, limit = f"n{self._count}", self._dice.randint(1, 4)
        self.start[name] = 0
        # The counter begins again when an outer loop repeats this one.
        self._connect(*self._draw_assignment(source, guard, name, 0), merge)
        if self._dice.random() < 0.5:
            self._connect(merge, "", decision)
            body = self._draw_block(decision, f"{name} < {limit}", depth)
            self._connect(*self._draw_assignment(*body, name, None), merge)
        else:
            body = self._draw_block(merge, "", depth)
            self._connect(*self._draw_assignment(*body, name, None), decision)
            self._connect(decision, f"{name} < {limit}", merge)
        return decision, "else"

    def _draw_assignment(
        self, source: str, guard: str, name: str, value: int | None
    ) -> tuple[str, str]:
        self._count += 1
        id = f"a{self._count}"
        self.assignments[id] = name, value
        body = f"{name} := {name} + 1" if value is None else f"{name} := {value}"
        self._nodes.append(f'    Action {id} "{id}" subkind="opaque" body="{body}"')
        self._connect(source, guard, id)
        return id, ""

    def _draw_attempts(self, source: str, guard: str, depth: int) -> tuple[str, str]:
        """Add a loop whose last service states whether it is repeated, with a bound."""
        merge, decision = self._add_control("merge"), self._add_control("decision")
        name, limit = f"ok{self._count}", self._dice.randint(1, 3)
        self.start[name] = False
        self._connect(source, guard, merge)
        body = self._draw_block(merge, "", depth) if depth else (merge, "")
        last = self._draw_service(*body, 0, name)
        self.outputs[last[0]] = name, limit
        self._connect(*last, decision)
        self._connect(decision, "else", merge)
        self._nodes.append(
            f'      Application {decision}.l stereotype="Loop" {_PROFILE} '
            f'tag.maxIterations="{limit}"\n        -> subject {decision}'
        )
        position = next(n for n, line in enumerate(self._nodes) if f" {decision} " in line)
        self._nodes.insert(position + 1, self._nodes.pop())
        return decision, name

    def __str__(self) -> str:
        """The IR text of a recipe with this task."""
        variables = [
            f'    Property t.{name} "{name}"{_print_default(value)}\n'
            f"      -> typed-by {'Integer' if type(value) is int else 'Boolean'}"
            for name, value in self.start.items()
        ]
        lines = "\n".join([*variables, *self._nodes, *self._flows]) + "\n"
        machines = [
            _ON.format(
                client="t", machine=machine, profile=_PROFILE, time="", attrs='role="allocate"'
            )
            for machine in ("left", "right")
        ]
        return _HEAD + lines + "".join([*self._services, *machines])


def _print_default(value: object) -> str:
    return "" if value is None else f" default={str(value).lower()}"


def derive_task(graph: TaskGraph) -> Task:
    """Return the task with its derived data."""
    ir_graph = parse_text(str(graph))
    run_steps(("expressions", "recipe"), ir_graph, Sink())
    (model,) = ir_graph.derived(Model)
    (task,) = model.recipe.tasks
    return task


def build_token_graph(graph: TaskGraph) -> TokenGraph:
    """Return the token graph of the task, which starts in the first step."""
    ir_graph = parse_text(str(graph))
    run_steps(("expressions", "activities"), ir_graph, Sink())
    tokens = next(tokens for tokens in ir_graph.derived(TokenGraph) if tokens.activity == "t")
    return replace(tokens, handshake=Handshake("running", "finished", is_started=True))


class Execution:
    """One execution of a task graph by the interpreter, with random choices."""

    def __init__(self, graph: TaskGraph, tokens: TokenGraph, dice: Random) -> None:
        self._graph = graph
        self._tokens = tokens
        self._dice = dice
        self._state = interpreter.initial_state(tokens)
        self._values = {
            name: dice.random() < 0.5 if value is None else value
            for name, value in graph.start.items()
        }
        self._failures: dict[str, int] = {}
        self._busy: dict[str, tuple[float, str]] = {}
        """The end of the work of each service that works, and its machine."""
        self.clock = 0.0
        self.runs: dict[str, int] = dict.fromkeys(graph.offers, 0)

    def run(self) -> float:
        """Return the time of the execution."""
        while True:
            self._settle()
            if not self._state.is_performed:
                return self.clock
            self._start_services()
            id = min(self._busy, key=lambda service: (self._busy[service][0], service))
            self.clock, _ = self._busy.pop(id)
            self._finish(id)

    def _settle(self) -> None:
        """Move tokens and execute assignments until only services run."""
        while self._state.is_performed:
            running = [id for id in self._graph.assignments if id in self._state.running]
            if running:
                self._step("")
                for id in running:
                    self._assign(*self._graph.assignments[id])
                continue
            previous = self._state
            self._step("")
            if self._state == previous:
                return

    def _start_services(self) -> None:
        waiting = [
            id for id in self._graph.offers if id in self._state.running and id not in self._busy
        ]
        self._dice.shuffle(waiting)
        for id in waiting:
            used = {machine for _, machine in self._busy.values()}
            offers = self._graph.offers[id]
            free = [machine for machine in offers if not machine or machine not in used]
            if free:
                machine = self._dice.choice(free)
                self._busy[id] = self.clock + offers[machine], machine

    def _finish(self, id: str) -> None:
        self._step(id)
        self.runs[id] += 1
        if id in self._graph.outputs:
            name, limit = self._graph.outputs[id]
            failures = self._failures.get(id, 0)
            is_good = failures + 1 >= limit or self._dice.random() < 0.5
            self._values[name] = is_good
            self._failures[id] = 0 if is_good else failures + 1

    def _assign(self, name: str, value: int | None) -> None:
        self._values[name] = self._values[name] + 1 if value is None else value

    def _step(self, done: str) -> None:
        """Play a step in which the service *done* ends, and all assignments that run."""
        inputs = {
            variable.name: self._values.get(variable.name, variable.name == f"done_{done}")
            for variable in self._tokens.inputs
        }
        self._state = interpreter.next_state(
            self._tokens, self._state, inputs, evaluate.is_true, lambda _, options: options[0]
        )


def iter_executions(graph: TaskGraph, dice: Random, count: int) -> Iterator[Execution]:
    """Yield executions of the task graph that have ended."""
    tokens = build_token_graph(graph)
    for _ in range(count):
        execution = Execution(graph, tokens, dice)
        execution.run()
        yield execution
