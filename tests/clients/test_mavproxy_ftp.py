"""MAVProxy's unmodified file transfer: download, upload, listing, checksum, and its fast download of all parameters."""

import pytest

import spandrel
from test_mavproxy import Console


@pytest.mark.timeout(600)
def test_wire_mavproxy_transfers_files(launch, tmp_path):
    """`ftp get`, `put`, `list`, `crc`, `rm`, and two downloads at the same time; MAVProxy assigns responses by the
    session ID that it chose."""
    files = tmp_path / "files"
    files.mkdir()
    content = bytes(k * k % 251 for k in range(50_000))
    (files / "survey.bin").write_bytes(content)
    typed = Console(launch("px4", "--files", str(files), speed=1), tmp_path)
    # MAVProxy reports a file as written some time before closing it.
    same = lambda path: spandrel.wait_for(f"{path} on disk", lambda: path.read_bytes() == content, limit_s=60)  # noqa: E731
    try:
        typed.wait("parameters to")
        typed.enter_command("ftp get /survey.bin down.bin", "Wrote 50000 bytes to down.bin")
        same(tmp_path / "down.bin")
        typed.enter_command("ftp get /survey.bin one.bin", None)
        typed.enter_command("ftp get /survey.bin two.bin", "Wrote 50000 bytes")
        typed.wait("Wrote 50000 bytes")
        same(tmp_path / "one.bin")
        same(tmp_path / "two.bin")
        typed.enter_command("ftp put down.bin /up.bin", "Sent file of length 50000")
        same(files / "up.bin")
        typed.enter_command("ftp list /", "up.bin\t50000")
        typed.enter_command("ftp crclocal down.bin", "crclocal: down.bin")
        checksum = next(word for word in typed.heard[-1].split() if word.startswith("0x"))
        typed.enter_command("ftp crc /up.bin", f"crc: /up.bin {checksum}")
        typed.repeat_until("ftp rm /up.bin", "Removing /up.bin")
        spandrel.wait_for("the removal", lambda: not (files / "up.bin").exists(), limit_s=60)
    finally:
        typed.close()


@pytest.mark.timeout(600)
def test_wire_mavproxy_fetches_parameters_by_ftp(launch, tmp_path):
    """As with ArduPilot, `@PARAM/param.pck` contains all values with their defaults in one file."""
    typed = Console(launch("ardupilot", speed=1), tmp_path)
    try:
        line = typed.wait("parameters (ftp)")
        assert int(line.split()[1]) > 50, line
        typed.repeat_until("param show WPNAV_SPEED", "WPNAV_SPEED")
        typed.enter_command("param ftp", "parameters (ftp)")
    finally:
        typed.close()
