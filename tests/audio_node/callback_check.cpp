// The callback of the real stream, on the virtual card, with everything trapped that it must not do.
#include <portaudio.h>

#include <dlfcn.h>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <random>
#include <thread>

#include "audio_node/device/stream.h"
#include "audio_node/impact.h"
#include "sync/pacing.h"
#include "tests/audio_node/bench.h"
#include "tests/audio_node/callback_trap.h"
#include "tests/audio_node/recorded_run.h"
#include "tests/audio_node/waves.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

// What PortAudio was to call.
PaStreamCallback* callback = nullptr;
void* of_callback = nullptr;
std::atomic<int> calls{0};

int call_trapped(const void* in, void* out, unsigned long frames, const PaStreamCallbackTimeInfo* time,
                 PaStreamCallbackFlags flags, void*) {
  // The first call asks for the thread's priority, once.
  if (calls.fetch_add(1) == 0) return callback(in, out, frames, time, flags, of_callback);
  const Trap trap;
  return callback(in, out, frames, time, flags, of_callback);
}

struct Folder {
  Folder() {
    char name[] = "/tmp/tactus_trap_XXXXXX";
    if (mkdtemp(name)) path = name;
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string path;
};

Scrape scrape(std::int64_t number, std::mt19937& random, const Relief* relief) {
  Scrape s;
  s.number = number;
  s.id = static_cast<std::int64_t>(random() % 24);  // more than are heard at a time
  s.at = sync::host_now();
  s.relief = relief;
  s.u_per_s = 50, s.along_u = 1, s.speed_m_s = 0.1, s.level = 0.05f;
  return s;
}

}  // namespace

// In front of PortAudio's own: the stream is opened with our callback around its.
extern "C" PaError Pa_OpenStream(PaStream** stream, const PaStreamParameters* in, const PaStreamParameters* out,
                                 double rate, unsigned long frames, PaStreamFlags flags, PaStreamCallback* call,
                                 void* user) {
  callback = call, of_callback = user, calls = 0;
  const auto real = reinterpret_cast<decltype(&Pa_OpenStream)>(dlsym(RTLD_NEXT, "Pa_OpenStream"));
  return real(stream, in, out, rate, frames, flags, call_trapped, user);
}

TEST_CASE("The trap catches what allocates, locks, waits and writes, and nothing of what happens outside of it") {
  const auto caught = [](auto f) {
    forget_trapped();
    {
      const Trap trap;
      f();
    }
    return first_trapped();
  };
  if (!traps_allocation()) {
    WARN("a sanitizer answers the allocator's calls: nothing is trapped");
    return;
  }
  CHECK(caught([] { delete new volatile int(1); }) == "malloc");
  CHECK(trapped() == 2);  // and free
  CHECK(caught([] { std::vector<double> v(1000, 1.0); }) == "malloc");
  std::mutex mutex;
  CHECK(caught([&] { const std::lock_guard lock(mutex); }) == "pthread_mutex_lock");
  CHECK_FALSE(caught([] { std::this_thread::sleep_for(std::chrono::microseconds(1)); }).empty());
  CHECK(caught([] { (void)!::write(-1, "", 0); }) == "write");
  CHECK_FALSE(caught([] { std::ifstream("/dev/null"); }).empty());
  CHECK_FALSE(caught([] { std::thread([] {}).join(); }).empty());
  CHECK(caught([] { (void)sync::host_now(); }).empty());  // the clock is read without a call of the system
  // Another thread may, meanwhile.
  CHECK(caught([] {}).empty());
  forget_trapped();
  std::vector<int> outside(1000, 1);
  CHECK(trapped() == 0);
}

TEST_CASE("The callback allocates nothing, takes no lock and does no I/O, whatever is asked of it") {
  if (!traps_allocation()) {
    WARN("a sanitizer answers the allocator's calls: nothing is trapped");
    return;
  }
  const Folder folder;
  const scene_t scene = struck_scene();
  const Impacts impacts(
      scene, [](std::int64_t) -> std::optional<Extent> { return std::nullopt; }, Settings{}, kRate, 1);
  const auto surfaces = wavy_surfaces();
  const Relief* relief = surfaces->by_material[0].relief.get();
  const int period = GENERATE(64, 256);
  CAPTURE(period);
  Crossing crossing;
  Renderer renderer(crossing, {.period_frames = period});
  std::mt19937 random(3);
  int reported = 0, steps = 0, struck = 0;
  forget_trapped();
  {
    StreamOptions options;
    options.device = "virtual", options.folder = folder.path, options.period_frames = period;
    Stream stream(options,
                  [&](float* out, int frames, const BlockTime& time) { renderer.render(out, frames, time); });
    for (int i = 0; i < 400; ++i) {
      // Some bodies that the scene has and many that it has not, in time, late and far too late.
      for (int k = 0; k < 3; ++k, ++struck) {
        const double early_s = std::uniform_real_distribution<double>(-0.05, 0.04)(random);
        Strike s = impacts.strike(RecordedRun::hit(struck, 0, 0, 1 + static_cast<int>(random() % 2)),
                                  sync::host_now() + sync::from_seconds(early_s));
        s.sides[1].voice += static_cast<std::int64_t>(random() % 100);
        crossing.strikes.push(s);
      }
      crossing.scrapes.push(scrape(i, random, random() % 3 ? relief : nullptr));
      if (i % 10 == 0)
        crossing.orders.push({{i % 40 < 20 ? 0.01 : 0.0, 0.05}, static_cast<int>(random() % 4) - 1}), ++steps;
      for (presentation_t r; crossing.reports.pop(r);) ++reported;
      while (stream.next_pair()) continue;
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    CHECK(stream.callbacks() > 100);
  }
  renderer.abandon();
  for (presentation_t r; crossing.reports.pop(r);) ++reported;
  CHECK(reported == struck);  // so all of that was rendered
  CHECK(steps == 40);
  CAPTURE(first_trapped());
  CHECK(trapped() == 0);
}

TEST_CASE("One allocation in one block of the real callback is caught") {
  if (!traps_allocation()) {
    WARN("a sanitizer answers the allocator's calls: nothing is trapped");
    return;
  }
  const Folder folder;
  forget_trapped();
  int blocks = 0;
  {
    StreamOptions options;
    options.device = "virtual", options.folder = folder.path;
    Stream stream(options, [&](float* out, int frames, const BlockTime&) {
      std::fill(out, out + 2 * frames, 0.f);
      if (++blocks == 20) delete new volatile int(blocks);
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
  REQUIRE(blocks > 20);
  CHECK(trapped() == 2);
  CHECK(first_trapped() == "malloc");
}

TEST_CASE("Neither does what keeps the samples of a real card") {
  if (!traps_allocation()) {
    WARN("a sanitizer answers the allocator's calls: nothing is trapped");
    return;
  }
  const Folder folder;
  Capture capture(folder.path + "/x.wav", 48000, 2, -1);
  const std::vector<float> block(2 * 128);
  forget_trapped();
  {
    const Trap trap;
    // Longer than what the ring holds: the disk cannot follow, and silence is owed.
    for (int i = 0; i < 3000; ++i) {
      capture.append(block.data(), 128);
      if (i % 100 == 0) capture.mark({capture.frames(), 0, MediaPair::kPeriodic, 0});
    }
  }
  CAPTURE(first_trapped());
  CHECK(trapped() == 0);
}
