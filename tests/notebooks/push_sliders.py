# Runs inside the notebook's kernel, as its last cell: pushes every control of every panel and reports as JSON.
def _push():
    import hashlib
    import json

    from ir50p_lab.course.draw.widgets import LivePanel

    def positions(control):
        if hasattr(control, "min"):
            middle = type(control.value)((control.min + control.max) / 2)
            return [control.min, middle, control.max]
        return [value for _, value in control._options_full]

    report = []
    for panel in sorted(LivePanel.panels, key=lambda panel: panel.model_id):
        start, errors, pictures, pushes = panel.values, [], set(), 0
        trials = [{name: value} for name, c in panel.controls.items() for value in positions(c)]
        trials += [{name: positions(c)[k] for name, c in panel.controls.items()} for k in (0, -1)]
        for trial in trials:
            try:
                panel.set(**trial)
            except Exception as error:
                errors.append(f"{trial} from {start}: {type(error).__name__}: {error}")
            if panel.error is None and "Error" in panel.status.value:
                errors.append(f"{trial}: {panel.status.value}")
            pictures.add(hashlib.sha256(panel.image.value).hexdigest())
            pushes += 1
            if len(trial) == 1:
                panel.reset()
        panel.reset()
        report.append({"controls": list(panel.controls), "pushes": pushes, "pictures": len(pictures), "errors": errors})
    print(json.dumps(report))


_push()
