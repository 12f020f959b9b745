"""Short questions to other servers of this network, by HTTP."""

from __future__ import annotations

import http.client
import urllib.error
import urllib.request
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any


class _NoRedirects(urllib.request.HTTPRedirectHandler):
    """Do not follow redirects: they lead to a login."""

    def redirect_request(
        self, req: Any, fp: Any, code: Any, msg: Any, headers: Any, newurl: Any
    ) -> None:
        return None


_OPENER = urllib.request.build_opener(urllib.request.ProxyHandler({}), _NoRedirects())
"""Asks a server directly: it is in this network, not beyond a proxy."""


def ask(
    address: str,
    patience: float,
    largest: int,
    headers: Mapping[str, str] = MappingProxyType({}),
    data: bytes | None = None,
) -> tuple[int, bytes]:
    """Return the status and the content of an answer, whatever its status.

    Args:
        address: address of the question.
        patience: longest time that the server may be silent [s].
        largest: the content ends after one byte more than this [bytes].
        headers: headers of the question.
        data: content of a POST request; None for GET.

    Raises:
        OSError: the server does not answer.
        ValueError: it is not an address, or the answer is not HTTP.
    """
    request = urllib.request.Request(address, data, dict(headers))
    try:
        with _OPENER.open(request, timeout=patience) as answer:
            return answer.status, answer.read(largest + 1)
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.read(largest + 1)
    except http.client.HTTPException as error:
        raise ValueError(str(error)) from error
