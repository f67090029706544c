"""A cluster of real processes, each perhaps on a network of its own, with certificates."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

PYTHON = [sys.executable, "-m", "daguerre"]


def has_namespaces() -> bool:
    """Whether this process may make network namespaces."""
    if os.getuid() != 0 or shutil.which("ip") is None:
        return False
    name = f"dg-try-{os.getpid()}"
    made = subprocess.run(["ip", "netns", "add", name], capture_output=True, check=False)
    subprocess.run(["ip", "netns", "del", name], capture_output=True, check=False)
    return made.returncode == 0


def certificates(folder: Path, name: str = "ca") -> tuple[Path, Path, Path]:
    """An authority, and a certificate by it with its key."""
    folder.mkdir(exist_ok=True)
    ca, ca_key = folder / f"{name}.pem", folder / f"{name}.key"
    cert, key, asked = folder / f"{name}-me.pem", folder / f"{name}-me.key", folder / "asked.csr"
    new = ["-newkey", "rsa:2048", "-nodes"]
    day = ["-days", "2"]
    for words in (
        ["req", "-x509", *new, *day, "-subj", f"/CN={name}", "-keyout", ca_key, "-out", ca],
        ["req", *new, "-subj", "/CN=daguerre", "-keyout", key, "-out", asked],
        ["x509", "-req", *day, "-in", asked, "-CA", ca, "-CAkey", ca_key, "-CAcreateserial",
         "-out", cert],
    ):  # fmt: skip
        subprocess.run(["openssl", *map(str, words)], check=True, capture_output=True)
    return ca, cert, key


def listening(pid: int) -> set[str]:
    """Addresses on which a process and those that it started listen."""
    import psutil  # Dask needs it, too

    top = psutil.Process(pid)
    return {
        one.laddr.ip
        for each in (top, *top.children(recursive=True))
        for one in each.net_connections("inet")
        if one.status == psutil.CONN_LISTEN
    }


@dataclass
class Farm:
    """Processes of a cluster.

    Attributes:
        folder: Folder of logs and of the workers' values.
        prefix: Begin of the names of network namespaces; empty: all is on this machine.
        tls: Flags of the certificates.
    """

    folder: Path
    prefix: str = ""
    tls: Sequence[str] = ()
    port: int = 0
    running: dict[str, subprocess.Popen[bytes]] = field(default_factory=dict)

    @property
    def address(self) -> str:
        host = "10.77.0.1" if self.prefix else "127.0.0.1"
        return f"{'tls' if self.tls else 'tcp'}://{host}:{self.port}"

    def command(self, where: str, words: Sequence[object]) -> list[str]:
        """Command of Daguerre in a namespace."""
        inside = ["ip", "netns", "exec", self.prefix + where] if self.prefix else []
        return [*inside, *PYTHON, *map(str, words)]

    def start(self, where: str, words: Sequence[object]) -> subprocess.Popen[bytes]:
        """Starts a process; its group can be killed as one."""
        environment = os.environ | {
            "DAGUERRE_CLUSTER_CACHE": str(self.folder / f"{where}-values"),
            "COLUMNS": "100",
        }
        with (self.folder / f"{where}.log").open("ab") as log:
            made = subprocess.Popen(
                self.command(where, words), stdout=log, stderr=log, env=environment,
                start_new_session=True,
            )  # fmt: skip
        self.running[where] = made
        return made

    def scheduler(self) -> None:
        """Starts the scheduler, on the same port again if there was one."""
        if not self.port:
            with socket.create_server(("127.0.0.1", 0)) as free:
                self.port = free.getsockname()[1]
        host = ["--host", "10.77.0.1"] if self.prefix else []
        self.start("hub", ["scheduler", "--port", self.port, *host, *self.tls])

    def worker(self, name: str, *more: object) -> None:
        """Starts a worker."""
        words = ["worker", self.address, "--threads", 1, "--memory", "4GB", *self.tls, *more]
        self.start(name, words)

    def kill(self, name: str, how: int = signal.SIGKILL) -> None:
        """Kills a process and all that it started."""
        process = self.running.pop(name)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, how)
        process.wait()

    def cut(self, name: str, seconds: float) -> None:
        """Takes a machine off the network for a while."""
        link = ["ip", "-n", self.prefix + name, "link", "set", "eth0"]
        subprocess.run([*link, "down"], check=True)
        time.sleep(seconds)
        subprocess.run([*link, "up"], check=True)

    def slow(self, name: str, until: threading.Event, share: float = 0.1) -> None:
        """Lets a process have a share of the time."""
        group = self.running[name].pid
        while not until.is_set():
            for how, seconds in (
                (signal.SIGSTOP, 0.2 * (1 - share)),
                (signal.SIGCONT, 0.2 * share),
            ):
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(group, how)
                time.sleep(seconds)

    def log(self, name: str) -> str:
        """Output of a process."""
        return (self.folder / f"{name}.log").read_text(errors="replace")

    def close(self) -> None:
        """Kills all."""
        for name in list(self.running):
            self.kill(name)


@contextlib.contextmanager
def on_networks(farm: Farm, names: Sequence[str]) -> Iterator[None]:
    """Makes a namespace for each machine, joined by a switch in that of the hub."""

    def ip(*words: str) -> None:
        subprocess.run(["ip", *words], check=True, capture_output=True)

    hub, made = farm.prefix + "hub", []
    try:
        for name in ["hub", *names]:
            ip("netns", "add", farm.prefix + name)
            made.append(farm.prefix + name)
            ip("-n", farm.prefix + name, "link", "set", "lo", "up")
        ip("-n", hub, "link", "add", "switch", "type", "bridge")
        ip("-n", hub, "addr", "add", "10.77.0.1/24", "dev", "switch")
        ip("-n", hub, "link", "set", "switch", "up")
        for k, name in enumerate(names):
            there = farm.prefix + name
            ip("-n", hub, "link", "add", f"to-{name}", "type", "veth", "peer", "name", "eth0",
               "netns", there)  # fmt: skip
            ip("-n", hub, "link", "set", f"to-{name}", "master", "switch")
            ip("-n", hub, "link", "set", f"to-{name}", "up")
            ip("-n", there, "addr", "add", f"10.77.0.{k + 2}/24", "dev", "eth0")
            ip("-n", there, "link", "set", "eth0", "up")
        yield
    finally:
        for name in made:
            ip("netns", "del", name)
