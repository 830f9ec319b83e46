"""Sessions: a process of `lightnet session` that keeps hosts, scenes and what was prepared from one edit to the next."""

import json
import os
import subprocess

from . import graph, operators, picture, program
from .errors import Error, UserError, error_of
from .run import patience


class Session:
    """Renders a graph, and again after each edit, for which only what it changes is done anew. Use it in `with`: its end
    ends the process, and leaves no file.

        with ln.Session(image, size=(320, 240)) as session:
            picture = session.picture()                       # as it is
            picture = session.edit(set={"direct.samples": 4}) # finished; the bits of a run of its own
            for picture in session.edits(camera={"from": (0, 1, 5), "to": (0, 0, 0)}):
                ...                                           # better and better, the finished one last

    Edits are those of `lightnet session`: set, camera, scene, constants; None takes one back. What is wrong with one is
    raised as UserError, and the session goes on. Options are those of `lightnet run`. One thread at a time.
    """

    def __init__(self, image, **options):
        self._folder = program.folder()
        folder = self._folder.__enter__()
        self._at, self._number, self._held, self._process, self._functions = folder, 0, {}, None, None
        self._refused = False  # the last edit that was wrong
        try:
            self._functions = operators.served(image, folder, options)
            with program.uninterrupted():
                self._process = self._start(image, folder, options, self._functions)
        except BaseException:
            self.close()
            raise

    @staticmethod
    def _start(image, folder, options, functions):
        words, text = graph.words_of(image, folder)
        if text is not None:
            words = [os.path.join(folder, "graph.json")]
            with open(words[0], "w", encoding="utf-8") as out:
                out.write(text)
        exr = os.path.join(folder, "picture.exr")
        command = [program.path(), "session", *words, "-o", exr, "--npz", exr[:-3] + "npz", "--compression", "none"]
        with open(os.path.join(folder, "said"), "w", encoding="utf-8") as said:
            return subprocess.Popen(
                [*command, "--json", *program.flags({**options, **functions.options})], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                stderr=said, text=True, start_new_session=True, env={**os.environ, **functions.environment},
            )  # fmt: skip

    def picture(self):
        """The finished picture of the graph as it stands, where no edit has been made yet."""
        return _last(self._pictures(None))

    def edit(self, **edit):
        """Makes an edit, and returns its finished picture."""
        return _last(self.edits(**edit))

    def edits(self, **edit):
        """Makes an edit, and gives its pictures, which get better; the last one is finished. Whoever leaves the loop
        early may go on with another edit."""
        self._number += 1
        edit = _plain(edit)
        self._send({"id": self._number, **edit})
        return self._pictures_of(edit)

    def _send(self, edit):
        self._process.stdin.write(json.dumps(edit) + "\n")
        self._process.stdin.flush()

    def _pictures_of(self, edit):
        try:
            for made in self._pictures(self._number):
                self._held = _joined(self._held, edit)
                yield made
        except UserError:
            if not self._refused:  # it holds: all that follows would be wrong, too
                self._send(_taken_back(edit, self._held))
            raise

    def _pictures(self, number):
        for line in self._process.stdout:
            event = json.loads(line)
            if event.get("id") != number:
                continue
            if event["event"] == "error":
                problem = self._functions.failure or UserError("\n".join(_text(one) for one in event["problems"]))
                self._functions.failure = None
                self._refused = event["refused"]
                raise problem
            if event["event"] == "picture":
                made = picture.in_folder(self._at, whole=event["finished"])
                made.samples_so_far = event["samples"]
                yield made
                if event["finished"]:
                    return
        if self._functions.failure:
            raise self._functions.failure
        raise error_of(self._process.wait(), self._said()) if self._process.wait() else Error("the session is over")

    def _said(self):
        with open(os.path.join(self._at, "said"), encoding="utf-8") as file:
            return file.read()

    def close(self):
        """Ends it. Nothing, where that was done already."""
        if self._process:
            self._end(self._process)
        if self._functions:
            self._functions.close()
        self._folder.__exit__(None, None, None)

    @staticmethod
    def _end(process):
        if process.poll() is None:
            process.terminate()
            try:
                process.wait(patience)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        for stream in (process.stdin, process.stdout):
            stream.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def _last(pictures):
    result = None
    for result in pictures:
        pass
    return result


def _joined(held, edit):
    """What holds when an edit has been made."""
    joined = {**held, **edit}
    for name in ("set", "constants"):
        if name in edit and name in held:
            joined[name] = {**held[name], **edit[name]}
    return joined


def _taken_back(edit, held):
    """The edit that makes things as they were before another."""
    back = {}
    for name, value in edit.items():
        before = held.get(name)
        back[name] = {key: (before or {}).get(key) for key in value} if name in ("set", "constants") else before
    return back


def _plain(value):
    """What JSON has no words for, as lists and numbers."""
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    if hasattr(value, "tolist"):
        return value.tolist()
    return os.fspath(value) if hasattr(value, "__fspath__") else value


def _text(problem):
    line = f":{problem['line']}" if problem["line"] else ""
    return f"{problem['file']}{line}: {problem['what']}"
