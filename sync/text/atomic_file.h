// A text file that bears its name only when it is whole: until then it is FILE.part, which goes with this.
#pragma once

#include <string>
#include <string_view>

namespace tactus::sync {

class AtomicFile {
 public:
  // option: which the person who reads a complaint is to choose anew, e.g. "--trace". Throws std::runtime_error
  // with one sentence when it cannot be made, or another program is writing it.
  AtomicFile(std::string path, std::string option);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Throws std::runtime_error with one sentence when the disk does not take it.
  void write(std::string_view text);
  // It gets its name; nothing is written any more. Throws as write does.
  void finish();
  const std::string& path() const { return path_; }

 private:
  void flush();

  std::string path_, part_, option_, waiting_;
  int file_ = -1;
};

// Where such a file is while it is not whole. What is there and no plain file, such as /dev/null, is written to as
// it is.
std::string part_of(const std::string& path);

}  // namespace tactus::sync
