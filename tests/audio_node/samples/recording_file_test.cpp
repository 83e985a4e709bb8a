#include "audio_node/samples/recording_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "tests/audio_node/support/sounds.h"

using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

// The faults of a file; empty: none.
std::string faults_of(const std::string& path, Interaction interaction, bool* read = nullptr) {
  std::vector<SoundFault> faults;
  const auto r = read_recording(path, interaction, 48000, faults);
  if (read) *read = r.has_value();
  std::string all;
  for (const SoundFault& f : faults) {
    CHECK(f.path == path);
    all += f.what;
  }
  return all;
}

}  // namespace

TEST_CASE("WAV and FLAC files with one or two channels are read at any rate") {
  const SoundFolder folder;
  for (const std::string ending : {".wav", ".flac"})
    for (const int rate : {22050, 44100, 48000, 96000}) {
      CAPTURE(ending, rate);
      std::vector<float> stereo;
      for (const float s : tone(300, 0.3, 0.5, rate)) stereo.insert(stereo.end(), {s, s});
      folder.write("a" + ending, stereo, rate, 2);
      std::vector<SoundFault> faults;
      const auto r = read_recording(folder.path() + "/a" + ending, Interaction::kScrape, 48000, faults);
      REQUIRE(r);
      CHECK(faults.empty());
      // A root mean square of 0.5 / sqrt(2); in the seam of 50 of 300 ms two tones may add by their phases, to 3
      // dB.
      CHECK(r->rms == Approx(0.3536).epsilon(0.1));
      CHECK(r->samples.size() == Approx(0.25 * 48000).margin(4));
    }
}

TEST_CASE("A recorded blow begins with its first sample, without the silence before it") {
  const SoundFolder folder;
  std::vector<float> x(5000, 1e-5f);
  const auto ring = tone(500, 0.2, 0.5, 48000, 20);
  x.insert(x.end(), ring.begin(), ring.end());
  folder.write("a.wav", x);
  std::vector<SoundFault> faults;
  const auto r = read_recording(folder.path() + "/a.wav", Interaction::kImpact, 48000, faults);
  REQUIRE(r);
  CHECK(faults.empty());
  CHECK(r->samples.front() == 0.5f);
  CHECK(r->samples.size() == ring.size());
  CHECK(std::abs(r->samples.back()) < 1e-6f);  // it fades
}

TEST_CASE("A loop is continuous over its seam") {
  std::mt19937 random(3);
  std::normal_distribution<float> normal(0, 0.2f);
  std::vector<float> x(48000);
  float low = 0;
  // Noise through a low-pass: continuous from sample to sample, so that a jump would stand out.
  for (float& s : x) s = low += 0.05f * (normal(random) - low);
  float inside = 0;
  for (std::size_t n = 1; n < x.size(); ++n) inside = std::max(inside, std::abs(x[n] - x[n - 1]));
  const auto loop = close_loop(x, 48000);
  REQUIRE(loop.size() == 48000 - 2400);
  // At the seam one sample follows the other as in the recording; in the seam, two parts with gains that add up to
  // at most sqrt(2) and rotate by pi/2 in 2400 samples.
  CHECK(std::abs(loop.front() - loop.back()) <= inside * 1.001f);
  const float most =
      *std::max_element(x.begin(), x.end(), [](float a, float b) { return std::abs(a) < std::abs(b); });
  const float bound = std::sqrt(2.f) * inside + std::abs(most) * 1.4143f * 1.5708f / 2400;
  for (std::size_t n = 1; n < loop.size(); ++n) REQUIRE(std::abs(loop[n] - loop[n - 1]) <= bound);
}

TEST_CASE("A recording that cannot be played is rejected with a sentence that names the remedy") {
  const SoundFolder folder;
  const auto at = [&](const char* file) { return folder.path() + "/" + file; };
  folder.text("empty.wav", "");
  folder.text("text.wav", "This is a text, and no sound at all, though its name says so.\n");
  folder.write("ten.wav", std::vector<float>(48000, 0.1f), 48000, 10);
  folder.write("slow.wav", tone(100, 1, 0.5, 4000), 4000);
  folder.write("silent.wav", std::vector<float>(48000, 1e-4f));
  folder.write("click.wav", tone(4000, 0.005));
  folder.write("short.wav", tone(400, 0.2));
  auto nan = tone(400, 1);
  nan[100] = std::numeric_limits<float>::quiet_NaN();
  folder.write("nan.wav", nan);
  nan[100] = std::numeric_limits<float>::infinity();
  folder.write("inf.wav", nan);
  using Catch::Contains;
  CHECK_THAT(faults_of(at("missing.wav"), Interaction::kImpact), Contains("cannot be read"));
  CHECK_THAT(faults_of(at("empty.wav"), Interaction::kImpact), Contains("cannot be read"));
  CHECK_THAT(faults_of(at("text.wav"), Interaction::kImpact), Contains("cannot be read"));
  CHECK_THAT(faults_of(at("ten.wav"), Interaction::kImpact), Contains("10 channels"));
  CHECK_THAT(faults_of(at("slow.wav"), Interaction::kImpact), Contains("4000 samples per second"));
  CHECK_THAT(faults_of(at("silent.wav"), Interaction::kImpact), Contains("silent"));
  CHECK_THAT(faults_of(at("click.wav"), Interaction::kImpact), Contains("10 ms"));
  CHECK_THAT(faults_of(at("short.wav"), Interaction::kScrape), Contains("too short for a loop"));
  CHECK_THAT(faults_of(at("nan.wav"), Interaction::kRoll), Contains("invalid samples"));
  CHECK_THAT(faults_of(at("inf.wav"), Interaction::kRoll), Contains("invalid samples"));
  for (const char* file : {"empty.wav", "text.wav", "ten.wav", "slow.wav", "silent.wav", "nan.wav"}) {
    bool read = true;
    faults_of(at(file), Interaction::kImpact, &read);
    CHECK_FALSE(read);
  }
}

TEST_CASE("A clipped recording is played and reported") {
  const SoundFolder folder;
  auto x = tone(200, 0.5, 1.5);
  for (float& s : x) s = std::clamp(s, -1.f, 1.f);
  folder.write("a.wav", x);
  bool read = false;
  CHECK_THAT(faults_of(folder.path() + "/a.wav", Interaction::kImpact, &read), Catch::Contains("clipped"));
  CHECK(read);
}

TEST_CASE("A truncated recording is read as far as possible and reported") {
  const SoundFolder folder;
  for (const std::string name : {"a.wav", "a.flac"}) {
    CAPTURE(name);
    folder.write(name, tone(200, 1));
    CHECK(faults_of(folder.place(name), Interaction::kImpact).empty());
    std::filesystem::resize_file(folder.place(name), std::filesystem::file_size(folder.place(name)) / 2);
    bool read = false;
    CHECK_THAT(faults_of(folder.place(name), Interaction::kImpact, &read), Catch::Contains("shorter than its header states"));
    CHECK(read);
  }
}

TEST_CASE("A recording that is a pipe, a device or another format inside is rejected at once") {
  const SoundFolder folder;
  REQUIRE(mkfifo(folder.place("pipe.wav").c_str(), 0600) == 0);
  std::filesystem::create_symlink("/dev/zero", folder.place("zero.wav"));
  for (const char* name : {"pipe.wav", "zero.wav"})
    CHECK_THAT(faults_of(folder.place(name), Interaction::kImpact), Catch::Contains("not a regular file"));
  // An AU file, which libsndfile reads too.
  std::string au = std::string(".snd") + std::string("\0\0\0\x18\0\0\x4\0\0\0\0\x3\0\0\xbb\x80\0\0\0\x1", 20);
  folder.text("au.wav", au + std::string(1024, '\x20'));
  CHECK_THAT(faults_of(folder.place("au.wav"), Interaction::kImpact), Catch::Contains("neither WAV nor FLAC inside"));
}

TEST_CASE("A recording that is cut off or damaged is a recording without invalid samples, or a fault") {
  const SoundFolder folder;
  std::mt19937 random(9);
  for (const std::string name : {"a.wav", "a.flac"}) {
    CAPTURE(name);
    folder.write(name, tone(500, 0.02, 0.5, 48000, 20));
    std::ifstream in(folder.place(name), std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const auto check = [&](const std::string& bytes) {
      folder.text(name, bytes);
      std::vector<SoundFault> faults;
      const auto r = read_recording(folder.place(name), Interaction::kImpact, 48000, faults);
      REQUIRE((r || !faults.empty()));
      if (r) REQUIRE(std::all_of(r->samples.begin(), r->samples.end(), [](float x) { return std::isfinite(x); }));
    };
    for (std::size_t size = 0; size < whole.size(); size += size < 100 ? 1 : 37) check(whole.substr(0, size));
    for (int i = 0; i < 300; ++i) {
      std::string changed = whole;
      for (int k = 0; k <= i % 4; ++k) changed[random() % (i % 2 == 0 ? 64 : changed.size())] = static_cast<char>(random() % 4 == 0 ? 0xff : random());
      check(changed);
    }
  }
}
