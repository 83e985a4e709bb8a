"""The tools of a scene: one haptic_node for each, so that each can stop and start independently."""
import re

FIRST = "haptic_node"  # holds the first tool; without a tool in a scene without tools
LONGEST_NAME = 40      # of a process name, which is also the name of its folder and log


def processes(names):
    """{process: tool} of the tools after the first: haptic_node_TOOL, with only letters, digits, _ and -."""
    hands = {}
    for number, tool in enumerate(names[1:], 2):
        process = f"{FIRST}_{re.sub(r'[^A-Za-z0-9_-]', '_', tool)}"[:LONGEST_NAME]
        hands[process if process not in hands else f"{process[:LONGEST_NAME - 4]}_{number}"] = tool
    return hands


def devices(words, names):
    """{tool: spec} of --device words; key "": the first tool. A word is SPEC, for the first tool, or TOOL=SPEC. Raises ValueError with
    one sentence for an unknown tool, for two devices of one tool, and for two tools with the device of one external program."""
    chosen, held = {}, {}
    for word in words:
        tool, equals, spec = word.partition("=")
        if not (equals and tool in names):
            # In a device without a tool the first = comes after the kind: playback:FILE,scale=2
            if equals and not re.search(r"[:,]", tool) and names:
                raise ValueError(f'--device {word}: the scene has no tool "{tool}"; it has {", ".join(names)}')
            tool, spec = (names[0] if names else ""), word
        key = "" if not names or tool == names[0] else tool
        if key in chosen:
            raise ValueError(f"--device {word}: the tool {tool} already has a device; give only one")
        chosen[key] = spec
        kind, _, name = spec.partition(":")
        name = name.partition(",")[0]
        if kind == "external" and held.setdefault(name, tool) != tool:
            raise ValueError(f"--device {word}: {held[name]} already holds external:{name}; give each tool its own device")
    return chosen
