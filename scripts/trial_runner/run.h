// conductor: runs the trials of a study on the bus, with JSON lines as commands and observations.
#pragma once

namespace tactus::conductor {

int run(int argc, char** argv);

}  // namespace tactus::conductor
