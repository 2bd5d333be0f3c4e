"""Laws of the tree that a Sightseer's path walks, recounted from its straight pieces."""

from __future__ import annotations

from collections.abc import Sequence

import networkx as nx

from exactacq.auditing.visibility import visible
from exactacq.geometry.box_index import box
from exactacq.geometry.intersections import contacts
from exactacq.sensing.event import EventKind
from exactacq.sensing.path import Piece
from exactacq.strategies.run import Run, SightseerRun
from exactacq.study.claims.model import Case
from exactacq.study.claims.walks import Move, is_circuit, is_same_segment, moves, node_at, stays, traversals
from exactacq.visibility.links import START


def traversal_flaw(run: SightseerRun) -> str | None:
    """A segment between obstacles that was walked more than twice."""
    for move, count in traversals(moves(run)):
        if count > 2:
            return f"the segment from {move.source} to {move.target} was walked {count} times"
    return None


def arrivals(run: SightseerRun) -> int:
    """How often a Sightseer came to an obstacle; to start on one counts."""
    starts_on_one = node_at(run, run.start) != START
    return starts_on_one + sum(move.target != START for move in moves(run))


def tree_flaw(run: SightseerRun) -> str | None:
    """Whether the segments walked are a tree over the start and all obstacles, walked depth first.

    At most n - 1 obstacles may be on the stack, and at most n - 2 moves may lead back to obstacles.
    """
    made, n = moves(run), len(run.scene.obstacles)
    root = node_at(run, run.start)
    tree = nx.Graph()
    tree.add_node(root)
    tree.add_edges_from((move.source, move.target) for move, _ in traversals(made))
    distinct = len(traversals(made))
    if not nx.is_tree(tree) or distinct != tree.number_of_edges():
        return f"{distinct} segments join {len(tree)} nodes"
    if set(tree) - {START} != set(range(n)):
        return f"the tree spans {len(tree)} nodes"
    returns = sum(move.returns and move.target != START for move in made)
    if returns > max(n - 2, 0):
        return f"{returns} return visits"
    return _stack_flaw(made, n)


def _stack_flaw(made: Sequence[Move], n: int) -> str | None:
    stack: list[Move] = []
    for move in made:
        if move.returns:
            if not stack or not is_same_segment(stack[-1].piece, move.piece):
                return f"move {move.at} back to {move.target} is not the way that led here"
            stack.pop()
            continue
        stack.append(move)
        depth = sum(entry.source != START for entry in stack)
        if depth > n - 1:
            return f"{depth} obstacles on the stack"
    return None


def move_flaw(case: Case) -> str | None:
    """Whether each straight move is free, and leads to an unvisited obstacle and touches no other unvisited
    one, or leads back."""
    run = case.sightseer
    made = moves(run)
    for k, move in enumerate(made):
        if move.returns:
            if not any(is_same_segment(move.piece, other.piece) for other in made[:k]):
                return f"move {move.at} to {move.target}, visited before, goes a new way"
            continue
        if not visible(case.world, run.radius, move.piece.start, move.piece.end):
            return f"move {move.at} to {move.target} is blocked, or longer than the radius"
        for other in sorted(set(range(len(run.scene.obstacles))) - move.visited - {move.target}):
            if other != move.source and _touches(run, move.piece, other):
                return f"move {move.at} to {move.target} meets {other}, unvisited too"
    return None


def _touches(run: Run, piece: Piece, obstacle: int) -> bool:
    x, y, right, top = box(piece.curve)
    for edge in run.scene.obstacles[obstacle].edges:
        left, bottom, east, north = box(edge)
        apart = east < x or right < left or north < y or top < bottom
        if not apart and contacts(piece.curve, edge):
            return True
    return False


def circled(run: Run) -> list[int]:
    """The obstacles that a path walks all around, in the order in which it first does."""
    order: list[int] = []
    for stay in stays(run):
        if stay.obstacle not in order and is_circuit(run, stay):
            order.append(stay.obstacle)
    return order


def end_flaw(run: Run) -> str | None:
    """Whether a run ended: it stops once, at the end, and circles no obstacle twice."""
    circuits = [stay for stay in stays(run) if is_circuit(run, stay)]
    around = [stay.obstacle for stay in circuits]
    # One stay may hold two turns: what follows the first is half of one at most.
    if len(around) != len(set(around)) or any(
        stay.length >= run.obstacles[stay.obstacle].perimeter * 2 for stay in circuits
    ):
        return f"the obstacles circled are {around}, or one of them twice on a stay"
    stops = [k for k, event in enumerate(run.events) if event.kind is EventKind.STOP]
    if stops != [len(run.events) - 1] or run.events[-1].after != len(run.path):
        return "the run does not end with its stop"
    return None
