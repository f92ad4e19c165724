"""What the notebooks share: figures, live sliders, exercises, claims, and what the thesis prints."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(__name__, submod_attrs={"claims": ["ClaimError", "claim"]})
