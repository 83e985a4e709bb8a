"""Command line of scripts/run for the live cluster of a study."""
from tactus.study import flash_detector


def sees(study, options):
    """Whether a simulated participant needs the pictures of this study."""
    return options.simulated and any("visual" in c.senses for c in study.conditions)


def cluster_words(study, options):
    """Arguments of scripts/run."""
    words = [str(study.scene), "--policy", "experiment", "--base", f"{study.base_delay_ms:g}ms", "--seed", str(study.seed)]
    words += ["--device", options.device or "external:conductor"]
    for flag in ("window", "listen"):
        if getattr(options, flag):
            words.append(f"--{flag}")
    if options.live is not None:
        words += ["--live", options.live]
        if not options.window:  # the page shows the questions itself
            words += ["--set", "visual_node.questions=false"]
    if sees(study, options):
        for setting in flash_detector.SETTINGS:
            words += ["--set", f"visual_node.{setting}"]
    for setting in options.set:
        words += ["--set", setting]
    return words
