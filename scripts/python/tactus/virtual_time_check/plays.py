"""Runs of a scene and games, live and in virtual time."""
import os
import shutil
import subprocess

from tactus.paths import tactus_command
from tactus.refusal import Refusal
from tactus.study import games
from tactus.sweep.player import Player
from tactus.virtual_time_check import scene_figures

STUDY = "game_limits"
# From harmless to fatal, for each of the three senses of the player; bin/play_games wins 8, 8, 8, 6, 4, 3, 2 and 0 of 8 games.
CONDITIONS = ("nothing degraded", "audio removed", "visual rate 5Hz", "haptic delay 20ms", "visual loss 90%", "haptic jitter 20ms", "visual loss 95%", "visual delay 200ms")


def machine():
    """Properties of the machine that affect figures of the live cluster."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        model = next((line.partition(":")[2].strip() for line in file if line.startswith("model name")), "unknown")
    return {"processor": model, "cores": len(os.sched_getaffinity(0)), "load": load()}


def load():
    return [round(x, 2) for x in os.getloadavg()]


def run(scene, seconds, seed, settings, out, virtual):
    """RunTables of a run of the scene with its scripted hand. Raises Refusal."""
    words = [*tactus_command("run"), str(scene), "--seconds", f"{seconds:g}", "--seed", str(seed), "--out", str(out)]
    words += [w for s in settings for w in ("--set", s)] + (["--virtual-time"] if virtual else [])
    done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", check=False)
    try:
        return scene_figures.read(out)  # a run that lost an event exits with status 1 but has figures
    except (OSError, ValueError, KeyError) as error:
        said = (done.stderr.strip().splitlines() or [str(error)])[-1]
        raise Refusal(f"scripts/run: wrote no figures ({said}); see {out}") from None


def virtual_games(scene, requests):
    """Yields the result of bin/play_games for each request, in order. Raises Refusal."""
    with Player(scene) as player:
        for game in requests:
            yield player.play(game)


def live_game(scene, request, settings, out, keep):
    """Plays the same game on the live cluster; returns the members of a result of play_games, and the state of the cluster. keep: keeps its files."""
    profile = out.with_suffix(".xml")
    profile.write_text(request["profile"], encoding="utf-8")
    try:
        played = games.play_in_new_cluster(out, scene, profile, request["seed"], request["limit_s"], settings)
        result = {"trouble": played.missed} if played.missed else {"won": bool(played.row["success"]), "time_s": played.row["completion_time_s"], "wrong": played.row["errors"]}
    except Refusal as refusal:
        result = {"trouble": str(refusal)}
    result["cluster"] = state_of(out)
    if not keep:
        shutil.rmtree(out, ignore_errors=True)
        out.with_suffix(".log").unlink(missing_ok=True)
        profile.unlink()
    return result


def state_of(out):
    """Figures from the summary of a run that show whether the machine kept up; {}: no summary."""
    try:
        tables = scene_figures.RunTables(out)
        nodes = tables.summary["nodes"]
        delays_ms = tables.delays_ms().get("visual", [])
        return {"realtime_factor": tables.summary["realtime_factor"], "pictures_hz": nodes["visual_node"]["rate_hz"],
                "missed_ticks": {name: node["missed_ticks"] for name, node in nodes.items()}, "visual_delay_ms": scene_figures.median(delays_ms) if len(delays_ms) else None, "load": load()}
    except (OSError, ValueError, KeyError):
        return {}
