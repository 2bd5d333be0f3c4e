"""Straight frontier: to the nearest end of known boundary as the crow flies, and along that boundary."""

import exactacq as xa


@xa.strategy("straight-frontier")
def straight_frontier(robot):
    """Acquire all obstacles that come into sight, the nearest unknown boundary first."""
    while robot.frontier:
        obstacle, end = min(robot.frontier, key=lambda place: away(robot, place[1]))
        reach(robot, end)
        if robot.at == obstacle and obstacle in robot.map.incomplete:
            robot.walk(hand_beyond(robot, obstacle, end), until="acquire")
        if robot.at in robot.map.acquired:
            corners = [part.end for part in robot.map.known(robot.at)]
            robot.walk_to(min(corners, key=lambda place: away(robot, place)))


def away(robot, place):
    """The square of the distance from the robot to a place: exact, and simpler than the distance."""
    way = place - robot.position
    return way.dot(way)


def reach(robot, goal):
    """Go to a place; around each obstacle in between, and on from its point that is nearest to the place."""
    while robot.go_to(goal).place != goal:
        robot.circle()
        robot.walk_to(robot.map.nearest(robot.at, goal))


def hand_beyond(robot, obstacle, end):
    """The hand for a walk from an end of known boundary into the unknown."""
    ends_here = any(part.end == end for part in robot.map.known(obstacle))
    return "left" if ends_here else "right"
