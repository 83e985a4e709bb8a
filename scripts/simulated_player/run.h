// The program simulated_player, as a function, so that virtual time can run it together with other programs in one process
// (sync/virtual_time).
#pragma once

namespace tactus::simulated_player {

struct Rules;

// Returns the exit status; when it is not 0, one sentence on stderr gives the reason. rules: the rules of the scene on the
// command line, if they have already been read; null: reads them from the scene.
int run(int argc, char** argv, const Rules* rules = nullptr);

}  // namespace tactus::simulated_player
