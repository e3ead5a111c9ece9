"""A job's process that does nothing, for tests of the studio: it says so in a log, and waits while a file is there.

``python studio_process.py FOLDER``: FOLDER/log gets a line when a job begins, is done, or sees its studio die;
while FOLDER/hold is there, jobs go on.
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from pathlib import Path


def main() -> None:
    folder = Path(sys.argv[1])
    task = json.loads(sys.stdin.buffer.readline())
    name = task["song"]["name"] if "song" in task else task["type"]

    def log(word: str) -> None:
        with (folder / "log").open("a") as file:
            file.write(f"{word} {name}\n")

    def watch() -> None:
        while os.read(0, 4096):
            pass
        log("orphan")
        os._exit(1)

    log("begin")
    threading.Thread(target=watch, daemon=True).start()
    print(json.dumps({"type": "progress", "share": 0.5, "message": "half"}), flush=True)
    while (folder / "hold").exists():
        time.sleep(0.01)
    if "bad" in name:
        print(json.dumps({"type": "failed", "error": f"{name} cannot be"}), flush=True)
        return
    if "crash" in name:
        os.abort()
    (Path(task["out"]) / "made.txt").write_text(name)
    log("done")
    seen = [{"id": file[0]} for file in task["files"]] if task["type"] == "look" else []
    print(json.dumps({"type": "done", "seconds": 12.0, "tempo": 120.0, "clips": 3, "seen": seen}), flush=True)


if __name__ == "__main__":
    main()
