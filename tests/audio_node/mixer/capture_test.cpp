#include "audio_node/mixer/capture.h"

#include <fcntl.h>
#include <sndfile.h>
#include <sys/resource.h>
#include <unistd.h>
#include <catch2/catch.hpp>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "audio_node/devices/stream.h"

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
  int pipe_fds[2];
  REQUIRE(pipe2(pipe_fds, O_NONBLOCK) == 0);
  {
    Capture capture(path, 8, 1, pipe_fds[1]);
    const std::vector<float> too_much(kFrames, 1.f), little(1, 0.5f);
    capture.append(too_much.data(), kFrames);
    CHECK(capture.lost_frames() == kFrames);
    while (capture.lost_frames() < kFrames + 1) capture.append(little.data(), 1);  // its silence is still pending
    CHECK(capture.frames() > kFrames);
  }
  MediaPair pair{};
  REQUIRE(::read(pipe_fds[0], &pair, sizeof pair) == sizeof pair);
  CHECK(pair.reason == MediaPair::kSilent);
  CHECK(recording_fault_of(pair, "audio.wav", 1000).starts_with("the disk is too slow for the sound: 1.0 s of audio.wav are silent"));
  ::close(pipe_fds[0]), ::close(pipe_fds[1]);
  std::filesystem::remove_all(folder);
}

TEST_CASE("Samples that the disk refuses end the file, are counted, and the reason comes through the pipe") {
  char folder[] = "/tmp/tactus_capture_XXXXXX";
  REQUIRE(mkdtemp(folder));
  const std::string path = std::string(folder) + "/a.wav";
  int pipe_fds[2];
  REQUIRE(pipe2(pipe_fds, O_NONBLOCK) == 0);
  const auto before = signal(SIGXFSZ, SIG_IGN);  // as every node
  rlimit limit{};
  REQUIRE(getrlimit(RLIMIT_FSIZE, &limit) == 0);
  const rlimit small{20'000, limit.rlim_max};
  REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
  std::int64_t lost = 0;
  {
    Capture capture(path, 48000, 1, pipe_fds[1]);
    const std::vector<float> samples(10'000, 0.25f);
    capture.append(samples.data(), samples.size());
    for (int i = 0; i < 5000 && capture.lost_frames() == 0; ++i) usleep(1000);  // the writer is a thread
    lost = capture.lost_frames();
  }
  setrlimit(RLIMIT_FSIZE, &limit);
  signal(SIGXFSZ, before);
  CHECK(lost > 0);
  MediaPair pair{};
  REQUIRE(::read(pipe_fds[0], &pair, sizeof pair) == sizeof pair);
  CHECK(pair.reason == MediaPair::kRefused);
  CHECK(pair.underflows == EFBIG);
  CHECK(pair.index > 0);
  CHECK(pair.index < 5000);
  CHECK(recording_fault_of(pair, "audio.wav", 48000).starts_with("the disk refuses the sound (File too large): audio.wav ends after 0."));
  CHECK(::read(pipe_fds[0], &pair, sizeof pair) < 0);  // reported once
  ::close(pipe_fds[0]), ::close(pipe_fds[1]);
  std::filesystem::remove_all(folder);
}

TEST_CASE("A WAV of float samples has the extension field and the fact chunk that a format other than PCM needs") {
  char folder[] = "/tmp/tactus_capture_XXXXXX";
  REQUIRE(mkdtemp(folder));
  const std::string path = std::string(folder) + "/a.wav";
  {
    Capture capture(path, 48000, 2, -1);
    const std::vector<float> samples(20, 0.25f);
    capture.append(samples.data(), 10);
  }
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  const auto number = [&](std::size_t at, int count) {
    std::uint32_t value = 0;
    for (int i = 0; i < count; ++i) value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i)))) << (8 * i);
    return value;
  };
  std::map<std::string, std::size_t> chunks;  // the place of the contents of each
  for (std::size_t at = 12; at + 8 <= bytes.size(); at += 8 + number(at + 4, 4) + number(at + 4, 4) % 2) chunks[bytes.substr(at, 4)] = at + 8;
  REQUIRE(chunks.contains("fmt "));
  const std::size_t format = chunks["fmt "], size = number(format - 4, 4);
  REQUIRE(size >= 18);
  CHECK(size == 18 + number(format + 16, 2));  // cbSize
  const bool extensible = number(format, 2) == 0xFFFE;
  CHECK(number(format + (extensible ? 24 : 0), 2) == 3);  // IEEE float
  CHECK(number(format + 14, 2) == 32);
  REQUIRE(chunks.contains("fact"));
  CHECK(number(chunks["fact"], 4) == 10);  // frames
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
