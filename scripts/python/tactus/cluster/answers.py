"""The form of each answer of an agent, and of the programs that it runs. A host may be hostile or run another version, so that an answer is
checked before it is used.

A form is a type; [FORM], a list; {name: FORM, ...}, an object with at least these members; or Each(FORM), an object with any names.
"""
import json
import math
import re
from typing import NamedTuple

NUMBER = (int, float)
BUILD = re.compile(r"[0-9a-f]{0,64}")


class Each(NamedTuple):
    form: object


class Optional(NamedTuple):
    """A member that may be missing or null."""
    form: object


NODE = {"up": bool, "pid": int, "deaths": int, "lost": str, "taken_down": bool, "last": str, "begun": bool}
RUN = {"run_id": int, "build": str, "services": str, "holder": int, "here": [str], "began": NUMBER, "namespaces": [str], "since": Optional(Each(NUMBER))}
FORMS = {
    "inspect_host": {"machine": str, "python": str, "runit": bool, "cores": int, "build": bool, "missing": [str], "messages": str, "realtime": int, "root": bool},
    "node_states": {"nodes": Each(NODE), "load": NUMBER, "cores": int}, "logs": Each({"lines": [str], "offset": int}), "check": Each(str),
    "prepare": {"prepared": bool, "kept": Optional(str)}, "stop": {"killed": [str]}, "restart": {"killed": [str]}, "shaders": {"tar": str},
    "store_shaders": {"stored": int}, "run_bus_program": {"status": int, "out": str, "err": str}, "end_supervisor": {"was_there": bool}}
# JSON of programs.
WATCH = {"nodes": Each({"state": str, "rate_hz": NUMBER, "missed_ticks": int, "input_age_ms": Optional(NUMBER), "contacts_rendered": int, "note": str})}
DOCTOR = {"lines": [{"what": str, "verdict": str, "found": str, "remedy": str}]}
PAIRS = {"burst": int, "refused": int, "other_doctors": int, "ttl": int, "buffer_bytes": int, "others": Each({
    "received": NUMBER, "answered": NUMBER, "lost": NUMBER, "of_bursts": int, "ttl": int, "offset_us": Optional(NUMBER), "uncertainty_us": Optional(NUMBER),
    "round_trip_us": Optional({"p50": NUMBER, "p99": NUMBER})})}


def wrong(what, answer):
    """The first fault of an answer to this request, as part of a sentence; "" when it is valid."""
    fault = fault_of(answer, FORMS.get(what, {}))
    if fault or what not in ("inspect_host", "node_states") or answer.get("run") == {}:
        return fault
    fault = fault_of(answer.get("run"), RUN, "run")
    return fault or ("" if BUILD.fullmatch(answer["run"]["build"]) else "build is not the name of a build")


def read(text, form):
    """The value of a JSON text of this form. Raises ValueError with its fault."""
    try:
        value = json.loads(text)
    except RecursionError:
        raise ValueError("is nested too deeply") from None
    if fault := fault_of(value, form):
        raise ValueError(fault)
    return value


def fault_of(value, form, name="the answer"):
    """The first fault of a value, as part of a sentence; "" when it has this form."""
    if isinstance(form, Optional):
        return "" if value is None else fault_of(value, form.form, name)
    if isinstance(form, (dict, Each)) and not isinstance(value, dict):
        return f"{name} is not an object"
    if isinstance(form, Each):
        return next(filter(None, (fault_of(v, form.form, k[:40]) for k, v in value.items())), "")
    if isinstance(form, dict):
        return next(filter(None, (fault_of(value.get(k), f, k) for k, f in form.items())), "")
    if isinstance(form, list):
        return next(filter(None, (fault_of(v, form[0], name) for v in value)), "") if isinstance(value, list) else f"{name} is not a list"
    is_type = isinstance(value, form) and (not isinstance(value, float) or math.isfinite(value))
    return "" if is_type else f"{name} is missing or has another type"
