"""Counts the instructions of one call of each kernel and fails if one exceeds its budget.

Usage: instruction_counts.py BUDGETS.json PROGRAM_FOLDER

BUDGETS.json lists {"program", "arguments", "budget"}. A program takes its arguments and then a
number of calls. Callgrind counts two runs of it with different numbers; the difference is the calls
alone, without start and set-up. Times vary from run to run, these counts do not.
"""

import json
import pathlib
import re
import subprocess
import sys

FEW, MANY = 100, 1100
ROOM_WORTH_A_NOTE = 0.8  # a budget that is used less than this should be lowered


def instructions(command):
    valgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    result = subprocess.run(valgrind + command, capture_output=True, text=True)
    counted = re.search(r"Collected : (\d+)", result.stderr)
    if result.returncode != 0 or not counted:
        sys.exit(f"{' '.join(command)} failed under callgrind:\n{result.stderr}")
    return int(counted.group(1))


def instructions_per_call(command):
    few, many = (instructions(command + [str(calls)]) for calls in (FEW, MANY))
    return (many - few) / (MANY - FEW)


def main():
    budgets, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    exceeded = False
    for kernel in json.loads(budgets.read_text()):
        count = instructions_per_call([str(folder / kernel["program"]), *kernel["arguments"]])
        name = " ".join([kernel["program"], *kernel["arguments"]])
        share = count / kernel["budget"]
        verdict = "EXCEEDED" if share > 1 else "could be lower" if share < ROOM_WORTH_A_NOTE else ""
        print(f"{name:40} {count:10.0f} of {kernel['budget']:10} {verdict}".rstrip())
        exceeded = exceeded or share > 1
    return 1 if exceeded else 0


if __name__ == "__main__":
    sys.exit(main())
