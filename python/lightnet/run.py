"""Runs: each is one process of `lightnet`, which ends with whoever asked for it."""

import contextlib
import json
import os
import signal
import subprocess
import tempfile

from . import graph, operators, picture, program
from .errors import error_of

patience = 20  # seconds that a run has to end when it is told to
interrupted = 130


class Run:
    """A run that goes on. `for picture in run:` gives the picture so far each time that it got better, and the finished
    one last. Ends, and leaves neither a process nor a file, when the loop is left, by break or by an exception."""

    def __init__(self, image, every=1.0, **options):
        self.image, self.every, self.options = image, every, options
        self.events, self.said, self._cancelled, self._told = [], [], False, False
        self._process = None

    def cancel(self):
        """Ends the run early; the loop then gets the picture that there is. May be called from any thread, and again."""
        self._cancelled = True
        if self._process and not self._told:  # a second signal would end it without its last words
            self._told = True
            self._process.send_signal(signal.SIGTERM)

    def __iter__(self):
        with program.folder() as folder:
            with contextlib.closing(operators.served(self.image, folder, self.options)) as functions:
                try:
                    yield from self._pictures(folder, functions)
                finally:
                    self._end()

    def _pictures(self, folder, functions):
        self._start(folder, functions)
        shown = None
        for line in self._process.stderr:
            if not self._hear(line):
                continue
            there = _identity(folder)
            if self.every and there and there != shown:
                shown = there
                yield picture.in_folder(folder, whole=False)
        code = self._process.wait()
        if code != 0 and not (code == interrupted and self._cancelled and _identity(folder)):
            raise functions.failure or error_of(code, "\n".join(self.said))
        yield picture.in_folder(folder, "\n".join(self.said))

    def _start(self, folder, functions):
        words, text = graph.words_of(self.image, folder)
        exr = os.path.join(folder, "picture.exr")
        command = [program.path(), "run", *words, "-o", exr, "--npz", exr[:-3] + "npz", "--compression", "none"]
        command += ["--forget", "--progress", "json", *program.flags({**self.options, **functions.options})]
        if self.every:
            command += ["--preview", repr(float(self.every))]
        with tempfile.TemporaryFile() as given:
            given.write((text or "").encode())
            given.seek(0)
            with program.uninterrupted():
                self._process = subprocess.Popen(
                    command, stdin=given, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                    start_new_session=True, env={**os.environ, **functions.environment},
                )  # fmt: skip
        if self._cancelled:
            self.cancel()

    def _hear(self, line):
        """False: it was no event of progress."""
        try:
            event = json.loads(line)
        except ValueError:
            self.said.append(line.rstrip("\n"))
            return False
        if event.get("event") == "message":
            self.said.append(event["text"])
        self.events.append(event)
        return True

    def _end(self):
        process = self._process
        if process is None:
            return
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(patience)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
        process.stderr.close()


def _identity(folder):
    """What changes when the picture there does; None: there is none yet."""
    try:
        facts = os.stat(os.path.join(folder, "picture.npz"))
        os.stat(os.path.join(folder, "picture.png"))
    except FileNotFoundError:
        return None
    return facts.st_ino, facts.st_mtime_ns


def progress(image, every=1.0, **options):
    """Renders, and gives the picture so far every so many seconds, then the finished one: `for picture in
    progress(image): …`. `picture.done` says how much is done. Options are those of render()."""
    return Run(image, every, **options)


def render(image, output=None, **options):
    """Renders a graph, and returns its Picture, whose bits are those of `lightnet run`.

    image: the node that makes it (RayTracer), what load() gave, or the name of a graph file.
    output: "x.exr", to have it written as well, with x.png beside it.
    options: those of `lightnet run`, by name: threads=4, local_workers=2, hosts="lab.lua", key=…, seed=7,
    samples=64, size=(640, 480), crop=(0, 0, 64, 64), gain={"direct": 0.5}, clean=True, time_limit=60, alpha=True …

    Other threads of Python go on meanwhile. Ctrl-C ends the run, and raises KeyboardInterrupt. Raises UserError when
    the graph, its scene or an option is wrong, NoWorker, UnknownKey, or Error.
    """
    result = None
    for result in Run(image, 0, **options):
        pass
    if output is not None:
        result.save(output)
    return result
