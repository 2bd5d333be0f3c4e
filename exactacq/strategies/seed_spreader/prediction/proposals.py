"""Candidates for lines of sight from a vertical line, in floats; some are discarded with a margin.

A line of sight that cannot be moved on touches two things, or one at the distance of the range: see
`exactacq.strategies.seed_spreader.prediction.decide`. Here the lines through two features (corners and lone
ends of known pieces, convex arcs, points of the line) are listed, and what is certainly blocked or out of
range is dropped. Margins grow with the proven error of each line, so what is nearly degenerate is kept and
left to exact arithmetic.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import compress
from typing import Any

import numpy as np

from exactacq.geometry.curves import Arc
from exactacq.numbers.float_bounds import margin
from exactacq.strategies.seed_spreader.prediction.pieces import (
    ANGLE,
    MARGIN,
    TINY,
    Flags,
    Floats,
    Gaps,
    Ints,
    KnownFeature,
    LineCell,
    Lines,
    Pieces,
    ProposedLine,
    chords,
    cross,
    dot,
    enters,
    left,
    norm,
    unit,
)


class Proposals:
    """The lines of sight from the line at abscissa x, from ordinate *low* to *high*, that floats leave over.

    *fixed* are ordinates that also part cells: those of the stands, and the ends of the walk. A *touch* is a
    feature as lines touch it: points are one each, arcs two, on the lines' left and on their right.
    """

    def __init__(
        self,
        pieces: Pieces,
        features: Sequence[KnownFeature],
        targets: Sequence[int],
        x: float,
        walk: tuple[float, float],
        radius: float,
        fixed: Sequence[float],
    ) -> None:
        self.pieces, self.features, self.x, self.radius = pieces, features, x, radius
        self.low, self.high = walk
        self.fixed = np.array(fixed)
        self.slack, self.grain = pieces.slack, pieces.grain
        self.targets = np.array(targets, dtype=np.intp)
        rows = []
        for f, feature in enumerate(features):
            shape = feature.shape
            if isinstance(shape, Arc):
                rows += [(f, *shape.center.xy, sign * float(shape.radius)) for sign in (1, -1)]
            else:
                rows.append((f, *shape.xy, 0.0))
        table = np.array(rows).reshape(-1, 4)
        self.feature = table[:, 0].astype(np.intp)
        self.center, self.turn = table[:, 1:3], table[:, 3]
        on_all = np.array([[*f.leave, *f.back] for f in features]).reshape(-1, 4)
        flags = np.array([(f.joined, f.pivot, f.goal, f.stand) for f in features], dtype=bool).reshape(-1, 4)
        self.leave, self.back = on_all[self.feature, :2], on_all[self.feature, 2:]
        self.joined, self.pivot, self.goal, self.stand = flags[self.feature].T
        self.on = np.zeros((len(features), len(pieces.curves)), dtype=bool)
        for f, feature in enumerate(features):
            self.on[f, list(feature.on)] = True
        self.on = self.on[self.feature]
        # Lines of sight touch only features within range, but all features part cells.
        self.near = self._reach(self.center) - np.abs(self.turn) <= radius + self.slack
        self.round = {f.on[0]: k for k, f in enumerate(features) if isinstance(f.shape, Arc)}
        # The piece that is touched, if it is an arc.
        arcs = np.array([f.on[0] if isinstance(f.shape, Arc) else -1 for f in features], dtype=np.intp)
        self.arc = arcs[self.feature]

    # -- the lines ---------------------------------------------------------------------------------

    def lines(self) -> tuple[Lines, list[tuple[int, int]]]:
        """The lines through two features that meet the walk, and the pairs that are too near to tell."""
        i, j = np.triu_indices(len(self.turn), 1)
        pivot, end = self.pivot, self.goal | self.stand
        keep = pivot[i] & (pivot[j] | end[j]) | pivot[j] & end[i]
        keep |= self.goal[i] & self.stand[j] | self.stand[i] & self.goal[j]
        keep &= (
            (self.near[i] | self.near[j])
            & ~(self.stand[i] & self.stand[j])
            & (self.feature[i] != self.feature[j])
        )
        i, j = i[keep], j[keep]
        own = self._incident(i, j)
        i, j = i[~own], j[~own]
        gap = norm(self.center[j] - self.center[i])
        near = gap < 100 * self.grain
        close = list(zip(i[near].tolist(), j[near].tolist(), strict=True))
        i, j, gap = i[~near], j[~near], gap[~near]
        normal, tilt, real = self._normals(self.center[i], self.turn[i], self.center[j], self.turn[j])
        flat = np.abs(normal[:, 1]) < 1e-9
        level = (normal * (self.center[i] - (self.x, 0.0))).sum(axis=1) + self.turn[i]
        vague = real & flat & (np.abs(level) < 1e-8 * self.slack / MARGIN)
        close += zip(i[vague].tolist(), j[vague].tolist(), strict=True)
        keep = real & ~flat & self._may_touch(i, normal, tilt) & self._may_touch(j, normal, tilt)
        i, j, normal, tilt = i[keep], j[keep], normal[keep], tilt[keep]
        piece = np.full(len(i), -1)
        i, j, piece, normal, tilt = self._with_tangents(i, j, piece, normal, tilt)
        level = dot(normal, self.center[i]) + self.turn[i]
        y = (level - normal[:, 0] * self.x) / normal[:, 1]
        far = norm(self.center[i] - np.stack((np.full(len(y), self.x), y), axis=1))
        error = (self.grain / 1000 + tilt * far) / np.abs(normal[:, 1])
        lines = Lines(i, j, piece, y, error, np.stack((normal[:, 1], -normal[:, 0]), axis=1), tilt)
        return lines[(y + error >= self.low - self.slack) & (y - error <= self.high + self.slack)], close

    def _may_touch(self, k: Ints, normal: Floats, tilt: Floats) -> Flags:
        """Whether lines may touch arcs k (rather than what is missing of their circles)."""
        if not len(self.pieces.curves):
            return np.ones(len(k), dtype=bool)
        arc, pieces = self.arc[k], self.pieces
        touch = self.center[k] + self.turn[k, None] * normal
        chord = pieces.end[arc] - pieces.start[arc]
        side = cross(unit(chord), touch - pieces.start[arc])
        outside = side > self.slack + tilt * np.abs(self.turn[k])
        wide = norm(chord) > 1e-6 * np.abs(self.turn[k])
        return np.asarray((arc < 0) | pieces.full[arc] | ~wide | ~outside)

    def _incident(self, i: Ints, j: Ints) -> Flags:
        """Whether one of the two is an arc and the other a point on it."""
        arc = self.turn != 0
        shared = (self.on.astype(np.float32) @ self.on.T.astype(np.float32)) > 0
        return np.asarray((arc[i] != arc[j]) & shared[i, j])

    def _normals(self, a: Floats, turn: Any, b: Floats, other: Any) -> tuple[Floats, Floats, Flags]:
        """Unit normals n, left of the way from a to b, with n.a + turn = n.b + other; errors; existence."""
        base = self.grain / 1000
        d = b - a
        square = dot(d, d)
        k = turn - other
        rest = square - k * k
        root = np.sqrt(np.maximum(rest, 0.0))
        length = np.sqrt(square)
        normal = (k[:, None] * d + root[:, None] * left(d)) / np.maximum(square, TINY)[:, None]
        tilt = np.minimum(4 * base / np.maximum(root, TINY), 4 * np.sqrt(base / np.maximum(length, TINY)))
        return unit(normal), tilt, (rest > -4 * base * length) | (self.slack == np.inf)

    def _with_tangents(self, i: Ints, j: Ints, piece: Ints, normal: Floats, tilt: Floats) -> Any:
        """Joined by the tangents of pieces at their ends and at stands."""
        rows = [
            (g, k)
            for g in np.flatnonzero(self.turn == 0)
            for k in self.features[self.feature[g]].on
            if self.pieces.sense[k] or self.goal[g] or self.stand[g]
        ]
        if not rows:
            return i, j, piece, normal, tilt
        pieces = self.pieces
        g, k = np.array(rows).T
        across = left(pieces.tangents(k, self.center[g]))
        keep = np.abs(across[:, 1]) > 1e-9
        g, k, across = g[keep], k[keep], across[keep]
        size = np.where(pieces.sense[k] == 0, norm(pieces.end[k] - pieces.start[k]), pieces.radius[k])
        return (
            np.concatenate((i, g)),
            np.concatenate((j, np.full(len(g), -1))),
            np.concatenate((piece, k)),
            np.concatenate((normal, across)),
            np.concatenate((tilt, self.grain / 1000 / np.maximum(size, TINY))),
        )

    # -- lines of sight along them ---------------------------------------------------------------------

    def sights(self, lines: Lines) -> list[ProposedLine]:
        """What is left of the lines of sight that touch two features."""
        p = self._places(lines.y)
        other = np.where(lines.j < 0, lines.i, lines.j)
        one, two = (dot(self.center[k] - p, lines.way) for k in (lines.i, other))
        # At a stand itself, the tangent of a piece is tried both ways.
        at_stand = (lines.j < 0) & self.stand[lines.i]
        found = []
        for sense in (1.0, -1.0):
            sign = np.where(at_stand, sense, np.where(one + two < 0, -1.0, 1.0))
            use = at_stand if sense < 0 else np.ones(len(sign), dtype=bool)
            near, far = np.minimum(one * sign, two * sign), np.maximum(one * sign, two * sign)
            blur = self.slack + lines.error + lines.tilt * self.radius
            use = use & (near > -blur) & (far < self.radius + blur)
            found += self._sights(lines[use], p[use], lines.way[use] * sign[use, None], far[use])
        return found

    def _sights(self, lines: Lines, p: Floats, way: Floats, far: Floats) -> list[ProposedLine]:
        other = np.where(lines.j < 0, lines.i, lines.j)
        base = self.grain / 1000 + lines.error
        rows, columns, ts, errors = [], [], [], []
        hit, blur = self._hits(p, way, base + lines.tilt * self.radius)
        bound = self.on[:, self.targets] & (
            (self.pieces.sense[self.targets] == 0) | (self.turn != 0)[:, None]
        )
        for branch in (0, 1):
            t = hit[..., branch]
            ok = (t > far[:, None] - blur[..., branch] - self.slack) & ~(bound[lines.i] | bound[other])
            ok &= lines.piece[:, None] != self.targets
            r, c = np.nonzero(ok)
            rows.append(r)
            columns.append(c)
            ts.append(t[r, c])
            errors.append(blur[r, c, branch])
        for k in (lines.i, other):
            t = dot(self.center[k] - p, way)
            r = np.flatnonzero(
                self.goal[k] & (t > far - base - self.slack) & ((lines.j >= 0) | (k == lines.i))
            )
            rows.append(r)
            columns.append(-1 - k[r])
            ts.append(t[r])
            errors.append(base[r])
        row, column = np.concatenate(rows), np.concatenate(columns)
        t, error = np.concatenate(ts), np.concatenate(errors) + base[row]
        q = p[row] + t[:, None] * way[row]
        leave, back = self._arrivals(column, q)
        blur = margin(ANGLE) + 4 * error / np.maximum(t, TINY) + lines.tilt[row]
        ok = (t <= self.radius + 2 * error + self.slack) & ~enters(leave, back, -way[row], blur)
        for k in (lines.i[row], other[row]):
            at = dot(self.center[k] - p[row], way[row])
            through = self.joined[k] & (self.turn[k] == 0)
            ahead = (through & (at < t - error - self.slack)) | self.stand[k]
            behind = through & (at > error + self.slack) & (at < t - error - self.slack)
            ok &= ~(ahead & enters(self.leave[k], self.back[k], way[row], blur))
            ok &= ~(behind & enters(self.leave[k], self.back[k], -way[row], blur))
        ok[ok] = ~self.pieces.block(p[row[ok]], q[ok], error[ok])
        return [
            ProposedLine(
                int(lines.i[r]),
                int(lines.j[r]),
                int(lines.piece[r]),
                -1 if c >= 0 else -1 - int(c),
                int(self.targets[c]) if c >= 0 else -1,
                float(lines.y[r]),
            )
            for r, c in zip(row[ok], column[ok], strict=True)
        ]

    def _reach(self, places: Floats) -> Floats:
        """Distances of places from the walk."""
        y = np.clip(places[:, 1], self.low, self.high)
        return norm(places - self._places(y))

    def _places(self, y: Floats) -> Floats:
        return np.stack((np.full(len(y), self.x), y), axis=-1)

    def _arrivals(self, column: Ints, q: Floats) -> tuple[Floats, Floats]:
        """The boundary's directions at ends q: of targets, numbers 0.., or of features, numbers -1 - k."""
        leave, back = np.zeros_like(q), np.zeros_like(q)
        inner = column >= 0
        leave[inner] = self.pieces.tangents(self.targets[column[inner]], q[inner])
        back[inner] = -leave[inner]
        k = -1 - column[~inner]
        leave[~inner], back[~inner] = self.leave[k], self.back[k]
        return leave, back

    def _hits(self, p: Floats, way: Floats, error: Floats) -> tuple[Floats, Floats]:
        """Where rays meet targets: parameters by ray, target and branch (NaN: nowhere), and their errors."""
        pieces, k = self.pieces, self.targets
        p, way, error = p[:, None], way[:, None], error[:, None]
        offset = pieces.start[k] - p
        chord = pieces.end[k] - pieces.start[k]
        length, along = norm(chord), unit(chord)
        sine = cross(way, along)
        flat = np.abs(sine) < 1e-9
        safe = np.where(flat, 1.0, sine)
        height = cross(offset, way)
        blur = np.where(flat, length + error, error / np.abs(safe))
        t = np.where(flat, dot(offset, way) + length * (dot(way, along) < 0), cross(offset, along) / safe)
        place = height / safe
        miss = np.where(
            flat,
            np.abs(height) > error + self.slack + 1e-9 * length,
            (place < -blur - self.slack) | (place > length + blur + self.slack),
        )
        straight = np.where(miss, np.nan, t)
        radius = pieces.radius[k]
        middle, height, half = chords(way, pieces.center[k] - p, radius)
        shake = error + np.minimum(error * radius / np.maximum(half, TINY), np.sqrt(2 * error * radius))
        hits, blurs = [], []
        for sign in (-1.0, 1.0):
            root = middle + sign * half
            on_circle = p + root[..., None] * way
            side = cross(along, on_circle - pieces.start[k]) * pieces.sense[k]
            wide = length > 1e-6 * radius
            miss = (np.abs(height) > radius + error + self.slack) | (
                ~pieces.full[k] & wide & (side > shake + self.slack)
            )
            round_ = np.where(miss, np.nan, root)
            is_straight = pieces.sense[k] == 0
            hits.append(np.where(is_straight, straight if sign < 0 else np.nan, round_))
            blurs.append(np.where(is_straight, blur, shake))
        return np.stack(hits, axis=-1), np.stack(blurs, axis=-1)

    # -- lines that touch one feature ------------------------------------------------------------------

    def cells(self, lines: Lines, is_point_of_line: Callable[[int], bool]) -> list[LineCell]:
        """What is left of the lines of sight that touch one feature, where the range may hold them.

        Between two neighbouring lines through two features all lines about a feature are blocked or none is.
        Past a point of the walk's line goes only that line: of such cells the range is not asked.
        """
        gaps = Gaps(self._ordinates(lines))
        touch, low, high = gaps.touch, gaps.low, gaps.high
        p = self._places((low + high) / 2)
        way, tilt, along, real = self._about(touch, p)
        real &= self._may_touch(touch, left(way), tilt)
        shake = (high - low + 10 * self.slack) * (1 + self.radius / np.maximum(np.abs(along), TINY))
        base = self.grain / 1000 + tilt * self.radius
        base = np.minimum(base + np.where(gaps.tiny, shake, 0.0), self.radius)
        hit, blur = self._hits(p, way, base)
        ok = real[:, None, None] & (hit > along[:, None, None] - blur - self.slack)
        straight = self.pieces.sense[self.targets] == 0
        ok &= ~(self.on[touch][:, self.targets] & ((self.turn[touch] != 0)[:, None] | straight))[..., None]
        row, target, branch = np.nonzero(ok)
        least = self._least(touch[row], low[row], high[row], target, branch)
        near = np.where(gaps.tiny[row], hit[ok] - 2 * blur[ok], least) <= self.radius + self.slack
        row, target, branch = row[near], target[near], branch[near]
        t, error = hit[row, target, branch], blur[row, target, branch] + base[row]
        q = p[row] + t[:, None] * way[row]
        leave, back = self._arrivals(target, q)
        blur = margin(ANGLE) + 4 * error / np.maximum(t, TINY)
        free = ~enters(leave, back, -way[row], blur)
        k = touch[row]
        passed = self.joined[k] & (self.turn[k] == 0)
        for v in (way[row], -way[row]):
            free &= ~(passed & enters(self.leave[k], self.back[k], v, blur))
        free[free] = ~self.pieces.block(p[row[free]], q[free], error[free])
        found = [
            gaps.cell(r, int(k), int(b))
            for r, k, b in zip(row[free], target[free], branch[free], strict=True)
        ]
        decided = [not cell.above or is_point_of_line(cell.touch) for cell in found]
        others = [cell for cell, is_decided in zip(found, decided, strict=True) if not is_decided]
        return [*compress(found, decided), *self._by_range(others)]

    def _ordinates(self, lines: Lines) -> Iterator[tuple[int, Floats, Floats, Ints]]:
        """Where the lines about each feature that can be turned about meet the walk (see `Gaps`)."""
        two = lines.j >= 0
        i, j = self.feature[lines.i], self.feature[np.maximum(lines.j, 0)]
        j[~two] = [self.round.get(int(k), -1) for k in lines.piece[~two]]
        feature = np.concatenate((i, j))
        fixed = -1 - np.arange(len(self.fixed))
        for g in np.flatnonzero(self.pivot & self.near):
            own = np.flatnonzero(feature == self.feature[g]) % len(i)
            y = np.clip(np.concatenate((lines.y[own], self.fixed)), self.low, self.high)
            error = np.concatenate((lines.error[own], np.zeros(len(fixed)))) + self.slack
            order = np.argsort(y, kind="stable")
            yield int(g), y[order], error[order], np.concatenate((own, fixed))[order]

    def _about(self, touch: Ints, p: Floats) -> tuple[Floats, Floats, Floats, Flags]:
        """The lines from places about features: direction, its error, length of the tangent, existence."""
        normal, tilt, real = self._normals(p, np.zeros(len(p)), self.center[touch], self.turn[touch])
        way = np.stack((normal[:, 1], -normal[:, 0]), axis=1)
        return way, tilt, dot(self.center[touch] - p, way), real

    def _ends(self, touch: Ints, y: Floats, target: Ints, branch: Ints) -> tuple[Floats, Flags]:
        """Where lines about features meet the carriers of targets, moved onto these; whether certain."""
        p = self._places(y)
        way, _, _, real = self._about(touch, p)
        pieces, k = self.pieces, self.targets[target]
        chord = pieces.end[k] - pieces.start[k]
        length, along = norm(chord), unit(chord)
        sine = cross(way, along)
        flat = np.abs(sine) < 1e-6
        place = np.clip(cross(pieces.start[k] - p, way) / np.where(flat, 1.0, sine), 0.0, length)
        straight = pieces.start[k] + place[:, None] * along
        radius = pieces.radius[k]
        middle, height, half = chords(way, pieces.center[k] - p, radius)
        is_straight = pieces.sense[k] == 0
        on_circle = p + (middle + half * (2 * branch - 1))[:, None] * way
        sure = real & np.where(is_straight, ~flat, np.abs(height) <= radius * (1 + 1e-9))
        return np.where(is_straight[:, None], straight, on_circle), sure

    def _least(self, touch: Ints, low: Floats, high: Floats, target: Ints, branch: Ints) -> Floats:
        """Lower bounds of the lengths of cells' lines of sight, from tangents' lengths on both sides."""
        center, square = self.center[touch], self.turn[touch] ** 2
        y = np.clip(center[:, 1], low, high)
        before = norm(self._places(y) - center) ** 2 - square
        one, is_one_sure = self._ends(touch, low, target, branch)
        two, is_two_sure = self._ends(touch, high, target, branch)
        chord = two - one
        size = norm(chord)
        u = np.clip(dot(center - one, chord) / np.maximum(size * size, TINY), 0.0, 1.0)
        off = norm(center - one - u[:, None] * chord)
        k = self.targets[target]
        radius, is_straight = self.pieces.radius[k], self.pieces.sense[k] == 0
        bulge = np.where(is_straight, 0.0, size * size / (4 * radius))
        # A short chord of a small turn belongs to a small arc.
        small = (size < radius / 2) & (high - low < 0.2 * np.maximum(np.abs(center[:, 0] - self.x), TINY))
        rough = np.abs(norm(center - self.pieces.center[k]) - radius)
        whole = self.pieces.end[k] - self.pieces.start[k]
        v = dot(center - self.pieces.start[k], whole) / np.maximum(dot(whole, whole), TINY)
        foot = norm(center - self.pieces.start[k] - np.clip(v, 0.0, 1.0)[:, None] * whole)
        fine = is_one_sure & is_two_sure & (is_straight | small)
        beyond = np.where(fine, np.maximum(off - bulge, 0.0), np.where(is_straight, foot, rough))
        after = beyond * beyond - square
        return np.asarray(np.sqrt(np.maximum(before, 0.0)) + np.sqrt(np.maximum(after, 0.0)))

    def _by_range(self, cells: list[LineCell]) -> list[LineCell]:
        """The cells with lines that may be within range.

        They are halved until each part is out of range, a line within it is found, or floats tell no more.
        """
        if not cells:
            return []
        touch, target, branch = np.array([(c.touch, c.target, c.branch) for c in cells]).T
        low, high = np.array([(c.low, c.high) for c in cells]).T
        parent = np.arange(len(cells))
        samples: dict[int, float] = {}
        close: set[int] = set()
        while len(parent):
            keep = self._least(touch[parent], low, high, target[parent], branch[parent]) <= (
                self.radius + self.slack
            )
            low, high, parent = low[keep], high[keep], parent[keep]
            middle = (low + high) / 2
            there = self._lengths(touch[parent], middle, target[parent], branch[parent])
            within = there < self.radius - 10 * self.slack
            for k, y in zip(parent[within].tolist(), middle[within].tolist(), strict=True):
                samples.setdefault(k, y)
            small = high - low < 1e4 * self.slack
            close.update(parent[small].tolist())
            go = ~small & ~np.isin(parent, [*samples, *close])
            low, middle, high, parent = low[go], middle[go], high[go], parent[go]
            low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
            parent = np.concatenate((parent, parent))
        return [
            replace(cell, sample=samples.get(k)) for k, cell in enumerate(cells) if k in samples or k in close
        ]

    def _lengths(self, touch: Ints, y: Floats, target: Ints, branch: Ints) -> Floats:
        """Lengths of the lines of sight about features from ordinates to targets; infinite if not certain."""
        q, sure = self._ends(touch, y, target, branch)
        return np.where(sure, norm(q - self._places(y)), np.inf)
