"""Counts the instructions of one call of each kernel and fails if one exceeds its budget.

Usage: instruction_counts.py [--jobs N] [--update] BUDGETS.json CONFIGURATION PROGRAM_FOLDER

BUDGETS.json lists {"program", "arguments", "budget"}, with a budget for each build type of CMake
(CONFIGURATION). A program takes its arguments and a number of calls, and has callgrind count these
calls alone (kernels.h). Times vary from run to run, these counts do not. --update writes what was
counted, and 5 % of room, as the budgets of the configuration.
"""

import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import re
import subprocess
import sys

CALLS = 300
ROOM = 1.05
ROOM_WORTH_A_NOTE = 0.8  # a budget that is used less than this should be lowered


def instructions_per_call(command):
    valgrind = ["valgrind", "--tool=callgrind", "--instr-atstart=no",
                "--callgrind-out-file=/dev/null"]
    result = subprocess.run(valgrind + command + [str(CALLS)], capture_output=True, text=True)
    counted = re.search(r"Collected : (\d+)", result.stderr)
    if result.returncode != 0 or not counted or int(counted.group(1)) == 0:
        sys.exit(f"{' '.join(command)} failed under callgrind:\n{result.stderr}")
    return int(counted.group(1)) / CALLS


def budget_for(count):
    """With room, to three digits."""
    digit = 10 ** max(0, math.floor(math.log10(count * ROOM)) - 2)
    return math.ceil(count * ROOM / digit) * digit


def report(kernel, count, budget):
    """Prints a line about the kernel; whether it is within its budget."""
    share = count / budget
    verdict = "EXCEEDED" if share > 1 else "could be lower" if share < ROOM_WORTH_A_NOTE else ""
    name = " ".join([kernel["program"], *kernel["arguments"]])
    print(f"{name:40} {count:10.0f} of {budget:10} {verdict}".rstrip(), flush=True)
    return share <= 1


def check_budgets(kernels, configuration):
    for kernel in kernels:
        if configuration not in kernel["budget"]:
            sys.exit(f"{kernel['program']} {' '.join(kernel['arguments'])} has no budget for "
                     f"'{configuration}'; --update gives it one")


def write(kernels, path):
    path.write_text("[\n  " + ",\n  ".join(json.dumps(kernel) for kernel in kernels) + "\n]\n")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--update", action="store_true")
    parser.add_argument("budgets", type=pathlib.Path)
    parser.add_argument("configuration")
    parser.add_argument("programs", type=pathlib.Path)
    arguments = parser.parse_args()

    kernels = json.loads(arguments.budgets.read_text())
    if not arguments.update:
        check_budgets(kernels, arguments.configuration)
    commands = [[str(arguments.programs / kernel["program"]), *kernel["arguments"]]
                for kernel in kernels]
    within = True
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for kernel, count in zip(kernels, pool.map(instructions_per_call, commands)):
            if arguments.update:
                kernel["budget"][arguments.configuration] = budget_for(count)
            within &= report(kernel, count, kernel["budget"][arguments.configuration])
    if arguments.update:
        write(kernels, arguments.budgets)
    return 0 if within else 1


if __name__ == "__main__":
    sys.exit(main())
