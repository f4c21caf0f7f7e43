"""Where batches run: dask's threads, dask worker processes, or a dask cluster at an address.

An executor takes batches and gives outcomes in whatever order they come; results do not depend on which it is.
"""

from __future__ import annotations

import os
import queue
from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Literal

from reperform.graphs.batch import run_batch
from reperform.graphs.messages import Batch, Outcome

CONNECT_SECONDS = 10.0
Scheduler = Literal["threads", "processes"]


class Executor(ABC):
    """Runs batches."""

    slots: int

    def __init__(self) -> None:
        self._done: queue.SimpleQueue[tuple[Hashable, Outcome | BaseException]] = queue.SimpleQueue()

    @abstractmethod
    def submit(self, tag: Hashable, batch: Batch) -> None:
        """Start a batch; its outcome comes back under the tag."""

    @abstractmethod
    def close(self) -> None:
        """Let go of the workers."""

    def wait(self, timeout: float | None) -> tuple[Hashable, Outcome] | None:
        """The next outcome; None after the timeout. Raises what kept a batch from running at all."""
        try:
            tag, outcome = self._done.get(timeout=timeout)
        except queue.Empty:
            return None
        if isinstance(outcome, BaseException):
            raise outcome
        return tag, outcome


class Threads(Executor):
    """dask's threaded scheduler in this process: nothing to start, arrays read once are shared."""

    def __init__(self, jobs: int) -> None:
        import dask.threaded
        from threadpoolctl import threadpool_limits

        super().__init__()
        self.slots = jobs
        self._get: Callable[..., Any] = dask.threaded.get
        self._pool = ThreadPoolExecutor(jobs, thread_name_prefix="batch")
        self._drivers = ThreadPoolExecutor(jobs, thread_name_prefix="driver")
        # results must not depend on how many threads a BLAS splits a sum over
        self._limits = threadpool_limits(limits=1)

    def submit(self, tag: Hashable, batch: Batch) -> None:
        """Start a batch."""
        self._drivers.submit(self._drive, tag, batch)

    def _drive(self, tag: Hashable, batch: Batch) -> None:
        try:
            self._done.put((tag, self._get({"batch": (run_batch, batch)}, "batch", pool=self._pool)))
        except BaseException as error:  # handed over: the run ends with it
            self._done.put((tag, error))

    def close(self) -> None:
        """Wait for running batches and end the threads."""
        self._drivers.shutdown(wait=True, cancel_futures=True)
        self._pool.shutdown(wait=True)
        self._limits.restore_original_limits()


class Workers(Executor):
    """dask workers: processes of this machine, or a cluster at an address."""

    def __init__(self, client: Any, cluster: Any = None) -> None:
        super().__init__()
        self._client, self._cluster = client, cluster
        self.slots = max(1, sum(client.nthreads().values()))

    @staticmethod
    def local(jobs: int) -> Workers:
        """Worker processes on this machine."""
        from distributed import Client, LocalCluster

        cluster = LocalCluster(n_workers=jobs, threads_per_worker=1, processes=True, dashboard_address=None)
        return Workers(Client(cluster), cluster)

    @staticmethod
    def at(address: str) -> Workers:
        """The workers of a running dask scheduler, such as tcp://host:8786."""
        from distributed import Client

        try:
            client = Client(address, timeout=CONNECT_SECONDS)
        except OSError as error:
            raise ConnectionError(
                f"no dask scheduler answers at {address}: start one with `dask scheduler` ({error})"
            ) from error
        if not client.nthreads():
            client.close()
            raise ConnectionError(
                f"the dask scheduler at {address} has no workers: start some with `dask worker {address}`"
            )
        return Workers(client)

    def submit(self, tag: Hashable, batch: Batch) -> None:
        """Start a batch."""
        future = self._client.submit(run_batch, batch, pure=False)
        future.add_done_callback(lambda done: self._finish(tag, done))

    def _finish(self, tag: Hashable, future: Any) -> None:
        error = future.exception() if future.status == "error" else None
        if future.status == "cancelled":
            error = ConnectionError("the dask cluster dropped a batch: is it still up?")
        self._done.put((tag, error or future.result()))

    def close(self) -> None:
        """Let go of the cluster; end it where it is ours."""
        self._client.close()
        if self._cluster is not None:
            self._cluster.close()


def open_executor(jobs: int | None, scheduler: Scheduler, cluster: str | None) -> Executor:
    """The executor a run asks for. jobs None: as many as the processor has cores."""
    if cluster:
        return Workers.at(cluster)
    jobs = (
        jobs or len(os.sched_getaffinity(0))
        if hasattr(os, "sched_getaffinity")
        else jobs or os.cpu_count() or 1
    )
    return Threads(jobs) if scheduler == "threads" else Workers.local(jobs)
