"""The program `lightnet` as a child process, and what it says while it works. Knows nothing of Blender."""

import json
import os
import queue
import shutil
import signal
import subprocess
import tempfile
import threading

patience = 15  # seconds that a run has to end when it is told to


def path_of(chosen):
    """Where the program is: where the preferences say, else `$LIGHTNET`, else in the PATH. Raises FileNotFoundError."""
    for candidate in (chosen, os.environ.get("LIGHTNET"), shutil.which("lightnet")):
        if candidate and os.access(candidate, os.X_OK):
            return candidate
    raise FileNotFoundError("there is no program lightnet in the PATH; the add-on's preferences may name it")


def new_folder():
    """A folder of this process's own: in memory, where there is such a place, else where temporary files are."""
    memory = "/dev/shm"
    return tempfile.mkdtemp(prefix=f"lightnet-{os.getpid()}-", dir=memory if os.access(memory, os.W_OK) else None)


def wait_for(process):
    """Until it has ended, as it was told to; not for longer than it may take."""
    try:
        process.wait(patience)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


class Run:
    """One run. Ends with the block that it is used in: `with Run(command, folder) as run:`."""

    def __init__(self, command, folder):
        self.share, self.phase, self.left, self.said = 0.0, "starts", None, []
        self._lines = queue.SimpleQueue()
        self._told = False  # to end
        self._process = subprocess.Popen(
            command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            text=True, errors="replace", start_new_session=True,
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def _read(self):
        for line in self._process.stderr:
            self._lines.put(line.rstrip("\n"))
        self._lines.put(None)

    def hear(self, seconds):
        """Takes in what was said, waiting so long for the first word. False: it has ended, and all was heard."""
        try:
            line = self._lines.get(timeout=seconds)
            while True:
                if line is None:
                    return False
                self._take(line)
                line = self._lines.get_nowait()
        except queue.Empty:
            return True

    def _take(self, line):
        try:
            event = json.loads(line)
        except ValueError:
            event = None
        if not isinstance(event, dict):
            self.said.append(line)
        elif event.get("event") == "message":
            self.said.append(event["text"])
        elif "phase" in event:
            self.phase, self.left = event["phase"], event.get("seconds_left")
            self.share = event["done"] / event["total"] if event.get("total") else self.share

    def cancel(self):
        """Tells it to end early, with the picture that there is. A second signal would end it without its last words."""
        if self._process.poll() is None and not self._told:
            self._told = True
            self._process.send_signal(signal.SIGTERM)

    def code(self):
        """Its exit code, once it has ended."""
        return self._process.wait()

    def end(self):
        self.cancel()
        wait_for(self._process)
        self._reader.join()
        self._process.stderr.close()


class Session:
    """A session that stays, and makes a picture after each edit."""

    def __init__(self, command, folder):
        self._events, self._said, self._number = queue.SimpleQueue(), [], 0
        self._process = subprocess.Popen(
            command, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            text=True, errors="replace", start_new_session=True,
        )
        self._readers = [threading.Thread(target=one, daemon=True) for one in (self._read, self._listen)]
        for reader in self._readers:
            reader.start()

    def _read(self):
        for line in self._process.stdout:
            try:
                event = json.loads(line)
            except ValueError:
                continue
            if isinstance(event, dict) and event.get("event") in ("picture", "error"):
                self._events.put(event)

    def _listen(self):
        for line in self._process.stderr:
            self._said = [*self._said[-20:], line.rstrip("\n")]

    def edit(self, **edit):
        """Makes an edit (see the documents on sessions); what was at work ends."""
        self._number += 1
        try:
            self._process.stdin.write(json.dumps({"id": self._number, **edit}) + "\n")
            self._process.stdin.flush()
        except OSError:
            pass  # it has ended, which ended() says

    def has_news(self):
        return not self._events.empty()

    def events(self):
        """What has happened since the last call: pictures, and mistakes."""
        found = []
        while not self._events.empty():
            found.append(self._events.get())
        return found

    def said(self):
        """The last lines of its words."""
        return self._said

    def ended(self):
        return self._process.poll() is not None

    def end(self):
        if not self.ended():
            self._process.send_signal(signal.SIGTERM)
        wait_for(self._process)
        for reader in self._readers:
            reader.join()
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            try:
                stream.close()
            except OSError:
                pass  # words that nobody could be given any more
