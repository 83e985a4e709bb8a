// The program recorder, as a function, so that virtual time can run it beside other programs in one process.
#pragma once

namespace tactus::sync {

// Returns the exit status, after one sentence on stderr where that is not 0.
int run_recorder(int argc, char** argv);

}  // namespace tactus::sync
