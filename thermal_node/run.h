// The program as a function, so that virtual time can run it together with other nodes in one process
// (sync/virtual_time).
#pragma once

namespace tactus::thermal {

// Returns the exit status; prints one sentence on stderr when it is not 0.
int run(int argc, char** argv);

}  // namespace tactus::thermal
