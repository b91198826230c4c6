"""Runs a command and writes its wall time, exit code and peak memory: `launch.py RESULT COMMAND…`.

A process counts the memory of whoever forked it as its own, so that big programs must not measure small ones; this
one is small.
"""

import json
import os
import sys
import time

begin = time.perf_counter()
child = os.fork()
if child == 0:
    try:
        os.execvp(sys.argv[2], sys.argv[2:])
    except OSError as error:
        print(f"{sys.argv[2]}: {error.strerror}")
        os._exit(127)
_, status, usage = os.wait4(child, 0)
seconds = time.perf_counter() - begin
with open(sys.argv[1], "w") as file:
    # Linux counts KiB.
    code, mib = os.waitstatus_to_exitcode(status), usage.ru_maxrss / 1024
    json.dump({"seconds": seconds, "code": code, "peak_mib": mib}, file)
