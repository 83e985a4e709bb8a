"""Pauses, steps, resets and changes the simulation of a running cluster."""
from tactus.commands import ask

USAGE = """Usage: tactus simulation COMMAND [--in OUT_DIR]

  pause                          the world stands still; hands feel its surfaces, which do not yield
  resume                         it goes on
  step [N]                       N steps of 1 ms of a world that stands still; default: 1
  reset                          back to the first instant of the scene
  set NAME.PROPERTY VALUE...     for example steel_ball.mass 0.3, world.gravity 0 0 -1.6, fan::axle.motor 0.02 1000
  push BODY FX FY FZ [--torque TX TY TZ] [--seconds S]
                                 a force (N) and a torque (N m) on a body, for 0.1 s or as long as is said
  snapshot NAME [--to-file]      keeps the state of the world; --to-file: in OUT_DIR/NAME.state too
  restore NAME                   puts it back, from memory or from that file

  --in OUT_DIR                   the cluster that writes to OUT_DIR; default: the one that was started last

Says what was done, or in one sentence why it was not. docs/commands.md lists what can be set."""


def main(words):
    return ask.main("simulation", USAGE, words)
