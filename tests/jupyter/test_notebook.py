"""A Visualizer in a cell of a real notebook."""

from __future__ import annotations

import json
import re
import socket
import subprocess
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing

import pytest
from a_jupyter import PYTHON, Lab, a_lab, a_place, ask, wait_until
from recorded_page import RecordedPage

# The same of our own code, without a notebook: test_frame.py.
pytestmark = pytest.mark.slow

CELLS = (
    "from sambot_viz import Visualizer\nviz = Visualizer('arm.urdf')\nviz",
    "viz.set_joint_positions({'swing': 1.0})",
    "viz.show(height=300, panels=False)",
)
ARM = """<robot name="arm">
<link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
<link name="tool"><visual><geometry><sphere radius="1"/></geometry></visual></link>
<joint name="swing" type="continuous">
  <parent link="base"/><child link="tool"/><axis xyz="0 0 1"/>
</joint>
</robot>
"""
FRAME = "document.querySelector('.jp-OutputArea iframe').contentDocument"
VIEWER = f"{FRAME}.querySelector('iframe').contentWindow"


OF_THE_LAST = FRAME.replace("querySelector(", "querySelectorAll(").replace(
    ".contentDocument", "[1].contentDocument"
)
ENDED = "querySelector('p')?.checkVisibility()"
"""Of the document in a cell: whether it says that the program has ended."""


def notebook(cells: Sequence[str]) -> str:
    made = [
        {
            "cell_type": "code",
            "id": f"cell{number}",
            "metadata": {},
            "outputs": [],
            "execution_count": None,
            "source": text,
        }
        for number, text in enumerate(cells)
    ]
    kernel = {"kernelspec": {"name": "python3", "display_name": "Python 3"}}
    return json.dumps(
        {"cells": made, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}
    )


@pytest.fixture(scope="module")
def lab() -> Iterator[Lab]:
    with a_place() as place:
        (place.work / "arm.urdf").write_text(ARM)
        (place.work / "class.ipynb").write_text(notebook(CELLS))
        with a_lab(place) as running:
            yield running


def run_cell(page: RecordedPage, number: int) -> None:
    """Click into a cell and run it."""
    cell = f"document.querySelectorAll('.jp-CodeCell .cm-content')[{number}]"
    page.wait_for(f"{cell}?.checkVisibility()", 30.0)
    page.wait_for("document.body.innerText.includes('| Idle')", 30.0)
    page.evaluate(f"{cell}.scrollIntoView({{block: 'center'}})")
    x, y = page.evaluate(
        f"(({{x, y}}) => [x + 5, y + 5])({cell}.getBoundingClientRect())"
    )
    page.mouse.click(x, y)
    page.keyboard.press("Enter", "Shift")


def port_in_cell(page: RecordedPage) -> int:
    """The port of the viewer that the cell shows, as soon as it is drawn."""
    page.wait_for(f"{VIEWER}.__viserMutable?.scene", 60.0)
    page.wait_for(f"{VIEWER}.document.body.innerText.includes('swing')", 30.0)
    path = page.evaluate(f"{VIEWER}.location.pathname")
    match = re.fullmatch(r"/proxy/(\d+)/", path)
    assert match, path
    return int(match[1])


def listens(port: int) -> bool:
    with closing(socket.socket()) as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def test_a_cell_shows_the_page_until_the_kernel_ends(
    lab: Lab, open_in_browser: Callable[[str], RecordedPage]
) -> None:
    page = open_in_browser(f"{lab.url}lab/tree/class.ipynb?token={lab.token}")
    run_cell(page, 0)
    port = port_in_cell(page)
    # Others on this machine do not see it.
    assert ask(f"http://127.0.0.1:{port}/")[0] == 401
    assert "token" not in page.evaluate(f"{VIEWER}.location.href")

    # The cell does not block: another one moves the robot in the page.
    run_cell(page, 1)
    turned = f"{VIEWER}.__viserMutable.nodePoseData['/0/1'].wxyz[3]"
    page.wait_for(f"Math.abs({turned} - Math.sin(0.5)) < 1e-3", 30.0)

    # When the cell runs again, its former viewer ends.
    run_cell(page, 0)
    page.wait_for(f"!{VIEWER}.location.pathname.includes('/{port}/')", 30.0)
    second = port_in_cell(page)
    wait_until(lambda: not listens(port))

    # And when the kernel starts again, or ends, nothing is left of it.
    (kernel,) = json.loads(lab.ask("api/kernels")[1])
    before = set(lab.place.processes())
    assert lab.ask(f"api/kernels/{kernel['id']}/restart", "POST", {})[0] == 200
    wait_until(lambda: not listens(second))
    assert lab.ask(f"api/kernels/{kernel['id']}", "DELETE")[0] == 204
    wait_until(lambda: set(lab.place.processes()) == {lab.process.pid}, 10.0)
    assert len(before) > 1


def test_a_cell_whose_kernel_is_gone_keeps_a_picture_and_asks_no_more(
    lab: Lab, open_in_browser: Callable[[str], RecordedPage]
) -> None:
    page = open_in_browser(f"{lab.url}lab/tree/class.ipynb?token={lab.token}&reset")
    run_cell(page, 0)
    port = port_in_cell(page)
    # The same viewer once more, and without its panels.
    run_cell(page, 2)
    view = f"{OF_THE_LAST}.querySelector('iframe')"
    page.wait_for(f"{view}?.className === 'here'", 60.0)
    page.wait_for(f"{view}.contentWindow.__viserMutable?.scene", 60.0)
    assert page.evaluate(f"{view}.contentDocument.querySelector('#sambot')") is None
    assert page.evaluate(f"{view}.clientHeight") == 300

    (kernel,) = json.loads(lab.ask("api/kernels")[1])
    assert lab.ask(f"api/kernels/{kernel['id']}/restart", "POST", {})[0] == 200
    for frame in (FRAME, OF_THE_LAST):
        page.wait_for(f"{frame}.{ENDED}", 60.0)
        assert page.evaluate(f"{frame}.querySelector('iframe')") is None
    picture = "document.querySelector('.jp-OutputArea img')"
    assert page.evaluate(f"{picture}.naturalWidth") == 800

    # What is saved shows the picture wherever it is opened, and no token.
    page.keyboard.press("s", "Control")
    saved = lab.place.work / "class.ipynb"
    wait_until(lambda: "image/png" in saved.read_text("utf-8"))
    text = saved.read_text("utf-8")
    assert "token=" not in text and len(text) < 200_000
    outputs = [o for cell in json.loads(text)["cells"] for o in cell["outputs"]]
    assert [o["output_type"] for o in outputs] == ["execute_result"] * 2
    # Every question to a program that has ended is a traceback in the log.
    question = f"Uncaught exception GET /proxy/{port}/"
    before = lab.place.log.count(question)
    again = open_in_browser(f"{lab.url}lab/tree/class.ipynb?token={lab.token}&reset")
    again.wait_for(f"{picture}?.naturalWidth === 800", 60.0)
    again.wait_for(f"{FRAME}?.{ENDED}", 60.0)
    again.wait_for(f"{OF_THE_LAST}.{ENDED}", 60.0)
    assert lab.place.log.count(question) - before <= 4
    words = ("-m", "nbconvert", "--to", "html", "--stdout", str(saved))
    html = subprocess.run(
        [PYTHON, *words], check=True, capture_output=True, text=True
    ).stdout
    assert 'src="data:image/png;base64,' in html and "token=" not in html
