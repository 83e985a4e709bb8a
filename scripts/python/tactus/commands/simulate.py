"""The command `tactus simulate`: pauses, steps, resets and changes the simulation of a running cluster."""
from tactus.commands import request_program

USAGE = """Usage: tactus simulate COMMAND [--in OUT_DIR]

  pause                          stops simulation time; haptic devices still feel the surfaces, which are rigid
  resume                         continues the simulation
  step [N]                       computes N steps of 1 ms of a paused simulation; default: 1
  reset                          returns to the initial state of the scene
  set NAME.PROPERTY VALUE...     changes a property, for example steel_ball.mass 0.3, world.gravity 0 0 -1.6, fan::axle.motor 0.02 1000
  push BODY FX FY FZ [--torque TX TY TZ] [--seconds S]
                                 applies a force (N) and a torque (N m) to a body for S seconds; default: 0.1
  snapshot NAME [--to-file]      saves the simulation state in memory; --to-file: also in OUT_DIR/NAME.state
  restore NAME                   restores the state from memory or from that file

  --in OUT_DIR                   the cluster that writes to OUT_DIR; default: the cluster that was started last

Prints the result, or one sentence with the reason for the failure. docs/commands.md lists the properties."""


def main(words):
    return request_program.main("simulation", USAGE, words, command="simulate")
