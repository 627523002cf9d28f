"""Robots and their environment as enumerated states: a reference for decision diagrams.

The rules are those of docs/robots.md and not taken from the formulas: the environment offers each
free cell to at most one robot, a robot goes to an offered cell or stays, and a robot in its target
gets any reachable cell as the next one. The mission is arbitrary.
"""

from itertools import chain, combinations, product

STAY = "stay"


class ListedFloor:
    """All reachable states and the steps between them.

    A state has one tuple for each robot: position, target, offered ways, command.
    """

    def __init__(self, study):
        self.grid, self.robots = study.grid, range(len(study.robots))
        self.successors = {}
        pending = [*self._iter_initial_states()]
        while pending:
            state = pending.pop()
            if state not in self.successors:
                self.successors[state] = [*self._iter_successors(state)]
                pending += self.successors[state]

    def _iter_initial_states(self):
        for cells in product(self.grid.cells, repeat=len(self.robots)):
            if len(set(cells)) == len(cells):
                for offers in self._iter_offers(cells):
                    yield tuple(
                        (cell, cell, ways, STAY) for cell, ways in zip(cells, offers, strict=True)
                    )

    def _iter_offers(self, cells):
        """Yield the offers of the environment to robots in *cells*: a set of ways per robot."""
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

    def _iter_successors(self, state):
        cells = [self.move(position, command) for position, _, _, command in state]
        goals = [
            sorted(self.grid.distances(position)) if position == goal else [goal]
            for position, goal, _, _ in state
        ]
        for offers in self._iter_offers(cells):
            commands = [
                [STAY] if position == goal else [STAY, *sorted(ways)]
                for (position, goal, _, _), ways in zip(state, offers, strict=True)
            ]
            for next_goals, next_commands in product(product(*goals), product(*commands)):
                yield tuple(zip(cells, next_goals, offers, next_commands, strict=True))

    def move(self, cell, command):
        return dict(self.grid.neighbours(cell)).get(command, cell)

    # -- queries --------------------------------------------------------------------------------

    def is_safe(self):
        """Whether robots never collide and go only in offered ways."""
        return all(
            len({robot_state[0] for robot_state in state}) == len(state)
            and all(command == STAY or command in ways for _, _, ways, command in state)
            for state in self.successors
        )

    def is_home(self, state, robot):
        return state[robot][0] == state[robot][1]

    def is_near(self, state, robot):
        """Whether *robot* is in its target, or a way that leads nearer is offered to it."""
        position, goal, ways, _ = state[robot]
        distances = self.grid.distances(goal)
        next_cells = (neighbour for way, neighbour in self.grid.neighbours(position) if way in ways)
        return position == goal or any(
            distances[neighbour] < distances[position] for neighbour in next_cells
        )

    def is_served(self, state, robot):
        """Whether a way is offered to *robot*, or all its neighbours are occupied."""
        occupied = {robot_state[0] for robot_state in state}
        neighbours = {neighbour for _, neighbour in self.grid.neighbours(state[robot][0])}
        return bool(state[robot][2]) or neighbours <= occupied

    def is_ever_away(self):
        """Whether the first robot may stay away from its target for ever."""
        return bool(
            self._find_loops({state for state in self.successors if not self.is_home(state, 0)})
        )

    def is_ever_stuck(self):
        """Whether the first robot may wait for a way that leads nearer for ever.

        Each of the remaining robots reaches its targets or waits as well.
        """
        return any(
            self._is_stuck([0, *(robot + 1 for robot, waits in enumerate(waiting_flags) if waits)])
            for waiting_flags in product((False, True), repeat=len(self.robots) - 1)
        )

    def _is_stuck(self, waiting):
        within = {
            state
            for state in self.successors
            if not any(self.is_near(state, robot) for robot in waiting)
        }
        return any(
            all(any(self.is_served(state, robot) for state in loop) for robot in self.robots)
            and all(
                any(self.is_home(state, robot) for state in loop)
                for robot in self.robots
                if robot not in waiting
            )
            for loop in self._find_loops(within)
        )

    def _find_loops(self, within):
        """Return the non-trivial strongly connected components within some states (Tarjan)."""
        index_by_state, low, stack, loops = {}, {}, [], []
        for root in within:
            work = [(root, iter(()))] if root not in index_by_state else []
            while work:
                state, successors = work[-1]
                if state not in index_by_state:
                    index_by_state[state] = low[state] = len(index_by_state)
                    stack.append(state)
                    successors = iter(
                        [successor for successor in self.successors[state] if successor in within]
                    )
                    work[-1] = state, successors
                for successor in successors:
                    if successor not in index_by_state:
                        work.append((successor, iter(())))
                        break
                    if low.get(successor) is not None:
                        low[state] = min(low[state], low[successor])
                else:
                    work.pop()
                    if work:
                        parent = work[-1][0]
                        low[parent] = min(low[parent], low[state])
                    if low[state] == index_by_state[state]:
                        group = stack[stack.index(state) :]
                        del stack[-len(group) :]
                        if len(group) > 1 or state in self.successors[state]:
                            loops.append(group)
                        for successor in group:
                            low[successor] = None
        return loops
