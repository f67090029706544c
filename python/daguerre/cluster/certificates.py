"""Certificates with which the machines of a cluster know each other."""

from __future__ import annotations

import ssl
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daguerre.errors import InputError, UsageError
from daguerre.files.reading import read_bytes


@dataclass(frozen=True)
class Certificates:
    """Files of certificates, .pem.

    Attributes:
        ca: Certificate of the authority that all trust.
        cert: Certificate of this machine.
        key: Its key.
    """

    ca: Path
    cert: Path
    key: Path

    @classmethod
    def of(cls, given: Mapping[str, Path | None], names: str) -> Certificates | None:
        """Certificates of files that a user names; None: no file is given.

        Args:
            given: Files by ``ca``, ``cert`` and ``key``.
            names: How the user writes these three.

        Raises:
            UsageError: Only some of the files are given.
            InputError: One of them cannot be used.
        """
        files = {name: file for name, file in given.items() if file is not None}
        if not files:
            return None
        if len(files) < 3:
            raise UsageError(f"{names}: wanted all three, got only {', '.join(files)}")
        found = cls(**files)
        found._check()
        return found

    def security(self) -> Any:
        """``distributed.Security`` of a client, a worker or a scheduler."""
        from distributed import Security

        roles = ("client", "worker", "scheduler")
        files = {f"tls_{role}_cert": str(self.cert) for role in roles}
        files |= {f"tls_{role}_key": str(self.key) for role in roles}
        return Security(tls_ca_file=str(self.ca), require_encryption=True, **files)

    def _check(self) -> None:
        for file in (self.ca, self.cert, self.key):
            read_bytes(file, 1 << 20)
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        try:
            context.load_verify_locations(self.ca)
        except ssl.SSLError as error:
            raise InputError(f"{self.ca}: wanted a certificate, .pem ({_reason(error)})") from None
        try:
            context.load_cert_chain(self.cert, self.key, password="")
        except (ssl.SSLError, ValueError) as error:
            raise InputError(
                f"{self.cert}, {self.key}: wanted a certificate and its key, .pem, without a "
                f"password ({_reason(error)})"
            ) from None


def _reason(error: Exception) -> str:
    """Name that OpenSSL gives to an error."""
    return str(getattr(error, "reason", None) or error).replace("_", " ").lower()
