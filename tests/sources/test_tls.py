"""A robot behind TLS: trusted, not trusted, and where there is none."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from live_peers import WAIT, FoxglovePeer
from patience import until

from sambot_viz.sources.source import Source

Open = Callable[[str], Source]


@pytest.fixture(scope="module")
def certificate(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A key and a certificate for 127.0.0.1 that has signed itself."""
    openssl = shutil.which("openssl")
    if openssl is None:
        pytest.skip("needs openssl, which is not installed")
    folder = tmp_path_factory.mktemp("tls")
    words = "req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=robot -keyout key.pem"
    name = "-addext subjectAltName=IP:127.0.0.1 -out cert.pem"
    subprocess.run(
        [openssl, *words.split(), *name.split()],
        cwd=folder,
        check=True,
        capture_output=True,
    )
    return folder


@pytest.fixture
def robot(certificate: Path) -> Iterator[FoxglovePeer]:
    peer = FoxglovePeer(
        tls_cert=(certificate / "cert.pem").read_bytes(),
        tls_key=(certificate / "key.pem").read_bytes(),
    )
    yield peer
    peer.stop()


def test_a_certificate_that_is_trusted_needs_nothing(
    robot: FoxglovePeer,
    certificate: Path,
    opened: Open,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("SSL_CERT_FILE", str(certificate / "cert.pem"))
    robot.advertise("/a")
    source = opened(robot.uri.replace("foxglove:", "foxglove+wss:"))
    until(lambda: "/a" in source.topics(), WAIT)


def test_a_certificate_that_is_not_trusted_says_how_to_trust_it(
    robot: FoxglovePeer, opened: Open
) -> None:
    source = opened(robot.uri.replace("foxglove:", "foxglove+wss:"))
    until(lambda: source.status.retry_s is not None, WAIT)
    assert "is not trusted (self-signed certificate)" in source.status.sentence
    assert "SSL_CERT_FILE=FILE" in source.status.sentence


def test_a_server_with_tls_does_not_answer_without(
    robot: FoxglovePeer, opened: Open
) -> None:
    source = opened(robot.uri)
    until(lambda: source.status.retry_s is not None, WAIT)
    assert "--source foxglove+wss://127.0.0.1:" in source.status.sentence
