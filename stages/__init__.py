"""The pipeline: one folder per stage, in the order that the Snakefile shows."""

import os

# Threads of BLAS cost more than they bring for matrices as small as ours, and stages run side by
# side. It must be said before numpy is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

ORDER = (
    "plan",
    "decode",
    "quality",
    "segment",
    "noise",
    "accelerometer",
    "gyroscope",
    "studies",
    "comparison",
    "simulation",
    "criticism",
    "extension",
    "diagnosis",
    "compensation",
    "navigation",
    "alignment",
    "history",
    "export",
    "report",
    "pdf",
)
