// Arbitrary bytes as the only recording in a folder: skipped with one sentence, or samples that are finite and within full scale.
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "audio_node/samples/database.h"
#include "tests/fuzz/file_of.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const tactus::fuzz::FileOf file("oak-steel/impact/0.1.wav");
  file.write(data, size);
  const auto database = tactus::audio::read_database(file.folder(), 48000, 0.1);
  for (const auto& fault : database.faults)
    if (fault.what.empty()) std::abort();
  return 0;
}
