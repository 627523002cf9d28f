"""Robots and their environment as enumerated states: a reference for decision diagrams.

Written from docs/robots.md, not from the formulas: the environment shows each free cell to one
robot at most, robots go where they are shown a way or stay, and a robot in its target is given
any reachable cell. The mission is arbitrary.
"""

from itertools import chain, combinations, product

STAY = "stay"


class ListedFloor:
    """All states that can be reached, with the steps between them.

    A state is a tuple of (position, target, ways that are shown, command), a robot each.
    """

    def __init__(self, study):
        self.grid, self.robots = study.grid, range(len(study.robots))
        self.successors = {}
        waiting = [*self._first()]
        while waiting:
            state = waiting.pop()
            if state not in self.successors:
                self.successors[state] = [*self._steps(state)]
                waiting += self.successors[state]

    def _first(self):
        for cells in product(self.grid.cells, repeat=len(self.robots)):
            if len(set(cells)) == len(cells):
                for shown in self._shown(cells):
                    yield tuple(
                        (cell, cell, ways, STAY) for cell, ways in zip(cells, shown, strict=True)
                    )

    def _shown(self, cells):
        """Yield the sets of ways that the environment may show to robots in *cells*."""
        possible_offers = [
            (robot, way, neighbour)
            for robot, cell in enumerate(cells)
            for way, neighbour in self.grid.neighbours(cell)
            if neighbour not in cells
        ]
        subsets = (combinations(possible_offers, size) for size in range(len(possible_offers) + 1))
        for offers in chain.from_iterable(subsets):
            if len({neighbour for _, _, neighbour in offers}) == len(offers):
                yield tuple(
                    frozenset(way for owner, way, _ in offers if owner == robot)
                    for robot in self.robots
                )

    def _steps(self, state):
        cells = [self.move(position, command) for position, _, _, command in state]
        goals = [
            sorted(self.grid.distances(position)) if position == goal else [goal]
            for position, goal, _, _ in state
        ]
        for shown in self._shown(cells):
            commands = [
                [STAY] if position == goal else [STAY, *sorted(ways)]
                for (position, goal, _, _), ways in zip(state, shown, strict=True)
            ]
            for next_goals, next_commands in product(product(*goals), product(*commands)):
                yield tuple(zip(cells, next_goals, shown, next_commands, strict=True))

    def move(self, cell, command):
        return dict(self.grid.neighbours(cell)).get(command, cell)

    # -- queries --------------------------------------------------------------------------------

    def is_safe(self):
        """Whether robots never collide and go only where a way is shown."""
        return all(
            len({robot_state[0] for robot_state in state}) == len(state)
            and all(command == STAY or command in ways for _, _, ways, command in state)
            for state in self.successors
        )

    def is_home(self, state, robot):
        return state[robot][0] == state[robot][1]

    def is_near(self, state, robot):
        """Whether *robot* is in its target or a way that leads nearer is shown to it."""
        position, goal, ways, _ = state[robot]
        distances = self.grid.distances(goal)
        next_cells = (neighbour for way, neighbour in self.grid.neighbours(position) if way in ways)
        return position == goal or any(
            distances[neighbour] < distances[position] for neighbour in next_cells
        )

    def is_served(self, state, robot):
        """Whether a way is shown to *robot*, or all its neighbours are occupied."""
        occupied = {robot_state[0] for robot_state in state}
        neighbours = {neighbour for _, neighbour in self.grid.neighbours(state[robot][0])}
        return bool(state[robot][2]) or neighbours <= occupied

    def is_ever_away(self):
        """Whether the first robot may stay away from its target for ever."""
        return bool(self._loops({state for state in self.successors if not self.is_home(state, 0)}))

    def is_ever_stuck(self):
        """Whether the first robot may wait for ever for a way that leads nearer, while each other
        one reaches its targets, or waits as well."""
        return any(
            self._is_stuck([0, *(robot + 1 for robot, waits in enumerate(waiting_flags) if waits)])
            for waiting_flags in product((False, True), repeat=len(self.robots) - 1)
        )

    def _is_stuck(self, waiting):
        within = {
            s for s in self.successors if not any(self.is_near(s, robot) for robot in waiting)
        }
        return any(
            all(any(self.is_served(state, robot) for state in loop) for robot in self.robots)
            and all(
                any(self.is_home(state, robot) for state in loop)
                for robot in self.robots
                if robot not in waiting
            )
            for loop in self._loops(within)
        )

    def _loops(self, within):
        """Return the non-trivial strongly connected components within some states (Tarjan)."""
        number, low, stack, loops = {}, {}, [], []
        for root in within:
            work = [(root, iter(()))] if root not in number else []
            while work:
                state, successors = work[-1]
                if state not in number:
                    number[state] = low[state] = len(number)
                    stack.append(state)
                    successors = iter(
                        [successor for successor in self.successors[state] if successor in within]
                    )
                    work[-1] = state, successors
                for successor in successors:
                    if successor not in number:
                        work.append((successor, iter(())))
                        break
                    if low.get(successor) is not None:
                        low[state] = min(low[state], low[successor])
                else:
                    work.pop()
                    if work:
                        parent = work[-1][0]
                        low[parent] = min(low[parent], low[state])
                    if low[state] == number[state]:
                        group = stack[stack.index(state) :]
                        del stack[-len(group) :]
                        if len(group) > 1 or state in self.successors[state]:
                            loops.append(group)
                        for successor in group:
                            low[successor] = None
        return loops
