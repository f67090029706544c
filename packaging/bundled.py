"""Names what a wheel brings along: licences, and a list for scanners (SBOM, CycloneDX 1.6).

Usage: bundled.py TREE, where TREE is an unpacked wheel that auditwheel has repaired. Debian's
package database names the libraries; auditwheel's own list comes out empty on Debian 12, where
/lib is a link.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any
from urllib.parse import quote

#: All are under the licence whose text the wheel has as LICENSE.
LICENCES = {"libembree3-3": "Apache-2.0", "libhwy1": "Apache-2.0", "libtbb12": "Apache-2.0"}


def said(*words: str) -> str:
    """Returns what a command prints."""
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def package_of(library: str) -> str:
    """Returns the package of a library, which auditwheel has called libtbb-4d79fbbd.so.12.8."""
    name = re.sub(r"-[0-9a-f]{8}(?=\.so)", "", library)
    machine = said("gcc", "-dumpmachine").strip().replace("-pc-", "-")
    return said("dpkg", "-S", f"/usr/lib/{machine}/{name}").rpartition(": ")[0].strip()


def component(package: str) -> dict[str, Any]:
    """Describes a package of Debian, as CycloneDX wants it."""
    name, version = said("dpkg-query", "-W", "-f", "${Package} ${Version}", package).split()
    if name not in LICENCES:
        raise SystemExit(f"bundled: {name}: wanted a licence in LICENCES, got none")
    url = f"pkg:deb/debian/{name}@{quote(version)}"
    return {
        "type": "library",
        "bom-ref": url,
        "name": name,
        "version": version,
        "licenses": [{"license": {"id": LICENCES[name]}}],
        "purl": url,
    }


def main(tree: Path) -> None:
    """Writes the licences and the list into the wheel's metadata."""
    info = next(tree.glob("*.dist-info"))
    name, version = info.name.removesuffix(".dist-info").split("-")
    packages = [package_of(path.name) for path in sorted(tree.glob("*.libs/*"))]
    parts = []
    for package in packages:
        parts.append(component(package))
        text = Path("/usr/share/doc", parts[-1]["name"], "copyright").read_text()
        (info / "licenses" / f"{parts[-1]['name']}.txt").write_text(text)
    wheel = {"type": "library", "bom-ref": f"pkg:pypi/{name}@{version}", "name": name}
    wheel |= {"version": version, "purl": f"pkg:pypi/{name}@{version}"}
    wheel["licenses"] = [{"license": {"id": "Apache-2.0"}}]
    refs = [part["bom-ref"] for part in parts]
    bom = {
        "$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json",
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {"component": wheel},
        "components": parts,
        "dependencies": [
            {"ref": wheel["bom-ref"], "dependsOn": refs},
            *({"ref": ref} for ref in refs),
        ],
    }
    (info / "sboms").mkdir(exist_ok=True)
    (info / "sboms" / "bundled.cdx.json").write_text(json.dumps(bom, indent=2) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
