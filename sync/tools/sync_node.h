// The program sync_node, as a function, so that virtual time can run it together with other programs in one
// process.
#pragma once

namespace tactus::sync {

// Returns the exit status; when it is not 0, one sentence on stderr gives the reason.
int run_sync_node(int argc, char** argv);

}  // namespace tactus::sync
