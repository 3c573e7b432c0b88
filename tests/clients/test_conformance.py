"""The table of answers in docs/src/measured/conformance.md is what the vehicle answers, and every difference from a real PX4 or ArduCopter has its reason."""

import os
import subprocess
import sys

import spandrel


def test_val_the_table_of_answers_is_true():
    """tools/conformance asks anew and compares."""
    environment = {**os.environ, "SPANDREL": spandrel.PROGRAM}
    tool = spandrel.ROOT / "tools" / "conformance"
    done = subprocess.run([sys.executable, str(tool), "--check"], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
