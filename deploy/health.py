"""Say whether the program of a container answers, at its own address and port.

The command line is that of the
container's first process; its last ``--port`` and ``--host`` count.
"""

import http.client
import sys


def value(words: list[str], flag: str, usual: str) -> str:
    """Return the last value of a flag, after a space or "="."""
    for word, after in reversed([*zip(words, [*words[1:], usual], strict=True)]):
        if word == flag:
            return after
        if word.startswith(f"{flag}="):
            return word.partition("=")[2]
    return usual


def main(command_line: str) -> None:
    """Ask; an exception, and so a status above 0, says that no answer came."""
    with open(command_line, encoding="utf-8") as file:
        words = file.read().split("\0")
    host, port = value(words, "--host", "127.0.0.1"), value(words, "--port", "8080")
    host = "127.0.0.1" if host in ("", "0.0.0.0", "::") else host
    connection = http.client.HTTPConnection(host, int(port), timeout=4)
    connection.request("GET", "/healthz")
    connection.getresponse()


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "/proc/1/cmdline")
