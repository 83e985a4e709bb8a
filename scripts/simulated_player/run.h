// What the program does. A function, so that a virtual time can run it beside others in one process (sync/virtual_time).
#pragma once

namespace tactus::participant {

struct Rules;

// Returns the exit status, after one sentence on stderr where that is not 0. rules: of the scene of the command line, where that has
// been read already; null: it is read.
int run(int argc, char** argv, const Rules* rules = nullptr);

}  // namespace tactus::participant
