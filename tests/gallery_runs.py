"""Runs on scenes of the gallery that several tests look at, made once in each process."""

from __future__ import annotations

from functools import cache

import exactacq as xa
from exactacq.files import gallery


@cache
def gallery_run(name: str, **options: object) -> xa.Run:
    """The run by the strategy that the scene is for."""
    scene = gallery.scene(name)
    return (
        xa.seed_spreader(scene, **options)
        if gallery.is_swept(name)
        else xa.sightseer(scene, **options).sense()
    )
