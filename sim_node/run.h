// What the program does. A function, so that a virtual time can run it beside others in one process (sync/virtual_time).
#pragma once

namespace tactus::sim {

struct WorldDef;

// Returns the exit status, after one sentence on stderr where that is not 0. world: what the file of the command line holds, where
// that has been read already, as for many runs of one scene; null: it is read.
int run(int argc, char** argv, const WorldDef* world = nullptr);

}  // namespace tactus::sim
