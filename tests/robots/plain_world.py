"""The rules of docs/robots.md for one run, written plainly: what many runs at once are held to."""

from sysmlc.robots.study import WAYS, shortest_path


class Plain:
    """Robots on a floor, one start; the greedy machine in words instead of formulas."""

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
        self._note()
        self._dispatch(home)
        self._note()
        for r in self.robots:
            self.commands[r] = self._command(r, home[r])

    def _note(self):
        for r in self.robots:
            if self.targets[r] is not None and self.cells[r] == self.goals[r]:
                self.done.add(self.targets[r])

    def _next(self, r):
        own = [one for one in self.allocation[r] if one not in self.done]
        ready = own and self.done.issuperset(self.study.earlier(own[0]))
        return own[0] if ready else None

    def _way(self, r, target):
        return set(shortest_path(self.grid, self.cells[r], self.study.targets[target].cell))

    def _dispatch(self, home):
        wanted = {r: self._next(r) for r in self.robots if home[r]}
        asking = [r for r in self.robots if wanted.get(r) is not None]
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
        held, leader = set(), asking[0] if asking else None
        for r in asking:
            way = self._way(r, wanted[r])
            others = {self.cells[o] for o in self.robots if o != r}
            if way & (others | reserved | held):
                held = way if r == leader else held
                continue
            reserved |= way
            home[r] = None
            self.targets[r], self.goals[r] = wanted[r], self.study.targets[wanted[r]].cell
        if held:
            goal = self.study.targets[wanted[leader]].cell
            self._aside([r for r in self.robots if home[r] and r != leader], held, reserved, goal)

    def _aside(self, idle, held, reserved, goal):
        known = self.grid.distances(goal)
        gone, chosen = set(), set()
        asked = {r for r in idle if self.cells[r] in held}
        for _ in self.robots:
            for r in sorted(asked - gone):
                near = [there for _, there in self.grid.neighbours(self.cells[r])]
                free = [c for c in near if c not in {*self.cells, *reserved, *chosen}]
                off = [c for c in free if c not in held]
                ahead = [c for c in free if known[c] < known[self.cells[r]]]
                for there in (*off, *ahead)[:1]:
                    gone.add(r)
                    chosen.add(there)
                    self.goals[r] = there
            stuck = {self.cells[r] for r in asked - gone}
            beside = {there for cell in stuck for _, there in self.grid.neighbours(cell)}
            asked |= {r for r in idle if self.cells[r] in beside}

    def _command(self, r, was_home):
        ways = self.grid.commands_nearer(self.cells[r], self.goals[r])
        return ways[0] if ways and was_home is False else "stay"

    def told(self):
        """Where robots are, and what is done."""
        assert all(one in ("stay", *WAYS) for one in self.commands)
        return tuple(self.cells), frozenset(self.done)
