#!/usr/bin/env python3
"""Pools what evaluate says of several drives into one line.

Usage: pool_evaluations.py SCENARIO FILTER X.json...
Beside each X.json lies X.cpu with the filter's processor time in seconds.
"""
import json
import math
import sys


def main():
    scenario, name, paths = sys.argv[1], sys.argv[2], sys.argv[3:]
    count = square = yaw_square = nees = worst = cpu = 0.0
    for path in paths:
        with open(path) as file:
            part = json.load(file)["all"]
        with open(path[:-len(".json")] + ".cpu") as file:
            cpu += float(file.read())
        n = part["samples"]
        count += n
        square += n * part["position"]["rmse_m"] ** 2
        yaw_square += n * part["yaw"]["rmse_rad"] ** 2
        nees += n * part["nees_mean"]
        worst = max(worst, part["position"]["max_m"])
    print("%-16s %-19s %2d drives: rmse %6.1f mm, yaw %.3f deg, worst %6.1f mm, NEES %5.2f of 3, processor %.2f s a drive"
          % (scenario, name, len(paths), 1e3 * math.sqrt(square / count), math.degrees(math.sqrt(yaw_square / count)),
             1e3 * worst, nees / count, cpu / len(paths)))


main()
