// Arbitrary bytes read as an HRTF (SOFA, which is HDF5): rejected with one sentence, or an HRTF with finite values. libmysofa itself is
// not instrumented.
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "audio_node/spatial/sofa.h"
#include "tests/fuzz/file_of.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const tactus::fuzz::FileOf file("ears.sofa");
  file.write(data, size);
  try {
    tactus::audio::parse_sofa(file.path());
  } catch (const std::runtime_error& e) {
    if (*e.what() == 0) std::abort();
  }
  return 0;
}
