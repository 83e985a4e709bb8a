"""The command `tactus replay`: plays the log of a run to live nodes. First installs missing packages and builds."""
from tactus.commands import prepare

USAGE = """Usage: tactus replay LOG [option]...

Plays a log to the nodes of the modalities, which render it again, live. Each node runs in its own process, as with tactus run.

  LOG                    run.lcmlog of a run, or its folder: all parts of its recording; damaged logs are played up to
                         the damage
  --run N                number of the run, of a log with several; default: 1
  --speed FACTOR         0.01 to 100 times the recorded speed; max: limited only by --most; default: 1
  --start S, --end S     from and to this second of the simulation; default: the whole log
  --loop                 restarts at the end
  --paused               starts paused and waits for a command
  --only NODE            only this node is live; may be repeated
  --without NODE         this node is not live; may be repeated. Nodes: haptic_node audio_node visual_node thermal_node sync_node
  --degrade PROFILE.xml  applies this degradation profile; --as-recorded: applies the recorded profile; default: none
  --channels REGEX       only channels whose complete name matches; --leave-out REGEX: not these channels; --also REGEX: also
                         these channels, which are not replayed by default
  --rename FROM=TO       renames a channel; may be repeated
  --most N               maximum number of messages per second, at any speed; default: 16000
  --set, --seed, --device, --policy, --soa, --base, --budget, --aligner, --window, --listen, --realtime, --network, --port, --out
                         as for tactus run
  --json FILE            also writes summary.json to FILE; -: prints only it
  --stay                 continues to run at the end of the log
  --help                 this text

The replay publishes the messages of the simulation and of the nodes that are not live. It leaves out the measurements, clocks,
commands and decisions of the recorded run, because receivers would take them for live ones; the recorded profile is also left out
unless --as-recorded is given. Timestamps are shifted to the current time; at twice the speed the simulation runs twice as fast.

Keys in a terminal during the replay: space pauses and resumes, . plays the time of one frame, left and right seek 5 s, + and -
double and halve the speed, 1 sets the recorded speed, m sets max, 0 seeks to the start, l toggles the loop, q ends. Commands in
OUT/control or stdin, one a line: pause, resume, toggle, step [S], seek [+|-]S, speed FACTOR|max, loop on|off, quit.

The results are those of tactus run for the live nodes: audio.wav, video.mp4, summary.json, ... and a log of the replay.

Exit status: as for tactus run."""


def main(words):
    if {"--help", "-h"} & set(words):
        return prepare.print_usage(USAGE)
    prepare.install_and_build()
    from tactus.launch import replay
    return replay.main(words)
