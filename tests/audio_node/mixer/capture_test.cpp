#include "audio_node/mixer/capture.h"

#include <fcntl.h>
#include <sndfile.h>
#include <unistd.h>
#include <catch2/catch.hpp>
#include <filesystem>
#include <vector>

using namespace tactus::audio;

TEST_CASE("The capture holds exactly the given samples and sends its pairs through the pipe") {
  char folder[] = "/tmp/tactus_capture_XXXXXX";
  REQUIRE(mkdtemp(folder));
  const std::string path = std::string(folder) + "/a.wav";
  int pipe_fds[2];
  REQUIRE(pipe2(pipe_fds, O_NONBLOCK) == 0);
  std::vector<float> samples(2 * 10000);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<float>(i) * 1e-5f - 3.f;  // beyond full scale too
  {
    Capture capture(path, 48000, 2, pipe_fds[1]);
    for (std::size_t done = 0; done < 10000; done += 100) capture.append(&samples[2 * done], 100);
    capture.mark({77, 123456789, MediaPair::kPeriodic, 0});
    CHECK(capture.frames() == 10000);
    CHECK(capture.lost_frames() == 0);
  }
  MediaPair pair{};
  REQUIRE(::read(pipe_fds[0], &pair, sizeof pair) == sizeof pair);
  CHECK(pair.index == 77);
  CHECK(pair.host_ns == 123456789);
  SF_INFO info{};
  SNDFILE* file = sf_open(path.c_str(), SFM_READ, &info);
  REQUIRE(file);
  CHECK(info.frames == 10000);
  CHECK(info.samplerate == 48000);
  std::vector<float> back(samples.size());
  CHECK(sf_read_float(file, back.data(), static_cast<sf_count_t>(back.size())) ==
        static_cast<sf_count_t>(back.size()));
  CHECK(back == samples);
  sf_close(file);
  ::close(pipe_fds[0]), ::close(pipe_fds[1]);
  std::filesystem::remove_all(folder);
}

TEST_CASE("Samples that the disk cannot take are replaced by silence, so that indices stay valid") {
  char folder[] = "/tmp/tactus_capture_XXXXXX";
  REQUIRE(mkdtemp(folder));
  const std::string path = std::string(folder) + "/a.wav";
  // 5 s of ring at 8 Hz: 64 samples. More than that at once cannot fit.
  constexpr std::int64_t kFrames = 1000;
  {
    Capture capture(path, 8, 1, -1);
    const std::vector<float> too_much(kFrames, 1.f), little(1, 0.5f);
    capture.append(too_much.data(), kFrames);
    CHECK(capture.lost_frames() == kFrames);
    while (capture.lost_frames() < kFrames + 1) capture.append(little.data(), 1);  // its silence is still pending
    CHECK(capture.frames() > kFrames);
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("A sound file is written into a folder whose path has more than 1023 bytes") {
  char top[] = "/tmp/tactus_capture_XXXXXX";
  REQUIRE(mkdtemp(top));
  std::filesystem::path folder = top;
  for (int i = 0; i < 6; ++i) folder /= std::string(200, 'd');
  std::filesystem::create_directories(folder);
  const std::string path = folder / "a.wav";
  {
    Capture capture(path, 48000, 1, -1);
    const std::vector<float> samples(100, 0.25f);
    capture.append(samples.data(), 100);
  }
  CHECK(std::filesystem::file_size(path) >= 400);
  CHECK_THROWS_WITH(Capture(path + "/b.wav", 48000, 1, -1), Catch::Contains("cannot write " + path + "/b.wav (Not a directory)"));
  std::filesystem::remove_all(top);
}
