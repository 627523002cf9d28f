"""Robots and their environment as lists of states: a judge of what is decided on diagrams.

Written from docs/robots.md, not from the formulas: the environment shows each free cell to one
robot at most, robots go where they are shown a way or stay, and a robot in its target is given
any cell that it can get to. The mission is anybody's.
"""

from itertools import chain, combinations, product

STAY = "stay"


class Listed:
    """All states that can be reached, with the steps between them.

    A state is a tuple of (position, target, ways that are shown, command), a robot each.
    """

    def __init__(self, study):
        self.grid, self.robots = study.grid, range(len(study.robots))
        self.after = {}
        waiting = [*self._first()]
        while waiting:
            state = waiting.pop()
            if state not in self.after:
                self.after[state] = [*self._steps(state)]
                waiting += self.after[state]

    def _first(self):
        for cells in product(self.grid.cells, repeat=len(self.robots)):
            if len(set(cells)) == len(cells):
                for shown in self._shown(cells):
                    yield tuple((at, at, ways, STAY) for at, ways in zip(cells, shown, strict=True))

    def _shown(self, cells):
        """What robots in these cells may be shown."""
        open_ = [
            (robot, way, there)
            for robot, cell in enumerate(cells)
            for way, there in self.grid.neighbours(cell)
            if there not in cells
        ]
        subsets = (combinations(open_, size) for size in range(len(open_) + 1))
        for some in chain.from_iterable(subsets):
            if len({there for _, _, there in some}) == len(some):
                yield tuple(
                    frozenset(way for one, way, _ in some if one == robot) for robot in self.robots
                )

    def _steps(self, state):
        cells = [self.moved(at, command) for at, _, _, command in state]
        goals = [
            sorted(self.grid.distances(at)) if at == goal else [goal] for at, goal, _, _ in state
        ]
        for shown in self._shown(cells):
            commands = [
                [STAY] if at == goal else [STAY, *sorted(ways)]
                for (at, goal, _, _), ways in zip(state, shown, strict=True)
            ]
            for given, done in product(product(*goals), product(*commands)):
                yield tuple(zip(cells, given, shown, done, strict=True))

    def moved(self, cell, command):
        return dict(self.grid.neighbours(cell)).get(command, cell)

    # -- what is asked -------------------------------------------------------------------------

    def is_safe(self):
        """Whether robots never meet and go only where they are shown a way."""
        return all(
            len({one[0] for one in state}) == len(state)
            and all(command == STAY or command in ways for _, _, ways, command in state)
            for state in self.after
        )

    def is_home(self, state, robot):
        return state[robot][0] == state[robot][1]

    def is_near(self, state, robot):
        """Whether a robot is in its target, or is shown a way that leads nearer."""
        at, goal, ways, _ = state[robot]
        known = self.grid.distances(goal)
        near = (there for way, there in self.grid.neighbours(at) if way in ways)
        return at == goal or any(known[there] < known[at] for there in near)

    def is_served(self, state, robot):
        """Whether a robot is shown a way, or is shut in."""
        taken = {one[0] for one in state}
        near = {there for _, there in self.grid.neighbours(state[robot][0])}
        return bool(state[robot][2]) or near <= taken

    def is_ever_away(self):
        """Whether the first robot may be away from its target for any time."""
        return bool(self._loops({one for one in self.after if not self.is_home(one, 0)}))

    def is_ever_stuck(self):
        """Whether the first robot may wait for ever for a way that leads nearer, while each other
        one reaches its targets, or waits as well."""
        return any(
            self._is_stuck([0, *(one + 1 for one, waits in enumerate(others) if waits)])
            for others in product((False, True), repeat=len(self.robots) - 1)
        )

    def _is_stuck(self, waiting):
        within = {s for s in self.after if not any(self.is_near(s, one) for one in waiting)}
        return any(
            all(any(self.is_served(one, robot) for one in loop) for robot in self.robots)
            and all(
                any(self.is_home(one, robot) for one in loop)
                for robot in self.robots
                if robot not in waiting
            )
            for loop in self._loops(within)
        )

    def _loops(self, within):
        """Sets of states that lead to one another within some states (Tarjan)."""
        number, low, stack, found = {}, {}, [], []
        for root in within:
            work = [(root, iter(()))] if root not in number else []
            while work:
                state, left = work[-1]
                if state not in number:
                    number[state] = low[state] = len(number)
                    stack.append(state)
                    left = iter([one for one in self.after[state] if one in within])
                    work[-1] = state, left
                for one in left:
                    if one not in number:
                        work.append((one, iter(())))
                        break
                    if low.get(one) is not None:
                        low[state] = min(low[state], low[one])
                else:
                    work.pop()
                    if work:
                        above = work[-1][0]
                        low[above] = min(low[above], low[state])
                    if low[state] == number[state]:
                        group = stack[stack.index(state) :]
                        del stack[-len(group) :]
                        if len(group) > 1 or state in self.after[state]:
                            found.append(group)
                        for one in group:
                            low[one] = None
        return found
