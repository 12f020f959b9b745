"""The files for Kubernetes: what can be said of them without a cluster."""

from __future__ import annotations

import importlib
import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, cast

import pytest
import yaml

from sambot_viz.classroom.hub import SCOPES, Hub
from sambot_viz.commands.command_line import parse
from sambot_viz.commands.show import parser
from sambot_viz.server.readiness import ANSWERS, READY

KINDS: dict[str, tuple[type, ...]] = {
    "object": (dict,),
    "array": (list,),
    "string": (str,),
    "boolean": (bool,),
    "integer": (int,),
    "number": (int, float),
}


def faults(value: Any, schema: Any, place: str = "") -> Iterator[str]:
    """Give what of a value its schema does not allow, with its place."""
    if value not in schema.get("enum", [value]):
        yield f"{place}: {value} is none of {schema['enum']}"
    kind = schema.get("type")
    if kind and (
        not isinstance(value, KINDS[kind])
        or (isinstance(value, bool) and kind != "boolean")
    ):
        yield f"{place}: {value!r} is not of type {kind}"
        return
    if kind == "array":
        for number, one in enumerate(cast("list[Any]", value)):
            yield from faults(one, schema["items"], f"{place}/{number}")
    if kind == "object":
        fields = cast("dict[str, Any]", value)
        for name in {*schema.get("required", ())} - {*fields}:
            yield f"{place}/{name} is missing"
        for name, one in fields.items():
            known = schema.get("properties", {}).get(name)
            if known is not None:
                yield from faults(one, known, f"{place}/{name}")
            elif not schema.get("additionalProperties", True):
                yield f"{place}/{name} is not known"


@pytest.fixture
def folder(repository: Path) -> Path:
    return repository / "deploy" / "kubernetes"


def test_the_values_are_what_the_chart_takes(folder: Path) -> None:
    values: Any = yaml.safe_load((folder / "values.yaml").read_text("utf-8"))
    schema = json.loads((folder / "values.schema.json").read_text("utf-8"))
    assert [*faults(values, schema)] == []
    # What is wrong has its place.
    values["cull"]["timout"] = 1
    values["singleuser"]["memory"] = {"limit": 1}
    assert sorted(faults(values, schema)) == [
        "/cull/timout is not known",
        "/singleuser/memory/guarantee is missing",
        "/singleuser/memory/limit: 1 is not of type string",
    ]


def megabytes(text: str) -> float:
    """Return an amount of memory [MB]."""
    number, unit = re.fullmatch(r"(\d+)([MG])", text).groups()  # pyright: ignore[reportOptionalMemberAccess]
    return float(number) * {"M": 1, "G": 1000}[unit]


def test_the_values_fit_what_was_measured(folder: Path) -> None:
    text = (folder / "values.yaml").read_text("utf-8")
    student = yaml.safe_load(text)["singleuser"]
    measured = [float(found) for found in re.findall(r"(\d+) MB(?: with|,)", text)]
    assert len(measured) == 2
    least, most = map(megabytes, (student["memory"][k] for k in ("guarantee", "limit")))
    # Beside JupyterLab; three times the files of the meshes that the profile names.
    assert 2 * max(measured) < least < most and max(measured) + 3 * 50 < most
    (large,) = [p["kubespawner_override"] for p in student["profileList"][1:]]
    assert megabytes(large["mem_limit"]) > max(measured) + 3 * 500
    mounted = {one["name"] for one in student["storage"]["extraVolumeMounts"]}
    assert mounted == {one["name"] for one in student["storage"]["extraVolumes"]}


def test_the_board_is_the_service_that_the_hub_shows(
    repository: Path, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    values: Any = yaml.safe_load((folder / "values.yaml").read_text("utf-8"))
    text = (folder / "board.yaml").read_text("utf-8")
    claim, service, pods, policy = yaml.safe_load_all(text)
    pod = pods["spec"]["template"]
    (container,) = pod["spec"]["containers"]
    # The hub sends requests to the service, which sends them to the pod.
    ((name, shown),) = values["hub"]["services"].items()
    (port,) = service["spec"]["ports"]
    assert shown["url"] == f"http://{service['metadata']['name']}:{port['port']}"
    labels = pod["metadata"]["labels"]
    for selector in (
        service["spec"]["selector"],
        pods["spec"]["selector"]["matchLabels"],
        policy["spec"]["podSelector"]["matchLabels"],
    ):
        assert selector.items() <= labels.items()
    # The program understands its words and its variables.
    for row in container["env"]:
        monkeypatch.setenv(row["name"], row.get("value", "a-secret-of-the-cluster"))
    first, *words = container["args"]
    command = importlib.import_module(f"sambot_viz.commands.{first}")
    given, options = parse(command.parser(), words)
    assert given.hub and (options.host, options.port) == ("0.0.0.0", port["port"])
    hub = Hub.of_environment()
    assert (hub.prefix, hub.client) == (f"/services/{name}", f"service-{name}")
    keys = [
        row["valueFrom"]["secretKeyRef"]["key"]
        for row in container["env"]
        if "valueFrom" in row
    ]
    assert keys == [f"hub.services.{name}.apiToken", "secret"]
    # It may do what it asks for, and no more.
    role = values["hub"]["loadRoles"][name]
    assert role == {"services": [name], "scopes": SCOPES.split(", ")}
    teachers = values["hub"]["loadRoles"]["teachers"]
    assert teachers["scopes"] == [f"access:services!service={name}"]
    # Students and the board have one volume, and one lesson.
    student = values["singleuser"]
    (mount,) = [
        one
        for one in student["storage"]["extraVolumeMounts"]
        if one["mountPath"].endswith("lesson")
    ]
    assert mount["subPath"] == "{username}"
    volumes = student["storage"]["extraVolumes"] + pod["spec"]["volumes"]
    claims = [v["persistentVolumeClaim"] for v in volumes if v["name"] == "class"]
    assert {one["claimName"] for one in claims} == {claim["metadata"]["name"]}
    assert student["extraEnv"]["SAMBOT_VIZ_LESSON"] == given.lesson
    home = student["extraEnv"]["SAMBOT_VIZ_MODEL"].replace("~", "/home/jovyan")
    assert mount["mountPath"] == home
    mounts = {one["mountPath"]: one for one in container["volumeMounts"]}
    assert given.dir in mounts and mounts[given.dir]["readOnly"]
    asked = [container[f"{of}Probe"]["httpGet"] for of in ("liveness", "readiness")]
    assert [one["path"] for one in asked] == [ANSWERS, READY]


def test_pods_are_asked_where_the_program_answers(
    repository: Path, folder: Path
) -> None:
    text = (folder / "robots.yaml").read_text("utf-8")
    service, pods = yaml.safe_load_all(text)
    (container,) = pods["spec"]["template"]["spec"]["containers"]
    words = [word.replace("$(POD_NAME)", "robots-0") for word in container["args"]]
    options = parse(parser(), words)[1]
    entry = (repository / "deploy" / "Dockerfile").read_text("utf-8")
    (port,) = container["ports"]
    assert f'"--port", "{port["containerPort"]}"' in entry
    assert (options.host, service["spec"]["ports"][0]["port"]) == ("0.0.0.0", 8080)
    asked = [container[f"{of}Probe"]["httpGet"] for of in ("liveness", "readiness")]
    assert [one["path"] for one in asked] == [ANSWERS, READY]
    assert {one["port"] for one in asked} == {port["name"]}
    labels = pods["spec"]["template"]["metadata"]["labels"]
    assert service["spec"]["selector"] == pods["spec"]["selector"]["matchLabels"]
    assert labels == service["spec"]["selector"]
    assert service["metadata"]["name"] == pods["spec"]["serviceName"]
    volumes = {one["name"] for one in pods["spec"]["template"]["spec"]["volumes"]}
    assert {one["name"] for one in container["volumeMounts"]} == volumes
