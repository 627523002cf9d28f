"""The rules of docs/robots.md for a single run: the reference for simulations of many runs."""

from sysmlc.robots.study import WAYS, shortest_path


class PlainWorld:
    """Robots on a floor from one start, with the greedy machine as code instead of formulas."""

    def __init__(self, study, allocation, starts):
        self.study, self.allocation, self.grid = study, allocation, study.grid
        self.robots = range(len(starts))
        self.cells = list(starts)
        self.goals = list(starts)
        self.targets = [None] * len(starts)
        self.was_home = [True] * len(starts)
        self.done = set()
        self.commands = ["stay"] * len(starts)

    def step(self):
        home = [self.cells[r] == self.goals[r] for r in self.robots]
        for r in self.robots:
            if self.commands[r] != "stay":
                self.cells[r] = self.grid.cell_after(self.cells[r], self.commands[r])
        assert len(set(self.cells)) == len(self.cells)
        for r in self.robots:
            if home[r]:
                self.targets[r], self.goals[r] = None, self.cells[r]
        self._record_reached_targets()
        self._dispatch(home)
        self._record_reached_targets()
        for r in self.robots:
            self.commands[r] = self._command(r, home[r])

    def _record_reached_targets(self):
        for r in self.robots:
            if self.targets[r] is not None and self.cells[r] == self.goals[r]:
                self.done.add(self.targets[r])

    def _next_target(self, r):
        remaining = [target for target in self.allocation[r] if target not in self.done]
        ready = remaining and self.done.issuperset(self.study.earlier(remaining[0]))
        return remaining[0] if ready else None

    def _cells_on_way(self, r, target):
        return set(shortest_path(self.grid, self.cells[r], self.study.targets[target].cell))

    def _dispatch(self, home):
        wanted = {r: self._next_target(r) for r in self.robots if home[r]}
        requesting = [r for r in self.robots if wanted.get(r) is not None]
        reserved = set()
        for r in self.robots:
            if not home[r]:
                is_sent = self.targets[r] is not None
                way = (
                    shortest_path(self.grid, self.cells[r], self.goals[r])
                    if is_sent
                    else (self.goals[r],)
                )
                reserved |= set(way)
        requested, leader = set(), requesting[0] if requesting else None
        for r in requesting:
            way = self._cells_on_way(r, wanted[r])
            others = {self.cells[o] for o in self.robots if o != r}
            if way & (others | reserved | requested):
                requested = way if r == leader else requested
                continue
            reserved |= way
            home[r] = None
            self.targets[r], self.goals[r] = wanted[r], self.study.targets[wanted[r]].cell
        if requested:
            goal = self.study.targets[wanted[leader]].cell
            self._move_aside(
                [r for r in self.robots if home[r] and r != leader], requested, reserved, goal
            )

    def _move_aside(self, idle, held, reserved, goal):
        distances = self.grid.distances(goal)
        moved_robots, chosen = set(), set()
        requested = {r for r in idle if self.cells[r] in held}
        for _ in self.robots:
            for r in sorted(requested - moved_robots):
                neighbours = [neighbour for _, neighbour in self.grid.neighbours(self.cells[r])]
                free = [c for c in neighbours if c not in {*self.cells, *reserved, *chosen}]
                outside = [c for c in free if c not in held]
                nearer = [c for c in free if distances[c] < distances[self.cells[r]]]
                for neighbour in (*outside, *nearer)[:1]:
                    moved_robots.add(r)
                    chosen.add(neighbour)
                    self.goals[r] = neighbour
            stuck = {self.cells[r] for r in requested - moved_robots}
            adjacent = {neighbour for cell in stuck for _, neighbour in self.grid.neighbours(cell)}
            requested |= {r for r in idle if self.cells[r] in adjacent}

    def _command(self, r, was_home):
        ways = self.grid.commands_nearer(self.cells[r], self.goals[r])
        return ways[0] if ways and was_home is False else "stay"

    def read_state(self):
        """Return the cells of the robots and the targets that are done."""
        assert all(command in ("stay", *WAYS) for command in self.commands)
        return tuple(self.cells), frozenset(self.done)
