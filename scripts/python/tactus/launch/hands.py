"""The hands of a scene: one haptic_node for each of its tools, so that one can go and come without the others."""
import re

FIRST = "haptic_node"  # holds the first tool, or none when the scene has none
LONGEST_NAME = 40      # of a process: its folder and its log bear it too


def processes(names):
    """{process: tool} of the tools after the first: haptic_node_TOOL, in letters that a folder and a shell bear."""
    hands = {}
    for number, tool in enumerate(names[1:], 2):
        process = f"{FIRST}_{re.sub(r'[^A-Za-z0-9_-]', '_', tool)}"[:LONGEST_NAME]
        hands[process if process not in hands else f"{process[:LONGEST_NAME - 4]}_{number}"] = tool
    return hands


def devices(words, names):
    """{tool or "": spec} of --device words: SPEC is the first tool's, TOOL=SPEC that of the tool of this name. ValueError, with one
    sentence, where a tool is not there or gets two, or two tools get the device of one program."""
    chosen, held = {}, {}
    for word in words:
        tool, equals, spec = word.partition("=")
        if not (equals and tool in names):
            # The first = of a device without a tool comes after its kind: playback:FILE,scale=2
            if equals and not re.search(r"[:,]", tool) and names:
                raise ValueError(f'--device {word}: the scene has no tool "{tool}"; it has {", ".join(names)}')
            tool, spec = (names[0] if names else ""), word
        key = "" if not names or tool == names[0] else tool
        if key in chosen:
            raise ValueError(f"--device {word}: the tool {tool} has a device already; name one")
        chosen[key] = spec
        kind, _, name = spec.partition(":")
        name = name.partition(",")[0]
        if kind == "external" and held.setdefault(name, tool) != tool:
            raise ValueError(f"--device {word}: {held[name]} holds external:{name} already; two would shake it between them")
    return chosen
