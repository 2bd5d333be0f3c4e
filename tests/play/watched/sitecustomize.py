"""Notes what a program and its children write, and whom they call: Python finds this on its path."""

import os
import sys

NOTES = os.open(os.environ["WATCHED_NOTES"], os.O_WRONLY | os.O_APPEND | os.O_CREAT)
CHANGES = {
    *(
        "os.chmod",
        "os.chown",
        "os.link",
        "os.mkdir",
        "os.remove",
        "os.rename",
        "os.rmdir",
        "os.symlink",
        "os.truncate",
    ),
    *(
        "shutil.rmtree",
        "shutil.move",
        "socket.connect",
        "socket.getaddrinfo",
        "os.system",
        "subprocess.Popen",
    ),
}
"""Events that are noted, beside files that are opened to be written."""


def note(event, args):
    """Called by Python before it does what the event says."""
    if event == "open":
        path, mode, flags = args
        writes = set("wax+") & set(mode or "") or flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)
        if not writes or isinstance(path, int):
            return
    elif event not in CHANGES:
        return
    os.write(NOTES, f"{event} {args[0]!r}\n".encode(errors="replace"))


sys.addaudithook(note)
