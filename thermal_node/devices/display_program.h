// The program thermal_device as a function, so that virtual time can run it together with other nodes in one
// process.
#pragma once

namespace tactus::thermal {

// Returns the exit status; prints one sentence on stderr when it is not 0.
int run_display(int argc, char** argv);

}  // namespace tactus::thermal
