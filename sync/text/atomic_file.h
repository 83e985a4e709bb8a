// A text file that is written as FILE.part and renamed to FILE on finish(); without finish() the part is deleted.
#pragma once

#include <string>
#include <string_view>

namespace tactus::sync {

class AtomicFile {
 public:
  // option: named in error messages as the option to change, e.g. "--trace". Throws std::runtime_error with one sentence when
  // the file cannot be created, or another program is writing it.
  AtomicFile(std::string path, std::string option);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Throws std::runtime_error with one sentence when writing fails.
  void write(std::string_view text);
  // Renames the file; no write may follow. Throws as write does.
  void finish();
  const std::string& path() const { return path_; }

 private:
  void flush();

  std::string path_, part_, option_, buffer_;
  int file_ = -1;
};

// The path of the unfinished file. An existing path that is not a plain file, such as /dev/null, is written directly.
std::string part_of(const std::string& path);

}  // namespace tactus::sync
