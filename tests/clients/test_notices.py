"""THIRD-PARTY.md and sbom.cdx.json must match Cargo.lock."""

import json
import subprocess

import spandrel


def test_notices_and_sbom_match_the_lock_file():
    done = subprocess.run([str(spandrel.ROOT / "tools" / "notices"), "--check"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_sbom_components_are_unique_and_references_resolve():
    """Checks that references follow CycloneDX's rules and that every component has a license."""
    bom = json.loads((spandrel.ROOT / "sbom.cdx.json").read_text(encoding="utf-8"))
    assert (bom["bomFormat"], bom["specVersion"]) == ("CycloneDX", "1.5")
    refs = [component["bom-ref"] for component in bom["components"]]
    assert len(refs) == len(set(refs)) > 100
    known = {*refs, bom["metadata"]["component"]["bom-ref"]}
    assert all({node["ref"], *node["dependsOn"]} <= known for node in bom["dependencies"])
    # The project's own crates do not come from an archive with a checksum.
    others = [component for component in bom["components"] if not component["name"].startswith("spandrel-")]
    lacking = [component["name"] for component in others if not component["licenses"] or not component["hashes"]]
    assert lacking == []
