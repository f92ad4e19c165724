"""What the notebooks share: figures, live sliders, exercises, and what the thesis prints."""
