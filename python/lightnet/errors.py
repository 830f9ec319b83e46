"""Errors: what `lightnet` says when something is wrong, as exceptions with the same texts."""


class Error(Exception):
    """A run failed, or something that was asked for could not be written (exit code 1 of `lightnet`)."""


class UserError(Error):
    """A graph, its hosts, its scene or an option is wrong (exit code 2). `problems` has one text for each mistake, with
    file and line; a graph that was made here names the lines of Python on which its nodes were made."""

    def __init__(self, text):
        super().__init__(text)
        self.problems = text.splitlines()


class NoWorker(Error):
    """No worker could be reached, or none was free in time (exit code 3)."""


class UnknownKey(Error):
    """There are workers, but none whose key we know and that knows ours (exit code 4)."""


class NoProgram(Error):
    """The program `lightnet` is not there, or is of another version than this module."""


def error_of(code, text):
    """The exception for an exit code of `lightnet`, with what it said."""
    kinds = {2: UserError, 3: NoWorker, 4: UnknownKey}
    return kinds.get(code, Error)(text.strip() or f"lightnet ended with code {code}")
