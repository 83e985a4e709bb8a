// The callback of the real stream, on the virtual card, with a trap for every forbidden operation.
#include <portaudio.h>

#include <dlfcn.h>
#include <poll.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdio.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/select.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <random>
#include <tactus/presentation_t.hpp>
#include <tactus/scene_t.hpp>
#include <thread>

#include "audio_node/devices/stream.h"
#include "audio_node/excitation/impact.h"
#include "audio_node/spatial/space_of.h"
#include "sync/clocks/pacing.h"
#include "tests/audio_node/support/bench.h"
#include "tests/audio_node/support/callback_trap.h"
#include "tests/audio_node/support/recorded_run.h"
#include "tests/audio_node/support/waves.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

// The callback that PortAudio would call.
PaStreamCallback* callback = nullptr;
void* of_callback = nullptr;
std::atomic<int> calls{0};

int call_trapped(const void* in, void* out, unsigned long frames, const PaStreamCallbackTimeInfo* time,
                 PaStreamCallbackFlags flags, void*) {
  // The first call sets the priority of the thread.
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

Scrape scrape(std::int64_t number, std::mt19937& random, const AudioSurface* surface, const Strike& of) {
  Scrape s;
  s.number = number;
  s.id = static_cast<std::int64_t>(random() % 24);  // more than are audible at a time
  s.at = sync::host_now();
  s.slide = s.roll = 1e-4f, s.cutoff_Hz = 1000;
  s.place = of.sides[1].place;
  ScrapeSide& side = s.sides[0];
  side.voice = of.sides[1].voice, side.resonators = *of.sides[1].resonators, side.gains = of.sides[1].gains;
  side.known = true;
  side.residual_gain = 0.1f, side.residual_Hz = 5000;
  if (surface) side.relief = surface->relief.get(), side.friction = surface->friction.get();
  side.roughness = {1e-6, 0};
  side.velocity_m_s.x() = 0.1, side.slide_vector.x() = 1, side.roll_vector.y() = 1;
  return s;
}

// Recordings of a blow and of a loop at two speeds.
struct Recordings {
  Layers blow, loop;
  Recordings() {
    Recording r;
    for (int i = 0; i < 24000; ++i) r.samples.push_back(0.3f * std::sin(0.05f * static_cast<float>(i)));
    r.peak = 0.3f, r.rms = 0.2f;
    blow.by_speed = {{0.5, 1, {r}}};
    loop.by_speed = {{0.1, 1, {r}}, {0.5, 1, {r}}};
  }
  void add_to(Strike& strike, std::int64_t database) const {
    strike.recorded.database = database;
    strike.recorded.shots[0] = {&blow.by_speed[0].takes[0], 0.1f, 1.3f};
    strike.recorded.place = strike.sides[0].place;
  }
  RecordedContact contact(std::int64_t database, std::mt19937& random) const {
    RecordedContact r;
    r.contact = static_cast<std::int64_t>(random() % 40);
    r.database = database, r.at = sync::host_now(), r.layers = &loop;
    r.speed_m_s = 0.1 + 0.01 * static_cast<double>(random() % 50), r.level = 0.05f;
    return r;
  }
};

// Ears, the loudspeakers of a cube (a card of eight channels), and a stereo pair.
Space space_for(const std::string& spatial) {
  Settings settings;
  settings.spatial = spatial, settings.layout_file = "cube";
  return space_of(settings, kRate);
}

}  // namespace

// Replaces PortAudio's function: the stream is opened with our callback around the original one.
extern "C" PaError Pa_OpenStream(PaStream** stream, const PaStreamParameters* in, const PaStreamParameters* out,
                                 double rate, unsigned long frames, PaStreamFlags flags, PaStreamCallback* call,
                                 void* user) {
  callback = call, of_callback = user, calls = 0;
  const auto real = reinterpret_cast<decltype(&Pa_OpenStream)>(dlsym(RTLD_NEXT, "Pa_OpenStream"));
  return real(stream, in, out, rate, frames, flags, call_trapped, user);
}

TEST_CASE("The trap counts allocations, locks, waits and I/O, and only while it is armed") {
  const auto caught = [](auto f) {
    reset_trapped();
    {
      const Trap trap;
      f();
    }
    return first_trapped();
  };
  if (!traps_allocation()) {
    WARN("skipped: a sanitizer replaces the allocator, so the trap counts nothing");
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
  CHECK(caught([] { (void)sync::host_now(); }).empty());  // the clock is read without a system call
  // Another thread may do so at the same time.
  CHECK(caught([] {}).empty());
  reset_trapped();
  std::vector<int> outside(1000, 1);
  CHECK(trapped() == 0);
}

TEST_CASE("The trap counts each call that waits, maps memory or does I/O, and passes the call on") {
  if (!traps_allocation()) {
    WARN("skipped: a sanitizer replaces the allocator, so the trap counts nothing");
    return;
  }
  int pipe_ends[2];
  REQUIRE(pipe(pipe_ends) == 0);
  const int events = epoll_create1(0), in = pipe_ends[0], out = pipe_ends[1];
  REQUIRE(events >= 0);
  FILE* const file = fmemopen(nullptr, 16, "w+");
  REQUIRE(file);
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  sem_t semaphore;
  REQUIRE(sem_init(&semaphore, 0, 1) == 0);
  const timespec past{1, 0}, none{0, 0};
  const size_t page = 4096;
  void* mapped = nullptr;
  char byte = 'x';
  pollfd fd{in, POLLIN, 0};
  fd_set set;
  FD_ZERO(&set);
  timeval at_once{0, 0};
  epoll_event event{};
  int waiting = -1;
  pthread_mutex_lock(&mutex);  // the timeouts of the waits for a condition have expired
  struct Call {
    const char* name;
    std::function<bool()> does;  // true: the result is the same as without the trap
  };
  const std::vector<Call> calls{
      {"poll", [&] { return poll(&fd, 1, 0) == 0; }},
      {"ppoll", [&] { return ppoll(&fd, 1, &none, nullptr) == 0; }},
      {"select", [&] { return select(0, &set, nullptr, nullptr, &at_once) == 0; }},
      {"pselect", [&] { return pselect(0, &set, nullptr, nullptr, &none, nullptr) == 0; }},
      {"epoll_wait", [&] { return epoll_wait(events, &event, 1, 0) == 0; }},
      {"epoll_pwait", [&] { return epoll_pwait(events, &event, 1, 0, nullptr) == 0; }},
      {"pthread_cond_timedwait", [&] { return pthread_cond_timedwait(&condition, &mutex, &past) == ETIMEDOUT; }},
      {"pthread_cond_clockwait",
       [&] { return pthread_cond_clockwait(&condition, &mutex, CLOCK_MONOTONIC, &none) == ETIMEDOUT; }},
      {"sem_wait", [&] { return sem_wait(&semaphore) == 0; }},
      {"sem_timedwait", [&] { return sem_timedwait(&semaphore, &past) == -1 && errno == ETIMEDOUT; }},
      {"mmap",
       [&] {
         mapped = mmap(nullptr, page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
         return mapped != MAP_FAILED;
       }},
      {"munmap", [&] { return munmap(mapped, page) == 0; }},
      {"write", [&] { return ::write(out, &byte, 1) == 1; }},
      {"ioctl", [&] { return ioctl(in, FIONREAD, &waiting) == 0 && waiting == 1; }},
      {"read", [&] { return ::read(in, &byte, 1) == 1; }},
      {"fwrite", [&] { return fwrite(&byte, 1, 1, file) == 1; }},
      {"fread", [&] { return fread(&byte, 1, 1, file) == 0; }}};
  for (const Call& call : calls) {
    CAPTURE(call.name);
    reset_trapped();
    bool right = false;
    {
      const Trap trap;
      right = call.does();
    }
    CHECK(right);
    CHECK(first_trapped() == call.name);
  }
  pthread_mutex_unlock(&mutex);
  sem_destroy(&semaphore);
  fclose(file);
  for (const int open_fd : {events, in, out}) ::close(open_fd);
  reset_trapped();
}

TEST_CASE("The trap counts a wait for a condition that another thread ends") {
  if (!traps_allocation()) {
    WARN("skipped: a sanitizer replaces the allocator, so the trap counts nothing");
    return;
  }
  pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
  pthread_cond_t condition = PTHREAD_COND_INITIALIZER;
  bool woken = false;
  pthread_mutex_lock(&mutex);
  std::thread waker([&] {
    pthread_mutex_lock(&mutex);
    woken = true;
    pthread_cond_signal(&condition);
    pthread_mutex_unlock(&mutex);
  });
  reset_trapped();
  {
    const Trap trap;
    while (!woken) pthread_cond_wait(&condition, &mutex);
  }
  waker.join();
  CHECK(first_trapped() == "pthread_cond_wait");
  pthread_mutex_unlock(&mutex);
  reset_trapped();
}

TEST_CASE("The callback allocates nothing, takes no lock and does no I/O for any input") {
  if (!traps_allocation()) {
    WARN("skipped: a sanitizer replaces the allocator, so the trap counts nothing");
    return;
  }
  const Folder folder;
  const scene_t scene = struck_scene();
  const Impacts impacts(
      scene, [](std::int64_t) -> std::optional<Extent> { return std::nullopt; }, Settings{}, kRate, 1);
  const auto surfaces = wavy_surfaces();
  const Recordings recordings;
  const auto [period, spatial] =
      GENERATE(std::pair(64, "hrtf"), std::pair(256, "loudspeakers"), std::pair(128, "stereo"));
  CAPTURE(period, spatial);
  CallbackQueues queues;
  RendererDef def;
  def.period_frames = period, def.space = space_for(spatial);
  def.clock_ns = [] { return sync::to_ns(sync::host_now()); };
  Renderer renderer(queues, def);
  std::mt19937 random(3);
  int reported = 0, steps = 0, struck = 0;
  std::int64_t database = 0;
  reset_trapped();
  {
    StreamOptions options;
    options.device = "virtual", options.folder = folder.path, options.period_frames = period;
    options.channels = renderer.channels();
    Stream stream(options,
                  [&](float* out, int frames, const BlockTime& time) { renderer.render(out, frames, time); });
    for (int i = 0; i < 400; ++i) {
      // Some bodies of the scene and many that it lacks, in time, late and far too late.
      for (int k = 0; k < 3; ++k, ++struck) {
        const double early_s = std::uniform_real_distribution<double>(-0.05, 0.04)(random);
        Strike s = impacts.strike(RecordedRun::hit(struck, 0, 0, 1 + static_cast<int>(random() % 2)),
                                  sync::host_now() + sync::from_seconds(early_s));
        s.sides[1].voice += static_cast<std::int64_t>(random() % 100);
        if (k == 0) recordings.add_to(s, database);
        queues.strikes.push(s);
        if (k == 1)
          queues.scrapes.push(scrape(i, random, random() % 3 ? &surfaces->by_material[0] : nullptr, s));
      }
      // The head turns, and the database changes from time to time.
      Listener listener;
      listener.T_W_listener.rotate(Eigen::AngleAxisd(0.1 * static_cast<double>(i), Eigen::Vector3d::UnitZ()));
      listener.nearest_m = 0.3f;
      queues.listeners.push(listener);
      if (i % 50 == 0) queues.recorded.databases.push(++database);
      queues.recorded.contacts.push(recordings.contact(database, random));
      if (i % 10 == 0)
        queues.commands.push({{i % 40 < 20 ? 0.01 : 0.0, 0.05}, static_cast<int>(random() % 4) - 1}), ++steps;
      for (presentation_t r; queues.reports.pop(r);) ++reported;
      while (stream.next_pair()) continue;
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    CHECK(stream.callbacks() > 100);
  }
  renderer.abandon();
  for (presentation_t r; queues.reports.pop(r);) ++reported;
  CHECK(reported == struck);  // shows that all of it was rendered
  CHECK(steps == 40);
  CAPTURE(first_trapped());
  CHECK(trapped() == 0);
}

TEST_CASE("The trap counts a single allocation in one block of the stream callback") {
  if (!traps_allocation()) {
    WARN("skipped: a sanitizer replaces the allocator, so the trap counts nothing");
    return;
  }
  const Folder folder;
  reset_trapped();
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

TEST_CASE("The capture of a real card allocates nothing, takes no lock and does no I/O") {
  if (!traps_allocation()) {
    WARN("skipped: a sanitizer replaces the allocator, so the trap counts nothing");
    return;
  }
  const Folder folder;
  Capture capture(folder.path + "/x.wav", 48000, 2, -1);
  const std::vector<float> block(2 * 128);
  reset_trapped();
  {
    const Trap trap;
    // Longer than the ring: the disk cannot follow, and silence is pending.
    for (int i = 0; i < 3000; ++i) {
      capture.append(block.data(), 128);
      if (i % 100 == 0) capture.mark({capture.frames(), 0, MediaPair::kPeriodic, 0});
    }
  }
  CAPTURE(first_trapped());
  CHECK(trapped() == 0);
}
