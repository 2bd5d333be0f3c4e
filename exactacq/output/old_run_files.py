"""Run files of versions 2 to 5.

Until version 2 events said in words what they say in fields now. Until version 3 straight pieces told what
their lines touch (``touches``), which sensing finds by itself. Until version 4 no event told a decision.
Until version 5 zeros of functions were not written: events there had no point, and lengths decimals alone.
"""

from __future__ import annotations

import re
from typing import Any

from exactacq.errors import FormatError
from exactacq.sensing.event import Ending, EventKind, Occasion, Reason

OLD_VERSIONS = (2, 3, 4, 5)
"""The versions that are still read."""
_WORDS: dict[tuple[str, str], dict[str, str]] = {
    (EventKind.HIT, "from #"): {"occasion": Occasion.ADVANCE},
    (EventKind.LEAVE, "to #"): {"occasion": Occasion.ADVANCE},
    (EventKind.LEAVE, "back to #"): {"occasion": Occasion.BACKTRACK},
    (EventKind.BACKTRACK, "from #"): {"occasion": Occasion.BACKTRACK},
    (EventKind.HIT, "diversion"): {"occasion": Occasion.DIVERSION},
    (EventKind.LEAVE, "back to the M-line"): {"occasion": Occasion.DIVERSION},
    (EventKind.STOP, "every obstacle is visited"): {"ending": Ending.ALL_VISITED},
    (EventKind.STOP, "no unvisited obstacle on the map"): {"ending": Ending.NOTHING_UNVISITED},
    (EventKind.STOP, "back at the start, nothing unvisited in sight"): {"ending": Ending.BACK_AT_START},
    (EventKind.STOP, "the end of the M-line is reached"): {"ending": Ending.END_OF_M_LINE},
    (EventKind.STOP, "the start or the end of the M-line is trapped in obstacle #"): {
        "ending": Ending.TRAPPED
    },
    (EventKind.STOP, "obstacle # closes the straight way"): {"ending": Ending.WAY_CLOSED},
}
_ON_A_WAY = {
    "on the M-line": Occasion.M_LINE,
    "on the way": Occasion.WAY_OUT,
    "on the way back": Occasion.WAY_BACK,
}
_NODE = re.compile(r"\d+|\bS$")


def upgraded(document: dict[str, Any]) -> dict[str, Any]:
    """The data of an old version as those of the present one.

    Raises `FormatError` for an event that version 2 never wrote.
    """
    path = [{key: value for key, value in piece.items() if key != "touches"} for piece in document["path"]]
    document = document | {"path": path}
    if int(document["version"]) > 2:
        return document | {"version": 6}
    fields = {key: value for key, value in document.items() if key != "sweeping"}
    if "sweeping" in document:
        del fields["links"], fields["stack_depth"]
        fields |= document["sweeping"]
    return fields | {"version": 6, "events": [_event(event) for event in document["events"]]}


def _event(event: dict[str, Any]) -> dict[str, Any]:
    kind, note = event["kind"], str(event["note"])
    if not note:
        return event
    if note in tuple(Reason):
        return event | {"reason": note}
    if note in _ON_A_WAY and kind in (EventKind.HIT, EventKind.CROSS, EventKind.LEAVE):
        return event | {"occasion": _ON_A_WAY[note]}
    facts = _WORDS.get((kind, _NODE.sub("#", note)))
    if facts is None:
        raise FormatError(f"an event of kind {str(kind)[:20]} with the unknown note {note[:60]!r}")
    node = _NODE.search(note)
    if node is None or "ending" in facts:
        return event | facts
    return event | facts | {"other": node[0] if node[0] == "S" else int(node[0])}
