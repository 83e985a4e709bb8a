// The program renders a recorded run, without bus and card.

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <span>

#include "audio_node/modal/bank/ring.h"
#include "audio_node/spatial/onset.h"
#include "tests/audio_node/support/offline_program.h"
#include "tests/audio_node/support/recorded_run.h"
#include "tests/rendered_log.h"

using namespace tactus;
using namespace tactus::audio::test;

namespace {

constexpr double kRate = 48000, kDelay_s = 0.020;  // of settings.csv
constexpr int kHits = 40;

// Hits far enough apart to be distinguished, at random times. Returns them.
std::vector<double> record(const std::string& path, const std::string& profile = "") {
  RecordedRun run(std::make_unique<sync::FileSink>(path));
  if (!profile.empty())
    run.write_raw(0.01, channels::kDegradation,
            tactus::test::in_force(profile, {10'000'000, kLogBegins_ns + 10'000'000, 4711, 7, 9, 33, 0}));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> gap(0.25, 0.4);
  std::vector<double> times;
  double next = 0.5;
  for (int ms = 0; ms < 15'000; ++ms) {
    const double now = ms * 1e-3;
    if (static_cast<int>(times.size()) < kHits && now >= next) {
      const auto n = static_cast<int>(times.size());
      // The glass ball on the board rings for less than the gap.
      run.write_events(now, {RecordedRun::hit(1000 + n, next, 0, 2)});
      times.push_back(next);
      next += gap(random);
    }
    if (ms % 17 == 0) run.write_contacts(now, {});
  }
  run.finish();
  return times;
}

// Samples from the time of hit t plus its delay to its onset out of silence.
double onset_after(const std::vector<float>& wav, const std::string& message, double t) {
  const double start_s = static_cast<double>(first_sample_ns(message) - kLogBegins_ns) * 1e-9;
  const double due = (t + kDelay_s - start_s) * kRate;
  const auto begin = static_cast<std::size_t>(due - 0.02 * kRate),
             end = static_cast<std::size_t>(due + 0.02 * kRate);
  const std::size_t n = begin + audio::first_audible(std::span(wav).subspan(begin, end - begin));
  float before = 0, most = 0;
  for (std::size_t k = begin; k < n - 16; ++k) before = std::max(before, std::abs(wav[k]));
  for (std::size_t k = n; k < end; ++k) most = std::max(most, std::abs(wav[k]));
  CAPTURE(t, before, most);
  REQUIRE(most > 300 * before);
  return static_cast<double>(n) - due;
}

}  // namespace

TEST_CASE("A log rendered twice gives the same bytes, and each hit starts at its time plus the delay") {
  const Folder folder;
  const std::vector<double> times = record(folder.file("run.lcmlog"));
  const auto words = [&](const char* wav) {
    return std::vector<std::string>{"--log", folder.file("run.lcmlog"), "--wav", folder.file(wav),
                                    "--set", "instructions=sse2"};
  };
  const Done first = render(folder, words("a.wav")), again = render(folder, words("b.wav"));
  CAPTURE(first.message);
  REQUIRE(first.status == 0);
  REQUIRE(again.status == 0);
  const std::string a = bytes_of(folder.file("a.wav"));
  CHECK(a.size() > 15 * kRate * 8);
  CHECK(a == bytes_of(folder.file("b.wav")));

  auto by_a_pair = words("pair.wav");
  by_a_pair.insert(by_a_pair.end(), {"--set", "spatial=stereo"});
  const Done pair = render(folder, by_a_pair);
  REQUIRE(pair.status == 0);
  const std::vector<float> wav = mono_of(folder.file("a.wav")), plain = mono_of(folder.file("pair.wav"));
  for (const double t : times) {
    CAPTURE(t);
    // Rounded to a sample; a raised cosine reaches a fiftieth of the following signal some samples later.
    const double late = onset_after(plain, pair.message, t);
    CHECK(late > -1);
    CHECK(late < 8);
    // From one side ears may receive it earlier or later than the mean over all directions by this much
    // (spatialiser_test).
    CHECK(std::abs(onset_after(wav, first.message, t) - late) <= 8);
  }

  SECTION("other instructions give the same sound to a thousandth, but not the same bits") {
    auto other = words("c.wav");
    other.back() = "instructions=auto";
    REQUIRE(render(folder, other).status == 0);
    const std::vector<float> wide = mono_of(folder.file("c.wav"));
    REQUIRE(wide.size() == wav.size());
    double power = 0, difference = 0;
    for (std::size_t n = 0; n < wav.size(); ++n) {
      const auto x = static_cast<double>(wav[n]), d = static_cast<double>(wide[n]) - x;
      power += x * x, difference += d * d;
    }
    // Single-precision poles round alike in all of them; a fused multiply-add rounds once less, 6e-8 a sample,
    // which over 12,000 samples of ringing gives at most 7e-4 of phase.
    CHECK(std::sqrt(difference / power) < 1e-3);
  }
}

TEST_CASE("A profile is applied to the raw log, and the logged profile only on request") {
  const Folder folder;
  const std::string muted = R"(<profile name="muted"><degrade modality="audio" off="true"/></profile>)";
  const std::string late = R"(<profile name="late"><degrade modality="audio" delay="40ms" loss="50%"/></profile>)";
  record(folder.file("plain.lcmlog"));
  record(folder.file("muted.lcmlog"), muted);
  std::ofstream(folder.file("late.xml")) << late;
  const auto render_log = [&](const char* log, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"--log", folder.file(log), "--wav", folder.file("x.wav"),
                                   "--presented", folder.file("x.csv")};
    words.insert(words.end(), more.begin(), more.end());
    const Done done = render(folder, words);
    CAPTURE(done.message);
    REQUIRE(done.status == 0);
    return std::pair(bytes_of(folder.file("x.wav")), bytes_of(folder.file("x.csv")));
  };
  const auto plain = render_log("plain.lcmlog");
  CHECK((render_log("muted.lcmlog") == plain));
  const auto rows = tactus::test::cells_of(plain.second);
  REQUIRE(rows.size() == kHits);
  std::map<std::string, std::int64_t> at_ns;
  for (const auto& row : rows) {
    CHECK(row.at(6) == "presented");
    at_ns[row.at(1)] = std::stoll(row.at(4));
  }

  const auto logged = render_log("muted.lcmlog", {"--degrade", "logged"});
  CHECK(std::all_of(logged.first.end() - 48000 * 8 * 14, logged.first.end(), [](char c) { return c == 0; }));
  for (const char* log : {"plain.lcmlog", "muted.lcmlog"}) {
    const auto worse = render_log(log, {"--degrade", folder.file("late.xml")});
    int presented = 0, dropped = 0;
    for (const auto& row : tactus::test::cells_of(worse.second)) {
      dropped += row.at(6) == "dropped_by_profile";
      if (row.at(6) != "presented") continue;
      ++presented;
      // Each rounded to a sample.
      CHECK(std::abs(std::stoll(row.at(4)) - at_ns.at(row.at(1)) - 40'000'000) <= 21'000);
    }
    CHECK(presented + dropped == kHits);
    CHECK(presented > 5);
    CHECK(dropped > 5);
  }
}

TEST_CASE("A file that is not a log of a run is rejected with a sentence that names the remedy") {
  const Folder folder;
  const auto refusal = [&](const std::string& log) {
    const Done done = render(folder, {"--log", log, "--wav", folder.file("x.wav")});
    CHECK(done.status == 1);
    CHECK(std::count(done.message.begin(), done.message.end(), '\n') <= 2);  // one more, which names the node
    return done.message;
  };
  CHECK_THAT(refusal(folder.file("none.lcmlog")), Catch::Contains("cannot read"));
  std::ofstream(folder.file("empty.lcmlog"));
  CHECK_THAT(refusal(folder.file("empty.lcmlog")), Catch::Contains("not an LCM log"));
  std::ofstream(folder.file("text.lcmlog")) << "This is a letter, and no log.\n";
  CHECK_THAT(refusal(folder.file("text.lcmlog")), Catch::Contains("not an LCM log"));
  {
    sync::LogWriter foreign(std::make_unique<sync::FileSink>(folder.file("foreign.lcmlog")));
    const std::vector<std::uint8_t> data(40, 7);
    foreign.write(1, "ROBOT_STATE", data);
    foreign.flush();
  }
  CHECK_THAT(refusal(folder.file("foreign.lcmlog")), Catch::Contains("holds no message of Tactus") && Catch::Contains("scripts/run"));
  const Done no_wav = render(folder, {"--log", folder.file("foreign.lcmlog")});
  CHECK(no_wav.status == 1);
  CHECK_THAT(no_wav.message, Catch::Contains("--wav"));
}

TEST_CASE("A damaged log is rendered as far as it is intact, and the damage is counted") {
  const Folder folder;
  record(folder.file("run.lcmlog"));
  std::string bytes = bytes_of(folder.file("run.lcmlog"));
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 500; ++i) bytes[i] = 'x';
  bytes.resize(bytes.size() - 10);
  std::ofstream(folder.file("damaged.lcmlog"), std::ios::binary) << bytes;
  const Done done = render(folder, {"--log", folder.file("damaged.lcmlog"), "--wav", folder.file("a.wav")});
  CAPTURE(done.message);
  CHECK(done.status == 0);
  CHECK_THAT(done.message, Catch::Contains("2 regions"));
  CHECK(mono_of(folder.file("a.wav")).size() > 14 * kRate);
}

TEST_CASE("A log is not overwritten by its own sound under any name") {
  const Folder folder;
  record(folder.file("run.lcmlog"));
  std::filesystem::create_symlink(folder.file("run.lcmlog"), folder.file("sound.wav"));
  const std::string before = bytes_of(folder.file("run.lcmlog"));
  for (const char* wav : {"run.lcmlog", "sound.wav"}) {
    const Done done = render(folder, {"--log", folder.file("run.lcmlog"), "--wav", folder.file(wav)});
    CHECK(done.status == 1);
    CHECK_THAT(done.message, Catch::Contains("is the log itself"));
  }
  CHECK(bytes_of(folder.file("run.lcmlog")) == before);
}

TEST_CASE("A card that is too slow for its delay is reported with the number of dropped hits") {
  const Folder folder;
  record(folder.file("run.lcmlog"));
  const Done done = render(
      folder, {"--log", folder.file("run.lcmlog"), "--wav", folder.file("a.wav"), "--set", "period_frames=4096"});
  CAPTURE(done.message);
  CHECK(done.status == 0);
  CHECK_THAT(done.message, Catch::Contains("too slowly for the delay of sound"));
  CHECK_THAT(done.message, Catch::Contains("40 hits (40 of them dropped"));
}
