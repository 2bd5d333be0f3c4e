"""Scenes like drawings: plates, boards, floor plans, gears, slots, words, staircases; of any size.

`scenes` makes a scene of a family, `names` are the families' names. Each family is a file of its own,
which draws a `plan` of the outlines in `parts` and `letters`, some in `rows`.
"""
