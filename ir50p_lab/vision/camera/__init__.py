"""Where pictures come from: a webcam, a folder, or a rendered scene, behind one interface."""
