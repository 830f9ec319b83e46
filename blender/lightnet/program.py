"""The program `lightnet` as a child process, and what it says while it works. Knows nothing of Blender."""

import json
import os
import queue
import shutil
import signal
import subprocess
import threading

patience = 15  # seconds that a run has to end when it is told to


def path_of(chosen):
    """Where the program is: where the preferences say, else `$LIGHTNET`, else in the PATH. Raises FileNotFoundError."""
    for candidate in (chosen, os.environ.get("LIGHTNET"), shutil.which("lightnet")):
        if candidate and os.access(candidate, os.X_OK):
            return candidate
    raise FileNotFoundError("there is no program lightnet in the PATH; the add-on's preferences may name it")


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
        try:
            self._process.wait(patience)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
        self._reader.join()
        self._process.stderr.close()
