// Runs the program audio_node on a log, in a folder that is removed afterwards, and reads its sound.
#pragma once

#include <fcntl.h>
#include <sndfile.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace tactus::audio::test {

struct Folder {
  Folder() {
    char name[] = "/tmp/tactus_offline_XXXXXX";
    if (mkdtemp(name)) path = name;
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string file(const std::string& name) const { return path + "/" + name; }
  std::string path;
};

struct Done {
  int status;
  std::string message;
};

// Runs the program in the folder of this one.
inline Done render(const Folder& folder, std::vector<std::string> words) {
  const auto bin = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::string message_path = folder.file("messages.txt");
  const pid_t child = fork();
  if (child == 0) {
    words.insert(words.begin(), bin / "audio_node");
    std::vector<char*> raw;
    for (std::string& w : words) raw.push_back(w.data());
    raw.push_back(nullptr);
    const int fd = open(message_path.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    dup2(fd, STDERR_FILENO);
    execv(raw[0], raw.data());
    _exit(127);
  }
  int status = -1;
  waitpid(child, &status, 0);
  std::ifstream text(message_path);
  return {WEXITSTATUS(status), std::string(std::istreambuf_iterator<char>(text), {})};
}

inline std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline std::vector<float> mono_of(const std::string& path) {
  SF_INFO info{};
  SNDFILE* file = sf_open(path.c_str(), SFM_READ, &info);
  REQUIRE(file);
  std::vector<float> all(static_cast<std::size_t>(info.channels * info.frames)), mono;
  sf_readf_float(file, all.data(), info.frames);
  sf_close(file);
  for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(info.channels))
    mono.push_back(all[i] + all[i + 1]);
  return mono;
}

inline std::int64_t first_sample_ns(const std::string& message) {
  const std::string before = "first sample was out at ";
  const auto at = message.find(before);
  REQUIRE(at != std::string::npos);
  return std::stoll(message.substr(at + before.size()));
}

}  // namespace tactus::audio::test
