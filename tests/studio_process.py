"""A job's process that does nothing, for tests of the studio: it says so in a log, and waits while a file is there.

``python studio_process.py FOLDER``: FOLDER/log gets a line when a job begins, is done, or sees its studio die;
while FOLDER/hold is there, jobs go on.
"""

from __future__ import annotations

import _thread
import json
import os
import sys
import time

# Begun some sixty times: modules that are slow to import (threads, paths) are done without.


def main() -> None:
    folder = sys.argv[1]
    task = json.loads(sys.stdin.buffer.readline())
    name = task["song"]["name"] if "song" in task else task["type"]

    def log(word: str) -> None:
        with open(f"{folder}/log", "a") as file:
            file.write(f"{word} {name}\n")

    def watch() -> None:
        while os.read(0, 4096):
            pass
        log("orphan")
        os._exit(1)

    log("begin")
    _thread.start_new_thread(watch, ())
    print(json.dumps({"type": "progress", "share": 0.5, "message": "half"}), flush=True)
    while os.path.exists(f"{folder}/hold"):
        time.sleep(0.01)
    if "bad" in name:
        print(json.dumps({"type": "failed", "error": f"{name} cannot be"}), flush=True)
        return
    if "crash" in name:
        os.abort()
    with open(f"{task['out']}/made.txt", "w") as file:
        file.write(name)
    log("done")
    seen = [{"id": file[0]} for file in task["files"]] if task["type"] == "look" else []
    print(json.dumps({"type": "done", "seconds": 12.0, "tempo": 120.0, "clips": 3, "seen": seen}), flush=True)


if __name__ == "__main__":
    main()
