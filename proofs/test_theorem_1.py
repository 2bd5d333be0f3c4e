"""Theorem 1 of the paper and what it rests on, decided exactly."""

import networkx as nx
import pytest

from exactacq import Length, Run, gallery, sightseer
from exactacq.generators import random_octagons


def bound(run: Run, name: str):
    return next(b for b in run.bounds if b.name == name)


@pytest.fixture(scope="module", params=range(6))
def run(request) -> Run:
    """A run on 24 random octagons, with a radius that changes from short to long."""
    return sightseer(random_octagons(24, seed=request.param), radius=4 + 2 * request.param)


def test_l1_a_tree_edge_is_walked_at_most_twice(run: Run) -> None:
    assert {link.traversals for link in run.links} <= {1, 2}


def test_l2_at_most_two_n_minus_two_visits(run: Run) -> None:
    arrivals = [e for e in run.events if e.kind in ("hit", "backtrack") and e.obstacle is not None]
    assert len(run.visits) >= 2
    assert len(arrivals) <= 2 * (len(run.visits) - 1)


def test_ss5_the_walked_edges_form_a_spanning_tree(run: Run) -> None:
    tree = nx.Graph((link.source, link.target) for link in run.links)
    assert nx.is_tree(tree)
    assert set(tree) == {"S", *run.visits}
    assert run.stack_depth <= len(run.visits)


def test_ss6_corrected_edges_stay_within_the_radius(run: Run) -> None:
    assert all(link.length <= Length(run.radius) for link in run.links)


def test_t1_corrected_and_2_with_the_approach_hold(run: Run) -> None:
    assert run.complete, "the corrected bounds are stated for model (a)"
    assert bound(run, "T1 corrected").holds
    assert bound(run, "(2) + S-S1").holds


def test_ss6_is_false() -> None:
    run = sightseer(gallery.scene("m8"))
    longest = max(link.length for link in run.links)
    assert longest > Length("7/2"), "3.5 is the largest distance between two obstacles of m8"


def test_t1_is_false() -> None:
    run = sightseer(gallery.scene("m9"))
    assert run.length == Length("2248.735")
    assert bound(run, "(1)").value == Length("1625.7")
    assert not bound(run, "(1)").holds
    assert bound(run, "T1 corrected").holds


def test_ss4_is_false_outside_model_a() -> None:
    run = sightseer(gallery.scene("m4"))
    assert not run.complete
    assert run.incomplete, "the glimpsed obstacle is on the map"


def test_f1_a_known_obstacle_must_be_visited() -> None:
    run = sightseer(gallery.scene("m11"))
    assert run.visits == (0, 1, 2)
    assert [(link.source, link.target) for link in run.links][-1] == (1, 2), "O3 is reached from O2 only"
