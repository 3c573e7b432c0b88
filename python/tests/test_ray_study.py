"""A study on a Ray cluster of two nodes, one of which is killed in the middle."""

import json
import os
import pathlib
import subprocess
import threading

import pytest

ray = pytest.importorskip("ray", reason="Ray is not installed")
from ray.cluster_utils import Cluster  # noqa: E402

from spandrel import ray_study  # noqa: E402

PROGRAM = os.environ.get("SPANDREL")
pytestmark = pytest.mark.skipif(not PROGRAM, reason="SPANDREL is not set to the path of the program")
STUDY = ["--scenario", "drill-hover", "--skill", "novice,expert", "--seeds", "3"]
FLIGHTS = 6
# The head must notice the loss of a node quickly, ms. Ray's own values, made for networks, take half a minute.
QUICK_CHECKS = {"health_check_initial_delay_ms": 1000, "health_check_period_ms": 1000, "health_check_failure_threshold": 3}
# On the second node, a flight reports its start and then never ends, so the node always dies during a flight.
STUCK_ON_SECOND = """#!/bin/sh
if [ "$SPANDREL_TEST_NODE" = second ]; then
    echo "$*" >{started}
    read -r _ <{hold}
fi
exec {program} "$@"
"""


@pytest.fixture
def cluster():
    one = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "_system_config": QUICK_CHECKS})
    yield one
    ray.shutdown()
    one.shutdown()


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.name != "flights.jsonl"}


def rows(folder):
    """Returns the journal's rows in a fixed order: the order in the file is that in which the flights ended."""
    return sorted((folder / "flights.jsonl").read_text(encoding="utf-8").splitlines())


def test_flight_lost_node_is_replaced_and_bits_are_the_same(tmp_path, cluster):
    started, hold = tmp_path / "started", tmp_path / "hold"
    os.mkfifo(started)
    os.mkfifo(hold)
    wrapper = tmp_path / "spandrel"
    wrapper.write_text(STUCK_ON_SECOND.format(started=started, hold=hold, program=PROGRAM), encoding="utf-8")
    wrapper.chmod(0o755)
    second = cluster.add_node(num_cpus=1, env_vars={"SPANDREL_TEST_NODE": "second"})
    cluster.wait_for_nodes()
    ray.init(address=cluster.address, log_to_driver=False)
    lost = []

    def kill_second_during_its_flight():
        lost.append(pathlib.Path(started).read_text(encoding="utf-8"))
        cluster.remove_node(second, allow_graceful=False)

    killer = threading.Thread(target=kill_second_during_its_flight, daemon=True)
    killer.start()
    on_ray, local = tmp_path / "ray", tmp_path / "local"
    assert ray_study.fly_missing(STUDY, on_ray, str(wrapper)) == FLIGHTS
    killer.join()
    assert "--flight" in lost[0], lost
    # The orphaned process of the lost flight ends.
    os.close(os.open(hold, os.O_RDWR | os.O_NONBLOCK))
    assert ray_study.fly_missing(STUDY, on_ray, PROGRAM) == 0, "a flight is missing"
    for folder in (on_ray, local):
        subprocess.run([PROGRAM, "study", *STUDY, "--out", str(folder)], check=True, capture_output=True)
    assert rows(on_ray) == rows(local) and len(rows(local)) == FLIGHTS
    assert files(on_ray) == files(local) and {"flights.parquet", "summary.md"} <= files(local).keys()


def test_wire_other_program_on_a_worker_is_an_error(tmp_path):
    row = json.dumps({"fingerprint": "theirs"})
    with pytest.raises(ray_study.StudyError, match="flight 3 on node-b: this machine has another version"):
        ray_study._checked_row(("node-b", 0, row, ""), 3, "ours")
    with pytest.raises(ray_study.StudyError, match="flight 3 on node-b: exit 2\nno such file"):
        ray_study._checked_row(("node-b", 2, "", "no such file\n"), 3, "ours")
    with pytest.raises(ray_study.StudyError, match="--seeds"):
        ray_study.fly_missing(["--seeds", "0"], tmp_path, PROGRAM)
