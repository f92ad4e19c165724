"""What several subjects draw with: figures, sliders, charts, the arm, pictures."""
