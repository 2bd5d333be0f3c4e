"""Lanes: up and down through the terrain, and around what is in the way."""

import exactacq as xa


@xa.strategy("lanes", confined=True)
def lanes(robot):
    """Follow lanes two ranges apart, and walk around each obstacle that is in the way."""
    route = robot.lay(corners(robot))
    while True:
        halt = robot.follow(route)
        if halt.kind == "arrived":
            if not route.turn():
                return
            continue
        if halt.obstacle in robot.map.incomplete:
            robot.circle()
        place = next(robot.exits(route, halt.obstacle), None)
        if place is None:
            return
        robot.take_up(route, place)


def corners(robot):
    """The corners of the lanes, from the SW corner; the first one leads north, and the last one is east."""
    west, south, east, north = robot.terrain.limits
    places, x, is_north = [(west, south)], west, True
    while True:
        places.append((x, north if is_north else south))
        if x == east:
            return places
        x, is_north = min(x + 2 * robot.radius, east), not is_north
        places.append((x, places[-1][1]))
