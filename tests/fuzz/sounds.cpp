// Arbitrary bytes as a recording: rejected with one sentence, or samples that are finite and within full scale.
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "audio_node/samples/recording_file.h"
#include "tests/fuzz/file_of.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const tactus::fuzz::FileOf file("0.1.wav");
  file.write(data, size);
  std::vector<tactus::audio::SoundFault> faults;
  const auto recording = tactus::audio::read_recording(file.path(), tactus::audio::Interaction::kImpact, 48000, faults);
  for (const auto& fault : faults)
    if (fault.what.empty()) std::abort();
  if (!recording && faults.empty()) std::abort();
  for (const float sample : recording ? recording->samples : std::vector<float>{})
    if (!(std::abs(sample) <= 2 * tactus::audio::kMaxSample)) std::abort();
  return 0;
}
