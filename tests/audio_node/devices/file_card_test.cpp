#include "audio_node/devices/file_card.h"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/audio_node/support/bench.h"

using namespace tactus;
using namespace tactus::audio;
using namespace tactus::audio::test;

namespace {

struct Folder {
  Folder() {
    char name[] = "/tmp/tactus_card_XXXXXX";
    if (mkdtemp(name)) path = name;
  }
  ~Folder() { std::filesystem::remove_all(path); }
  long files() const {
    return std::distance(std::filesystem::directory_iterator(path), std::filesystem::directory_iterator());
  }
  std::string path;
};

void silence(float* out, int frames, const BlockTime&) { std::fill(out, out + 2 * frames, 0.f); }

}  // namespace

TEST_CASE("An aborted rendering leaves no file with the final name") {
  const Folder folder;
  const std::string wav = folder.path + "/out.wav";
  std::ofstream(wav) << "of before";
  {
    FileCard card({}, wav, silence);
    card.play_until(sync::host_time(kStart_ns));
    CHECK(card.frames() > 0);
    CHECK(std::filesystem::file_size(wav) == 9);
  }
  CHECK(folder.files() == 1);
  CHECK(std::filesystem::file_size(wav) == 9);  // the previous file is still there

  SECTION("a completed rendering leaves only the final file") {
    FileCard card({}, wav, silence);
    card.play_until(sync::host_time(kStart_ns));
    card.finish();
    CHECK(folder.files() == 1);
    CHECK(static_cast<std::int64_t>(std::filesystem::file_size(wav)) > card.frames() * 8);
  }
}

TEST_CASE("The second of two renderings into one file is rejected until the first has ended") {
  const Folder folder;
  const std::string wav = folder.path + "/out.wav";
  {
    FileCard first({}, wav, silence);
    CHECK_THROWS_WITH(FileCard({}, wav, silence), Catch::Contains("another program is writing"));
    first.play_until(sync::host_time(kStart_ns));
    first.finish();
  }
  const auto size = std::filesystem::file_size(wav);
  FileCard second({}, wav, silence);
  second.play_until(sync::host_time(kStart_ns));
  second.finish();
  CHECK(std::filesystem::file_size(wav) == size);
}
