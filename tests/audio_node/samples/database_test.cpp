#include "audio_node/samples/database.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "tests/audio_node/support/sounds.h"

using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

Database read(const SoundFolder& folder) { return read_database(folder.path(), 48000, 0.05); }

}  // namespace

TEST_CASE("A pair is found in either order of its materials and of its folder name") {
  const SoundFolder folder;
  folder.write("steel-oak/impact/1.wav", tone(500, 0.2));
  const Database d = read(folder);
  CHECK(d.faults.empty());
  const Layers* pair = d.find("oak", "steel", Interaction::kImpact).pair;
  REQUIRE(pair);
  CHECK(d.find("steel", "oak", Interaction::kImpact).pair == pair);
  CHECK_FALSE(d.find("steel", "oak", Interaction::kScrape).any());
}

TEST_CASE("Without recordings of a pair those of each material are found, otherwise none") {
  const SoundFolder folder;
  folder.write("oak-steel/impact/1.wav", tone(500, 0.2));
  folder.write("oak/impact/1.wav", tone(300, 0.2));
  folder.write("glass-glass/impact/1.wav", tone(900, 0.2));
  const Database d = read(folder);
  CHECK(d.faults.empty());
  CHECK(d.find("oak", "steel", Interaction::kImpact).pair);
  const auto both = d.find("glass", "oak", Interaction::kImpact);
  CHECK_FALSE(both.pair);
  CHECK(both.alone[0]);  // glass on itself is glass alone
  CHECK(both.alone[1]);
  const auto one = d.find("rubber", "oak", Interaction::kImpact);
  CHECK_FALSE(one.alone[0]);
  CHECK(one.alone[1] == both.alone[1]);
  // On itself: once, not twice.
  const auto itself = d.find("oak", "oak", Interaction::kImpact);
  CHECK(itself.alone[0]);
  CHECK_FALSE(itself.alone[1]);
  CHECK_FALSE(d.find("rubber", "foam", Interaction::kImpact).any());
  CHECK_FALSE(d.find("", "", Interaction::kImpact).any());
}

TEST_CASE("Layers are sorted by speed, takes of one speed stay together, and all layers are equally loud") {
  const SoundFolder folder;
  folder.write("oak/impact/2.wav", tone(500, 0.2, 0.8));
  folder.write("oak/impact/0.25.wav", tone(500, 0.2, 0.2));
  folder.write("oak/impact/0.25_2.flac", tone(500, 0.2, 0.1));
  folder.text("oak/size.txt", "0.12\n");
  const Database d = read(folder);
  CHECK(d.faults.empty());
  const Layers* l = d.find("oak", "oak", Interaction::kImpact).alone[0];
  REQUIRE(l);
  REQUIRE(l->by_speed.size() == 2);
  CHECK(l->size_m == 0.12);
  CHECK(l->by_speed[0].speed_m_s == 0.25);
  CHECK(l->by_speed[0].takes.size() == 2);
  CHECK(l->by_speed[0].gain == Approx(4));  // of its loudest take
  CHECK(l->by_speed[1].gain == 1);
}

TEST_CASE("Faults of a folder of recordings are listed, and the rest is played") {
  const SoundFolder folder;
  folder.write("oak/impact/1.wav", tone(500, 0.2));
  folder.write("oak/impact/fast.wav", tone(500, 0.2));
  folder.text("oak/impact/2.wav", "");
  folder.text("oak/impact/notes.doc", "words");
  folder.write("oak/bounce/1.wav", tone(500, 0.2));
  folder.write("a-b-c/impact/1.wav", tone(500, 0.2));
  folder.write("steel-oak/impact/1.wav", tone(500, 0.2));
  folder.write("oak-steel/impact/1.wav", tone(500, 0.2));
  folder.write("lost.wav", tone(500, 0.2));
  folder.text("oak/size.txt", GENERATE("large", "5 cm", "0.05 0.1", ""));
  std::filesystem::create_directories(folder.path() + "/oak/roll");
  // Opening it would block for ever.
  REQUIRE(mkfifo((folder.path() + "/oak/impact/4.wav").c_str(), 0600) == 0);
  const Database d = read(folder);
  CHECK(d.find("oak", "oak", Interaction::kImpact).any());
  const auto named = [&](const std::string& end, const std::string& what) {
    for (const SoundFault& f : d.faults)
      if (f.path.ends_with(end) && f.what.find(what) != std::string::npos) return true;
    return false;
  };
  CHECK(named("oak/impact/fast.wav", "speed"));
  CHECK(named("oak/impact/2.wav", "cannot be read"));
  CHECK(named("oak/impact/notes.doc", "neither WAV nor FLAC"));
  CHECK(named("oak/bounce", "impact, scrape and roll"));
  CHECK(named("a-b-c", "not named after a material"));
  CHECK(named("steel-oak/impact", "twice"));
  CHECK(named("lost.wav", "outside"));
  CHECK(named("oak/size.txt", "no size"));
  CHECK(named("oak/roll", "empty"));
  CHECK(named("oak/impact/4.wav", "not a file"));
  CHECK(d.faults.size() == 10);
}

TEST_CASE("Excess speeds are listed as a fault, and the gain of a faint layer is limited") {
  const SoundFolder folder;
  for (int i = 1; i <= kMaxLayers + 2; ++i)
    folder.write("oak/scrape/0." + std::to_string(10 + i) + ".wav", tone(500, 0.5));
  folder.write("steel/scrape/0.1.wav", tone(500, 0.5, 1e-3));
  folder.write("steel/scrape/1.wav", tone(500, 0.5, 0.9));
  const Database d = read(folder);
  const Layers* many = d.find("oak", "oak", Interaction::kScrape).alone[0];
  REQUIRE(many);
  CHECK(many->by_speed.size() == static_cast<std::size_t>(kMaxLayers));
  REQUIRE(d.faults.size() == 1);
  CHECK_THAT(d.faults[0].what, Catch::Contains("8 speeds"));
  const Layers* faint = d.find("steel", "steel", Interaction::kScrape).alone[0];
  REQUIRE(faint);
  CHECK(faint->by_speed[0].gain == 100);
}

TEST_CASE("An empty or missing folder of recordings is listed as a fault") {
  const SoundFolder folder;
  REQUIRE(read(folder).faults.size() == 1);
  CHECK_THAT(read(folder).faults[0].what, Catch::Contains("no playable recording"));
  const Database none = read_database(folder.path() + "/none", 48000, 0.05);
  REQUIRE(none.faults.size() == 1);
  CHECK_THAT(none.faults[0].what, Catch::Contains("not a folder"));
  CHECK_FALSE(none.find("oak", "oak", Interaction::kImpact).any());
}
