#!/usr/bin/env python3
"""Weighted sample elimination (Yuksel 2015): eliminate.py candidates.vpl vpls.vpl 1000"""

import math
import sys

import numpy as np

import bnvpl


def compatible(p, n, q, m, tolerance):
    """Whether points may stand for each other; those on two sides of a wall may not."""
    apart = np.maximum(abs(((q - p) * n).sum(1)), abs(((q - p) * m).sum(1)))
    return ((n * m).sum(1) >= 0.5) & (apart <= tolerance)


def area_of(p, n, k=20, probes=500):
    """Area under the candidates. Each covers pi d^2 / k, d the distance of the k-th nearest."""
    shares = []
    for i in np.linspace(0, len(p) - 1, probes).astype(int):
        distance2 = ((p - p[i]) ** 2).sum(1)
        near = np.argpartition(distance2, 3 * k)[: 3 * k]
        tolerance = 0.5 * math.sqrt(np.partition(distance2[near], k)[k])
        same = np.sort(distance2[near[compatible(p[i], n[i], p[near], n[near], tolerance)]])
        last = min(k, len(same) - 1)  # the nearest one is the candidate itself
        shares.append(math.pi * same[last] / max(1, last))
    return len(p) * np.mean(shares)


def eliminate(p, n, count, radius):
    """Rows of the candidates that stay: the one with most weight goes, until `count` are left."""
    order = p[:, 0].argsort()  # so that neighbours in space are near in the arrays
    p, n = p[order], n[order]
    begin, end = (p[:, 0].searchsorted(p[:, 0] + side * 2 * radius) for side in (-1, 1))
    neighbours, pairs = [], []
    for i in range(len(p)):
        distance2 = ((p[begin[i] : end[i]] - p[i]) ** 2).sum(1)
        near = begin[i] + (distance2 < 4 * radius**2).nonzero()[0]
        near = near[compatible(p[i], n[i], p[near], n[near], radius) & (near != i)]
        neighbours.append(near)
        pairs.append((1 - np.sqrt(distance2[near - begin[i]]) / (2 * radius)) ** 8)
    weight = np.array([pair.sum() for pair in pairs])
    for _ in range(len(p) - count):
        heaviest = weight.argmax()
        weight[neighbours[heaviest]] -= pairs[heaviest]
        weight[heaviest] = -math.inf
    return np.sort(order[weight > -math.inf])


source, target, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
candidates = bnvpl.read_vpl(source)
p, n = candidates.position.astype(float), candidates.normal.astype(float)
r_max = math.sqrt(area_of(p, n) / (2 * math.sqrt(3) * count))  # disks in their densest packing
vpls = candidates.take(eliminate(p, n, count, r_max))
vpls.stage, vpls.r_max, vpls.radius = "eliminated", r_max, np.full(count, r_max)
record = {"tool": "eliminate.py", "version": "1", "options": {"count": count}}
vpls.provenance.append(record | {"inputs": {"candidates": candidates.checksum}})
bnvpl.write_vpl(target, vpls)
