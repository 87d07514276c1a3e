"""Speaks to a Dask cluster, if nobody else can.

What crosses is pickled, so whoever may speak to the scheduler may run anything on every machine of the cluster. Hence TLS,
with certificates asked of both sides, everywhere but on the loopback interface.
"""

from __future__ import annotations

import contextlib
import ipaddress
import os
from collections.abc import Iterable, Iterator
from typing import Any

from autograder.errors import CourseError

try:
    import dask.config
    import distributed
except ModuleNotFoundError as error:
    raise CourseError(f"grading on a cluster needs {error.name}: pip install 'directrix[cluster]'") from None

PATIENCE = 30.0  # seconds for the scheduler's first answer
ENCRYPTED = ("tls", "gateway", "inproc")  # a gateway's connections are TLS too; inproc leaves no process


def safe(address: str) -> bool:
    """Whether nobody but its two ends can read or join a connection to this address."""
    scheme, _, rest = address.partition("://")
    host = rest.rpartition(":")[0].strip("[]") if ":" in rest else rest
    if scheme != "tcp":
        return scheme in ENCRYPTED
    with contextlib.suppress(ValueError):
        return ipaddress.ip_address(host).is_loopback
    return host == "localhost"


@contextlib.contextmanager
def connected(scheduler: str | distributed.Client) -> Iterator[distributed.Client]:
    """A client of the cluster; one that was given stays open.

    Raises
    ------
    CourseError
        If the address or a worker's could be overheard, certificates are missing, or nobody answers.
    """
    if not isinstance(scheduler, str):
        _refuse_open(scheduler)
        yield scheduler
        return
    if scheduler.partition("://")[0] not in ("tcp", "tls"):
        raise CourseError(f"a scheduler is tls://host:port, or tcp://127.0.0.1:port on this machine; got {scheduler!r}")
    refuse([scheduler])
    try:
        with dask.config.set({"distributed.admin.low-level-log-length": 0}):  # else the last thousand batches stay in memory
            client = distributed.Client(scheduler, security=_security(scheduler), timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise CourseError(f"no Dask scheduler answers at {scheduler}: {type(error).__name__}: {error}") from None
    try:
        _refuse_open(client)
        yield client
    finally:
        with contextlib.suppress(Exception):  # the scheduler may be gone
            client.close(timeout=5)


def _security(scheduler: str) -> distributed.Security:
    if not scheduler.startswith("tls:"):
        return distributed.Security()
    security = distributed.Security(require_encryption=True)
    files = {
        "ca-file": security.tls_ca_file, "client.cert": security.tls_client_cert, "client.key": security.tls_client_key,
    }  # fmt: skip
    missing = [name for name, value in files.items() if not value]
    if missing:
        variables = ", ".join(f"DASK_DISTRIBUTED__COMM__TLS__{n.upper().replace('.', '__').replace('-', '_')}" for n in missing)
        raise CourseError(
            f"a tls:// scheduler asks for a certificate; Dask's configuration does not name distributed.comm.tls."
            f"{' and '.join(missing)} (in the environment: {variables})"
        )
    unread = [f"{name} = {value}" for name, value in files.items() if "\n" not in str(value) and not os.access(value, os.R_OK)]
    if unread:
        raise CourseError(f"a certificate cannot be read: {', '.join(unread)} in distributed.comm.tls of Dask's configuration")
    return security


def refuse(addresses: Iterable[str]) -> None:
    """Raise CourseError for an address that is not safe."""
    exposed = [address for address in addresses if not safe(address)]
    if exposed:
        raise CourseError(
            f"{exposed[0]} is neither TLS nor on this machine alone: anybody on the network could read submissions there, and "
            "run programs as the grader. Start scheduler and workers with tls:// addresses and certificates (docs/cluster.md), "
            "or with --host 127.0.0.1 where all of them are on one machine"
        )


def listening(server: Any) -> list[str]:
    """Where a scheduler or worker can be reached: not only at the address by which it is known.

    Dask's default is every interface of the machine, also of a process that is known by its loopback address.
    """
    return [listener.listen_address for listener in server.listeners]


def _refuse_open(client: distributed.Client) -> None:
    """Workers refuse themselves, now and when they come: see :class:`autograder.fleet.remote.Grading`.

    A scheduler that speaks TLS to us may listen without it too (``--protocol tls,tcp`` where Dask's require-encryption is
    false), so it is always asked.
    """
    refuse([*([client.scheduler.address] if client.scheduler is not None else []), *client.nthreads()])
    # A lambda, since directrix need not be there.
    refuse(client.run_on_scheduler(lambda dask_scheduler: [at.listen_address for at in dask_scheduler.listeners]))
