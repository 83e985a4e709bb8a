#include "audio_node/samples/recording_reader.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace tactus::audio {
namespace {

// More than read_recording finds in one file.
constexpr std::size_t kMaxFaults = 8;

std::vector<std::string> arguments(const sync::ReadableFolders& readable) {
  std::vector<std::string> words{"recordings"};
  for (const auto& folder : readable.folders()) words.push_back(folder.string());
  return words;
}

bool valid(const Recording& r, double rate_Hz) {
  // read_recording reads whole blocks of 4096 frames, which are half a second at 8 kHz.
  const auto max_samples = static_cast<std::size_t>((kMaxRecording_s + 1) * rate_Hz);
  const auto plausible = [](float x) { return std::abs(x) <= 4 * kMaxSample; };  // a seam and resampling add; false for NaN
  return !r.samples.empty() && r.samples.size() <= max_samples && plausible(r.peak) && r.peak > 0 && plausible(r.rms) && r.rms > 0 &&
         std::all_of(r.samples.begin(), r.samples.end(), plausible);
}

}  // namespace

std::vector<std::uint8_t> pack(const ReadSound& sound) {
  sync::Packer to;
  to.put(static_cast<std::uint8_t>(sound.recording.has_value()));
  if (sound.recording) to.put(sound.recording->peak), to.put(sound.recording->rms), to.put_list(sound.recording->samples);
  to.put(static_cast<std::uint64_t>(sound.faults.size()));
  for (const SoundFault& fault : sound.faults) to.put(static_cast<std::uint8_t>(fault.unusable)), to.put_list(fault.what);
  return to.take();
}

ReadSound unpack_sound(std::span<const std::uint8_t> answer, double rate_Hz) {
  sync::Unpacker from(answer);
  ReadSound sound;
  if (from.get<std::uint8_t>() != 0) {
    Recording& r = sound.recording.emplace();
    r.peak = from.get<float>(), r.rms = from.get<float>(), r.samples = from.get_list<std::vector<float>>();
    if (!valid(r, rate_Hz)) throw std::runtime_error("its reader returned no valid sound");
  }
  const std::size_t faults = std::min(from.get_count(9), kMaxFaults);
  for (std::size_t i = 0; i < faults; ++i) {
    const bool unusable = from.get<std::uint8_t>() != 0;
    const std::string what = from.get_list<std::string>();
    sound.faults.push_back({"", sync::text_of({'E', {what.begin(), what.end()}}), unusable});
  }
  if (!sound.recording && sound.faults.empty()) throw std::runtime_error("its reader returned nothing");
  return sound;
}

std::vector<std::uint8_t> answer_request(std::span<const std::uint8_t> request) {
  sync::Unpacker from(request);
  const double rate_Hz = from.get<double>();
  const auto interaction = from.get<Interaction>();
  const std::string path = from.get_list<std::string>();
  ReadSound sound;
  sound.recording = read_recording(path, interaction, rate_Hz, sound.faults);
  return pack(sound);
}

RecordingReader::RecordingReader(const std::string& folder, double rate_Hz)
    : readable_({folder}), session_("read_sounds", arguments(readable_)), rate_Hz_(rate_Hz) {}

std::optional<Recording> RecordingReader::read(const std::string& path, Interaction interaction, std::vector<SoundFault>& faults) {
  const auto reject = [&](const std::string& what) {
    faults.push_back({path, what, true});
    return std::nullopt;
  };
  const auto real = readable_.resolve(path);
  if (!real) return reject("is hidden, or a link that leads out of the folder; put the file itself there");
  try {
    sync::Packer request;
    request.put(rate_Hz_), request.put(interaction), request.put_list(real->string());
    ReadSound sound = unpack_sound(session_.request(request.take()), rate_Hz_);
    for (SoundFault& fault : sound.faults) faults.push_back({path, std::move(fault.what), fault.unusable});
    return std::move(sound.recording);
  } catch (const std::runtime_error& e) {
    return reject("cannot be read as sound (" + std::string(e.what()) + "); give another WAV or FLAC");
  }
}

}  // namespace tactus::audio
