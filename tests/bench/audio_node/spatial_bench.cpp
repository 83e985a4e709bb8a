// Share of one core that many binaural sources take in real time at 48 kHz: ours in blocks of 64 with each
// instruction set of this machine, and OpenAL Soft's loopback device with its own HRTF in blocks of 256,
// interleaved. Sources at rest, and sources that all circle the head once per second.
//
//    bin/spatial_bench [--json FILE]
#include <AL/al.h>
#include <AL/alc.h>
#include <AL/alext.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <stdexcept>
#include <vector>

#include "audio_node/spatial/spatialiser.h"
#include "sync/node/node_options.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

using namespace tactus::audio;

namespace {

constexpr int kRate_Hz = 48000;
constexpr int kRoundFrames = 4096;  // 85 ms of sound with each method, then the next method
constexpr int kRounds = 41;

std::vector<float> noise() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> even(-0.1f, 0.1f);
  std::vector<float> x(kRate_Hz);
  for (float& v : x) v = even(random);
  return x;
}

Eigen::Vector3f direction(int source, int sources, std::int64_t frame, bool circling) {
  const double turns =
      static_cast<double>(source) / sources + (circling ? static_cast<double>(frame) / kRate_Hz : 0);
  const double azimuth = 2 * std::numbers::pi * turns, height = 0.5 * std::sin(7.0 * source);
  return Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), height).normalized().cast<float>();
}

// Time of this thread; other programs are not counted.
double processor_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// Renders kRoundFrames.
using Round = std::function<void()>;

Round our_renderer(const Space& space, Instructions instructions, int sources, bool circling) {
  struct State {
    Spatialiser spatialiser;
    std::vector<SourcePosition> places;
    std::vector<float> sound = noise();
    std::int64_t frame = 0;
  };
  const auto s = std::make_shared<State>(State{Spatialiser(space, sources, kRate_Hz, instructions), {}});
  for (int i = 0; i < sources; ++i) {
    s->spatialiser.begin(i);
    s->places.push_back({direction(i, sources, 0, circling), 3});
  }
  return [=] {
    for (int done = 0; done < kRoundFrames; done += kMaxBlock, s->frame += kMaxBlock) {
      float out[2 * kMaxBlock] = {};
      for (int i = 0; i < sources; ++i) {
        const std::size_t at = static_cast<std::size_t>(s->frame + 97 * i) % (s->sound.size() - kMaxBlock);
        SourcePosition& place = s->places[static_cast<std::size_t>(i)];
        if (circling) place.direction = direction(i, sources, s->frame, true);
        s->spatialiser.add(i, place, s->sound.data() + at, kMaxBlock);
      }
      s->spatialiser.mix(out, kMaxBlock);
    }
  };
}

class OpenAl {
 public:
  OpenAl(int sources, bool circling) : circling_(circling), sources_(static_cast<std::size_t>(sources)) {
    const auto open =
        reinterpret_cast<LPALCLOOPBACKOPENDEVICESOFT>(alcGetProcAddress(nullptr, "alcLoopbackOpenDeviceSOFT"));
    render_ = reinterpret_cast<LPALCRENDERSAMPLESSOFT>(alcGetProcAddress(nullptr, "alcRenderSamplesSOFT"));
    if (!open || !render_ || !(device_ = open(nullptr)))
      throw std::runtime_error("OpenAL Soft has no loopback device");
    const ALCint attributes[] = {ALC_FORMAT_CHANNELS_SOFT,
                                 ALC_STEREO_SOFT,
                                 ALC_FORMAT_TYPE_SOFT,
                                 ALC_FLOAT_SOFT,
                                 ALC_FREQUENCY,
                                 kRate_Hz,
                                 ALC_MONO_SOURCES,
                                 256,
                                 ALC_HRTF_SOFT,
                                 ALC_TRUE,
                                 0};
    context_ = alcCreateContext(device_, attributes);
    alcMakeContextCurrent(context_);
    ALCint status = 0;
    alcGetIntegerv(device_, ALC_HRTF_STATUS_SOFT, 1, &status);
    if (status != ALC_HRTF_ENABLED_SOFT && status != ALC_HRTF_REQUIRED_SOFT)
      throw std::runtime_error("OpenAL Soft does not render binaural sound (HRTF) on this machine");
    const auto sound = noise();
    alGenBuffers(1, &buffer_);
    alBufferData(buffer_, AL_FORMAT_MONO_FLOAT32, sound.data(), static_cast<ALsizei>(4 * sound.size()), kRate_Hz);
    alGenSources(sources, sources_.data());
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      alSourcei(sources_[i], AL_BUFFER, static_cast<ALint>(buffer_));
      alSourcei(sources_[i], AL_LOOPING, AL_TRUE);
      alSourcei(sources_[i], AL_SAMPLE_OFFSET, static_cast<ALint>(97 * i));
      place_source(i);
      alSourcePlay(sources_[i]);
    }
    if (alGetError() != AL_NO_ERROR) throw std::runtime_error("OpenAL Soft cannot play this number of sources");
  }
  ~OpenAl() {
    alcMakeContextCurrent(nullptr);
    alcDestroyContext(context_);
    alcCloseDevice(device_);
  }
  OpenAl(const OpenAl&) = delete;
  OpenAl& operator=(const OpenAl&) = delete;

  void round() {
    alcMakeContextCurrent(context_);
    constexpr int kFrames = 256;
    float out[2 * kFrames];
    for (int done = 0; done < kRoundFrames; done += kFrames, frame_ += kFrames) {
      if (circling_)
        for (std::size_t i = 0; i < sources_.size(); ++i) place_source(i);
      render_(device_, out, kFrames);
    }
  }

 private:
  // OpenAL looks along -z, y up.
  void place_source(std::size_t i) {
    const Eigen::Vector3f d =
        3 * direction(static_cast<int>(i), static_cast<int>(sources_.size()), frame_, circling_);
    alSource3f(sources_[i], AL_POSITION, -d.y(), d.z(), -d.x());
  }
  LPALCRENDERSAMPLESSOFT render_ = nullptr;
  ALCdevice* device_ = nullptr;
  ALCcontext* context_ = nullptr;
  bool circling_;
  ALuint buffer_ = 0;
  std::vector<ALuint> sources_;
  std::int64_t frame_ = 0;
};

struct Variant {
  std::string name;
  Round round;
  std::vector<double> shares = {};
  double median() {
    std::sort(shares.begin(), shares.end());
    return shares[shares.size() / 2];
  }
};

}  // namespace

int main(int argc, char** argv) try {
  std::string json, file = "/usr/share/libmysofa/MIT_KEMAR_normal_pinna.sofa";
  tactus::sync::Arguments app{"Cost of many sources rendered with a measured HRTF."};
  app.add_option("--hrtf", file, "SOFA file");
  app.add_option("--json", json, "also writes the figures to this file");
  tactus::sync::parse_or_exit(app, "spatial_bench", argc, argv);
#if defined(__SSE__)
  _mm_setcsr(_mm_getcsr() | 0x8040);  // denormal numbers are 0, as in the callback
#endif
  const Space space{std::make_shared<const Hrtf>(load_sofa(file), kRate_Hz), nullptr};
  std::printf("%-8s %-9s %-12s %12s %12s\n", "sources", "", "way", "% of a core", "of OpenAL's");
  nlohmann::json rows = nlohmann::json::array();
  for (const bool circling : {false, true})
    for (const int sources : {32, 128}) {
      OpenAl open_al(sources, circling);
      std::vector<Variant> variants{{"OpenAL Soft", [&] { open_al.round(); }}};
      for (const Instructions i : available_instructions())
        variants.push_back({name(i), our_renderer(space, i, sources, circling)});
      for (int round = 0; round < kRounds; ++round)
        for (Variant& variant : variants) {
          const double begin_s = processor_s();
          variant.round();
          variant.shares.push_back(100 * (processor_s() - begin_s) * kRate_Hz / kRoundFrames);
        }
      const double theirs = variants[0].median();
      for (Variant& variant : variants) {
        const char* how = circling ? "circling" : "still";
        std::printf("%-8d %-9s %-12s %12.2f %12.2f\n", sources, how, variant.name.c_str(), variant.median(),
                    variant.median() / theirs);
        rows.push_back({{"sources", sources},
                        {"how", how},
                        {"way", variant.name},
                        {"percent", variant.median()},
                        {"of_openal", variant.median() / theirs}});
      }
    }
  if (!json.empty()) std::ofstream(json) << rows.dump(1) << "\n";
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "spatial_bench: %s\n", e.what());
  return 1;
}
