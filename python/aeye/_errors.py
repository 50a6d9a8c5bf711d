"""What is raised: each exception says in one sentence what is wrong, and what was expected."""


class Error(Exception):
    """Anything that the package itself raises."""


class FileError(Error, OSError):
    """A file or folder is not there, or the system does not let it be read or written."""


class InputError(Error, ValueError):
    """A value or the content of a file is not what is expected."""


class EngineError(Error, RuntimeError):
    """Something cannot be computed here: no graphics driver, another simulation, a network that fails."""


class DivergedError(EngineError):
    """A replay is not the run that was recorded."""


class MissingRunsError(EngineError):
    """Shards have not driven all runs that are needed, or all runs do not come to the goal."""
