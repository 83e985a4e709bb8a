// The program simulated_player, as a function, so that virtual time can run it beside other programs in one process
// (sync/virtual_time).
#pragma once

namespace tactus::simulated_player {

struct Rules;

// Returns the exit status, after one sentence on stderr where that is not 0. rules: of the command line's scene, when they
// have been read already; null: they are read from the scene.
int run(int argc, char** argv, const Rules* rules = nullptr);

}  // namespace tactus::simulated_player
