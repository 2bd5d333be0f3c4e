"""Scenes like drawings: plates, boards, floor plans, gears, slots, words, staircases; of any size.

`catalogue` makes a scene of a family; `plan` says what a family draws, `parts` are the outlines it draws with,
and each family is a file of its own.
"""
