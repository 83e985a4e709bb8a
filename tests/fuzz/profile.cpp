// Arbitrary text read as a degradation profile: rejected with one sentence, or a profile whose text parses to the same profile again.
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "sync/degradation/profile.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tactus::sync;
  const std::string xml(reinterpret_cast<const char*>(data), size);
  try {
    const auto profile = parse_profile(xml, "fuzz.xml");
    const auto again = parse_profile(xml, "fuzz.xml");
    if (again.rules.size() != profile.rules.size() || again.seed != profile.seed) std::abort();
  } catch (const std::invalid_argument& e) {
    const std::string said = e.what();
    if (said.empty() || said.find("fuzz.xml") != 0) std::abort();
  }
  return 0;
}
