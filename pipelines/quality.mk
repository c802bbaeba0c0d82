# The presets draft, default, final and guided: counts of all stages, and options of two. Makefile
# includes this file, and generate_ninja.py reads it. docs/guide.md, "Presets", lists their errors.
#   VARIABLE.quality := value

CANDIDATES.draft := 15k
VPLS.draft       := 1500
PHOTONS.draft    := 1M
SPP.draft        := 16
ESTIMATE.draft   := --irradiance-error 0.02
RENDER.draft     := --near-field-rays 2 --error 0.1

# The defaults of the tools, and VPLS, for which vpl-eliminate has no default.
CANDIDATES.default := 120k
VPLS.default       := 3k
PHOTONS.default    := 10M
SPP.default        := 16
ESTIMATE.default   :=
RENDER.default     :=

CANDIDATES.final := 240k
VPLS.final       := 12k
PHOTONS.final    := 20M
SPP.final        := 256
ESTIMATE.final   := --irradiance-error 0.002
RENDER.final     := --near-field-rays 4 --error 0.05

# Path guiding: its VPLs only say where light comes from, so a draft of them is enough.
CANDIDATES.guided := 15k
VPLS.guided       := 1500
PHOTONS.guided    := 1M
SPP.guided        := 32
ESTIMATE.guided   := --irradiance-error 0.02
RENDER.guided     := --integrator guided
