"""What all work on a Ray cluster has in common: a connection, its room, and what became of a task."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager

import ray

from aeye._errors import EngineError, Error


@contextmanager
def connected(address: str | None) -> Iterator[None]:
    """A connection to a cluster: that of this process, or one that ends with the call."""
    if ray.is_initialized():
        yield
        return
    ray.init(address=address, include_dashboard=None if address else False, logging_level=logging.WARNING)
    try:
        yield
    finally:
        ray.shutdown()


def room(cores: int) -> int:
    """How many tasks with so many CPUs each the cluster has room for now, at least one."""
    return max(1, int(ray.cluster_resources().get("CPU", 1)) // cores)


def fetched(reference: "ray.ObjectRef[dict[str, bytes]]", what: str) -> dict[str, bytes]:
    """The files that a task gave, or the error that it ended with, as one of this package."""
    try:
        files: dict[str, bytes] = ray.get(reference)
        return files
    except ray.exceptions.RayTaskError as error:
        if isinstance(error.cause, Error):
            raise error.cause from None
        raise
    except ray.exceptions.RayError as error:
        reason = str(error).strip().splitlines()[0]
        raise EngineError(f"{what}: was lost as often as it may be, at last: {reason}") from error
