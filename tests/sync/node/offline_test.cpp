// Tests of rendering a log offline: profiles, ticks, progress and output files.
#include "sync/bus/bus.h"
#include "sync/node/offline.h"
#include "sync/node/run_renderer.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <tactus/degradation_t.hpp>
#include <tactus/log_info_t.hpp>
#include <tactus/presentation_t.hpp>

#include "tests/sync/support/memory_sink.h"

using namespace tactus;
using namespace tactus::sync;
using Catch::Contains;

namespace {

constexpr std::int64_t kBegin_ns = 5'000'000'000, kOffset_ns = 1'700'000'000'000'000'000;
constexpr double kRate_Hz = 100;

struct Folder {
  Folder() {
    char name[] = "/tmp/tactus_offline_XXXXXX";
    if (mkdtemp(name)) path = name;
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name) const { return path + "/" + name; }
  std::string path;
};

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A log of 0.1 s with two profiles and no other messages.
std::string log_in(const Folder& folder) {
  LogWriter writer(std::make_unique<FileSink>(folder.file("run.lcmlog")));
  const auto write = [&](const char* channel, const auto& m, std::int64_t after_us) {
    writer.write((kBegin_ns + kOffset_ns) / 1000 + after_us, channel, encode(m));
  };
  log_info_t info{};
  info.header = header_of("recorder", 1, 0, kBegin_ns, 77);
  info.header.clock = 4711;
  info.realtime_offset_ns = kOffset_ns;
  write(channels::kLogInfo, info, 0);
  for (int i = 0; i < 2; ++i) {
    degradation_t m{};
    m.header = header_of("sync_node", 5, i, kBegin_ns, 77);
    m.pages = 1;
    write(channels::kDegradation, m, 100'000 * i);
  }
  writer.flush();
  return folder.file("run.lcmlog");
}

OfflineOptions of(const std::string& log) {
  OfflineOptions options;
  options.log = log;
  return options;
}

// Number of profiles that a node with these options receives.
int profiles_heard(const std::string& log, NodeOptions options, bool as_recorded = false) {
  OfflineOptions of_log = of(log);
  of_log.as_recorded = as_recorded;
  OfflineInput offline(of_log, {}, kRate_Hz, HostTime{});
  offline.adapt(options);
  CHECK(options.run_id == 77);
  CHECK(options.bus.memory);
  CHECK(options.realtime == "off");
  Bus bus(Identity::fresh("audio_node", options.run_id), options.bus);
  auto& heard = bus.queue<degradation_t>(channels::kDegradation, 8);
  while (!offline.over()) offline.next(bus);
  int n = 0;
  while (heard.pop()) ++n;
  return n;
}

}  // namespace

TEST_CASE("The profiles in a log apply only with --degrade logged, and then no other does") {
  const Folder folder;
  const std::string log = log_in(folder);
  NodeOptions none, own, logged;
  own.degrade = "own.xml", logged.degrade = "logged";
  CHECK(profiles_heard(log, none) == 0);
  CHECK(profiles_heard(log, own) == 0);
  CHECK(profiles_heard(log, logged) == 2);
  CHECK(profiles_heard(log, none, true) == 2);

  SECTION("the profile of the scene does not apply either") {
    OfflineInput offline(of(log), {}, kRate_Hz, HostTime{});
    offline.adapt(none);
    CHECK(none.profile.text == "<profile/>");
    offline.adapt(own);
    CHECK(own.degrade == "own.xml");
    CHECK(own.profile.text.empty());
    offline.adapt(logged);
    CHECK(logged.degrade.empty());
    CHECK(logged.profile.text.empty());
  }
}

TEST_CASE("A rendering that stops early leaves no file, a complete one leaves complete files") {
  const Folder folder;
  OfflineOptions options = of(log_in(folder));
  options.presented = folder.file("p.csv");
  presentation_t report{};
  report.event_id = 4, report.presented_ns = 9, report.scheduled_ns = 8;
  for (const bool stopped : {true, false}) {
    {
      OfflineInput offline(options, {}, kRate_Hz, HostTime{});
      Bus bus(Identity::fresh("audio_node", 77), offline.feed().bus());
      offline.record_outcome("audio", report);
      offline.next(bus);
      if (stopped) CHECK_THROWS_WITH(offline.finish(1, HostTime{}), Contains("stopped before"));
      while (!stopped && !offline.over()) offline.next(bus);
      if (!stopped)
        CHECK_THAT(offline.finish(1, host_time(500'000'000)), Contains("0.5 s (2 times as fast as real time)"));
    }
    CHECK(std::filesystem::exists(options.presented) != stopped);
    CHECK_FALSE(std::filesystem::exists(options.presented + ".part"));
  }
  CHECK_THAT(text_of(options.presented), Contains("audio,4,whole,8,9,0,presented,1\n"));
}

TEST_CASE("An output path that is the log itself is rejected, also through a link, as is another tick rate") {
  const Folder folder;
  const std::string log = log_in(folder), before = text_of(log);
  std::filesystem::create_symlink(log, folder.file("link.csv"));
  for (const std::string& path : {log, folder.file("link.csv")}) {
    CHECK_THROWS_WITH(OfflineInput(of(log), {{path, "--trace"}}, kRate_Hz, HostTime{}),
                      Contains("is the log itself") && Contains("--trace"));
    OfflineOptions options = of(log);
    options.presented = path;
    CHECK_THROWS_WITH(OfflineInput(options, {}, kRate_Hz, HostTime{}), Contains("--presented"));
  }
  CHECK(text_of(log) == before);
  const OfflineInput offline(of(log), {}, kRate_Hz, HostTime{});
  CHECK_NOTHROW(offline.require_rate(kRate_Hz));
  CHECK_THROWS_WITH(offline.require_rate(50), Contains("--set rate=50"));
}

TEST_CASE("The progress of a rendering is reported once a second") {
  const Folder folder;
  OfflineInput offline(of(log_in(folder)), {}, kRate_Hz, HostTime{});
  Bus bus(Identity::fresh("audio_node", 77), offline.feed().bus());
  CHECK(offline.progress(host_time(900'000'000)) == std::nullopt);
  for (int i = 0; i < 6; ++i) offline.next(bus);  // ticks at 0, 10, ... 50 ms
  CHECK(offline.progress(host_time(1'100'000'000)) == "50 % of the log");
  CHECK(offline.progress(host_time(1'200'000'000)) == std::nullopt);
  SECTION("a rendering with an earlier end is complete there") {
    offline.end_at(offline.now());
    CHECK(offline.over());
    CHECK_NOTHROW(offline.finish(1, HostTime{}));
  }
}

TEST_CASE("A file gets its final name only when it is complete") {
  const Folder folder;
  const std::string path = folder.file("a.csv");
  {
    AtomicFile file(path, "--trace");
    file.write("x,y\n");
    CHECK_FALSE(std::filesystem::exists(path));
    CHECK_THROWS_WITH(AtomicFile(path, "--trace"), Contains("another program is writing"));
  }
  CHECK_FALSE(std::filesystem::exists(path + ".part"));
  const std::string much(200'000, 'z');
  AtomicFile file(path, "--trace");
  file.write("x,y\n");
  file.write(much);
  file.finish();
  CHECK((text_of(path) == "x,y\n" + much));
  CHECK_FALSE(std::filesystem::exists(path + ".part"));

  SECTION("the error for a file names its option or asks for disk space") {
    CHECK_THROWS_WITH(AtomicFile(folder.file("no/b.csv"), "--trace"), Contains("choose another --trace"));
    AtomicFile full("/dev/full", "--trace");
    full.write("x");
    CHECK_THROWS_WITH(full.finish(), Contains("free disk space"));
  }
}

namespace {

// A node that renders a log to nothing, and that may not be made.
class CheckedFactory : public RendererFactory {
 public:
  void add_options(Arguments& app) override { options_.add_to(app, "renders a log", "--presented"); }
  OfflineInput* prepare(const NodeOptions&) override {
    input_ = std::make_unique<OfflineInput>(options_, std::vector<OfflineInput::Written>{}, kRate_Hz, host_time(0));
    return input_.get();
  }
  std::unique_ptr<Renderer> make(RendererHost&) override { throw std::runtime_error("a check makes no renderer"); }

 private:
  OfflineOptions options_;
  std::unique_ptr<OfflineInput> input_;
};

int checked(std::vector<std::string> words) {
  words.insert(words.begin(), "test_node");
  words.push_back("--check");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  CheckedFactory factory;
  return run_renderer({.name = "test_node", .modality = "test", .rate_Hz = kRate_Hz, .about = "A test."}, factory,
                      static_cast<int>(argv.size()), argv.data());
}

}  // namespace

TEST_CASE("A check of a node with a log leaves no file, and a missing file is an error") {
  const Folder folder;
  const std::string log = log_in(folder);
  CHECK(checked({"--log", log, "--presented", folder.file("out.csv")}) == 0);
  CHECK_FALSE(std::filesystem::exists(folder.file("out.csv")));
  CHECK_FALSE(std::filesystem::exists(folder.file("out.csv.part")));
  CHECK(checked({"--log", folder.file("missing.lcmlog"), "--presented", folder.file("out.csv")}) == 1);
  CHECK(checked({"--log", log, "--presented", folder.file("none/out.csv")}) == 1);
  CHECK(checked({"--log", log, "--presented", folder.file("out.csv"), "--degrade", folder.file("missing.xml")}) == 1);
  CHECK_FALSE(std::filesystem::exists(folder.file("out.csv.part")));
}
