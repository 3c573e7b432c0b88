"""pymavlink's module for a dialect, generated with its own mavgen from the official XML in the `mavlink` crate."""

import importlib
import json
import pathlib
import subprocess

import pymavlink.dialects.v20
from pymavlink.generator import mavgen, mavparse

import spandrel


def definitions():
    """Returns the folder of the official message definitions in the dependency's source, found through cargo."""
    asked = ["cargo", "metadata", "--format-version", "1", "--locked"]
    told = subprocess.run(asked, cwd=spandrel.ROOT, capture_output=True, text=True, check=True).stdout
    crate = next(p for p in json.loads(told)["packages"] if p["name"] == "mavlink")
    return next(pathlib.Path(crate["manifest_path"]).parent.rglob("message_definitions/v1.0"))


def generate(folder, name="common"):
    """Generates the module in a folder, makes pymavlink use it, and returns its name."""
    module = f"official_{name}"
    options = mavgen.Opts(str(pathlib.Path(folder) / module), wire_protocol=mavparse.PROTOCOL_2_0, language="Python3", validate=False)
    assert mavgen.mavgen(options, [str(definitions() / f"{name}.xml")])
    pymavlink.dialects.v20.__path__.append(str(folder))
    importlib.invalidate_caches()
    return module
