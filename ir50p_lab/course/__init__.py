"""What the notebooks share: figures, live sliders, what students write and predict, claims, what the thesis prints."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(
    __name__,
    submodules=["my_robot"],
    submod_attrs={
        "checking": ["check", "reset"],
        "claims": ["ClaimError", "claim"],
        "lab_book": ["keep", "measured", "note", "predict"],
        "live_arm": ["LiveArm"],
        "own_results": ["arm_that_answers", "load_result", "results", "save_result"],
        "parts": ["parts"],
        "rehearse": ["RehearsalError", "rehearse"],
    },
)
