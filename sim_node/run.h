// Main function of the program, callable so that virtual time can run several programs in one process
// (sync/virtual_time).
#pragma once

namespace tactus::sim {

struct WorldDef;

// Returns the exit status; a status other than 0 follows one sentence on stderr. loaded_world: the content of the
// scene file of the command line if it is already loaded, as for many runs of one scene; null: the file is loaded.
int run(int argc, char** argv, const WorldDef* loaded_world = nullptr);

}  // namespace tactus::sim
