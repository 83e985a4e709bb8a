#include "audio_node/samples/recording_file.h"

#include <sndfile.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "audio_node/samples/resample.h"
#include "sync/sandbox/regular_file.h"

namespace tactus::audio {
namespace {

constexpr double kMinBlow_s = 0.01;  // design: shorter is a click without material
constexpr double kMinLoop_s = 0.25;  // design: shorter is audible as a hum of its repetitions
constexpr float kOnset = 1e-3f;           // of the peak: a blow begins above it (design: -60 dB)
constexpr float kMinPeak = 1e-3f;          // of full scale: quieter is silence (design: -60 dBFS)
constexpr float kClippingLevel = 0.9995f;  // of full scale: kClippedSamples consecutive samples at this level are clipped (design)
constexpr int kClippedSamples = 4;
constexpr double kEnd_s = 0.005;  // fade at the end of a blow (design: shorter is audible as a click)
constexpr double kSeam_s = 0.05;  // of a loop, at most a quarter of it (design)

struct Close {
  void operator()(SNDFILE* file) const { sf_close(file); }
};

bool clipped(const std::vector<float>& x) {
  int in_a_row = 0;
  for (const float s : x)
    if (in_a_row = std::abs(s) >= kClippingLevel ? in_a_row + 1 : 0; in_a_row >= kClippedSamples) return true;
  return false;
}

// Size of a RIFF file by its header (IBM and Microsoft 1991, "Multimedia Programming Interface", chapter 2): 8 bytes and the 32 bits
// at byte 4, little-endian. 0: another format, or a size that a program could not know when it began to write, at or near the largest.
std::uint64_t declared_bytes(int descriptor) {
  std::array<unsigned char, 8> head{};
  if (pread(descriptor, head.data(), head.size(), 0) != static_cast<ssize_t>(head.size())) return 0;
  if (head[0] != 'R' || head[1] != 'I' || head[2] != 'F' || head[3] != 'F') return 0;
  const std::uint64_t size = head[4] | std::uint64_t{head[5]} << 8 | std::uint64_t{head[6]} << 16 | std::uint64_t{head[7]} << 24;
  return size < 0x7ffff000 ? size + 8 : 0;
}

float peak_of(const std::vector<float>& x) {
  float peak = 0;
  for (const float s : x) peak = std::max(peak, std::abs(s));
  return peak;
}

// error: a code of libsndfile.
const char* unreadable_reason(int error) {
  switch (error) {
    case SF_ERR_MALFORMED_FILE: return "its header is damaged";
    case SF_ERR_UNSUPPORTED_ENCODING: return "its samples are encoded in a way that is not supported";
    case SF_ERR_SYSTEM: return "the system refuses to read it";
    default: return "it is empty, cut off, or no sound";
  }
}

}  // namespace

std::vector<float> cut_blow(std::vector<float> x, double rate_Hz) {
  const float onset = kOnset * peak_of(x);
  const auto begin = std::find_if(x.begin(), x.end(), [&](float s) { return std::abs(s) > onset; });
  x.erase(x.begin(), begin);
  const auto fade = std::min(x.size(), static_cast<std::size_t>(kEnd_s * rate_Hz));
  for (std::size_t i = 0; i < fade; ++i) x[x.size() - 1 - i] *= static_cast<float>(i) / static_cast<float>(fade);
  return x;
}

std::vector<float> close_loop(std::vector<float> x, double rate_Hz) {
  const auto seam = std::min(x.size() / 4, static_cast<std::size_t>(kSeam_s * rate_Hz));
  const std::size_t length = x.size() - seam;
  // Both parts are uncorrelated noise: their powers add.
  for (std::size_t i = 0; i < seam; ++i) {
    const double angle = static_cast<double>(i) / static_cast<double>(seam) * std::numbers::pi / 2;
    x[i] = static_cast<float>(std::sin(angle)) * x[i] + static_cast<float>(std::cos(angle)) * x[length + i];
  }
  x.resize(length);
  return x;
}

std::optional<Recording> read_recording(const std::string& path, Interaction interaction, double rate_Hz,
                                        std::vector<SoundFault>& faults) {
  const auto reject = [&](const std::string& what) {
    faults.push_back({path, what, true});
    return std::nullopt;
  };
  SF_INFO info{};
  std::unique_ptr<SNDFILE, Close> file;
  bool truncated = false;
  try {
    sync::RegularFile regular(path, std::numeric_limits<std::uintmax_t>::max());
    const std::size_t bytes = regular.size_bytes();
    const int descriptor = regular.release();
    truncated = declared_bytes(descriptor) > bytes;
    file.reset(sf_open_fd(descriptor, SFM_READ, &info, SF_TRUE));  // closes the descriptor, also when it fails
  } catch (const std::runtime_error& e) {
    return reject("cannot be read as sound (" + std::string(e.what()) + "); give a WAV or FLAC");
  }
  if (!file) return reject(std::string("cannot be read as sound (") + unreadable_reason(sf_error(nullptr)) + "); give a WAV or FLAC");
  // libsndfile reads thirty formats and ignores the name of the file; fewer parsers have fewer errors.
  const int format = info.format & SF_FORMAT_TYPEMASK;
  if (format != SF_FORMAT_WAV && format != SF_FORMAT_WAVEX && format != SF_FORMAT_RF64 && format != SF_FORMAT_FLAC)
    return reject("is neither WAV nor FLAC inside; convert it or remove it");
  if (info.channels < 1 || info.channels > 2)
    return reject("has " + std::to_string(info.channels) + " channels; give one or two");
  if (info.samplerate < 8000 || info.samplerate > 192000)
    return reject("has " + std::to_string(info.samplerate) + " samples per second; give 8000 to 192000");
  const auto max_frames = static_cast<sf_count_t>(kMaxRecording_s * info.samplerate);
  if (info.frames > max_frames) faults.push_back({path, "is longer than 20 s; only the first 20 s are played; cut it", false});
  // Counts the frames that are read: a header may state any number.
  std::vector<float> x, block(4096 * static_cast<std::size_t>(info.channels));
  while (static_cast<sf_count_t>(x.size()) < max_frames) {
    const sf_count_t got = sf_readf_float(file.get(), block.data(), 4096);
    if (got <= 0) break;
    for (sf_count_t n = 0; n < got; ++n) {
      const float* frame = &block[static_cast<std::size_t>(n * info.channels)];
      x.push_back(info.channels == 1 ? frame[0] : 0.5f * (frame[0] + frame[1]));
    }
  }
  // libsndfile gives the largest number for a FLAC whose header states none.
  const bool states_length = info.frames < std::numeric_limits<sf_count_t>::max() / 2;
  truncated = truncated || (states_length && static_cast<sf_count_t>(x.size()) < std::min(info.frames, max_frames));
  if (truncated) faults.push_back({path, "is shorter than its header states; only the part that is there is played; copy it again", false});
  if (!std::all_of(x.begin(), x.end(), [](float s) { return std::abs(s) <= kMaxSample; }))
    return reject("has invalid samples (NaN, infinite, or far beyond full scale); record it again");
  if (peak_of(x) < kMinPeak) return reject("is silent; record it louder or remove it");
  if (clipped(x)) faults.push_back({path, "is clipped; record it with less gain", false});
  const bool blow = interaction == Interaction::kImpact;
  x = resample(x, info.samplerate, rate_Hz);
  if (peak_of(x) < kMinPeak) return reject("has no audible sound at the rate of the card; record it again or remove it");
  x = blow ? cut_blow(std::move(x), rate_Hz) : std::move(x);
  const double length_s = static_cast<double>(x.size()) / rate_Hz;
  if (blow && length_s < kMinBlow_s) return reject("is shorter than 10 ms; give the whole sound of the blow");
  if (!blow && length_s < kMinLoop_s)
    return reject("is shorter than 0.25 s, too short for a loop; give a second or more");
  Recording r{blow ? std::move(x) : close_loop(std::move(x), rate_Hz), 0, 0};
  r.peak = peak_of(r.samples);
  double power = 0;
  for (const float s : r.samples) power += static_cast<double>(s * s);
  r.rms = static_cast<float>(std::sqrt(power / static_cast<double>(r.samples.size())));
  return r;
}

}  // namespace tactus::audio
