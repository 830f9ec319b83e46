"""The program `lightnet`, which does all the work in a process of its own: no mistake of a run costs this one, the
interpreter is never held, and pictures come back as memory that both see."""

import contextlib
import functools
import os
import shutil
import signal
import subprocess
import tempfile
import threading

from .errors import NoProgram, error_of

least_room = 256 << 20  # bytes; what a small picture with many layers takes


@functools.lru_cache(maxsize=None)
def path():
    """Where the program is: `$LIGHTNET`, else beside this package (as wheels have it), else in the PATH."""
    beside = os.path.join(os.path.dirname(__file__), "bin", "lightnet")
    for candidate in (os.environ.get("LIGHTNET"), beside, shutil.which("lightnet")):
        if candidate and os.access(candidate, os.X_OK):
            return candidate
    raise NoProgram("there is no program lightnet in the PATH; $LIGHTNET may name it")


def said(*words, text=None, pass_fds=(), environment=None):
    """What the program prints on standard output. `text`: its standard input. Raises Error."""
    done = subprocess.run(
        [path(), *words], input=text, capture_output=True, text=True, pass_fds=pass_fds, start_new_session=True,
        env={**os.environ, **(environment or {})},
    )  # fmt: skip
    if done.returncode != 0:
        raise error_of(done.returncode, done.stderr)
    return done.stdout


@contextlib.contextmanager
def uninterrupted():
    """Ctrl-C counts when this is over: a process that is being started must be known before anybody can leave it."""
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(before):
        yield  # nobody is interrupted here
        return
    late = []
    signal.signal(signal.SIGINT, lambda *interrupt: late.append(interrupt))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if late:
            before(*late[0])


def flags(options):
    """Options of the command line: `local_workers=2` is `--local-workers 2`, `resume=True` is `--resume`, lists have
    commas between their entries, `size=(640, 480)` is `--size 640x480`, and `gain={"direct": 0.5}` is given once for
    each. What is None or False is left out."""
    words = []
    for name, value in options.items():
        flag = "--" + name.replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            words.append(flag)
        elif isinstance(value, dict):
            for key, one in value.items():
                words += [flag, f"{key}={_word(one, ',')}"]
        else:
            words += [flag, _word(value, "x" if name == "size" else ",")]
    return words


def _word(value, between):
    if isinstance(value, (list, tuple)):
        return between.join(_word(one, between) for one in value)
    return repr(float(value)) if isinstance(value, float) else os.fspath(value) if hasattr(value, "__fspath__") else str(value)


@contextlib.contextmanager
def folder():
    """A folder in memory (else where temporary files are), gone afterwards."""
    memory = "/dev/shm"
    room = os.statvfs(memory) if os.path.isdir(memory) and os.access(memory, os.W_OK) else None
    roomy = room is not None and room.f_bavail * room.f_frsize > least_room
    with tempfile.TemporaryDirectory(prefix=f"lightnet-{os.getpid()}-", dir=memory if roomy else None) as name:
        yield name
