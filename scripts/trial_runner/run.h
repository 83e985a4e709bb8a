// trial_runner: runs the trials of a study on the bus, with JSON lines as commands and observations.
#pragma once

namespace tactus::trial_runner {

int run(int argc, char** argv);

}  // namespace tactus::trial_runner
