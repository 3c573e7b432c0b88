"""Starts a real PX4 with its own simulator (SIH) for comparisons. The SPANDREL_PX4 environment variable contains its
source or build folder. No test requires PX4."""

import os
import pathlib
import re
import subprocess

BUILD = os.environ.get("SPANDREL_PX4")
if BUILD and (pathlib.Path(BUILD) / "build/px4_sitl_default/bin/px4").exists():
    BUILD = str(pathlib.Path(BUILD) / "build/px4_sitl_default")
# First instance number used here. Other PX4 instances on the same machine start at 0. Instance N has system ID N + 1
# and listens on UDP 18570 + N.
FIRST_INSTANCE = 60
GCS_PORT = 18570
# The ground station link from PX4's own start script (normal mode, 4 MB/s, forwarding), directed to the given port; the
# other links would use fixed ports.
LINKS = "mavlink start -x -u {local} -r 4000000 -f -o {remote} -t 127.0.0.1\n"
AIRFRAME = {"PX4_SYS_AUTOSTART": "10040", "PX4_SIM_MODEL": "sihsim_quadx"}


def version():
    """Returns the version of PX4, such as `v1.17.0 (0123456789)`."""
    header = (pathlib.Path(BUILD) / "src/lib/version/build_git_version.h").read_text(encoding="utf-8")
    tag, commit = (re.search(rf'#define {name}\s+"([^"]+)"', header).group(1) for name in ("PX4_GIT_TAG_STR", "PX4_GIT_VERSION_STR"))
    return f"{tag} ({commit[:10]})"


def start(folder, files, client_port, slot=0, speed=1):
    """Starts a new PX4 that serves `files` over FTP and has a single link, which connects to `client_port`. Vehicles
    that run at the same time have different slots."""
    build, instance, scripts = pathlib.Path(BUILD).resolve(), FIRST_INSTANCE + slot, pathlib.Path(folder) / "scripts"
    scripts.mkdir()
    (scripts / "px4-rc.mavlink").write_text(LINKS.format(local=GCS_PORT + instance, remote=client_port), encoding="utf-8")
    # PX4's start script finds its parts through PATH, so this link replaces PX4's own.
    environment = {**os.environ, **AIRFRAME, "PX4_SIM_SPEED_FACTOR": str(speed), "PATH": f"{scripts}:{build / 'bin'}:{os.environ['PATH']}"}
    with open(pathlib.Path(folder) / "px4.txt", "w", encoding="utf-8") as log:
        return subprocess.Popen(
            [build / "bin/px4", "-i", str(instance), "-d", "-w", str(files), str(build / "etc")],
            stdout=log, stderr=log, stdin=subprocess.DEVNULL, env=environment,
        )
