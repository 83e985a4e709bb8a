#include "audio_node/spatial/sofa.h"

#include <mysofa.h>
#include <sys/stat.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "tests/audio_node/support/kemar.h"
#include "tests/audio_node/support/sounds.h"

using namespace tactus::audio;
using namespace tactus::audio::test;
using Catch::Contains;

namespace {

std::string why(const std::string& path) {
  try {
    load_sofa(path);
    return "";
  } catch (const std::runtime_error& e) {
    return e.what();
  }
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// A valid set of four directions, with a response of eight samples for each ear.
struct Set {
  std::vector<float> ir = std::vector<float>(4 * 2 * 8, 0.5f), delay{0, 0}, source = std::vector<float>(12, 1.f),
                     receiver{0, 0.09f, 0, 0, -0.09f, 0}, rate{48000}, listener{0, 0, 0}, view{1, 0, 0}, up{0, 0, 1}, emitter{0, 0, 0};
  unsigned M = 4, R = 2, C = 3, N = 8;

  std::string fault() {
    MYSOFA_HRTF file{};
    file.M = M, file.R = R, file.C = C, file.N = N, file.I = file.E = 1;
    const auto point = [](MYSOFA_ARRAY& array, std::vector<float>& values) {
      array.values = values.empty() ? nullptr : values.data();
      array.elements = static_cast<unsigned>(values.size());
    };
    point(file.DataIR, ir), point(file.DataDelay, delay), point(file.SourcePosition, source);
    point(file.ReceiverPosition, receiver), point(file.DataSamplingRate, rate);
    point(file.ListenerPosition, listener), point(file.ListenerView, view), point(file.ListenerUp, up), point(file.EmitterPosition, emitter);
    return array_fault(file);
  }
};

}  // namespace

TEST_CASE("The confined reader of measured ears returns the same bits as the parser") {
  const MeasuredHrtf direct = parse_sofa(kKemar), confined = load_sofa(kKemar);
  CHECK(direct.rate_Hz == confined.rate_Hz);
  CHECK(direct.samples == confined.samples);
  CHECK(direct.directions == confined.directions);
  CHECK(direct.responses == confined.responses);
  CHECK(direct.delays == confined.delays);
}

TEST_CASE("Measured ears without one of their arrays are rejected with one sentence") {
  const SoundFolder folder;
  const std::string whole = bytes_of(kKemar);
  for (const std::string name : {"Data.Delay", "Data.IR", "SourcePosition", "ReceiverPosition", "Data.SamplingRate"}) {
    CAPTURE(name);
    std::string without = whole;
    // The array gets another name, which nothing reads.
    for (auto at = without.find(name); at != std::string::npos; at = without.find(name, at + 1)) without[at] = 'X';
    const std::string file = folder.place("ears.sofa");
    std::ofstream(file, std::ios::binary) << without;
    const std::string said = why(file);
    CHECK_THAT(said, Catch::StartsWith("the HRTF file " + file + " ") && Catch::EndsWith("; choose another hrtf_file"));
    CHECK(said.find('\n') == std::string::npos);
  }
}

TEST_CASE("Arrays of measured ears that are shorter than their dimensions are found before they are used") {
  CHECK(Set{}.fault() == "");
  const auto broken = [](auto change) {
    Set set;
    change(set);
    return set.fault();
  };
  CHECK_THAT(broken([](Set& s) { s.ir.clear(); }), Contains("Data.IR"));
  CHECK_THAT(broken([](Set& s) { s.ir.pop_back(); }), Contains("Data.IR"));
  CHECK_THAT(broken([](Set& s) { s.N = 9; }), Contains("Data.IR"));
  CHECK_THAT(broken([](Set& s) { s.delay.clear(); }), Contains("Data.Delay"));
  CHECK_THAT(broken([](Set& s) { s.delay.resize(3); }), Contains("Data.Delay"));
  CHECK(broken([](Set& s) { s.delay.resize(8); }) == "");
  CHECK_THAT(broken([](Set& s) { s.source.pop_back(); }), Contains("SourcePosition"));
  CHECK_THAT(broken([](Set& s) { s.receiver.pop_back(); }), Contains("ReceiverPosition"));
  CHECK_THAT(broken([](Set& s) { s.rate.clear(); }), Contains("SamplingRate"));
  // All positions are converted in steps of three values.
  for (const std::size_t count : {1u, 2u, 4u, 14u})
    for (std::vector<float> Set::*array : {&Set::listener, &Set::view, &Set::up, &Set::emitter, &Set::source, &Set::receiver})
      CHECK(broken([&](Set& s) { (s.*array).resize(count + 12 * (array == &Set::source)); }) != "");
  for (const float rate : {0.f, -48000.f, 1e9f, std::nanf(""), std::numeric_limits<float>::infinity()})
    CHECK_THAT(broken([&](Set& s) { s.rate = {rate}; }), Contains("sampling rate"));
  for (const unsigned huge : {32'769u, 0x80000000u, 0xffffffffu}) CHECK(broken([&](Set& s) { s.M = huge; }) != "");
  for (const unsigned huge : {65'537u, 0x80000000u, 0xffffffffu}) CHECK(broken([&](Set& s) { s.N = huge; }) != "");
  for (const unsigned few : {0u, 3u}) CHECK(broken([&](Set& s) { s.M = few; }) != "");
  // Any dimensions: without a fault, every array is long enough.
  std::mt19937 random(5);
  int valid = 0;
  for (int i = 0; i < 20'000; ++i) {
    Set s;
    const auto some = [&](unsigned usual) { return random() % 3 == 0 ? static_cast<unsigned>(random() % 12) : usual; };
    s.M = some(4), s.N = some(8), s.R = some(2);
    s.ir.resize(some(64)), s.delay.resize(some(2)), s.source.resize(some(12)), s.receiver.resize(some(6));
    if (!s.fault().empty()) continue;
    ++valid;
    REQUIRE(s.ir.size() >= std::size_t{2} * s.M * s.N);
    REQUIRE(s.source.size() >= std::size_t{3} * s.M);
    REQUIRE((s.delay.size() == 2 || s.delay.size() == std::size_t{2} * s.M));
    REQUIRE(s.receiver.size() >= 6);
  }
  CHECK(valid > 100);
}

TEST_CASE("Measured ears in a pipe, a device or a folder are rejected at once") {
  const SoundFolder folder;
  REQUIRE(mkfifo(folder.place("pipe").c_str(), 0600) == 0);
  for (const std::string& path : {folder.place("pipe"), std::string("/dev/zero"), folder.path()})
    CHECK_THAT(why(path), Contains(path) && Contains("not a regular file"));
  CHECK_THAT(why(folder.path() + "/none"), Contains("does not exist"));
}

TEST_CASE("Damaged measured ears are valid ears or one sentence") {
  const SoundFolder folder;
  const std::string whole = bytes_of(kKemar), file = folder.place("ears.sofa");
  std::mt19937 random(11);
  for (int i = 0; i < 60; ++i) {
    std::string damaged = whole;
    // Most structure lies at the beginning and at the end; the middle is compressed responses.
    const std::size_t range = i % 3 == 0 ? damaged.size() : std::min<std::size_t>(damaged.size(), 20'000);
    for (int k = 0; k < 1 + i % 8; ++k) {
      const std::size_t from = i % 2 == 0 ? 0 : damaged.size() - range;
      damaged[from + random() % range] = static_cast<char>(i % 5 == 0 ? 0xff : random());
    }
    if (i % 10 == 9) damaged.resize(random() % damaged.size());
    std::ofstream(file, std::ios::binary) << damaged;
    const std::string said = why(file);
    INFO(i << ": " << said);
    CHECK((said.empty() || (said.starts_with("the HRTF file ") && said.find('\n') == std::string::npos)));
  }
}

TEST_CASE("A result of the reader that contradicts itself is rejected") {
  MeasuredHrtf measured;
  measured.rate_Hz = 48000, measured.samples = 2;
  measured.directions.assign(4, {1, 0, 0});
  measured.responses.assign(16, 0.5f), measured.delays.assign(8, 0);
  CHECK(unpack_hrtf(pack(measured)).responses == measured.responses);
  const auto rejects = [&](auto change) {
    MeasuredHrtf other = measured;
    change(other);
    CHECK_THROWS_AS(unpack_hrtf(pack(other)), std::runtime_error);
  };
  rejects([](MeasuredHrtf& m) { m.samples = 3; });
  rejects([](MeasuredHrtf& m) { m.samples = -2; });
  rejects([](MeasuredHrtf& m) { m.directions.pop_back(); });
  rejects([](MeasuredHrtf& m) { m.responses.back() = std::nanf(""); });
  rejects([](MeasuredHrtf& m) { m.rate_Hz = std::numeric_limits<double>::infinity(); });
}
