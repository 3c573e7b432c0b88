"""Kills an erasure at each of its system calls that write. Afterwards, either nothing is erased or the next start
completes the erasure."""

import json
import shutil
import subprocess

import spandrel
import webserver

# System calls that change files or folders.
WRITES = "pwrite64,write,fsync,fdatasync,ftruncate,rename,renameat,renameat2,unlink,unlinkat,rmdir"
# A marker that only Anna's session contains.
SECRET = "only-anna-wrote-this"


def file_contents(folder):
    """Returns the contents of all files in a folder, and all names."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    return b"".join(path.read_bytes() for path in files), [str(path.relative_to(folder)) for path in folder.rglob("*")]


def kill_at(calls, k, *command):
    """Runs the program and kills it when it enters the k-th of these calls. Returns whether it was killed."""
    inject = f"inject={calls}:signal=KILL:when={k}"
    done = subprocess.run(["strace", "-f", "-qq", "-o", "/dev/null", "-e", f"trace={calls}", "-e", inject, spandrel.PROGRAM, *command],
                          capture_output=True, text=True, timeout=webserver.PATIENCE_S, check=False)
    assert done.returncode in (0, -9, 137), (k, done.returncode, done.stderr)
    return done.returncode != 0


def test_erasure_killed_at_any_write_completes_later(tmp_path):
    original = tmp_path / "original"
    flown = webserver.flown(original, "anna", "ben")
    for folder in flown:
        if "-anna-" in folder.name:
            (folder / "answers.json").write_text(json.dumps({"note": SECRET}), encoding="utf-8")
            (folder / "snapshots").mkdir(exist_ok=True)
            (folder / "snapshots" / "1.jpg").write_text(SECRET, encoding="utf-8")
        else:
            (folder / "answers.json").unlink(missing_ok=True)
    # Imported without the questionnaire answers, which are not real.
    for folder in flown:
        kept = (folder / "answers.json").read_bytes() if (folder / "answers.json").exists() else None
        (folder / "answers.json").unlink(missing_ok=True)
        spandrel.run("records", "import", str(folder), "--sessions", str(original))
        if kept is not None:
            (folder / "answers.json").write_bytes(kept)
    erased_whole, untouched = 0, 0
    for k in range(1, 1000):
        place = tmp_path / "place"
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(original, place)
        killed = kill_at(WRITES, k, "records", "erase", "--trainee", "anna", "--yes", "--sessions", str(place))
        listed = json.loads(spandrel.run("records", "list", "--json", "--sessions", str(place)))
        data, names = file_contents(place)
        kept = {record["trainee"] for record in listed}
        if "anna" in kept:
            assert SECRET.encode() in data and any("-anna-" in name for name in names), f"call {k}: half erased"
            assert "erased 'anna': 1 sessions" in spandrel.run("records", "erase", "--trainee", "anna", "--yes", "--sessions", str(place))
            data, names = file_contents(place)
            untouched += 1
        else:
            erased_whole += 1
        assert SECRET.encode() not in data and not any("anna" in name for name in names), (k, names)
        assert kept - {"anna"} == {"ben"} and any("-ben-" in name for name in names), f"call {k}: Ben's session is missing"
        if not killed:
            break
    print(f"{k} calls: {untouched} times untouched, {erased_whole} times erased")
    assert not killed and untouched > 1 and erased_whole > 5, (k, untouched, erased_whole)
