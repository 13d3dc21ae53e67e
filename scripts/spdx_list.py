"""Prints the contents of rigcal's packages as SPDX 2.3 in JSON. usage: spdx_list.py VERSION DATE PACKAGE...

PACKAGE: Debian packages of the shared libraries; cmake/parts.txt lists the parts that are compiled in. DATE: date of the
commit, in UTC or with a UTC offset, so that the same commit gives the same list.
"""
import datetime
import json
import pathlib
import re
import subprocess
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent


def version_of(package):
    if package.startswith("npm:"):
        return json.loads((ROOT / "node_modules" / package[4:] / "package.json").read_text())["version"]
    return subprocess.run(["dpkg-query", "-W", "-f=${Version}\n", package], capture_output=True, text=True,
                          check=True).stdout.splitlines()[0]


def licences_by_debian(package):
    """Returns the short licence names in Debian's copyright file; not all are SPDX names."""
    file = pathlib.Path("/usr/share/doc") / package / "copyright"
    names = re.findall(r"^License: *(\S.*)$", file.read_text(errors="replace"), re.MULTILINE) if file.is_file() else []
    return ", ".join(dict.fromkeys(name.strip() for name in names))


def entry(name, package, version, licence, comment):
    identifier = "SPDXRef-" + re.sub(r"[^A-Za-z0-9.-]", "-", package)
    if package.startswith("npm:"):
        place, reference = f"https://registry.npmjs.org/{package[4:]}/-/{package[4:]}-{version}.tgz", f"pkg:npm/{package[4:]}@{version}"
    else:
        place, reference = "NOASSERTION", f"pkg:deb/debian/{package}@{urllib.parse.quote(version, safe='')}"
    return {"SPDXID": identifier, "name": name, "versionInfo": version, "downloadLocation": place, "filesAnalyzed": False,
            "licenseConcluded": licence, "licenseDeclared": licence, "copyrightText": "NOASSERTION", "comment": comment,
            "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": reference}]}


def spdx_list(version, date, shared):
    moment = datetime.datetime.fromisoformat(date).astimezone(datetime.timezone.utc)
    rigcal = {"SPDXID": "SPDXRef-rigcal", "name": "rigcal", "versionInfo": version, "downloadLocation": "NOASSERTION",
              "filesAnalyzed": False, "licenseConcluded": "MIT", "licenseDeclared": "MIT", "copyrightText": "NOASSERTION"}
    packages, relations = [rigcal], [("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-rigcal")]
    for line in (ROOT / "cmake" / "parts.txt").read_text().splitlines():
        if line.startswith("#"):
            continue
        name, package, licence, what = line.split("|")
        packages.append(entry(name, package, version_of(package), licence, what))
        relations.append(("SPDXRef-rigcal", "CONTAINS", packages[-1]["SPDXID"]))
    known = {each["SPDXID"] for each in packages}
    for package in shared:
        found = entry(package, package, version_of(package), "NOASSERTION",
                      f"shared library; licences by Debian's copyright file: {licences_by_debian(package) or 'see there'}")
        if found["SPDXID"] not in known:
            packages.append(found)
        relations.append(("SPDXRef-rigcal", "DYNAMIC_LINK", found["SPDXID"]))
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"rigcal-{version}",
            "documentNamespace": f"https://spdx.org/spdxdocs/rigcal-{version}-{moment:%Y%m%dT%H%M%SZ}",
            "creationInfo": {"created": f"{moment:%Y-%m-%dT%H:%M:%SZ}", "creators": ["Tool: rigcal-scripts-package"]},
            "packages": packages,
            "relationships": [{"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other}
                              for one, kind, other in relations]}


if __name__ == "__main__":
    print(json.dumps(spdx_list(sys.argv[1], sys.argv[2], sys.argv[3:]), indent=1, ensure_ascii=False))
