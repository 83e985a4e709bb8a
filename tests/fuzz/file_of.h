// A temporary file of this process, for readers that take a path.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

namespace tactus::fuzz {

class FileOf {
 public:
  // name: file name within a folder that no other object of this process uses.
  explicit FileOf(const std::filesystem::path& name)
      : folder_(std::filesystem::temp_directory_path() /
                ("tactus_fuzz_" + std::to_string(getpid()) + "_" + name.filename().string())),
        path_(folder_ / name) {
    std::filesystem::create_directories(path_.parent_path());
  }
  ~FileOf() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  FileOf(const FileOf&) = delete;
  FileOf& operator=(const FileOf&) = delete;

  void write(const std::uint8_t* data, std::size_t size) const {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    if (file == nullptr) return;
    std::fwrite(data, 1, size, file);
    std::fclose(file);
  }
  const std::filesystem::path& path() const { return path_; }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_, path_;
};

}  // namespace tactus::fuzz
