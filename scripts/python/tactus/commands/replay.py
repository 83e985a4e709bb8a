"""Installs what is missing, builds, and plays the log of a run to live renderers."""
from tactus.commands import prepare

USAGE = """Usage: tactus replay LOG [option]...

Plays a log to the senses, each in a process of its own, as scripts/run does with a scene: they render it anew, live.

  LOG                    run.lcmlog of a run, or its folder: all parts of its recording; damaged ones are played as far as
                         they are whole
  --speed FACTOR         0.01 to 100 times as fast as it was; max: as fast as --most lets it; default: 1
  --start S, --end S     from and until this second of the world; default: all of it
  --loop                 begins anew at its end
  --paused               waits for an order before it begins
  --only NODE            only this sense is live; may be repeated
  --without NODE         this sense is not; may be repeated. Nodes: haptic_node audio_node visual_node thermal_node sync_node
  --degrade PROFILE.xml  another profile than the recorded one; --as-recorded: that one; default: none
  --channels REGEX       only channels that match as a whole; --leave-out REGEX: not these; --also REGEX: these too, which
                         would stay in the log
  --rename FROM=TO       another name for a channel; may be repeated
  --most N               messages a second, at any speed; default: 16000
  --set, --seed, --device, --policy, --soa, --base, --budget, --aligner, --window, --listen, --realtime, --network, --port, --out
                         as of scripts/run
  --stay                 does not end at the end of the log
  --help                 this text

What the world said goes out, and what those senses said that are not live now. Their measurements, the clocks, commands and
decisions of the recorded run stay in the log, and the log's own profile too, unless told --as-recorded: they would be mistaken
for the live ones. Times are made those of now; at twice the speed the world runs twice as fast.

While it runs, in a terminal: blank pauses and goes on, . plays one picture's time, left and right seek 5 s, + and - double and
halve the speed, 1 is the speed it was, m is max, 0 goes to the beginning, l loops, q ends. From elsewhere, a line each, into
OUT/control or stdin: pause, resume, toggle, step [S], seek [+|-]S, speed FACTOR|max, loop on|off, quit.

The results are those of scripts/run, of the live senses: audio.wav, video.mp4, summary.json, ... and a log of the replay.

Exit status: as of scripts/run."""


def main(words):
    if {"--help", "-h"} & set(words):
        return prepare.show(USAGE)
    prepare.install_and_build()
    from tactus.launch import replay
    return replay.main(words)
