#include "audio_node/samples/recording_reader.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "tests/audio_node/support/sounds.h"

using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

std::string text(const std::vector<SoundFault>& faults) {
  std::string all;
  for (const SoundFault& f : faults) all += f.path + " " + f.what + (f.unusable ? " unusable\n" : "\n");
  return all;
}

}  // namespace

TEST_CASE("The confined reader of recordings returns the same bits and faults as the reader in this process") {
  const SoundFolder folder;
  folder.write("blow.wav", tone(500, 0.3, 0.5, 48000, 20));
  folder.write("blow.flac", tone(500, 0.3, 0.5, 44100, 20), 44100);
  folder.write("silent.wav", std::vector<float>(48000, 1e-4f));
  folder.write("ten.wav", std::vector<float>(48000, 0.1f), 48000, 10);
  folder.text("text.wav", "This is a text.\n");
  folder.text("empty.wav", "");
  auto loud = tone(200, 0.5, 1.5);
  for (float& s : loud) s = std::clamp(s, -1.f, 1.f);
  folder.write("clipped.wav", loud);
  folder.write("long.wav", std::vector<float>(25 * 8000, 0.2f), 8000);
  folder.write("cut.wav", tone(200, 1));
  std::filesystem::resize_file(folder.path() + "/cut.wav", 100000);
  RecordingReader confined(folder.path(), 48000);
  for (const char* name : {"blow.wav", "blow.flac", "silent.wav", "ten.wav", "text.wav", "empty.wav", "clipped.wav", "long.wav", "cut.wav"})
    for (const Interaction interaction : kInteractions) {
      CAPTURE(name, static_cast<int>(interaction));
      std::vector<SoundFault> direct_faults, confined_faults;
      const auto a = read_recording(folder.place(name), interaction, 48000, direct_faults);
      const auto b = confined.read(folder.place(name), interaction, confined_faults);
      REQUIRE(a.has_value() == b.has_value());
      CHECK(text(direct_faults) == text(confined_faults));
      if (!a) continue;
      CHECK(a->samples == b->samples);
      CHECK(a->peak == b->peak);
      CHECK(a->rms == b->rms);
    }
}

TEST_CASE("A recording that is a link out of its folder, or hidden, is not opened") {
  const SoundFolder folder, other;
  other.write("a.wav", tone(500, 0.3));
  std::filesystem::create_symlink(other.place("a.wav"), folder.place("link.wav"));
  folder.write(".hidden.wav", tone(500, 0.3));
  folder.write("b.wav", tone(500, 0.3));
  std::filesystem::create_symlink(folder.place("b.wav"), folder.place("inside.wav"));
  RecordingReader confined(folder.path(), 48000);
  std::vector<SoundFault> faults;
  CHECK_FALSE(confined.read(folder.place("link.wav"), Interaction::kImpact, faults));
  CHECK_FALSE(confined.read(folder.place(".hidden.wav"), Interaction::kImpact, faults));
  REQUIRE(faults.size() == 2);
  for (const SoundFault& fault : faults) CHECK(fault.what == "is hidden, or a link that leads out of the folder; put the file itself there");
  CHECK(confined.read(folder.place("inside.wav"), Interaction::kImpact, faults));
  CHECK(faults.size() == 2);
}

TEST_CASE("An answer of a reader that is no valid sound is rejected") {
  const ReadSound good{Recording{std::vector<float>(100, 0.5f), 0.5f, 0.5f}, {{"", "is clipped", false}}};
  const std::vector<std::uint8_t> whole = pack(good);
  const ReadSound read = unpack_sound(whole, 48000);
  REQUIRE(read.recording);
  CHECK(read.recording->samples == good.recording->samples);
  CHECK(text(read.faults) == text(good.faults));
  for (std::size_t size = 0; size < whole.size(); ++size)
    CHECK_THROWS_AS(unpack_sound(std::span(whole).first(size), 48000), std::runtime_error);
  CHECK_THROWS_WITH(unpack_sound(pack(ReadSound{}), 48000), "its reader returned nothing");
  const auto rejected = [&](auto change) {
    ReadSound changed = good;
    change(*changed.recording);
    CHECK_THROWS_WITH(unpack_sound(pack(changed), 48000), "its reader returned no valid sound");
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
  for (const float x : {kNan, kInf, -kInf, 100.f}) {
    rejected([&](Recording& r) { r.samples[50] = x; });
    rejected([&](Recording& r) { r.peak = x; });
    rejected([&](Recording& r) { r.rms = x; });
  }
  rejected([](Recording& r) { r.samples.clear(); });
  rejected([](Recording& r) { r.samples.assign(48000 * 22, 0.5f); });
  rejected([](Recording& r) { r.peak = 0; });
  ReadSound hostile = good;
  hostile.recording.reset();
  hostile.faults.assign(1000, {"", std::string("a\x1b[2J\n") + std::string(1000, 'x'), true});
  const ReadSound bounded = unpack_sound(pack(hostile), 48000);
  CHECK(bounded.faults.size() == 8);
  for (const SoundFault& fault : bounded.faults) {
    CHECK(fault.what.size() <= 400);
    CHECK(std::none_of(fault.what.begin(), fault.what.end(), [](unsigned char c) { return c < 0x20; }));
  }
}
