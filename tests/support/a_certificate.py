"""A key and a certificate for 127.0.0.1 that has signed itself."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest


def self_signed(folder: Path) -> tuple[Path, Path]:
    """Write both into a folder; without openssl the test is skipped.

    Returns:
        The key and the certificate.
    """
    openssl = shutil.which("openssl")
    if openssl is None:
        pytest.skip("needs openssl, which is not installed")
    words = "req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=robot -keyout key.pem"
    more = "-addext subjectAltName=IP:127.0.0.1 -out cert.pem"
    # zenoh takes no certificate of a router that may sign others.
    more += " -addext basicConstraints=critical,CA:FALSE"
    subprocess.run(
        [openssl, *words.split(), *more.split()],
        cwd=folder,
        check=True,
        capture_output=True,
    )
    return folder / "key.pem", folder / "cert.pem"


def tls_settings(key: Path, certificate: Path) -> dict[str, str]:
    """Settings of a router of zenoh that speaks TLS."""
    return {
        "transport/link/tls/listen_private_key": str(key),
        "transport/link/tls/listen_certificate": str(certificate),
    }
