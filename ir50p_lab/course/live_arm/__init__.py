"""The arm in 3-D, in the browser: turned by mouse, touch and keys, dragged at its tip, played back, fed by a bench.

    view = LiveArm(arm, [0.3, 0.8, -1.2], layers=["table", "shadow", "frames"])
    view

Mathematics and drawing run in the browser (`src/`, on three.js, bundled into `static/live_arm.js`). Whoever
changes `src/` builds the bundle again, in this folder: `npm ci && npm run build`. Nobody else needs Node.
"""

from ir50p_lab.course.live_arm.view import LiveArm

__all__ = ["LiveArm"]
