"""Hostile requests, made from good ones: the n-th one is always the same.

Of each request some parts are spoiled: its method, its path, whom it says to come from and to speak to, its
other headers, its body, the length of that as it is told, and the way it is sent.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from random import Random
from typing import Any
from urllib.parse import quote, unquote

from hostile_files import NUMBERS, hostile, kinds

KINDS = kinds()
LARGE = (25 << 20, 65 << 20)
"""Bytes of a body that is more than a drawing may have, and more than a file may."""
DISC = {"name": "O1", "circle": {"center": ["5", "0"], "radius": "2"}}
SQUARE = [
    ["8", "8"],
    ["10", "8", "1/2"],
    ["10", "10", {"center": ["9", "10"], "clockwise": False}],
    ["8", "10"],
]
ROOM = {"boundary": [["-20", "-20"], ["30", "-20"], ["30", "30"], ["-20", "30"]]}
TERRAIN = {"width": "20", "height": "20", "origin": ["0", "0"]}
SCENE = {"name": "a", "start": ["0", "0"], "radius": "20", "obstacles": [DISC, {"boundary": SQUARE}]}
DRAWINGS: list[Any] = [
    {"scene": SCENE},
    {"scene": {**SCENE, "enclosure": ROOM, "notes": ["n"]}, "strategy": "nearest-frontier"},
    {
        "scene": {**SCENE, "terrain": TERRAIN},
        "strategy": "seed-spreader",
        "lookahead": False,
        "target": "visible",
    },
]
QUERIES = {
    "api/gallery/circles": {}, "api/gallery/figure2": {}, "api/gallery": {}, "api/first": {}, "": {},
    "main.js": {}, "player/player.js": {}, "api/run": {"number": "1"}, "api/data": {"number": "1"},
}  # fmt: skip
"""What is asked for, with the parameters."""
TASKS = ("api/check", "api/text", "api/run", "api/stop", "api/save", "api/open")
METHODS = (
    "GET", "POST", "HEAD", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "get", "BREW", "X" * 5000,
)  # fmt: skip
TEXTS = (
    "", "\0", "\ud800", "\U0001f642" * 50, "../../etc/passwd", "\r\nX: y", "<script>", "%s%n", "x" * 70_000,
    "__proto__", "1/0", "1e999999999", "1e-999999999", "NaN", "-inf", "9" * 10_000, "٣", "0x10", "1_0", " 1 ",
    "1/" + "3" * 5000, "'",
)  # fmt: skip
PATHS = (
    "..", "../..", "%2e%2e", "..%2f..", "%5c..", "%00", "%ff", "%c0%ae", "//", ".", "a" * 60_000,
    "%41" * 3000, "/" * 4000, "etc/passwd", "~root", "index.html", "http://evil.example/", "*", "?", "#", "%",
    "%zz", ";", "api/../api.py",
)  # fmt: skip


@dataclass(frozen=True)
class Attack:
    """A request: its head as lines, its body, and how it is sent.

    It is sent in *pieces*, with a pause after each. The rest from *cut* on never comes: then the sender does
    not wait for an answer, nor does he if he *promised* more than he sends.
    """

    method: str
    target: str
    headers: tuple[tuple[str, str], ...]
    body: bytes
    pieces: int = 1
    pause: float = 0.0
    cut: int | None = None
    promised: bool = False

    @property
    def sent(self) -> bytes:
        """All that is sent."""
        lines = [
            f"{self.method} {self.target} HTTP/1.1",
            *(f"{name}: {value}" for name, value in self.headers),
        ]
        whole = "\r\n".join([*lines, "", ""]).encode("utf-8", "surrogatepass") + self.body
        return whole[: self.cut]

    @property
    def is_whole(self) -> bool:
        """Whether an answer must come."""
        return self.cut is None and not self.promised

    def may_be_answered(self, host: str, token: str) -> bool:
        """Whether it comes from the page itself, as far as its head tells."""
        told: dict[str, list[str]] = {}
        for name, value in self.headers:
            told.setdefault(name.lower(), []).append(value.strip())
        return (
            [name.lower() for name in told.get("host", [])] == [host]
            and told.get("origin", []) in ([], [f"http://{host}"])
            and told.get("sec-fetch-site", ["none"]) in (["none"], ["same-origin"])
            and unquote(self.target).startswith(f"/{token}/")
        )

    def __str__(self) -> str:
        return f"{self.sent[:2000]!r}, {len(self.sent)} bytes in {self.pieces} pieces"


def attack(n: int, host: str, token: str) -> Attack:
    """The n-th hostile request to a server with that name and secret."""
    rng = Random(n)
    path, query, body, kind = _task(rng) if rng.randrange(3) else _question(rng)
    method = "POST" if kind else "GET"
    headers = [("Host", host), *([("Content-Type", kind)] if kind else [])]
    target = f"/{token}/{path}" + (f"?{query}" if query else "")
    made = dict.fromkeys(
        rng.sample(("method", "path", "origin", "headers", "length", "sending"), rng.choice((0, 1, 1, 2)))
    )
    if "method" in made:
        method = rng.choice(METHODS)
    if "path" in made:
        target = _other_path(rng, token, path)
    if "origin" in made:
        headers = _foreign(rng, host, headers)
    if "headers" in made:
        headers = _odd(rng, headers)
    body, framing, promised = _framed(rng, body) if "length" in made else (body, _length(body), False)
    if not kind and not body:
        framing = []
    found = Attack(method, target, (*headers, *framing), body, promised=promised)
    return _sent_otherwise(rng, found) if "sending" in made else found


# -- paths and bodies ---------------------------------------------------------------------------------------


def _question(rng: Random) -> tuple[str, str, bytes, str]:
    path, parameters = rng.choice(list(QUERIES.items()))
    return path, _query(rng, dict(parameters)), b"", ""


def _task(rng: Random) -> tuple[str, str, bytes, str]:
    path = rng.choice(TASKS)
    if path == "api/open":
        name = rng.choice(list(KINDS))
        body, options = hostile(KINDS[name], rng.randrange(rng.choice((8, 1 << 30))), name)
        start = options.pop("start", None)
        asked = {"suffix": KINDS[name].suffix, "options": json.dumps(options, default=str)}
        if start is not None:
            asked["start"] = ",".join(map(str, start))  # type: ignore[arg-type]
        return path, _query(rng, asked), body, "application/octet-stream"
    asked = {"kind": rng.choice(("figure", "trace", "page")), "at": "2"} if path == "api/save" else {}
    return path, _query(rng, asked), _body(rng), "application/json"


def _query(rng: Random, parameters: dict[str, str]) -> str:
    """Parameters, one of them spoiled perhaps, in a query."""
    if rng.randrange(3) == 0 and parameters:
        name = rng.choice(list(parameters))
        parameters[name] = rng.choice(
            (*TEXTS, "[" * 5000, "{}", '{"a": {}}', '{"\\ud800": 1}', "null", "1,2,3")
        )
    pairs = [f"{quote(name)}={quote(value, errors='replace')}"[:50_000] for name, value in parameters.items()]
    if rng.randrange(8) == 0:
        pairs += [rng.choice(("%ff=%ff", "&&&", "a" * 20_000, "number=2", "=", *pairs))]
    return "&".join(pairs)


def _body(rng: Random) -> bytes:
    way = rng.randrange(8)
    if way == 0:
        return rng.choice(
            (b"", b"{", b"null", b"[" * 300_000, b'{"a":' * 50_000, b"\xff\xfe{}", b"\0" * 1000, b" " * 10**6)
        )
    drawing = json.loads(json.dumps(rng.choice(DRAWINGS)))
    if way == 1:
        return json.dumps(drawing).encode()
    for _ in range(rng.randint(1, 3)):
        _spoil(rng, drawing)
    body = json.dumps(drawing).encode("utf-8", "surrogatepass")
    if way == 2:
        body = body[: rng.randrange(len(body))]
    if way == 3:
        body = body.replace(b'"20"', rng.choice(NUMBERS), 1)
    return body


def _spoil(rng: Random, value: Any) -> None:
    """Change one thing, somewhere in a document."""
    while True:
        keys = list(value) if isinstance(value, dict) else range(len(value))
        if not keys:
            return
        key = rng.choice(list(keys))
        if not isinstance(value[key], dict | list) or rng.randrange(5) == 0:
            break
        value = value[key]
    way = rng.randrange(5)
    if way == 0:
        del value[key]
    elif way == 1 and isinstance(value, list):
        value.extend([value[key]] * rng.choice((1, 2, 500)))
    elif way == 1:
        value[rng.choice(TEXTS)] = value[key]
    elif way == 2:
        value[key] = rng.choice((None, True, [], {}, 7, -1.5, 10**400, [[]], {"": []}, [1] * 3000))
    else:
        value[key] = rng.choice(TEXTS)


def _other_path(rng: Random, token: str, path: str) -> str:
    odd = rng.choice(PATHS)
    return rng.choice((
        f"/{token}/{odd}", f"/{odd}", f"/{token}{odd}", f"/{token}/{path}/{odd}",
        f"/{token}/api/gallery/{odd}", f"/{path}", "/", f"/{token[:-1]}/{path}",
        f"/{token.swapcase()}/{path}", f"//{token}/{path}", f"/x/{token}/{path}",
        f"http://evil.example/{token}/{path}", "/" + "".join(f"%{ord(c):02x}" for c in token) + f"/{path}",
    ))  # fmt: skip


# -- heads ---------------------------------------------------------------------------------------------------

Headers = list[tuple[str, str]]


def _foreign(rng: Random, host: str, headers: Headers) -> Headers:
    """From another page, or under another name."""
    evil = rng.choice(
        ("evil.example", f"evil.example:{host.partition(':')[2]}", "127.0.0.1:1", "", f"{host}.evil.example")
    )
    rest = [(name, value) for name, value in headers if name != "Host"]
    way = rng.randrange(6)
    if way == 0:
        return [("Host", evil), *rest]
    if way == 1:
        return [("Host", host), ("Host", evil), *rest]
    if way == 2:
        return rest
    if way == 3:
        return [*headers, ("Sec-Fetch-Site", rng.choice(("cross-site", "same-site", "none, cross-site", "")))]
    if way == 4:
        return [*headers, ("Origin", f"http://{host}"), ("Origin", f"http://{evil}")]
    origin = rng.choice(
        (f"http://{evil}", f"https://{host}", "null", "", f"http://{host}@evil.example", f"http://{host} ")
    )
    return [*headers, ("Origin", origin), ("Referer", f"http://{evil}/")]


def _odd(rng: Random, headers: Headers) -> Headers:
    """Other headers: huge, very many, twice the same, or senseless."""
    return rng.choice((
        [*headers, ("X-Long", "a" * 70_000)],
        [*headers, *[(f"X-{k}", "b" * 50) for k in range(500)]],
        [*headers, *headers[1:]],
        [*headers, ("Content-Type", "text/plain")],
        [(name, "text/plain;" if name == "Content-Type" else value) for name, value in headers],
        [*headers, ("X", "\0")], [*headers, ("X y", "z")],
        [*headers, ("", "z")], [*headers, ("X", "é\ud800")],
        [*headers, ("Upgrade", "websocket"), ("Connection", "Upgrade"), ("Sec-WebSocket-Key", "x")],
        [*headers, ("Upgrade", "h2c"), ("Connection", "Upgrade, HTTP2-Settings"), ("HTTP2-Settings", "AAMA")],
        [*headers, ("Expect", "100-continue")], [*headers, ("Expect", "a miracle")],
        [*headers, ("Range", "bytes=0-,0-,0-"), ("Accept-Encoding", "bomb"), ("If-None-Match", "*")],
        [*headers, ("X-Forwarded-Host", "evil.example"), ("Forwarded", "host=evil")],
        [*headers, ("X-HTTP-Method-Override", "DELETE"), ("Cookie", "a=" + "b" * 4000)],
        [*headers, ("Connection", "close, close")],
    ))  # fmt: skip


def _length(body: bytes) -> Headers:
    return [("Content-Length", str(len(body)))]


def _framed(rng: Random, body: bytes) -> tuple[bytes, Headers, bool]:
    """A body, the headers that tell how long it is, and whether more is promised than is sent."""
    way, size = rng.randrange(9), len(body)
    if way == 0:
        return body, [("Content-Length", str(size + rng.choice((1, 1000, 10**7))))], True
    if way == 1:
        return (
            body,
            [("Content-Length", rng.choice(("-1", "1e3", "0x10", "٣", "9" * 12, "9" * 40, " ", "1, 2")))],
            True,
        )
    if way == 2:
        return body, [("Content-Length", str(max(0, size - 3)))], True
    if way == 3:
        return body, [*_length(body), ("Content-Length", str(size + 1))], True
    if way == 4:
        return body, [("Transfer-Encoding", rng.choice(("gzip", "chunked, chunked", "identity")))], True
    if way == 5:
        return b" " * rng.choice(LARGE), [("Content-Length", str(LARGE[1]))], True
    step = rng.choice((1, 7, 4096))
    chunks = [body[k : k + step] for k in range(0, min(size, step * 500), step)]
    coded = b"".join(b"%x\r\n%b\r\n" % (len(chunk), chunk) for chunk in chunks)
    if way == 6:
        return (
            coded + rng.choice((b"", b"zz\r\n", b"-1\r\n\r\n", b"f" * 30 + b"\r\n")),
            [("Transfer-Encoding", "chunked")],
            True,
        )
    both = [*_length(body), ("Transfer-Encoding", "chunked")]
    return coded + b"0\r\n\r\n", both if way == 7 else both[1:], way == 7


def _sent_otherwise(rng: Random, found: Attack) -> Attack:
    """Slowly, in pieces, or not to the end."""
    parts = {name: getattr(found, name) for name in ("method", "target", "headers", "body", "promised")}
    size = len(found.sent)
    if rng.randrange(2):
        return Attack(**parts, pieces=rng.randint(2, 8), pause=0.005)
    return Attack(**parts, pieces=rng.randint(1, 3), cut=rng.randrange(size))
