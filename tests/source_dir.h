// The folder of the sources, for the data that tests read. A function, so that only one object depends on the path of the clone.
#pragma once

#include <string>

namespace tactus {

std::string source_dir();

}  // namespace tactus
