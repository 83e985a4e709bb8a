#include <signal.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>
#include <tactus/media_clock_t.hpp>

#include "visual_node/video/encoder.h"
#include "visual_node/video/i420.h"
#include "visual_node/video/recording.h"
#include "visual_node/video/slots.h"

using namespace tactus;
using namespace tactus::visual;

namespace {
struct Folder {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("tactus_video_test." + std::to_string(getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
};
}  // namespace

TEST_CASE("A video has one picture per period and repeats a missed one") {
  std::mt19937 random(17);
  for (int trial = 0; trial < 200; ++trial) {
    SlotFiller slots;
    std::vector<std::int64_t> file;  // tick of the picture in each slot
    const std::int64_t first = static_cast<std::int64_t>(random() % 1000);
    std::int64_t tick = first;
    for (int i = 0; i < 300; ++i) {
      if (const auto repeats = slots.repeats_before(tick)) {
        for (std::int64_t k = 0; k < *repeats; ++k) file.push_back(file.back());
        file.push_back(tick);
      }
      if (i < 299) tick += random() % 10 == 0 ? 1 + static_cast<std::int64_t>(random() % 130) : 1;
    }
    REQUIRE(static_cast<std::int64_t>(file.size()) == tick - first + 1);
    CHECK(slots.written() == tick - first + 1);
    for (std::size_t slot = 0; slot < file.size(); ++slot) {
      CHECK(file[slot] <= first + static_cast<std::int64_t>(slot));
      if (slot > 0) CHECK((file[slot] == file[slot - 1] || file[slot] == first + static_cast<std::int64_t>(slot)));
    }
  }
}

TEST_CASE("A filled period is not filled again") {
  SlotFiller slots;
  CHECK(slots.repeats_before(10) == 0);
  CHECK_FALSE(slots.repeats_before(10));
  CHECK_FALSE(slots.repeats_before(9));
  CHECK(slots.repeats_before(12) == 1);
}

TEST_CASE("The clock of a video is published for every frame") {
  SlotClock clock;
  const auto start = clock.frame(100);
  CHECK(start.index == 0);
  CHECK(start.reason == media_clock_t::START);
  for (std::int64_t tick = 101; tick <= 110; ++tick) {
    const auto pair = clock.frame(tick);
    CHECK(pair.reason == media_clock_t::PERIODIC);
    CHECK(pair.index == tick - 100);
  }
  const auto missed = clock.frame(112);
  CHECK(missed.reason == media_clock_t::UNDERFLOW);
  CHECK(missed.index == 12);
}

TEST_CASE("Colours are converted to BT.709, and the lowest row becomes the last") {
  // Left half red, right half white; upper half black. 4 x 4 pixels.
  std::vector<std::uint8_t> rgba(64, 0), planes(i420_bytes(4, 4));
  for (std::size_t i = 0; i < 8; ++i) {
    const bool white = i % 4 >= 2;
    rgba[4 * i] = 255;
    rgba[4 * i + 1] = rgba[4 * i + 2] = white ? 255 : 0;
  }
  rgba_to_i420(rgba, 4, 4, planes);
  CHECK(planes[0] == 16);                               // black above
  CHECK(planes[4 * 3] == Approx(63).margin(1.5));       // red: 16 + 219 * 0.2126
  CHECK(planes[4 * 3 + 3] == Approx(235).margin(1.5));  // white
  const std::uint8_t* u = planes.data() + 16;
  const std::uint8_t* v = u + 4;
  CHECK(u[2] == Approx(102).margin(1.5));  // red: 128 - 224 * 0.2126 / 1.8556
  CHECK(v[2] == Approx(240).margin(1.5));
  CHECK(u[3] == Approx(128).margin(1.5));
  CHECK(v[3] == Approx(128).margin(1.5));
}

TEST_CASE("A restarted node does not overwrite an existing video") {
  const Folder folder;
  CHECK(next_video_path(folder.path.string()) == (folder.path / "video.mp4").string());
  std::ofstream(folder.path / "video.mp4") << "x";
  CHECK(next_video_path(folder.path.string()) == (folder.path / "video.2.mp4").string());
  std::ofstream(folder.path / "video.2.mp4") << "x";
  CHECK(next_video_path(folder.path.string()) == (folder.path / "video.3.mp4").string());
}

TEST_CASE("An encoder receives every byte and ends with its owner") {
  const Folder folder;
  const std::string file = (folder.path / "bytes").string();
  const std::vector<std::uint8_t> bytes(3'000'000, 7);
  {
    Encoder encoder({"sh", "-c", "cat > " + file});
    CHECK(encoder.write(bytes));
    CHECK(encoder.write(bytes));
  }
  CHECK(std::filesystem::file_size(file) == 6'000'000);

  SECTION("the end of an encoder is detected") {
    signal(SIGPIPE, SIG_IGN);  // as sync::Node does
    Encoder dead({"true"});
    bool written = true;
    for (int i = 0; i < 100 && written; ++i) written = dead.write(bytes);
    CHECK_FALSE(written);
  }
  SECTION("a missing encoder is reported by name") {
    CHECK_THROWS_WITH(Encoder({"no-such-encoder"}),
                      Catch::Contains("no-such-encoder") && Catch::Contains("install ffmpeg"));
  }
}

TEST_CASE("A video and a snapshot are complete when their owner ends") {
  const Folder folder;
  Settings settings;
  int reads = 0, pairs = 0;
  {
    Recording recording({folder.path.string(), true, (folder.path / "now.png").string(), 0.5});
    recording.begin(640, 480, settings);
    for (int tick = 0; tick < 8; ++tick) {
      const auto pair = recording.add(tick, sync::host_time(1'000'000'000 + tick * 16'666'667),
                                      [&](std::span<std::uint8_t> rgba) {
                                        std::fill(rgba.begin(), rgba.end(), static_cast<std::uint8_t>(20 * tick));
                                        ++reads;
                                      });
      if (!pair) continue;
      ++pairs;
      CHECK(pair->medium == "video.mp4");
      CHECK(pair->index == tick);
      CHECK(pair->host_time_ns == 1'000'000'000 + tick * 16'666'667);
    }
    CHECK(recording.error().empty());
    CHECK(recording.dropped() == 0);
  }
  CHECK(reads == 9);
  CHECK(pairs == 8);
  CHECK(std::filesystem::exists(folder.path / "now.png"));
  std::ifstream video(folder.path / "video.mp4", std::ios::binary);
  std::string head(12, '\0');
  video.read(head.data(), 12);
  CHECK(head.substr(4, 4) == "ftyp");
}
