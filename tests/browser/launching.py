"""Which browser, and how it is started."""

from __future__ import annotations

# Debian's Chromium without windows first: it draws the same pages, and is there sooner.
NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
# WebGL drawn by the processor, the rest of the page by the quicker way for one, and no name resolved: nothing but this
# machine can be reached.
ARGUMENTS = (
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-gpu-rasterization",
    "--disable-gpu-compositing",
    "--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1",
)
PHONE = {"width": 390, "height": 844}
LAPTOP = {"width": 1366, "height": 768}
SMALL = {"width": 960, "height": 640}  # the layout of a laptop, and few pixels to draw
PATIENCE = 20_000  # ms, for anything on a busy machine
