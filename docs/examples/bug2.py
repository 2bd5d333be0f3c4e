"""Bug 2 (Lumelsky and Stepanov 1987): to a goal, and around obstacles back to the M-line, nearer to it."""

import exactacq as xa

GOAL = xa.Point(20, 0)


@xa.strategy("bug2")
def bug2(robot):
    """Go to the goal, or find that no way leads there."""
    m_line = xa.Segment(robot.start, GOAL)
    while robot.go_to(GOAL).kind == "hit":
        hit = robot.position
        while True:
            if robot.walk("left", to=m_line).kind == "round":
                return
            leave = robot.position
            if from_goal(leave) < from_goal(hit) and robot.go_to(GOAL).place != leave:
                break


def from_goal(place):
    """The square of the distance from the goal."""
    return (GOAL - place).norm_sq()
