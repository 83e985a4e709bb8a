// Main function of the program, callable so that virtual time can run several programs in one process
// (sync/virtual_time).
#pragma once

namespace tactus::visual {

// Returns the exit status; a status other than 0 follows one sentence on stderr.
int run(int argc, char** argv);

}  // namespace tactus::visual
