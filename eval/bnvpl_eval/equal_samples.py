"""How many samples a pixel fit into a time that is equal for all."""

import math
from collections.abc import Callable

MAX_SPP = 1024
MIN_SAMPLE_S = 6e-5  # CPU time for one sample a pixel; less is the noise of two times
CLOSE_ENOUGH = 0.1  # to the time, for a number of samples that has been run
SECOND_TRIAL = 0.25  # as a share of the time
TOO_LONG = 1.25  # times the time, for a run of no more samples than a first trial has
MAX_TRIALS = 5
# Most growth of the samples to the next trial: the noise of two short ones may hide the slope.
MAX_STEP = 8


def samples_within(time_s: float, few: tuple[int, float], many: tuple[int, float]) -> float:
    """Samples a pixel for a time in CPU seconds, by a line through two trials (samples, CPU s)."""
    sample_s = max((many[1] - few[1]) / (many[0] - few[0]), MIN_SAMPLE_S)
    return many[0] + (time_s - many[1]) / sample_s


def fitting_spp(
    cpu_s: Callable[[int], float], few: int, time_s: float, most: int = MAX_SPP
) -> int:
    """Samples a pixel whose run takes `time_s` CPU seconds; 0 if the run of one sample is too long.

    Preparations take most of the time of a few samples, and further samples may cost less than the
    first. So lines through two trials lead to the number, which is tried itself; the trial whose
    time is nearest counts. The first line is of short trials, since those are run besides the
    images that count.
    """
    few_s = max(cpu_s(few), 1e-3)
    if few_s > time_s:
        spp = round(few * time_s / few_s)
        while spp > 0 and (few_s if spp == few else cpu_s(spp)) > TOO_LONG * time_s:
            spp -= 1
        return spp
    tried = {few: few_s}
    before = (few, few_s)
    spp = min(max(math.floor(SECOND_TRIAL * few * time_s / few_s), 2 * few), most)
    for _ in range(MAX_TRIALS):
        trial = (spp, cpu_s(spp))
        tried[spp] = trial[1]
        if abs(trial[1] - time_s) < CLOSE_ENOUGH * time_s:
            return spp
        fitting = max(1, round(samples_within(time_s, before, trial)))
        fitting = min(most, MAX_STEP * spp, fitting)
        if fitting in tried:
            break
        before, spp = trial, fitting
    return min(tried, key=lambda spp: abs(tried[spp] - time_s))
