"""Flags of renders on many machines.

Annotations must be real objects here (see ``groups.py``), so no ``annotations`` future.
"""

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

from daguerre.rendering.parameters import SAMPLING

from .groups import Text, option


@dataclass(frozen=True)
class ClusterFlags:
    """Cluster that draws the samples."""

    cluster: Annotated[
        Text,
        option(
            "--cluster",
            metavar="ADDRESS",
            help="Draw on a Dask cluster: local, local:N, tcp://HOST:PORT, tls://HOST:PORT or a "
            "FILE.yaml (needs extra `cluster`).",
            panel=SAMPLING,
        ),
    ] = None
    insecure_cluster: Annotated[
        bool,
        option(
            "--insecure-cluster",
            help="Allow a scheduler on another machine without TLS.",
            panel=SAMPLING,
        ),
    ] = False
    mixed_builds: Annotated[
        bool,
        option(
            "--mixed-builds",
            help="Allow workers of another build or processor, whose bits differ.",
            panel=SAMPLING,
        ),
    ] = False

    @contextlib.contextmanager
    def worker_pool(self, tell: Any) -> Iterator[Any]:
        """Opens the cluster of ``--cluster``, with a first worker; None without the flag."""
        if self.cluster is None:
            yield None
            return
        from daguerre.cluster.opened import opened

        how = {"insecure": self.insecure_cluster, "mixed": self.mixed_builds}
        with opened(self.cluster, tell=tell, **how) as pool:
            yield pool
