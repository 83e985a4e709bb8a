// conductor: leads the trials of a study on the bus, as whoever started it says, a line of JSON each way.
#pragma once

namespace tactus::conductor {

int run(int argc, char** argv);

}  // namespace tactus::conductor
