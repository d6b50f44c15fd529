"""Downloads a Houdini for compiling against: its toolkit, libraries and Python.

    fetch_houdini.py VERSION FOLDER        VERSION as in 21.0

The newest production build of that version for Linux, by SideFX's Web API (https://www.sidefx.com/docs/api/), with the
credentials in HOUDINI_CLIENT_ID and HOUDINI_SECRET_KEY. Some gigabytes. Nothing is installed and no licence is taken.
"""

import base64
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import urllib.parse
import urllib.request
from pathlib import Path

SERVER = "https://www.sidefx.com"
# Large, and of no use to a compiler.
LEFT_OUT = ("./houdini/help", "./houdini/pic", "./houdini/config", "./mozilla", "./engine")


def post(address: str, fields: dict, authorization: str):
    request = urllib.request.Request(
        SERVER + address, urllib.parse.urlencode(fields).encode(), {"Authorization": authorization}
    )
    with urllib.request.urlopen(request, timeout=60) as reply:
        return json.load(reply)


def token(client: str, secret: str) -> str:
    basic = base64.b64encode(f"{client}:{secret}".encode()).decode()
    return post("/oauth2/application_token", {"grant_type": "client_credentials"}, f"Basic {basic}")["access_token"]


def find_build(version: str, bearer: str) -> dict:
    def call(function: str, **arguments):
        return post("/api/", {"json": json.dumps([function, [], arguments])}, f"Bearer {bearer}")

    product = {"product": "houdini", "version": version, "platform": "linux"}
    builds = call("download.get_daily_builds_list", **product, only_production=True)
    if not builds:
        raise SystemExit(f"fetch_houdini.py: SideFX has no production build of Houdini {version} for Linux")
    return call("download.get_daily_build_download", **{**product, "platform": builds[0]["platform"]},
                build=builds[0]["build"])  # fmt: skip


def download(build: dict, path: Path) -> None:
    checksum = hashlib.md5(usedforsecurity=False)  # what SideFX publishes
    with urllib.request.urlopen(build["download_url"], timeout=600) as reply, path.open("wb") as file:
        while block := reply.read(1 << 20):
            checksum.update(block)
            file.write(block)
    if checksum.hexdigest() != build["hash"]:
        raise SystemExit(f"fetch_houdini.py: {build['filename']} arrived damaged; try again")


def unpack(archive: Path, folder: Path) -> None:
    """The download holds an installer and houdini.tar.gz, which is $HFS."""
    outer = archive.parent / "outer"
    outer.mkdir()
    subprocess.run(["tar", "-xzf", archive, "-C", outer, "--strip-components=1"], check=True)
    folder.mkdir(parents=True)
    options = [f"--exclude={name}" for name in LEFT_OUT]
    subprocess.run(["tar", "-xzf", outer / "houdini.tar.gz", "-C", folder, *options], check=True)


def main() -> None:
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    client, secret = (os.environ.get(name) for name in ("HOUDINI_CLIENT_ID", "HOUDINI_SECRET_KEY"))
    if not client or not secret:
        raise SystemExit("fetch_houdini.py: HOUDINI_CLIENT_ID and HOUDINI_SECRET_KEY are not set")
    folder = Path(sys.argv[2])
    if folder.exists():
        raise SystemExit(f"fetch_houdini.py: {folder} is there already; choose another folder")
    build = find_build(sys.argv[1], token(client, secret))
    print(f"downloading {build['filename']}", flush=True)
    with tempfile.TemporaryDirectory(dir=".") as work:
        archive = Path(work) / "houdini.tar.gz"
        download(build, archive)
        unpack(archive, folder)


if __name__ == "__main__":
    main()
