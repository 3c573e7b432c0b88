"""The table of responses in docs/src/measured/conformance.md must match the vehicle's responses, and every difference
from a real PX4 or ArduCopter must have a reason."""

import os
import subprocess
import sys

import spandrel


def test_val_conformance_table_matches_the_vehicle():
    """tools/conformance sends all requests again and compares the responses."""
    environment = {**os.environ, "SPANDREL": spandrel.PROGRAM}
    tool = spandrel.ROOT / "tools" / "conformance"
    done = subprocess.run([sys.executable, str(tool), "--check"], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
