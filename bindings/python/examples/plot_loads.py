"""The force at every joint of a study over time, as a picture: plot_loads.py STUDY PICTURE"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

import vmech

study = vmech.Study.read(sys.argv[1])
loads = study.run()
figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
for name in study.mechanism.joints:
    axes.plot(1e3 * loads.times, numpy.linalg.norm(loads.wrench(name)[:, :2], axis=1), label=name)
axes.set(xlabel="time [ms]", ylabel="force in the plane [N]", title=study.name)
axes.legend()
figure.savefig(sys.argv[2])
