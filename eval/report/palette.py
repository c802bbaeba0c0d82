"""Colours and markers of plot lines, which the page and plots.py share.

The hues follow Okabe and Ito, so that they differ under the common colour-vision deficiencies.
Their contrast with the background is at least 3:1. No line is identified by its colour alone.
"""

LIGHT = ("#0067b3", "#cc4b00", "#00795a", "#a8327e", "#846500", "#4a4f57", "#5b4bc4", "#b3261e")
DARK = ("#63b3ff", "#ff9550", "#2fd0a0", "#f490cf", "#e3c64a", "#c3c8cf", "#b0a4ff", "#ff8a80")
MARKERS = ("circle", "square", "triangle", "diamond", "down", "plus", "cross", "circle")
