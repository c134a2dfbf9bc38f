"""Workers that compute variants: processes of this machine, or of a cluster with a Dask scheduler."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Protocol

from lamella.base.errors import InputError
from lamella.studies.variant import FAILED, Base, Outcome, compute_variant

LOST_MAX = 3
"""How often a variant is begun anew on a cluster that lost its workers, beyond what the scheduler itself does."""

ALLOWED_FAILURES = 20
"""Workers that may die on a variant before the scheduler thinks that it kills them."""

AHEAD = 4
"""Variants handed out for each worker: enough that none waits, few enough that an end comes soon."""

CONNECT_SECONDS = 10
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS", "RAYON_NUM_THREADS")


class Crew(Protocol):
    """Whoever computes variants."""

    def outcomes(self, chosen: Sequence[tuple[Any, ...]]) -> Iterator[tuple[int, Outcome]]:
        """Each variant's number in the list with what became of it, in the order in which they are ready."""


class Alone:
    """This process computes variants, one after the other."""

    def __init__(self, base: Base) -> None:
        self._base = base

    def outcomes(self, chosen: Sequence[tuple[Any, ...]]) -> Iterator[tuple[int, Outcome]]:
        """See `Crew`."""
        return ((number, compute_variant(self._base, one)) for number, one in enumerate(chosen))


@contextmanager
def workers(base: Base, *, jobs: int | None, scheduler: str | None) -> Iterator[Crew]:
    """Workers for the variants of a study.

    Parameters
    ----------
    base : Base
    jobs : int or None
        Processes of this machine; as many as it has cores when not given. With 1 this process does it, without Dask.
    scheduler : str or None
        Address of a Dask scheduler, "tcp://host:8786", whose workers have lamella installed.

    Raises
    ------
    InputError
        Dask is not installed, or there is no such scheduler.
    """
    if jobs == 1 and scheduler is None:
        yield Alone(base)
        return
    try:
        import dask
        from distributed import Client, LocalCluster
    except ImportError:
        raise InputError(
            "a study on several processes needs Dask, and it is not installed",
            'install it: pip install "lamella[study]"; or write --jobs 1',
        ) from None
    settings = {
        "distributed.scheduler.allowed-failures": ALLOWED_FAILURES,
        # variants take seconds: none is worth a second copy, and none is worth moving
        "distributed.scheduler.work-stealing": False,
        "distributed.worker.daemon": True,
        # a variant of a large net holds the interpreter for longer than Dask takes for healthy
        "distributed.admin.tick.limit": "1h",
        "distributed.comm.timeouts.connect": f"{CONNECT_SECONDS}s",
        "distributed.logging.distributed": "error",
    }
    with dask.config.set(settings), _one_thread():
        if scheduler is not None:
            try:
                client = Client(scheduler, timeout=CONNECT_SECONDS)
            except (OSError, ValueError, TypeError) as error:
                raise InputError(
                    f"no Dask scheduler answers at {scheduler}: {error}",
                    "start one (dask scheduler, then dask worker ADDRESS), or leave --scheduler out",
                    "--scheduler",
                ) from None
            with client:
                yield Workers(client, base)
            return
        try:
            cluster = LocalCluster(
                n_workers=jobs or os.cpu_count() or 1,
                threads_per_worker=1,
                processes=True,
                dashboard_address=None,
                silence_logs=50,
            )
        except RuntimeError as error:
            raise InputError(
                f"the processes of a study could not be begun: {error}",
                "try again with fewer --jobs; with 1 the program itself does it",
                "--jobs",
            ) from None
        with cluster, Client(cluster) as client:
            yield Workers(client, base)


@contextmanager
def _one_thread() -> Iterator[None]:
    """Processes begun inside run their linear algebra in one thread: sums are rounded alike on all of them."""
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


class Workers:
    """A Dask client that computes variants.

    Parameters
    ----------
    client : distributed.Client
    base : Base
    """

    def __init__(self, client: Any, base: Base) -> None:
        self._client = client
        # once to each worker that needs it, and as a task of its own: data that were only sent would be lost with the
        # worker that holds them
        self._base = client.submit(_given, base, pure=False)

    @property
    def count(self) -> int:
        """Workers there are now."""
        return max(1, len(self._client.scheduler_info(n_workers=-1)["workers"]))

    def outcomes(self, chosen: Sequence[tuple[Any, ...]]) -> Iterator[tuple[int, Outcome]]:
        """See `Crew`."""
        from distributed import as_completed
        from distributed.scheduler import KilledWorker

        waiting = list(range(len(chosen)))[::-1]
        numbers: dict[str, int] = {}
        tries = dict.fromkeys(range(len(chosen)), 0)
        ready = as_completed([])

        def hand_out(number: int) -> None:
            # not pure: a variant that was lost is computed anew
            future = self._client.submit(compute_variant, self._base, chosen[number], pure=False)
            numbers[future.key] = number
            ready.add(future)

        for _ in range(min(len(waiting), AHEAD * self.count)):
            hand_out(waiting.pop())
        for future in ready:
            number = numbers.pop(future.key)
            error = future.exception() if future.status == "error" else None
            if isinstance(error, KilledWorker) or future.status == "cancelled":
                tries[number] += 1
                if tries[number] <= LOST_MAX:
                    hand_out(number)
                    continue
                reason = "its worker was lost again and again: out of memory, or ended by the machine"
                yield number, _failed(reason)
            elif error is not None:
                yield number, _failed(f"{type(error).__name__}: {error}")
            else:
                yield number, future.result()
            future.release()
            if waiting:
                hand_out(waiting.pop())


def _given(base: Base) -> Base:
    return base


def _failed(reason: str) -> Outcome:
    remedy = "run the study again: what is missing is computed"
    return Outcome(FAILED, reason, remedy, {}, None, {}, b"", 0.0)
