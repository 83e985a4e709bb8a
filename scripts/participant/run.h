// What the program does. A function, so that a virtual time can run it beside others in one process (sync/virtual_time).
#pragma once

namespace tactus::participant {

// Returns the exit status, after one sentence on stderr where that is not 0.
int run(int argc, char** argv);

}  // namespace tactus::participant
